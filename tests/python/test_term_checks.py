# SPDX-License-Identifier: GPL-3.0-or-later
"""Terms of one's own that are wrong are named: by check_term(), in the first step in which they act, and where a step fails."""
import unittest

import numpy as np

import exemplar
from test_terms import BAR, DYNAMIC, floor, springs

try:
    import scipy.sparse
except ImportError:
    raise SystemExit(0)  # Hessians need it


def pulled(k=1e3, sign=1., factor=1., stiffness=1.):
    """Springs from each node to where it is at rest, and wrong versions of them."""
    rest = exemplar.Problem(BAR).rest_positions.copy()

    def function(x, t):
        u = x - rest - [0, 0, 0.1]
        return k / 2 * (u**2).sum(), sign * factor * k * u, stiffness * k * scipy.sparse.identity(u.size, format="csr")
    return function


def saddle(x, t):
    """Whose Hessian is that of its gradient, and not convex."""
    k = 1e6 * np.where(np.arange(x.size) % 3 == 2, -1., 1.)
    return (k * x.ravel()**2).sum() / 2, (k * x.ravel()).reshape(-1, 3), scipy.sparse.diags(k)


class Checks(unittest.TestCase):
    def setUp(self):
        self.problem = exemplar.Problem(BAR)
        self.n = len(self.problem.rest_positions)

    def refuse(self, term, words, **where):
        with self.assertRaisesRegex(exemplar.UserError, words):
            self.problem.check_term(term, **where)

    def test_right_ones(self):
        depth = 1e-2 * np.arange(self.n)[:, None] % 0.3
        places = {"at rest": None, "moved": self.problem.rest_positions - [0, 0, 1] * depth}
        pairs = np.array([[0, self.n - 1], [3, self.n - 2]])
        for kind, term in (("springs", springs(pairs, 1e3, self.n)), ("floor", floor(-0.55, 1e5)), ("a floor that touches", floor(-0.5, 1e5)),
                           ("pulled", pulled()), ("nothing", lambda x, t: (0., 0 * x, None)), ("force", lambda x, t: (t * x.sum(), t + 0 * x, None))):
            for where, positions in places.items():
                with self.subTest(kind + " " + where):
                    found = self.problem.check_term(term, positions=positions, time=0.5)
                    self.assertEqual(sorted(found), ["curvature", "gradient", "hessian"])
                    self.assertGreaterEqual(found["curvature"], -1e-6)
                    if kind in ("springs", "pulled", "force"):
                        self.assertLess(found["gradient"], 1e-7)
                        self.assertLess(found["hessian"], 1e-7)

    def test_wrong_ones_are_named(self):
        self.refuse(pulled(sign=-1), "the term function: its gradient is not that of its energy.* The sign is wrong")
        self.refuse(pulled(factor=1.01), "its gradient is not that of its energy at t = 0: .*check_term")
        self.refuse(lambda x, t: (*pulled()(x, t)[:2], None), "the term <lambda>: its Hessian is not that of its gradient")
        self.refuse(pulled(stiffness=.99), "Hessian is not that of its gradient.*softer")
        self.refuse(saddle, "the term saddle: its Hessian has a negative curvature.*-[0-9.e+]+ N/m.*Leave out")
        self.problem.add_term(floor(-0.7, 1e4))
        self.problem.add_term(pulled(sign=-1))
        self.refuse(2, "^term_2: its gradient")
        self.problem.check_term(1)

    def test_a_hessian_may_leave_out_what_is_not_convex(self):
        def convex_part(x, t):
            energy, force, H = saddle(x, t)
            return energy, force, scipy.sparse.diags(np.maximum(H.diagonal(), 0))
        found = self.problem.check_term(convex_part)
        self.assertLess(found["gradient"], 1e-6)
        self.assertGreater(found["hessian"], 0.1)

    def test_bad_arguments(self):
        self.refuse(3, r"check_term\(3\): terms are counted from 1.*0 were added")
        self.refuse(pulled(), r"check_term: positions must be an array of shape \(45, 3\)", positions=np.zeros((3, 3)))
        self.refuse(pulled(), "time must be finite", time=np.inf)
        self.refuse(lambda x, t: 3, "the term <lambda>: what the function returns .* must be energy, gradient, hessian")
        with self.assertRaisesRegex(TypeError, "but is a str"):
            self.problem.check_term("term_1")
        with self.assertRaisesRegex(TypeError, "check_term is called as"):
            self.problem.check_term()
        with self.assertRaisesRegex(ZeroDivisionError, "by zero"):
            self.problem.check_term(lambda x, t: 1 / 0)


class Steps(unittest.TestCase):
    def test_a_gradient_of_the_wrong_sign_is_named_in_the_first_step(self):
        for of in BAR, DYNAMIC:
            problem = exemplar.Problem(of)
            problem.add_term(floor(-0.7, 1e5))
            problem.add_term(pulled(sign=-1))
            before = problem.positions.tobytes()
            for _ in range(2):
                with self.assertRaisesRegex(exemplar.UserError, "^term_2: its gradient is not that of its energy.*The sign is wrong"):
                    problem.step()
            self.assertEqual((problem.positions.tobytes(), problem.step_number), (before, 0))
            problem.energy()  # may be looked at

    def test_a_term_that_acts_later_is_looked_at_then(self):
        ceiling = floor(-0.5001, 1e7)

        def wrong(x, t):
            energy, force, H = ceiling(x, t)
            return energy, -force, H
        problem = exemplar.Problem({**DYNAMIC, "Time": {"Step": 0.002, "End": 0.2}})
        problem.add_term(wrong)
        with self.assertRaisesRegex(exemplar.UserError, "^term_1: its gradient is not that of its energy"):
            problem.run()

    def test_a_step_that_fails_by_a_concave_term_names_it(self):
        for of in BAR, DYNAMIC:
            problem = exemplar.Problem(of)
            problem.add_term(floor(-0.7, 1e5))
            problem.add_term(saddle)
            with self.assertRaisesRegex(exemplar.SolverFailure, "^term_2: its Hessian has a negative curvature.* The step failed so: "):
                problem.run()

    def test_other_failures_blame_no_term(self):
        problem = exemplar.Problem({**BAR, "Solver": {"Maximum iterations": 1, "Method": "fixed point"}})
        problem.add_term(pulled())
        with self.assertRaises(exemplar.SolverFailure) as failure:
            problem.run()
        self.assertNotIn("term_", str(failure.exception))

    def test_two_more_calls_are_made_once(self):
        calls = []
        right = pulled()

        def counted(x, t):
            calls.append(t)
            return right(x, t)
        problem = exemplar.Problem(BAR)
        problem.add_term(counted)
        calls.clear()
        problem.step()
        first = len(calls)
        problem.reset()
        calls.clear()
        problem.step()
        self.assertLessEqual(first - len(calls), 2)


if __name__ == "__main__":
    unittest.main()
