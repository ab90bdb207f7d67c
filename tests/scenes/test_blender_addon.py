# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on of source/blender in Blender without a window: from an object with a shape key and an armature to the animated result."""

import json
import math
import os
import subprocess
import sys
import unittest

from exemplar_runner import EXEMPLAR, REPOSITORY, SceneTest
from test_blender import BLENDER, ENVIRONMENT


@unittest.skipUnless(BLENDER, "there is no blender (Debian: apt-get install blender)")
class AddOn(SceneTest):
    def use(self):
        addon, result = self.directory / "exemplar_addon.zip", self.directory / "result.json"
        subprocess.run([sys.executable, REPOSITORY / "source/blender/pack_addon.py", addon], check=True)
        own = {"BLENDER_USER_CONFIG": str(self.directory / "config"), "BLENDER_USER_SCRIPTS": str(self.directory / "scripts")}
        done = subprocess.run([BLENDER, "--background", "--factory-startup", "--python-exit-code", "1", "--python",
                               REPOSITORY / "tests/blender/run_addon.py", "--", addon, EXEMPLAR, self.directory, result],
                              cwd=self.directory, text=True, env={**os.environ, **ENVIRONMENT, **own}, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, timeout=300)
        self.assertEqual(done.returncode, 0, done.stdout)
        return json.loads(result.read_text())

    def test_from_keys_and_an_armature_to_the_result(self):
        found = self.use()
        self.assertEqual(found["said"], "Done.")
        self.assertEqual((found["keys"], found["range"]), (["Basis", "bent"], [3, 18]))
        self.assertGreater(found["frames seen"], 1)
        # the upper end is where the armature has it, the lower one where it was, and the shape key is recognised
        high = [i for i, x in enumerate(found["rest"]) if abs(x[2] - 5.) < 1e-5]
        low = [i for i, x in enumerate(found["rest"]) if abs(x[2] - 1.) < 1e-5]
        self.assertEqual((len(high), len(low)), (25, 25))
        self.assertLess(max(math.dist(found["end"][i], found["rig"][i]) for i in high), 1e-2)
        self.assertGreater(min(math.dist(found["rest"][i], found["rig"][i]) for i in high), 1.5)
        self.assertLess(max(math.dist(found["end"][i], found["rest"][i]) for i in low), 1e-2)
        self.assertEqual(found["weights"][0], 0.)
        self.assertGreater(found["weights"][-1], .8)

        # what it wears lies .05 above the upper end, whose normal turns by 60 degrees
        end = [found["end"][i] for i in high]
        middle = [sum(x[c] for x in end) / 25 for c in range(3)]
        hat = [sum(x[c] for x in found["hat"]) / 4 for c in range(3)]
        self.assertLess(math.dist(hat, [middle[0] + .05 * math.sin(math.pi / 3), middle[1], middle[2] + .025]), .02)

        # what an artist may run again, without Blender
        self.assertEqual(found["directory"], str(self.directory / "my film_bar"))
        scene = self.directory / "kept/scene.prm"
        self.assertIn("set Young's modulus map = groups.csv:stiffness from 0.1 to 10", scene.read_text())
        output = self.solve(scene.read_text(), "--quiet", output="again", file="kept/scene.prm")
        self.assertEqual((output / "animation.pc2").read_bytes(), (self.directory / "kept/output/animation.pc2").read_bytes())

        # a mirrored body runs as well, and what was renamed stays
        self.assertEqual(found["mirrored"], "Done.")
        self.assertLess(max(math.dist(found["second end"][i], found["second rig"][i]) for i in high), 1e-2)
        self.assertIn("is the result of a run", found["result"])

        self.assertEqual((found["status"], found["timer"]), ("{'FINISHED'}", True))
        self.assertIn("bar is running. Cancel that first", found["twice"])
        self.assertIn("cannot be written (File exists). Save the .blend elsewhere", found["no directory"])
        self.assertIn("Save the .blend first", found["unsaved"])
        self.assertIn("bar has no vertex group 'gone'", found["no group"])
        self.assertEqual((found["cancelled"], found["hidden"]), ("Cancelled.", False))
        self.assertEqual(found["objects"], ["bar", "bar residual", "bar residual.001", "bar result", "hat", "hat result", "hat result.001", "mine", "rig"])
        self.assertIn("holes: 1", found["hole"])
        self.assertIn("0 faces and 4 vertices with faults are selected", found["hole"])
        self.assertEqual(found["selected"], [0, 1, 2, 3])


if __name__ == "__main__":
    unittest.main()
