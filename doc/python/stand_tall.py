# SPDX-License-Identifier: GPL-3.0-or-later
"""An example pose with which a soft cat, which sags under its weight, stands as high as it was drawn.

Usage: python3 doc/python/stand_tall.py [PICTURE]
Needs scipy; the picture needs matplotlib.
"""
import sys
import warnings
from pathlib import Path

import numpy as np
import scipy.sparse.linalg

import exemplar

exemplar.use_one_blas_thread()
warnings.simplefilter("ignore", UserWarning)  # that it sags, and has one pose which is at first its shape, is meant
problem = exemplar.Problem({
    "Scene": "static",
    "Mesh": {"File": Path(__file__).resolve().parents[2] / "meshes/cat.msh"},
    "Material": {"Young's modulus": 8e5, "Poisson's ratio": 0.45, "Density": 1000},
    "Examples": {"Pose functions": [["x", "y", "z"]], "Include rest pose": False, "Importance": 0.9},
    "Handles": {"paws": {"Select": "box -1 -1 -0.01  1 1 0.08"}},
    "Loads": {"Gravity": [0, 0, -9.81]},
    "Solver": {"Tolerance": 1e-9},
})
rest, pose = problem.rest_positions, problem.rest_positions.copy()  # the pose is at first the drawn shape
back = (abs(rest[:, 0]) < 0.15) & (rest[:, 2] > np.quantile(rest[:, 2], 0.6))
by_positions = np.outer(back, [0, 0, 1]) / back.sum()  # of the mean height of the back
target = (by_positions * rest).sum()
problem.run()
sagged = problem.positions.copy()

# Of all changes of the pose that raise the back by what is missing, the one of least energy in the norm of the stiffness K
free = np.repeat(rest[:, 2] > 0.08, 3)
solve_K = scipy.sparse.linalg.factorized(problem.hessian(kind="convex")[free][:, free].tocsc())
print("change   height of the back [m]   missing [mm]")
for change in range(8):
    missing = target - (by_positions * problem.positions).sum()
    print(f"{change:6d} {target - missing:24.5f} {1000 * missing:14.5f}")
    if abs(missing) < 1e-6:
        break
    slope = problem.vjp(by_positions)["poses"][0].ravel()
    direction = np.zeros(pose.size)
    direction[free] = solve_K(slope[free])
    pose += (missing / (slope @ direction) * direction).reshape(pose.shape)
    problem.set_pose(0, pose)
    problem.step()
if len(sys.argv) > 1:
    import matplotlib.pyplot as plt
    for places, label in (rest, "drawn"), (sagged, "sags"), (problem.positions, "with the pose"), (pose, "the pose"):
        plt.plot(*places[abs(rest[:, 1]) < 0.03][:, [0, 2]].T, ".", markersize=3, label=label)
    plt.gca().set(aspect="equal", xlabel="x [m]", ylabel="z [m], nodes near the middle plane")
    plt.legend()
    plt.savefig(sys.argv[1], dpi=90)
