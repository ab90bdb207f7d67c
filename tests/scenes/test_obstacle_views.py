# SPDX-License-Identifier: GPL-3.0-or-later
"""Obstacles beside the body in frames of all formats: where they are, which way their faces look, what goes on after a stop."""

import unittest

import numpy as np
from exemplar_runner import SceneTest, read_pvd, read_vtu
from mpirun import launch
from surface_bar import UsdaReader, bar_surface, obj_text, read_mdd, read_obj, read_ply

SCENE = {
    "Scene": "dynamic",
    "Mesh/Generator": "box",
    "Mesh/Box size": "4, 1, 1",
    "Mesh/Box cells": "8, 2, 2",
    "Mesh/Surface": "bar.obj",
    "Mesh/Scale": "0.1",
    "Material/Young's modulus": "1e5",
    "Material/Poisson's ratio": "0.3",
    "Initial/Velocity": "6; 0; 0",
    "Obstacles/Names": "floor, ball, rod, cage, block, tent",
    "Obstacles/floor/Shape": "plane 0 0 -0.2  0 0 1",
    "Obstacles/ball/Shape": "sphere 0.4 0 -0.4 0.2",
    "Obstacles/ball/Motion": "0; 0; 0.1*t",
    "Obstacles/rod/Shape": "capsule 0 -0.3 0.4  0 0.3 0.4 0.05",
    "Obstacles/rod/Turn": "0; 0; 5*t",
    "Obstacles/rod/Until": "0.15",
    "Obstacles/cage/Shape": "inside box -9 -1 -2  9 1 3",
    "Obstacles/block/Shape": "box 0.2 0.3 -0.1  0.3 0.5 0.3",
    "Obstacles/tent/Shape": "surface tent.obj",
    "Time/Step": "0.05",
    "Time/End": "0.2",
    "Output/Every": "2",
    "Output/Formats": "vtu, obj, ply, mdd, pc2, usda",
}
TENT = "v -1 -20 -1\nv 1 -20 -1\nv 0 -20 1\nv 0 -22 0\nf 1 3 2\nf 2 4 1\nf 3 4 2\nf 1 4 3\n"
NAMES = SCENE["Obstacles/Names"].split(", ")
VOLUMES = {"ball": 4 / 3 * np.pi * .2 ** 3, "rod": np.pi * .05 ** 2 * .6 + 4 / 3 * np.pi * .05 ** 3, "cage": -18 * 2 * 5., "block": .1 * .2 * .4,
           "tent": 2 / 3 * 2e-3}


def polygons(file):
    """Points, polygons and the name of the obstacle of each."""
    arrays = read_vtu(file)[0]
    points = np.reshape(arrays["Points", "Points"], (-1, 3))
    ends = np.array(arrays["Cells", "offsets"])
    faces = np.split(np.array(arrays["Cells", "connectivity"]), ends[:-1])
    return points, faces, [NAMES[i] for i in arrays["CellData", "obstacle"]]


def volume(points, faces):
    return sum(np.linalg.det(points[[f[0], f[k], f[k + 1]]]) for f in faces for k in range(1, len(f) - 1)) / 6


class ObstacleViews(SceneTest):
    def setUp(self):
        super().setUp()
        self.write("bar.obj", obj_text(bar_surface()))
        self.write("tent.obj", TENT)

    def test_each_is_where_it_is_and_looks_at_the_body(self):
        output = self.solve(SCENE)
        for step in (0, 2, 4):
            points, faces, names = polygons(output / f"frame_{step:04}_obstacles.vtu")
            time = 0.05 * step
            for name, expected in VOLUMES.items():
                found = volume(points, [f for f, of in zip(faces, names) if of == name])
                there = name != "rod" or time < 0.15
                self.assertAlmostEqual(found / expected, there, delta=0.01 if name in ("ball", "rod") else 1e-9, msg=name)
            places = {name: points[np.unique(np.concatenate([f for f, of in zip(faces, names) if of == name]))] for name in NAMES}
            self.assertLess(np.abs(np.linalg.norm(places["ball"] - (0.4, 0, -0.4 + 0.1 * time), axis=1) - 0.2).max(), 1e-12)
            square = places["floor"]
            self.assertLess(np.abs(square[:, 2] + 0.2).max(), 1e-12)
            corners = points[next(f for f, of in zip(faces, names) if of == "floor")]
            self.assertGreater(np.cross(corners[1] - corners[0], corners[2] - corners[0])[2], 0)
            # below the body, which flies away
            body = np.reshape(read_vtu(output / f"frame_{step:04}.vtu")[0]["Points", "Points"], (-1, 3))
            diameter = np.linalg.norm((.4, .1, .1))
            self.assertAlmostEqual(np.ptp(square[:, 0]) / diameter, 8)
            self.assertLess(np.abs(square.mean(0) - body.mean(0))[:2].max(), 0.51 * diameter)
            axis = (1, 0, 0) if time >= 0.15 else (-np.sin(5 * time), np.cos(5 * time), 0)
            self.assertAlmostEqual(np.ptp(places["rod"] @ axis), 0.7 * (time < 0.15), delta=1e-3)
        self.assertEqual(read_pvd(output)[:2], [(0, "frame_0000.vtu"), (0, "frame_0000_obstacles.vtu")])
        self.assertIn('part="1" file="frame_0004_obstacles.vtu"', (output / "animation.pvd").read_text())

    def test_a_track_is_followed(self):
        def turned(angle):  # about an axis along z through (5, 0, 0), in the unit of the mesh file, and up by it
            c, s = np.cos(angle), np.sin(angle)
            R = np.array(((c, -s, 0), (s, c, 0), (0, 0, 1)))
            return R, (5, 0, 0.2 * angle) - R @ (5, 0, 0)
        times = np.linspace(0, 0.2, 5)
        rows = [(t, *np.column_stack(turned(20 * t)).ravel()) for t in times]
        self.write("spin.txt", "# a matrix a frame\n" + "\n".join(", ".join(f"{x:.17g}" for x in row) for row in rows))
        names = {"Obstacles/Names": "block", "Obstacles/block/Follow track": "spin.txt", "Obstacles/block/Shape": "box 0.5 0 -3  0.6 0.1 -2.9",
                 "Output/Every": "1", "Output/Formats": "vtu"}
        scene = {key: value for key, value in SCENE.items() if not key.startswith("Obstacles")}
        output = self.solve({**scene, **names})
        rest = read_vtu(output / "frame_0000_obstacles.vtu")[0]["Points", "Points"]
        for step, t in enumerate(times):
            R, p = turned(20 * t)
            points = np.reshape(read_vtu(output / f"frame_{step:04}_obstacles.vtu")[0]["Points", "Points"], (-1, 3))
            self.assertLess(np.abs(points - np.reshape(rest, (-1, 3)) @ R.T - 0.1 * p).max(), 1e-12)
        # vectors, as Motion and Turn have them, linear between frames and at rest after the last
        self.write("turn.txt", "0 0 0 0 0 0 0\n0.15 0 0 1.5 0 0 3\n")
        of_track = self.solve({**scene, **names, "Obstacles/block/Follow track": "turn.txt"}, output="track")
        of_formula = self.solve({**scene, **names, "Obstacles/block/Follow track": None, "Obstacles/block/Motion": "0; 0; min(t, 0.15)",
                                 "Obstacles/block/Turn": "0; 0; 20*min(t, 0.15)"}, output="formula")
        for step in range(5):
            a, b = (read_vtu(o / f"frame_{step:04}_obstacles.vtu")[0]["Points", "Points"] for o in (of_track, of_formula))
            self.assertLess(np.abs(np.subtract(a, b)).max(), 1e-12)

    def test_what_is_no_track_is_refused_with_its_line(self):
        for text, words in (("0 0 0 0 0 0 0\n0 0 0 0 0 0 0\n", "track.txt:2: t must be later"), ("# nothing\n", "has no frame"),
                            ("0 1 2\n", "track.txt:1: it has 3 numbers. Allowed: 7"), ("0 0 0 0 0 0 0\n1 x 0 0 0 0 0\n", "track.txt:2: all of it must be finite"),
                            ("0 2 0 0 0  0 2 0 0  0 0 2 0\n", "track.txt:1: its matrix R stretches"),
                            ("0 1 0 0 0  0 1 0 0  0 0 -1 0\n", "track.txt:1: its matrix R mirrors")):
            with self.subTest(words):
                self.write("track.txt", text)
                run = self.attempt({**SCENE, "Obstacles/block/Follow track": "track.txt"})
                self.assertEqual(run.status, 1)
                self.assertIn("Obstacles/block/Follow track: ", run.stderr)
                self.assertIn(words, run.stderr)
                self.assertFalse(run.output.exists())
        run = self.attempt({**SCENE, "Obstacles/ball/Follow track": "track.txt"})
        self.assertIn("Obstacles/ball/Follow track and Obstacles/ball/Motion are both given", run.stderr)

    def test_all_formats_show_them_in_the_unit_of_the_files(self):
        output = self.solve(SCENE)
        points = polygons(output / "frame_0004_obstacles.vtu")[0]
        for found in (read_obj(output / "frame_0004_obstacles.obj")[0], read_ply(output / "frame_0004_obstacles.ply")[0],
                      np.reshape(read_mdd(output / "animation_obstacles.mdd")[1][2], (-1, 3))):
            self.assertLess(np.abs(0.1 * np.array(found) - points).max(), 1e-6)
        text = (output / "frame_0000_obstacles.obj").read_text()
        self.assertEqual([line[2:] for line in text.split("\n") if line[:2] == "g "], NAMES)
        layer = UsdaReader((output / "animation_obstacles.usda").read_text()).statements(None)['def Xform "body"']['def Mesh "obstacles"']
        self.assertLess(np.abs(0.1 * np.array(layer["point3f[] points.timeSamples"][2]) - points).max(), 1e-6)
        self.assertEqual([name for name in layer if "GeomSubset" in name], [f'def GeomSubset "{name}"' for name in NAMES])
        self.assertIn('def Xform "obstacles" (\n    references = @./animation_obstacles.usda@\n)', (output / "animation.usda").read_text())
        self.assertFalse((output / "rest_obstacles.obj").exists())

    def test_a_run_that_goes_on_writes_the_same(self):
        whole = self.solve(SCENE, output="whole")
        self.solve({**SCENE, "Time/End": "0.1"}, output="parts")
        self.solve(SCENE, "--resume", output="parts")
        for file in whole.glob("*obstacles*"):
            self.assertEqual((self.directory / "parts" / file.name).read_bytes(), file.read_bytes(), file.name)
        self.assertEqual((self.directory / "parts/animation.pvd").read_bytes(), (whole / "animation.pvd").read_bytes())

    def test_of_several_processes_one_writes_them(self):
        scene = {**SCENE, "Output/Formats": "vtu", "Mesh/Surface": None, "Initial/Velocity": None}
        one = self.solve(scene, output="one")
        status, said, _ = launch(2, self.directory / "scene.prm", "--output", self.directory / "two", cwd=self.directory)
        self.assertEqual((status, said), (0, []))
        self.assertIn((0.2, "frame_0004.pvtu"), read_pvd(self.directory / "two"))
        for file in one.glob("*obstacles*"):
            self.assertEqual((self.directory / "two" / file.name).read_bytes(), file.read_bytes(), file.name)

    def test_what_the_body_wears_has_another_name(self):
        self.write("obstacles.obj", "v 1 .1 .1\nv 1.2 .1 .1\nv 1 .3 .1\nf 1 2 3\n")
        run = self.attempt({**SCENE, "Mesh/Carry": "obstacles.obj"})
        self.assertEqual(run.status, 1)
        self.assertIn("Mesh/Carry has a surface of the name 'obstacles'", run.stderr)
        self.assertFalse(run.output.exists())


if __name__ == "__main__":
    unittest.main()
