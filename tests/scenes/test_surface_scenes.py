# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes that name surfaces: the mesh and the poses that are made of them, kept by content, and the same in every run."""

import csv
import math
import shutil
import signal
import subprocess
import time
import unittest

import surfaces
from exemplar_runner import EXEMPLAR, SceneTest, bent, nodes_of, prm, read_csv, read_summary, results, twisted

SCENE = {"Scene": "static", "Mesh/File": "rest.obj", "Mesh/Cells": "400", "Examples/Poses": "bow.obj, twist.ply",
         "Handles/Names": "left", "Handles/left/Select": "boundary left", "Loads/Gravity": "0, 0, -9.81",
         "Time/Increments": "2"}
DYNAMIC = {**SCENE, "Scene": "dynamic", "Time/Increments": None, "Time/Step": "0.01", "Time/End": "0.04"}


def bar(scale=1.):
    """4 x 1 x 1, of 192 triangles; the name of each one's end, or of the sides."""
    vertices, faces = surfaces.cube((0, -.5, -.5))
    for _ in range(2):
        vertices, faces, _ = surfaces.divided(vertices, faces)
    names = ["left" if all(vertices[i][0] == 0 for i in face) else
             "right" if all(vertices[i][0] == 1 for i in face) else "sides" for face in faces]
    return [(4 * scale * x, scale * y, scale * z) for x, y, z in vertices], faces, names


def write_ply(file, vertices, faces):
    file.write_text("\n".join(
        ["ply", "format ascii 1.0", f"element vertex {len(vertices)}", *(f"property double {c}" for c in "xyz"),
         f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header",
         *(f"{x!r} {y!r} {z!r}" for x, y, z in vertices), *(f"3 {a} {b} {c}" for a, b, c in faces), ""]))


class SurfaceScenes(SceneTest):
    def setUp(self):
        super().setUp()
        self.environment = {"XDG_CACHE_HOME": str(self.directory / "cache")}
        self.vertices, self.faces, self.names = bar()
        self.surface("rest.obj")
        self.surface("bow.obj", bent)
        write_ply(self.directory / "twist.ply", [twisted(*x, 1.5) for x in self.vertices], self.faces)

    def surface(self, name, place=lambda *x: x):
        surfaces.write_obj(self.directory / name, [place(*x) for x in self.vertices], self.faces, self.names)

    def call(self, *arguments, **environment):
        return super().call(*arguments, **{**self.environment, **environment})

    def kept(self):
        return sorted(file.name for file in (self.directory / "cache/exemplar").iterdir())

    def test_the_scene_of_its_own_mesh_and_poses_is_the_same(self):
        out = self.solve(SCENE)
        self.assertEqual(len(self.kept()), 3)
        first = results(out)
        summary = read_summary(out)
        self.assertEqual(summary["mesh_made"]["cells"], summary["cells"])
        self.assertEqual(summary["mesh_made"]["volume"], 4)
        self.assertEqual([(pose["pose"].split("/")[-1], pose["inverted_cells"]) for pose in summary["poses_carried"]],
                         [("bow.obj", 0), ("twist.ply", 0)])
        for pose in summary["poses_carried"]:
            self.assertLess(pose["surface_error_max"], 2)
        self.assertEqual(results(self.solve(SCENE, "--threads", "1", "--quiet", output="again")), first)
        # by the commands, one after the other
        self.assertEqual(self.call("mesh", "--surface", "rest.obj", "--cells", 400, "--output", "body.msh").status, 0)
        self.assertEqual((self.directory / "body.msh").read_text().removesuffix("$Comments\na mesh by exemplar\n$EndComments\n"),
                         (out / "rest.msh").read_text())
        self.assertEqual(self.call("pose", "--mesh", "body.msh", "--rest", "rest.obj", "--pose", "bow.obj", "twist.ply",
                                   "--output", "poses").status, 0)
        by_hand = {**SCENE, "Mesh/File": "body.msh", "Mesh/Cells": None, "Examples/Poses": "poses/bow.msh, poses/twist.msh"}
        self.assertEqual(results(self.solve(by_hand, output="by_hand")), first)
        self.assertFalse((self.directory / "by_hand/rest.msh").exists())
        # poses as surfaces of a mesh that is there, or of a mix
        mixed = {**by_hand, "Mesh/Surface": "rest.obj", "Examples/Poses": "poses/bow.msh, twist.ply"}
        self.assertEqual(results(self.solve(mixed, output="mixed")), first)

    def test_what_is_made_is_kept_by_content(self):
        self.assertEqual(self.solve(SCENE, "--quiet") and len(self.kept()), 3)
        self.assertIn("filling", self.attempt({**SCENE, "Mesh/Cells": "300"}, "--validate").stdout)
        self.assertEqual(len(self.kept()), 6)  # another mesh, and other poses of it
        (self.directory / "elsewhere").mkdir()
        shutil.copy(self.directory / "rest.obj", self.directory / "elsewhere/body.obj")
        run = self.attempt({**SCENE, "Mesh/File": "elsewhere/body.obj"}, "--validate")
        self.assertEqual((run.status, run.stdout.count("...")), (0, 0))
        self.surface("bow.obj", lambda *x: bent(*x, 1))
        run = self.attempt({**SCENE, "Examples/Attach": "30"}, "--validate")
        self.assertEqual((run.stdout.count("carrying"), len(self.kept())), (1, 7))
        self.attempt({**SCENE, "Examples/Attach": "3"}, "--validate")
        self.assertEqual(len(self.kept()), 9)
        for file in (self.directory / "cache/exemplar").iterdir():
            file.write_bytes(file.read_bytes().replace(b"$Nodes", b"$Nudes"))
        run = self.attempt(SCENE, "--validate")
        self.assertEqual((run.status, run.stdout.count("...")), (0, 3))

    def test_resumed_without_the_cache(self):
        whole = results(self.solve(DYNAMIC, "--quiet", output="whole"))
        out = self.solve({**DYNAMIC, "Time/End": "0.02"}, "--quiet")
        shutil.rmtree(self.directory / "cache")
        self.assertEqual(results(self.solve(DYNAMIC, "--quiet", "--resume")), whole)
        self.surface("bow.obj", lambda *x: bent(*x, 3))
        run = self.attempt({**DYNAMIC, "Time/End": "0.06"}, "--resume")
        self.assertEqual(run.status, 1)
        self.assertIn("bow.obj has changed since", run.stderr)
        self.assertTrue((out / "rest.msh").exists())

    def test_handles_and_starts_follow_surfaces_and_millimetres_are_scaled(self):
        scene = {**SCENE, "Scene": "dynamic", "Time/Increments": None, "Time/Step": "0.1", "Time/End": "0.1",
                 "Examples/Poses": None, "Initial/Pose": "bow.obj", "Handles/left/Select": "boundary right",
                 "Handles/left/Follow pose": "bow.obj", "Handles/left/Progress": "1"}
        rest, final = self.rest_and_final_with_bent_end(scene, "out", 1.)
        self.vertices = [tuple(1000 * c for c in x) for x in self.vertices]
        self.surface("rest.obj")
        self.surface("bow.obj", lambda x, y, z: [1000 * c for c in bent(x / 1000, y / 1000, z / 1000)])
        scaled_rest, scaled_final = self.rest_and_final_with_bent_end({**scene, "Mesh/Scale": "0.001"}, "mm", 1000.)
        for one, scaled in ((rest, scaled_rest), (final, scaled_final)):  # meshers may round the two in different ways
            for c in range(3):
                for end in (min, max):
                    self.assertAlmostEqual(end(x[c] for x in one.values()), end(x[c] for x in scaled.values()) / 1000, delta=.1)

    def rest_and_final_with_bent_end(self, scene, output, unit):
        """Nodes before and after, by files in a unit, where the handle has bent an end."""
        out = self.solve(scene, "--quiet", output=output)
        rest, final = (nodes_of(out / name) for name in ("rest.msh", "final.msh"))
        ends = [number for number, x in rest.items() if x[0] == 4 * unit]
        self.assertGreater(len(ends), 8)
        for number in ends:
            place = bent(*(c / unit for c in rest[number]))
            self.assertLess(math.dist([c / unit for c in final[number]], place), .1)
        return rest, final

    def test_a_pose_that_the_mesh_cannot_follow_is_named(self):
        self.surface("wrung.obj", lambda *x: twisted(*x, 10))
        run = self.attempt({**SCENE, "Examples/Poses": "wrung.obj"}, "--quiet")
        self.assertEqual((run.status, run.stdout), (0, ""))
        self.assertIn("wrung.obj: the mesh is up to", run.stderr)
        self.assertIn("Examples/Attach", run.stderr)

    def test_a_study_with_several_meshes(self):
        self.write("scene.prm", prm(SCENE))
        self.write("study.prm", prm({"Scene": "scene.prm", "Reference": "Mesh/Cells=800", "Vary": "Mesh/Cells: 200 400",
                                     "Probe": "4, 0, 0", "Threads": "1"}))
        run = self.call("study", "study.prm", "--output", "out", "--quiet")
        self.assertEqual(run.status, 0, run.stderr)
        with open(self.directory / "out/study.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([row["status"] for row in rows[-2:]], ["converged"] * 2)

    def wait_for_end_of(self, group):
        """It is killed with its parent, but takes a moment to give its memory back."""
        for _ in range(200):
            alive = subprocess.run(["/usr/bin/pgrep", "-r", "D,R,S", "-g", group], capture_output=True, check=False)
            if alive.returncode != 0:
                return
            time.sleep(.05)
        self.fail(f"{group} goes on")

    def test_interrupted_while_the_mesh_is_made(self):
        self.write("scene.prm", prm({**SCENE, "Mesh/Cells": "2000000"}))
        with subprocess.Popen([EXEMPLAR, "scene.prm", "--output", "out"], cwd=self.directory, text=True,
                              env={**self.environment, "PATH": ""}, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE) as process:
            self.assertIn("filling", process.stdout.readline())
            children = subprocess.run(["/usr/bin/pgrep", "-P", str(process.pid)], capture_output=True, text=True, check=False)
            process.send_signal(signal.SIGINT)
            self.assertEqual(process.wait(timeout=60), 130)
            self.assertEqual(process.stderr.read().count("Interrupted"), 1)
        for child in children.stdout.split():
            self.wait_for_end_of(child)
        self.assertFalse((self.directory / "out").exists())

    def test_what_is_missing_is_said(self):
        for keys, words in (({"Mesh/File": None, "Mesh/Generator": "box"},
                             ("Examples/Poses: ", "bow.obj is a surface", "Mesh/Surface")),
                            ({"Mesh/Generator": "box"}, ("both File and Generator",)),
                            ({"Mesh/Cells": "9"}, ("Mesh/Cells", "10 ... 1e+07"))):
            run = self.attempt({**SCENE, **keys})
            self.assertEqual((run.status, run.stdout), (1, ""))
            for word in words:
                self.assertIn(word, run.stderr)


if __name__ == "__main__":
    unittest.main()
