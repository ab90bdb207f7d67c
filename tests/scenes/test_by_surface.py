# SPDX-License-Identifier: GPL-3.0-or-later
"""Handles, loads, constants and weights by the surface of the body; handles that follow a point cache."""

import struct
import unittest
from math import cos, pi, sin

from exemplar_runner import SceneTest, read_csv, read_msh, read_summary, results, timeless_statistics

LENGTH, CELLS = (4., 1., 1.), (8, 2, 2)  # of the bar, and of its surface's grid
BAR = {
    "Scene": "static",
    "Mesh/Generator": "box",
    "Mesh/Box size": "4, 1, 1",
    "Mesh/Box cells": "8, 2, 2",
    "Mesh/Surface": "rest.obj",
    "Material/Poisson's ratio": "0.3",
    "Time/Increments": "4",
    "Output/Every": "0",
}


def bar_surface():
    """Vertices of the bar's surface on a grid of its own, and faces of four with the names of their groups."""
    numbers, vertices, faces = {}, [], []

    def vertex(*index):
        if index not in numbers:
            numbers[index] = len(vertices)
            place = [LENGTH[d] * index[d] / CELLS[d] for d in range(3)]
            vertices.append((place[0], place[1] - .5, place[2] - .5))
        return numbers[index]

    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for side in (0, 1):
            for i in range(CELLS[u]):
                for j in range(CELLS[v]):
                    corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
                    face = []
                    for a, b in corners if side else corners[::-1]:
                        index = [0, 0, 0]
                        index[axis], index[u], index[v] = side * CELLS[axis], a, b
                        face.append(vertex(*index))
                    faces.append(("xyz"[axis] + "-+"[side], face))
    return vertices, faces


VERTICES, FACES = bar_surface()


def obj(vertices):
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in vertices]
    group = None
    for name, face in FACES:
        lines += [f"g {name}"] * (name != group) + ["f " + " ".join(str(v + 1) for v in face)]
        group = name
    return "\n".join(lines) + "\n"


def ply(values, kind="float", vertices=None):
    vertices = VERTICES if vertices is None else vertices
    lines = ["ply", "format ascii 1.0", f"element vertex {len(vertices)}", "property float x", "property float y",
             "property float z", f"property {kind} paint", f"element face {len(FACES)}",
             "property list uchar int vertex_indices", "end_header"]
    lines += [f"{x!r} {y!r} {z!r} {value!r}" for (x, y, z), value in zip(vertices, values)]
    lines += [f"{len(face)} " + " ".join(map(str, face)) for _, face in FACES]
    return "\n".join(lines) + "\n"


def table(values, name="paint"):
    return f"vertex,{name}\n" + "".join(f"{v + 1},{value!r}\n" for v, value in values.items())


def mdd(times, samples):
    n = len(samples[0])
    return (struct.pack(">2i", len(times), n) + struct.pack(f">{len(times)}f", *times)
            + b"".join(struct.pack(f">{3 * n}f", *[c for x in sample for c in x]) for sample in samples))


def pc2(start, rate, samples, version=1):
    n = len(samples[0])
    return (struct.pack("<12siiffi", b"POINTCACHE2\0", version, n, start, rate, len(samples))
            + b"".join(struct.pack(f"<{3 * n}f", *[c for x in sample for c in x]) for sample in samples))


def number_at(*place):
    """Of the vertex at a place, from 1."""
    return VERTICES.index(place) + 1


def turned(angle, points):
    return [(x, y * cos(angle) - z * sin(angle), y * sin(angle) + z * cos(angle)) for x, y, z in points]


class BySurface(SceneTest):
    def setUp(self):
        super().setUp()
        self.write("rest.obj", obj(VERTICES))

    def write_bytes(self, name, content):
        (self.directory / name).write_bytes(content)

    def refused(self, keys, *words):
        run = self.attempt({**BAR, **keys})
        self.assertEqual(run.status, 1, run.stderr)
        for word in words:
            self.assertIn(word, run.stderr)
        self.assertFalse(run.output.exists())

    def same(self, keys, other):
        """Two scenes that must leave the same bytes; with names that are the same."""
        a, b = (self.solve({**BAR, **scene}, output=name) for scene, name in ((keys, "a"), (other, "b")))
        self.assertEqual((a / "final.msh").read_bytes(), (b / "final.msh").read_bytes())
        self.assertEqual(timeless_statistics(a), timeless_statistics(b))
        return a


def held(left, right="boundary 2", motion="0.2*t; 0.1*t; 0"):
    return {"Handles/Names": "left, right", "Handles/left/Select": left, "Handles/right/Select": right,
            "Handles/right/Motion": motion}


class Selections(BySurface):
    def test_groups_are_boundaries(self):
        self.same(held("group x-", "group x+"), held("boundary 1"))

    def test_within_a_distance_along_the_surface(self):
        # from the middle of the end face; over its edge by .3, which reaches no node at .5 from it
        middle = number_at(0., 0., 0.)
        self.same(held(f"vertex {middle} within 0.78"), held("boundary 1"))
        # the middles of its edges are .5 away, corners .71
        self.write("list.txt", "\n".join(map(str, self.cross())))
        self.same(held(f"vertex {middle} within 0.6"), held("nodes list.txt"))
        # the opposite end is 1 away through a thin bar, but 2 along its surface
        self.same({**held(f"vertex {number_at(2., 0., .5)}, {number_at(2.5, 0., .5)} within 0.01"), "Loads/Gravity": "0, 0, 1",
                   "Handles/left/Components": "z"},
                  {**held("box 1.99 -0.01 0.49 2.51 0.01 0.51"), "Loads/Gravity": "0, 0, 1", "Handles/left/Components": "z"})

    def cross(self):
        """Numbers of the nodes of the box at x = 0 that are no corners."""
        nodes = read_msh(self.solve({**BAR, **held("boundary 1")}, "--set", "Handles/right/Motion=0; 0; 0", output="box")
                         / "final.msh").nodes
        return [n for n, (x, y, z) in nodes.items() if x < 1e-9 and min(abs(y), abs(z)) < 1e-9]

    def test_nearest_to_a_vertex(self):
        corners = [number_at(0., y, z) for y in (-.5, .5) for z in (-.5, .5)]
        words = ", ".join(map(str, corners))
        nodes = read_msh(self.solve({**BAR, **held("boundary 1")}, output="box") / "final.msh").nodes
        chosen = [n for n, (x, y, z) in nodes.items() if abs(x) < 1e-9 and abs(abs(y) - .5) < 1e-9 and abs(abs(z) - .5) < 1e-9]
        self.write("corners.txt", " ".join(map(str, chosen)))
        self.same(held(f"vertex {words}"), held("nodes corners.txt"))

    def test_painted_maps(self):
        left = [1. if x < 1e-9 else 0. for x, _, _ in VERTICES]
        self.write("paint.ply", ply([round(255 * value) for value in left], "uchar"))
        self.write("paint.csv", table({v: 1. for v, value in enumerate(left) if value > 0.}))
        self.write("rows.csv", "".join(f"{-value}\n" for value in left))
        for choice in ("paint.ply:paint", "paint.ply:paint above 0.99", "paint.csv:paint above 0.6", "rows.csv below -0.5"):
            with self.subTest(choice):
                self.same(held(f"map {choice}"), held("boundary 1"))

    def test_loads_are_shared_by_area(self):
        load = {"Loads/Names": "pull", "Loads/pull/Force": "0; 0; -1e3*t"}
        a = self.solve({**BAR, **held("boundary 1"), **load, "Handles/Names": "left", "Loads/pull/Select": "group z+",
                        "Handles/right/Select": None, "Handles/right/Motion": None}, output="a")
        rows = read_csv(a)
        self.assertAlmostEqual(rows[-1]["reaction_left_z"], 1e3, delta=1e-3)

    def test_scale(self):
        self.write("rest.obj", obj([tuple(1e3 * c for c in x) for x in VERTICES]))
        scaled = {"Mesh/Box size": "4000, 1000, 1000", "Mesh/Scale": "0.001"}
        middle = number_at(0., 0., 0.)
        self.same({**scaled, **held(f"vertex {middle} within 0.78")}, {**scaled, **held("boundary 1")})

    def test_refused(self):
        for choice, words in {
                "vertex 0": ("is no vertex of", "counted from 1"),
                "vertex 4000": ("is no vertex of",),
                "vertex": ("is not understood", "within D"),
                "vertex 3 within": ("is not understood",),
                "vertex 3 within -1": ("is not understood",),
                "vertex 3 4 about 1": ("is no vertex",),
                "group left paw": ("no group of this name", "x-, x+, y-"),
                "map paint.obj": ("names no painted map",),
                "map none.csv": ("none.csv: cannot be opened",),
                "map paint.ply": ("say which attribute", "x, y, z, paint"),
                "map paint.ply:blue": ("no attribute 'blue'", "x, y, z, paint"),
                "map paint.ply:paint above": ("is not understood",),
                "map paint.ply:paint over 3": ("is not understood",),
                "map paint.ply:paint above 3": ("selects no node", "at most 0.5"),
                "map long.ply:paint": ("has 75 vertices", "the same model"),
                "map other.ply:paint": ("are not those of", "their distance"),
                "map nan.csv": ("nan.csv, line 3", "no finite number"),
                "map twice.csv": ("has a value already",),
                "map far.csv": ("is no vertex of", "counted from 1"),
                "map wide.csv": ("wide.csv: the map is saved as UTF-16", "UTF-8"),
                "map semicolons.csv": ("line 1: the cells are separated by semicolons", "by commas"),
                "map rows.csv": ("has 2 rows",)}.items():
            self.write("paint.ply", ply([.5] * len(VERTICES)))
            self.write("long.ply", ply([.5] * 75, vertices=[*VERTICES, (9., 9., 9.)]))
            self.write("other.ply", ply([.5] * len(VERTICES), vertices=VERTICES[::-1][1:] + VERTICES[:1]))
            self.write("nan.csv", "vertex,paint\n1,0.5\n2,nan\n")
            self.write("twice.csv", "vertex,paint\n1,0.5\n1,0.6\n")
            self.write("far.csv", "vertex,paint\n1000,0.5\n")
            self.write_bytes("wide.csv", "vertex,paint\n1,0.5\n".encode("utf-16"))
            self.write("semicolons.csv", "vertex;paint\n1;0,5\n")
            self.write("rows.csv", "1\n2\n")
            with self.subTest(choice):
                self.refused(held(choice), *words)
        self.write("rest.obj", obj(VERTICES) + "v 2 0 0.6\n")
        self.refused(held(f"vertex {len(VERTICES) + 1} within 5"), "no face of the surface uses this vertex")
        self.write("rest.obj", obj(VERTICES))
        self.refused({**held("vertex 3"), "Mesh/Surface": None}, "Set Mesh/Surface", "Handles/left/Select")
        self.write("rest.obj", obj([tuple(1e3 * c for c in x) for x in VERTICES]))
        self.refused(held("vertex 3"), "is no mesh of the inside of")


class Painted(BySurface):
    def test_constants(self):
        half = [3. if x > 2. + 1e-9 else 1. for x, _, _ in VERTICES]
        self.write("e.ply", ply(half))
        self.write("rho.csv", table(dict(enumerate([500. * h for h in half])), "density"))
        load = {"Loads/Gravity": "0, 0, -9.81", "Handles/Names": "left", "Handles/left/Select": "boundary 1"}
        # a constant map is a constant
        self.write("one.csv", table({v: .25 for v in range(len(VERTICES))}))
        self.same({**load, "Material/Young's modulus map": "one.csv from 0 to 8", "Material/Poisson's ratio map":
                   "one.csv absolute", "Material/Density map": "one.csv from 1 to 1"},
                  {**load, "Material/Young's modulus": "2e6", "Material/Poisson's ratio": "0.25"})
        # masses: cells of the right half are heavier; between x = 2 and 2.5 paint is linear
        rows = read_csv(self.solve({**BAR, **load, "Material/Density map": "rho.csv:density absolute"}))
        mean = (2. * 500. + .5 * 1000. + 1.5 * 1500.)
        self.assertAlmostEqual(rows[-1]["reaction_left_z"] / (9.81 * mean), 1., delta=1e-2)
        # a bar in tension, stiffer by 3 where it is painted: u = F L / (E A) of two springs in series
        pull = {"Handles/Names": "left", "Handles/left/Select": "boundary 1", "Material/Poisson's ratio": "0",
                "Loads/Names": "pull", "Loads/pull/Select": "group x+", "Loads/pull/Force": "1*t; 0; 0"}
        final = read_msh(self.solve({**BAR, **pull, "Material/Young's modulus map": "e.ply:paint"}) / "final.msh")
        end = max(x for x, _, _ in final.nodes.values()) - 4.
        between = .25 * sum(1. / (1. + 2. * s) for s in (.125, .375, .625, .875)) * .5
        self.assertAlmostEqual(end * 1e6, 2. + between + 1.5 / 3., delta=.06)

    def test_factors_and_values_are_not_mistaken(self):
        self.write("map.csv", table({v: v / len(VERTICES) for v in range(len(VERTICES))}))
        hold = {**BAR, "Handles/Names": "left", "Handles/left/Select": "boundary 1"}
        for key, text, words in (("Young's modulus", "1e5 to 1e6", "are factors of the constant"),
                                 ("Density", "500 to 2000", "write 'absolute' behind"),
                                 ("Young's modulus", "1 to 20 absolute", "leave 'absolute' out"),
                                 ("Young's modulus", "1 to 1e3", ""), ("Young's modulus", "1e5 to 1e6 absolute", ""),
                                 ("Density", "1 to 20 absolute", "")):
            run = self.attempt({**hold, f"Material/{key} map": f"map.csv from {text}"})
            self.assertEqual(run.status, 0, run.stderr)
            self.assertIn(words, run.stderr)
            self.assertEqual(run.stderr == "", words == "", run.stderr)
        run = self.attempt({**hold, "Material/Young's modulus": "1", "Material/Young's modulus map": "map.csv from 1e5 to 1e6"})
        self.assertEqual(run.stderr, "")
        self.write("bytes.csv", table({v: 255. * v / (len(VERTICES) - 1) for v in range(len(VERTICES))}))
        run = self.attempt({**hold, "Material/Young's modulus map": "bytes.csv from 1 to 20"})
        self.assertRegex(run.stderr, "the map has 255, of which 4846 is made. Divide its values by 255")

    def test_painted_importance(self):
        twisted = {"Examples/Pose functions": "1.2*x; y; z", "Examples/Importance": "0.8", "Examples/Weights": "prescribed",
                   "Examples/Prescribed weights": "1-t; t", "Handles/Names": "left", "Handles/left/Select": "boundary 1"}
        self.write("half.csv", table({v: .5 for v in range(len(VERTICES))}))
        self.same({**twisted, "Material/Importance map": "half.csv"}, {**twisted, "Examples/Importance": "0.4"})
        self.write("much.csv", table({v: 2. for v in range(len(VERTICES))}))
        run = self.attempt({**BAR, **twisted, "Material/Importance map": "much.csv"})
        self.assertEqual(run.status, 1)
        self.assertRegex(run.stderr, "Material/Importance map: in .*much.csv vertex 1 has the value 2, but shares lie between 0 and 1")

    def test_shares_of_weights(self):
        n = len(VERTICES)
        examples = {"Examples/Pose functions": "1.2*x; y; z", "Handles/Names": "left", "Handles/left/Select": "boundary 1",
                    "Loads/Names": "pull", "Loads/pull/Select": "boundary 2", "Loads/pull/Force": "3e4*t; 0; 0"}
        self.write("all.csv", table({v: 1. for v in range(n)}))
        self.write("half.csv", table({v: .5 for v in range(n)}))
        self.write("right.csv", table({v: min(1., max(0., x - 1.5)) for v, (x, _, _) in enumerate(VERTICES)}))
        self.write("left.csv", table({v: 1. - min(1., max(0., x - 1.5)) for v, (x, _, _) in enumerate(VERTICES)}))
        whole = read_csv(self.solve({**BAR, **examples}, output="whole"))
        one = read_csv(self.solve({**BAR, **examples, "Examples/Weight maps": "all.csv"}, output="one"))
        self.assertEqual(one[-1]["weight_1_1"], whole[-1]["weight_1"])
        half = self.attempt({**BAR, **examples, "Examples/Weight maps": "half.csv"}, output="half")
        self.assertRegex(half.stderr, "^Warning: Example 1 .* in region 1 is an affine combination")  # both act alike
        half = read_csv(half.output)
        self.assertAlmostEqual((half[-1]["weight_0_1"] + half[-1]["weight_1_1"]) / 2., whole[-1]["weight_1"], places=5)
        rest = read_csv(self.solve({**BAR, **examples, "Examples/Weight maps": "right.csv"}, output="rest"))
        both = read_csv(self.solve({**BAR, **examples, "Examples/Weight maps": "left.csv, right.csv"}, output="both"))
        for a, b in (("weight_0_1", "weight_1_1"), ("weight_1_1", "weight_2_1")):
            self.assertAlmostEqual(rest[-1][a], both[-1][b], places=6)
        self.assertNotIn("weight_0_1", both[-1])
        # sums above one are divided
        twice = read_csv(self.attempt({**BAR, **examples, "Examples/Weight maps": "all.csv, all.csv:paint"},
                                      output="twice").output)
        self.assertAlmostEqual(twice[-1]["weight_1_1"] + twice[-1]["weight_2_1"], 2. * whole[-1]["weight_1"], places=5)

    def test_refused(self):
        n = len(VERTICES)
        self.write("zero.csv", table({v: float(v != 6) for v in range(n)}))
        self.write("few.csv", table({0: 1.}))
        self.write("big.csv", table({v: 2. for v in range(n)}))
        self.write("none.csv", table({v: 0. for v in range(n)}))
        self.write("percent.csv", table({v: 100. * v / n for v in range(n)}))
        hold = {"Handles/Names": "left", "Handles/left/Select": "boundary 1"}
        for key, text, words in (
                ("Material/Young's modulus map", "zero.csv", ("vertex 7 has the value 0", "from A to B")),
                ("Material/Density map", "few.csv", ("vertex 2 has no value in the table",)),
                ("Material/Poisson's ratio map", "big.csv", ("vertex 1 has the value 2", "less than 0.5")),
                ("Material/Young's modulus map", "zero.csv from 1", ("is not understood",)),
                ("Material/Young's modulus map", "paint.png", ("names no painted map",)),
                ("Material/Density map", "absent.csv", ("Material/Density map: ", "/absent.csv: cannot be opened")),
                ("Material/Density map", "big.csv:pant", ("no column 'pant' (there: vertex, paint). Did you mean 'paint'?",)),
                ("Examples/Weight maps", "big.csv", ("vertex 1 has the value 2", "between 0 and 1", "divide all by 2,")),
                ("Examples/Weight maps", "percent.csv", ("The greatest value is 98.6: divide all by 100",)),
                ("Examples/Weight maps", "zero.csv, none.csv", ("map 2 is 0 in all cells",)),
                ("Examples/Weight maps", "zero.csv above 1", ("is not understood",))):
            with self.subTest(f"{key} = {text}"):
                self.refused({**hold, "Examples/Pose functions": "1.2*x; y; z", key: text}, *words)
        self.refused({**hold, "Examples/Pose functions": "1.2*x; y; z", "Examples/Weight maps": "zero.csv",
                      "Examples/Weights per region": "true"}, "are both given")


TURN = pi / 2  # in a second


class Caches(BySurface):
    motion = (f"0; y*cos({TURN!r}*t) - z*sin({TURN!r}*t) - y; y*sin({TURN!r}*t) + z*cos({TURN!r}*t) - z")

    def scene(self, keys):
        return {**held("boundary 1"), "Time/Increments": "8", "Handles/right/Motion": None, **keys}

    def check_follows(self, keys, places=5):
        """The same as by the formula, in single precision."""
        a = self.solve({**BAR, **self.scene({"Handles/right/Motion": self.motion})}, output="formula")
        b = self.solve({**BAR, **self.scene(keys)}, output="cache")
        expected, found = (read_msh(output / "final.msh").nodes for output in (a, b))
        for number, place in expected.items():
            for x, y in zip(found[number], place):
                self.assertAlmostEqual(x, y, places=places)
        for row, other in zip(read_csv(a), read_csv(b)):
            self.assertAlmostEqual(row["work_handles"] / 1e3, other["work_handles"] / 1e3, delta=1e-2)
            self.assertAlmostEqual(row["reaction_right_x"] / 1e3, other["reaction_right_x"] / 1e3, delta=1e-2)
        self.assertGreater(read_csv(b)[-1]["work_handles"], 1e4)

    def samples(self, n=8):
        return [turned(TURN * k / n, VERTICES) for k in range(n + 1)]

    def test_mdd(self):
        self.write_bytes("rig.mdd", mdd([k / 8 for k in range(9)], self.samples()))
        self.check_follows({"Handles/right/Follow cache": "rig.mdd"})
        # the end of a box with nodes inside
        self.check_follows({"Handles/right/Follow cache": "rig.mdd", "Handles/right/Select": "boundary 2"})

    def test_pc2_and_its_start(self):
        self.write_bytes("rig.pc2", pc2(3., 2., self.samples()))
        self.check_follows({"Handles/right/Follow cache": "rig.pc2", "Handles/right/Frames per second": "16",
                            "Handles/right/Cache start": "0"})

    def test_sequence(self):
        for k, sample in enumerate(self.samples()):
            self.write(f"rig_{3 * k + 7:03}.obj", obj(sample))
        self.check_follows({"Handles/right/Follow cache": "rig_*.obj", "Handles/right/Frames per second": "24"}, places=9)

    def test_between_samples(self):
        # linear: half way at half the time; before and after the samples at rest
        shifted = [(x, y, z + .25) for x, y, z in VERTICES]
        self.write_bytes("rig.mdd", mdd([.25, .75], [VERTICES, shifted]))
        output = self.solve({**BAR, **self.scene({"Handles/right/Follow cache": "rig.mdd", "Output/Every": "1"})}, output="a")
        other = self.solve({**BAR, **self.scene({"Handles/right/Motion": "0; 0; 0.25*min(1, max(0, 2*(t-0.25)))"})}, output="b")
        for row, expected in zip(read_csv(output), read_csv(other)):
            self.assertAlmostEqual(row["reaction_right_z"], expected["reaction_right_z"], delta=1e-2)

    def test_bad_caches(self):
        good = mdd([0., 1.], [VERTICES, VERTICES])
        nan = [list(x) for x in VERTICES]
        nan[4][1] = float("nan")
        far = [(1e5 * x, y, z) for x, y, z in VERTICES]
        self.write("b_001.obj", obj(VERTICES))
        self.write("b_002.obj", obj([tuple(1000 * c for c in x) for x in VERTICES]))
        for name, content, words in (
                ("a.mdd", good[:-4], ("truncated", "Save or copy it anew")),
                ("b.mdd", good[:11], ("truncated",)),
                ("c.mdd", good + b"    ", ("longer",)),
                ("d.mdd", mdd([0., 1.], [VERTICES[1:], VERTICES[1:]]), ("moves 73 vertices", "has 74")),
                ("e.mdd", mdd([0., 1.], [VERTICES, nan]), ("sample 2 of 2, vertex 5", "no finite place")),
                ("f.mdd", mdd([1., 1.], [VERTICES, VERTICES]), ("not after that of the one before",)),
                ("g.mdd", struct.pack(">2i", 0, len(VERTICES)), ("no samples",)),
                ("h.mdd", mdd([0., 1.], [VERTICES, far]), ("in sample 2", "unit")),
                ("i.mdd", struct.pack(">2i", -3, len(VERTICES)), ("is none",)),
                ("j.mdd", mdd([0., float("nan")], [VERTICES, VERTICES]), ("no finite number",)),
                ("k.mdd", b"", ("empty",)),
                ("a.pc2", pc2(0., 1., [VERTICES])[1:], ("no .pc2 file",)),
                ("m.mdd", pc2(0., 1., [VERTICES]), ("it is a .pc2 file", "ends in .pc2")),
                ("b.pc2", pc2(0., 0., [VERTICES, VERTICES]), ("not after that",)),
                ("c.pc2", pc2(0., 1., [VERTICES], 2), ("version 2",)),
                ("d.pc2", pc2(0., 1., [VERTICES])[:50], ("truncated",)),
                ("a.abc", b"x", ("a point cache is a .mdd or .pc2 file",)),
                ("a_1.obj", obj(VERTICES[:-1] + [(9., 9., 9.)]).replace("f 1 ", "f 2 ").encode(), ("is no pose of", "face")),
                ("l.mdd", mdd([0., 1.], 2 * [[tuple(100 * c for c in x) for x in VERTICES]]), ("100 times as large as at rest", "same unit")),
                ("b_*.obj", None, ("b_002.obj the surface is 1000 times as large",)),
                ("none_*.obj", None, ("Handles/right/Follow cache: No file matches",)),
                ("none.mdd", None, ("Handles/right/Follow cache: ", "there is no such file"))):
            with self.subTest(name):
                if content is not None:
                    self.write_bytes(name, content)
                self.refused(self.scene({"Handles/right/Follow cache": name}), *words)

    def test_keys(self):
        self.write_bytes("rig.mdd", mdd([0., 1.], [VERTICES, VERTICES]))
        self.refused(self.scene({"Handles/right/Follow cache": "rig.mdd", "Handles/right/Motion": "t; 0; 0"}), "are both given")
        self.refused(self.scene({"Handles/right/Cache start": "3"}), "is given, but no")
        self.refused(self.scene({"Handles/right/Follow cache": "rig.mdd", "Handles/right/Cache start": "x"}), "is not allowed")
        self.refused({**self.scene({"Handles/right/Follow cache": "rig.mdd"}), "Mesh/Surface": None}, "Set Mesh/Surface")

    def test_warnings(self):
        self.write_bytes("rig.mdd", mdd([0., 1.], [VERTICES, turned(TURN, VERTICES)]))
        run = self.attempt({**BAR, **self.scene({"Handles/right/Follow cache": "rig.mdd"})})
        self.assertEqual(run.status, 0)
        self.assertRegex(run.stderr, "Follow cache turns the held nodes by 90 degrees.*more samples")
        self.write_bytes("rig.mdd", mdd([0., 1.], [self.samples()[4], self.samples()[8]]))
        run = self.attempt({**BAR, **self.scene({"Handles/right/Follow cache": "rig.mdd"})})
        self.assertIn("they jump in the first step", run.stderr)
        sideways = [(x, z, -y) for x, y, z in VERTICES]
        self.write_bytes("rig.mdd", mdd([0., 1.], [sideways, sideways]))
        run = self.attempt({**BAR, **self.scene({"Handles/right/Follow cache": "rig.mdd"})})
        self.assertRegex(run.stderr, r"surface is the one at rest, turned by 90 degrees about \(-1, 0, 0\): export both with the same axes")
        self.write_bytes("rig.mdd", mdd([0., .04], [VERTICES, sideways]))  # in one step
        run = self.attempt({**BAR, **self.scene({"Handles/right/Follow cache": "rig.mdd"})})
        self.assertRegex(run.stderr, r"Follow cache turns the held nodes by 90 degrees about .* from sample 1 to the next. .*axes")
        self.write_bytes("rig.mdd", mdd([0., 1., 2.], 3 * [VERTICES]))
        run = self.attempt({**BAR, **self.scene({"Handles/right/Follow cache": "rig.mdd"})})
        self.assertIn("goes to t = 2 s, but t of a static scene ends at 1, after 2 of 3 samples. Set Scene = dynamic and Time/End = 2.", run.stderr)
        self.write_bytes("rig.pc2", pc2(0., 1., 49 * [VERTICES]))
        run = self.attempt({**BAR, **self.scene({"Handles/right/Follow cache": "rig.pc2"})})
        self.assertIn("after 25 of 49 samples. Set Scene = dynamic and Time/End = 2, or a greater Handles/right/Frames per second.", run.stderr)
        run = self.attempt({**BAR, **self.scene({"Handles/right/Follow cache": "rig.pc2", "Handles/right/Frames per second": "48"})})
        self.assertEqual(run.stderr, "")

    def test_resumed(self):
        self.write_bytes("rig.mdd", mdd([k / 8 for k in range(9)], self.samples()))
        scene = {**BAR, **self.scene({"Handles/right/Follow cache": "rig.mdd"}), "Scene": "dynamic", "Time/Increments": None, "Time/Step": "0.05",
                 "Output/Every": "1"}
        whole = self.solve({**scene, "Time/End": "0.4"}, output="whole")
        self.solve({**scene, "Time/End": "0.2"})
        out = self.solve({**scene, "Time/End": "0.4"}, "--resume")
        self.assertEqual(results(out), results(whole))
        self.write_bytes("rig.mdd", mdd([k / 8 for k in range(9)], self.samples(9)[:9]))
        run = self.attempt({**scene, "Time/End": "0.5"}, "--resume")
        self.assertIn("rig.mdd has changed since", run.stderr)
        out = self.solve({**scene, "Time/End": "0.5"}, "--resume-from", "8")
        self.assertEqual([edit["step"] for edit in read_summary(out)["edits"]], [8])

    def test_mesh_that_is_made_of_the_surface(self):
        self.write_bytes("rig.mdd", mdd([k / 8 for k in range(9)], self.samples()))
        keys = {**self.scene({"Handles/right/Follow cache": "rig.mdd"}), "Handles/left/Select": "group x-",
                "Handles/right/Select": "group x+", "Mesh/Generator": None, "Mesh/Box size": None, "Mesh/Box cells": None,
                "Mesh/Surface": None, "Mesh/File": "rest.obj", "Mesh/Cells": "300"}
        out = self.solve({**BAR, **keys})
        ends = [(x, y, z) for x, y, z in read_msh(out / "final.msh").nodes.values() if x > 4 - 1e-5]
        for y, z in ((.5, .5), (-.5, .5)):  # a quarter of a turn takes corners to corners
            self.assertTrue(any(abs(y - b) + abs(z - c) < 1e-5 for _, b, c in ends))
        self.assertGreater(read_csv(out)[-1]["work_handles"], 1e4)

    def test_overlapping_handles_must_agree(self):
        self.write_bytes("rig.mdd", mdd([k / 8 for k in range(9)], self.samples()))
        keys = {"Handles/right/Follow cache": "rig.mdd", "Handles/left/Select": "group z+"}
        self.refused(self.scene(keys), "but move it differently")
        self.solve({**BAR, **self.scene({**keys, "Handles/left/Follow cache": "rig.mdd"})})


if __name__ == "__main__":
    unittest.main()
