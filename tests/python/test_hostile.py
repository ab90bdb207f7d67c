# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers, names and shapes that no computation can take: each is an error with a message that says why, and nothing is changed."""
import unittest
import warnings

import exemplar
import numpy as np

BOX = {"Generator": "box", "Box size": [1, .4, .4], "Box cells": [3, 1, 1]}
FREE = {"Scene": "dynamic", "Mesh": BOX, "Material": {"Young's modulus": 1e5}, "Time": {"Step": .01, "End": .02}}
FLOOR = "plane 0 0 -1 0 0 1"


def made(**sections):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return exemplar.Problem({**FREE, **sections})


class HostileTest(unittest.TestCase):
    def check(self, error, words, function, *arguments, **named):
        with self.assertRaisesRegex(error, words):
            function(*arguments, **named)

    def test_names(self):
        for name in ("", "a,b", "a\nb", "a\0b", "\t", " a", "a "):
            problem = made()
            with self.subTest(name):
                self.check(exemplar.UserError, "is not allowed. A name has", problem.add_obstacle, name, FLOOR)
                self.check(exemplar.UserError, "is not allowed. A name has", problem.hold, name, [0, 1, 2])
                self.check(exemplar.UserError, "is not allowed. A name has", problem.grab, name, [0], lambda rest, t: 0 * rest)
                self.assertEqual((problem.obstacles, problem.handles), ({}, {}))

    def test_friction(self):
        for friction in (1, 0.5, np.float32(0.25), np.int64(2)):
            problem = made()
            problem.add_obstacle("floor", FLOOR, friction=friction)
            self.assertIn("floor", problem.obstacles)
        for friction, words in ((float("nan"), "Friction = nan is not allowed"), (float("inf"), "Friction = inf"), (-1, "Friction = -1")):
            self.check(exemplar.UserError, words, made().add_obstacle, "floor", FLOOR, friction=friction)
        for friction in (None, "1", [1, 2], 1j):
            self.check(TypeError, "friction must be a number", made().add_obstacle, "floor", FLOOR, friction=friction)

    def test_motions_of_obstacles(self):
        """Of a new obstacle, and of a scene."""
        for keys, words in (({"Motion": "1/0; 0; 0"}, "formula '1/0' is not finite"), ({"Motion": "1e60*t; 0; 0"}, "too far"),
                            ({"Turn": "3e221*t; 0; 0"}, "rad"), ({"Turn": "0; 1e300*t; 1e300*t"}, "rad")):
            for shape in (FLOOR, "sphere 0 0 -3 1"):
                with self.subTest(shape=shape, **keys):
                    problem = made()
                    self.check(exemplar.UserError, words, problem.add_obstacle, "it", shape, **{key.lower(): text for key, text in keys.items()})
                    self.assertEqual(problem.obstacles, {})
                    self.check(exemplar.UserError, words, made, Obstacles={"it": {"Shape": shape, **keys}})

    def test_surfaces(self):
        point = np.zeros((3, 3)) - [0, 0, 1]
        self.check(exemplar.UserError, "all vertices of the surface are at one point", made().add_obstacle, "it", (point, [[0, 1, 2]]))

    def test_speeds(self):
        """A body that passes around an obstacle within a step."""
        for speed in (1e3, 1e9, 1e15):
            problem = made(Initial={"Velocity": [0, 0, -speed]}, Obstacles={"it": {"Shape": "sphere .5 .2 -3 2"}})
            with self.assertWarnsRegex(UserWarning, "in step [12], more than twice its size"):
                problem.run()
            self.assertTrue(np.isfinite(problem.positions).all())

    def test_recordings(self):
        for record in (5, 1.5, b"a", []):
            self.check(exemplar.UserError, "record is", made().live, record=record)

    def test_loads_at_once(self):
        scene = {"Scene": "static", "Loads": {"Gravity": [0, 0, -1e9]}, "Handles": {"left": {"Select": "box -1 -1 -1 1e-9 2 2"}}, "Time": {"Increments": 3},
                 "Solver": {"Maximum iterations": 1}}
        self.check(exemplar.SolverFailure, "Loads/Ramp = increments", made(**scene).run)

    def test_attributes(self):
        problem = made()
        for name, meant in (("postions", "positions"), ("weigths", "weights"), ("gravty", "gravity")):
            self.check(AttributeError, f"exemplar.Problem has no attribute '{name}'. Did you mean '{meant}'", getattr, problem, name)
        self.check(AttributeError, "Did you mean 'gravity'", setattr, problem, "gravty", [0, 0, 0])
        self.check(AttributeError, "Did you mean 'iterations'", getattr, problem.step(), "iteratons")
        self.assertFalse(hasattr(problem, "_anything"))

    def test_steps_beyond_the_end(self):
        problem = made()
        problem.run()
        self.assertIn("step 2 of 2,", repr(problem))
        problem.step()
        self.assertIn("step 3, 1 beyond the scene's end,", repr(problem))

    def test_motions_with_commas(self):
        """Of a handle that holds z alone: the check of other components splits the formulas as the parser does."""
        for motion, warns in (("0, 0, t", False), ("0; 0; t", False), ("t, 0, 0", True), ("max(0, t), 0, t", True)):
            with self.subTest(motion), warnings.catch_warnings():
                warnings.simplefilter("ignore")
                problem = exemplar.Problem({**FREE, "Handles": {"left": {"Select": "box -1 -1 -1 1e-9 2 2", "Motion": motion, "Components": "z"}}})
                self.assertEqual(any("moves along x" in warning for warning in problem.warnings), warns)


if __name__ == "__main__":
    unittest.main()
