# SPDX-License-Identifier: GPL-3.0-or-later
"""Active fibres through the doors of scenes: several processes, resume, painted maps, presets, and vectors by commas or semicolons."""

import unittest

import numpy as np
from exemplar_runner import SceneTest, nodes_of, read_csv, timeless_statistics
from mpirun import launch

E, T = 1e6, 2e5
ALONG = {"Scene": "static", "Mesh/Generator": "box", "Mesh/Box size": "4, 1, 1", "Mesh/Box cells": "4, 1, 1", "Time/Increments": "2",
         "Material/Young's modulus": f"{E}", "Material/Poisson's ratio": "0", "Material/Fibre tension": f"{T}*t",
         "Material/Fibre direction": "1; 0; 0", "Handles/Names": "left", "Handles/left/Select": "boundary 1", "Output/Every": "0",
         "Solver/Tolerance": "1e-12"}
BEATING = {**{k: v for k, v in ALONG.items() if k != "Time/Increments"}, "Scene": "dynamic", "Time/Step": "0.005", "Time/End": "0.1",
           "Material/Fibre tension": "1e5*(1+sin(60*t))", "Solver/Step tolerance": "1e-9"}
# the box as a surface, with a tension painted on it
CORNERS = [(x, y, z) for x in (0, 4) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]
FACES = [(1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4)]


class Tension(SceneTest):
    def places(self, output):
        return np.array(list(nodes_of(output / "final.msh").values()))

    def lengths(self, output):
        return self.places(output)[:, 0].max()

    def test_the_length_of_a_bar_and_its_energy(self):
        for direction in ("1; 0; 0", "1, 0, 0"):
            output = self.solve({**ALONG, "Material/Fibre direction": direction})
            self.assertAlmostEqual(self.lengths(output), 4 * (1 - T / E), delta=1e-8)  # E e = -T
        self.assertAlmostEqual(read_csv(output)[-1]["energy_tension"], -4 * T * T / E, delta=1e-6 * 4 * T * T / E)

    def test_a_preset_stands_for_its_numbers(self):
        by_name = {k: v for k, v in ALONG.items() if "ratio" not in k and "modulus" not in k}
        named = self.solve({**by_name, "Material/Preset": "muscle", "Material/Fibre tension": "100*t"})
        lines = (named / "parameters.prm").read_text().splitlines()
        keys = {key: line.split("= ")[1] for key in ("Young's modulus", "Poisson's ratio") for line in lines if line.split("=")[0].strip() == f"set {key}"}
        numbers = self.solve({**by_name, "Material/Fibre tension": "100*t", "Material/Young's modulus": keys["Young's modulus"],
                              "Material/Poisson's ratio": keys["Poisson's ratio"]}, output="numbers", file="numbers.prm")
        np.testing.assert_array_equal(self.places(named), self.places(numbers))
        self.assertLess(self.lengths(named), 4)

    def test_several_processes_give_the_same(self):
        for scene in (ALONG, BEATING, {**BEATING, "Material/Fibre tension curve": "0.4: 0; 1: 1; 1.6: 0", "Solver/Method": "newton"}):
            run = self.attempt(scene)
            self.assertEqual(run.status, 0, run.stderr)
            shared = launch(2, self.directory / "scene.prm", "--output", self.directory / "shared", "--quiet")
            self.assertEqual(shared[0], 0, shared[1])
            np.testing.assert_allclose(self.places(self.directory / "shared"), self.places(run.output), atol=1e-6)
            np.testing.assert_allclose(read_csv(self.directory / "shared")[-1]["energy_tension"], read_csv(run.output)[-1]["energy_tension"], rtol=1e-5)

    def test_resume_and_threads_leave_the_bytes(self):
        whole = self.solve(BEATING, output="whole")
        self.assertEqual(timeless_statistics(whole), timeless_statistics(self.solve(BEATING, "--threads", "1", output="one")))
        self.solve({**BEATING, "Time/End": "0.05"}, output="half")
        half = self.solve(BEATING, "--resume", output="half")
        self.assertEqual(timeless_statistics(whole), timeless_statistics(half))
        self.assertEqual((whole / "final.msh").read_bytes(), (half / "final.msh").read_bytes())

    def test_a_painted_map_scales_it(self):
        skin = "".join("v {} {} {}\n".format(*x) for x in CORNERS) + "".join("f {} {} {} {}\n".format(*f) for f in FACES)
        (self.directory / "skin.obj").write_text(skin)
        painted = {**ALONG, "Mesh/Surface": "skin.obj", "Material/Fibre tension map": "tension.csv"}
        for value in (0.5, 0):
            (self.directory / "tension.csv").write_text("".join(f"{value}\n" for _ in CORNERS))
            self.assertAlmostEqual(self.lengths(self.solve(painted)), 4 * (1 - value * T / E), delta=1e-8)
        (self.directory / "tension.csv").write_text("".join(f"{0 if x == 0 else 1}\n" for x, *_ in CORNERS))
        ends = self.places(self.solve(painted))[:, 0]  # it grows from none at the held end
        self.assertLess(ends.max(), 4 * (1 - 0.4 * T / E))
        self.assertGreater(ends.max(), 4 * (1 - 0.6 * T / E))

    def test_a_region_alone(self):
        from piece_boxes import Box, write_boxes
        write_boxes(self.directory / "a.msh", Box((0, 0, 0), (4, 1, 1), (4, 1, 1)))
        write_boxes(self.directory / "b.msh", Box((0, 0, 2), (4, 1, 3), (4, 1, 1)))
        scene = {k: v for k, v in ALONG.items() if "Box" not in k and "Generator" not in k and "Fibre" not in k}
        output = self.solve({**scene, "Mesh/Files": "a.msh, b.msh", "Handles/left/Select": "box -1 -1 -1 1e-9 9 9",
                             "Material/region b/Fibre tension": f"{T}", "Material/region b/Fibre direction": "1, 0, 0"})
        places = self.places(output)
        self.assertAlmostEqual(places[:20, 0].max(), 4, delta=1e-9)
        self.assertAlmostEqual(places[20:, 0].max(), 4 * (1 - T / E), delta=1e-8)

    def test_a_session_sets_it_by_region(self):
        (self.directory / "session.txt").write_text("exemplar session 1\n1 | tension | Material | | 20000\n11 | tension | Material | | 0\n")
        scene = {**BEATING, "Time/Mass damping": "200", "Time/End": "0.05", "Session/File": "session.txt", "Material/Fibre tension": "0*t+1e5",
                 "Time/Scheme": "implicit euler"}
        early = self.solve(scene)
        self.assertLess(self.lengths(early), 4)
        constant = self.solve({**{k: v for k, v in scene.items() if k != "Session/File"}, "Material/Fibre tension": "20000"}, output="constant", file="constant.prm")
        np.testing.assert_array_equal(self.places(early), self.places(constant))
        for line, words in (("1 | tension | arm | | 1", "there are no active fibres in the region 'arm'. Allowed: Material"),
                            ("1 | tension | Material | | -1", "fibres do not push")):
            (self.directory / "session.txt").write_text(f"exemplar session 1\n{line}\n")
            run = self.attempt(scene)
            self.assertEqual(run.status, 1)
            self.assertIn(words, run.stderr)


if __name__ == "__main__":
    unittest.main()
