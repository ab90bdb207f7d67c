# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces that go along with the body (Mesh/Carry): their files in all formats."""

import unittest

from exemplar_runner import SceneTest
from surface_bar import bar_surface, obj_text, read_mdd, read_obj, read_pc2, read_ply, read_usda
from test_surface_formats import flat, single

SCENE = {
    "Scene": "dynamic",
    "Mesh/Generator": "box",
    "Mesh/Box size": "4, 1, 1",
    "Mesh/Box cells": "8, 2, 2",
    "Mesh/Surface": "bar.obj",
    "Mesh/Carry": "eyes.obj, my coat.obj",
    "Material/Young's modulus": "1e4",
    "Handles/Names": "left",
    "Handles/left/Select": "boundary 1",
    "Handles/left/Motion": "t; 0; 0",
    "Loads/Gravity": "0, 0, -9.81",
    "Material/Mass matrix": "lumped",
    "Time/Step": "0.05",
    "Time/End": "0.2",
    "Output/Every": "2",
    "Output/Formats": "vtu, obj, ply, mdd, pc2, usda",
}
EYES = "v 1 .1 .1\nv 1.2 .1 .1\nv 1 .3 .1\nf 1 2 3\n"


class Carried(SceneTest):
    def setUp(self):
        super().setUp()
        self.write("bar.obj", obj_text(bar_surface()))
        self.write("eyes.obj", EYES)
        self.write("my coat.obj", obj_text(bar_surface(), lambda x, y, z: (x, 1.1 * y, 1.1 * z)))

    def test_each_has_frames_in_all_formats(self):
        output = self.solve(SCENE)
        for name in "eyes", "my coat":
            rest = read_obj(self.directory / f"{name}.obj")[0]
            self.assertEqual(read_obj(output / f"rest_{name}.obj")[0], rest)
            frames = [flat(read_ply(output / f"frame_{step:04}_{name}.ply")[0]) for step in (0, 2, 4)]
            self.assertEqual(frames[0], flat(rest))
            self.assertNotEqual(frames[2], frames[0])
            for step, frame in zip((0, 2, 4), frames):
                self.assertEqual(flat(read_obj(output / f"frame_{step:04}_{name}.obj")[0]), frame)
                self.assertIn(f'NumberOfPoints="{len(rest)}"', (output / f"frame_{step:04}_{name}.vtu").read_text())
            expected = [single(frame) for frame in frames]
            self.assertEqual([list(frame) for frame in read_mdd(output / f"animation_{name}.mdd")[1]], expected)
            self.assertEqual([list(frame) for frame in read_pc2(output / f"animation_{name}.pc2")[1]], expected)
            self.assertIn(f'file="frame_0004_{name}.vtu"', (output / f"animation_{name}.pvd").read_text())
        self.assertIn('def Mesh "eyes"', (output / "animation_eyes.usda").read_text())
        self.assertIn('def Mesh "my_coat"', (output / "animation_my coat.usda").read_text())
        # the body's own files do not know of what it wears
        plain = self.solve({**SCENE, "Mesh/Carry": None}, output="plain")
        self.assertEqual((plain / "animation.pc2").read_bytes(), (output / "animation.pc2").read_bytes())

    def test_the_next_run_clears_them_and_a_resumed_one_goes_on(self):
        self.solve(SCENE, output="again")
        whole = {file.name: file.read_bytes() for file in (self.directory / "again").glob("*eyes*")}
        output = self.solve({**SCENE, "Time/End": "0.1"}, output="again")
        self.assertFalse((output / "frame_0004_eyes.obj").exists())
        self.solve(SCENE, "--resume", output="again")
        self.assertEqual({file.name: file.read_bytes() for file in output.glob("*eyes*")}, whole)

    def test_another_surface_or_unit_is_refused(self):
        output = self.solve({**SCENE, "Time/End": "0.1"})
        self.write("eyes.obj", EYES.replace("1.2", "1.3"))
        run = self.attempt(SCENE, "--resume")
        self.assertEqual(run.status, 1)
        self.assertIn("eyes.obj has changed since", run.stderr)
        self.assertTrue((output / "frame_0002_eyes.obj").exists())
        self.write("eyes.obj", EYES.replace("v 1 ", "v 1000 "))
        run = self.attempt(SCENE, output="refused")
        self.assertEqual(run.status, 1)
        self.assertIn("Mesh/Carry: eyes: vertex 1 ", run.stderr)
        self.assertIn("in the unit and axes of the mesh", run.stderr)
        self.assertFalse(run.output.exists())


if __name__ == "__main__":
    unittest.main()
