# SPDX-License-Identifier: GPL-3.0-or-later
"""A bar of numpy arrays, lifted at one end; its example is the bar bent by 90 degrees."""
import numpy as np

import exemplar


def box(n_x, n_y, n_z, size):
    """Nodes (n, 3), x fastest, and cells (m, 4): six tetrahedra a brick."""
    points = np.stack(np.meshgrid(np.arange(n_z + 1), np.arange(n_y + 1), np.arange(n_x + 1), indexing="ij"), axis=-1)
    nodes = points.reshape(-1, 3)[:, ::-1] / [n_x, n_y, n_z] * size
    step = np.array([1, n_x + 1, (n_x + 1) * (n_y + 1)])  # to the neighbour in x, y, z
    corners = (points[:-1, :-1, :-1].reshape(-1, 3)[:, ::-1] @ step)[:, None]
    cells = []
    for first, second in [(0, 1), (1, 2), (2, 0), (1, 0), (2, 1), (0, 2)]:  # the ways from corner to corner
        way = np.array([0, step[first], step[first] + step[second], step.sum()])
        is_right_handed = (second - first) % 3 == 1
        cells.append(corners + (way if is_right_handed else way[[0, 2, 1, 3]]))
    return nodes, np.concatenate(cells)


nodes, cells = box(16, 4, 4, [4.0, 1.0, 1.0])
x, y, z = nodes.T
radius, angle = 8 / np.pi, np.pi * x / 8
bent = np.column_stack([(radius - z) * np.sin(angle), y, radius - (radius - z) * np.cos(angle)])

scene = {
    "Scene": "static",
    "Examples": {"Importance": 0.8},
    "Handles": {
        "left": {"Select": ["box", -0.1, 0, 0, 0.1, 1, 1]},
        "right": {"Select": ["box", 3.9, 0, 0, 4.1, 1, 1], "Motion": [0, 0, "t"], "Components": "z"},
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
