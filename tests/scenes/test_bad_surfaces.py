# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces and poses that are none, one by one, given to `exemplar mesh`, `exemplar pose` and scenes: each ends with status 1
and one message that has the place and the remedy, and nothing is written."""

import math
import struct
import sys
import unittest

import surfaces
from bad_inputs import NO_MESSAGE
from exemplar_runner import SceneTest, bent, prm
from surfaces import cube, joined, moved
from test_surface_scenes import bar, write_ply

NAN = float("nan")
SCENE = {"Scene": "static", "Mesh/File": "rest.obj", "Mesh/Cells": "100", "Time/Increments": "1", "Handles/Names": "left",
         "Handles/left/Select": "boundary left"}
ORDER = "export both from the same model"


def without(n):
    """A cube that lacks its last faces."""
    vertices, faces = cube()
    return vertices, faces[:-n]


def with_face(*face, vertex=None):
    vertices, faces = cube()
    return vertices + ([vertex] if vertex else []), [*faces, face]


def changed(number, place):
    """A cube with a vertex, counted from 1, elsewhere."""
    vertices, faces = cube()
    return [place if i == number - 1 else v for i, v in enumerate(vertices)], faces


def moebius(n=24):
    """A closed band of half a turn."""
    vertices = []
    for i in range(n):
        a = 2 * math.pi * i / n
        for side in (-.3, .3):
            r = 1 + side * math.cos(a / 2)
            vertices.append((r * math.cos(a), r * math.sin(a), side * math.sin(a / 2)))
    faces = []
    for i in range(n):
        a, b = 2 * i, 2 * i + 1
        c, d = (2 * i + 2, 2 * i + 3) if i < n - 1 else (1, 0)
        faces += [(a, c, d), (a, d, b)]
    return vertices, faces


def klein(n=24, m=12):
    """A closed surface with one side, which passes through itself: Klein's bottle as a figure of eight."""
    vertices, index = [], {}
    for i in range(n):
        for j in range(m):
            u, v = 2 * math.pi * i / n, 2 * math.pi * (j + .5) / m
            r = 3 + math.cos(u / 2) * math.sin(v) - math.sin(u / 2) * math.sin(2 * v)
            index[i, j] = len(vertices)
            vertices.append((r * math.cos(u), r * math.sin(u), math.sin(u / 2) * math.sin(v) + math.cos(u / 2) * math.sin(2 * v)))

    def at(i, j):
        return index[i, j % m] if i < n else index[0, (m - 1 - j) % m]
    faces = []
    for i in range(n):
        for j in range(m):
            a, b, c, d = at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)
            faces += [(a, b, c), (a, c, d)]
    return vertices, faces


def ply_head(vertices, faces, form="ascii"):
    return "\n".join(["ply", f"format {form} 1.0", f"element vertex {vertices}", *(f"property float {c}" for c in "xyz"),
                      f"element face {faces}", "property list uchar int vertex_indices", "end_header", ""]).encode()


def binary_ply():
    vertices, faces = cube()
    return (ply_head(8, 12, "binary_little_endian") + b"".join(struct.pack("<3f", *v) for v in vertices)
            + b"".join(struct.pack("<B3i", 3, *f) for f in faces))


def binary_stl(vertices, faces):
    return bytes(80) + struct.pack("<I", len(faces)) + b"".join(
        struct.pack("<12fH", 0, 0, 0, *(x for v in face for x in vertices[v]), 0) for face in faces)


def obj_text(vertices, faces):
    return "".join(f"v {x} {y} {z}\n" for x, y, z in vertices) + "".join(
        "f " + " ".join(str(v + 1) for v in face) + "\n" for face in faces)


CUBE = obj_text(*cube())

# name: (file name, its content: (vertices, faces) or text or bytes, words of the message); where all that take a surface
# read it alike
NO_FILES = {
    "empty file": ("bad.obj", "", ["bad.obj: the file is empty", "Save the surface anew"]),
    "only points and lines": ("bad.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2\np 3\n",
                              ["3 vertices and 0 faces", "Export the object as a mesh of polygons"]),
    "coordinate that is not a number": ("bad.obj", changed(8, (1, NAN, 1)), ["vertex 8 of 8", "no finite number", "Correct"]),
    "infinite coordinate": ("bad.obj", changed(2, (math.inf, 0, 0)), ["vertex 2 of 8", "no finite number"]),
    "huge coordinate": ("bad.obj", changed(3, (0, 1e300, 0)), ["vertex 3 of 8", "beyond 1e100", "Correct"]),
    "text where a number should be": ("bad.obj", CUBE.replace("v 1.0 0.0 0.0", "v one 0 0"),
                                      ["bad.obj, line 2: expected a number, found 'one'"]),
    "vertex of two coordinates": ("bad.obj", CUBE.replace("v 1.0 0.0 0.0\n", "v 1 0\n"), ["bad.obj, line 2: "]),
    "index out of range": ("bad.obj", CUBE + "f 1 2 99\n", ["line 21: a face uses vertex 99, but the file has 8 vertices"]),
    "index 0": ("bad.obj", CUBE + "f 0 1 2\n", ["line 21: ", "0"]),
    "index that is no number": ("bad.obj", CUBE + "f 1 two 3\n", ["line 21: expected an integer, found 'two'"]),
    "face of two vertices": ("bad.obj", CUBE + "f 1 2\n", ["line 21: "]),
    "bytes that are no text": ("bad.obj", b"\x89PNG\r\n\x1a\n" + bytes(range(256)), ["bad.obj"]),
    "truncated binary PLY": ("bad.ply", binary_ply()[:-5], ["bad.ply: ends after 11 of 12 elements of 'face'; the file is truncated", "anew"]),
    "binary PLY cut in its vertices": ("bad.ply", binary_ply()[:-200], ["bad.ply: ends after 4 of 8 elements of 'vertex'"]),
    "PLY with huge counts": ("bad.ply", ply_head(4000000000, 4000000000), ["bad.ply"]),
    "PLY with counts beyond any number": ("bad.ply", ply_head(10**30, 1), ["bad.ply, line 3"]),
    "PLY with a negative count": ("bad.ply", ply_head(-8, 12), ["bad.ply, line 3"]),
    "PLY index out of range": ("bad.ply", binary_ply()[:-4] + struct.pack("<i", 8), ["bad.ply", "8"]),
    "PLY without a header's end": ("bad.ply", b"ply\nformat ascii 1.0\nelement vertex 8\n", ["bad.ply, line 3: the file ends within its header", "anew"]),
    "truncated STL": ("bad.stl", binary_stl(*cube())[:-30], ["bad.stl: ends after 11 of 12 facets; the file is truncated"]),
    "STL of another kind of text": ("bad.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0\n", ["bad.stl, line 4"]),
    "obj called stl": ("bad.stl", CUBE, ["bad.stl"]),
    "obj called ply": ("bad.ply", CUBE, ["bad.ply: the name ends in .ply", "ply"]),
    "STEP called obj": ("bad.obj", "ISO-10303-21;\n", ["bad.obj: the name ends in .obj", "It is a CAD model. Make a surface of it: gmsh -2 bad.step"]),
    "msh called obj": ("bad.obj", "$MeshFormat\n", ["It is a mesh of tetrahedra, not a surface", "Mesh/File"]),
    "directory": ("bad.obj", None, ["bad.obj: ", "a directory", "Give the path of a "]),
    "missing file": ("absent.obj", "absent", ["absent.obj: cannot be opened (No such file"]),
    "flat in a point": ("bad.obj", ([(0, 0, 0)] * 3, [(0, 1, 2)]), ["bad.obj", "area"]),
}

# that bound no body: for `exemplar mesh` and Mesh/File
NO_BODIES = {
    "open surface": (without(2), ["holes: 1 (with 4 open edges", "Mend it in the program that made it"]),
    "one face missing": (without(1), ["holes: 1 (with 3 open edges", "at vertex 2 (1, 0, 0)"]),
    "a turned face": ((cube()[0], [f[::-1] if i == 4 else f for i, f in enumerate(cube()[1])]),
                      ["faces turned against their neighbours: 1 (face 5)"]),
    "flipped normals": (cube(inside_out=True), ["inside out"]),
    "one of two components inside out": (joined(cube(), (moved(cube()[0], (3, 0, 0)), cube(inside_out=True)[1])), ["inside out"]),
    "a face without area": (with_face(0, 8, 1, vertex=(.5, 0, 0)), ["faces without area: 1 (face 13)"]),
    "self-intersection": (joined(cube(), cube((.5,) * 3)), ["pairs of intersecting faces: 18", "faces "]),
    "edge of three faces": (with_face(0, 1, 8, vertex=(.5, -1, -1)), ["edges of more than two faces: 1 (the first at vertex 1 (0, 0, 0); faces 2, 5, 13)"]),
    "touching in a vertex": (joined(cube(), (moved(cube()[0], (1, 1, 1)), cube()[1])), ["body"]),
    "flat, without volume": (([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2), (0, 2, 3), (2, 1, 0), (3, 2, 0)]),
                             ["does not bound a body"]),
    "a sheet": (([(0, 0, 0), (1, 0, 1), (1, 1, 2), (0, 1, 1)], [(0, 1, 2), (0, 2, 3)]), ["holes: 1", "lies in a plane", "a thickness"]),
    "one side, open (Moebius)": (moebius(), ["one-sided", "holes"]),
    "one side, closed (Klein)": (klein(), ["one-sided"]),
    "a soup of triangles": (([cube()[0][i] for f in cube()[1] for i in f], [(3 * i, 3 * i + 1, 3 * i + 2) for i in range(12)]),
                            ["holes: 12", "duplicate vertices: 28"]),
}


class BadSurfaces(SceneTest):
    def setUp(self):
        super().setUp()
        self.environment = {"XDG_CACHE_HOME": str(self.directory / "cache")}
        self.vertices, self.faces, self.names = bar()
        surfaces.write_obj(self.directory / "rest.obj", self.vertices, self.faces, self.names)
        self.surface("good.obj", [bent(*x) for x in self.vertices])
        run = self.call("mesh", "--surface", "rest.obj", "--cells", 100, "--output", "body.msh")
        self.assertEqual(run.status, 0, run.stderr)

    def call(self, *arguments, **environment):
        return super().call(*arguments, **{**self.environment, **environment})

    def surface(self, name, vertices, faces=None):
        surfaces.write_obj(self.directory / name, vertices, faces or self.faces)

    def put(self, name, content):
        """A file of the contents of the tables above; None: a directory, "absent": none."""
        file = self.directory / name
        if content is None:
            file.mkdir()
        elif isinstance(content, bytes):
            file.write_bytes(content)
        elif isinstance(content, tuple):
            file.write_text(obj_text(*content))
        elif content != "absent":
            file.write_text(content)

    def remove(self, name):
        file = self.directory / name
        if file.is_dir():
            file.rmdir()
        else:
            file.unlink(missing_ok=True)

    def tree(self):
        """All files and their contents; what is kept may grow."""
        return {file: file.read_bytes() if file.is_file() else None for file in self.directory.rglob("*")
                if "cache" not in file.parts}

    def refused(self, arguments, words):
        before = self.tree()
        run = self.call(*arguments)
        said = f"{arguments}: {run.stdout}{run.stderr}"
        self.assertEqual(run.status, 1, said)
        lines = run.stderr.splitlines()
        self.assertTrue(lines[0].startswith("exemplar: "), said)
        self.assertTrue(all(line.startswith("  ") for line in lines[1:]), said)
        self.assertLess(len(run.stderr), 4000)
        self.assertNotRegex(run.stderr, NO_MESSAGE)
        self.assertRegex(run.stderr, r"[.)]\n$")
        for word in words:
            self.assertIn(word, run.stderr)
        self.assertEqual(self.tree(), before, said)
        return run

    def mesh(self, surface, *arguments):
        return ["mesh", "--surface", surface, "--cells", 100, "--output", "made.msh", *arguments]

    def pose(self, *poses, rest="rest.obj", mesh="body.msh", output="out", arguments=()):
        return ["pose", "--mesh", mesh, "--rest", rest, "--pose", *poses, "--output", output, *arguments]

    def scene(self, keys, *arguments):
        self.write("scene.prm", prm({**SCENE, **keys}))
        return ["scene.prm", "--output", "out", *arguments]

    def test_files_that_are_no_surfaces(self):
        for number, (name, (file, content, words)) in enumerate(NO_FILES.items()):
            with self.subTest(name):
                self.put(file, content)
                self.refused(self.mesh(file), words)
                for way, arguments in enumerate((lambda: self.pose("good.obj", file), lambda: self.pose("good.obj", rest=file),
                                                 lambda: self.scene({"Mesh/File": file}),
                                                 lambda: self.scene({"Examples/Poses": file}, "--validate"))):
                    if (number + way) % 4 < (4 if name in ("directory", "missing file") else 1):  # each takes all in turn
                        self.refused(arguments(), words)
                self.remove(file)

    def test_surfaces_that_bound_no_body(self):
        for name, (content, words) in NO_BODIES.items():
            with self.subTest(name):
                self.put("bad.obj", content)
                self.refused(self.mesh("bad.obj"), ["bad.obj: ", *words])
                run = self.refused(self.scene({"Mesh/File": "bad.obj"}), ["bad.obj: ", *words])
                self.assertNotIn("--repair", run.stderr)
                self.remove("bad.obj")

    def bad_poses(self):
        """name: (vertices, faces, words)"""
        n = len(self.vertices)
        rotated = [self.faces[6][1:] + self.faces[6][:1] if i == 6 else face for i, face in enumerate(self.faces)]
        swapped = [*self.faces[:3], self.faces[4], self.faces[3], *self.faces[5:]]
        other, other_faces, _ = surfaces.divided(self.vertices, self.faces)
        bow = [bent(*x) for x in self.vertices]
        return {
            "a face that begins elsewhere": (bow, rotated, ["face 7 has the vertices", "at rest", ORDER]),
            "swapped order of faces": (bow, swapped, ["face 4 has the vertices", ORDER]),
            "swapped order of vertices": (bow[::-1], [tuple(n - 1 - i for i in face) for face in self.faces],
                                          ["face 1 has the vertices", ORDER]),
            "a vertex less": (bow[:-1], [f for f in self.faces if n - 1 not in f], [f"it has {n - 1} vertices", str(n), ORDER]),
            "another resolution": (other, other_faces, [f"it has {len(other)} vertices", ORDER]),
            "a face more": (bow, [*self.faces, self.faces[0]], ["it has 193 faces, the surface at rest 192"]),
            "a mirror image": ([(x, -y, z) for x, y, z in (bent(*x, .5) for x in self.vertices)], self.faces, ["mirror image", "negative scale"]),
            "millimetres": ([tuple(1000 * c for c in x) for x in bow], self.faces, [" times larger", "same unit"]),
            "kilometres": ([tuple(.001 * c for c in x) for x in bow], self.faces, [" times smaller", "same unit"]),
            "all in a point": ([(1., 2., 3.)] * n, self.faces, ["without area"]),
            "shuffled vertices": ([bow[(37 * i) % n] for i in range(n)], self.faces, ["its vertices are in another order", ORDER]),
            "no number": ([*bow[:-1], (NAN, 0, 0)], self.faces, [f"vertex {n} of {n}", "no finite number"]),
        }

    def test_surfaces_that_are_no_poses(self):
        scenes = [{"Examples/Poses": "good.obj, bad.obj"}, {"Initial/Pose": "bad.obj"}, {"Handles/left/Follow pose": "bad.obj"}]
        for number, (name, (vertices, faces, words)) in enumerate(self.bad_poses().items()):
            with self.subTest(name):
                self.surface("bad.obj", vertices, faces)
                self.refused(self.pose("good.obj", "bad.obj"), ["bad.obj", *words])
                scene = scenes[number % 3]
                key = ["Handles/left/Follow pose: "] if "Handles/left/Follow pose" in scene else []
                self.refused(self.scene(scene, "--validate"), ["bad.obj", *key, *words])

    def test_stl_with_other_joined_corners(self):
        vertices, faces = cube()
        (self.directory / "rest.stl").write_bytes(binary_stl(vertices, faces))
        (self.directory / "touching.stl").write_bytes(binary_stl([vertices[0], vertices[0], *vertices[2:]], faces))
        self.refused(self.pose("touching.stl", rest="rest.stl"), ["touching.stl is no pose of ", "rest.stl: it has 7 vertices", "8"])
        self.refused(self.scene({"Mesh/File": "rest.stl", "Examples/Poses": "touching.stl"}), ["it has 7 vertices"])

    def test_surface_and_mesh_of_different_bodies(self):
        inside = ["body.msh is no mesh of the inside of "]
        self.surface("mm.obj", [tuple(1000 * c for c in x) for x in self.vertices])
        self.surface("axes.obj", [(y, -x, z) for x, y, z in self.vertices])
        surfaces.write_obj(self.directory / "ball.obj", *surfaces.sphere(2))
        for rest in ("mm.obj", "axes.obj", "ball.obj"):
            with self.subTest(rest):
                self.refused(self.pose(rest, rest=rest), [*inside, rest, "is 1000 times as large" if rest == "mm.obj" else ": node "])
                self.refused(self.scene({"Mesh/File": "body.msh", "Mesh/Surface": rest, "Examples/Poses": rest},
                                        "--quiet"), [*inside, rest])

    def test_rest_and_pose_are_swapped(self):
        run = self.refused(self.pose("rest.obj", rest="good.obj"), ["It is that of rest.obj: --rest and --pose seem to be swapped."])
        self.assertIn("no mesh of the inside of good.obj", run.stderr)

    def test_pose_with_another_axis_upwards(self):
        self.surface("up.obj", [(x, z, -y) for x, y, z in (bent(*x, .1) for x in self.vertices)])
        run = self.call(*self.pose("up.obj"))
        self.assertEqual(run.status, 0, run.stderr)
        self.assertIn("up.obj is turned by 90 degrees about the x axis", run.stderr)

    def test_places_and_names(self):
        self.refused(["mesh", "--surface", "rest.obj", "--cells", 100, "--output", "none/made.msh"], ["there is no directory"])
        self.refused(["mesh", "--surface", "rest.obj", "--cells", 100, "--output", "made.vtu"], ["written as .msh"])
        self.refused(["mesh", "--surface", "scene.txt", "--cells", 100, "--output", "made.msh"],
                     ["scene.txt", "must be an .obj, .ply or .stl file, found '.txt'"])
        for cells in (3, "many", "1e4", -10, 10**12):
            self.refused(["mesh", "--surface", "rest.obj", "--cells", cells, "--output", "made.msh"], ["--cells"])
        self.refused(self.pose("hop_*.obj"), ["No file matches hop_*.obj"])
        self.refused(self.pose("good.obj", arguments=["--attach", "-1"]), ["--attach"])
        self.refused(self.pose("good.obj", mesh="rest.obj"), ["rest.obj"])
        self.refused(self.pose("good.obj", output="rest.obj"), ["rest.obj"])
        self.write("plain", "")
        self.refused(self.pose("good.obj", output="plain/out"), ["plain"])
        self.refused(self.scene({"Handles/left/Select": "boundary lleft"}, "--quiet"), ["lleft", "left"])
        self.refused(self.scene({"Material/region bone/Density": "1"}, "--quiet"), ["bone"])
        self.refused(self.scene({"Examples/Attach": "0"}), ["Examples/Attach", "0.001 ... 1e+06"])
        self.refused(self.scene({"Mesh/Repair": "perhaps"}), ["Mesh/Repair", "perhaps"])
        self.refused(self.scene({"Mesh/File": "body.msh", "Examples/Poses": "good.obj"}), ["good.obj is a surface", "Mesh/Surface"])
        self.directory.joinpath("shut").mkdir()
        (self.directory / "shut/made.msh").mkdir()
        self.refused(["mesh", "--surface", "rest.obj", "--cells", 100, "--output", "shut/made.msh"], ["made.msh"])

    def test_tables_of_materials(self):
        for text, words in (("", ["there is no row", "x,y,z,id,name"]), ("x,y,z,id,name\n", ["there is no row"]),
                            ("1,2,3,4\n", ["m.csv, line 1: expected the header"]),
                            ("x;y;z;id\n", ["found 'x;y;z;id'. Columns are separated by commas"]),
                            ("x,y,z,id\n1,0,0\n", ["m.csv, line 2: expected x,y,z,id", "found 3 columns"]),
                            ("x,y,z,id\n1,0,nan,1\n", ["m.csv, line 2: expected a coordinate, found 'nan'"]),
                            ("x,y,z,id\n\n1,0,0,0\n", ["m.csv, line 3: expected a material id", "'0'"]),
                            ("x,y,z,id\n9,0,0,1\n", ["m.csv, line 2: the point (9, 0, 0) is not inside the body", "Move it"]),
                            ("x,y,z,id,name\n1,0,0,1,a\n2,0,0,1,b\n", ["m.csv, line 3: material 1 is called 'b', before 'a'"]),
                            ("x,y,z,id\n2,0,0,1\n2,0,0,2\n", ["m.csv, line 3: no cell is nearer", "fewer points"]),
                            ("x,y,z,id,name\n1,0,0,1,a\"b\n", ["m.csv, line 2: the name", "quote"])):
            with self.subTest(text):
                self.write("m.csv", text)
                self.refused(self.mesh("rest.obj", "--materials", "m.csv"), words)
        self.refused(self.mesh("rest.obj", "--materials", "absent.csv"), ["absent.csv: cannot be opened"])
        self.write("made.csv", "x,y,z,id\n1,0,0,1\n")
        self.refused(self.mesh("rest.obj", "--materials", "made.csv"), ["made.csv: is to be written, but is the input"])

    def test_where_nothing_can_be_kept(self):
        """The run goes on; it only says so."""
        self.write("file", "")
        for cache in (str(self.directory / "file"), "relative"):
            with self.subTest(cache):
                run = self.call(*self.scene({}, "--validate"), XDG_CACHE_HOME=cache, HOME="relative")
                self.assertEqual(run.status, 0, run.stderr)
                self.assertIn("are not kept", run.stderr)
                self.assertIn("Set XDG_CACHE_HOME", run.stderr)
                self.assertFalse((self.directory / "relative").exists())

    def test_odd_surfaces_that_do(self):
        """Polygons, surfaces with unused vertices, capitals in the name, groups that are no words."""
        vertices, _ = cube()
        quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
        write_ply(self.directory / "TRIANGLES.PLY", *cube())
        hexagon = [(math.cos(k * math.pi / 3), math.sin(k * math.pi / 3), z) for z in (0, 1) for k in range(6)]
        for name, text in {
                "quads.obj": obj_text(vertices, quads),
                "prism.obj": obj_text(hexagon, [tuple(range(5, -1, -1)), tuple(range(6, 12)),
                                                *((k, (k + 1) % 6, 6 + (k + 1) % 6, 6 + k) for k in range(6))]),
                "unused.obj": obj_text([*vertices, (9, 9, 9)], quads), "Quads.OBJ": obj_text(vertices, quads),
                "named.obj": 'g a"b\n' + obj_text(vertices, quads), "back.obj": obj_text(vertices, []) + "".join(
                    "f " + " ".join(str(i - 8) for i in face) + "\n" for face in quads)}.items():
            self.write(name, text)
            with self.subTest(name):
                self.assertEqual(self.call(*self.mesh(name)).status, 0)
                run = self.call(*self.pose(name, rest=name, mesh="made.msh", output="poses"))
                self.assertEqual(run.status, 0, run.stderr)
                self.solve({**SCENE, "Mesh/File": name, "Handles/left/Select": "box -9 -9 -9 9 9 .01"}, "--quiet")
        self.solve({**SCENE, "Mesh/File": "TRIANGLES.PLY", "Handles/left/Select": "boundary 1"}, "--quiet")


if __name__ == "__main__":
    if len(NO_FILES) + len(NO_BODIES) < 25:
        sys.exit("fewer than 25 inputs")
    unittest.main()
