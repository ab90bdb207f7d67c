# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames of the body's surface: obj, ply, mdd, pc2 and usda, what they hold, and that they outlive interrupted runs."""

import csv
import math
import re
import signal
import struct
import subprocess
import unittest

from exemplar_runner import EXEMPLAR, SceneTest, bent, bend, prm, results, write_msh, wait_until
from surface_bar import bar_surface, obj_text, read_mdd, read_obj, read_pc2, read_ply, read_usda, read_usda_prims

SCENE = {
    "Scene": "dynamic",
    "Mesh/Generator": "box",
    "Mesh/Box size": "4, 1, 1",
    "Mesh/Box cells": "8, 2, 2",
    "Mesh/Surface": "bar.obj",
    "Material/Young's modulus": "1e5",
    "Examples/Pose functions": bend("pi/2"),
    "Handles/Names": "left",
    "Handles/left/Select": "boundary 1",
    "Loads/Gravity": "0, 0, -9.81",
    "Time/Step": "0.02",
    "Time/End": "0.21",
    "Output/Every": "2",
    "Output/Formats": "vtu, obj, ply, mdd, pc2, usda",
}
STEPS = [0, 2, 4, 6, 8, 10, 11]
FORMATS = ["obj", "ply", "mdd", "pc2", "usda"]


def flat(points):
    return [x for point in points for x in point]


def single(numbers):
    return list(struct.unpack(f"{len(numbers)}f", struct.pack(f"{len(numbers)}f", *numbers)))


class SurfaceFormats(SceneTest):
    def setUp(self):
        super().setUp()
        self.surface = bar_surface()
        self.write("bar.obj", obj_text(self.surface))

    def test_texture_points_counted_from_the_end(self):
        scene = {**SCENE, "Time/End": "0.02", "Output/Formats": "usda"}
        whole = results(self.solve(scene))
        n = len(self.surface.texture)
        counted = re.sub(r"(\d+)/(\d+)", lambda corner: f"{corner[1]}/{int(corner[2]) - n - 1}", obj_text(self.surface))
        self.assertIn(f"/-{n}", counted)
        self.write("bar.obj", counted)
        self.assertTrue(results(self.solve(scene)) == whole)  # without looking for the differences, which takes a minute

    def frames(self, output):
        """By step: flat coordinates in double precision."""
        return {step: flat(read_ply(output / f"frame_{step:04}.ply")[0]) for step in STEPS}

    def test_obj_is_the_file_with_other_vertices(self):
        output = self.solve({**SCENE, "Output/Formats": "obj"})
        self.assertEqual(sorted(file.name for file in output.glob("frame_*")), [f"frame_{step:04}.obj" for step in STEPS])
        rest, statements = read_obj(self.directory / "bar.obj")
        for step in STEPS:
            vertices, found = read_obj(output / f"frame_{step:04}.obj")
            if step == 0:
                self.assertEqual(vertices, rest)  # to the last bit
            else:
                self.assertEqual(len(vertices), len(rest))
                self.assertNotEqual(vertices, rest)
            # but for normals, which are those of another pose; "o" and the library stand behind the vertices
            expected = [line.replace("/1 ", " ").removesuffix("/1") if line.startswith("f ") else line
                        for line in statements if not line.startswith(("vn", "vt"))]
            texture = [tuple(map(float, line.split()[1:])) for line in found if line.startswith("vt")]
            self.assertEqual(texture, self.surface.texture)
            self.assertEqual(sorted(line for line in found if not line.startswith("vt")), sorted(expected))
            for kind in "f", "g", "usemtl":
                self.assertEqual([line for line in found if line.split()[0] == kind],
                                 [line for line in expected if line.split()[0] == kind])
            index = {line: found.index(line) for line in found if line.startswith(("g ", "usemtl "))}
            self.assertEqual(index["usemtl paint of top"], index["g top"] + 1)

    def test_all_formats_have_the_same_places(self):
        output = self.solve(SCENE)
        frames = self.frames(output)
        for step, places in frames.items():
            self.assertEqual(flat(read_obj(output / f"frame_{step:04}.obj")[0]), places)
        _, faces, labels = read_ply(output / "frame_0000.ply")
        self.assertEqual(faces, self.surface.faces)
        self.assertEqual(labels, [["bottom", "top", "front", "back", "ends"].index(g) + 1 for g in self.surface.groups])
        expected = [single(places) for places in frames.values()]
        times, places = read_mdd(output / "animation.mdd")
        self.assertEqual(list(times), single([0, .04, .08, .12, .16, .2, .21]))
        self.assertEqual([list(frame) for frame in places], expected)
        head, places = read_pc2(output / "animation.pc2")
        self.assertEqual(head, (1, 0., 1.))
        self.assertEqual([list(frame) for frame in places], expected)

    def test_usda(self):
        output = self.solve(SCENE)
        layer, mesh = read_usda(output / "animation.usda")
        self.assertEqual({name: layer[name] for name in ("metersPerUnit", "upAxis", "timeCodesPerSecond", "startTimeCode",
                                                         "endTimeCode", "defaultPrim")},
                         {"metersPerUnit": 1, "upAxis": "Z", "timeCodesPerSecond": 25, "startTimeCode": 0,
                          "endTimeCode": 5.25, "defaultPrim": "body"})
        self.assertEqual(mesh["uniform token subdivisionScheme"], "none")
        self.assertEqual(mesh["int[] faceVertexCounts"], [len(face) for face in self.surface.faces])
        self.assertEqual(mesh["int[] faceVertexIndices"], flat(self.surface.faces))
        points = mesh["point3f[] points.timeSamples"]
        self.assertEqual(list(points), [0, 1, 2, 3, 4, 5, 5.25])
        for places, found in zip(self.frames(output).values(), points.values()):
            self.assertEqual(single(flat(found)), single(places))
        extents = mesh["float3[] extent.timeSamples"]
        for time, found in points.items():
            self.assertEqual(extents[time], [tuple(map(min, zip(*found))), tuple(map(max, zip(*found)))])
        st, indices = mesh["texCoord2f[] primvars:st"], mesh["int[] primvars:st:indices"]
        self.assertEqual([single(st[int(i)]) for i in indices], [single(self.surface.texture[i]) for i in flat(self.surface.faces)])
        groups = {name: value for name, value in mesh.items() if name.startswith("def GeomSubset") and "material_" not in name
                  and not name.endswith("(metadata)")}
        self.assertEqual(groups['def GeomSubset "ends"']["int[] indices"],
                         [f for f, group in enumerate(self.surface.groups) if group == "ends"])
        self.assertEqual(len(groups), 5)

    def test_usda_without_cells_and_normals(self):
        scene = {**SCENE, "Output/Formats": "usda", "Time/End": "0.05"}
        whole = self.solve(scene, output="whole")
        less = self.solve({**scene, "Output/USD cells": "false", "Output/USD normals": "false"}, output="less")
        prims, fewer = (read_usda_prims(output / "animation.usda") for output in (whole, less))
        self.assertEqual({name for name in prims if name not in fewer}, {'def TetMesh "cells"'})
        mesh, plain = (of['def Mesh "surface"'] for of in (prims, fewer))
        self.assertEqual({name for name in mesh if name not in plain}, {name for name in mesh if "normals" in name})
        self.assertEqual({name: mesh[name] for name in plain}, plain)
        self.assertLess((less / "animation.usda").stat().st_size, .75 * (whole / "animation.usda").stat().st_size)

    def test_usda_moves_shades_and_fills(self):
        """Velocities are those of implicit Euler; normals look away from the body; cells fill the boundary; materials."""
        self.write("bar.mtl", "newmtl paint of top\nKd 0.25 0.5 1\nNs 250\nmap_Kd sky.png\nnewmtl paint of front\nKd 1 0 0\nd 0.5\n")
        output = self.solve({**SCENE, "Output/Formats": "usda, vtu", "Output/Every": "1", "Time/End": "0.1"})
        prims = read_usda_prims(output / "animation.usda")
        mesh, cells = prims['def Mesh "surface"'], prims['def TetMesh "cells"']
        points, velocities = (list(mesh[name + ".timeSamples"].values()) for name in ("point3f[] points", "vector3f[] velocities"))
        self.assertEqual(set(flat(velocities[0])), {0})
        for before, after, velocity in zip(points, points[1:], velocities[1:]):
            for a, b, v in zip(flat(before), flat(after), flat(velocity), strict=True):
                self.assertAlmostEqual((b - a) / .02, v, delta=5e-5)
        self.assertEqual(mesh["normal3f[] normals (metadata)"], {"interpolation": "vertex"})
        for places, normals in zip(points, mesh["normal3f[] normals.timeSamples"].values()):
            for face in self.surface.faces:
                a, b, c = (places[i] for i in face[:3])
                u, v = ([q - p for p, q in zip(a, x)] for x in (b, c))
                n = [u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3] for i in range(3)]
                for i in face:
                    self.assertAlmostEqual(math.hypot(*normals[i]), 1, delta=1e-6)
                    if len(face) == 4:  # three corners of an end are nearly on a line
                        self.assertGreater(sum(p * q for p, q in zip(n, normals[i])) / math.hypot(*n), 0.)
        # cells: volumes are positive and sum to what the boundary encloses
        self.assertEqual(cells["uniform token purpose"], "guide")
        nodes = cells["point3f[] points.timeSamples"][0.]
        self.assertEqual(cells["float3[] extent.timeSamples"][0.], [(0, -.5, -.5), (4, .5, .5)])

        def sextuple(a, b, c):
            return (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]))
        volumes = []
        for cell in cells["int4[] tetVertexIndices"]:
            a, *others = (nodes[int(i)] for i in cell)
            volumes.append(sextuple(*([q - p for p, q in zip(a, x)] for x in others)) / 6)
        self.assertGreater(min(volumes), 0)
        self.assertAlmostEqual(sum(volumes), 4, delta=1e-6)
        faces = cells["int3[] surfaceFaceVertexIndices"]
        self.assertAlmostEqual(sum(sextuple(*(nodes[int(i)] for i in face)) for face in faces) / 6, 4, delta=1e-6)
        # materials
        materials = prims['def Scope "materials"']
        top = materials['def Material "paint_of_top"']
        self.assertEqual(top["token outputs:surface.connect"], "/body/materials/paint_of_top/surface.outputs:surface")
        self.assertEqual(top['def Shader "surface"']["color3f inputs:diffuseColor.connect"], "/body/materials/paint_of_top/image.outputs:rgb")
        self.assertEqual(top['def Shader "surface"']["float inputs:roughness"], .5)
        self.assertEqual(top['def Shader "image"']["asset inputs:file"], str(self.directory.resolve() / "sky.png"))
        front = materials['def Material "paint_of_front"']['def Shader "surface"']
        self.assertEqual((front["color3f inputs:diffuseColor"], front["float inputs:opacity"]), ((1, 0, 0), .5))
        subset = mesh['def GeomSubset "material_paint_of_top"']
        self.assertEqual(subset["rel material:binding"], "/body/materials/paint_of_top")
        self.assertEqual(subset["int[] indices"], [f for f, group in enumerate(self.surface.groups) if group == "top"])

    def test_unit_of_the_file(self):
        """Millimetres; no gravity, so up is y."""
        self.write("bar.obj", obj_text(bar_surface(unit=1000.)))
        output = self.solve({**SCENE, "Mesh/Box size": "4000, 1000, 1000", "Mesh/Scale": "1e-3", "Loads/Gravity": "0, 0, 0",
                             "Handles/left/Motion": "t; 0; 0", "Time/End": "0.1", "Examples/Pose functions": None,
                             "Examples/Importance": "0"})
        self.assertEqual(flat(read_ply(output / "frame_0000.ply")[0]), flat(bar_surface(unit=1000.).vertices))
        left = read_ply(output / "frame_0005.ply")[0][0]
        self.assertAlmostEqual(left[0], 100., delta=1e-9)
        layer, _ = read_usda(output / "animation.usda")
        self.assertEqual((layer["metersPerUnit"], layer["upAxis"]), (.001, "Y"))
        self.assertEqual(sorted(file.name for file in output.glob("weight_*")), [])
        self.assertTrue((output / "rest.obj").exists())

    def test_threads_and_resumed_runs_give_the_same_bytes(self):
        whole = results(self.solve(SCENE, "--threads", "1", output="whole"))
        names = {f"animation.{ending}" for ending in ("pvd", "mdd", "pc2", "usda")} | {"rest.obj", "weight_0.obj", "weight_1.obj"}
        self.assertLessEqual(names, whole.keys())
        self.assertEqual(len(whole), 7 * 6 + 7 + 2)
        self.assertEqual(results(self.solve(SCENE, "--threads", "2", output="threads")), whole)
        self.solve({**SCENE, "Time/End": "0.1"})  # its last frame, of step 5, is none of the whole run
        self.assertEqual(len(read_pc2(self.directory / "out/animation.pc2")[1]), 4)
        self.assertEqual(results(self.solve(SCENE, "--resume")), whole)

    def test_an_edited_scene_goes_on(self):
        kept = {**SCENE, "Output/Keep states": "true"}
        before = read_pc2(self.solve(kept) / "animation.pc2")[1]
        output = self.directory / "out"
        self.write("scene.prm", prm({**kept, "Examples/Pose functions": None, "Examples/Importance": "0"}))
        self.assertEqual(self.call("scene.prm", "--quiet", "--output", output, "--resume-from", "4").status, 0)
        after = read_pc2(output / "animation.pc2")[1]
        self.assertEqual((len(after), after[:3]), (len(before), before[:3]))
        self.assertNotEqual(after[3:], before[3:])
        self.assertEqual(sorted(file.name for file in output.glob("weight_*")), [])

        self.write("other.obj", obj_text(bar_surface()))
        self.write("scene.prm", prm({**kept, "Mesh/Surface": "other.obj"}))
        run = self.call("scene.prm", "--quiet", "--output", output, "--resume-from", "4")
        self.assertEqual(run.status, 1)
        self.assertIn("Mesh/Surface was", run.stderr)

    def test_shapes_of_painted_weights(self):
        """By a map that grows along the bar: the shapes of both parts sum to the whole pose."""
        places = list(enumerate(self.surface.vertices, 1))
        self.write("ramp.csv", "\ufeffvertex,w\n" + "".join(f"{i},{place[0] / 4!r}\n" for i, place in reversed(places)))
        short = {**SCENE, "Time/End": "0.02", "Output/Formats": "obj"}
        whole = read_obj(self.solve(short, output="whole") / "weight_1.obj")[0]
        painted = self.solve({**short, "Examples/Weight maps": "ramp.csv:w"}, output="painted")
        near, far = (read_obj(painted / name)[0] for name in ("weight_0_1.obj", "weight_1_1.obj"))
        for rest, end, *parts in zip(self.surface.vertices, whole, near, far):
            for x, u, *moved in zip(rest, end, *parts):
                self.assertAlmostEqual(sum(p - x for p in moved), u - x, delta=1e-9)
        for x, least, most in ((4, 0.9, 1), (2, 0.35, 0.65)):
            i = min(range(len(whole)), key=lambda i: abs(self.surface.vertices[i][0] - x))
            share = math.dist(far[i], self.surface.vertices[i]) / math.dist(whole[i], self.surface.vertices[i])
            self.assertTrue(least < share < most, share)

    def test_killed_and_interrupted_runs(self):
        long = {**SCENE, "Time/Step": "0.001", "Time/End": "0.3", "Output/Every": "3"}
        whole = results(self.solve(long, output="whole"))
        self.write("scene.prm", prm(long))
        arguments = ["--set", "Output/Checkpoint minutes=0"]
        for how, after in ((signal.SIGKILL, 60), (signal.SIGINT, 130)):
            process = subprocess.Popen([EXEMPLAR, "scene.prm", "--output", "out", "--quiet", *arguments], cwd=self.directory,
                                       stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            rows = self.directory / "out/statistics.csv"
            wait_until(lambda: rows.exists() and rows.read_bytes().count(b"\n") > after, process)
            process.send_signal(how)
            process.communicate(timeout=300)
            self.assertEqual(process.returncode, -9 if how == signal.SIGKILL else 130)
            arguments = ["--set", "Output/Checkpoint minutes=0", "--resume"]
        _, places = read_pc2(self.directory / "out/animation.pc2")  # readable after Ctrl-C
        self.assertTrue(40 < len(places) < 101, len(places))
        self.assertEqual(len(read_usda(self.directory / "out/animation.usda")[1]["point3f[] points.timeSamples"]), len(places))
        self.assertEqual(results(self.solve(long, "--resume")), whole)

    def test_an_earlier_run_is_cleared(self):
        self.solve(SCENE)
        output = self.solve({**SCENE, "Output/Formats": "vtu", "Mesh/Surface": None, "Time/End": "0.02"})
        self.assertEqual(sorted(file.name for file in output.iterdir()),
                         ["animation.pvd", "checkpoint.bin", "final.msh", "frame_0000.vtu", "frame_0001.vtu", "log.txt",
                          "original.prm", "parameters.prm", "statistics.csv", "summary.json"])

    def test_files_of_others_are_refused(self):
        output = self.solve(SCENE)
        before = results(output)
        for name in ("frame_0003.obj", "frame_0003.ply", "frame_0003.usda", "animation.mdd", "animation.pc2", "animation.usda",
                     "rest.obj", "weight_1.obj"):
            kept = (output / name).read_bytes() if (output / name).exists() else None
            (output / name).write_text("v 1 2 3, by somebody\n")
            for arguments in ((), ("--resume",)):
                run = self.attempt(SCENE, *arguments)
                self.assertEqual(run.status, 1, name)
                self.assertIn(f"holds {name}, which was not written by exemplar", run.stderr)
            (output / name).unlink()
            if kept is not None:
                (output / name).write_bytes(kept)
        self.assertEqual(results(output), before)

    def test_a_damaged_frame_is_named(self):
        for name, message in (("frame_0004.pc2", "is not the frame that this run has written"),
                              ("frame_0004.usda", "is not the frame that this run has written")):
            output = self.solve({**SCENE, "Time/End": "0.1"})
            (output / name).write_bytes((output / name).read_bytes()[:-10 if name.endswith("pc2") else 400])
            run = self.attempt(SCENE, "--resume")
            self.assertNotEqual(run.status, 0)
            self.assertIn(f"{name} {message}", run.stderr)

    def test_surfaces_that_cannot_be_shown(self):
        def refused(scene, *parts):
            for arguments in ((), ("--validate",)):
                run = self.call(self.write("scene.prm", prm(scene)), "--output", "none", *arguments)
                self.assertEqual(run.status, 1, run.stderr)
                for part in parts:
                    self.assertIn(part, run.stderr)
                self.assertFalse((self.directory / "none").exists())
        refused({**SCENE, "Mesh/Surface": None}, "the scene names none", "Set Mesh/Surface")
        refused({**SCENE, "Mesh/Surface": "none.obj"}, "none.obj")
        self.write("large.obj", obj_text(bar_surface(unit=1000.)))
        refused({**SCENE, "Mesh/Surface": "large.obj"}, "large.obj is not the surface of box: its vertex ",
                "times as large as the body", "Mesh/Scale", "set Mesh/Surface")
        self.write("away.obj", obj_text(self.surface, lambda x, y, z: (x, y + 3., z)))
        refused({**SCENE, "Mesh/Surface": "away.obj"}, "is farthest outside the body, by ", "(3 in the unit of the files)")
        self.solve({**SCENE, "Mesh/Surface": "away.obj", "Output/Formats": "vtu"})  # not looked at
        output = self.solve({**SCENE, "Mesh/Surface": "away.obj", "Output/Every": "0"}, output="no frames")
        self.assertEqual(sorted(file.name for file in output.glob("*.obj")), [])

    def test_shapes_are_the_poses(self):
        scene = {**SCENE, "Scene": "interpolation", "Handles/Names": None, "Handles/left/Select": None, "Loads/Gravity": None,
                 "Time/Step": None, "Time/End": None, "Time/Increments": "4", "Output/Every": "1"}
        output = self.solve(scene)
        self.assertEqual(read_obj(output / "rest.obj")[0], self.surface.vertices)
        self.assertEqual(read_obj(output / "weight_0.obj")[0], self.surface.vertices)
        pose = read_obj(output / "weight_1.obj")[0]
        for found, vertex in zip(pose, self.surface.vertices):
            for x, y in zip(found, bent(*vertex, angle=1.5707963267948966)):
                self.assertAlmostEqual(x, y, delta=.02)
        # at the end the body is in the pose, but for a rigid motion
        end = read_obj(output / "frame_0004.obj")[0]
        for i in range(0, len(pose) - 1, 7):
            self.assertAlmostEqual(sum((a - b) ** 2 for a, b in zip(pose[i], pose[-1])) ** .5,
                                   sum((a - b) ** 2 for a, b in zip(end[i], end[-1])) ** .5, delta=1e-5)
        layer, mesh = read_usda(output / "animation.usda")
        self.assertEqual((layer["timeCodesPerSecond"], list(mesh["point3f[] points.timeSamples"])), (24, [0, 1, 2, 3, 4]))

    def test_a_pose_comes_back_within_the_error_that_was_reported(self):
        self.write_box(SCENE, "box.msh")
        self.write("bow.obj", obj_text(self.surface, lambda x, y, z: bent(x, y, z, angle=2.)))
        run = self.call("pose", "--mesh", "box.msh", "--rest", "bar.obj", "--pose", "bow.obj", "--output", "poses", "--quiet")
        self.assertEqual((run.status, run.stderr), (0, ""))
        with open(self.directory / "poses/poses.csv") as file:
            row, = csv.DictReader(file)
        output = self.solve({"Scene": "interpolation", "Mesh/File": "box.msh", "Mesh/Surface": "bar.obj",
                             "Examples/Poses": "poses/bow.msh", "Time/Increments": "2", "Output/Formats": "obj"})
        used = sorted(set(flat(self.surface.faces)))
        pose = read_obj(self.directory / "bow.obj")[0]
        carried, end = (read_obj(output / name)[0] for name in ("weight_1.obj", "frame_0002.obj"))
        percent = [100 * sum((a - b) ** 2 for a, b in zip(carried[v], pose[v])) ** .5 / 18 ** .5 for v in used]
        self.assertAlmostEqual(max(percent), float(row["surface_error_max"]), delta=1e-6)
        self.assertAlmostEqual(sum(percent) / len(percent), float(row["surface_error_mean"]), delta=1e-6)
        self.assertLess(max(percent), 2.)
        # the run that is only this example, but for a rigid motion
        for v in used[1:]:
            self.assertAlmostEqual(sum((a - b) ** 2 for a, b in zip(end[v], end[0])) ** .5,
                                   sum((a - b) ** 2 for a, b in zip(carried[v], carried[0])) ** .5, delta=1e-4)

    def test_shapes_of_regions_sum_to_the_pose(self):
        box = self.write_box(SCENE, "box.msh")
        elements = [(*e[:3], 1 + (max(box.nodes[n][0] for n in e[-4:]) > 2.1), *e[4:]) if e[1] == 4 else e
                    for e in box.elements]
        write_msh(self.directory / "two.msh", box._replace(elements=elements))
        output = self.solve({**SCENE, "Mesh/Generator": None, "Mesh/File": "two.msh", "Mesh/Box size": None,
                             "Mesh/Box cells": None, "Handles/left/Select": "box -1 -1 -1 0 1 1", "Time/End": "0.04",
                             "Examples/Weights per region": "true"})
        names = sorted(file.name for file in output.glob("weight_*.obj"))
        self.assertEqual(names, ["weight_1_0.obj", "weight_1_1.obj", "weight_2_0.obj", "weight_2_1.obj"])
        whole = read_obj(self.solve({**SCENE, "Time/End": "0.04"}, output="one") / "weight_1.obj")[0]
        left, right = (read_obj(output / f"weight_{region}_1.obj")[0] for region in (1, 2))
        for rest, a, b, expected in zip(self.surface.vertices, left, right, whole):
            for c in range(3):
                self.assertAlmostEqual(a[c] + b[c] - rest[c], expected[c], delta=1e-9)
        with open(output / "statistics.csv") as file:
            self.assertLessEqual({name[:-4] for name in names}, set(next(csv.reader(file))))


if __name__ == "__main__":
    unittest.main()
