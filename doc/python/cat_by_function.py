# SPDX-License-Identifier: GPL-3.0-or-later
"""The cat of the tutorial; a function of time leads its fore paws round half a circle.

Usage: python3 doc/python/cat_by_function.py [STEPS]
"""
import sys
from pathlib import Path

import numpy as np

import exemplar

top = Path(__file__).resolve().parents[2]
scene = {
    "Scene": "static",
    "Mesh": {"File": top / "meshes/cat.msh"},
    "Material": {"Young's modulus": 1e6, "Poisson's ratio": 0.45},
    "Examples": {"Poses": [top / "meshes/poses/cat_arch.msh", top / "meshes/poses/cat_rear.msh"], "Importance": 0.9},
    "Handles": {
        "hind paws": {"Select": "box -0.52 -0.2 -0.01  -0.27 0.2 0.08"},
        "fore paws": {"Select": "box 0.26 -0.2 -0.01  0.5 0.2 0.08"},
    },
    "Time": {"Increments": int(sys.argv[1]) if len(sys.argv) > 1 else 10},
}


def lead(rest, t):
    """Displacements (k, 3) [m] of the fore paws, which are at `rest` (k, 3), at time t."""
    angle = np.pi * t
    way = 0.11 * np.array([np.cos(angle) - 1, 0, np.sin(angle)])
    return np.tile(way, (len(rest), 1))


problem = exemplar.Problem(scene)
problem.set_motion("fore paws", lead)
problem.on_iteration(lambda report: print(f"  iteration {report.iterations}: residual {report.residual:.1e}"))
print("   t   rest   arch   rear   back [m]")
back = problem.positions[:, 2].argmax()
while problem.step_number < problem.n_steps:
    problem.step()
    weights = " ".join(f"{weight:6.3f}" for weight in problem.weights)
    print(f"{problem.time:4.1f} {weights} {problem.positions[back, 2]:8.3f}")
