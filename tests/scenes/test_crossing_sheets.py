# SPDX-License-Identifier: GPL-3.0-or-later
"""Lips that cross at rest and part in poses: they stay two sheets."""

import csv
import sys
import unittest
from pathlib import Path

from exemplar_runner import SceneTest, prm, read_summary

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "meshes/surfaces"))
import crossing  # noqa: E402


class CrossingSheets(SceneTest):
    def setUp(self):
        super().setUp()
        triangles, rest, poses = crossing.make("beak")
        crossing.write(self.directory / "rest.obj", rest, triangles)
        crossing.write(self.directory / "open.obj", poses[0], triangles)
        crossing.write(self.directory / "shut.obj", rest + [1., 0., 0.], triangles)

    def mesh(self, *arguments):
        return self.call("mesh", "--surface", "rest.obj", "--cells", 3000, "--output", "body.msh", *arguments)

    def test_lips_part_where_a_pose_parts_them(self):
        run = self.mesh("--poses", "open.obj", "shut.obj")
        self.assertEqual((run.status, run.stderr), (0, ""))
        self.assertIn("Sheets cross at rest", run.stdout)
        self.assertIn("open.obj", run.stdout)
        run = self.call("pose", "--mesh", "body.msh", "--rest", "rest.obj", "--pose", "open.obj", "--output", "out")
        self.assertEqual((run.status, run.stderr), (0, ""))
        with open(self.directory / "out/poses.csv") as file:
            row = next(csv.DictReader(file))
        self.assertEqual(row["inverted_cells"], "0")
        self.assertLess(float(row["surface_error_max"]), 1)
        self.assertLess(float(row["longest_edge"]), 3)

    def test_what_no_pose_parts_is_a_fault_with_its_place(self):
        for poses in ((), ("--poses", "shut.obj")):
            run = self.mesh(*poses)
            self.assertEqual((run.status, run.stdout), (1, ""))
            self.assertIn("pairs of intersecting faces", run.stderr)
            self.assertFalse((self.directory / "body.msh").exists())

    def test_a_scene_fills_its_mesh_from_its_own_poses(self):
        cache = {"XDG_CACHE_HOME": str(self.directory / "cache")}
        scene = {"Scene": "static", "Mesh/File": "rest.obj", "Mesh/Cells": "3000", "Examples/Poses": "open.obj",
                 "Handles/Names": "nape", "Handles/nape/Select": "box -2 -1 -1 -1 1 1", "Time/Increments": "1"}
        self.write("scene.prm", prm(scene))
        run = self.call("scene.prm", "--output", "out", "--quiet", **cache)
        self.assertEqual((run.status, run.stderr), (0, ""))
        summary = read_summary(self.directory / "out")
        self.assertEqual([pose["inverted_cells"] for pose in summary["poses_carried"]], [0])
        self.assertLess(summary["poses_carried"][0]["surface_error_max"], 1)
        self.assertEqual(self.mesh("--poses", "open.obj").status, 0)
        self.assertEqual((self.directory / "body.msh").read_text().removesuffix("$Comments\na mesh by exemplar\n$EndComments\n"),
                         (self.directory / "out/rest.msh").read_text())
        # without a pose that parts them the sheets are a fault
        self.write("scene.prm", prm({**scene, "Examples/Poses": "shut.obj"}))
        run = self.call("scene.prm", "--output", "shut", "--quiet", **cache)
        self.assertEqual((run.status, run.stdout), (1, ""))
        self.assertIn("pairs of intersecting faces", run.stderr)

    def test_poses_of_another_surface_are_refused(self):
        self.write("other.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        run = self.mesh("--poses", "other.obj")
        self.assertEqual(run.status, 1)
        self.assertIn("other.obj is no pose of", run.stderr)


if __name__ == "__main__":
    unittest.main()
