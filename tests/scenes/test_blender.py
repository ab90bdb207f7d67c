# SPDX-License-Identifier: GPL-3.0-or-later
"""What Blender (Debian: apt-get install blender) reads of a run, and what source/blender/exemplar_blender.py makes of it."""

import json
import os
import shutil
import subprocess
import unittest

from exemplar_runner import REPOSITORY, SceneTest, bend, read_csv, read_summary
from surface_bar import bar_surface, obj_text, read_obj, read_ply

SCENE = {
    "Scene": "dynamic",
    "Mesh/Generator": "box",
    "Mesh/Box size": "4, 1, 1",
    "Mesh/Box cells": "8, 2, 2",
    "Mesh/Surface": "bar.obj",
    "Material/Young's modulus": "1e4",
    "Examples/Pose functions": bend("pi/2") + " | " + bend("-pi/2"),
    "Examples/Importance": "0.9",
    "Handles/Names": "left",
    "Handles/left/Select": "boundary 1",
    "Loads/Gravity": "0, 0, -2",
    "Time/Step": "0.1",
    "Time/End": "1.25",
    "Output/Every": "2",
    "Output/Formats": "obj, ply, mdd, pc2",
}


BLENDER = shutil.which("blender")
# Debian's Blender takes the first python3 of the PATH, which need not have numpy
ENVIRONMENT = {**os.environ, "PATH": "/usr/bin:/bin"}


def flat(points):
    return [x for point in points for x in point]


@unittest.skipUnless(BLENDER, "there is no blender (Debian: apt-get install blender)")
class Blender(SceneTest):
    def call_blender(self, *arguments):
        done = subprocess.run([BLENDER, "--background", "--factory-startup", "--python-exit-code", "1", "--python",
                               *map(str, arguments)], cwd=self.directory, text=True, env=ENVIRONMENT,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=300)
        return done.returncode, done.stdout

    def read(self, output, *shapes):
        status, said = self.call_blender(REPOSITORY / "tests/blender/read_run.py", "--", output,
                                         REPOSITORY / "source/blender/exemplar_blender.py", self.directory / "result.json", *shapes)
        self.assertEqual(status, 0, said)
        return json.loads((self.directory / "result.json").read_text())

    def assert_close(self, found, expected, tolerance, what):
        self.assertEqual([len(frame) for frame in found], [len(frame) for frame in expected], what)
        worst = max(abs(a - b) for x, y in zip(found, expected) for a, b in zip(x, y))
        self.assertLess(worst, tolerance, what)
        return worst

    def test_all_formats_and_the_script(self):
        surface = bar_surface()
        self.write("bar.obj", obj_text(surface))
        output = self.solve(SCENE)
        found = self.read(output)
        files = sorted(output.glob("frame_*.ply"))
        expected = [flat(read_ply(file)[0]) for file in files]
        self.assertEqual(len(files), 8)  # 0, 2, ..., 12 and the last
        single = 4 * 2 ** -23
        # the importer of .obj leaves out the last vertex, which no face uses
        self.assert_close(found["obj"], [frame[:-3] for frame in expected], single, "obj")
        for extension in ("ply", "mdd", "pc2"):
            self.assert_close(found[extension], expected, single, extension)
        for extension in ("obj", "ply"):
            self.assertEqual([tuple(face) for face in found[f"{extension} faces"]], surface.faces)
        self.assert_close([flat(found["obj texture"])], [flat(surface.texture[i] for i in flat(surface.faces))], 1e-6, "uv")
        self.assertEqual(found["obj materials"], ["paint of " + group for group in ("bottom", "top", "front", "back", "ends")])

        # the script: weights' poses and the residual sum to the surface
        self.assert_close(found["script"], expected, 2 * single, "script")
        self.assertEqual((found["keys"], found["range"]), (["rest", "weight_1", "weight_2"], [1, 8]))
        self.assertAlmostEqual(found["frames per second"], 5)
        rows = {row["step"]: row for row in read_csv(output)}
        steps = [0, 2, 4, 6, 8, 10, 12, read_summary(output)["steps"]]
        weights = [[rows[step]["weight_1"], rows[step]["weight_2"]] for step in steps]
        self.assertGreater(max(map(max, weights)), .05)
        self.assert_close(found["values"], weights, 1e-6, "weights")
        rest, *poses = [flat(read_obj(output / f"{name}.obj")[0]) for name in ("rest", "weight_1", "weight_2")]
        shapes = [[x + sum(w * (pose[i] - x) for w, pose in zip(of_frame, poses)) for i, x in enumerate(rest)]
                  for of_frame in weights]
        self.assert_close(found["without residual"], shapes, 4e-6, "shape keys alone")

    def test_shapes_of_the_artist(self):
        surface = bar_surface()
        self.write("bar.obj", obj_text(surface))
        self.write("mine.obj", obj_text(surface, lambda x, y, z: (x, y, z + .1 * x * x)))
        output = self.solve(SCENE)
        found = self.read(output, f"weight_2={self.directory / 'mine.obj'}")
        self.assertEqual(found["keys"], ["rest", "weight_1", "mine"])
        expected = [flat(read_ply(file)[0]) for file in sorted(output.glob("frame_*.ply"))]
        self.assert_close(found["script"], expected, 2e-6, "script")

    def test_the_script_from_the_command_line(self):
        self.write("bar.obj", obj_text(bar_surface()))
        output = self.solve({**SCENE, "Output/Formats": "mdd", "Examples/Importance": "0", "Time/End": "0.4"})
        script = REPOSITORY / "source/blender/exemplar_blender.py"
        for file in output.glob("frame_*"):
            file.unlink()  # the steps are every so many then
        status, said = self.call_blender(script, "--", output, "--save", "run.blend", "--start", "10")
        self.assertEqual(status, 0, said)
        self.assertIn("vertices, 3 frames, 0 shape keys", said)
        self.assertTrue((self.directory / "run.blend").exists())
        for arguments, message in (([self.directory], "is not the output directory of a run"),
                                   ([output, "--shape", "weight_7=bar.obj"], "the run has no weight_7")):
            status, said = self.call_blender(script, "--", *arguments)
            self.assertEqual(status, 1)
            self.assertIn(message, said)


if __name__ == "__main__":
    unittest.main()
