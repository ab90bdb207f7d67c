# SPDX-License-Identifier: GPL-3.0-or-later
"""Ten strong poses each of surfaces like those of meshes/cat.geo and meshes/horse.geo, by bones.

Usage: python3 animals.py cat|horse SURFACE.msh DIRECTORY
SURFACE.msh (MSH 2.2 ASCII) holds the triangles of the rest surface at any resolution: those of the boundary that
gmsh -2 meshes/cat.geo -setnumber hs .019 -o SURFACE.msh makes (7,000 vertices; horse: .024). Writes
DIRECTORY/rest.obj, pose_1.obj to pose_10.obj, and mild_1.obj to mild_10.obj with .4 times the angles.
"""
import sys
from pathlib import Path

import numpy as np

import skinning
from creature import X, Y, Z, leg, tail


def chain(skeleton, name, parent, points):
    for number, (head, end) in enumerate(zip(points, points[1:]), 1):
        skeleton[f"{name} {number}"] = (parent if number == 1 else f"{name} {number - 1}", head, end)


def leg_bones(skeleton, name, parent, hip, knee, foot):
    skeleton[f"{name} upper"] = (parent, hip, knee)
    skeleton[f"{name} lower"] = (f"{name} upper", knee, foot)


def cat():
    skeleton = {"body": (None, (-.45, 0, .49), (-.05, 0, .51)), "chest": ("body", (-.05, 0, .51), (.4, 0, .48)),
                "neck": ("chest", (.36, 0, .52), (.52, 0, .68)), "head": ("neck", (.52, 0, .68), (.68, 0, .72))}
    for side, sign in (("right", -1), ("left", 1)):
        leg_bones(skeleton, f"fore {side}", "chest", (.34, .075 * sign, .42), (.33, .085 * sign, .23),
                  (.36, .085 * sign, .03))
        leg_bones(skeleton, f"hind {side}", "body", (-.36, .08 * sign, .42), (-.39, .09 * sign, .22),
                  (-.41, .09 * sign, .03))
    chain(skeleton, "tail", "body", [(-.5, 0, .52), (-.68, 0, .58), (-.74, 0, .75), (-.73, 0, .9), (-.6, 0, 1.045)])
    return skeleton


def horse():
    skeleton = {"body": (None, (-.45, 0, .79), (-.05, 0, .77)), "chest": ("body", (-.05, 0, .77), (.42, 0, .78)),
                "neck": ("chest", (.4, 0, .9), (.66, 0, 1.26)), "head": ("neck", (.68, 0, 1.32), (.95, 0, 1.05))}
    for side, sign in (("right", -1), ("left", 1)):
        leg_bones(skeleton, f"fore {side}", "chest", (.35, .09 * sign, .66), (.355, .105 * sign, .34),
                  (.37, .105 * sign, .02))
        leg_bones(skeleton, f"hind {side}", "body", (-.34, .09 * sign, .66), (-.42, .105 * sign, .4),
                  (-.41, .105 * sign, .02))
    chain(skeleton, "tail", "body", [(-.5, 0, .86), (-.61, 0, .77), (-.63, 0, .65), (-.636, 0, .52), (-.636, 0, .4)])
    return skeleton


def make_poses():
    fr, fl, hr, hl = "fore right", "fore left", "hind right", "hind left"
    return [
        {**leg(fr, -90, 60), **tail(180, X)},
        {**leg(fr, -90, 0), **leg(fl, -100, 0), **leg(hr, 90, 0), **leg(hl, 100, 0), **tail(180, Y)},
        {**leg(fr, -60, 120), **leg(fl, 60, 60), **leg(hr, 60, -90), **leg(hl, -60, -60), **tail(-180, X)},
        {**leg(fr, 80, 0, X), **leg(fl, -80, 0, X), **leg(hr, 80, 0, X), **leg(hl, -80, 0, X), **tail(-180, Y)},
        {"neck": (Z, 60), "head": (Z, 40), "chest": (Z, 50), **tail(180, X)},
        {"neck": (Y, 70), "head": (Y, 30), "chest": (Y, 30), **leg(fr, -100, 100), **leg(fl, -30, 90)},
        {"chest": (X, 70), "neck": (X, 30), **tail(180, X), **leg(hr, 0, -90), **leg(hl, 90, -60)},
        {"chest": (Y, -60), "neck": (Y, -30), **leg(fr, -60, 90), **leg(fl, -90, 90), **tail(180, Y)},
        {**leg(fr, 90, -90), **leg(fl, -100, 90), **leg(hr, -90, -90), **leg(hl, 90, 30), **tail(-200, X)},
        {"chest": (Z, -70), "neck": (Z, -60), "head": (Z, -40), **leg(fl, -90, 110), **leg(hl, 90, -110),
         **tail(200, X)},
    ]


def read_triangles(path):
    """Vertices of the triangles of an MSH 2.2 file, in its order, and the triangles."""
    lines = iter(Path(path).read_text().split("\n"))
    while next(lines) != "$Nodes":
        pass
    places = {}
    for _ in range(int(next(lines))):
        number, *place = next(lines).split()
        places[int(number)] = [float(x) for x in place]
    while next(lines) != "$Elements":
        pass
    triangles = []
    for _ in range(int(next(lines))):
        words = [int(word) for word in next(lines).split()]
        if words[1] == 2:
            triangles.append(words[-3:])
    used = sorted({node for triangle in triangles for node in triangle})
    number = {node: k for k, node in enumerate(used)}
    return (np.array([places[node] for node in used]),
            np.array([[number[node] for node in triangle] for triangle in triangles]))


def main():
    kind, surface, directory = sys.argv[1], sys.argv[2], Path(sys.argv[3])
    skeleton = {"cat": cat, "horse": horse}[kind]()
    points, triangles = read_triangles(surface)
    directory.mkdir(parents=True, exist_ok=True)
    share = skinning.smoothed(skinning.weights(points, skeleton, .04), triangles, 10)
    skinning.write_obj(directory / "rest.obj", points, triangles)
    for number, pose in enumerate(make_poses(), 1):
        for name, turns in (("pose", pose), ("mild", skinning.mild(pose))):
            skinning.write_obj(directory / f"{name}_{number}.obj", skinning.posed(points, share, skeleton, turns), triangles)
    print(f"{len(points)} vertices, {len(triangles)} triangles")


if __name__ == "__main__":
    main()
