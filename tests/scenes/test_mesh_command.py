# SPDX-License-Identifier: GPL-3.0-or-later
"""exemplar mesh: from surfaces to meshes that scenes take; test_bad_surfaces.py has what it refuses."""

import csv
import math
import struct
import unittest

import surfaces
from exemplar_runner import SceneTest, read_msh, write_scene
from surfaces import joined, moved

STATIC = {"Scene": "static", "Mesh/File": "body.msh", "Time/Increments": "1", "Handles/Names": "base",
          "Handles/base/Select": "boundary 1", "Loads/Gravity": "0, 0, -1"}


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

    def test_shells_side_by_side_become_pieces(self):
        """Two balls and a cavity in one of them: what is between them is empty, each has its volume, and in a scene each flies alone."""
        vertices, faces = surfaces.sphere(2)
        hollow = joined((vertices, faces), ([[.4 * c for c in x] for x in vertices], [face[::-1] for face in faces]))
        both = joined(hollow, (moved([[.5 * c for c in x] for x in vertices], (2, 0, 0)), faces))
        self.surface("balls.obj", *both)
        run = self.mesh("balls.obj", 2000)
        self.assertEqual((run.status, run.stderr), (0, ""))
        self.assertIn("2 shells side by side (", run.stdout)
        volume = self.table()["volume"]
        self.assertLess(abs(volume / (4 / 3 * math.pi * (1 - .4 ** 3 + .5 ** 3)) - 1), .1)
        write_scene(self.directory / "fall.prm", {"Scene": "dynamic", "Mesh/File": "body.msh", "Handles/Names": "one",
                                                  "Handles/one/Select": "box -2 -2 -2 1.2 2 2", "Loads/Gravity": "0, 0, -1",
                                                  "Material/Mass matrix": "lumped", "Time/Step": "0.1", "Time/End": "1"})
        run = self.call("fall.prm", "--output", "out")
        self.assertEqual((run.status, run.stderr), (0, ""))
        first, last = (read_msh(self.directory / name).nodes for name in ("body.msh", "out/final.msh"))
        for number, x in last.items():
            fallen = .55 if first[number][0] > 1.4 else 0.  # g h^2 n (n + 1) / 2 by implicit Euler
            self.assertLess(math.dist(x, (first[number][0], first[number][1], first[number][2] - fallen)), 1e-6)

    def test_finer_triangles_give_the_same_mesh(self):
        """Of a ring with a narrow hole, where surfaces made anew intersect."""
        vertices, faces = surfaces.torus(60, 40, .5, .46)
        for times in range(3):
            self.surface(f"ring_{times}.obj", vertices, faces)
            run = self.mesh(f"ring_{times}.obj", 1000)
            self.assertEqual((run.status, run.stderr), (0, ""))
            table = self.table()
            self.assertEqual(table["surface_triangles"], 4800 * 4 ** times)
            self.assertLess(abs(table["cells"] / 1000 - 1), .15)
            self.assertGreater(table["angle_smallest"], 8)
            vertices, faces, _ = surfaces.divided(vertices, faces)

    def test_folds_nearer_to_each_other_than_cells_are_large(self):
        """Edges that must follow all folds that meet at a pole intersect, or leave slivers."""
        self.surface("crumpled.obj", *surfaces.crumpled(100))
        self.assertEqual(self.made("crumpled.obj", 5000)["slivers"], 0)

    def test_much_finer_folds_end_too(self):
        """Triangles beside intersections are held from one attempt to the next: each attempt by itself took minutes."""
        self.surface("crumpled.obj", *surfaces.crumpled(300))
        table = self.made("crumpled.obj", 5000)
        self.assertLess(abs(table["cells"] / 5000 - 1), .1)
        self.assertEqual(table["slivers"], 0)

    def test_what_another_has_made_stays(self):
        self.surface("box.obj", *surfaces.cube())
        self.made("box.obj", 300)
        made = {name: (self.directory / name).read_bytes() for name in ("body.msh", "body.csv")}
        own = made["body.msh"]
        unlike = {"text": b"mine\n", "empty": b"", "of gmsh": own[:own.index(b"$Comments")], "appended to": own + b"mine\n"}
        for name, kind in [("body.msh", kind) for kind in unlike] + [
                (name, kind) for name in ("body.csv", "body.msh.tmp", "body.csv.tmp") for kind in ("text",)] + [
                (name, kind) for name in ("body.msh", "body.csv", "body.msh.tmp", "body.csv.tmp")
                for kind in ("directory", "link", "dangling link", "protected")]:
            with self.subTest(name=name, kind=kind):
                file = self.directory / name
                file.unlink(missing_ok=True)
                if kind == "directory":
                    file.mkdir()
                elif "link" in kind:
                    self.write("mine", "mine")
                    file.symlink_to("mine" if kind == "link" else "nowhere")
                else:
                    file.write_bytes(unlike.get(kind, made.get(name, b"")))
                    file.chmod(0o444 if kind == "protected" else 0o644)
                before = {path: path.read_bytes() for path in self.directory.iterdir() if path.is_file()}
                run = self.mesh("box.obj", 300)
                self.assertEqual((run.status, run.stdout), (1, ""), run.stderr)
                self.assertIn(f"{name}: is to be written, but", run.stderr)
                self.assertIn("Nothing has been changed", run.stderr)
                self.assertEqual({path: path.read_bytes() for path in self.directory.iterdir() if path.is_file()}, before)
                file.rmdir() if kind == "directory" else file.unlink()
                for other, content in made.items():
                    (self.directory / other).write_bytes(content)
        self.write("body.csv.tmp", "quan")  # what a killed command leaves
        self.made("box.obj", 300)
        self.assertEqual({name: (self.directory / name).read_bytes() for name in made}, made)

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

    def test_regions_take_the_names_of_their_shells(self):
        outer, inner = surfaces.cube(), surfaces.cube((.25,) * 3, .5)
        self.surface("two.obj", *joined(outer, inner), ["skin"] * 12 + ["bone"] * 12)
        self.made("two.obj", 3000)
        names = read_msh(self.directory / "body.msh").names
        self.assertEqual(names, ['2 1 "skin"', '2 2 "bone"', '3 1 "skin"', '3 2 "bone"'])
        self.solve({**STATIC, "Material/region bone/Young's modulus": "1e7"}, "--quiet")
        self.surface("two.obj", *joined(outer, inner), ["7"] * 12 + ["3"] * 12)
        self.made("two.obj", 3000)
        self.assertEqual(read_msh(self.directory / "body.msh").names[2:], ['3 3 "3"', '3 7 "7"'])

    def materials(self):
        """{material id: volume's share of the cells' centres} and the names."""
        msh = read_msh(self.directory / "body.msh")
        centres = {}
        for element in msh.elements:
            if element[1] == 4:
                corners = [msh.nodes[n] for n in element[-4:]]
                centres.setdefault(element[3], []).append([sum(x) / 4 for x in zip(*corners)])
        return centres, [name for name in msh.names if name.startswith("3 ")]

    def test_a_table_of_points_gives_materials(self):
        self.surface("box.obj", *surfaces.cube())
        self.write("two.csv", "x,y,z,id,name\n# halves\n.2, .5, .5, 4, soft\n\n.8, .5, .5, 9, hard one\n")
        table = self.made("box.obj", 2000, "--materials", "two.csv")
        self.assertEqual(table["material_ids"], 2)
        centres, names = self.materials()
        self.assertEqual(names, ['3 4 "soft"', '3 9 "hard one"'])
        self.assertLess(max(x[0] for x in centres[4]), .5)
        self.assertGreater(min(x[0] for x in centres[9]), .5)
        self.solve({**STATIC, "Material/region hard one/Density": "2000"}, "--quiet")
        # points within shells name these, the others keep names and take what ids are left
        self.surface("nested.obj", *joined(surfaces.cube(), surfaces.cube((.25,) * 3, .5)), ["skin"] * 12 + ["bone"] * 12)
        self.write("inner.csv", "x,y,z,id\n.5,.5,.3,1\n.5,.5,.7,5\n")
        self.made("nested.obj", 3000, "--materials", "inner.csv")
        centres, names = self.materials()
        self.assertEqual((sorted(centres), names), ([1, 2, 5], ['3 2 "skin"']))
        for material, low, high in ((1, .25, .5), (5, .5, .75)):
            self.assertTrue(all(low <= x[2] <= high for x in centres[material]))

    def test_few_cells_have_no_slivers_or_say_so(self):
        shapes = {"ball.obj": surfaces.sphere(2), "plate.obj": ([(x, y, z / 50) for x, y, z in surfaces.cube()[0]], surfaces.cube()[1])}
        for name, shape in shapes.items():
            self.surface(name, *shape)
            for cells in (10, 60):
                run = self.mesh(name, cells)
                self.assertEqual((run.status, run.stderr), (0, ""))
                table = self.table()
                self.assertEqual("Some cells are nearly flat" in run.stdout, table["slivers"] > 0)
                self.assertEqual("away from the mesh" in run.stdout, table["surface_to_mesh_max"] > 5)

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


if __name__ == "__main__":
    unittest.main()
