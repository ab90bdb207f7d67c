# SPDX-License-Identifier: GPL-3.0-or-later
"""Which edges of a surface pass through its triangles, by exact arithmetic: doubles are fractions, and rounding is told from sign."""

from fractions import Fraction

import numpy as np


def volume_signs(a, b, c, d):
    """Signs of the volumes of many tetrahedra; by fractions where rounding might be all there is."""
    u, v, w = b - a, c - a, d - a
    volumes = np.einsum("ij,ij->i", np.cross(u, v), w)
    size = np.abs(np.stack([u, v, w])).max((0, 2)) ** 3
    signs = np.sign(volumes)
    for i in np.flatnonzero(np.abs(volumes) <= 1e-12 * size):
        (ux, uy, uz), (vx, vy, vz), (wx, wy, wz) = ([Fraction(float(p)) - Fraction(float(q)) for p, q in zip(corner[i], a[i])]
                                                    for corner in (b, c, d))
        exact = ux * (vy * wz - vz * wy) - uy * (vx * wz - vz * wx) + uz * (vx * wy - vy * wx)
        signs[i] = (exact > 0) - (exact < 0)
    return signs


def crossings(x, triangles):
    """(edge, triangle) without a common node that pass through or touch each other, but for what lies in one plane."""
    edges = np.array(sorted({tuple(sorted((t[k], t[(k + 1) % 3]))) for t in triangles.tolist() for k in range(3)}))
    ends, corners = x[edges], x[triangles]
    found = []
    low, high = corners.min(1), corners.max(1)
    for edge, place in zip(edges, ends):
        near = np.flatnonzero((low <= place.max(0)).all(1) & (high >= place.min(0)).all(1) & ~np.isin(triangles, edge).any(1))
        if not len(near):
            continue
        p, q = (np.tile(end, (len(near), 1)) for end in place)
        a, b, c = (corners[near, k] for k in range(3))
        sides = volume_signs(a, b, c, p) * volume_signs(a, b, c, q)
        turns = np.stack([volume_signs(p, a, b, q), volume_signs(p, b, c, q), volume_signs(p, c, a, q)])
        inside = (turns >= 0).all(0) | (turns <= 0).all(0)
        crosses = (sides <= 0) & inside & (np.abs(turns).sum(0) > 0)
        found += [(tuple(edge), tuple(triangles[t])) for t in near[crosses]]
    return found
