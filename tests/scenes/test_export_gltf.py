# SPDX-License-Identifier: GPL-3.0-or-later
"""exemplar export --gltf: what players read is what the run has written, as far as the program says; materials; refusals."""

import json
import base64
import math
import os
import re
import shutil
import struct
import subprocess
import unittest
import zlib

from exemplar_runner import REPOSITORY, SceneTest, bend, bent, read_csv
from gltf_reader import Gltf
from surface_bar import bar_surface, obj_text, read_obj, read_pc2

SCENE = {
    "Scene": "dynamic",
    "Mesh/Generator": "box",
    "Mesh/Box size": "4, 1, 1",
    "Mesh/Box cells": "8, 2, 2",
    "Mesh/Surface": "bar.obj",
    "Mesh/Carry": "coat.obj",
    "Material/Young's modulus": "1e5",
    "Examples/Pose functions": bend("pi/2") + " | " + bend("-pi/2"),
    "Examples/Importance": "0.9",
    "Handles/Names": "left",
    "Handles/left/Select": "boundary 1",
    "Handles/left/Motion": "0.3*t; 0.2*sin(2*t); 0",
    "Loads/Gravity": "0, 0, -5",
    "Time/Step": "0.05",
    "Time/End": "0.83",
    "Output/Every": "2",
    "Output/Formats": "pc2",
}
# of the body alone, by its frames in vtu
PLAIN = {**{key: value for key, value in SCENE.items() if key not in ("Mesh/Surface", "Mesh/Carry")}, "Output/Formats": "vtu",
         "Mesh/Generator": None, "Mesh/Box size": None, "Mesh/Box cells": None, "Mesh/File": "bar.msh", "Mesh/Scale": "0.5",
         "Examples/Pose functions": bend("-pi/2"), "Examples/Poses": "bent.msh", "Handles/left/Select": "box -1 -1 -1 0.01 1 1"}
MATERIALS = """# by an artist
newmtl paint of top
Kd 0.25 0.5 1
Ns 250
map_Kd -s 1 1 1 the sky.png
newmtl paint of front
Kd 1 0 0
d 0.5
Ke 0 0 0.125
"""
BLENDER = shutil.which("blender")


def single(x):
    return struct.unpack("f", struct.pack("f", x))[0]


def png():
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">2I5B", 1, 1, 8, 2, 0, 0, 0)) + chunk(b"IDAT", zlib.compress(b"\0\1\2\3"))
            + chunk(b"IEND", b""))


class ExportGltf(SceneTest):
    def setUp(self):
        super().setUp()
        self.write("bar.obj", obj_text(bar_surface()))
        self.write("bar.mtl", MATERIALS)
        self.write("coat.obj", obj_text(bar_surface(), lambda x, y, z: (x, 1.1 * y, 1.1 * z)).replace("mtllib bar.mtl\n", "").replace("paint", "cloth"))
        (self.directory / "the sky.png").write_bytes(png())

    def export(self, output="out", *words, file="run.glb"):
        """(numbers that are said: frames, vertices, examples, shapes, error [m], in % of the diagonal; warnings)."""
        run = self.call("export", output, "--gltf", file, *words)
        self.assertEqual(run.status, 0, run.stderr)
        self.last = run.stdout
        said = re.fullmatch(re.escape(file) + r": (\d+) frames? of (\d+) vertices in the order of the surface and \d+ copies at seams, (\d+) examples? and (\d+) shapes?, [\d.]+ MB; vertices are off by "
                            r"(\S+) m at most, (\S+) % of the diagonal\n", run.stdout.splitlines(keepends=True)[0])
        return [float(number) for number in said.groups()], run.stderr

    def refuse(self, *words, output="out", arguments=("--gltf", "run.glb")):
        run = self.call("export", output, *arguments)
        self.assertEqual((run.status, run.stdout), (1, ""), run.stderr)
        for word in words:
            self.assertIn(word, run.stderr)

    def error(self, gltf, name, rest, frames):
        """The largest distance of a vertex from where the run has it; vertices are those of the run, in its order, but for what no face
        uses."""
        _, mesh = gltf.meshes()[name]
        used = {i for primitive in mesh["primitives"] for i, in gltf.accessor(primitive["indices"])}
        places = gltf.accessor(mesh["primitives"][0]["attributes"]["POSITION"])
        self.assertEqual([tuple(map(single, rest[v])) for v in sorted(used)], [places[v] for v in sorted(used)])
        worst, found = 0., list(gltf.frames(name))
        self.assertEqual(len(found), len(frames))
        for places, frame in zip(found, frames):
            worst = max([worst, *(math.dist(places[v], frame[3 * v:3 * v + 3]) for v in used)])
        return worst, used

    def measured(self, output="out"):
        """The error of run.glb by the point caches of a run of SCENE."""
        gltf, worst = Gltf(self.directory / "run.glb"), 0.
        for name, end in (("body", ""), ("coat", "_coat")):
            rest, _ = read_obj(self.directory / output / f"rest{end}.obj")
            error, used = self.error(gltf, name, rest, read_pc2(self.directory / output / f"animation{end}.pc2")[1])
            self.assertEqual(used, set(range(len(rest) - 1)))  # no face uses the last
            worst = max(worst, error)
        return gltf, worst

    def test_keys_that_add_up(self):
        """Names and poses are those of their weights, which are counted from 1 without one of the rest pose."""
        output = self.solve({**SCENE, "Examples/Weights": "additive"})
        self.export()
        gltf, _ = self.measured()
        rows = read_csv(output)
        self.assertNotIn("weight_0", rows[0])
        self.assertGreater(max(row["weight_1"] for row in rows), .05)
        for _, mesh in gltf.meshes().values():
            self.assertEqual(mesh["extras"]["targetNames"][:2], ["example 1", "example 2"])
        for key, step in zip(gltf.keys(2, "weights"), [*range(0, 17, 2), 17], strict=True):
            self.assertEqual(key[:2], [single(rows[step][f"weight_{i}"]) for i in (1, 2)])
        self.write_box(SCENE, "bar.msh")
        self.write_box(SCENE, "bent.msh", lambda x, y, z: bent(x, y, z, math.pi / 2))
        output = self.solve({**PLAIN, "Examples/Weights": "additive"}, output="plain")
        self.export("plain")
        gltf = Gltf(self.directory / "run.glb")
        self.assertEqual(gltf.json["meshes"][0]["extras"]["targetNames"][0], "bent")
        self.assertEqual([key[0] for key in gltf.keys(2, "weights")],
                         [single(read_csv(output)[step]["weight_1"]) for step in [*range(0, 17, 2), 17]])

    def test_error_said_is_error_measured(self):
        output = self.solve(SCENE)
        rows = read_csv(output)
        errors = []
        for n_shapes in (None, 0, 4, 8):
            said, warnings = self.export("out", *(["--shapes", str(n_shapes)] if n_shapes is not None else []))
            gltf, error = self.measured()
            self.assertAlmostEqual(said[4] / error, 1., delta=1e-3)
            diagonal = math.hypot(4, 1, 1)
            self.assertAlmostEqual(said[5], 100 * error / diagonal, delta=1e-3)
            n = int(said[3])
            self.assertEqual(said[:3], [10, 2 * len(bar_surface().vertices), 2])
            if n_shapes is None:
                self.assertLess(said[5], .5)
            else:
                self.assertEqual(n, n_shapes)
                errors.append(error)
            self.assertEqual("morph targets" in warnings, n + 2 > 8)
            for _, mesh in gltf.meshes().values():
                self.assertEqual(mesh["extras"]["targetNames"], ["example 1", "example 2"] + [f"shape {i + 1}" for i in range(n)])
            keys = gltf.keys(2, "weights")
            self.assertEqual(keys, gltf.keys(3, "weights"))
            for key, step in zip(keys, [*range(0, 17, 2), 17], strict=True):
                self.assertEqual(key[:2], [single(rows[step][f"weight_{i}"]) for i in (1, 2)])
                self.assertTrue(all(0 <= w <= 1 for w in key))
                self.assertEqual(key[2:3], [1][:n])
        self.assertEqual([single(rows[step]["time"]) for step in [*range(0, 17, 2), 17]], gltf.times)
        self.assertGreater(errors[0], 5 * errors[1])
        self.assertGreater(errors[1], 5 * errors[2])
        # z is up in the run, y in glTF
        half = single(math.sqrt(.5))
        for a, b in zip(gltf.json["nodes"][0]["rotation"], [-half, 0, 0, half], strict=True):
            self.assertAlmostEqual(a, b, delta=1e-7)

    def test_quaternions_turn_the_short_way(self):
        turning = "x*(cos(3*t)-1)-y*sin(3*t); x*sin(3*t)+y*(cos(3*t)-1); 0"
        self.solve({**SCENE, "Handles/left/Motion": turning, "Loads/Gravity": "0, 0, 0", "Time/Step": "0.02", "Time/End": "1.6",
                    "Material/Young's modulus": "1e6", "Time/Mass damping": "1"})
        self.export()
        gltf, _ = self.measured()
        self.assertNotIn("rotation", gltf.json["nodes"][0])
        keys = gltf.keys(1, "rotation")
        for a, b in zip(keys, keys[1:]):
            self.assertGreater(sum(x * y for x, y in zip(a, b)), 0.)
            self.assertAlmostEqual(math.hypot(*b), 1., delta=1e-6)
        self.assertGreater(max(math.acos(min(1., abs(q[3]))) for q in keys), 1.)

    def test_faces_textures_and_materials(self):
        self.solve(SCENE)
        self.export()
        gltf = Gltf(self.directory / "run.glb")
        surface = bar_surface()
        named = gltf.json["materials"]
        _, body = gltf.meshes()["body"]
        groups = dict(zip([named[primitive["material"]]["name"] for primitive in body["primitives"]], body["primitives"]))
        self.assertEqual(sorted(groups), sorted("paint of " + group for group in ("bottom", "top", "front", "back", "ends")))
        number = {tuple(map(single, x)): i for i, x in enumerate(surface.vertices)}
        for name, primitive in groups.items():
            faces = [face for face, group in zip(surface.faces, surface.groups) if "paint of " + group == name]
            indices = [i for i, in gltf.accessor(primitive["indices"])]
            places = gltf.accessor(primitive["attributes"]["POSITION"])
            texture = gltf.accessor(primitive["attributes"]["TEXCOORD_0"])
            self.assertEqual(len(indices), 3 * sum(len(face) - 2 for face in faces))
            self.assertEqual([number[x] for x in places[:-1]], list(range(len(places) - 1)))  # no face uses the last
            for i in set(indices):
                u, v = texture[i]
                expected = surface.texture[number[places[i]]]
                self.assertAlmostEqual(u, expected[0], delta=1e-6)
                self.assertAlmostEqual(1 - v, expected[1], delta=1e-6)
            # edges of triangles that are met once are those of the polygons, in their direction
            corners = [number[places[i]] for i in indices]
            edges = {(corners[k + i], corners[k + (i + 1) % 3]) for k in range(0, len(corners), 3) for i in range(3)}
            polygons = {(face[i - 1], face[i]) for face in faces for i in range(len(face))}
            self.assertEqual({e for e in edges if e[::-1] not in edges}, {e for e in polygons if e[::-1] not in polygons})
        material = {each["name"]: each for each in named}
        self.assertEqual(material["paint of bottom"], {"name": "paint of bottom"})
        top, front = material["paint of top"]["pbrMetallicRoughness"], material["paint of front"]
        self.assertEqual((top["baseColorFactor"], top["roughnessFactor"], top["baseColorTexture"]), ([1, 1, 1, 1], .5, {"index": 0}))
        self.assertEqual((front["pbrMetallicRoughness"]["baseColorFactor"], front["alphaMode"], front["emissiveFactor"]),
                         ([1, 0, 0, .5], "BLEND", [0, 0, .125]))
        image, = gltf.json["images"]
        view = gltf.json["bufferViews"][image["bufferView"]]
        self.assertEqual(gltf.bytes[view["byteOffset"]:view["byteOffset"] + view["byteLength"]], png())
        _, coat = gltf.meshes()["coat"]
        self.assertTrue(all(named[primitive["material"]]["doubleSided"] for primitive in coat["primitives"]))

        # what is missing is told, not refused; a copy in the run's directory is found
        (self.directory / "the sky.png").write_text("no picture")
        self.assertIn("'the sky.png' is no PNG or JPEG", re.sub(r"\S*/the", "'the", self.export()[1]))
        (self.directory / "bar.mtl").rename(self.directory / "out/bar.mtl")
        self.assertIn("the sky.png", self.export()[1])
        (self.directory / "out/bar.mtl").unlink()
        self.assertIn("The material library 'bar.mtl' of body is missing", self.export()[1])

    def test_texture_coordinates_of_a_ply(self):
        surface = bar_surface()
        head = f"ply\nformat ascii 1.0\nelement vertex {len(surface.vertices)}\n" + "".join(f"property float {c}\n" for c in "xyz")
        faces = f"element face {len(surface.faces)}\nproperty list uchar int vertex_indices\n"

        def line(*numbers):
            return " ".join(map(repr, numbers)) + "\n"
        of_vertices = (head + "property float u\nproperty float v\n" + faces + "end_header\n"
                       + "".join(line(*x, *t) for x, t in zip(surface.vertices, surface.texture))
                       + "".join(line(len(face), *face) for face in surface.faces))
        of_faces = (head + faces + "property list uchar float texcoord\nend_header\n" + "".join(line(*x) for x in surface.vertices)
                    + "".join(line(len(face), *face, 2 * len(face), *(c for i in face for c in surface.texture[i])) for face in surface.faces))
        number = {tuple(map(single, x)): i for i, x in enumerate(surface.vertices)}
        for text in of_vertices, of_faces:
            self.write("bar.ply", text)
            self.solve({**SCENE, "Mesh/Surface": "bar.ply", "Mesh/Carry": None, "Time/End": "0.1"})
            self.export()
            gltf = Gltf(self.directory / "run.glb")
            primitive, = gltf.json["meshes"][0]["primitives"]
            places, texture = (gltf.accessor(primitive["attributes"][name]) for name in ("POSITION", "TEXCOORD_0"))
            for x, (u, v) in zip(places[:-1], texture):  # no face uses the last
                self.assertAlmostEqual(u, surface.texture[number[x]][0], delta=1e-6)
                self.assertAlmostEqual(1 - v, surface.texture[number[x]][1], delta=1e-6)

    def test_copies_at_seams_are_behind_the_vertices(self):
        """Each face has a texture of its own, so that the corners of a box have three texture points each."""
        surface = bar_surface()
        faces, texture = [], []
        for k, face in enumerate(surface.faces):
            faces.append("f " + " ".join(f"{v + 1}/{len(texture) + i + 1}" for i, v in enumerate(face)))
            texture += [(k + .1 * i, .5) for i in range(len(face))]
        self.write("bar.obj", "".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in surface.vertices)
                   + "".join(f"vt {u!r} {v!r}\n" for u, v in texture) + "\n".join(faces) + "\n")
        self.solve({**SCENE, "Mesh/Carry": None, "Time/End": "0.1"})
        self.export()
        primitive, = Gltf(self.directory / "run.glb").json["meshes"][0]["primitives"]
        gltf = Gltf(self.directory / "run.glb")
        places, at = (gltf.accessor(primitive["attributes"][name]) for name in ("POSITION", "TEXCOORD_0"))
        indices, used = [i for i, in gltf.accessor(primitive["indices"])], {v for face in surface.faces for v in face}
        n = len(surface.vertices)
        self.assertEqual([places[v] for v in sorted(used)], [tuple(map(single, surface.vertices[v])) for v in sorted(used)])
        self.assertEqual(len(places), n + len(texture) - len(used))
        found = set()  # (vertex, texture point) of each corner
        for i in indices:
            vertex = places.index(places[i])
            self.assertTrue(vertex < n)
            found.add((vertex, single(at[i][0])))
        self.assertEqual(found, {(v, single(k + .1 * i)) for k, face in enumerate(surface.faces) for i, v in enumerate(face)})

    def test_contact_has_more_shapes_and_obstacles(self):
        """A bar falls onto a slope and a moving ball: the file has both, and the error is a tenth of that without contact."""
        self.solve({**SCENE, "Mesh/Carry": None, "Handles/Names": None, "Handles/left/Select": None, "Handles/left/Motion": None,
                    "Obstacles/Names": "slope, ball", "Obstacles/slope/Shape": "plane 0 0 -0.6  0.1 0 1", "Obstacles/ball/Shape": "sphere 2 0 2 0.4",
                    "Obstacles/ball/Motion": "0; 0; -1.2*t", "Obstacles/ball/Turn": "0; t; 0", "Obstacles/ball/Until": "0.6"})
        said, _ = self.export("out", "--shapes", "1")
        gltf = Gltf(self.directory / "run.glb")
        nodes = {node["name"]: i for i, node in enumerate(gltf.json["nodes"])}
        self.assertEqual(gltf.json["nodes"][0]["children"], [1, nodes["slope"], nodes["ball"]])
        ball = gltf.accessor(gltf.json["meshes"][gltf.json["nodes"][nodes["ball"]]["mesh"]]["primitives"][0]["attributes"]["POSITION"])
        self.assertAlmostEqual(max(math.hypot(*x) for x in ball), .4, delta=1e-6)
        moved, sizes = (gltf.keys(nodes["ball"], path) for path in ("translation", "scale"))
        for time, place, size in zip(gltf.times, moved, sizes):
            self.assertEqual(size[0], 1 if time < .6 - 1e-6 else 0)
            if size[0]:
                self.assertLess(math.dist(place, (2, 0, 2 - 1.2 * time)), 1e-5)
        level = gltf.accessor(gltf.json["meshes"][gltf.json["nodes"][nodes["slope"]]["mesh"]]["primitives"][0]["attributes"]["POSITION"])
        middle = gltf.keys(nodes["slope"], "translation")[0]
        for x in level:
            self.assertAlmostEqual(.1 * (x[0] + middle[0]) + x[2] + middle[2] + .6, 0, delta=1e-5)
        crossing = re.search(r"pass through each other in (\d+) of \d+ frames, by (\S+) m at most", self.last)
        self.assertGreater(float(crossing[2]), 1e-3)  # one shape is too few
        few = said[4]
        said, _ = self.export()
        self.assertLess(said[5], .05)
        self.assertLess(said[4], few)
        self.assertIn("2 obstacles are in the file", self.last)
        crossing = re.search(r"by (\S+) m at most. For less", self.last)
        self.assertLess(float(crossing[1]) if crossing else 0., 2e-3)

    def test_normals(self):
        self.solve({**SCENE, "Mesh/Carry": None})
        self.export("out", "--normals", "--shapes", "8")
        gltf = Gltf(self.directory / "run.glb")
        primitive = gltf.json["meshes"][0]["primitives"]
        triangles, places = [], list(gltf.frames("body"))
        for one in primitive:
            indices = [i for i, in gltf.accessor(one["indices"])]
            triangles += [indices[i:i + 3] for i in range(0, len(indices), 3)]
        for frame, normals in zip(places, gltf.frames("body", "NORMAL")):
            for triangle in triangles:
                a, b, c = (frame[v] for v in triangle)
                u, v = ([q - p for p, q in zip(a, x)] for x in (b, c))
                n = [u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3] for i in range(3)]
                for vertex in triangle:  # of a box, corners included
                    m = normals[vertex]
                    cosine = sum(p * q for p, q in zip(n, m)) / math.hypot(*n) / math.hypot(*m)
                    self.assertGreater(cosine, .4)
                    self.assertAlmostEqual(math.hypot(*m), 1., delta=.2)

    def test_a_run_without_a_surface(self):
        self.write_box(SCENE, "bar.msh")
        self.write_box(SCENE, "bent.msh", lambda x, y, z: bent(x, y, z, math.pi / 2))
        output = self.solve(PLAIN)
        said, warnings = self.export()
        self.assertIn("become part of the shapes", warnings)  # the one by formula
        gltf = Gltf(self.directory / "run.glb")
        frames = [self.points(output / f"frame_{step:04}.vtu") for step in [*range(0, 17, 2), 17]]
        moved = self.points(output / "frame_0000.vtu", "displacement")
        rest = [tuple(frames[0][i + c] - moved[i + c] for c in range(3)) for i in range(0, len(moved), 3)]
        # the file has the nodes of the boundary, in their order
        node = {tuple(map(single, x)): i for i, x in enumerate(rest)}
        boundary = [node[x] for x in gltf.accessor(gltf.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"])]
        self.assertEqual(boundary, sorted(set(boundary)))
        error, used = self.error(gltf, "body", [rest[i] for i in boundary],
                                 [[x for i in boundary for x in frame[3 * i:3 * i + 3]] for frame in frames])
        self.assertAlmostEqual(said[4] / error, 1., delta=1e-3)
        self.assertEqual((said[0], said[1], said[2], len(used)), (10, len(used), 1, len(used)))
        self.assertEqual(gltf.json["meshes"][0]["extras"]["targetNames"][0], "bent")
        self.assertEqual([key[0] for key in gltf.keys(2, "weights")],
                         [single(read_csv(output)[step]["weight_1"]) for step in [*range(0, 17, 2), 17]])
        # the pose is that of the file, up to a rigid motion: distances in it are
        target = gltf.accessor(gltf.json["meshes"][0]["primitives"][0]["targets"][0]["POSITION"])
        places = gltf.accessor(gltf.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"])
        for a, b in ((0, len(places) - 1), (3, len(places) // 2)):
            x, y = ([p + d for p, d in zip(places[v], target[v])] for v in (a, b))
            exact = [[.5 * c for c in bent(*(2 * c for c in places[v]), math.pi / 2)] for v in (a, b)]
            self.assertAlmostEqual(math.dist(x, y), math.dist(*exact), delta=1e-6)
        # a pose that has changed since
        (self.directory / "run.glb").unlink()
        pose = (self.directory / "bent.msh").read_text()
        self.write("bent.msh", pose + "\n")
        self.refuse("bent.msh", "has changed since the run")
        (self.directory / "bent.msh").unlink()
        self.refuse("bent.msh", "is missing")
        self.assertFalse((self.directory / "run.glb").exists())

    def points(self, file, name="Points"):
        text = re.search(f' Name="{name}"[^>]*>([^<]*)<', file.read_text())[1]
        data = zlib.decompress(base64.b64decode(text[44:]))
        return struct.unpack(f"<{len(data) // 8}d", data)

    def test_statics_play_at_24_frames_a_second(self):
        self.solve({**SCENE, "Scene": "static", "Time/Step": None, "Time/End": None, "Time/Increments": "8", "Mesh/Carry": None,
                    "Output/Formats": "mdd"})
        self.export()
        self.assertEqual(Gltf(self.directory / "run.glb").times, [single(k / 24) for k in range(5)])

    def test_what_is_refused(self):
        output = self.solve(SCENE)
        (self.directory / "run.glb").write_bytes(b"glTF\2\0\0\0" + bytes(100))
        self.refuse("was not written by exemplar", "Nothing has been changed")
        (self.directory / "run.glb").unlink()
        self.export()
        self.export()  # over its own
        (self.directory / "run.glb").unlink()
        self.refuse("ends in .glb", arguments=("--gltf", "run.gltf"))
        self.refuse("no directory", arguments=("--gltf", "no/run.glb"))
        self.refuse("give one of them", arguments=("--gltf", "run.glb", "--html", "run.html"))
        self.refuse("--shapes and --normals are those of --gltf", arguments=("--html", "run.html", "--shapes", "4"))
        self.refuse("one run", arguments=("out", "--gltf", "run.glb"))
        self.refuse("whole number from 0 to 1000", arguments=("--gltf", "run.glb", "--shapes", "1001"))
        self.refuse("no parameters.prm", output=".")
        self.refuse("is no directory", output="bar.obj")
        for name, change, words in (
                ("rest.obj", lambda text: text.replace(b"# a shape", b"# another"), "not the one that the run has written"),
                ("rest.obj", lambda text: text.replace(b"\nv ", b"\nv 0 0 0\nv ", 1), "the cache moves"),
                ("weight_1.obj", lambda text: text.replace(b"\nv ", b"\nv 0 0 0\nv ", 1), "another number of vertices"),
                ("weight_1.obj", None, "weight_1.obj is missing"), ("animation_coat.pc2", None, "animation_coat.pc2 is missing"),
                ("animation.pc2", lambda data: data[:-12], "truncated"), ("frame_0002.pc2", None, "10 frames, but 9 files"),
                ("statistics.csv", lambda text: text[:-len(text) // 3], "has no row of step"), ("statistics.csv", None, "is missing"),
                ("animation.pc2", lambda data: data[:-12] + struct.pack("<3f", 1e31, 0, 0), "too far away"),
                ("animation.pc2", lambda data: data[:-12] + struct.pack("<3f", math.nan, 0, 0), "no finite")):
            with self.subTest(name, words=words):
                data = (output / name).read_bytes()
                (output / name).unlink()
                if change:
                    self.assertNotEqual(change(data), data)
                    (output / name).write_bytes(change(data))
                self.refuse(words)
                (output / name).write_bytes(data)
        self.assertFalse((self.directory / "run.glb").exists())
        self.export()
        self.solve({**SCENE, "Output/Formats": "ply, vtu"})
        (self.directory / "run.glb").unlink()
        self.refuse("with pc2 among Output/Formats")

    @unittest.skipUnless(BLENDER, "there is no blender (Debian: apt-get install blender)")
    def test_blender_sees_the_same(self):
        self.solve(SCENE)
        self.export()
        gltf = Gltf(self.directory / "run.glb")
        done = subprocess.run([BLENDER, "--background", "--factory-startup", "--python-exit-code", "1", "--python",
                               REPOSITORY / "tests/blender/read_gltf.py", "--", self.directory / "run.glb", self.directory / "result.json"],
                              cwd=self.directory, text=True, env={**os.environ, "PATH": "/usr/bin:/bin"}, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, timeout=300)
        self.assertEqual(done.returncode, 0, done.stdout)
        result = json.loads((self.directory / "result.json").read_text())
        for name in "body", "coat":
            # Blender turns y up back to z up, and parts a mesh by material
            parts = [sorted({i for i, in gltf.accessor(primitive["indices"])}) for primitive in gltf.meshes()[name][1]["primitives"]]
            found, expected = result[name], [[frame[v] for part in parts for v in part] for frame in gltf.frames(name)]
            self.assertEqual(len(found["frames"]), len(expected))
            for a, b in zip(found["frames"], expected):
                self.assertLess(max(abs(p - q) for x, y in zip(a, b, strict=True) for p, q in zip(x, y)), 2e-5)
            self.assertEqual(found["keys"], ["example 1", "example 2"] + [f"shape {i + 1}" for i in range(len(found["keys"]) - 2)])
            self.assertTrue(found["uv"])
        self.assertEqual(sorted(result["body"]["materials"]), sorted("paint of " + g for g in ("bottom", "top", "front", "back", "ends")))


if __name__ == "__main__":
    unittest.main()
