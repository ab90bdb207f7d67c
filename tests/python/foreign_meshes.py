# SPDX-License-Identifier: GPL-3.0-or-later
"""One body of two cubes as many programs write it, by the documentation of their formats; see test_foreign_meshes.py.

Tetrahedra of x < 1 are region 1, the others region 2; triangles at x = 0 are boundary 11, at x = 2 boundary 12, and between the
cubes, at x = 1, boundary 13."""
import base64
import itertools
import struct
import zlib

NODES = [(float(x), float(y), float(z)) for z in (0, 1) for y in (0, 1) for x in (0, 1, 2)]
PATHS = [(1, 2, 4), (1, 4, 2), (2, 1, 4), (2, 4, 1), (4, 1, 2), (4, 2, 1)]
EDGES = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]  # of VTK, Abaqus and Medit; gmsh exchanges the last two


def number(place):
    return NODES.index(place)


def cells():
    """(region, nodes) from 0."""
    found = []
    for cube, path in itertools.product((0, 1), PATHS):
        corner, at = [0, 0, 0], [number((float(cube), 0., 0.))]
        for bit in path:
            corner[bit.bit_length() - 1] += 1
            at.append(number((float(cube + corner[0]), float(corner[1]), float(corner[2]))))
        a, b, c = ([NODES[at[i]][k] - NODES[at[0]][k] for k in range(3)] for i in (1, 2, 3))
        volume = sum(a[i] * (b[(i + 1) % 3] * c[(i + 2) % 3] - b[(i + 2) % 3] * c[(i + 1) % 3]) for i in range(3))
        found.append((cube + 1, at if volume > 0 else [at[0], at[2], at[1], at[3]]))
    return found


CELLS = cells()


def faces(x, tag):
    """The triangles of tetrahedra in a plane, each once."""
    sides = {tuple(sorted(side)) for _, nodes in CELLS for side in itertools.combinations(nodes, 3) if all(NODES[n][0] == x for n in side)}
    return [(tag, list(side)) for side in sorted(sides)]


FACES = faces(0., 11) + faces(2., 12) + faces(1., 13)
SIDES = sorted({tuple(sorted((nodes[a], nodes[b]))) for _, nodes in CELLS for a, b in EDGES})
MIDDLES = NODES + [tuple((NODES[a][k] + NODES[b][k]) / 2 for k in range(3)) for a, b in SIDES]


def quadratic(nodes, edges=EDGES):
    return nodes + [len(NODES) + SIDES.index(tuple(sorted((nodes[a], nodes[b])))) for a, b in edges]


GMSH_EDGES = EDGES[:3] + [(0, 3), (2, 3), (1, 3)]


def lines(rows, gap=" "):
    return "".join(gap.join(map(str, row)) + "\n" for row in rows)


# legacy VTK

METADATA = "METADATA\nINFORMATION 1\nNAME L2_NORM_RANGE LOCATION vtkDataArray\nDATA 2 0 1.73205 \n\n"
COMPONENTS = "METADATA\nCOMPONENT_NAMES\nX\nY\nZ\nINFORMATION 0\n\n"


class Vtk:
    """A legacy file: ASCII with nine numbers per line as VTK's, or binary of the greatest digit first."""

    def __init__(self, binary, version="5.1", points=NODES, kind="double"):
        self.binary, self.version = binary, version
        self.out = f"# vtk DataFile Version {version}\nvtk output\n{'BINARY' if binary else 'ASCII'}\nDATASET UNSTRUCTURED_GRID\n".encode()
        self.kind, self.points = kind, points

    def add(self, text):
        self.out += text.encode() if isinstance(text, str) else text
        return self

    def numbers(self, values, form):
        if self.binary:
            return self.add(struct.pack(f">{len(values)}{form}", *values) + b"\n")
        return self.add("".join(" ".join(map(str, values[i:i + 9])) + " \n" for i in range(0, len(values), 9)))

    def grid(self, metadata="", order=2, triangles=True):
        all_cells = [(24 if order == 2 and len(n) == 10 else 10, n) for _, n in self.tetrahedra()] + [(5, n) for _, n in FACES if triangles]
        self.add(f"POINTS {len(self.points)} {self.kind}\n").numbers([x for p in self.points for x in p], self.kind[0]).add(metadata)
        flat = [n for _, nodes in all_cells for n in nodes]
        if self.version >= "5":
            ends = list(itertools.accumulate([0] + [len(n) for _, n in all_cells]))
            self.add(f"CELLS {len(ends)} {len(flat)}\nOFFSETS vtktypeint64\n").numbers(ends, "q").add("CONNECTIVITY vtktypeint64\n").numbers(flat, "q")
        else:
            counted = [n for _, nodes in all_cells for n in [len(nodes), *nodes]]
            self.add(f"CELLS {len(all_cells)} {len(counted)}\n").numbers(counted, "i")
        return self.add(f"CELL_TYPES {len(all_cells)}\n").numbers([kind for kind, _ in all_cells], "i").add("\n")

    def tetrahedra(self):
        return CELLS if self.points is NODES else [(tag, quadratic(n)) for tag, n in CELLS]


TAGS = [tag for tag, _ in CELLS] + [tag for tag, _ in FACES]


def paraview(binary, version, **how):
    """Save Data of ParaView: arrays in a FIELD, each with a block of METADATA."""
    file = Vtk(binary, version, **how).grid(COMPONENTS if binary else METADATA)
    file.add(f"CELL_DATA {len(TAGS)}\nFIELD FieldData 2\nvtkOriginalCellIds 1 {len(TAGS)} vtktypeint64\n").numbers(list(range(len(TAGS))), "q").add(METADATA)
    file.add(f"material%20id 1 {len(TAGS)} int\n").numbers(TAGS, "i").add(METADATA)
    file.add(f"POINT_DATA {len(file.points)}\nVECTORS u double\n").numbers([0.] * 3 * len(file.points), "d")
    return file.add(METADATA).out


def with_field_data(binary):
    file = Vtk(binary, "4.2").add("FIELD FieldData 3\nTimeValue 1 1 double\n").numbers([0.5], "d").add(METADATA)
    file.add("Title 1 2 string\n").add(b"\xc5steel\xc3a b\n" if binary else "steel\na%20b\n").add(METADATA)
    file.add("flags 1 3 bit\n").add(b"\xa0\n" if binary else "1 0 1\n")
    return file.grid().add(f"CELL_DATA {len(TAGS)}\nSCALARS material int 1\nLOOKUP_TABLE default\n").numbers(TAGS, "i").out


def with_attributes(binary):
    """All attributes that the format has."""
    n, file = len(NODES), Vtk(binary, "3.0").grid()
    file.add(f"POINT_DATA {n}\nSCALARS t float\nLOOKUP_TABLE mine\n").numbers([0.5] * n, "f")
    file.add("LOOKUP_TABLE mine 2\n").add(b"\x00\x00\x00\xff\xff\xff\xff\xff\n" if binary else "0 0 0 1\n1 1 1 1\n")
    file.add("NORMALS n float\n").numbers([0., 0., 1.] * n, "f").add("TEXTURE_COORDINATES uv 2 float\n").numbers([0.] * 2 * n, "f")
    file.add("TENSORS s double\n").numbers([0.] * 9 * n, "d").add("TENSORS6 s6 double\n").numbers([0.] * 6 * n, "d")
    file.add("COLOR_SCALARS c 3\n").add(bytes(3 * n) + b"\n" if binary else "0.5 " * (3 * n) + "\n")
    file.add("GLOBAL_IDS ids vtkIdType\n").numbers(list(range(n)), "i")
    return file.add(f"CELL_DATA {len(TAGS)}\nPEDIGREE_IDS p vtkIdType\n").numbers(list(range(len(TAGS))), "i").add("SCALARS region int\nLOOKUP_TABLE default\n").numbers(TAGS, "i").out


def gmsh_vtk():
    file = Vtk(False, "2.0").grid().add(f"CELL_DATA {len(TAGS)}\nSCALARS CellEntityIds int 1\nLOOKUP_TABLE default\n").add(lines([[t] for t in TAGS]))
    return file.out.replace(b"vtk output", b"body, Created by Gmsh 4.11.1")


def meshio_vtk():
    file = Vtk(True).grid().add(f"CELL_DATA {len(TAGS)}\nFIELD FieldData 1\ngmsh:physical 1 {len(TAGS)} int\n").numbers(TAGS, "i")
    return file.out.replace(b"vtk output", b"written by meshio v5.3.4")


LEGACY = {
    "ParaView 5.10, ASCII": lambda: paraview(False, "5.1"),
    "ParaView 5.10, binary": lambda: paraview(True, "5.1"),
    "ParaView 5.8, ASCII": lambda: paraview(False, "4.2"),
    "ParaView 5.8, binary": lambda: paraview(True, "4.2"),
    "ParaView, quadratic": lambda: paraview(False, "5.1", points=MIDDLES),
    "ParaView, quadratic and float": lambda: paraview(True, "4.2", points=MIDDLES, kind="float"),
    "field data, ASCII": lambda: with_field_data(False),
    "field data, binary": lambda: with_field_data(True),
    "attributes, ASCII": lambda: with_attributes(False),
    "attributes, binary": lambda: with_attributes(True),
    "gmsh": gmsh_vtk,
    "meshio": meshio_vtk,
    "ends of Windows": lambda: paraview(False, "4.2").replace(b"\n", b"\r\n"),
}

# VTK in XML

FORMS = {"Float64": "d", "Float32": "f", "Int64": "q", "Int32": "i", "UInt8": "B", "Int8": "b"}
KEY = ('<InformationKey name="L2_NORM_RANGE" location="vtkDataArray" length="2">\n<Value index="0">\n0\n</Value>\n'
       '<Value index="1">\n1.7\n</Value>\n</InformationKey>\n')


class Vtu:
    def __init__(self, form, header="UInt32", packed=False, order="LittleEndian", block=32768, keys=False):
        self.form, self.header, self.packed, self.block, self.keys = form, header, packed, block, keys
        self.sign, self.big = (">" if order == "BigEndian" else "<"), order
        self.appended = b""

    def head(self, *numbers):
        return struct.pack(f"{self.sign}{len(numbers)}{'Q' if self.header == 'UInt64' else 'I'}", *numbers)

    def parts(self, data):
        if not self.packed:
            return [self.head(len(data)) + data]
        blocks = [data[i:i + self.block] for i in range(0, len(data), self.block)]
        last = len(blocks[-1]) % self.block
        zipped = [zlib.compress(one) for one in blocks]
        return [self.head(len(blocks), self.block, last, *map(len, zipped)), b"".join(zipped)]

    def array(self, kind, name, values, n=1):
        data = struct.pack(f"{self.sign}{len(values)}{FORMS[kind]}", *values)
        begin = f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{n}" format="{self.form.split()[0]}" RangeMin="0" RangeMax="1.7"'
        if self.form == "ascii":
            text = "\n" + " ".join(map(str, values)) + "\n"
        elif self.form == "binary":
            text = "\n" + "".join(base64.b64encode(part).decode() for part in self.parts(data)) + "\n"
        else:
            begin, text = begin + f' offset="{len(self.appended)}"', ""
            encode = base64.b64encode if self.form.endswith("base64") else bytes
            self.appended += b"".join(encode(part) for part in self.parts(data))
        if not text and not self.keys:
            return begin + "/>\n"
        return begin + ">" + text + (KEY if self.keys else "") + "</DataArray>\n"

    def file(self, points=NODES, kind="Float64", ids="Int64", names=("material",)):
        all_cells = ([(10, n) for _, n in CELLS] if points is NODES else [(24, quadratic(n)) for _, n in CELLS]) + [(5, n) for _, n in FACES]
        attributes = f'byte_order="{self.big}" header_type="{self.header}"' + (' compressor="vtkZLibDataCompressor"' if self.packed else "")
        text = (f'<?xml version="1.0"?>\n<!-- a body -->\n<VTKFile type="UnstructuredGrid" version="1.0" {attributes}>\n<UnstructuredGrid>\n<FieldData>\n'
                + self.array("Float64", "TimeValue", [0.5]).replace("NumberOfComponents", "NumberOfTuples")
                + '<Array type="String" Name="title" NumberOfTuples="1" format="ascii">\n98 111 0\n</Array>\n</FieldData>\n'
                + f'<Piece NumberOfPoints="{len(points)}" NumberOfCells="{len(all_cells)}">\n<PointData>\n'
                + self.array("Float32", "u", [0.] * 3 * len(points), 3) + "</PointData>\n<CellData>\n"
                + self.array("UInt8", "vtkGhostType", [0] * len(all_cells)) + "".join(self.array("Int32", name, TAGS) for name in names)
                + "</CellData>\n<Points>\n" + self.array(kind, "Points", [x for p in points for x in p], 3) + "</Points>\n<Cells>\n"
                + self.array(ids, "connectivity", [n for _, nodes in all_cells for n in nodes])
                + self.array(ids, "offsets", list(itertools.accumulate(len(n) for _, n in all_cells)))
                + self.array("UInt8", "types", [kind for kind, _ in all_cells]) + "</Cells>\n</Piece>\n</UnstructuredGrid>\n").encode()
        if self.appended:
            text += f'<AppendedData encoding="{"base64" if self.form.endswith("base64") else "raw"}">\n_'.encode() + self.appended + b"\n</AppendedData>\n"
        return text + b"</VTKFile>\n"


XML = {
    "ascii": lambda: Vtu("ascii").file(),
    "ascii with keys": lambda: Vtu("ascii", keys=True).file(),
    "binary": lambda: Vtu("binary").file(),
    "binary, UInt64": lambda: Vtu("binary", "UInt64", keys=True).file(),
    "binary, zlib": lambda: Vtu("binary", "UInt64", True).file(),
    "binary, zlib in blocks": lambda: Vtu("binary", packed=True, block=64).file(),
    "appended raw": lambda: Vtu("appended", "UInt64").file(),
    "appended raw, zlib": lambda: Vtu("appended", "UInt64", True, keys=True).file(),
    "appended base64": lambda: Vtu("appended base64").file(),
    "appended base64, zlib": lambda: Vtu("appended base64", "UInt64", True, block=100).file(),
    "other order of bytes": lambda: Vtu("appended", order="BigEndian").file(),
    "quadratic": lambda: Vtu("appended", "UInt64", True).file(MIDDLES, "Float32", "Int32"),
    "several arrays": lambda: Vtu("ascii", keys=True).file(names=("CellEntityIds", "other")),
}

# Abaqus and CalculiX


def rows_of(numbers, n=8):
    return "".join(", ".join(map(str, numbers[i:i + n])) + ",\n" for i in range(0, len(numbers), n))


def deck(node="*NODE", cell="*ELEMENT, TYPE=C3D4, ELSET={}", points=NODES, skin=True, gap=", ", sets="*ELSET, ELSET={}\n", comment="** a comment\n", word=str):
    """An input deck; sets of elements are called R1, R2 and B11 to B13."""
    text = comment + node + "\n" + lines(([i + 1, *x] for i, x in enumerate(points)), gap)
    numbers, first = {}, 1
    groups = [(f"R{t}", cell, [n for tag, n in CELLS if tag == t]) for t in (1, 2)]
    if skin:
        groups += [(f"B{t}", "*ELEMENT, TYPE=S3, ELSET={}", [n for tag, n in FACES if tag == t]) for t in (11, 12, 13)]
    for name, keyword, members in groups:
        if points is not NODES and len(members[0]) == 4:
            members = [quadratic(n) for n in members]
        numbers[name] = list(range(first, first + len(members)))
        text += comment + keyword.format(name) + "\n"
        for n in members:
            row = [first, *(k + 1 for k in n)]
            text += gap.join(map(str, row[:9])) + (gap.rstrip() + "\n" + gap.join(map(str, row[9:])) if len(row) > 9 else "") + "\n"
            first += 1
        if "ELSET" not in keyword.upper():
            text += sets.format(name) + rows_of(numbers[name])
    return word(text + "*NSET, NSET=HELD\n" + rows_of([i + 1 for i, x in enumerate(points) if x[0] == 0.]))


def gmsh_inp():
    text = deck(cell="*ELEMENT, type=C3D4, ELSET={}", comment="******* E L E M E N T S *************\n").replace("TYPE=S3", "type=CPS3")
    return "*Heading\n body.inp\n" + text


STEP = ("*MATERIAL, NAME=STEEL\n*ELASTIC\n210000., 0.3\n*SOLID SECTION, ELSET=R1, MATERIAL=STEEL\n*SURFACE, NAME=S, TYPE=ELEMENT\n1, S1\n*STEP\n*STATIC\n"
        "*BOUNDARY\nHELD, 1, 3\n*CLOAD\n5, 2, 1.\n*NODE PRINT, NSET=HELD\nU\n*EL FILE\nS\n*END STEP\n")

INP = {
    "CalculiX": lambda: deck("*NODE, NSET=NALL") + STEP,
    "CalculiX, quadratic": lambda: deck("*NODE, NSET=NALL", "*ELEMENT, TYPE=C3D10, ELSET={}", MIDDLES) + STEP,
    "PrePoMax": lambda: deck("*Node", "*Element, Type=C3D10, Elset={}", MIDDLES, sets="*Elset, Elset={}\n").replace("*NSET, NSET", "*Nset, Nset"),
    "gmsh": gmsh_inp,
    "Abaqus": lambda: "*Heading\n** Job name: a\n*Preprint, echo=NO, model=NO\n" + deck("*Node, nset=N, system=R", "*Element, type=C3D4H, elset={}", gap=",   ") + STEP,
    "Abaqus, modified elements": lambda: deck("*Node", "*Element, type=C3D10M, elset={}", MIDDLES),
    "sets in lines of their own": lambda: deck(cell="*ELEMENT, TYPE=C3D4"),
    "small letters": lambda: deck(word=str.lower).replace("r1", "R1").replace("r2", "R2").replace("b1", "B1").replace("held", "HELD"),
    "keywords in two lines": lambda: deck(cell="*ELEMENT,\nTYPE=C3D4,\nELSET={}"),
    "normals of nodes": lambda: deck().replace("1, 0.0, 0.0, 0.0\n", "1, 0.0, 0.0, 0.0, 0., 0., 1.\n", 1),
    "nodes of elements": lambda: deck() + "*NSET, NSET=FAR, ELSET=B12\n*NSET, NSET=BOTH\nHELD, FAR\n",
    "ends of Windows": lambda: deck("*NODE, NSET=NALL").replace("\n", "\r\n"),
    "empty sets and quotes": lambda: deck(cell='*ELEMENT, TYPE=C3D4, ELSET="{}"') + "*ELSET, ELSET=ALL\nR1, R2\n",
}

# gmsh

NAMES = '$PhysicalNames\n5\n2 11 "left"\n2 12 "right side"\n2 13 "between"\n3 1 "one"\n3 2 "two"\n$EndPhysicalNames\n'
POST = '$NodeData\n1\n"u"\n1\n0.0\n3\n0\n1\n1\n1 0.5\n$EndNodeData\n$ElementData\n1\n"e"\n1\n0.\n3\n0\n1\n1\n7 1.\n$EndElementData\n'


def gmsh_cells(points):
    return [(4, t, n) for t, n in CELLS] if points is NODES else [(11, t, quadratic(n, GMSH_EDGES)) for t, n in CELLS]


def gmsh_2(version="2.2", points=NODES, first=1, names=NAMES, more="", tags=(), also=()):
    """also: pairs of a group and the further group in which its elements are, too, which repeats them."""
    elements = [(2, t, n) for t, n in FACES] + gmsh_cells(points)
    rows, number = [], 0
    for kind, tag, nodes in elements:
        for group in [tag, *(g for t, g in also if t == tag)]:
            number += 1
            rows.append([number, kind, 2 + len(tags), group, tag, *tags, *(n + first for n in nodes)])
    return (f"$MeshFormat\n{version} 0 8\n$EndMeshFormat\n" + names + f"$Nodes\n{len(points)}\n" + lines([i + first, *x] for i, x in enumerate(points))
            + f"$EndNodes\n$Elements\n{len(rows)}\n" + lines(rows) + "$EndElements\n" + more)


def gmsh_2_binary(points=NODES):
    text = b"$MeshFormat\n2.2 1 8\n" + struct.pack("i", 1) + b"\n$EndMeshFormat\n" + NAMES.encode() + f"$Nodes\n{len(points)}\n".encode()
    text += b"".join(struct.pack("=i3d", i + 1, *x) for i, x in enumerate(points)) + b"\n$EndNodes\n"
    elements = gmsh_cells(points)
    text += f"$Elements\n{len(FACES) + len(elements)}\n".encode() + struct.pack("3i", 2, len(FACES), 2)
    text += b"".join(struct.pack("6i", i + 1, t, t, *(k + 1 for k in n)) for i, (t, n) in enumerate(FACES))
    for i, (kind, t, n) in enumerate(elements):  # a head for each, as gmsh writes
        text += struct.pack(f"={6 + len(n)}i", kind, 1, 2, len(FACES) + i + 1, t, t, *(k + 1 for k in n))
    return text + b"\n$EndElements\n" + POST.encode()


class Gmsh4:
    def __init__(self, binary, points=NODES, also=(), names=NAMES, parametric=False, centre=False, more=""):
        self.binary, self.points, self.also, self.names, self.parametric, self.centre, self.more = binary, points, also, names, parametric, centre, more

    def put(self, form, *values):
        if self.binary:
            return struct.pack("=" + form, *values)
        return (" ".join(map(str, values)) + "\n").encode()

    def file(self):
        surfaces, volumes = (11, 12, 13), (1, 2)
        text = f"$MeshFormat\n4.1 {int(self.binary)} 8\n".encode() + (struct.pack("i", 1) + b"\n" if self.binary else b"") + b"$EndMeshFormat\n"
        text += self.names.encode() + b"$Entities\n" + self.put("4Q", int(self.centre), 0, 3, 2)
        if self.centre:
            text += self.put("i3dQ", 99, 5., 5., 5., 0)
        for dimension, entities in ((2, surfaces), (3, volumes)):
            for tag in entities:
                groups = [tag, *(g for t, g in self.also if t == tag)]
                text += self.put(f"i6dQ{len(groups)}iQ", tag, 0., 0., 0., 2., 1., 1., len(groups), *groups, 0)
        text += b"\n$EndEntities\n$Nodes\n" if self.binary else b"$EndEntities\n$Nodes\n"
        n = len(self.points)
        text += self.put("4Q", 1 + self.centre, n + self.centre, 1, n + self.centre)
        text += self.put("3iQ", 2 if self.parametric else 3, 11 if self.parametric else 1, int(self.parametric), n)
        text += b"".join(self.put("Q", i + 1) for i in range(n))
        text += b"".join(self.put("5d", *x, 0.1, 0.2) if self.parametric else self.put("3d", *x) for x in self.points)
        if self.centre:
            text += self.put("3iQ", 0, 99, 0, 1) + self.put("Q", n + 1) + self.put("3d", 5., 5., 5.)
        text += b"\n$EndNodes\n$Elements\n" if self.binary else b"$EndNodes\n$Elements\n"
        blocks = [(2, t, 2, [n for tag, n in FACES if tag == t]) for t in surfaces]
        blocks += [(3, t, kind, [n for k, tag, n in gmsh_cells(self.points) if tag == t]) for t in volumes for kind in {k for k, _, _ in gmsh_cells(self.points)}]
        if self.centre:
            blocks.insert(0, (0, 99, 15, [[n]]))
        total = sum(len(members) for *_, members in blocks)
        text += self.put("4Q", len(blocks), total, 1, total)
        count = itertools.count(1)
        for dimension, tag, kind, members in blocks:
            text += self.put("3iQ", dimension, tag, kind, len(members))
            text += b"".join(self.put(f"{1 + len(m)}Q", next(count), *(k + 1 for k in m)) for m in members)
        return text + (b"\n" if self.binary else b"") + b"$EndElements\n" + self.more.encode()


TWICE = ((1, 7), (2, 7), (11, 21))
PERIODIC = "$Periodic\n1\n0 1 2\n0\n1\n1 2\n$EndPeriodic\n"

MSH = {
    "gmsh 2.2": lambda: gmsh_2(),
    "gmsh 2.0": lambda: gmsh_2("2"),
    "gmsh 2.1 in parts": lambda: gmsh_2("2.1", tags=(1, 1)),
    "gmsh 2.2, with results": lambda: gmsh_2(more=PERIODIC + POST),
    "gmsh 2.2, quadratic": lambda: gmsh_2(points=MIDDLES),
    "gmsh 2.2, other numbers": lambda: gmsh_2(first=1000),
    "gmsh 2.2, a comment before": lambda: gmsh_2(more="$Comments\n$Nodes\n$EndComments\n"),
    "gmsh 2.2, ends of Windows": lambda: gmsh_2().replace("\n", "\r\n"),
    "gmsh 2.2, two groups each": lambda: gmsh_2(also=TWICE),
    "gmsh 2.2, binary": gmsh_2_binary,
    "gmsh 2.2, binary and quadratic": lambda: gmsh_2_binary(MIDDLES),
    "gmsh 4.1": lambda: Gmsh4(False).file(),
    "gmsh 4.1, binary": lambda: Gmsh4(True).file(),
    "gmsh 4.1, quadratic": lambda: Gmsh4(False, MIDDLES).file(),
    "gmsh 4.1, binary and quadratic": lambda: Gmsh4(True, MIDDLES).file(),
    "gmsh 4.1, two groups each": lambda: Gmsh4(False, also=TWICE).file(),
    "gmsh 4.1, binary, two groups each": lambda: Gmsh4(True, also=TWICE).file(),
    "gmsh 4.1, parameters of nodes": lambda: Gmsh4(False, parametric=True).file(),
    "gmsh 4.1, binary, parameters of nodes": lambda: Gmsh4(True, parametric=True).file(),
    "gmsh 4.1, the centre of an arc": lambda: Gmsh4(False, centre=True).file(),
    "gmsh 4.1, binary, the centre of an arc": lambda: Gmsh4(True, centre=True).file(),
    "gmsh 4.1, with results": lambda: Gmsh4(False, more=PERIODIC + POST).file(),
}

# TetGen


def tetgen(first=1, order=1, marks=True, face_marks=1, attributes=1, comment="# Generated by tetgen -pqA\n", more=""):
    points = NODES if order == 1 else MIDDLES
    edges = [(2, 3), (0, 3), (0, 1), (1, 2), (1, 3), (0, 2)]
    found = CELLS if order == 1 else [(t, quadratic(n, edges)) for t, n in CELLS]
    files = {".node": f"{len(points)}  3  1  {int(marks)}\n" + lines([i + first, *x, 0.5, *([1] if marks else [])] for i, x in enumerate(points)) + comment,
             ".ele": f"{len(found)}  {len(found[0][1])}  {attributes}\n" + lines([i + first, *(k + first for k in n), *[t] * attributes] for i, (t, n) in enumerate(found)) + comment}
    if face_marks:
        files[".face"] = f"{len(FACES)}  1\n" + lines([i + first, *(k + first for k in n), face_marks * t, *more.split()] for i, (t, n) in enumerate(FACES)) + comment
    return files


TETGEN = {
    "from 1": tetgen,
    "from 0 (-z)": lambda: tetgen(0),
    "quadratic (-o2)": lambda: tetgen(order=2),
    "quadratic from 0": lambda: tetgen(0, 2),
    "cells beside faces (-nn)": lambda: tetgen(more="1 -1"),
    "negative marks": lambda: tetgen(face_marks=-1),
    "no marks of nodes": lambda: tetgen(marks=False),
    "two attributes": lambda: tetgen(attributes=2),
    "comments before": lambda: {name: "# a mesh\n\n" + text for name, text in tetgen().items()},
    "ends of Windows": lambda: {name: text.replace("\n", "\r\n") for name, text in tetgen().items()},
    "without faces": lambda: tetgen(face_marks=0),
}

# Medit


def medit(version=2, dimension="Dimension\n3\n", points=NODES, before="", between="", end="End\n", gap=" ", reals=str):
    found = [("Tetrahedra", CELLS)] if points is NODES else [("TetrahedraP2", [(t, quadratic(n)) for t, n in CELLS])]
    text = f"MeshVersionFormatted {version}\n\n{dimension}\n" + before + f"Vertices\n{len(points)}\n" + lines(([*map(reals, x), 0] for x in points), gap) + between
    for name, members in [("Triangles", FACES), *found]:
        text += f"\n{name}\n{len(members)}\n" + lines(([*(k + 1 for k in n), t] for t, n in members), gap)
    return text + "\n" + end


MMG = ("\nCorners\n2\n1\n2\n\nRequiredVertices\n2\n1\n2\n\nEdges\n1\n1 2 3\n\nRidges\n1\n1\n\nRequiredEdges\n1\n1\n\nRequiredTriangles\n1\n1\n\nRequiredTetrahedra\n1\n1\n"
       "\nNormals\n1\n0. 0. 1.\n\nNormalAtVertices\n1\n1 1\n\nTangents\n1\n1. 0. 0.\n\nTangentAtVertices\n1\n2 1\n\nParallelTriangles\n1\n1\n")

MEDIT = {
    "gmsh": lambda: medit(gap="     ", dimension="Dimension\n3").replace("MeshVersionFormatted", " MeshVersionFormatted"),
    "mmg": lambda: medit(between=MMG),
    "TetGen (-g)": lambda: medit(1, "Dimension\n3\n\n# Set of mesh vertices\n"),
    "FreeFem": lambda: medit(2, "Dimension 3\n"),
    "CGAL": lambda: medit(1, "Dimension 3\n", reals=lambda x: f"{x:.17g}"),
    "quadratic": lambda: medit(points=MIDDLES),
    "comments": lambda: medit(before="# made by hand\n", between="# cells\n"),
    "exponents": lambda: medit(reals=lambda x: f"{x:.15e}"),
    "marks of quadrilaterals": lambda: medit(between="\nRequiredQuadrilaterals\n0\n\nTangentAtEdges\n0\n\nNormalAtQuadrilateralVertices\n0\n"),
    "ends of Windows": lambda: medit().replace("\n", "\r\n"),
    "one line": lambda: medit().replace("\n", " "),
}

FORMATS = {".vtk": LEGACY, ".vtu": XML, ".inp": INP, ".msh": MSH, ".node": TETGEN, ".mesh": MEDIT}


def write(directory, extension, name):
    """Write the file or files; the path of the one that is named as a mesh."""
    content = FORMATS[extension][name]()
    files = content if isinstance(content, dict) else {extension: content}
    for end, data in files.items():
        (directory / f"body{end}").write_bytes(data if isinstance(data, bytes) else data.encode())
    return directory / f"body{extension}"
