# SPDX-License-Identifier: GPL-3.0-or-later
"""Ten closed skins whose lips, eyelids, arms, legs and paws cross at rest by about 1 % of the head, and three poses of each that part them.

Usage: python3 meshes/surfaces/crossing.py DIRECTORY [NAME]...
Writes DIRECTORY/NAME/rest.obj and pose_1.obj to pose_3.obj. A skin is the boundary of small cubes, smoothed; between two sheets
one layer of cubes is left out, so that in the bent skin at rest they meet.
"""
import sys
from pathlib import Path

import numpy as np
from skinning import rotation

X, Y, Z = np.eye(3)


class Flap:
    """A slit, one cube wide, at `n` = c; from the hinge at `a` = h on towards `way`; `half` is half its width along `t`
    around `middle`, or None for all. The side `side` of it turns about the hinge by `angle` degrees in pose 1."""

    def __init__(self, n, c, a, h, way, side, length, angle, t=None, middle=0., half=None, reach=100.):
        self.n, self.c, self.a, self.h, self.way, self.side = n, c, a, h, way, side
        self.length, self.angle, self.reach = length, angle, reach
        self.t, self.middle, self.half = t if t is not None else 3 - n - a, middle, half

    def cuts(self, centre):
        inside = (np.abs(centre[..., self.n] - self.c) < .5) & ((centre[..., self.a] - self.h) * self.way > 0)
        return inside if self.half is None else inside & (np.abs(centre[..., self.t] - self.middle) < self.half)

    def share(self, x):
        u = np.clip((x[:, self.a] - self.h) * self.way / self.length, 0, 1)
        share = u * u * (3 - 2 * u)
        if self.half is not None:
            share = share * np.clip(1 - ((x[:, self.t] - self.middle) / self.half) ** 2, 0, 1)
        return share

    def close(self, base, x, overlap):
        """Both sheets towards each other, until they have crossed by `overlap`."""
        away = base[:, self.n] - self.c
        way = self.share(base) * (1 + overlap) / 2 * np.exp(-np.clip(np.abs(away) - .5, 0, None) / 3)
        x[:, self.n] -= np.sign(away) * way

    def open(self, base, x, factor):
        """Turn one side about the hinge."""
        away = (base[:, self.n] - self.c) * self.side
        share = self.share(base) * (away > 0) * np.exp(-(np.clip(away, 0, None) / self.reach) ** 2)
        hinge = np.zeros(3)
        hinge[self.n], hinge[self.a] = self.c, self.h
        direction = np.cross(np.eye(3)[self.a] * self.way, np.eye(3)[self.n] * self.side)
        for i in np.nonzero(share)[0]:
            x[i] = hinge + rotation(direction, factor * self.angle * share[i]) @ (x[i] - hinge)


def ellipsoid(a, b, c, power=2.5):
    return lambda x: (np.abs(x) / np.array([a, b, c])) ** power @ np.ones(3) < 1


def box(a, b, c):
    return lambda x: (np.abs(x) < np.array([a, b, c])).all(axis=-1)


def mouth(h, length, half, angle=25., c=-.5, reach=100.):
    return Flap(2, c, 0, h, 1, -1, length, angle, half=half, reach=reach)


def eye(y, c, x, half=2.6):
    return Flap(2, c, 0, x, 1, 1, 3., 30., middle=y, half=half, reach=3.)


def arm(side, c, h, angle=30.):
    return Flap(1, side * c, 2, h, -1, side, 9., angle)


SKINS = {
    "muzzle": (ellipsoid(12, 8, 8), [mouth(2, 8, 5.6, 14.)], 16),
    "narrow_mouth": (ellipsoid(12, 9, 9), [mouth(2, 7, 3.6, 12.)], 18),
    "deep_mouth": (ellipsoid(15, 7, 7), [mouth(-3, 10, 5.6, 20.)], 14),
    "eyes": (ellipsoid(10, 10, 10), [eye(4.5, 3.5, 6), eye(-4.5, 3.5, 6)], 20),
    "face": (ellipsoid(11, 10, 10), [mouth(2, 7, 3.6, 12., -3.5), eye(4.5, 4.5, 5.5), eye(-4.5, 4.5, 5.5)], 20),
    "beak": (ellipsoid(13, 5, 5), [mouth(2, 8, None, 18.)], 12),
    "armpits": (box(4, 9, 11), [arm(1, 5.5, 5), arm(-1, 5.5, 5)], 20),
    "legs": (box(4, 8, 12), [Flap(1, .5, 2, 0, -1, 1, 8., 25.)], 20),
    "paw": (ellipsoid(10, 8, 12), [Flap(0, 5.5, 2, 3, -1, 1, 9., 30.)], 20),
    "creature": (lambda x: box(5, 8, 7)(x + 6 * Z) | ellipsoid(8, 6, 6)(x - 6 * Z),
                 [mouth(1, 6, 4.6, 14., 5.5, 4.), arm(1, 4.5, -4), arm(-1, 4.5, -4)], 14),
}


def boundary_of_cubes(inside, flaps, n=17):
    """Vertices and squares; the cubes have the width 1, and centres in the middles between whole numbers."""
    axis = np.arange(-n, n) + .5
    centre = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1)
    solid = inside(centre)
    for flap in flaps:
        solid &= ~flap.cuts(centre)
    faces, number = [], {}
    for i, j, k in np.argwhere(solid):
        for d in range(3):
            for s in (0, 1):
                other = np.array([i, j, k])
                other[d] += 2 * s - 1
                if solid[tuple(other)]:
                    continue
                corner = np.array([i, j, k])
                corner[d] += s
                e, f = np.eye(3, dtype=int)[(d + 1) % 3], np.eye(3, dtype=int)[(d + 2) % 3]
                square = [corner, corner + e, corner + e + f, corner + f]
                faces.append([number.setdefault(tuple(v), len(number)) for v in (square if s else square[::-1])])
    return np.array(list(number), float) - n, np.array(faces)


def smoothed(x, faces, times):
    """By Taubin: without shrinking."""
    edges = np.unique(np.sort(np.concatenate([faces[:, [i, (i + 1) % 4]] for i in range(4)]), axis=1), axis=0)
    count = np.bincount(edges.ravel(), minlength=len(x))[:, None]
    for k in range(2 * times):
        total = np.zeros_like(x)
        np.add.at(total, edges[:, 0], x[edges[:, 1]])
        np.add.at(total, edges[:, 1], x[edges[:, 0]])
        x = x + (.5 if k % 2 == 0 else -.52) * (total / count - x)
    return x


def divided(x, faces):
    """Each square in four, smoothed a little."""
    sides = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=-1), axis=-1).reshape(-1, 2)
    edges, of_side = np.unique(sides, axis=0, return_inverse=True)
    of_side = of_side.reshape(faces.shape) + len(x)
    middle = np.arange(len(faces)) + len(x) + len(edges)
    fine = np.concatenate([np.stack([faces[:, i], of_side[:, i], middle, of_side[:, i - 1]], axis=1) for i in range(4)])
    return smoothed(np.concatenate([x, x[edges].mean(axis=1), x[faces].mean(axis=1)]), fine, 1), fine


def make(name):
    """(triangles, rest, [poses])."""
    inside, flaps, head = SKINS[name]
    base, squares = boundary_of_cubes(inside, flaps)
    base = smoothed(base, squares, 3)
    base, squares = divided(base, squares)
    triangles = np.concatenate([squares[:, [0, 1, 2]], squares[:, [0, 2, 3]]])
    rest = base.copy()
    for flap in flaps:
        flap.close(base, rest, .01 * head)
    poses = []
    for factor in (1., .6, 1.4):
        x = rest.copy()
        for flap in flaps:
            flap.open(base, x, factor)
        x = x @ rotation([1, 2, 3], 20 * factor).T + 5 * factor * X
        if factor > 1.2:  # the body bends, too
            bend = np.radians(2.) * x[:, 1]
            x = np.stack([x[:, 0] + .15 * bend ** 2 * 10, x[:, 1], x[:, 2] + 2 * bend], axis=1)
        poses.append(x)
    return triangles, rest / 10, [x / 10 for x in poses]


def write(file, x, triangles):
    file.write_text("".join(f"v {a!r} {b!r} {c!r}\n" for a, b, c in x.tolist())
                    + "".join(f"f {a} {b} {c}\n" for a, b, c in (triangles + 1).tolist()))


def main():
    for name in sys.argv[2:] or SKINS:
        directory = Path(sys.argv[1]) / name
        directory.mkdir(parents=True, exist_ok=True)
        triangles, rest, poses = make(name)
        write(directory / "rest.obj", rest, triangles)
        for k, pose in enumerate(poses):
            write(directory / f"pose_{k + 1}.obj", pose, triangles)


if __name__ == "__main__":
    main()
