# SPDX-License-Identifier: GPL-3.0-or-later
"""Lips that cross at rest and part in poses: they stay two sheets."""

import csv
import re
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

    def test_lids_and_lips_narrower_than_cells_keep_their_gaps_and_follow_their_own_side(self):
        """Slits half as wide as the cells: cells would fill them, and vertices be tied to the lid across."""
        triangles, rest, poses = crossing.make("face")
        for name, x in (("rest", rest), ("open", poses[0]), ("wide", poses[2])):
            crossing.write(self.directory / f"{name}.obj", x, triangles)
        run = self.call("mesh", "--surface", "rest.obj", "--cells", 5000, "--output", "body.msh",
                        "--poses", "open.obj", "wide.obj")
        self.assertEqual((run.status, run.stderr), (0, ""))
        self.assertIn(f"$SurfaceTies\n{len(rest)}\n", (self.directory / "body.msh").read_text())
        run = self.call("pose", "--mesh", "body.msh", "--rest", "rest.obj", "--pose", "open.obj", "wide.obj",
                        "--output", "out")
        self.assertEqual((run.status, run.stderr), (0, ""))
        with open(self.directory / "out/poses.csv") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([row["inverted_cells"] for row in rows], ["0", "0"])
        for row in rows:
            self.assertLess(float(row["surface_error_max"]), 1)
            self.assertLess(float(row["longest_edge"]), 3)

    def test_edges_that_become_far_too_long_are_warned_of_with_their_place(self):
        triangles, rest, poses = crossing.make("face")
        crossing.write(self.directory / "rest.obj", rest, triangles)
        crossing.write(self.directory / "open.obj", poses[2], triangles)
        run = self.call("mesh", "--surface", "rest.obj", "--cells", 5000, "--output", "body.msh", "--repair")
        self.assertEqual(run.status, 0, run.stderr)  # no pose parts the lids: they become one piece
        run = self.call("pose", "--mesh", "body.msh", "--rest", "rest.obj", "--pose", "open.obj", "--output", "out")
        self.assertEqual(run.status, 0, run.stderr)
        with open(self.directory / "out/poses.csv") as file:
            row = next(csv.DictReader(file))
        self.assertGreater(float(row["longest_edge"]), 3)
        found = re.search(r"Warning: open.obj: the edge between vertices (\d+) and (\d+) "
                          r"\(at (\S+), (\S+), (\S+) in this pose\) becomes (\S+) times as long", run.stderr)
        self.assertIsNotNone(found, run.stderr)
        self.assertAlmostEqual(float(found[6]) / float(row["longest_edge"]), 1, 2)
        middle = (poses[2][int(found[1]) - 1] + poses[2][int(found[2]) - 1]) / 2
        for c in range(3):
            self.assertAlmostEqual(float(found[3 + c]), middle[c], 2)
        # a scene says so, too
        self.write("scene.prm", prm({
            "Scene": "static", "Mesh/File": "body.msh", "Mesh/Surface": "rest.obj", "Examples/Poses": "open.obj",
            "Handles/Names": "nape", "Handles/nape/Select": "box -2 -1 -1 -1 1 1", "Time/Increments": "1"}))
        run = self.call("scene.prm", "--output", "run", "--quiet", XDG_CACHE_HOME=str(self.directory / "cache"))
        self.assertEqual(run.status, 0, run.stderr)
        self.assertTrue(any("times as long as the pose has it" in text
                            for text in read_summary(self.directory / "run")["warnings"]))

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
