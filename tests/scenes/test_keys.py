# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes whose weights are additive: what they write, what they warn of, painted maps, and runs that go on under another rule."""

import unittest

from exemplar_runner import SceneTest, read_csv, read_summary, results
from surface_bar import bar_surface, obj_text

# A bar whose ends are keys, dragged at both.
SCENE = {
    "Scene": "static",
    "Mesh/Generator": "box",
    "Mesh/Box size": "8, 1, 1",
    "Mesh/Box cells": "16, 2, 2",
    "Material/Young's modulus": "1e5",
    "Material/Poisson's ratio": "0.3",
    "Examples/Pose functions": "x; y; z + (x < 2 ? 0.2*(2-x)^2 : 0) | x; y; z + (x > 6 ? 0.2*(x-6)^2 : 0)",
    "Examples/Importance": "0.95",
    "Examples/Weights": "additive",
    "Handles/Names": "middle, left, right",
    "Handles/middle/Select": "box 3 0 0 5 1 1",
    "Handles/left/Select": "box 0 0 0 0 1 1",
    "Handles/left/Motion": "0; 0; 0.8*t",
    "Handles/left/Components": "z",
    "Handles/right/Select": "box 8 0 0 8 1 1",
    "Handles/right/Motion": "0; 0; 0.8*t",
    "Handles/right/Components": "z",
    "Time/Increments": "4",
    "Output/Every": "0",
}
SQUEEZED = "x<1 ? 0.6*x : x-0.4; y; z"


class Keys(SceneTest):
    def columns(self, output):
        return [name for name in read_csv(output)[0] if name.startswith(("weight", "multiplier"))]

    def test_weights_of_both(self):
        output = self.solve(SCENE, "--quiet")
        self.assertEqual(self.columns(output), ["weight_1", "weight_2"])
        first, *_, last = read_csv(output)
        self.assertEqual((first["weight_1"], first["weight_2"]), (0., 0.))
        self.assertGreater(min(last["weight_1"], last["weight_2"]), 0.7)
        self.assertEqual(last["kkt_residual"], 0.)
        self.assertEqual(read_summary(output)["example_names"], ["rest pose", "example 1", "example 2"])
        shared = read_csv(self.solve({**SCENE, "Examples/Weights": "simplex"}, "--quiet", output="shared"))[-1]
        self.assertAlmostEqual(shared["weight_1"] + shared["weight_2"], 1., places=9)

    def test_one_key_alone_is_the_simplex_of_it_and_the_rest_pose(self):
        scene = {**SCENE, "Examples/Pose functions": SCENE["Examples/Pose functions"].split("|")[0], "Solver/Tolerance": "1e-10"}
        for energy in "scaled", "blended", "mixed":
            with self.subTest(energy):
                additive, simplex = (read_csv(self.solve({**scene, "Examples/Energy": energy, "Examples/Weights": rule}, "--quiet",
                                                         output=f"{energy}_{rule}"))[-1] for rule in ("additive", "simplex"))
                self.assertGreater(additive["weight_1"], 0.05)
                self.assertAlmostEqual(additive["weight_1"], simplex["weight_1"], delta=1e-6)
                self.assertAlmostEqual(additive["energy_elastic"], simplex["energy_elastic"], delta=1e-6 * simplex["energy_elastic"])

    def test_any_number_of_threads(self):
        one, two = (results(self.solve(SCENE, "--quiet", "--threads", str(n), output=f"on_{n}")) for n in (1, 2))
        self.assertEqual(one, two)

    def test_warnings(self):
        self.write("scene.prm", "")
        run = self.attempt({**SCENE, "Examples/Include rest pose": "true"}, "--quiet")
        self.assertEqual(run.status, 0)
        self.assertRegex(run.stderr, "Examples/Include rest pose = true does nothing with additive weights, whose keys are added to the rest pose")
        three = " | ".join([SQUEEZED, "x<1 ? 0.6*x : x-0.4; y+0.01*x; z", "x<1 ? 0.6*x : x-0.4; y; z+0.01*x"])
        run = self.attempt({**SCENE, "Examples/Pose functions": three}, "--quiet")
        self.assertEqual(run.status, 0)
        self.assertRegex(run.stderr, r"may want a stretch of 0 or less.* They do in \d+ cells, element .*most in element \d+, where keys "
                         r"1 \(pose function '.*'\), 2 \(.*\), 3 \(.*\) want a strain of -1.2")
        run = self.attempt({**SCENE, "Examples/Pose functions": three, "Model/Strain": "green"}, "--quiet")
        self.assertRegex(run.stderr, "want a strain of -0.96")  # (0.36 - 1) / 2 each
        two = self.attempt({**SCENE, "Examples/Pose functions": " | ".join(three.split(" | ")[:2])}, "--quiet").stderr
        self.assertNotIn("may want a stretch", two)
        self.assertIn("prefers equal weights", two)  # of keys that differ by 3 %

    def test_refused(self):
        for changes, words in (({"Scene": "interpolation", "Handles/Names": ""}, "Scene = interpolation follows prescribed weights"),
                               ({"Solver/Linear solver": "umfpack", "Solver/Method": "fixed point"}, "without bounds"),
                               ({"Examples/Prescribed weights": "t; t"}, "is not 'prescribed'"),
                               ({"Examples/Creep viscosity": "3"}, "only a dynamic scene has rates")):
            with self.subTest(words):
                scene = {key: value for key, value in {**SCENE, **changes}.items() if changes.get("Handles/Names") != "" or "Handles" not in key}
                run = self.attempt(scene, "--quiet", output="refused")
                self.assertEqual(run.status, 1)
                self.assertIn(words, run.stderr)

    def test_a_run_goes_on_under_another_rule(self):
        """Weights of another rule begin anew."""
        self.solve({**SCENE, "Output/Checkpoint minutes": "0"}, "--quiet", "--set", "Time/Increments=4")
        run = self.attempt({**SCENE, "Examples/Weights": "simplex", "Examples/Include rest pose": "false"}, "--quiet",
                           "--resume-from", "out", output="on")
        if run.status == 0:
            self.assertIn("begin anew", run.stdout + run.stderr)

    def test_painted_maps(self):
        """Each half has weights of its own; the other half's key stays out of it."""
        surface = bar_surface()
        self.write("bar.obj", obj_text(surface))
        self.write("maps.csv", "near,far\n" + "".join(f"{float(x < 2)},{float(x >= 2)}\n" for x, _, _ in surface.vertices))
        scene = {**SCENE, "Mesh/Box size": "4, 1, 1", "Mesh/Box cells": "8, 2, 2", "Mesh/Surface": "bar.obj",
                 "Examples/Weight maps": "maps.csv:near, maps.csv:far",
                 "Examples/Pose functions": "x; y; z + (x < 2 ? 0.1*(2-x)^2 : 0) | x; y; z + (x > 2 ? 0.1*(x-2)^2 : 0)",
                 "Handles/middle/Select": "box 1.5 -1 -1 2.5 1 1", "Handles/left/Select": "box 0 -1 -1 0 1 1",
                 "Handles/left/Motion": "0; 0; 0.4*t", "Handles/right/Select": "box 4 -1 -1 4 1 1", "Handles/right/Motion": "0; 0; 0.2*t"}
        output = self.solve(scene, "--quiet")
        last = read_csv(output)[-1]
        self.assertEqual([name for name in self.columns(output) if "_0_" not in name], ["weight_1_1", "weight_1_2", "weight_2_1", "weight_2_2"])
        self.assertGreater(last["weight_1_1"], last["weight_2_2"])
        self.assertGreater(last["weight_2_2"], 0.1)
        self.assertLess(max(last["weight_1_2"], last["weight_2_1"]), 0.1)


if __name__ == "__main__":
    unittest.main()
