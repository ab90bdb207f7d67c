# SPDX-License-Identifier: GPL-3.0-or-later
"""Gradients of static equilibria of all elements, laws and examples, against differences of equilibria."""
import itertools
import unittest

import numpy as np

import test_gradients  # by name its tests would be taken for some of this file
from test_gradients import CELLS, NODES, POSES, scene

DILATATIONS = {"cells": {"Dilatation": "cells"}, "patches": {"Dilatation": "patches"}}
FIBRES = {"Fibre stiffness": 8e4, "Fibre direction": "1; 0.3; -0.2"}
ORTHOTROPY = {**FIBRES, "Fibre stiffness": 0, "Orthotropy": "2e5, 1e5, 0.7e5, 0.3, 0.25, 0.2, 0.3e5, 0.4e5, 0.5e5",
              "Cross direction": "0; 0; 1"}
PRESCRIBED = {"Weights": "prescribed", "Prescribed weights": "0.1; 0.2; 0.3; 0.4"}


class OfLaws(unittest.TestCase):
    check = test_gradients.Differences.check

    def check_both(self, model=None, is_near=False, **sections):
        for name, dilatation in DILATATIONS.items():
            with self.subTest(name):
                self.check(scene(Model={**dilatation, **(model or {})}, **sections), is_near=is_near)

    def test_quadratic_elements(self):
        self.check_both({"Element": "P2"}, Examples={"Energy": "blended", "Weights per region": True})

    def test_fibres(self):
        self.check_both(Material=FIBRES)

    def test_orthotropy(self):
        self.check_both(Material=ORTHOTROPY)

    def test_neo_hookean_background(self):
        self.check_both({"Background": "neo-hookean"}, Examples={"Energy": "blended"})
        self.check(scene(Model={"Background": "neo-hookean", "Element": "P2"}, Examples={"Energy": "blended"}))

    def test_other_strains(self):
        self.check_both({"Strain": "linear"})
        self.check(scene(Model={"Strain": "green"}))

    def check_parts_of_the_strain(self, material):
        for part in "shape", "volume", "along fibres", "across fibres":
            with self.subTest(part):
                self.check_both(is_near=True, Material=material, Examples={"Acts on": part, "Weights": "free"})

    def test_examples_of_a_part_of_the_strain(self):
        self.check_parts_of_the_strain(FIBRES)

    def test_examples_of_a_part_of_the_strain_and_orthotropy(self):
        self.check_parts_of_the_strain(ORTHOTROPY)

    def test_examples_with_an_elasticity_of_their_own(self):
        for material in {}, FIBRES:
            for own in {"Example modulus": 3e4}, {"Example Poisson ratio": 0.2}, {"Example modulus": 2e5, "Example Poisson ratio": 0.1}:
                with self.subTest(f"{material}, {own}"):
                    self.check_both(Material=material, Examples={**own, "Energy": "blended"})

    def test_importance_of_regions(self):
        for energy in "scaled", "blended":
            with self.subTest(energy):
                self.check_both(Material={"region 2": {"Importance factor": 0.6}}, Examples={"Energy": energy})

    def test_weights_that_remember(self):
        for price in 1., 30., 300.:
            with self.subTest(price):
                self.check_both(Examples={"Yield": price})


def pinched(length, thickness):
    """Both ends, where a bar so long is so thin."""
    return lambda nodes: np.stack([length * nodes[:, 0], *(0.5 + thickness * (nodes[:, 1:] - 0.5).T)], axis=1)


def stretches(problem):
    """(p, |F|^2) of the cells, with p of Eq. (16)."""
    def edges(nodes):
        return np.moveaxis(nodes[CELLS[:, 1:]] - nodes[CELLS[:, :1]], 1, 2)
    F = edges(problem.positions) @ np.linalg.inv(edges(NODES))
    s = np.linalg.svd(F, compute_uv=False)
    s[:, 2] *= np.sign(np.linalg.det(F))
    return (s[:, 0] + s[:, 1]) * (s[:, 1] + s[:, 2]) * (s[:, 2] + s[:, 0]), (F**2).sum(axis=(1, 2))


class Guarded(unittest.TestCase):
    check = test_gradients.Differences.check
    MATERIALS = {"isotropic": {}, "fibres": FIBRES, "orthotropy": ORTHOTROPY}

    def both(self, keys, **of_case):
        cases = []
        for name, dilatation in DILATATIONS.items():
            with self.subTest(name):
                cases.append(self.check(scene(**{**keys, "Model": {**dilatation, **keys.get("Model", {})}}),
                                        is_near=True, **of_case))
        return [stretches(case.problem) for case in cases]

    def test_collapsed_cells(self):
        """Those of Eq. (16), and with patches thin ones."""
        for name, material in self.MATERIALS.items():
            with self.subTest(name):
                for p, _ in self.both({"Material": material, "Examples": PRESCRIBED}, targets_of=pinched(0.9, 0.08)):
                    self.assertGreater(np.sum(p < 0.8), 2)
        with self.subTest("free weights"):
            for p, _ in self.both({"Examples": {"Weights": "free", "Energy": "blended"}}, targets_of=pinched(0.9, 0.08)):
                self.assertGreater(np.sum(p < 0.8), 2)

    def test_example_that_says_where_the_guard_begins(self):
        poses = [*POSES[:2], 0.52 * NODES + 0.01 * NODES[:, :1]**2]
        for p, _ in self.both({"Examples": PRESCRIBED},
                                    poses=poses, targets_of=pinched(0.9, 0.08)):
            self.assertGreater(np.sum(p < 0.4), 2)

    def test_stretched_cells(self):
        """Of Eq. (24), and with patches of Eq. (26)."""
        for name, material in {"isotropic": {}, "orthotropy": ORTHOTROPY}.items():
            with self.subTest(name):
                for p, square in self.both({"Material": material, "Examples": PRESCRIBED}, targets_of=pinched(3.3, 0.05)):
                    self.assertGreater(np.sum((p < 0.4 * square) & (square > 9)), 10)

    def test_stretched_patches_of_a_stretched_example(self):
        poses = [*POSES[:2], np.stack([2.6 * NODES[:, 0], *NODES[:, 1:].T], axis=1)]
        for _, square in self.both({"Examples": PRESCRIBED}, poses=poses, targets_of=pinched(3.4, 0.05)):
            self.assertGreater(np.sum(square > 8), 20)

    def test_other_elements_and_backgrounds(self):
        for model, pinch in itertools.product([{"Element": "P2"}, {"Background": "neo-hookean"}], [(0.9, 0.08), (3.6, 0.05)]):
            with self.subTest(f"{model}, {pinch}"):
                for p, square in self.both({"Model": model, "Examples": {**PRESCRIBED, "Energy": "blended"}}, targets_of=pinched(*pinch)):
                    self.assertGreater(max(np.sum(p < 0.8), np.sum(p < 0.4 * square)), 5)


if __name__ == "__main__":
    unittest.main()
