# SPDX-License-Identifier: GPL-3.0-or-later
"""Obstacles that are added between steps: as if the scene had them, on what falls and on what stands, and what is refused."""
import unittest
from pathlib import Path

import numpy as np

import exemplar

BAR = {"Scene": "dynamic", "Mesh": {"Generator": "box", "Box size": [1, 0.2, 0.2], "Box cells": (6, 2, 2)},
       "Material": {"Young's modulus": 1e5, "Poisson's ratio": 0.3}, "Loads": {"Gravity": [0, 0, -9.81]},
       "Solver": {"Step tolerance": 1e-10}, "Time": {"Step": 0.01, "End": 2, "Mass damping": 20}}
FLOOR = "plane 0 0 -0.2 0 0 1"
WEIGHT = 1000 * 0.04 * 9.81


class Obstacles(unittest.TestCase):
    def test_one_that_is_added_at_the_start_is_as_one_of_the_scene(self):
        theirs = exemplar.Problem({**BAR, "Obstacles": {"floor": {"Shape": FLOOR, "Friction": 0.3, "Motion": "0.01*t; 0; 0"}}})
        mine = exemplar.Problem(BAR)
        self.assertEqual(mine.obstacles, {})
        mine.add_obstacle("floor", FLOOR, motion="0.01*t; 0; 0", friction=0.3)
        for problem in (theirs, mine):
            problem.goto(0.3)
        self.assertGreater(theirs.obstacles["floor"]["force"][2], 1)
        self.assertLess(np.abs(mine.positions - theirs.positions).max(), 1e-12)
        self.assertAlmostEqual(mine.obstacles["floor"]["heat"], theirs.obstacles["floor"]["heat"], places=12)

    def test_forces_of_pieces_on_each_other(self):
        problem = exemplar.Problem({**BAR, "Mesh": {"File": Path(__file__).resolve().parents[2] / "meshes/two_bars.msh"},
                                    "Handles": {"left": {"Select": "box -0.01 -1 -0.1  0.01 1 0.1"}, "right": {"Select": "box 1.99 -1 -0.1  2.01 1 0.1"}},
                                    "Material": {"Young's modulus": 1e7, "Poisson's ratio": 0.3},
                                    "Contact": {"Bodies": True, "Friction": 0.3}, "Time": {"Step": 0.01, "End": 1}})
        upper = problem.rest_positions[:, 2] > 0.11
        self.assertEqual(abs(problem.contact_forces).max(), 0)
        problem.goto(0.19)
        masses = problem.mass

        def momentum_of(nodes):
            return (masses @ problem.velocities.ravel()).reshape(-1, 3)[nodes].sum(0)
        before = momentum_of(upper)
        problem.step()
        forces, momentum = problem.contact_forces, momentum_of(upper)
        weight = np.asarray(masses.sum(1)).reshape(-1, 3)[upper, 2].sum() * 9.81
        self.assertGreater(problem.statistics["body_pairs"], 0)
        self.assertLess(0, problem.statistics["least_body_gap"])
        self.assertGreater(forces[upper].sum(0)[2], 0.1 * weight)
        np.testing.assert_allclose(forces[upper].sum(0), (momentum - before) / 0.01 + [0, 0, weight], atol=1e-5 * weight)
        np.testing.assert_allclose(forces.sum(0), 0, atol=1e-9 * weight)

    def test_one_more_goes_beside_those_that_are_there(self):
        problem = exemplar.Problem({**BAR, "Obstacles": {"floor": {"Shape": FLOOR}}})
        problem.goto(1)
        step = np.array([(-1, -1, -1), (0.3, -1, -1), (0.3, 1, -1), (-1, 1, -1), (-1, -1, -0.25), (0.3, -1, -0.25), (0.3, 1, -0.25), (-1, 1, -0.25)])
        faces = [(0, 2, 1), (0, 3, 2), (4, 5, 6), (4, 6, 7), (0, 1, 5), (0, 5, 4), (1, 2, 6), (1, 6, 5), (2, 3, 7), (2, 7, 6), (3, 0, 4), (3, 4, 7)]
        problem.add_obstacle("step", (step, faces), motion="0; 0; 0.2*min(t-1, 0.4)")
        before = problem.obstacles["floor"]["work"]
        self.assertEqual(problem.obstacles["step"]["work"], 0)
        problem.goto(2)
        forces = [problem.obstacles[name]["force"][2] for name in ("floor", "step")]
        self.assertGreater(min(forces), 0.1 * WEIGHT)
        self.assertAlmostEqual(sum(forces) / WEIGHT, 1, delta=0.02)
        self.assertNotEqual(problem.obstacles["floor"]["work"], before)
        self.assertGreater(problem.positions[problem.positions[:, 0] < 0.3][:, 2].min(), -0.17)

    def test_what_it_touches_stands(self):
        problem = exemplar.Problem({key: value for key, value in BAR.items() if key != "Loads"})
        problem.step()
        problem.add_obstacle("table", "plane 0 0 -0.1 0 0 1")
        problem.step()
        self.assertLess(problem.energies["energy_kinetic"], 1e-9)

    def test_a_state_from_before_comes_back(self):
        problem = exemplar.Problem({**BAR, "Obstacles": {"floor": {"Shape": FLOOR}}})
        problem.goto(0.1)
        state = problem.state
        problem.add_obstacle("wall", "plane 3 0 0 -1 0 0")
        problem.goto(0.3)
        at_end = problem.positions.copy()
        problem.state = state
        self.assertEqual(sorted(problem.obstacles), ["floor", "wall"])
        problem.goto(0.3)
        self.assertLess(np.abs(problem.positions - at_end).max(), 1e-9)

    def test_what_is_refused_changes_nothing(self):
        problem = exemplar.Problem({**BAR, "Obstacles": {"floor": {"Shape": FLOOR}}})
        problem.step()
        for words, call in (("already", ("floor", FLOOR)), ("m deep", ("wall", "plane 0.5 0 0 -1 0 0")), ("Allowed: plane", ("wall", "cone 1")),
                            ("of no file", ("wall", "surface wall.obj")), ("a tuple", ("wall", 3)), ("tuple", ("wall", (1, 2, 3))),
                            ("triangle 0 has the vertex 7", ("wall", (np.zeros((3, 3)), [(0, 1, 7)]))),
                            ("more than a quarter", ("wall", "plane 9 0 0 -1 0 0", "-100*t; 0; 0"))):
            with self.subTest(words), self.assertRaisesRegex(exemplar.UserError, words):
                problem.add_obstacle(*call)
        self.assertEqual(sorted(problem.obstacles), ["floor"])
        with self.assertRaisesRegex(exemplar.UserError, "interpolation"):
            exemplar.Problem({"Scene": "interpolation", "Mesh": BAR["Mesh"], "Examples": {"Pose functions": "x; y; 2*z"}}).add_obstacle("floor", FLOOR)
        problem.step()


if __name__ == "__main__":
    unittest.main()
