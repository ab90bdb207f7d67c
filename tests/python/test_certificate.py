# SPDX-License-Identifier: GPL-3.0-or-later
"""problem.correction(): what a function of the equilibrium is, from a state beside it."""
import unittest

import numpy as np

import exemplar

BENT = {"Scene": "static", "Mesh": {"Generator": "box", "Box size": [4, 1, 1], "Box cells": [8, 2, 2]},
        "Material": {"Poisson's ratio": 0.4}, "Time": {"Increments": 1},
        "Examples": {"Pose functions": [["(8/pi-z)*sin(pi*x/8)", "y", "8/pi-(8/pi-z)*cos(pi*x/8)"],
                                        ["1.2*x", "0.9*y", "0.9*z"]]},
        "Handles": {"left": {"Select": "boundary 1"}, "right": {"Select": "boundary 2", "Motion": [0.2, 0.1, 1]}}}
# stretched by 10 %, free to become thinner
STRETCHED = {"Scene": "static", "Mesh": {"Generator": "box", "Box size": [2, 1, 1], "Box cells": [3, 2, 2]},
             "Material": {"Poisson's ratio": 0.3}, "Solver": {"Tolerance": 1e-12}, "Time": {"Increments": 1},
             "Handles": {"left": {"Select": "boundary 1", "Components": "x"}, "floor": {"Select": "boundary 5", "Components": "z"},
                         "side": {"Select": "boundary 3", "Components": "y"},
                         "right": {"Select": "boundary 2", "Motion": [0.2, 0, 0], "Components": "x"}}}


def solved(base, **sections):
    problem = exemplar.Problem({**base, **{name: {**base.get(name, {}), **keys} for name, keys in sections.items()}})
    problem.run()
    return problem


class Corrections(unittest.TestCase):
    def test_loose_solves(self):
        """The corrected number of a loose solve is much nearer to that of a strict one."""
        random, ratios = np.random.default_rng(3), []
        for dilatation in "cells", "patches":
            for rule in {"Weights": "simplex"}, {"Weights": "free"}, {"Energy": "blended"}:
                sections = {"Model": {"Dilatation": dilatation}, "Examples": rule}
                exact = solved(BENT, **sections, Solver={"Tolerance": 1e-12})
                by_positions, by_weights = random.normal(size=exact.positions.shape), random.normal(size=len(exact.weights))

                def value(problem):
                    return (by_positions * problem.positions).sum() + by_weights @ problem.weights
                for tolerance in 1e-3, 1e-5:
                    with self.subTest(f"{dilatation}, {rule}, {tolerance}"):
                        loose = solved(BENT, **sections, Solver={"Tolerance": tolerance})
                        error = value(loose) - value(exact)
                        corrected = error + loose.correction(by_positions, by_weights)
                        self.assertGreater(abs(error), 1e-10)
                        self.assertLess(abs(corrected), 0.05 * abs(error))
                        ratios.append(abs(error / corrected))
                self.assertLess(abs(exact.correction(by_positions, by_weights)), 1e-9)
        self.assertGreater(np.median(ratios), 300)

    def test_closed_form(self):
        """Beside a uniform stretch, what stays is of second order in the distance."""
        problem = solved(STRETCHED)
        exact, saved, far_side = problem.positions.copy(), problem.state, problem.rest_positions[:, 2] == 0.5
        np.testing.assert_allclose(np.ptp(exact[:, 2]), 1 - 0.3 * 0.1, rtol=1e-10)
        held = np.abs(exact - problem.rest_positions * [1.1, 0, 0]) < 1e-12
        held[:, 0] |= (problem.rest_positions[:, 0] == 0) | (problem.rest_positions[:, 0] == 2)
        held[:, 1] |= problem.rest_positions[:, 1] == -0.5
        held[:, 2] |= problem.rest_positions[:, 2] == -0.5
        noise = np.where(held, 0, np.random.default_rng(1).normal(size=exact.shape))
        by_positions = np.outer(far_side, [0, 0, 1]) / far_side.sum()
        left = []
        for size in 1e-2, 1e-3:
            problem.state = saved.replace(positions=exact + size * noise)
            value = (by_positions * problem.positions).sum()
            left.append(value + problem.correction(by_positions) - (0.5 - 0.3 * 0.1))
            self.assertLess(abs(left[-1]), 0.1 * abs(value - (0.5 - 0.3 * 0.1)))
        self.assertAlmostEqual(left[0] / left[1], 100, delta=30)

    def test_predicts_changes(self):
        """After a change, without a step, it is the change's effect to first order."""
        problem = solved(BENT, Solver={"Tolerance": 1e-12})
        by_positions = np.random.default_rng(3).normal(size=problem.positions.shape)
        gradient = problem.vjp(by_positions)["gravity"] @ [0, 0, -0.01]
        positions = problem.positions.copy()
        problem.gravity = [0, 0, -0.01]
        self.assertAlmostEqual(problem.correction(by_positions) / gradient, 1, delta=1e-6)
        np.testing.assert_array_equal(problem.positions, positions)

    def test_refused(self):
        moved = solved(BENT)
        moved.set_motion("right", lambda rest, t: 0 * rest + [0, 0, 0.1])
        with self.assertRaisesRegex(exemplar.UserError, "not where their motions put them"):
            moved.correction(None)
        with self.assertRaisesRegex(exemplar.SolverFailure, "Scale J"):
            solved(BENT).correction(np.full(moved.positions.shape, 1e308))
        with self.assertRaisesRegex(exemplar.UserError, "not static"):
            solved({**BENT, "Scene": "dynamic", "Time": {"Step": 0.1, "End": 0.1}}).correction(None)
        problem = solved(BENT)
        with self.assertRaisesRegex(exemplar.UserError, "correction: dJ_dx"):
            problem.correction(np.zeros(3))
        with self.assertRaisesRegex(TypeError, "correction is called"):
            problem.correction()
        with self.assertRaisesRegex(exemplar.UserError, "Output/Functional = 'reaction_nose_x' is not allowed: no handle is called 'nose'"):
            exemplar.Problem({**BENT, "Output": {"Functional": "reaction_nose_x"}})


if __name__ == "__main__":
    unittest.main()
