# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes in the formats of other programs: good ones, spoilt ones, and what meshio reads in them, where it is installed."""

import contextlib
import io
import re

import bases
import mutations

NUMBER = re.compile(rb"(?<![\w.])-?\d+(?:\.\d+)?(?:e[-+]?\d+)?(?![\w.])")


def numbered(mesh):
    """Places, and cells and triangles of indices from 0 with their tags."""
    index = {number: i for i, (number, _) in enumerate(mesh.nodes)}
    of = {kind: [(tag, [index[n] for n in corners]) for _, k, tag, _, corners in mesh.elements if k == kind] for kind in (4, 2)}
    return [place for _, place in mesh.nodes], of[4], of[2]


def rows(entries):
    return "".join(" ".join(map(str, entry)) + "\n" for entry in entries)


def medit(mesh):
    places, cells, faces = numbered(mesh)
    return {"body.mesh": ("MeshVersionFormatted 2\nDimension 3\nVertices\n" + rows([[len(places)]] + [[*x, 0] for x in places])
                          + "Triangles\n" + rows([[len(faces)]] + [[*(i + 1 for i in n), tag] for tag, n in faces])
                          + "Tetrahedra\n" + rows([[len(cells)]] + [[*(i + 1 for i in n), tag] for tag, n in cells]) + "End\n")}


def legacy_vtk(mesh):
    places, cells, _ = numbered(mesh)
    return {"body.vtk": ("# vtk DataFile Version 3.0\nbody\nASCII\nDATASET UNSTRUCTURED_GRID\n" + f"POINTS {len(places)} double\n"
                         + rows(places) + f"CELLS {len(cells)} {5 * len(cells)}\n" + rows([4, *n] for _, n in cells)
                         + f"CELL_TYPES {len(cells)}\n" + rows([10] for _ in cells) + f"CELL_DATA {len(cells)}\nSCALARS region int 1\n"
                         + "LOOKUP_TABLE default\n" + rows([tag] for tag, _ in cells))}


def vtu(mesh):
    places, cells, _ = numbered(mesh)

    def array(kind, name, text, n=1):
        return f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{n}" format="ascii">\n{text}</DataArray>\n'
    return {"body.vtu": (f'<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian">\n<UnstructuredGrid>\n'
                         f'<Piece NumberOfPoints="{len(places)}" NumberOfCells="{len(cells)}">\n<Points>\n' + array("Float64", "Points", rows(places), 3)
                         + "</Points>\n<Cells>\n" + array("Int64", "connectivity", rows(n for _, n in cells))
                         + array("Int64", "offsets", rows([4 * i + 4] for i in range(len(cells)))) + array("UInt8", "types", rows([10] for _ in cells))
                         + "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n")}


def tetgen(mesh):
    places, cells, _ = numbered(mesh)
    return {"body.node": f"{len(places)} 3 0 0\n" + rows([i + 1, *x] for i, x in enumerate(places)),
            "body.ele": f"{len(cells)} 4 1\n" + rows([i + 1, *(k + 1 for k in n), tag] for i, (tag, n) in enumerate(cells))}


def abaqus(mesh):
    places, cells, _ = numbered(mesh)

    def lines(entries):
        return "".join(", ".join(map(str, entry)) + "\n" for entry in entries)
    return {"body.inp": ("*HEADING\nbody\n*NODE\n" + lines([i + 1, *x] for i, x in enumerate(places)) + "*ELEMENT, TYPE=C3D4, ELSET=all\n"
                         + lines([i + 1, *(k + 1 for k in n)] for i, (_, n) in enumerate(cells)) + "*NSET, NSET=held\n1, 2, 3, 4\n")}


def usd(mesh):
    places, cells, _ = numbered(mesh)
    tuples = [", ".join(f"({', '.join(map(str, entry))})" for entry in entries) for entries in (places, [n for _, n in cells])]
    return {"body.usda": (f'#usda 1.0\n(\n    metersPerUnit = 1\n)\ndef TetMesh "body"\n{{\n    point3f[] points = [{tuples[0]}]\n'
                          f"    int4[] tetVertexIndices = [{tuples[1]}]\n}}\n")}


def nastran(mesh):
    places, cells, faces = numbered(mesh)

    def lines(entries):
        return "".join(",".join(map(str, entry)) + "\n" for entry in entries)
    return {"body.bdf": ("SOL 101\nCEND\nBEGIN BULK\n" + lines(["GRID", i + 1, "", *x] for i, x in enumerate(places))
                         + lines(["CTETRA", i + 1, tag, *(k + 1 for k in n)] for i, (tag, n) in enumerate(cells))
                         + lines(["CTRIA3", 1000 + i, tag, *(k + 1 for k in n)] for i, (tag, n) in enumerate(faces)) + "ENDDATA\n")}


FORMATS = [medit, legacy_vtk, vtu, tetgen, abaqus, usd, nastran]


def other_number(r, data):
    """One number of the text is another one."""
    found = r.choice(list(NUMBER.finditer(data)))
    old = found.group().decode()
    new = r.choice([str(r.choice(mutations.INTEGERS)), str(int(float(old)) + r.choice([-1, 1])), repr(r.choice(mutations.REALS)), repr(r.uniform(-3, 3)),
                    old + "0", "-" + old, old + "e1", ""])
    return data[:found.start()] + new.encode() + data[found.end():]


def spoilt(r):
    """{name: bytes} of a body, of which one file is changed, and the name for the scene."""
    files = {name: text.encode() for name, text in r.choice(FORMATS)(bases.box_mesh()).items()}
    name = r.choice(sorted(files))
    change = r.choice([other_number, other_number, mutations.damaged, mutations.spoilt_text])
    files[name] = change(r, files[name])
    return files, r.choice(sorted(files))


def by_meshio(file):
    """(places, cells) that meshio reads in a file; None where it reads none, or is not here."""
    try:
        import meshio
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            mesh = meshio.read(file)
        return mesh.points.tolist(), [list(map(int, cell)) for block in mesh.cells if block.type == "tetra" for cell in block.data]
    except (Exception, SystemExit):  # a reader that fails is no second opinion
        return None
