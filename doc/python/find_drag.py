# SPDX-License-Identifier: GPL-3.0-or-later
"""Where to drag the fore paws of the cat so that its muzzle comes to a given point, with the least work.

Usage: python3 doc/python/find_drag.py [ITERATIONS [PICTURE]]
Needs scipy; the picture needs matplotlib.
"""
import sys
from pathlib import Path

import numpy as np
import scipy.optimize

import exemplar

top = Path(__file__).resolve().parents[2]
scene = {
    "Scene": "static",
    "Mesh": {"File": top / "meshes/cat.msh"},
    "Examples": {"Poses": [top / "meshes/poses/cat_arch.msh", top / "meshes/poses/cat_rear.msh"], "Importance": 0.9},
    "Handles": {
        "hind": {"Select": "box -0.52 -0.2 -0.01  -0.27 0.2 0.08"},
        "right": {"Select": "box 0.26 -0.2 -0.01  0.5 0 0.08"},
        "left": {"Select": "box 0.26 0 -0.01  0.5 0.2 0.08"},
    },
    "Time": {"Increments": 1},
    "Solver": {"Tolerance": 1e-8},
}
exemplar.use_one_blas_thread()
problem = exemplar.Problem(scene)
rest = problem.rest_positions
x, y, z = rest.T
paws = [(x > 0.26) & (x < 0.5) & (z < 0.08) & (y < 0), (x > 0.26) & (x < 0.5) & (z < 0.08) & (y > 0)]
muzzle = x.argmax()
target = rest[muzzle] + [-0.12, 0.04, 0.08]
drags = np.zeros((2, 3))  # of the right and of the left fore paw [m]
problem.set_motion("right", lambda places, t: 0 * places + drags[0])
problem.set_motion("left", lambda places, t: 0 * places + drags[1])


def solve(unknowns):
    """The equilibrium for these drags, unless the problem stands there."""
    if problem.step_number == 0 or np.any(drags != unknowns.reshape(2, 3)):
        drags[:] = unknowns.reshape(2, 3)
        problem.step()


def by_drags(by_positions):
    """The derivative by the drags of what has this one by the positions of held nodes."""
    return np.concatenate([by_positions[paw].sum(axis=0) for paw in paws])


def work(unknowns):
    """The potential, whose derivative by the place of a held node is the force that holds it; over some N/m, which make the
    second derivatives of the order of 1."""
    solve(unknowns)
    return problem.energy() / 200, by_drags(problem.gradient()) / 200


def distance(unknowns):
    solve(unknowns)
    return problem.positions[muzzle] - target


def slopes_of_distance(unknowns):
    solve(unknowns)
    rows = np.zeros((3, *rest.shape))
    rows[range(3), muzzle, range(3)] = 1
    return np.array([by_drags(problem.vjp(row)["handles"]) for row in rows])


solve(drags.ravel())
limit = int(sys.argv[1]) if len(sys.argv) > 1 else 50
found = scipy.optimize.minimize(work, np.zeros(6), jac=True, method="SLSQP", options={"maxiter": limit, "ftol": 1e-7},
                                constraints={"type": "eq", "fun": distance, "jac": slopes_of_distance})
solve(found.x)
print(f"{found.nit} iterations, {found.nfev} solves")
print("muzzle is off by [mm]   work [J]   right paw [m]          left paw [m]")
print(f"{1000 * np.linalg.norm(distance(found.x)):21.4f} {problem.energy():10.3f}  ", np.array2string(found.x, precision=3)[1:-1])
if len(sys.argv) > 2:
    import matplotlib.pyplot as plt
    axes = problem.plot()
    axes.plot(*target, "ro")
    axes.view_init(15, -70)
    plt.savefig(sys.argv[2], dpi=90)
