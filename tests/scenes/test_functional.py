# SPDX-License-Identifier: GPL-3.0-or-later
"""Output/Functional: a number of the equilibrium, and how far a loose solve is from it."""

import json
import unittest

from exemplar_runner import SceneTest

# bent and sheared, with an example of unknown weight
BENT = {
    "Scene": "static",
    "Mesh/Generator": "box",
    "Mesh/Box size": "4, 1, 1",
    "Mesh/Box cells": "6, 2, 2",
    "Examples/Pose functions": "(8/pi-z)*sin(pi*x/8); y; 8/pi-(8/pi-z)*cos(pi*x/8)",
    "Examples/Importance": "0.8",
    "Handles/Names": "left, right hand",
    "Handles/left/Select": "boundary 1",
    "Handles/right hand/Select": "boundary 2",
    "Handles/right hand/Motion": "0; 0; t",
    "Handles/right hand/Components": "z",
    "Time/Increments": "1",
    "Output/Every": "0",
}
# E = 1e5 Pa, 1 m by 1 m, stretched by 10 % and free to become thinner
STRETCHED = {
    "Scene": "static",
    "Mesh/Generator": "box",
    "Mesh/Box size": "2, 1, 1",
    "Mesh/Box cells": "2, 1, 1",
    "Material/Young's modulus": "1e5",
    "Material/Poisson's ratio": "0.3",
    "Handles/Names": "left, right, side, floor",
    "Handles/left/Select": "boundary 1",
    "Handles/left/Components": "x",
    "Handles/right/Select": "boundary 2",
    "Handles/right/Components": "x",
    "Handles/right/Motion": "0.2*t; 0; 0",
    "Handles/side/Select": "boundary 3",
    "Handles/side/Components": "y",
    "Handles/floor/Select": "boundary 5",
    "Handles/floor/Components": "z",
    "Time/Increments": "1",
    "Output/Every": "0",
}


class Functional(SceneTest):
    def found(self, scene, **keys):
        summary = json.loads((self.solve({**scene, **keys}, output="out") / "summary.json").read_text())
        return summary.get("functional"), summary

    def test_closed_forms(self):
        expected = {"energy_elastic": 0.5 * 1e5 * 0.1**2 * 2, "reaction_right_x": 1e5 * 0.1,
                    "displacement_z of boundary 6": -0.3 * 0.1, "displacement_x of box 1 -1 -1  1 1 1": 0.1}
        for name, value in expected.items():
            with self.subTest(name):
                functional, summary = self.found(STRETCHED, **{"Output/Functional": name, "Solver/Tolerance": "1e-3"})
                self.assertEqual(functional["name"], name)
                self.assertAlmostEqual(functional["value"] + functional["correction"], value, delta=1e-9 * abs(value))
                self.assertIn("functional", summary["used"])

    def test_loose_solves(self):
        """With any tolerance the corrected number is that of a strict solve."""
        remembering = {**BENT, "Examples/Yield": "10"}
        for base, name in ((BENT, "energy_elastic"), (BENT, "reaction_right hand_z"), (BENT, "displacement_x of sphere 4 0 0.5 0.3"),
                           (remembering, "reaction_right hand_z")):
            exact, _ = self.found(base, **{"Output/Functional": name, "Solver/Tolerance": "1e-12"})
            self.assertLess(abs(exact["correction"]), 1e-10 * abs(exact["value"]))
            for tolerance, part in ("1e-2", 0.2), ("1e-3", 0.02), ("1e-5", 0.02):
                with self.subTest(f"{name}, {tolerance}, yield {base.get('Examples/Yield', 0)}"):
                    loose, _ = self.found(base, **{"Output/Functional": name, "Solver/Tolerance": tolerance})
                    error = loose["value"] - exact["value"]
                    self.assertLess(abs(error + loose["correction"]), part * abs(error) + 1e-10 * abs(exact["value"]))

    def test_values_are_those_of_columns(self):
        for name in "energy_elastic", "reaction_right hand_z", "reaction_right hand_x":
            output = self.solve({**BENT, "Output/Functional": name}, output="columns")
            value = json.loads((output / "summary.json").read_text())["functional"]["value"]
            header, *rows = [line.split(",") for line in (output / "statistics.csv").read_text().splitlines()]
            self.assertAlmostEqual(value, float(rows[-1][header.index(name)]), delta=1e-12 * abs(value))

    def test_none_is_asked_for(self):
        functional, summary = self.found(BENT)
        self.assertIsNone(functional)
        self.assertIn("functional", summary["left_out"])

    def test_a_squashed_body(self):
        """Where there is no correction, the value is there, and why."""
        functional, _ = self.found(STRETCHED, **{"Output/Functional": "energy_elastic", "Handles/right/Motion": "-1.9*t; 0; 0"})
        self.assertGreater(functional["value"], 0)
        self.assertNotIn("correction", functional)
        self.assertTrue(functional["failure"])

    def test_refused(self):
        for name, why in (("energy", "no functional"), ("reaction_hand_x", "there: left, right hand"),
                          ("displacement_x of box 9 9 9 10 10 10", "selects no node"), ("displacement_x of disc 3", "disc"),
                          ("displacement_x of vertex 3", "box, sphere, boundary or region"), ("displacement_w of boundary 1", "Allowed")):
            self.refuse({**BENT, "Output/Functional": name}, why)
        self.refuse({**BENT, "Output/Functional": "energy_elastic", "Scene": "dynamic"}, "not static")
        self.refuse({**BENT, "Output/Functional": "energy_elastic", "Model/Gradient": "frozen",
                     "Solver/Method": "fixed point"}, "cells that are frozen")

    def refuse(self, scene, why):
        with self.subTest(scene["Output/Functional"]):
            run = self.attempt(scene)
            self.assertEqual(run.status, 1)
            self.assertIn("Output/Functional", run.stderr)
            self.assertIn(why, run.stderr)


if __name__ == "__main__":
    unittest.main()
