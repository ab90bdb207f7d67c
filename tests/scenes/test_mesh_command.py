# SPDX-License-Identifier: GPL-3.0-or-later
"""exemplar mesh: from surfaces to meshes that scenes take, and what it says of surfaces that bound no body."""

import csv
import math
import struct
import unittest
from pathlib import Path

import surfaces
from exemplar_runner import BAR, SceneTest, read_msh

STATIC = {"Scene": "static", "Mesh/File": "body.msh", "Time/Increments": "1", "Handles/Names": "base",
          "Handles/base/Select": "boundary 1", "Loads/Gravity": "0, 0, -1"}


def moved(vertices, by):
    return [tuple(x + d for x, d in zip(v, by)) for v in vertices]


def joined(*parts):
    vertices, faces = [], []
    for v, f in parts:
        faces += [tuple(i + len(vertices) for i in face) for face in f]
        vertices += v
    return vertices, faces


class MeshCommandTest(SceneTest):
    def surface(self, name, vertices, faces, groups=None):
        return surfaces.write_obj(self.directory / name, vertices, faces, groups)

    def mesh(self, surface, cells, *arguments):
        return self.call("mesh", "--surface", surface, "--cells", cells, "--output", "body.msh", *arguments)

    def table(self):
        with open(self.directory / "body.csv", newline="") as file:
            return {row["quantity"]: float(row["value"]) for row in csv.DictReader(file)}

    def made(self, surface, cells, *arguments):
        """Of a surface that must do: the table."""
        run = self.mesh(surface, cells, *arguments)
        self.assertEqual((run.status, run.stderr), (0, ""))
        table = self.table()
        self.assertLessEqual(abs(table["cells"] / cells - 1), .1)
        self.assertEqual(table["boundary_slivers"], 0)
        return table

    def refused(self, surface, *words, arguments=(), cells=300):
        """Status 1, these words, and nothing written."""
        before = sorted(self.directory.iterdir())
        run = self.mesh(surface, cells, *arguments)
        self.assertEqual(run.status, 1, run.stdout + run.stderr)
        for word in words:
            self.assertIn(word, run.stderr)
        self.assertEqual(sorted(self.directory.iterdir()), before)

    def test_sphere(self):
        vertices, faces = surfaces.sphere(3)
        self.surface("ball.obj", moved(vertices, (10, 0, 0)), faces)
        table = self.made("ball.obj", 2000)
        self.assertGreater(table["volume"], .95 * 4 / 3 * math.pi)
        self.assertLess(table["volume"], 4 / 3 * math.pi)
        self.assertLess(table["surface_to_mesh_max"], 1)
        self.assertGreater(table["angle_median"], 45)
        nodes = read_msh(self.directory / "body.msh").nodes.values()
        self.assertAlmostEqual(sum(x for x, _, _ in nodes) / len(nodes), 10, 1)  # unit and place are kept
        first = (self.directory / "body.msh").read_bytes()
        self.made("ball.obj", 2000, "--quiet")
        self.assertEqual((self.directory / "body.msh").read_bytes(), first)

    def test_groups_become_boundary_ids_of_a_scene(self):
        vertices, faces = surfaces.cube()
        names = ["bottom", "top", "front", "back", "left", "right"]
        self.surface("box.obj", vertices, faces, [names[i // 2] for i in range(12)])
        table = self.made("box.obj", 3000)
        self.assertEqual((table["boundary_ids"], table["volume"]), (6, 1))
        self.assertLess(table["mesh_to_surface_max"], 1e-9)
        self.solve(STATIC, "--quiet")
        self.solve({**STATIC, "Handles/base/Select": "boundary bottom"}, "--quiet", output="named")
        for name in ("statistics.csv", "final.msh"):
            a, b = (self.directory / out / name for out in ("out", "named"))
            if name.endswith(".msh"):
                self.assertEqual(a.read_bytes(), b.read_bytes())

    def test_shells_within_become_material_ids_or_cavities(self):
        outer, inner = surfaces.cube(), surfaces.cube((.25,) * 3, .5)
        self.surface("two.obj", *joined(outer, inner))
        self.assertEqual(self.made("two.obj", 3000)["material_ids"], 2)
        self.solve({**STATIC, "Material/region 2/Young's modulus": "1e7"}, "--quiet")
        self.surface("hollow.obj", *joined(outer, surfaces.cube((.25,) * 3, .5, inside_out=True)))
        table = self.made("hollow.obj", 3000)
        self.assertEqual((table["material_ids"], table["volume"]), (1, .875))

    def test_sheets_that_almost_touch(self):
        self.surface("mouth.obj", *surfaces.mouth(.003, .06))
        table = self.made("mouth.obj", 1500)
        self.assertLess(table["surface_to_mesh_max"], .3)

    def test_polygons_and_other_formats(self):
        vertices, _ = surfaces.cube()
        quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
        self.surface("quads.obj", vertices, quads)
        self.assertEqual(self.made("quads.obj", 300)["volume"], 1)
        text = "\n".join(["ply", "format ascii 1.0", "element vertex 8", "property float x", "property float y",
                          "property float z", "element face 6", "property list uchar int vertex_indices",
                          "property int label", "end_header", *(f"{x} {y} {z}" for x, y, z in vertices),
                          *(f"4 {a} {b} {c} {d} {i * 10}" for i, (a, b, c, d) in enumerate(quads, 1)), ""])
        self.write("quads.ply", text)
        self.made("quads.ply", 300)
        self.solve({**STATIC, "Handles/base/Select": "boundary 60"}, "--quiet")  # labels are ids
        data = bytes(80) + struct.pack("<I", 12)
        for face in surfaces.cube()[1]:
            data += struct.pack("<12fH", 0, 0, 0, *(x for v in face for x in vertices[v]), 0)
        (self.directory / "cube.stl").write_bytes(data)
        self.assertEqual(self.made("cube.stl", 300)["volume"], 1)
        (self.directory / "cut.stl").write_bytes(data[:-30])
        self.refused("cut.stl", "cut.stl: ends after 11 of 12 facets; the file is truncated")

    def test_surfaces_that_bound_no_body(self):
        vertices, faces = surfaces.cube()
        self.surface("open.obj", vertices, faces[:-1])
        self.refused("open.obj", "holes: 1 (with 3 open edges", "at vertex 2 (1, 0, 0)", "--repair")
        self.surface("turned.obj", vertices, [*faces[:4], faces[4][::-1], *faces[5:]])
        self.refused("turned.obj", "faces turned against their neighbours: 1 (face 5)", "--repair")
        self.surface("inwards.obj", *surfaces.cube(inside_out=True))
        self.refused("inwards.obj", "inside out", "--repair")
        self.surface("two.obj", *joined((vertices, faces), surfaces.cube((3, 0, 0))))
        for arguments in ((), ("--repair",)):
            self.refused("two.obj", "more than one body", "12 triangles at (3, 0, 0)", "mesh each alone",
                         arguments=arguments)
        self.surface("crossing.obj", *joined((vertices, faces), surfaces.cube((.5, .5, .5))))
        self.refused("crossing.obj", "pairs of intersecting faces: 18", "faces ", "--repair")
        self.surface("flat.obj", [*vertices, (.5, 0, 0)], [*faces, (0, 8, 1)])
        self.refused("flat.obj", "faces without area: 1 (face 13)", "edges of more than two faces: 1")
        self.surface("soup.obj", [vertices[i] for f in faces for i in f], [(3 * i, 3 * i + 1, 3 * i + 2) for i in range(12)])
        self.refused("soup.obj", "holes: 12", "duplicate vertices: 28")
        self.surface("nan.obj", [*vertices[:7], (1, float("nan"), 1)], faces)
        self.refused("nan.obj", "vertex 8 of 8 has a coordinate that is no finite number")
        self.surface("index.obj", vertices[:7], faces)
        self.refused("index.obj", "line 10: a face uses vertex 8, but the file has 7 vertices")
        self.write("empty.obj", "")
        self.refused("empty.obj", "the file is empty")
        self.write("points.obj", "v 0 0 0\nv 1 0 0\n")
        self.refused("points.obj", "2 vertices and 0 faces")
        self.refused("none.obj", "cannot be opened")
        self.write("scene.prm", "")
        self.refused("scene.prm", "must be an .obj, .ply or .stl file")

    def test_repair(self):
        vertices, faces = surfaces.cube()
        self.surface("bad.obj", [vertices[i] for f in faces for i in f],
                     [(3 * i, 3 * i + 1, 3 * i + 2)[:: -1 if i == 4 else 1] for i in range(11)])
        run = self.mesh("bad.obj", 300, "--repair")
        self.assertEqual((run.status, run.stderr), (0, ""))
        for words in ("vertices joined", "faces turned: 1", "holes filled: 1", "the old surface is at most 0 %"):
            self.assertIn(words, run.stdout)
        self.assertEqual(self.table()["volume"], 1)
        self.surface("crossing.obj", *joined((vertices, faces), surfaces.cube((.5, .5, .5))))
        run = self.mesh("crossing.obj", 2000, "--repair")
        self.assertEqual(run.status, 0, run.stderr)
        self.assertIn("the surface was wrapped", run.stdout)
        self.assertAlmostEqual(self.table()["volume"], 2 - .125, delta=.1)

    def test_arguments(self):
        self.surface("box.obj", *surfaces.cube())
        self.refused("box.obj", "--cells: the number of tetrahedra must be from 10 to 10000000, found 3", cells=3)
        self.refused("box.obj", "--cells", cells="many")
        run = self.call("mesh", "--surface", "box.obj", "--cells", 300, "--output", "none/body.msh")
        self.assertEqual(run.status, 1)
        self.assertIn("there is no directory", run.stderr)
        run = self.call("mesh", "--surface", "box.obj", "--cells", 300, "--output", "body.vtu")
        self.assertEqual(run.status, 1)
        self.assertIn("the mesh is written as .msh", run.stderr)


if __name__ == "__main__":
    unittest.main()
