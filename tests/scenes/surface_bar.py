# SPDX-License-Identifier: GPL-3.0-or-later
"""The bar 4 x 1 x 1 with a surface as artists make them, and readers of what a run writes of it, none of them the program's."""

import re
import struct
from collections import namedtuple

Surface = namedtuple("Surface", "vertices faces texture groups")  # texture: a point a vertex; groups: a name a face


def bar_surface(n_along=12, n_across=4, unit=1.):
    """Quads along the bar, an end of one polygon each, a vertex that no face uses; in five groups."""
    vertices, number, faces = [], {}, {"bottom": [], "top": [], "front": [], "back": [], "ends": []}

    def v(i, j, k):
        if (i, j, k) not in number:
            number[i, j, k] = len(vertices)
            vertices.append((unit * 4 * i / n_along, unit * (j / n_across - .5), unit * (k / n_across - .5)))
        return number[i, j, k]
    n = n_across
    for i in range(n_along):
        for j in range(n):
            faces["bottom"].append((v(i, j, 0), v(i, j + 1, 0), v(i + 1, j + 1, 0), v(i + 1, j, 0)))
            faces["top"].append((v(i, j, n), v(i + 1, j, n), v(i + 1, j + 1, n), v(i, j + 1, n)))
            faces["front"].append((v(i, 0, j), v(i + 1, 0, j), v(i + 1, 0, j + 1), v(i, 0, j + 1)))
            faces["back"].append((v(i, n, j), v(i, n, j + 1), v(i + 1, n, j + 1), v(i + 1, n, j)))
    ring = [(0, j) for j in range(n)] + [(j, n) for j in range(n)]
    ring += [(n, n - j) for j in range(n)] + [(n - j, 0) for j in range(n)]
    faces["ends"] = [tuple(v(0, j, k) for j, k in ring), tuple(v(n_along, j, k) for j, k in reversed(ring))]
    vertices.append((2. * unit, 0., .1 * unit))
    texture = [(x / unit / 4, .5 + y / unit) for x, y, _ in vertices]
    return Surface(vertices, [face for group in faces.values() for face in group], texture,
                   [name for name, group in faces.items() for _ in group])


def obj_text(surface, place=lambda x, y, z: (x, y, z)):
    lines = ["# by an artist", "mtllib bar.mtl", "o bar"]
    lines += ["v %.17g %.17g %.17g" % tuple(place(*vertex)) for vertex in surface.vertices]
    lines += ["vt %.17g %.17g" % point for point in surface.texture]
    last = None
    for face, group in zip(surface.faces, surface.groups):
        if group != last:
            lines += [f"g {group}", f"usemtl paint of {group}", "s 1"]
            last = group
        lines.append("f " + " ".join(f"{i + 1}/{i + 1}/1" for i in face))
    return "\n".join([*lines, "vn 0 0 1", ""])


def read_obj(file):
    """(vertices, all other statements)."""
    lines = [line for line in file.read_text().splitlines() if not line.startswith("#")]
    return ([tuple(map(float, line.split()[1:])) for line in lines if line.startswith("v ")],
            [line for line in lines if not line.startswith("v ")])


def read_ply(file):
    """(vertices, faces, labels), as the program writes it."""
    data = file.read_bytes()
    end = data.index(b"end_header\n") + 11
    head = data[:end].decode()
    n_vertices, n_faces = (int(n) for n in re.findall(r"element \w+ (\d+)", head))
    flat = struct.unpack_from(f"<{3 * n_vertices}d", data, end)
    at, faces, labels = end + 24 * n_vertices, [], []
    for _ in range(n_faces):
        n = data[at]
        faces.append(struct.unpack_from(f"<{n}i", data, at + 1))
        at += 1 + 4 * n
        if "label" in head:
            labels += struct.unpack_from("<i", data, at)
            at += 4
    assert at == len(data)
    return [flat[i:i + 3] for i in range(0, len(flat), 3)], faces, labels


def read_mdd(file):
    """(times, frames of flat coordinates)."""
    data = file.read_bytes()
    n_frames, n = struct.unpack_from(">ii", data)
    times = struct.unpack_from(f">{n_frames}f", data, 8)
    assert len(data) == 8 + 4 * n_frames + 12 * n * n_frames
    return times, [struct.unpack_from(f">{3 * n}f", data, 8 + 4 * n_frames + 12 * n * i) for i in range(n_frames)]


def read_pc2(file):
    """((version, first frame, frames a sample), frames of flat coordinates)."""
    data = file.read_bytes()
    name, version, n, start, rate, n_frames = struct.unpack_from("<12siiffi", data)
    assert name == b"POINTCACHE2\0" and len(data) == 32 + 12 * n * n_frames
    return (version, start, rate), [struct.unpack_from(f"<{3 * n}f", data, 32 + 12 * n * i) for i in range(n_frames)]


class UsdaReader:
    """Text of USD, as far as layers with a mesh have it, into dictionaries: {"(metadata)": ..., "def Mesh \"x\"": {...}}."""

    TOKEN = re.compile(r'"[^"]*"|<[^>]*>|@@@.*?@@@|[A-Za-z_][\w.:]*(?:\[\])?|-?\d[\d.]*(?:e[-+]?\d+)?|[][(){}=:,]')

    def __init__(self, text):
        head, text = text[:10], text[10:]
        assert head == "#usda 1.0\n" and not self.TOKEN.sub("", text).strip()
        self.tokens, self.at = self.TOKEN.findall(text), 0

    def take(self, expected=None):
        token = self.tokens[self.at]
        assert expected is None or token == expected, (token, expected)
        self.at += 1
        return token

    def peek(self):
        return self.tokens[self.at] if self.at < len(self.tokens) else None

    def value(self):
        token = self.take()
        if token in "([":
            items, end = [], ")" if token == "(" else "]"
            while self.peek() != end:
                items.append(self.value())
                if self.peek() == ",":
                    self.take()
            self.take(end)
            return tuple(items) if token == "(" else items
        if token == "{":
            samples = {}
            while self.peek() != "}":
                time = float(self.take())
                self.take(":")
                samples[time] = self.value()
                self.take(",")
            self.take("}")
            return samples
        if token[0] in '"<@':
            return token.strip('"<>@')
        return float(token)

    def statements(self, end):
        """Attributes, prims, and "(metadata)" of the layer and of prims."""
        found = {}
        while self.peek() not in (end, None):
            words = []
            while self.peek() not in ("=", "{", "(", end, None):
                words.append(self.take())
            if self.peek() == "=":
                self.take()
                found[" ".join(words)] = self.value()
            elif self.peek() == "(":
                self.take()
                found[" ".join([*words, "(metadata)"])] = self.statements(")")
                self.take(")")
                if self.peek() == "{" and words:
                    self.take()
                    found[" ".join(words)] = self.statements("}")
                    self.take("}")
            elif self.peek() == "{":
                self.take()
                found[" ".join(words)] = self.statements("}")
                self.take("}")
        return found


def read_usda(file):
    """(metadata of the layer, attributes of the mesh)."""
    layer = UsdaReader(file.read_text()).statements(None)
    return layer["(metadata)"], layer['def Xform "body"']['def Mesh "surface"']


def read_usda_prims(file):
    """What stands in the prim of the body."""
    return UsdaReader(file.read_text()).statements(None)['def Xform "body"']
