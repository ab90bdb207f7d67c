# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes of other formats: the same body gives the same bytes, and bad files are refused by line and remedy."""

import shutil
import struct
import unittest
from pathlib import Path

from exemplar_runner import SceneTest

MESHES = Path(__file__).resolve().parent / "meshes"
FALL = {"Scene": "dynamic", "Time/Step": "0.01", "Time/End": "0.05", "Handles/Names": "left",
        "Handles/left/Select": "box -1 -1 -1 1e-9 1 1", "Loads/Gravity": "0, 0, -9.81", "Output/Every": "0"}


def body():
    """Nodes, and (type, tag, nodes from 0) of the elements, of box.msh."""
    words = (MESHES / "box.msh").read_text().split("\n")
    at = words.index("$Nodes")
    nodes = [line.split()[1:] for line in words[at + 2:at + 2 + int(words[at + 1])]]
    at = words.index("$Elements")
    rows = [list(map(int, line.split())) for line in words[at + 2:at + 2 + int(words[at + 1])]]
    return nodes, [(row[1], row[3], [n - 1 for n in row[5:]]) for row in rows]


def write_tetgen(stem, first):
    nodes, elements = body()
    cells = [(tag, e) for kind, tag, e in elements if kind == 4]
    faces = [(tag, e) for kind, tag, e in elements if kind == 2]
    stem.with_suffix(".node").write_text(f"{len(nodes)} 3 0 0\n" + "".join(
        f"{i + first} {' '.join(x)}\n" for i, x in enumerate(nodes)) + "# the end\n")
    stem.with_suffix(".ele").write_text(f"{len(cells)} 4 1\n" + "".join(
        f"{i + first} {' '.join(str(n + first) for n in e)} {tag}\n" for i, (tag, e) in enumerate(cells)))
    stem.with_suffix(".face").write_text(f"{len(faces)} 1\n" + "".join(
        f"{i + first} {' '.join(str(n + first) for n in e)} {tag}\n" for i, (tag, e) in enumerate(faces)))


def write_usda(file):
    nodes, elements = body()
    points = ", ".join("({}, {}, {})".format(*x) for x in nodes)
    cells = ", ".join("({}, {}, {}, {})".format(*e) for kind, _, e in elements if kind == 4)
    file.write_text(f'#usda 1.0\ndef TetMesh "cells"\n{{\n    point3f[] points = [{points}]\n'
                    f"    int4[] tetVertexIndices = [{cells}]\n}}\n")


def write_nastran(file, form):
    """In free fields, or in large ones with exponents without an E."""
    nodes, elements = body()
    lines = ["$ a body", "BEGIN BULK", "MAT1,1,2.1+11,,0.3"]
    for i, x in enumerate(nodes):
        if form == "free":
            lines.append(f"GRID,{i + 1},,{','.join(x)}")
        else:
            x = [f"{float(c):.9e}".replace("e", "") for c in x]
            lines += [f"GRID*   {i + 1:16}{'':16}{x[0]:>16}{x[1]:>16}", f"*       {x[2]:>16}"]
    for i, (kind, tag, e) in enumerate(elements):
        name = {4: "CTETRA", 2: "CTRIA3"}.get(kind)
        if name:
            lines.append(f"{name},{i + 1},{tag},{','.join(str(n + 1) for n in e)}" if form == "free"
                         else f"{name:8}{i + 1:8}{tag:8}" + "".join(f"{n + 1:8}" for n in e))
    file.write_text("\n".join([*lines, "ENDDATA", "rubbish"]) + "\n")


class MeshFormatsTest(SceneTest):
    def nodes_after_fall(self, mesh, **settings):
        run = self.call(self.scene({**FALL, "Mesh/File": str(mesh), **settings}), "--quiet", "--output", "out")
        self.assertEqual(run.status, 0, run.stderr)
        text = (self.directory / "out/final.msh").read_text()
        shutil.rmtree(self.directory / "out")
        return text[text.index("$Nodes"):text.index("$EndNodes")]

    def check_fall(self, file, expected):
        """The same bytes; of gmsh's .mesh and .inp, whose numbers have 14 digits, the same places to what a step is solved to."""
        found = self.nodes_after_fall(file)
        if not Path(file).name.startswith(("gmsh.mesh", "gmsh.inp", "ends.mesh", "ends.inp")):
            return self.assertEqual(found, expected)
        found, expected = ([[float(word) for word in line.split()] for line in text.split("\n")[2:-1]] for text in (found, expected))
        self.assertEqual(len(found), len(expected))
        for a, b in zip(found, expected):
            self.assertEqual(a[0], b[0])
            self.assertLess(max(abs(x - y) for x, y in zip(a, b)), 1e-6)

    def scene(self, settings):
        from exemplar_runner import write_scene
        return write_scene(self.directory / "scene.prm", settings)

    def refuses(self, name, text, *words):
        """The message on a file of this text."""
        file = self.directory / name
        file.write_bytes(text if isinstance(text, bytes) else text.encode())
        run = self.call(self.scene({**FALL, "Mesh/File": name}), "--validate")
        self.assertEqual(run.status, 1, run.stdout)
        for word in [Path(name).stem, *words]:
            self.assertIn(word, run.stderr)

    def test_the_same_body_in_all_formats(self):
        expected = self.nodes_after_fall(MESHES / "box.msh")
        files = [MESHES / name for name in ("gmsh.mesh", "gmsh.vtk", "gmsh.inp", "meshio.mesh", "meshio.vtk",
                                            "meshio.vtu", "meshio.inp")]
        for extension in ("msh", "mesh", "vtu", "inp"):
            files.append(self.directory / f"own.{extension}")
            run = self.call("convert", MESHES / "box.msh", files[-1])
            self.assertEqual((run.status, run.stderr), (0, ""))
        for first in (0, 1):
            write_tetgen(self.directory / f"from{first}", first)
            files += [self.directory / f"from{first}.node", self.directory / f"from{first}.ele"]
        write_usda(self.directory / "by_hand.usda")
        write_nastran(self.directory / "by_hand.bdf", "free")
        for file in [*files, self.directory / "by_hand.usda", self.directory / "by_hand.bdf"]:
            with self.subTest(file.name):
                self.check_fall(file, expected)

    def test_nastran_by_its_digits(self):
        write_nastran(self.directory / "large.nas", "large")
        far = [[float(word) for word in line.split()] for line in self.nodes_after_fall("large.nas").split("\n")[2:-1]]
        near = [[float(word) for word in line.split()] for line in self.nodes_after_fall(MESHES / "box.msh").split("\n")[2:-1]]
        self.assertLess(max(abs(a - b) for x, y in zip(far, near) for a, b in zip(x, y)), 1e-6)
        if shutil.which("gmsh"):  # whose small fields have six digits
            import subprocess
            subprocess.run(["gmsh", "-0", MESHES / "box.msh", "-o", self.directory / "gmsh.bdf", "-format", "bdf"], check=True, capture_output=True)
            near = self.call(self.scene({**FALL, "Mesh/File": "gmsh.bdf"}), "--quiet", "--output", "out")
            self.assertEqual(near.status, 0, near.stderr)

    def test_notes_of_poses_and_units(self):
        write_usda(self.directory / "unit.usda")
        text = (self.directory / "unit.usda").read_text().replace("#usda 1.0", "#usda 1.0\n(\n    metersPerUnit = 0.01\n)")
        (self.directory / "unit.usda").write_text(text)
        for settings in ({"Mesh/File": "unit.usda"}, {"Mesh/File": str(MESHES / "box.msh"), "Initial/Pose": "unit.usda"}):
            run = self.call(self.scene({**FALL, **settings}), "--validate")
            self.assertEqual(run.status, 0, run.stderr)
            self.assertIn("its unit is 0.01 m (metersPerUnit), which Mesh/Scale = 0.01 makes metres of", run.stdout + run.stderr)

    def test_other_ends_of_lines(self):
        expected = self.nodes_after_fall(MESHES / "box.msh")
        for name in ("gmsh.mesh", "gmsh.vtk", "gmsh.inp"):
            for end in (b"\r\n", b"\r"):
                file = self.directory / ("ends" + Path(name).suffix)
                file.write_bytes((MESHES / name).read_bytes().replace(b"\n", end))
                with self.subTest(name, end=end):
                    self.check_fall(file, expected)

    def test_sets_of_abaqus(self):
        held = ",\n".join(str(i + 1) for i, x in enumerate(body()[0]) if float(x[0]) < 1e-9)
        text = (MESHES / "meshio.inp").read_text() + f"*NSET, NSET=Held\n{held}\n"
        (self.directory / "sets.inp").write_text(text)
        by_set = self.nodes_after_fall("sets.inp", **{"Handles/left/Select": "set Held"})
        self.assertEqual(by_set, self.nodes_after_fall(MESHES / "box.msh"))
        first = next(int(line.split(",")[0]) for line in text.split("TYPE=C3D4")[1].split("\n")[1:])
        (self.directory / "sets.inp").write_text(text + f"*ELSET, ELSET=Stiff, GENERATE\n{first}, {first + 3}, 1\n")
        run = self.call(self.scene({**FALL, "Mesh/File": "sets.inp", "Handles/left/Select": "region Stiff"}), "--validate")
        self.assertEqual(run.status, 0, run.stderr)

    def test_exponents_of_fortran(self):
        text = (MESHES / "meshio.inp").read_text()
        (self.directory / "fortran.inp").write_text(text.replace("e-", "D-").replace("e+", "d+"))
        self.check_fall("fortran.inp", self.nodes_after_fall(MESHES / "box.msh"))
        self.refuses("a.inp", text.replace("e-01", "D-0D1"), "should be a finite number")

    def test_poses_in_other_formats(self):
        self.call("convert", MESHES / "box.msh", "pose.vtu")
        expected = self.nodes_after_fall(MESHES / "box.msh")
        self.assertEqual(self.nodes_after_fall(MESHES / "box.msh", **{"Initial/Pose": "pose.vtu"}), expected)

    def test_files_that_are_cut_off(self):
        for name in ("gmsh.mesh", "gmsh.vtk", "meshio.vtk", "meshio.vtu"):
            with self.subTest(name):
                data = (MESHES / name).read_bytes()
                self.refuses("cut" + Path(name).suffix, data[:len(data) // 2], "again")

    def test_bad_files(self):
        self.refuses("a.inp", "*INCLUDE, INPUT=b.inp\n", "line 1", "*INCLUDE is not read", "Put the text")
        self.refuses("a.inp", "*NODE\n1, 0, 0, 0\n*TRANSFORM, NSET=A\n", "line 3", "*TRANSFORM is not read")
        self.refuses("a.inp", "*Part, name=A\n", "*PART is not read", "without parts")
        self.refuses("a.inp", "*NODE\n1,0,0,0\n*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 4\n", "element 1 uses node 2")
        self.refuses("a.inp", "*NODE\n1,0,0,0\n*ELEMENT, TYPE=COH3D8\n", "'COH3D8'", "C3D4")
        self.refuses("a.mesh", "MeshVersionFormatted 2\nDimension 2\n", "line 2", "Dimension is 2")
        self.refuses("a.mesh", struct.pack("i", 1), "MeshVersionFormatted", "save it as text")
        self.refuses("a.vtk", "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\n", "POLYDATA", "ParaView")
        self.refuses("a.vtu", '<VTKFile type="PolyData">', "'PolyData'", "UnstructuredGrid")
        self.refuses("a.vtu", '<VTKFile type="UnstructuredGrid" compressor="vtkLZ4DataCompressor">', "vtkLZ4DataCompressor")
        self.refuses("a.node", "1 3 0 0\n1 0 0 0\n", "a.ele", "there is no such file")
        self.refuses("a.bdf", "GRID,1,7,0.,0.,0.\n", "line 1", "coordinate system 7", "basic system")
        self.refuses("a.bdf", "GRID,1,,0.,0.,0.\nCHEXA,1,1,1,2,3,4,5,6,7,8\n", "line 2", "CHEXA is not read")
        self.refuses("a.bdf", "GRID,1,,0.,0.,0.\nCTETRA,1,1,1,2,3,4\n", "line 2", "element 1 uses node 2")
        self.refuses("a.bdf", "GRID,1,,0.,x,0.\n", "line 1", "field 5 of GRID is 'x'")
        self.refuses("a.bdf", "+,1\n", "continues an entry")
        self.refuses("a.usda", '#usda 1.0\ndef Mesh "a" {}\n', "def TetMesh")
        self.refuses("a.vtk", (MESHES / "gmsh.mesh").read_bytes(), "It is a Medit mesh. Call it a.mesh.")

    def test_what_convert_refuses(self):
        for out, word in (("a.vtk", "meshes are written as .msh, .mesh, .vtu and .inp"), ("none/a.msh", "no directory")):
            run = self.call("convert", MESHES / "box.msh", out)
            self.assertEqual((run.status, run.stdout), (1, ""))
            self.assertIn(word, run.stderr)
        run = self.call("convert", MESHES / "box.msh", "a.mesh")
        self.assertIn("Names of groups are left out", run.stdout)
        run = self.call("convert", MESHES / "box.msh", "a.mesh")
        self.assertIn("is there already", run.stderr)


if __name__ == "__main__":
    unittest.main()
