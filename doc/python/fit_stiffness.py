# SPDX-License-Identifier: GPL-3.0-or-later
"""Find Young's modulus of each cell of a bar from where five loads bring its surface.

Usage: python3 doc/python/fit_stiffness.py [CELLS_ACROSS [PICTURE]]
8 cells across are 10,752 tetrahedra. Needs scipy; the picture needs matplotlib.
"""
import sys
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import scipy.optimize
import scipy.sparse
import scipy.spatial

import exemplar

across = int(sys.argv[1]) if len(sys.argv) > 1 else 8
exemplar.use_one_blas_thread()
scene = {
    "Scene": "static",
    "Mesh": {"Generator": "box", "Box size": [3.5, 1, 1], "Box cells": [7 * across // 2, across, across]},
    "Material": {"Young's modulus": 1e5, "Poisson's ratio": 0.3},
    "Handles": {"wall": {"Select": "boundary 1"}},
    "Time": {"Increments": 1},
    "Solver": {"Tolerance": 1e-7},
}
problems = [exemplar.Problem(scene) for _ in range(5)]
x, y, z = problems[0].rest_positions.T
centres = problems[0].rest_positions[problems[0].cells].mean(axis=1)
surface = np.isclose(x, 3.5) | np.isclose(abs(y), 0.5) | np.isclose(abs(z), 0.5)


# pulled, bent both ways and twisted at its end, and squeezed from its sides
def spread(nodes, vectors):
    """Forces (n, 3) on some nodes, which a mean of `vectors` (n, 3) or (3,) adds up to."""
    forces = np.zeros((len(x), 3))
    forces[nodes] = np.broadcast_to(vectors, forces.shape)[nodes] / nodes.sum()
    return forces


end, sides = np.isclose(x, 3.5), np.isclose(abs(y), 0.5)
forces = [spread(end, [4e3, 0, 0]), spread(end, [0, 300, 0]), spread(end, [0, 0, 300]),
          spread(end, 1e3 * np.stack([0 * y, -z, y], axis=1)), spread(sides, np.outer(-1e4 * np.sign(y), [0, 1, 0]))]
for problem, load in zip(problems, forces):
    problem.nodal_forces = load


def solve(problem, young):
    problem.set_material(young=young)
    problem.step()
    return problem.positions


# the body whose stiffness is to be found: a hard lump, and softer towards its end
true_young = 1e5 * np.exp(0.8 * np.exp(-2 * ((centres - [1.2, 0.2, 0.1]) ** 2).sum(axis=1)) - 0.15 * centres[:, 0])
measured = [solve(problem, true_young)[surface] for problem in problems]
energies = [np.einsum("mij,mij->m", problem.stresses, problem.strains) for problem in problems]
seen = np.max([energy / energy.mean() for energy in energies], axis=0) > 0.1  # cells that some load strains

# unknowns q: log E is a mean of q over a ball round each cell, by a weight that falls to its border
radius = 0.8
near = scipy.spatial.cKDTree(centres).sparse_distance_matrix(scipy.spatial.cKDTree(centres), radius).tocsr()
near.data = (1 - near.data / radius) ** 2
smooth = scipy.sparse.diags(1 / near.sum(axis=1).A1) @ near


def misfit_of(problem, wanted, young):
    """Relative squared distance of the surface from the measured one, and its gradient by E."""
    difference = np.zeros((len(x), 3))
    difference[surface] = solve(problem, young)[surface] - wanted
    scale = 1 / ((wanted - problem.rest_positions[surface]) ** 2).sum()
    return scale * (difference**2).sum() / 2, problem.vjp(scale * difference)["young"]


def misfit(q):
    young = np.exp(smooth @ q)
    values, gradients = zip(*threads.map(misfit_of, problems, measured, [young] * 5))
    history.append(sum(values))
    return 1e4 * sum(values), 1e4 * (smooth.T @ (young * sum(gradients)))


threads, history, start = ThreadPoolExecutor(2), [], time.time()
found = scipy.optimize.minimize(misfit, np.full(len(centres), np.log(1e5)), jac=True, method="L-BFGS-B",
                                options={"maxiter": 150, "maxcor": 100, "ftol": 0, "gtol": 1e-5})
young = np.exp(smooth @ found.x)
errors = abs(young / true_young - 1)
print(f"{len(centres)} cells, {found.nit} iterations, {found.nfev} evaluations of 5 loads, {time.time() - start:.0f} s")
print(f"misfit {history[0]:.1e} -> {history[-1]:.1e}; E from {true_young.min():.3g} to {true_young.max():.3g} Pa")
print("cells seen   error of E: mean   95 %   greatest")
print(f"{seen.mean():10.3f} {errors[seen].mean():17.4f} {np.quantile(errors[seen], 0.95):8.4f} {errors[seen].max():8.4f}")

if len(sys.argv) > 2:
    import matplotlib.pyplot as plt
    figure, rows = plt.subplots(3, 1, figsize=(7, 7), sharex=True, constrained_layout=True)
    cut = abs(centres[:, 1] - 0.2) < 0.5 / across
    for axes, values, title in zip(rows, (true_young, young, 100 * (young / true_young - 1)), ("E [Pa]", "found [Pa]", "error [%]")):
        image = axes.tricontourf(centres[cut, 0], centres[cut, 2], values[cut], 20)
        axes.set(title=title, aspect="equal", ylabel="z [m]")
        figure.colorbar(image, ax=axes)
    rows[-1].set(xlabel="x [m], in the plane y = 0.2 m")
    plt.savefig(sys.argv[2], dpi=90)
