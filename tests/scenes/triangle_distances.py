# SPDX-License-Identifier: GPL-3.0-or-later
"""Distances of triangles from points, by formulas of their own: the least over the plane's foot, where it is inside, and the three edges."""

import numpy as np


def to_segments(points, a, b):
    """(n, m) distances of n points from m segments."""
    along = b - a
    s = np.einsum("nmc,mc->nm", points[:, None] - a, along) / np.maximum((along ** 2).sum(1), 1e-300)
    foot = a + np.clip(s, 0, 1)[..., None] * along
    return np.linalg.norm(points[:, None] - foot, axis=2)


def to_triangles(points, x):
    """(n, m) distances of points (n, 3) from triangles (m, 3, 3)."""
    a, b, c = x[:, 0], x[:, 1], x[:, 2]
    result = np.minimum(np.minimum(to_segments(points, a, b), to_segments(points, b, c)), to_segments(points, c, a))
    normal = np.cross(b - a, c - a)
    length = np.linalg.norm(normal, axis=1)
    height = np.einsum("nmc,mc->nm", points[:, None] - a, normal / length[:, None])
    inside = np.ones_like(result, dtype=bool)
    for p, q in ((a, b), (b, c), (c, a)):
        inside &= np.einsum("nmc,mc->nm", points[:, None] - p, np.cross(normal, q - p)) >= 0
    return np.where(inside, np.abs(height), result)


def samples_of_triangles(x, n):
    """Points of triangles (m, 3, 3): those whose barycentric coordinates are multiples of 1/n."""
    shares = np.array([(i, j, n - i - j) for i in range(n + 1) for j in range(n + 1 - i)]) / n
    return np.einsum("ks,msc->mkc", shares, x).reshape(-1, 3)


def samples_of_box(low, high, n):
    """Points of a box' faces, edges and corners among them."""
    grid = np.stack(np.meshgrid(*[np.linspace(0, 1, n + 1)] * 3, indexing="ij"), -1).reshape(-1, 3)
    return low + grid[((grid == 0) | (grid == 1)).any(1)] * (np.array(high) - low)
