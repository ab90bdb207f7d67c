# SPDX-License-Identifier: GPL-3.0-or-later
"""Find the tensions of biceps and triceps that bring the hand of the tutorial's arm to a height.

Usage: python3 doc/python/reach_by_muscles.py [HEIGHT]   (8 cm above the shoulder if there is none)
Each row: the tensions of biceps and triceps [kPa], the hand's place x and z [cm], its distance from the wish [mm].
"""
import sys
from pathlib import Path

import numpy as np

import exemplar

scene = Path(__file__).resolve().parents[2] / "prm/tutorial/step11_arm.prm"
problem = exemplar.Problem(scene)
hand = problem.rest_positions[:, 0] > 0.559
wish = 1e-2 * float(sys.argv[1] if len(sys.argv) > 1 else 8)
muscles = ["biceps", "triceps"]


def cells_of(muscle):
    problem.set_tension({name: float(name == muscle) for name in muscles})
    return problem.tension > 0


cells = [cells_of(muscle) for muscle in muscles]
tension = np.array([2e3, 1e2])
problem.set_tension(dict(zip(muscles, tension)))
problem.run()
for _ in range(8):
    place = problem.positions[hand].mean(axis=0)
    print(*(f"{number:8.3f}" for number in (*tension / 1e3, 100 * place[0], 100 * place[2], 1e3 * abs(place[2] - wish))))
    by_positions = np.zeros_like(problem.positions)
    by_positions[hand, 2] = 1 / hand.sum()  # of the hand's height
    by_cell = problem.vjp(by_positions)["fibre_tension"]
    slope = np.array([by_cell[of_muscle].sum() for of_muscle in cells])
    step = slope * (wish - place[2]) / (slope @ slope)  # Newton's, the shortest
    tension = np.maximum(tension + np.clip(step, -3e3, 3e3), 0)
    problem.set_tension(dict(zip(muscles, tension)))
    problem.step()
