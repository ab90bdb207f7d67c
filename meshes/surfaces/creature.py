# SPDX-License-Identifier: GPL-3.0-or-later
"""A simple creature with body, neck, head, four limbs and a tail: its surface, and poses of it by bones.

Usage: python3 creature.py DIRECTORY [--cell H] [--poses strong|tutorial]
Writes DIRECTORY/rest.obj and, in the same order of vertices, ten strong poses, pose_1.obj to pose_10.obj, with mild ones
of .4 times their angles, mild_1.obj to mild_10.obj, or those of the tutorial, crouch.obj and reach.obj. The surface is
that of round cones around the bones, blended (an isosurface, found by surface nets on a grid of spacing H: .0365 gives
7,000 vertices). Units m, facing +x, up +z.
"""
import argparse
from pathlib import Path

import numpy as np

import skinning

X, Y, Z = (1, 0, 0), (0, 1, 0), (0, 0, 1)


def limb(skeleton, name, x, side, height):
    skeleton[f"{name} upper"] = ("body", (x, .2 * side, height), (x, .3 * side, .6 * height))
    skeleton[f"{name} lower"] = (f"{name} upper", (x, .3 * side, .6 * height), (x, .3 * side, .1))


def make_skeleton():
    skeleton = {"body": (None, (-.6, 0, 1), (0, 0, 1.03)), "chest": ("body", (0, 0, 1.03), (.6, 0, 1.05)),
                "neck": ("chest", (.6, 0, 1.05), (.95, 0, 1.45)), "head": ("neck", (.95, 0, 1.45), (1.3, 0, 1.4))}
    for name, x, parent in (("fore", .55, "chest"), ("hind", -.55, "body")):
        for side in (-1, 1):
            limb(skeleton, f"{name} {'right' if side < 0 else 'left'}", x, side, 1.)
    for name in ("fore right upper", "fore left upper"):
        skeleton[name] = ("chest", *skeleton[name][1:])
    points = [(-.65, 0, 1.02), (-.9, 0, 1.05), (-1.15, 0, 1.06), (-1.4, 0, 1.06), (-1.65, 0, 1.06)]
    for number, (head, tail) in enumerate(zip(points, points[1:]), 1):
        skeleton[f"tail {number}"] = ("body" if number == 1 else f"tail {number - 1}", head, tail)
    return skeleton


def radius(name):
    return {"body": .27, "chest": .25, "neck": .15, "head": .17, "tail": .085}.get(
        name.split()[0], .13 if name.endswith("upper") else .105)


def field(points, skeleton):
    """Negative inside: a smooth minimum of the distances from the bones' cones."""
    distance = skinning.distances_to_bones(points, skeleton) - [radius(name) for name in skeleton]
    blend = .03
    least = distance.min(axis=1)
    return least - blend * np.log(np.exp(-(distance - least[:, None]) / blend).sum(axis=1))


def grid_values(skeleton, low, shape, spacing):
    axes = [low[d] + spacing * np.arange(shape[d]) for d in range(3)]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), -1).reshape(-1, 3)
    return np.concatenate([field(part, skeleton) for part in np.array_split(points, 50)]).reshape(shape)


CORNERS = np.array([(i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1)])


def net(values):
    """Surface nets (Gibson 1998): a vertex in each cube that the surface cuts, a quadrilateral for each edge of the
    grid that it cuts. Vertices in units of the grid, triangles."""
    inside = values < 0
    n = [size - 1 for size in values.shape]
    parts = [values[i:i + n[0], j:j + n[1], k:k + n[2]] for i, j, k in CORNERS]
    n_inside = sum((part < 0).astype(int) for part in parts)
    cut = (n_inside > 0) & (n_inside < 8)
    number = np.full(cut.shape, -1)
    number[cut] = np.arange(cut.sum())
    cubes = np.argwhere(cut)
    total, count = np.zeros((len(cubes), 3)), np.zeros(len(cubes))
    for a in range(8):
        for b in range(a + 1, 8):
            if abs(CORNERS[a] - CORNERS[b]).sum() == 1:
                p, q = parts[a][cut], parts[b][cut]
                crossed = (p < 0) != (q < 0)
                share = np.where(crossed, p / np.where(crossed, p - q, 1), 0)
                total += crossed[:, None] * (CORNERS[a] + share[:, None] * (CORNERS[b] - CORNERS[a]))
                count += crossed
    vertices = cubes + total / count[:, None]
    triangles = []
    for axis in range(3):
        u, v = np.eye(3, dtype=int)[(axis + 1) % 3], np.eye(3, dtype=int)[(axis + 2) % 3]
        first = inside.take(range(inside.shape[axis] - 1), axis)
        second = inside.take(range(1, inside.shape[axis]), axis)
        for places, flip in ((np.argwhere(first & ~second), False), (np.argwhere(~first & second), True)):
            a, b, c, d = (number[tuple((places - shift).T)] for shift in (u + v, v, 0 * u, u))
            quads = np.stack([d, c, b, a] if flip else [a, b, c, d], 1)
            triangles += [quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]
    return vertices, np.concatenate(triangles)


def make_surface(skeleton, spacing):
    low = np.array([-1.9, -.55, -.15])
    shape = [int(length / spacing) + 2 for length in (3.5, 1.1, 1.95)]
    vertices, triangles = net(grid_values(skeleton, low, shape, spacing))
    points = low + spacing * vertices
    for _ in range(3):  # evenly spread, then back onto the surface
        points = 0.5 * points + 0.5 * skinning.smoothed(points, triangles, 1)
        for _ in range(3):
            step = 1e-4
            slope = np.stack([(field(points + step * e, skeleton) - field(points - step * e, skeleton)) / (2 * step)
                              for e in np.eye(3)], 1)
            points = points - (field(points, skeleton) / (slope ** 2).sum(axis=1))[:, None] * slope
    return points, triangles


def tail(degrees, axis=Z):
    """The tail rolled up by so much from root to tip."""
    return {f"tail {number}": (axis, degrees / 4) for number in range(1, 5)}


def leg(name, upper, lower, axis=Y):
    return {f"{name} upper": (axis, upper), f"{name} lower": (axis, lower)}


def tutorial_poses():
    crouch, reach = {"neck": (Y, 35), "head": (Y, -15), **tail(-50, Y)}, {}
    for side in ("right", "left"):
        crouch.update({**leg(f"fore {side}", 45, -90), **leg(f"hind {side}", -45, 90)})
    reach.update({"chest": (Y, -25), "neck": (Y, -25), "head": (Y, 20), **tail(90, Y)})
    for side in ("right", "left"):  # the forelegs stay upright
        reach.update(leg(f"fore {side}", 25, 0))
    return {"crouch": crouch, "reach": reach}


def strong_poses():
    return {f"pose_{number}": pose for number, pose in enumerate(list_of_strong_poses(), 1)}


def list_of_strong_poses():
    fr, fl, hr, hl = "fore right", "fore left", "hind right", "hind left"
    return [
        {**leg(fr, -90, 60), **tail(180)},
        {**leg(fr, -90, 0), **leg(fl, -100, 0), **leg(hr, 90, 0), **leg(hl, 100, 0), **tail(180, Y)},
        {**leg(fr, -60, 120), **leg(fl, 60, 90), **leg(hr, 60, -120), **leg(hl, -60, -90), **tail(-180)},
        {**leg(fr, 90, 0, X), **leg(fl, -90, 0, X), **leg(hr, 90, 0, X), **leg(hl, -90, 0, X), **tail(-180, Y)},
        {"neck": (Z, 60), "head": (Z, 60), "chest": (Z, 50), **tail(200)},
        {"neck": (Y, 100), "head": (Y, 30), "chest": (Y, 30), **leg(fr, -120, 120), **leg(fl, -30, 100)},
        {"chest": (X, 80), "neck": (X, 40), **tail(180), **leg(hr, 0, -110), **leg(hl, 100, -60)},
        {"chest": (Y, -70), "neck": (Y, -30), **leg(fr, -60, 90), **leg(fl, -90, 90), **tail(180, Y)},
        {**leg(fr, 120, -120), **leg(fl, -120, 90), **leg(hr, -100, -90), **leg(hl, 100, 30), **tail(-270)},
        {"chest": (Z, -80), "neck": (Z, -80), "head": (Z, -40), **leg(fl, -90, 130), **leg(hl, 90, -130),
         **tail(270)},
    ]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("directory", type=Path)
    parser.add_argument("--cell", type=float, default=.0365)
    parser.add_argument("--poses", choices=["strong", "tutorial"], default="strong")
    arguments = parser.parse_args()
    arguments.directory.mkdir(parents=True, exist_ok=True)
    skeleton = make_skeleton()
    points, triangles = make_surface(skeleton, arguments.cell)
    share = skinning.smoothed(skinning.weights(points, skeleton, .1), triangles, round(.3 / arguments.cell))
    skinning.write_obj(arguments.directory / "rest.obj", points, triangles)
    poses = strong_poses() if arguments.poses == "strong" else tutorial_poses()
    if arguments.poses == "strong":
        poses |= {name.replace("pose", "mild"): skinning.mild(pose) for name, pose in poses.items()}
    for name, pose in poses.items():
        skinning.write_obj(arguments.directory / f"{name}.obj", skinning.posed(points, share, skeleton, pose), triangles)
    print(f"{len(points)} vertices, {len(triangles)} triangles")


if __name__ == "__main__":
    main()
