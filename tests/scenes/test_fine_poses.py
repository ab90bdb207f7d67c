# SPDX-License-Identifier: GPL-3.0-or-later
"""Poses that move or pinch a part of the surface smaller than the cells are warned of."""

import csv
import math
import re
import unittest

from exemplar_runner import SceneTest, prm, read_summary
from surfaces import sphere, write_obj


class FinePoses(SceneTest):
    """A ball of radius 1 on which a wart, .12 wide, is raised by .04: 1.2 % of the diagonal."""

    def setUp(self):
        super().setUp()
        self.vertices, faces = sphere(5)
        write_obj(self.directory / "rest.obj", self.vertices, faces)
        self.wart = [tuple((1 + .04 * math.exp(-math.dist(x, (1, 0, 0)) ** 2 / .06 ** 2)) * c for c in x) for x in self.vertices]
        write_obj(self.directory / "wart.obj", self.wart, faces)

    def pose(self, cells):
        run = self.call("mesh", "--surface", "rest.obj", "--cells", cells, "--output", "body.msh")
        self.assertEqual((run.status, run.stderr), (0, ""))
        run = self.call("pose", "--mesh", "body.msh", "--rest", "rest.obj", "--pose", "wart.obj", "--output", "out")
        self.assertEqual(run.status, 0, run.stderr)
        with open(self.directory / "out/poses.csv") as file:
            row = next(csv.DictReader(file))
        self.assertEqual(row["inverted_cells"], "0")
        return float(row["surface_error_max"]), run.stderr

    def test_small_cells_follow(self):
        error, warnings = self.pose(40000)
        self.assertEqual(warnings, "")
        self.assertLess(error, .55)

    def test_a_pose_that_is_hardly_followed_is_warned_of_with_its_place(self):
        error, warnings = self.pose(1500)
        self.assertGreater(error, .6)
        found = re.search(r"Warning: wart.obj: the pose is hardly followed: vertex (\d+) \(at (\S+), (\S+), (\S+) in it\) stays (\S+) % of "
                          r"the diagonal away, and no vertex moves by more than (\S+) %.*--cells", warnings)
        self.assertIsNotNone(found, warnings)
        for c in range(3):
            self.assertAlmostEqual(float(found[2 + c]), self.wart[int(found[1]) - 1][c], 2)
        self.assertAlmostEqual(float(found[5]) / error, 1, 2)
        self.assertAlmostEqual(float(found[6]), 100 * .04 / math.sqrt(12), delta=.05)
        # a scene says so, too
        self.write("scene.prm", prm({
            "Scene": "static", "Mesh/File": "body.msh", "Mesh/Surface": "rest.obj", "Examples/Poses": "wart.obj",
            "Handles/Names": "nape", "Handles/nape/Select": "box -2 -1 -1 -.8 1 1", "Time/Increments": "1"}))
        for output in ("first", "second"):  # the second time the pose is a kept one
            run = self.call("scene.prm", "--output", output, "--quiet", XDG_CACHE_HOME=str(self.directory / "cache"))
            self.assertEqual(run.status, 0, run.stderr)
            self.assertTrue(any(f"the pose is hardly followed: vertex {found[1]} (at" in text
                                for text in read_summary(self.directory / output)["warnings"]))

    def test_an_edge_that_a_pose_pinches_is_no_sheet_that_hangs_together(self):
        """A vertex moved to a neighbour, by all but 2 % of the edge: far smaller than cells are."""
        _, faces = sphere(5)
        a, b = faces[len(faces) // 2][:2]
        pinched = list(self.vertices)
        pinched[a] = tuple(y + .02 * (x - y) for x, y in zip(self.vertices[a], self.vertices[b]))
        write_obj(self.directory / "wart.obj", pinched, faces)
        _, warnings = self.pose(1500)
        found = re.search(r"Warning: wart.obj: the edge between vertices (\d+) and (\d+) .* becomes (\S+) times as long as the pose has it: "
                          r"the pose shortens it to (\S+) % of its length at rest", warnings)
        self.assertIsNotNone(found, warnings)
        self.assertEqual({int(found[1]), int(found[2])}, {a + 1, b + 1})
        self.assertAlmostEqual(float(found[4]), 2, 2)
        self.assertGreater(float(found[3]), 3)
        self.assertNotIn("hang together", warnings)


if __name__ == "__main__":
    unittest.main()
