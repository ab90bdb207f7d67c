# SPDX-License-Identifier: GPL-3.0-or-later
"""Gradients of bodies that meet each other, or themselves, against differences of equilibria and of steps."""
import unittest

import numpy as np

import exemplar

from test_gradients import bar, edges_of, with_middles
from test_gradients_of_contact import DYNAMIC, STATIC, AgainstDifferences, RecordedCase, scene

random = np.random.default_rng(31)
LOWER, LOWER_CELLS, _ = bar((3, 2, 2), random)
UPPER, UPPER_CELLS, _ = bar((2, 2, 1), random)


def two_bars(gap, turn, over=(0.6, 0.1)):
    """(nodes, cells) of a bar and, above it, a turned one."""
    c, s = np.cos(turn), np.sin(turn)
    upper = UPPER @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]) + [*over, 0]
    upper[:, 2] += LOWER[:, 2].max() + gap - upper[:, 2].min()
    return np.concatenate([LOWER, upper]), np.concatenate([LOWER_CELLS, UPPER_CELLS + len(LOWER)])


def materials(n, soft):
    """Of n cells, those of the upper bar `soft` times as stiff; None: all are."""
    draw = np.random.default_rng(3)
    factor = np.where(np.arange(n) < len(LOWER_CELLS), 1., soft) * draw.uniform(0.7, 1.3, n) if soft else np.ones(n)
    return {"young": 1e5 * factor, "poisson": draw.uniform(0.3, 0.4, n), "density": 900 * draw.uniform(0.7, 1.3, n)}


LOW, HIGH = LOWER[:, 2].min(), LOWER[:, 2].max()
PRESSED = {**STATIC, "Handles": {"lower": {"Select": f"box -9 -9 {LOW - 1} 9 9 {LOW + 0.2}"}, "upper": {"Select": f"box -9 -9 {HIGH + 0.6} 9 9 9"}}}
THROWN = {**DYNAMIC, "Initial": {}, "Time": {"Step": 0.02, "End": 0.2}}


class Case(RecordedCase):
    """Bars that meet, a function of all states, and what they depend on."""

    def __init__(self, base, mesh, contact, n_steps, soft=1., down=-0.06):
        self.nodes, self.cells = mesh
        self.base, self.contact, self.n_steps, self.down = base, contact, n_steps, down
        self.is_dynamic = base["Scene"] == "dynamic"
        edges = edges_of(self.cells)
        n = len(self.nodes) + len(edges) * (base.get("Model", {}).get("Element") == "P2")
        self.edges, self.n = edges, n
        self.material = materials(len(self.cells), soft)
        self.values = {**self.material, "rest_positions": self.nodes, "gravity": np.array([0.2, 0.1, -0.5]), "initial_positions": np.zeros((n, 3))}
        if self.is_dynamic:
            velocities = np.zeros((n, 3))
            velocities[len(LOWER):len(self.nodes)] = [0.3, 0.2, -1.5]
            self.values["initial_velocities"] = velocities
        else:
            self.values["handles"] = np.zeros(3)
        self.problem, self.trajectory = self.made()
        self.by_positions, self.by_velocities = random.normal(size=(2, len(self.trajectory), *self.nodes.shape))
        self.found = self.trajectory.vjp(list(self.by_positions), None, list(self.by_velocities) if self.is_dynamic else None)

    def made(self, **changes):
        v = {**self.values, **changes}
        problem = exemplar.Problem(scene(self.base, Contact=self.contact), mesh=(v["rest_positions"], self.cells))
        problem.set_material(**{name: v[name] for name in self.material})
        problem.gravity = v["gravity"]
        problem.state = problem.state.replace(positions=problem.state.positions + v["initial_positions"])
        if self.is_dynamic:
            problem.state = problem.state.replace(velocities=problem.state.velocities + v["initial_velocities"])
        else:
            problem.set_motion("upper", lambda rest, t: rest * 0 + v["handles"] + [0, 0, self.down * t])
        with problem.record() as trajectory:
            for _ in range(self.n_steps):
                problem.step()
        return problem, trajectory

    def gradient(self, name):
        """By what value() depends on; None: it is not known."""
        if name == "handles":
            upper = with_middles(self.problem.rest_positions, self.edges)[:self.n, 2] > HIGH + 0.6
            return self.found["handles"][upper].sum(axis=0)
        return self.by_rest_positions(self.edges) if name == "rest_positions" else self.found.get(name)


class Differences(AgainstDifferences, unittest.TestCase):
    def test_equilibria(self):
        for soft in 0.2, 1., 5., None:  # without a softer side each is so in half of the differences
            with self.subTest(soft):
                self.check(Case(PRESSED, two_bars(0.05, 0.3), {"Bodies": True, "Distance": 0.08}, 4, soft, down=-0.2))

    def test_steps(self):
        self.check(Case(THROWN, two_bars(0.05, 0.3), {"Bodies": True, "Distance": 0.04}, 5))

    def test_pairs_that_are_near_at_rest(self):
        self.check(Case(THROWN, two_bars(0.03, 0.3), {"Bodies": True, "Distance": 0.15}, 5))

    def test_edges_almost_parallel(self):
        self.check(Case(THROWN, two_bars(0.04, 0.02, (0.3, 0.)), {"Bodies": True, "Distance": 0.08}, 5))

    def test_the_body_and_itself(self):
        self.check(Case(THROWN, two_bars(0.03, 0.3), {"Self": True, "Distance": 0.1}, 5, 0.5))

    def test_quadratic_elements(self):
        self.check(Case({**PRESSED, "Model": {"Element": "P2"}}, two_bars(0.05, 0.3), {"Bodies": True, "Distance": 0.08}, 3, down=-0.2))


class Answers(unittest.TestCase):
    def test_one_equilibrium(self):
        """problem.vjp() and the trajectory's are the same."""
        case = Case(PRESSED, two_bars(0.05, 0.3), {"Bodies": True, "Distance": 0.08}, 4, down=-0.2)
        by_positions = case.by_positions[-1]
        of_steps, alone = case.trajectory.vjp([None] * 3 + [by_positions]), case.problem.vjp(by_positions)
        for name in "young", "rest_positions", "handles":
            np.testing.assert_allclose(of_steps[name], alone[name], rtol=1e-9, atol=1e-9 * np.abs(alone[name]).max())

    def test_friction_by_name(self):
        mesh = two_bars(0.05, 0.3)
        problem = exemplar.Problem(scene(THROWN, Contact={"Bodies": True, "Distance": 0.04, "Friction": 0.3}), mesh=mesh)
        with self.assertRaisesRegex(exemplar.UserError, "of friction between bodies, .* Set Contact/Friction to 0"):
            problem.record()


if __name__ == "__main__":
    unittest.main()
