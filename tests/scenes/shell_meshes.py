# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces of shells for tests and studies: vertices and triangles, and their .obj."""

import math
import random


def grid(nx, ny, kind="right"):
    """Points of the unit square, by rows along x, and its triangles, counterclockwise seen from z. `kind`: right (all diagonals alike),
    alternating (diagonals in turn), random (alternating, with inner points moved by up to .25 of a cell) or equilateral (every other row
    moved by half a cell, its ends apart, and as many rows as make the triangles nearly equilateral where nx = ny)."""
    points = [(i / nx, j / ny) for j in range(ny + 1) for i in range(nx + 1)]

    def number(i, j):
        return j * (nx + 1) + i
    if kind == "random":
        choose = random.Random(4)
        points = [(x + choose.uniform(-.25, .25) / nx if 0. < x < 1. else x, y + choose.uniform(-.25, .25) / ny if 0. < y < 1. else y)
                  if 0. < x < 1. and 0. < y < 1. else (x, y) for x, y in points]
    triangles = []
    for j in range(ny):
        for i in range(nx):
            a, b, c, d = number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)
            if kind == "right" or (i + j) % 2 == 0:
                triangles += [(a, b, c), (a, c, d)]
            else:
                triangles += [(a, b, d), (b, c, d)]
    if kind == "equilateral":
        return equilateral(nx, round(ny / math.sqrt(3.)) * 2)
    return points, triangles


def equilateral(nx, ny):
    """The unit square in rows of isosceles triangles, with halves of them at both ends of every other row."""
    points, rows, triangles = [], [], []
    for j in range(ny + 1):
        xs = [i / nx for i in range(nx + 1)] if j % 2 == 0 else [0.] + [(i + .5) / nx for i in range(nx)] + [1.]
        rows.append(range(len(points), len(points) + len(xs)))
        points += [(x, j / ny) for x in xs]
    for low, high in zip(rows, rows[1:]):
        i = k = 0
        while i + 1 < len(low) or k + 1 < len(high):
            below = points[low[i + 1]][0] if i + 1 < len(low) else 2.
            above = points[high[k + 1]][0] if k + 1 < len(high) else 2.
            if below <= above:
                triangles.append((low[i], low[i + 1], high[k]))
                i += 1
            else:
                triangles.append((low[i], high[k + 1], high[k]))
                k += 1
    return points, triangles


def ball(halvings):
    """An octahedron whose edges are halved so often, with its vertices on the unit sphere; triangles seen from outside."""
    points = [(1., 0., 0.), (-1., 0., 0.), (0., 1., 0.), (0., -1., 0.), (0., 0., 1.), (0., 0., -1.)]
    triangles = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]
    for _ in range(halvings):
        numbers, finer = {}, []

        def middle(a, b):
            if (a, b) not in numbers:
                sums = [p + q for p, q in zip(points[a], points[b])]
                numbers[a, b] = numbers[b, a] = len(points)
                points.append(tuple(x / math.hypot(*sums) for x in sums))
            return numbers[a, b]
        for a, b, c in triangles:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            finer += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        triangles = finer
    return points, triangles


def obj_text(vertices, triangles):
    return "".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in vertices) + "".join(
        "f " + " ".join(str(v + 1) for v in face) + "\n" for face in triangles)


def strip(length, width, nx, ny, kind="right"):
    """A flat strip along x, with its triangles."""
    points, triangles = grid(nx, ny, kind)
    return [(length * x, width * (y - .5), 0.) for x, y in points], triangles


def rolled(length, width, nx, ny, angle, kind="right"):
    """The strip rolled up by an angle, as a prism whose facets are as wide as the strip's columns: no edge is longer than on the strip."""
    fold = angle / nx
    places = [(0., 0.)]
    for k in range(nx):
        turn = (k + .5) * fold
        places.append((places[-1][0] + length / nx * math.cos(turn), places[-1][1] + length / nx * math.sin(turn)))
    points, triangles = grid(nx, ny, kind)
    return [(*places[round(x * nx)], width * (y - .5)) for x, y in points], triangles


def rolled_vertices(length, width, nx, ny, angle, kind="right"):
    """Vertices of rolled() with the width along y, as strip() has it."""
    return [(x, w, z) for x, z, w in rolled(length, width, nx, ny, angle, kind)[0]]
