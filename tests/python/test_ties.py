# SPDX-License-Identifier: GPL-3.0-or-later
"""Ties in Python: their energy and forces by their formula, forces without moment, and no gradients."""
import unittest

import numpy as np

import exemplar

E = 1e5
TIED = {"Scene": "static", "Material": {"Young's modulus": E, "Poisson's ratio": 0.3},
        "Handles": {"left": {"Select": "box -0.1 -9 -9  0.1 9 9"}},
        "Ties": {"glue": {"Select": "region 2", "To": "region 1", "Reach": 0.3}}}
CUBE = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
CELLS = np.array([[0, 4, 6, 7], [0, 6, 2, 7], [0, 2, 3, 7], [0, 3, 1, 7], [0, 1, 5, 7], [0, 5, 4, 7]])


def two_cubes(gap=0.2):
    nodes = np.vstack([CUBE, CUBE * [1, 0.5, 0.5] + [1 + gap, 0.2, 0.25]])
    return nodes, np.vstack([CELLS, CELLS + 8])


def problem_of(ties=None, **more):
    nodes, cells = two_cubes()
    regions = {"Ties": {"glue": {**TIED["Ties"]["glue"], "Select": "box 1.1 0 0  1.3 1 1", "To": "box -0.1 -0.1 -0.1  1.05 1.1 1.1", **(ties or {})}}}
    return exemplar.Problem({**TIED, **regions, **more}, mesh=(nodes, cells)), nodes


class Ties(unittest.TestCase):
    def test_energy_by_its_formula(self):
        """The free face of the first cube carries four nodes, extrapolated from the cells behind it."""
        stiffness, area = 1e4, 0.25
        problem, rest = problem_of({"Stiffness": stiffness})
        without, _ = problem_of({"Stiffness": 1e-12})
        np.testing.assert_allclose(problem.energy(rest), 0, atol=1e-12)
        moved = rest.copy()
        moved[8:] += [0.01, -0.02, 0.03]  # the second cube alone
        expected = 0.5 * stiffness * area * (0.01 ** 2 + 0.02 ** 2 + 0.03 ** 2)
        self.assertAlmostEqual(problem.energy(moved) - without.energy(moved), expected, delta=1e-9 * expected)
        stretched = rest * [1.1, 0.9, 1.2]  # what is affine pulls nothing
        self.assertAlmostEqual(problem.energy(stretched), without.energy(stretched), delta=1e-9 * without.energy(stretched))

    def test_forces_are_derivatives_and_have_no_moment(self):
        problem, rest = problem_of({"Stiffness": 1e5})
        r = np.random.default_rng(1)
        for _ in range(5):
            x, d = rest + 0.1 * r.standard_normal(rest.shape), r.standard_normal(rest.shape)
            force = problem.gradient(x)
            eps = 1e-6
            slope = (problem.energy(x + eps * d) - problem.energy(x - eps * d)) / (2 * eps)
            self.assertAlmostEqual(slope, (force * d).sum(), delta=1e-6 * abs(force).max())
            change = (problem.gradient(x + eps * d) - problem.gradient(x - eps * d)) / (2 * eps)
            np.testing.assert_allclose(problem.hessian(x) @ d.ravel(), change.ravel(), atol=1e-5 * abs(change).max())
            np.testing.assert_allclose(force.sum(0), 0, atol=1e-9 * abs(force).max())
            np.testing.assert_allclose(np.cross(x, force).sum(0), 0, atol=1e-9 * abs(force).max())

    def test_rigid_ties_follow_the_material(self):
        problem, rest = problem_of()
        moved = rest.copy()
        moved[8:] += [0.01, 0, 0]
        before = problem.energy(moved)
        problem.set_material(young=2 * E)
        self.assertAlmostEqual(problem.energy(moved), 2 * before, delta=1e-9 * before)

    def test_there_are_no_gradients(self):
        problem, rest = problem_of()
        problem.step()
        with self.assertRaisesRegex(exemplar.UserError, "no gradients of bodies that are tied yet. Leave Ties/Names empty"):
            problem.vjp(np.zeros_like(rest))

    def test_several_meshes_from_files_only(self):
        with self.assertWarnsRegex(Warning, "Mesh/Files = a.msh does nothing, as mesh= is given"):
            exemplar.Problem({"Scene": "dynamic", "Mesh": {"Files": "a.msh"}}, mesh=two_cubes())


if __name__ == "__main__":
    unittest.main()
