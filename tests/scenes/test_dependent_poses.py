# SPDX-License-Identifier: GPL-3.0-or-later
"""Weights of poses whose strains nearly cancel: a beam with the poses bent up and bent down."""

import shutil
import unittest

from exemplar_runner import SceneTest, greatest_distance, has_trilinos, nodes_of, read_csv, read_summary
from mpirun import launch


def arc(curvature):
    """The beam of 1 m bent to an arc, its middle line as long as before."""
    k = curvature
    return f"sin({k}*x)/({k})-z*sin({k}*x); y; (1-cos({k}*x))/({k})+z*cos({k}*x)"


BEAM = {
    "Scene": "static", "Mesh/Generator": "box", "Mesh/Box size": "1, .1, .1", "Mesh/Box cells": "10, 1, 1",
    "Material/Young's modulus": "1e6", "Material/Poisson's ratio": ".3", "Material/Density": "1000",
    "Examples/Pose functions": f"{arc(.6)} | {arc(-.6)}",
    "Handles/Names": "left", "Handles/left/Select": "boundary 1",
    "Loads/Names": "tip", "Loads/tip/Select": "boundary 2", "Time/Increments": "10", "Solver/Tolerance": "1e-11", "Output/Every": "0",
}
SWINGING = {**BEAM, "Material/Young's modulus": "1e7", "Scene": "dynamic", "Loads/Names": None, "Loads/tip/Select": None, "Time/Increments": None, "Time/Step": ".005",
            "Time/End": ".8", "Solver/Tolerance": "1e-9", "Solver/Method": "newton", "Initial/Velocity": "0; 0; 2*x^2"}
WORDS = ("a combination of their strains is only", "A penalty along this combination prefers the rest pose", "positions change by up to some")


class DependentPoses(SceneTest):
    def run_with_warning(self, scene, output="out", words=WORDS):
        run = self.attempt(scene, output=output)
        self.assertEqual(run.status, 0, run.stderr)
        for word in words:
            self.assertIn(word, run.stderr)
        rows = read_csv(run.output)
        return run.output, [[row[f"weight_{i}"] for i in range(3)] for row in rows]

    def test_static_weights_follow_the_load(self):
        """Up and down take the same part, one at a time, and in proportion to a small load."""
        _, up = self.run_with_warning({**BEAM, "Loads/tip/Force": "0; 0; t"}, "up")
        _, down = self.run_with_warning({**BEAM, "Loads/tip/Force": "0; 0; -t"}, "down")
        self.assertGreater(up[-1][1], .02)
        for step, (a, b) in enumerate(zip(up, down, strict=True)):
            self.assertLess(max(a[2], b[1]), 1e-9)
            self.assertAlmostEqual(a[1], b[2], delta=.02 * up[-1][1])
            self.assertAlmostEqual(a[1], step / 10 * up[-1][1], delta=.05 * up[-1][1])

    def test_one_state_has_one_set_of_weights(self):
        """After a load that rises, and after one that falls from twice as much."""
        rising, a = self.run_with_warning({**BEAM, "Loads/tip/Force": "0; .2*t; t"}, "rising")
        falling, b = self.run_with_warning({**BEAM, "Loads/tip/Force": "0; .2*t; -t+4*t*(1-t)+2*t"}, "falling")
        self.assertLess(greatest_distance(nodes_of(rising / "final.msh"), nodes_of(falling / "final.msh")), 1e-7)
        for x, y in zip(a[-1], b[-1]):
            self.assertAlmostEqual(x, y, delta=1e-6)

    def test_weights_of_a_swinging_beam_are_continuous(self):
        """They change by no more than three times as fast as the weight of a single pose does."""
        one = {**SWINGING, "Examples/Pose functions": f"{arc(.6)} | 1.1*x; y; z"}
        alone = read_csv(self.attempt(one, output="one").output)
        fastest = max(abs(b["weight_1"] - a["weight_1"]) for a, b in zip(alone, alone[1:]))
        _, weights = self.run_with_warning(SWINGING, "both")
        self.assertGreater(max(row[1] for row in weights), .05)
        self.assertGreater(max(row[2] for row in weights), .05)
        for a, b in zip(weights, weights[1:]):
            for x, y in zip(a, b):
                self.assertLess(abs(y - x), 3 * fastest)

    def test_additive_keys_that_cancel_stay_at_0(self):
        scene = {**SWINGING, "Examples/Weights": "additive"}
        run = self.attempt(scene)
        self.assertIn("prefers weights of 0", run.stderr)
        for row in read_csv(run.output):
            self.assertLess(min(row["weight_1"], row["weight_2"]), .01)

    @unittest.skipUnless(shutil.which("mpirun") and has_trilinos(), "without mpirun, or built without Trilinos")
    def test_two_processes(self):
        """They find the same combination and the same weights."""
        one = self.attempt({**BEAM, "Loads/tip/Force": "0; 0; t"}, "--quiet", output="one")
        status, own, done = launch(2, self.directory / "scene.prm", "--quiet", "--output", self.directory / "two")
        self.assertEqual((status, own), (0, one.stderr.splitlines()), done.stderr)
        for a, b in zip(read_csv(one.output), read_csv(self.directory / "two"), strict=True):
            for name in ("weight_0", "weight_1", "weight_2"):
                self.assertAlmostEqual(a[name], b[name], delta=1e-7)

    def test_regions_elements_and_patches(self):
        """The rule holds in each region, and in all elements."""
        for name, keys in {"patches": {"Model/Dilatation": "patches"}, "cells": {"Model/Dilatation": "cells"},
                           "quadratic": {"Model/Element": "P2"},
                           "found": {"Examples/Regions": "auto"}}.items():
            with self.subTest(name):
                run = self.attempt({**BEAM, "Loads/tip/Force": "0; 0; t", "Time/Increments": "2", **keys}, output=name)
                self.assertEqual(run.status, 0, run.stderr)
                self.assertIn("prefers the rest pose", run.stderr)
                for row in read_csv(run.output):
                    self.assertLess(row["weight_2" if "weight_2" in row else "weight_1_2"], 1e-9)
        self.assertIn("prefers the rest pose", "".join(read_summary(run.output)["warnings"]))


if __name__ == "__main__":
    unittest.main()
