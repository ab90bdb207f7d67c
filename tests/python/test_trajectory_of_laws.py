# SPDX-License-Identifier: GPL-3.0-or-later
"""Gradients through steps of all elements, laws and examples, and where guards act, against differences of steps.
doc/scripts/measure_gradients.py has more combinations."""
import unittest
import warnings

import numpy as np

import exemplar

from test_gradients import converged_difference
from test_gradients_of_laws import FIBRES, ORTHOTROPY, pinched
from test_trajectory import BY_POSITIONS, CELLS, DAMPED, NODES, SCENE, Case, difference, nodes_of, recorded, scene

EULER, BDF2 = DAMPED, {**DAMPED, "Scheme": "bdf2"}
PRESCRIBED = {"Weights": "prescribed", "Prescribed weights": "0.1+t; 0.2; 0.3-t; 0.4"}
SHORT = 8 * [None]


def products(positions):
    """p of Eq. (16) of the cells."""
    def edges(nodes):
        return np.moveaxis(nodes[CELLS[:, 1:]] - nodes[CELLS[:, :1]], 1, 2)
    F = edges(positions) @ np.linalg.inv(edges(NODES))
    s = np.linalg.svd(F, compute_uv=False)
    s[:, 2] *= np.sign(np.linalg.det(F))
    return (s[:, 0] + s[:, 1]) * (s[:, 1] + s[:, 2]) * (s[:, 2] + s[:, 0])


class OfLaws(unittest.TestCase):
    def check(self, lengths=SHORT, goals=None, **sections):
        case = Case(scene(**sections), lengths=lengths, **({} if goals is None else {"goals": goals}))
        self.assertEqual(case.found["weakly_active"], [])
        for name, (at, _, function) in case.parameters().items():
            direction = case.direction(name)
            if goals is None:
                expected = case.difference(function, at, direction)
            else:
                expected = converged_difference(function, at, direction, (1e-4, 2e-5, 4e-6), difference)
            found = case.derivative(name, direction)
            with self.subTest(name):
                self.assertLess(abs(found - expected), 1e-6 * abs(expected), (found, expected))
        return case

    def check_both(self, time=EULER, **sections):
        for dilatation in "cells", "patches":
            with self.subTest(dilatation):
                self.check(Time=time, **{**sections, "Model": {"Dilatation": dilatation, **sections.get("Model", {})}})

    def test_quadratic_elements(self):
        self.check_both(BDF2, Model={"Element": "P2"}, Examples={"Energy": "blended", "Weights per region": True})
        self.check(Model={"Element": "P2"}, Material={"Mass matrix": "lumped"})

    def test_fibres_and_orthotropy(self):
        self.check_both(Material=FIBRES)
        self.check_both(BDF2, Material=ORTHOTROPY)

    def test_neo_hookean_background(self):
        self.check_both(BDF2, Model={"Background": "neo-hookean"}, Examples={"Energy": "blended"})

    def test_other_strains(self):
        self.check_both(Model={"Strain": "linear"})
        self.check(Time=BDF2, Model={"Strain": "green"})

    def test_examples_of_a_part_with_an_elasticity_or_an_importance_of_their_own(self):
        self.check_both(Examples={"Acts on": "shape"})
        self.check_both(Examples={"Example modulus": 3e4, "Energy": "blended"})
        self.check_both(Material={"region 2": {"Importance factor": 0.6}})

    def test_guards(self):
        """Through steps in which cells begin to be guarded, and their damping ends."""
        for time, sizes, sections in ((EULER, (0.9, 0.08), {}), (BDF2, (3.3, 0.05), {"Model": {"Dilatation": "patches"}}),
                                      (BDF2, (0.9, 0.08), {"Model": {"Dilatation": "patches"}, "Material": ORTHOTROPY})):
            with self.subTest(f"{time}, {sizes}"):
                goals = pinched(*sizes)(NODES) - NODES
                case = self.check([0.05] * 8, goals, Time=time, Examples=PRESCRIBED, **sections)
                p = [np.sum(products(positions) < 0.8) for positions in case.trajectory.positions]
                self.assertEqual(p[0], 0)
                self.assertGreater(p[-1], 0)


class OfQuadraticElements(unittest.TestCase):
    BASE = scene(Model={"Element": "P2"})

    def test_rows(self):
        """Positions are those of the vertices, as problem.positions; what belongs to nodes has a row for each."""
        problem, trajectory = recorded(self.BASE, lengths=[None])
        n, n_all = len(NODES), len(nodes_of(self.BASE, NODES))
        self.assertEqual(trajectory.positions[0].shape, (n, 3))
        self.assertEqual(trajectory.velocities[0].shape, (n, 3))
        np.testing.assert_array_equal(trajectory.positions[0], problem.positions)
        found = trajectory.vjp([BY_POSITIONS[0]])
        shapes = {name: n_all for name in ("handles", "nodal_forces", "initial_positions", "initial_velocities")}
        self.assertEqual({name: len(found[name]) for name in shapes}, shapes)
        self.assertEqual((len(found["rest_positions"]), len(found["poses"][0])), (n, n_all))
        of_all = trajectory.vjp([np.concatenate([BY_POSITIONS[0], np.zeros((n_all - n, 3))])])
        np.testing.assert_array_equal(of_all["young"], found["young"])
        with self.assertRaisesRegex(exemplar.UserError, r"dJ_dx\[0\]"):
            trajectory.vjp([np.zeros((n_all - 1, 3))])

    def test_increments(self):
        """One of them is a static equilibrium."""
        base = scene({**SCENE, "Scene": "static", "Time": {"Increments": 1}, "Solver": {"Tolerance": 1e-12}}, Model={"Element": "P2"})
        problem, trajectory = recorded(base, lengths=[None])
        through, of_equilibrium = trajectory.vjp([BY_POSITIONS[0]]), problem.vjp(BY_POSITIONS[0])
        for name in "young", "rest_positions", "nodal_forces", "handles":
            np.testing.assert_allclose(through[name], of_equilibrium[name], rtol=1e-9, atol=1e-12 * np.abs(of_equilibrium[name]).max())


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    unittest.main()
