# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces for tests, made of formulas or of the boundary of a mesh: (vertices, faces), counted from 0.

Usage: python3 tests/scenes/surfaces.py cat|horse|sphere|torus|creature|mouth FILE.obj
"""
import math
import sys
from collections import defaultdict
from pathlib import Path

MESHES = Path(__file__).resolve().parents[2] / "meshes"


def write_obj(file, vertices, faces, groups=None):
    """With groups, a name a face."""
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in vertices]
    last = None
    for i, face in enumerate(faces):
        if groups and groups[i] != last:
            last = groups[i]
            lines.append(f"g {last}")
        lines.append("f " + " ".join(str(v + 1) for v in face))
    Path(file).write_text("\n".join([*lines, ""]))
    return file


def cube(origin=(0., 0., 0.), size=1., inside_out=False):
    """Twelve triangles."""
    corners = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    squares = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    faces = [t for a, b, c, d in squares for t in ((a, b, c), (a, c, d))]
    vertices = [tuple(o + size * s for o, s in zip(origin, corner)) for corner in corners]
    return vertices, [f[::-1] for f in faces] if inside_out else faces


def moved(vertices, by):
    return [tuple(x + d for x, d in zip(v, by)) for v in vertices]


def joined(*parts):
    """Of several (vertices, faces) one."""
    vertices, faces = [], []
    for v, f in parts:
        faces += [tuple(i + len(vertices) for i in face) for face in f]
        vertices += v
    return vertices, faces


def grid_surface(n_u, n_v, place):
    """A surface that closes in both parameters: place(u, v) for u, v in [0, 1)."""
    vertices = [place(i / n_u, j / n_v) for i in range(n_u) for j in range(n_v)]

    def index(i, j):
        return i % n_u * n_v + j % n_v
    faces = [t for i in range(n_u) for j in range(n_v)
             for t in ((index(i, j), index(i + 1, j), index(i + 1, j + 1)),
                       (index(i, j), index(i + 1, j + 1), index(i, j + 1)))]
    return vertices, faces


def torus(n_u, n_v, major=1., minor=.4):
    def place(u, v):
        a, b = 2 * math.pi * u, 2 * math.pi * v
        r = major + minor * math.cos(b)
        return r * math.cos(a), r * math.sin(a), minor * math.sin(b)
    return grid_surface(n_u, n_v, place)


def sphere(times, radius=1.):
    """An octahedron whose triangles are divided in four `times` times."""
    vertices = [(1., 0., 0.), (-1., 0., 0.), (0., 1., 0.), (0., -1., 0.), (0., 0., 1.), (0., 0., -1.)]
    faces = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]
    for _ in range(times):
        vertices, faces, _ = divided(vertices, faces)
    lengths = [math.hypot(*v) for v in vertices]
    return [tuple(radius * x / r for x in v) for v, r in zip(vertices, lengths)], faces


def crumpled(n):
    """A bumpy ball of n x n quads whose relief does not vanish at the poles, where 22 sharp folds meet."""
    def place(i, j):
        theta, phi = math.pi * i / n, 2 * math.pi * j / n
        r = 1 + .05 * math.sin(9 * theta) * math.sin(11 * phi) + .002 * math.sin(80 * theta) * math.sin(90 * phi)
        return (r * math.sin(theta) * math.cos(phi), r * math.sin(theta) * math.sin(phi), r * math.cos(theta))
    vertices = [place(i, j) for i in range(1, n) for j in range(n)] + [(0, 0, 1), (0, 0, -1)]
    north, south, last = len(vertices) - 2, len(vertices) - 1, (n - 2) * n
    faces = []
    for j in range(n):
        k = (j + 1) % n
        for i in range(0, last, n):
            faces += [(i + j, i + n + j, i + k), (i + k, i + n + j, i + n + k)]
        faces += [(north, j, k), (south, last + k, last + j)]
    return vertices, faces


def divided(vertices, faces):
    """Each triangle in four; also {edge: its middle vertex}."""
    vertices, middles, small = list(vertices), {}, []

    def middle(a, b):
        key = (min(a, b), max(a, b))
        if key not in middles:
            middles[key] = len(vertices)
            vertices.append(tuple((x + y) / 2 for x, y in zip(vertices[a], vertices[b])))
        return middles[key]
    for a, b, c in faces:
        ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
        small += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return vertices, small, middles


def smoothed(vertices, faces):
    """Loop's subdivision (1987) of a closed surface: four times the faces, smoother."""
    neighbours, opposite = defaultdict(set), defaultdict(list)
    for face in faces:
        for k in range(3):
            a, b, c = face[k], face[(k + 1) % 3], face[(k + 2) % 3]
            neighbours[a] |= {b, c}
            opposite[min(a, b), max(a, b)].append(c)
    new, small, middles = divided(vertices, faces)
    for i, old in enumerate(vertices):
        n = len(neighbours[i])
        beta = (5 / 8 - (3 / 8 + math.cos(2 * math.pi / n) / 4) ** 2) / n
        new[i] = tuple((1 - n * beta) * old[d] + beta * sum(vertices[j][d] for j in neighbours[i]) for d in range(3))
    for (a, b), m in middles.items():
        c, d = opposite[a, b]
        new[m] = tuple(3 / 8 * (vertices[a][i] + vertices[b][i]) + (vertices[c][i] + vertices[d][i]) / 8
                       for i in range(3))
    return new, small


def boundary_of(msh):
    """The boundary triangles of an MSH 2.2 file in ASCII, outwards."""
    lines = Path(msh).read_text().split("\n")
    at = lines.index("$Nodes")
    nodes = {}
    for line in lines[at + 2:at + 2 + int(lines[at + 1])]:
        number, *place = line.split()
        nodes[int(number)] = tuple(map(float, place))
    at = lines.index("$Elements")
    cells = [list(map(int, line.split()))[-4:] for line in lines[at + 2:at + 2 + int(lines[at + 1])]
             if line.split()[1] == "4"]
    faces = {}
    for cell in cells:
        p = [nodes[n] for n in cell]
        e = [[p[k][d] - p[0][d] for d in range(3)] for k in (1, 2, 3)]
        volume = sum(e[0][d] * (e[1][(d + 1) % 3] * e[2][(d + 2) % 3] - e[1][(d + 2) % 3] * e[2][(d + 1) % 3])
                     for d in range(3))
        a, b, c, d = cell if volume > 0 else (cell[1], cell[0], cell[2], cell[3])
        for face in ((a, c, b), (a, b, d), (b, c, d), (a, d, c)):
            if faces.pop(tuple(sorted(face)), None) is None:
                faces[tuple(sorted(face))] = face
    used = sorted({n for face in faces for n in face})
    index = {n: i for i, n in enumerate(used)}
    return [nodes[n] for n in used], [tuple(index[n] for n in face) for face in faces.values()]


def level_set(value, low, high, n):
    """The triangles of value(x, y, z) = 0 by marching tetrahedra, outwards where value is positive; n cells along x."""
    h = (high[0] - low[0]) / n
    counts = [round((high[d] - low[d]) / h) for d in range(3)]
    values = {}

    def place(p):
        return tuple(low[d] + h * p[d] for d in range(3))

    def at(p):
        if p not in values:
            values[p] = value(*place(p)) or 1e-12
        return values[p]
    ways = [((1, 0, 0), (1, 1, 0)), ((0, 1, 0), (1, 1, 0)), ((0, 1, 0), (0, 1, 1)), ((0, 0, 1), (0, 1, 1)),
            ((0, 0, 1), (1, 0, 1)), ((1, 0, 0), (1, 0, 1))]
    odd = (1, 3, 5)
    vertices, index, faces = [], {}, []

    def crossing(p, q):
        key = (min(p, q), max(p, q))
        if key not in index:
            index[key] = len(vertices)
            p, q = key
            t = min(max(at(p) / (at(p) - at(q)), .1), .9)
            vertices.append(tuple(x + t * (y - x) for x, y in zip(place(p), place(q))))
        return index[key]
    for i in range(counts[0]):
        for j in range(counts[1]):
            for k in range(counts[2]):
                for w, (u, v) in enumerate(ways):
                    tet = [(i, j, k), (i + u[0], j + u[1], k + u[2]), (i + v[0], j + v[1], k + v[2]),
                           (i + 1, j + 1, k + 1)]
                    if w in odd:
                        tet[1], tet[2] = tet[2], tet[1]
                    inside = [m for m in range(4) if at(tet[m]) < 0]
                    outside = [m for m in range(4) if m not in inside]
                    if not inside or not outside:
                        continue
                    even = sum(1 for x in range(4) for y in range(x) if (inside + outside)[y] > (inside + outside)[x]) % 2 == 0
                    c = [[crossing(tet[a], tet[b]) for b in outside] for a in inside]
                    if len(inside) == 1:
                        new = [(c[0][0], c[0][1], c[0][2])]
                    elif len(inside) == 3:
                        new = [(c[0][0], c[2][0], c[1][0])]
                    else:
                        new = [(c[0][0], c[0][1], c[1][1]), (c[0][0], c[1][1], c[1][0])]
                    if len(inside) == 3:
                        new = [f[::-1] for f in new]
                    faces += new if even else [f[::-1] for f in new]
    return vertices, faces


def creature(n=90):
    """A body with four legs, a neck, a head and a tail: capsules joined smoothly."""
    bones = [((-.5, 0, .6), (.5, 0, .6), .2), ((-.45, .14, .6), (-.5, .16, 0), .08),
             ((-.45, -.14, .6), (-.5, -.16, 0), .08), ((.45, .14, .6), (.5, .16, 0), .08),
             ((.45, -.14, .6), (.5, -.16, 0), .08), ((.55, 0, .65), (.75, 0, .95), .1),
             ((.72, 0, .95), (.9, 0, .9), .12), ((-.6, 0, .65), (-1.1, 0, .85), .05)]

    def value(x, y, z):
        total = 0.
        for a, b, r in bones:
            ab = [q - p for p, q in zip(a, b)]
            ap = (x - a[0], y - a[1], z - a[2])
            t = min(max(sum(p * q for p, q in zip(ap, ab)) / sum(q * q for q in ab), 0.), 1.)
            total += math.exp(-24 * (math.hypot(*(p - t * q for p, q in zip(ap, ab))) - r))
        return -math.log(total) / 24 if total > 0 else 1.
    return level_set(value, (-1.3, -.45, -.2), (1.15, .45, 1.2), n)


def mouth(gap, h):
    """A block 1 x .4 x .5, a little bent, with a wedge `gap` wide and .6 deep cut into it: two lips. Two of its faces
    are polygons."""
    corners = [(0, 0), (1, 0), (1, .25 - gap / 2), (.4, .25), (1, .25 + gap / 2), (1, .5), (0, .5)]
    profile = []
    for (x, z), (x_next, z_next) in zip(corners, corners[1:] + corners[:1]):
        n = max(1, round(math.hypot(x_next - x, z_next - z) / h))
        profile += [(x + i / n * (x_next - x), z + i / n * (z_next - z)) for i in range(n)]
    n, m = len(profile), round(.4 / h)
    vertices = [(x, .4 * j / m, z + .02 * math.sin(3 * x) * math.cos(2 * j / m)) for j in range(m + 1) for x, z in profile]
    faces = [tuple(range(n)), tuple(reversed(range(m * n, (m + 1) * n)))]
    for j in range(m):
        for i in range(n):
            a, b = j * n + i, j * n + (i + 1) % n
            faces.append((a, a + n, b + n, b))
    return vertices, faces


def main():
    kind, file = sys.argv[1:]
    surface = {"sphere": lambda: sphere(5), "torus": lambda: torus(140, 50), "creature": creature, "mouth": lambda: mouth(.003, .03),
               "cat": lambda: smoothed(*boundary_of(MESHES / "cat.msh")),
               "horse": lambda: smoothed(*boundary_of(MESHES / "horse.msh"))}[kind]()
    write_obj(file, *surface)
    print(len(surface[0]), "vertices", len(surface[1]), "faces")


if __name__ == "__main__":
    main()
