# SPDX-License-Identifier: GPL-3.0-or-later
"""Terms of one's own: springs and a soft obstacle, against closed forms and a minimisation by numpy."""
import gc
import unittest
import weakref

import numpy as np

import exemplar

try:
    import scipy.sparse
except ImportError:
    raise SystemExit(0)  # Hessians need it

BAR = {"Scene": "static", "Mesh": {"Generator": "box", "Box size": [2, 1, 1], "Box cells": (4, 2, 2)}, "Material": {"Poisson's ratio": 0.3},
       "Handles": {"left": {"Select": "box 0 -1 -1 0 2 2"}}, "Loads": {"Gravity": [0, 0, -20]}, "Solver": {"Tolerance": 1e-11},
       "Time": {"Increments": 2}}
DYNAMIC = {**BAR, "Scene": "dynamic", "Time": {"Step": 0.02, "End": 0.2}}


def springs(pairs, stiffness, n):
    """k/2 |x_i - x_j|^2 between nodes: no length at rest."""
    rows = np.concatenate([np.stack([3 * pairs[:, 0] + c, 3 * pairs[:, 1] + c], axis=1) for c in range(3)])
    H = scipy.sparse.csr_array((3 * n, 3 * n))
    for i, j in rows:
        H = H + scipy.sparse.csr_array(([stiffness, -stiffness, -stiffness, stiffness], ([i, i, j, j], [i, j, i, j])), shape=(3 * n, 3 * n))

    def function(x, t):
        force = (H @ x.ravel()).reshape(-1, 3)
        return 0.5 * (x * force).sum(), force, H
    return function


def floor(height, stiffness):
    """k/2 depth^2 of the nodes below a height."""
    def function(x, t):
        depth = np.minimum(x[:, 2] - height, 0)
        force = np.zeros_like(x)
        force[:, 2] = stiffness * depth
        diagonal = np.zeros_like(x)
        diagonal[:, 2] = np.where(depth < 0, stiffness, 0)
        return 0.5 * stiffness * (depth**2).sum(), force, scipy.sparse.diags(diagonal.ravel())
    return function


class Terms(unittest.TestCase):
    def assert_is_minimum(self, problem, tolerance=1e-8):
        force = problem.gradient()
        free = problem.rest_positions[:, 0] > 0
        self.assertLess(np.abs(force[free]).max(), tolerance * np.abs(force).max())

    def test_springs_are_those_of_numpy(self):
        """Newton's method of numpy on the energy without the term, and the term beside it."""
        plain, problem = exemplar.Problem(BAR), exemplar.Problem(BAR)
        x0 = problem.rest_positions
        tip = np.flatnonzero(x0[:, 0] == 2)
        root = np.flatnonzero(x0[:, 0] == 0)
        term = springs(np.stack([tip, root[:len(tip)]], axis=1), 2e3, len(x0))
        problem.add_term(term)
        problem.run()
        plain.run()
        x = plain.positions.copy()
        free = np.repeat(x0[:, 0] > 0, 3)
        for _ in range(20):
            _, force, H = term(x, 1)
            r = (plain.gradient(x) + force).ravel()[free]
            A = (plain.hessian(x) + H).toarray()[np.ix_(free, free)]
            step = np.zeros(x.size)
            step[free] = np.linalg.solve(A, r)
            x -= step.reshape(-1, 3)
        self.assertLess(np.abs(r).max(), 1e-6)
        np.testing.assert_allclose(problem.positions, x, atol=1e-9)
        self.assertGreater(np.abs(problem.positions - plain.positions).max(), 1e-3)
        self.assertAlmostEqual(problem.energies["energy_term_1"] / term(x, 1)[0], 1, places=8)
        self.assert_is_minimum(problem)

    def test_a_rigid_fall_on_a_spring(self):
        """A stiff body that falls between springs to each node: m x'' = -m g - k x, by implicit Euler."""
        problem = exemplar.Problem({**DYNAMIC, "Handles": {}, "Material": {"Young's modulus": 1e8, "Density": 1000, "Mass matrix": "lumped"}})
        x0 = problem.rest_positions.copy()
        mass = problem.mass.diagonal().reshape(-1, 3)
        k = 400.0  # [1/s^2] a mass, so that nothing deforms

        def pull(x, t):
            u = x - x0
            return 0.5 * k * (mass * u * u).sum(), k * mass * u, scipy.sparse.diags(k * mass.ravel())
        problem.add_term(pull)
        z = v = 0.0
        h, g = 0.02, 20.0
        for _ in range(10):
            problem.step()
            v = (v - h * g - h * k * z) / (1 + h * h * k)
            z += h * v
            np.testing.assert_allclose(problem.positions - x0, np.tile([0, 0, z], (len(x0), 1)), atol=1e-9)

    def test_soft_obstacle(self):
        for of in BAR, {**BAR, "Model": {"Element": "P2"}}:
            with self.subTest(str(of)[-60:]):
                free, problem = exemplar.Problem(of), exemplar.Problem(of)
                problem.add_term(floor(-0.51, 1e6))
                free.run()
                problem.run()
                self.assertLess(free.positions[:, 2].min(), -0.53)
                self.assertGreater(problem.positions[:, 2].min(), -0.52)
                self.assertLess(problem.positions[:, 2].min(), -0.51)
                force = problem.gradient()
                free_nodes = problem.state.positions[:, 0] > 1e-6
                self.assertLess(np.abs(force[free_nodes]).max(), 1e-6 * np.abs(force).max())

    def test_derivatives_include_the_term(self):
        problem = exemplar.Problem(DYNAMIC)
        n = len(problem.rest_positions)
        problem.add_term(springs(np.array([[0, n - 1], [3, n - 2]]), 5e3, n))
        problem.step()
        random = np.random.default_rng(1)
        x, d, h = problem.positions + 1e-3 * random.standard_normal((n, 3)), random.standard_normal((n, 3)), 1e-6
        change = (problem.energy(x + h * d) - problem.energy(x - h * d)) / (2 * h)
        self.assertAlmostEqual(change / (problem.gradient(x) * d).sum(), 1, places=6)
        change = (problem.gradient(x + h * d) - problem.gradient(x - h * d)).ravel() / (2 * h)
        self.assertLess(np.abs(problem.hessian(x) @ d.ravel() - change).max() / np.abs(change).max(), 1e-6)

    def test_two_terms_and_time(self):
        problem = exemplar.Problem(BAR)
        n = len(problem.rest_positions)
        tip = np.flatnonzero(problem.rest_positions[:, 0] == 2)

        def lift(x, t):
            force = np.zeros((n, 3))
            force[tip, 2] = -100 * t
            return (force * x).sum(), force, None
        problem.add_term(lift)
        problem.add_term(floor(-0.52, 1e5))
        problem.run()
        other = exemplar.Problem(BAR)
        other.add_term(floor(-0.52, 1e5))
        forces = np.zeros((n, 3))
        forces[tip, 2] = 100
        other.nodal_forces = forces
        other.run()
        np.testing.assert_allclose(problem.positions, other.positions, atol=1e-9)
        self.assertIn("energy_term_2", problem.statistics)

    def test_state_and_reset(self):
        problem = exemplar.Problem(DYNAMIC)
        problem.add_term(floor(-0.501, 1e6))
        problem.step()
        before = problem.state
        problem.step()
        x = problem.positions.tobytes()
        problem.state = before
        problem.step()
        self.assertEqual(problem.positions.tobytes(), x)


class Failures(unittest.TestCase):
    def test_exception_leaves_the_problem_as_it_was(self):
        for of in BAR, {**DYNAMIC, "Solver": {"Method": "newton", "Tolerance": 1e-11}}:
            problem, same = exemplar.Problem(of), exemplar.Problem(of)
            term = floor(-0.501, 1e5)
            breaks = []

            def function(x, t):
                if breaks:
                    raise KeyError("broken")
                return term(x, t)
            problem.add_term(function)
            same.add_term(term)
            problem.step()
            same.step()
            before = problem.positions.tobytes()
            breaks.append(1)
            with self.assertRaisesRegex(KeyError, "broken"):
                problem.step()
            self.assertEqual(problem.positions.tobytes(), before)
            self.assertEqual(problem.step_number, 1)
            breaks.clear()
            problem.step()
            same.step()
            np.testing.assert_allclose(problem.positions, same.positions, atol=1e-9)

    def test_what_a_function_must_return(self):
        problem = exemplar.Problem(BAR)
        n = len(problem.rest_positions)
        zero = np.zeros((n, 3))
        skew = scipy.sparse.csr_array(([1.0], ([0], [1])), shape=(3 * n, 3 * n))
        for wrong, message in ((None, "energy, gradient, hessian"), (("a", zero, None), "finite number"), ((np.nan, zero, None), "finite number"),
                               ((0, zero[1:], None), "gradient"), ((0, zero, np.zeros((3 * n, 3 * n))), "csr_array"),
                               ((0, zero, scipy.sparse.eye(n)), "shape"), ((0, zero, skew), "symmetric")):
            with self.subTest(message), self.assertRaisesRegex(exemplar.UserError, message):
                problem.add_term(lambda x, t: wrong)
        with self.assertRaisesRegex(TypeError, "but is"):
            problem.add_term(3)
        with self.assertRaisesRegex(TypeError, "add_term calls function"):
            problem.add_term(lambda x: x)
        self.assertNotIn("energy_term_1", problem.energies)
        problem.run()

    def test_new_couplings_within_a_step(self):
        problem = exemplar.Problem({**BAR, "Model": {"Dilatation": "cells"}})  # patches couple more nodes
        n = len(problem.rest_positions)
        ends = np.flatnonzero(problem.rest_positions[:, 0] == 2)[[0, -1]]  # of a diagonal
        whole = springs(ends[None], 1.0, n)
        start = problem.positions.tobytes()

        def function(x, t):
            energy, force, H = whole(x, t)
            return energy, force, None if x.tobytes() == start else H
        problem.add_term(function)
        always = exemplar.Problem({**BAR, "Model": {"Dilatation": "cells"}})
        always.add_term(whole)
        for one in problem, always:
            self.assertEqual(one.step().status, "converged")
        self.assertLess(np.abs(problem.positions - always.positions).max(), 1e-9)

    def test_garbage(self):
        class Function:
            def __init__(self, problem):
                self.problem = problem

            def __call__(self, x, t):
                return 0, np.zeros_like(x), None
        problem = exemplar.Problem(BAR)
        function = Function(problem)
        problem.add_term(function)
        problem.step()
        problem.energy()
        kept = weakref.ref(function)
        del problem, function
        gc.collect()
        self.assertIsNone(kept())


if __name__ == "__main__":
    unittest.main()
