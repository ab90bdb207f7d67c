# SPDX-License-Identifier: GPL-3.0-or-later
"""Find the tensions of biceps and triceps that bring the hand of the tutorial's arm to a point.

Usage: python3 doc/python/reach_by_muscles.py [X Z]   (52 cm along the upper arm and 12 cm above the shoulder if there are none)
Each row: the tensions of biceps and triceps [kPa], the hand's place x and z [cm], its distance from the point [mm].
"""
import sys
from pathlib import Path

import numpy as np

import exemplar

scene = Path(__file__).resolve().parents[2] / "prm/tutorial/step11_arm.prm"
problem = exemplar.Problem(scene)
hand = problem.rest_positions[:, 0] > 0.559
point = 1e-2 * np.array([float(word) for word in sys.argv[1:3]] or [52, 12])
muscles = ["biceps", "triceps"]


def cells_of(muscle):
    problem.set_tension({name: float(name == muscle) for name in muscles})
    return problem.tension > 0


def slope_of(coordinate):
    """Of the hand's coordinate by both tensions."""
    by_positions = np.zeros_like(problem.positions)
    by_positions[hand, coordinate] = 1 / hand.sum()
    by_cell = problem.vjp(by_positions)["fibre_tension"]
    return [by_cell[of_muscle].sum() for of_muscle in cells]


cells = [cells_of(muscle) for muscle in muscles]
tension = np.array([2e3, 1e2])
problem.set_tension(dict(zip(muscles, tension)))
problem.run()
for _ in range(15):
    place = problem.positions[hand].mean(axis=0)[[0, 2]]
    print(*(f"{number:8.3f}" for number in (*tension / 1e3, *100 * place, 1e3 * np.linalg.norm(place - point))))
    slope, way = np.array([slope_of(0), slope_of(2)]), point - place
    damping = (way @ way) / 0.01 * (slope ** 2).sum() * np.eye(2)  # Levenberg's, less the nearer
    step = np.linalg.solve(slope.T @ slope + damping, slope.T @ way)
    tension = np.maximum(tension + np.clip(step, -2e3, 2e3), 0)
    problem.set_tension(dict(zip(muscles, tension)))
    problem.step()
