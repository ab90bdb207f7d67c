# SPDX-License-Identifier: GPL-3.0-or-later
"""A bar of numpy arrays, lifted at one end; its example is the bar bent by 90 degrees about its middle."""
import numpy as np

import exemplar

# of a brick, whose corner 4 i + 2 j + k is i, j, k bricks' lengths from the first along x, y, z
TETRAHEDRA = [[0, 4, 6, 7], [0, 2, 3, 7], [0, 1, 5, 7], [0, 6, 2, 7], [0, 3, 1, 7], [0, 5, 4, 7]]


def box(n_x, n_y, n_z, size):
    """Nodes (n, 3) and cells (m, 4) of a box from x = 0, around the x axis: six tetrahedra a brick."""
    counts = [n_x, n_y, n_z]
    points = np.stack(np.meshgrid(*[np.arange(n + 1) for n in counts], indexing="ij"), axis=-1)
    number = np.arange(points[..., 0].size).reshape(points.shape[:3])  # of the node at each point
    corners = np.stack([number[i:n_x + i, j:n_y + j, k:n_z + k].ravel() for i in (0, 1) for j in (0, 1) for k in (0, 1)], axis=-1)
    nodes = (points.reshape(-1, 3) / counts - [0, 0.5, 0.5]) * size
    return nodes, corners[:, TETRAHEDRA].reshape(-1, 4)


nodes, cells = box(16, 4, 4, [4.0, 1.0, 1.0])
x, y, z = nodes.T
radius, angle = 8 / np.pi, np.pi * x / 8
bent = np.column_stack([(radius - z) * np.sin(angle), y, radius - (radius - z) * np.cos(angle)])

scene = {
    "Scene": "static",
    "Examples": {"Importance": 0.8},
    "Handles": {
        "left": {"Select": ["box", -0.1, -1, -1, 0.1, 1, 1]},
        "right": {"Select": ["box", 3.9, -1, -1, 4.1, 1, 1], "Motion": [0, 0, "t"], "Components": "z"},
    },
    "Time": {"Increments": 5},
}
problem = exemplar.Problem(scene, mesh=(nodes, cells), poses=[bent])
print("lift [m]   rest   bent   elastic [J]")
while problem.step_number < problem.n_steps:
    problem.step()
    rest, weight = problem.weights
    print(f"{problem.time:8.1f} {rest:6.3f} {weight:6.3f} {problem.energies['energy_elastic']:13.1f}")
shift = (problem.positions - problem.rest_positions)[x == 4].mean(axis=0)
print("The end has moved by", shift.round(3))
