# SPDX-License-Identifier: GPL-3.0-or-later
"""Good inputs of every kind, so small that a run takes a tenth of a second: what the mutations start from."""

import struct
from itertools import permutations, product

# A bar of 2 bricks; End and Step make four steps.
BOX = {"Mesh/Generator": "box", "Mesh/Box size": "2, 1, 1", "Mesh/Box cells": "2, 1, 1"}
HELD = {"Handles/Names": "left", "Handles/left/Select": "boundary 1"}
LATER = {"Time/Step": "0.01", "Time/End": "0.04"}
FILE = {"Mesh/File": "mesh.msh"}
BENT = "x; y; z+0.2*x^2"

SCENES = [
    {**BOX, **HELD, "Scene": "static", "Time/Increments": "2", "Loads/Gravity": "0, 0, -1"},
    {**BOX, **HELD, **LATER, "Scene": "dynamic", "Examples/Pose functions": "1.3*x; y; z | " + BENT,
     "Handles/left/Motion": "0; 0; 0.1*sin(6*t)", "Loads/Gravity": "0, 0, -9.81", "Time/Stiffness damping": "0.01"},
    {**BOX, **LATER, "Scene": "dynamic", "Time/Scheme": "bdf2", "Initial/Velocity": "0; 0; x", "Time/Mass damping": "1"},
    {**BOX, "Scene": "interpolation", "Examples/Pose functions": BENT, "Examples/Prescribed weights": "1-t; t",
     "Time/Increments": "2"},
    {**BOX, **HELD, **LATER, "Scene": "dynamic", "Solver/Method": "one pass", "Model/Gradient": "frozen",
     "Examples/Pose functions": BENT, "Examples/Weights": "free", "Material/Mass matrix": "lumped"},
    {**BOX, **HELD, "Scene": "static", "Time/Increments": "2", "Loads/Names": "tip", "Loads/tip/Select": "boundary 2",
     "Loads/tip/Force": "0; 0; -100*t", "Solver/Method": "newton", "Examples/Pose functions": BENT,
     "Examples/Energy": "blended", "Examples/Importance": "0.5"},
    {**FILE, "Scene": "static", "Time/Increments": "2", "Handles/Names": "left, right end",
     "Handles/left/Select": "nodes held.txt", "Handles/right end/Select": "boundary 2",
     "Handles/right end/Follow pose": "pose.msh", "Handles/right end/Progress": "t", "Examples/Poses": "pose.msh"},
    {**FILE, **HELD, **LATER, "Scene": "dynamic", "Examples/Poses": "pose.msh, pose2.msh", "Initial/Pose": "pose.msh",
     "Examples/Weights per region": "true", "Examples/Region blend length": "0.5",
     "Material/region 2/Young's modulus": "1e5", "Loads/Names": "down", "Loads/down/Select": "region 2",
     "Loads/down/Force": "0; 0; -t"},
    {**BOX, **HELD, **LATER, "Scene": "dynamic", "Model/Strain": "green", "Solver/Linear solver": "umfpack",
     "Solver/Method": "fixed point", "Examples/Weights": "free", "Handles/left/Components": "x, z",
     "Handles/left/Select": "box -1 -1 -1 0.1 1 1"},
    {**BOX, **HELD, "Scene": "static", "Time/Increments": "1", "Model/Strain": "linear", "Mesh/Scale": "0.001",
     "Handles/left/Select": "sphere 0 0 0 0.0008", "Loads/Gravity": "0, 0, -9.81"},
]

STUDY = {"Scene": "scene.prm", "Base": "Solver/Tolerance=1e-6", "Reference": "Time/Increments=2",
         "Vary": "Time/Increments: 1 2", "Repeats": "1", "Columns": "energy_elastic", "Probe": "2, 0, 0", "Timeout": "10"}

LIST = "1\n4\n7\n10\n"


def place(x, y, z):
    return x, y, z


def bent(x, y, z):
    return x, y, z + 0.2 * x * x


def stretched(x, y, z):
    return 1.2 * x, y, z


class Mesh:
    """Nodes [(number, [x, y, z])], elements [(number, type, physical, elementary, [node numbers])] and names."""

    def __init__(self, nodes, elements, names):
        self.nodes, self.elements, self.names = nodes, elements, names


def box_mesh(moved=place):
    """2 x 1 x 1 bricks of six tetrahedra; node numbers have gaps; two regions, ends 1 and 2."""
    counts = (2, 1, 1)
    points = list(product(range(3), range(2), range(2)))
    number = {point: 1 + 3 * i for i, point in enumerate(points)}
    nodes = [(number[p], list(moved(*(c - (0, .5, .5)[i] for i, c in enumerate(p))))) for p in points]
    elements = []
    for end, tag in ((0, 1), (2, 2)):
        corners = [number[end, y, z] for y, z in product(range(2), range(2))]
        for triangle in ((0, 1, 3), (0, 3, 2)):
            elements.append((len(elements) + 1, 2, tag, tag, [corners[i] for i in triangle]))
    for brick in range(counts[0]):
        for axes in permutations(range(3)):
            at, corners = [brick, 0, 0], [number[brick, 0, 0]]
            for axis in axes:
                at[axis] += 1
                corners.append(number[tuple(at)])
            if axes not in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
                corners[2], corners[3] = corners[3], corners[2]
            elements.append((len(elements) + 1, 4, brick + 1, brick + 1, corners))
    return Mesh(nodes, elements, [(2, 1, "left"), (2, 2, "right"), (3, 1, "first"), (3, 2, "second")])


# A .msh file is a list of tokens (kind, value): "i" int, "s" size_t, "d" double, "t" text, "n" the end of a line of
# text, "l" the end of a line of numbers, which binary files do not have.

def words(text):
    return [("t", word) for word in text.split()] + [("n", None)]


def section(name, body):
    return [*words("$" + name), *body, ("l", None), *words("$End" + name)]


def head(mesh, version, binary):
    tokens = [*words(f"{version} {int(binary)} 8")]
    if binary:
        tokens += [("i", 1), ("n", None)]
    names = words(str(len(mesh.names)))
    for dimension, tag, name in mesh.names:
        names += words(f'{dimension} {tag} "{name}"')
    return [*words("$MeshFormat"), *tokens, *words("$EndMeshFormat"), *words("$PhysicalNames"), *names,
            *words("$EndPhysicalNames")]


def version_2(mesh, binary):
    nodes, elements = words(str(len(mesh.nodes))), words(str(len(mesh.elements)))
    for number, position in mesh.nodes:
        nodes += [("i", number), *(("d", x) for x in position), ("l", None)]
    for number, kind, physical, elementary, corners in mesh.elements:
        first = [("i", kind), ("i", 1), ("i", 2), ("i", number)] if binary else [("i", number), ("i", kind), ("i", 2)]
        elements += [*first, ("i", physical), ("i", elementary), *(("i", n) for n in corners), ("l", None)]
    return head(mesh, "2.2", binary) + section("Nodes", nodes) + section("Elements", elements)


def version_4(mesh, binary):
    entities = [("s", 0), ("s", 0), ("s", 2), ("s", 2), ("l", None)]
    for dimension, tags in ((2, (1, 2)), (3, (1, 2))):
        for tag in tags:
            entities += [("i", tag), *(("d", float(x)) for x in (0, 0, 0, 2, 1, 1)), ("s", 1), ("i", tag),
                         ("s", 0), ("l", None)]
    half = len(mesh.nodes) // 2
    nodes = [("s", 2), ("s", len(mesh.nodes)), ("s", 1), ("s", 100), ("l", None)]
    for dimension, block in ((2, mesh.nodes[:half]), (3, mesh.nodes[half:])):
        nodes += [("i", dimension), ("i", 1), ("i", int(dimension == 2)), ("s", len(block)), ("l", None)]
        for number, _ in block:
            nodes += [("s", number), ("l", None)]
        for _, position in block:
            parameters = [("d", 0.25), ("d", 0.75)] if dimension == 2 else []
            nodes += [*(("d", x) for x in position), *parameters, ("l", None)]
    blocks = []
    for element in mesh.elements:
        key = element[1], element[3]
        if not blocks or blocks[-1][0] != key:
            blocks.append((key, []))
        blocks[-1][1].append(element)
    elements = [("s", len(blocks)), ("s", len(mesh.elements)), ("s", 1), ("s", 100), ("l", None)]
    for (kind, entity), block in blocks:
        elements += [("i", 3 if kind == 4 else 2), ("i", entity), ("i", kind), ("s", len(block)), ("l", None)]
        for number, *_, corners in block:
            elements += [("s", number), *(("s", n) for n in corners), ("l", None)]
    return (head(mesh, "4.1", binary) + section("Entities", entities) + section("Nodes", nodes)
            + section("Elements", elements))


def msh_bytes(tokens, binary):
    """The file; numbers beyond their type are cut to it in a binary one."""
    out = b""
    for kind, value in tokens:
        if kind == "n" or (kind == "l" and not binary):
            out += b"\n"
        elif kind == "t" or (kind in "isd" and not binary):
            out += (value if isinstance(value, bytes) else str(value).encode("utf-8", "surrogateescape")) + b" "
        elif kind == "i":
            out += struct.pack("<I", int(value) % 2**32)
        elif kind == "s":
            out += struct.pack("<Q", int(value) % 2**64)
        elif kind == "d":
            out += struct.pack("<d", float(value))
        # in binary, numbers begin right behind the line break: no blank before it
        if kind == "n" and out.endswith(b" \n"):
            out = out[:-2] + b"\n"
    return out


def msh_text(mesh):
    return msh_bytes(version_2(mesh, False), False)
