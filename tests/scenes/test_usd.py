# SPDX-License-Identifier: GPL-3.0-or-later
"""animation.usda as another program reads it: tinyusdz (npm install tinyusdz), in the directory that the environment variable
TINYUSDZ names, by node. Without it the reader of surface_bar.py alone looks at these files (test_surface_formats.py)."""

import json
import os
import re
import shutil
import subprocess
import unittest

from exemplar_runner import REPOSITORY, SceneTest
from surface_bar import bar_surface, obj_text, read_ply, read_usda
from test_surface_formats import SCENE, STEPS, flat, single

TINYUSDZ = os.environ.get("TINYUSDZ")


@unittest.skipUnless(TINYUSDZ and shutil.which("node"), "no node, or TINYUSDZ does not name the directory of tinyusdz")
class Usd(SceneTest):
    def samples(self, text, attribute):
        """{time code: flat numbers}"""
        block = re.search(re.escape(attribute) + r"\.timeSamples = \{(.*?)\n\s*\}", text, re.DOTALL)[1]
        return {float(code): [float(word) for word in re.findall(r"[-\d.e+]+", values)]
                for code, values in re.findall(r"([\d.]+): \[(.*?)\]", block, re.DOTALL)}

    def test_another_reader_sees_the_same(self):
        self.write("bar.obj", obj_text(bar_surface()))
        output = self.solve(SCENE)
        subprocess.run(["node", REPOSITORY / "tests/usd/read_layer.mjs", TINYUSDZ, output / "animation.usda", "layer.txt",
                        "scene.json"], cwd=self.directory, check=True, timeout=120)
        layer = (self.directory / "layer.txt").read_text()
        for words in ('upAxis = "Z"', "metersPerUnit = 1", "timeCodesPerSecond = 25", "endTimeCode = 5.25",
                      'uniform token subdivisionScheme = "none"', 'interpolation = "faceVarying"'):
            self.assertIn(words, layer)
        _, mesh = read_usda(output / "animation.usda")
        for attribute in ("point3f[] points", "float3[] extent"):
            found = self.samples(layer, attribute)
            expected = {code: flat(points) for code, points in mesh[attribute + ".timeSamples"].items()}
            self.assertEqual(sorted(found), sorted(expected))
            for code in expected:
                for a, b in zip(found[code], expected[code], strict=True):
                    self.assertAlmostEqual(a, b, delta=4 * 2 ** -23)
        found = self.samples(layer, "point3f[] points")
        for code, step in zip(sorted(found), STEPS):
            for a, b in zip(found[code], flat(read_ply(output / f"frame_{step:04}.ply")[0]), strict=True):
                self.assertAlmostEqual(a, b, delta=4 * 2 ** -23)
        scene = json.loads((self.directory / "scene.json").read_text())
        self.assertEqual((scene["meshes"], scene["path"]), (1, "/body/surface"))
        self.assertEqual(single(scene["points"]), single(flat(bar_surface().vertices)))


if __name__ == "__main__":
    unittest.main()
