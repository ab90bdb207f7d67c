# SPDX-License-Identifier: GPL-3.0-or-later
"""Surface poses on tetrahedra: what `exemplar pose` writes; test_bad_surfaces.py has what it refuses."""

import csv
import unittest

from exemplar_runner import BAR, SceneTest, bent, prm, read_msh, twisted


def write_obj(file, points, faces):
    lines = ["v %.17g %.17g %.17g" % tuple(point) for point in points]
    lines += ["f " + " ".join(str(v + 1) for v in face) for face in faces]
    file.write_text("\n".join(lines) + "\n")


class Pose(SceneTest):
    """A bar of 4 x 1 x 1 and its own boundary as the artist's surface."""

    def setUp(self):
        super().setUp()
        self.bar = self.write_box({**BAR, "Mesh/Box size": "4, 1, 1", "Mesh/Box cells": "8, 2, 2"}, "bar.msh")
        triangles = [element[-3:] for element in self.bar.elements if element[1] == 2]
        used = sorted({node for triangle in triangles for node in triangle})
        number = {node: k for k, node in enumerate(used)}
        self.points = [self.bar.nodes[node] for node in used]
        self.faces = [[number[node] for node in triangle] for triangle in triangles]
        self.surface("rest.obj", lambda *x: x)

    def surface(self, name, place, faces=None):
        write_obj(self.directory / name, [place(*x) for x in self.points], faces or self.faces)

    def pose(self, *poses, mesh="bar.msh", rest="rest.obj", output="out", arguments=()):
        return self.call("pose", "--mesh", mesh, "--rest", rest, "--pose", *poses, "--output", output, *arguments)

    def rows(self, output="out"):
        with open(self.directory / output / "poses.csv") as file:
            return list(csv.DictReader(file))

    def refuse(self, expected, *poses, **keywords):
        before = sorted(self.directory.rglob("*"))
        run = self.pose(*poses, **keywords)
        self.assertEqual((run.status, run.stdout), (1, ""), run.stderr)
        for text in expected:
            self.assertIn(text, run.stderr)
        self.assertEqual(sorted(self.directory.rglob("*")), before)

    def test_poses_become_examples_of_a_scene(self):
        self.surface("bow.obj", bent)
        self.surface("twist.obj", lambda x, y, z: twisted(x, y, z, 1.5))
        run = self.pose("bow.obj", "twist.obj")
        self.assertEqual((run.status, run.stderr), (0, ""))
        self.assertIn("surface error", run.stdout)
        rows = self.rows()
        self.assertEqual([row["pose"] for row in rows], ["bow", "twist"])
        for row in rows:
            self.assertEqual(row["inverted_cells"], "0")
            self.assertGreater(float(row["min_det_F"]), 0.2)
            self.assertLess(float(row["surface_error_max"]), 2)
            self.assertLess(float(row["surface_error_mean"]), 0.5)
        bow = read_msh(self.directory / "out/bow.msh")
        self.assertEqual(bow.elements, self.bar.elements)
        self.assertEqual(list(bow.nodes), list(self.bar.nodes))
        for number, x in self.bar.nodes.items():
            for got, expected in zip(bow.nodes[number], bent(*x)):
                self.assertAlmostEqual(got, expected, delta=0.15)
        self.write("s.prm", prm({"Scene": "interpolation", "Mesh/File": "bar.msh",
                                 "Examples/Poses": "out/bow.msh, out/twist.msh",
                                 "Examples/Prescribed weights": "1-t; t; 0"}))
        run = self.call("s.prm", "--validate")
        self.assertEqual((run.status, run.stderr), (0, ""))

    def test_the_rest_surface_gives_the_rest_mesh_and_is_named(self):
        run = self.pose("rest.obj")
        self.assertEqual(run.status, 0)
        self.assertIn("rest.obj is the same as rest.obj", run.stderr)
        for number, x in read_msh(self.directory / "out/rest.msh").nodes.items():
            for got, expected in zip(x, self.bar.nodes[number]):
                self.assertAlmostEqual(got, expected, delta=1e-9)

    def test_a_rigid_motion_is_reported(self):
        self.surface("turned.obj", lambda x, y, z: (5 - y, x, z))
        self.assertEqual(self.pose("turned.obj").status, 0)
        row, = self.rows()
        self.assertAlmostEqual(float(row["rotation"]), 90)
        self.assertAlmostEqual(float(row["shift"]), (3 ** 2 + 2 ** 2) ** .5)
        self.assertLess(float(row["surface_error_max"]), 1e-6)

    def test_sequences_and_the_same_bytes_again(self):
        for number in (1, 9, 10):
            self.surface(f"walk_{number}.obj", lambda x, y, z: bent(x, y, z, .2 * number))
        self.assertEqual(self.pose("walk_*.obj").status, 0)
        self.assertEqual([row["pose"] for row in self.rows()], ["walk_1", "walk_9", "walk_10"])
        self.assertEqual(self.pose("walk_10.obj", "walk_9.obj", "walk_1.obj", output="again").status, 0)
        for number in (1, 9, 10):
            self.assertEqual(*((self.directory / name / f"walk_{number}.msh").read_bytes() for name in ("out", "again")))
        run = self.pose("walk_?.obj", output="quiet", arguments=["--quiet"])
        self.assertEqual((run.status, run.stdout, len(self.rows("quiet"))), (0, "", 2))

    def test_no_cell_of_a_folded_bar_is_inverted(self):
        self.surface("fold.obj", lambda x, y, z: (x if x < 2 else 4 - x, y, z))
        self.assertEqual(self.pose("fold.obj", arguments=["--attach", "1000"]).status, 0)
        row, = self.rows()
        self.assertEqual(row["inverted_cells"], "0")
        self.assertGreater(float(row["min_det_F"]), 1e-3)

    def test_outputs_overwrite_no_input_and_no_other_output(self):
        (self.directory / "more").mkdir()
        for name in ("bar.obj", "more/p.obj", "p.obj"):
            self.surface(name, bent)
        self.refuse(["bar.msh: is to be written, but is the input"], "bar.obj", output=".")
        self.refuse(["p.obj and more/p.obj would both be written"], "p.obj", "more/p.obj")

    def test_what_another_has_made_stays(self):
        self.surface("bow.obj", bent)
        out = self.directory / "out"
        out.mkdir()
        self.write("out/notes.txt", "mine")
        for name in ("bow.msh", "poses.csv", "bow.msh.tmp", "poses.csv.tmp"):
            with self.subTest(name):
                for content in ("mine\n", (self.directory / "bar.msh").read_text() if name == "bow.msh" else "pose\n"):
                    self.write("out/" + name, content)
                    self.refuse([f"out/{name}: is to be written, but was not written by exemplar", "Move it away"], "bow.obj")
                    self.assertEqual((out / name).read_text(), content)
                    (out / name).unlink()
                (out / name).symlink_to("../bar.msh")
                self.refuse([f"out/{name}: is to be written, but is ", "bar.msh" if name == "bow.msh" else ""], "bow.obj")
                (out / name).unlink()
        self.write("out/poses.csv.tmp", "pose,inv")  # what a killed command leaves
        for _ in range(2):  # over its own results, too
            self.assertEqual(self.pose("bow.obj").status, 0)
        self.assertEqual(sorted(file.name for file in out.iterdir()), ["bow.msh", "notes.txt", "poses.csv"])
        self.assertEqual((out / "notes.txt").read_text(), "mine")


if __name__ == "__main__":
    unittest.main()
