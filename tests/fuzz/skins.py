# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces in all formats: the boundary of the box of bases.py, a pose of it, and what is wrong with them."""

import re
import struct

import bases
import bodies
import mutations

CELLS = ["10", "12", "30", "30", "80"]


class Skin:
    """Vertices [[x, y, z]], faces [[vertex from 0]] and the name of each face's group."""

    def __init__(self, vertices, faces, groups):
        self.vertices, self.faces, self.groups = vertices, faces, groups


def box_skin(moved=bases.place):
    mesh = bases.box_mesh()
    place, sides = dict(mesh.nodes), {}
    for _, kind, _, _, corners in mesh.elements:
        if kind != 4:
            continue
        a, b, c, d = corners
        e = [[place[n][k] - place[a][k] for k in range(3)] for n in (b, c, d)]
        if sum(e[0][k] * (e[1][k - 2] * e[2][k - 1] - e[1][k - 1] * e[2][k - 2]) for k in range(3)) < 0:
            a, b = b, a
        for face in ((a, c, b), (a, b, d), (b, c, d), (a, d, c)):
            if sides.pop(tuple(sorted(face)), None) is None:
                sides[tuple(sorted(face))] = face
    used = sorted({n for face in sides for n in face})
    faces = [[used.index(n) for n in face] for face in sides.values()]
    ends = {0: "left", 2: "right"}
    groups = [ends.get(place[face[0]][0] if len({place[n][0] for n in face}) == 1 else None, "sides")
              for face in sides.values()]
    return Skin([list(moved(*place[n])) for n in used], faces, groups)


def obj(skin):
    lines = ["v " + " ".join(map(repr, v)) for v in skin.vertices]
    for group in dict.fromkeys(skin.groups):
        lines.append(f"g {group}")
        lines += ["f " + " ".join(str(i + 1) for i in face) for face, g in zip(skin.faces, skin.groups) if g == group]
    return ("\n".join(lines) + "\n").encode("utf-8", "surrogateescape")


def ply(skin, form="ascii"):
    head = ["ply", f"format {form} 1.0", f"element vertex {len(skin.vertices)}", *(f"property double {c}" for c in "xyz"),
            f"element face {len(skin.faces)}", "property list uchar int vertex_indices", "end_header"]
    text = ("\n".join(head) + "\n").encode()
    if form == "ascii":
        rows = [" ".join(map(repr, v)) for v in skin.vertices] + [f"{len(f)} " + " ".join(map(str, f)) for f in skin.faces]
        return text + ("\n".join(rows) + "\n").encode()
    order = "<" if "little" in form else ">"
    text += b"".join(struct.pack(order + "3d", *v) for v in skin.vertices)
    return text + b"".join(struct.pack(f"{order}B{len(f) % 256}i", len(f) % 256, *(i % 2**31 for i in f[:len(f) % 256]))
                           for f in skin.faces)


def cut(x):
    """A whole number as a file of four bytes may have it."""
    return (int(x) + 2**31) % 2**32 - 2**31


def mdd(samples, counts=None):
    frames, points = counts or (len(samples), len(samples[0]))
    return (struct.pack(">2i", cut(frames), cut(points)) + b"".join(struct.pack(">f", .02 * k) for k in range(len(samples)))
            + b"".join(single(x)[::-1] for sample in samples for v in sample for x in v))


def pc2(samples, counts=None):
    frames, points = counts or (len(samples), len(samples[0]))
    return (struct.pack("<12siiffi", b"POINTCACHE2\0", 1, cut(points), 0., 50., cut(frames))
            + b"".join(single(x) for sample in samples for v in sample for x in v))


def table(values, column="paint"):
    return (f"vertex,{column}\n" + "".join(f"{v + 1},{value!r}\n" for v, value in enumerate(values))).encode()


def painted_ply(skin, values):
    head, body = ply(skin).split(b"element face")
    head = head.replace(b"property double z\n", b"property double z\nproperty float paint\n")
    start, rows = body.split(b"end_header\n")
    rows = rows.split(b"\n")
    rows[:len(values)] = [row + b" " + repr(value).encode() for row, value in zip(rows, values)]
    return head + b"element face" + start + b"end_header\n" + b"\n".join(rows)


def odd_values(r, n):
    """Numbers for vertices, from 0 to 1 and otherwise, sometimes too many or too few."""
    values = [round(r.random(), 3) for _ in range(max(0, n + r.choice([0, 0, 0, 0, -1, 1, -n])))]
    for _ in range(r.choice([0, 0, 1, 3])):
        if values:
            values[r.randrange(len(values))] = r.choice([*mutations.REALS, r.uniform(-3, 3)])
    return values


def odd_cache(r, skin, make):
    """A point cache of the skin that moves a little, or is wrong."""
    samples = [[[x + .02 * k * (c == 2) for c, x in enumerate(v)] for v in skin.vertices] for k in range(r.choice([1, 2, 3, 3]))]
    action = r.random()
    if action < .25:
        samples[-1][r.randrange(len(samples[-1]))][r.randrange(3)] = r.choice(mutations.REALS)
    elif action < .4:
        return make(samples, (r.choice(mutations.INTEGERS), r.choice([len(samples[0]), r.choice(mutations.INTEGERS)])))
    elif action < .8:
        return mutations.damaged(r, make(samples))
    return make(samples)


def single(x):
    """As a number of four bytes has it."""
    return struct.pack("<f", max(-3e38, min(3e38, x)) if abs(x) < float("inf") else x)


def stl(skin, binary):
    faces = [face[:3] for face in skin.faces if len(face) >= 3]
    if binary:
        return bytes(80) + struct.pack("<I", len(faces)) + b"".join(
            bytes(12) + b"".join(single(x) for v in face for x in skin.vertices[v]) + bytes(2) for face in faces)
    lines = ["solid body"]
    for face in faces:
        lines += ["facet normal 0 0 0", "outer loop", *("vertex " + " ".join(map(repr, skin.vertices[v])) for v in face),
                  "endloop", "endfacet"]
    return ("\n".join([*lines, "endsolid body"]) + "\n").encode()


def form_of(r):
    """(ending, the function that makes the bytes of a skin)"""
    return r.choice([(".obj", obj), (".obj", obj), (".ply", ply), (".ply", lambda s: ply(s, "binary_little_endian")),
                     (".ply", lambda s: ply(s, "binary_big_endian")), (".stl", lambda s: stl(s, False)),
                     (".stl", lambda s: stl(s, True)), (".OBJ", obj)])


def odd_faces(r, skin):
    """Faces missing, doubled, turned, joined to others or to themselves, or shells more."""
    for _ in range(r.choice([1, 1, 2, 4, 10])):
        at = r.randrange(len(skin.faces)) if skin.faces else None
        action = r.randrange(8) if skin.faces else 7
        n = len(skin.vertices)
        if action == 0:
            del skin.faces[at], skin.groups[at]
        elif action == 1:
            skin.faces.append(list(r.choice(skin.faces)))
            skin.groups.append(r.choice(["left", "", "é", "7", 'a"b', "n" * 3000]))
        elif action == 2:
            skin.faces[at] = skin.faces[at][::-1]
        elif action == 3:
            skin.faces[at] = [r.randrange(n) for _ in range(r.choice([3, 3, 4, 7]))]
        elif action == 4:
            other = r.randrange(n)
            skin.faces = [[other if i == at % n else i for i in face] for face in skin.faces]
        elif action == 5:
            r.shuffle(skin.faces)
        elif action == 6:
            skin.vertices.append([r.uniform(-1, 2) for _ in range(3)])
        elif action == 7:
            shift, size = r.choice([0., .3, 5.]), r.choice([1., -1., .5, .1])
            skin.faces += [[i + n for i in face] for face in skin.faces]
            skin.groups += skin.groups
            skin.vertices += [[size * x + shift for x in v] for v in skin.vertices]
    return skin


def odd_places(r, skin):
    if r.random() < 0.3:
        one, axis = r.randrange(len(skin.vertices)), r.randrange(3)
        skin.vertices[one][axis] = r.choice([*mutations.REALS, r.uniform(-3, 3), 1e50, 1e99, 1e101])
        return skin
    skin.vertices = [list(x) for _, x in bodies.odd_geometry(r, list(enumerate(skin.vertices)))]
    return skin


def other_words(r, data):
    """Words of a text, or of the header, that are others."""
    words = re.split(rb"(\s+)", data)
    for _ in range(r.choice([1, 1, 2, 5])):
        at = r.randrange(min(len(words), r.choice([40, 10**9])))
        words[at] = r.choice([mutations.number(r), str(r.choice(mutations.INTEGERS)), r.choice(mutations.TEXTS)]).encode(
            "utf-8", "surrogateescape")
    return b"".join(words)


def spoilt(r, skin, make):
    """The bytes of a surface that is wrong in one way or several, or in none."""
    action = r.random()
    if action < 0.35:
        skin = odd_faces(r, skin)
    elif action < 0.65:
        skin = odd_places(r, skin)
    data = make(skin)
    if action > 0.95:
        return data
    if action > 0.8:
        return other_words(r, data)
    return mutations.damaged(r, data) if action > 0.65 else data
