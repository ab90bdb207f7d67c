# SPDX-License-Identifier: GPL-3.0-or-later
"""Drops and shots of bodies at obstacles: no run may fail, no frame may show the body inside, and none may gain energy.

    python3 tests/fuzz/drops.py --exemplar build/release/exemplar --runs 1000 --seed 1

Scenes are random: bodies of some hundred to ten thousand cells, all shapes of obstacles, stiffness, speed and step over
orders of magnitude. What a frame shows is tested by formulas of its own, on the triangles of the body's surface. Prints a line
a failure, with the scene's number, and counts at the end; --keep leaves the directories of failures. With --moving the obstacle comes
towards the body with a share of the speed; energies are not looked at then."""

import argparse
import concurrent.futures
import csv
import math
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "scenes"))
from exemplar_runner import read_vtu

ROOT = pathlib.Path(__file__).resolve().parents[2]
GAIN = 0.01


class Body:
    def __init__(self, name, mesh, size, low):
        self.name, self.mesh, self.size, self.low = name, mesh, size, None if low is None else np.array(low)


def bodies(rng, names):
    n = rng.choice([(4, 1, 1), (8, 2, 2), (12, 3, 3)])
    bar = {"Mesh/Generator": "box", "Mesh/Box size": "0.8, 0.2, 0.2", "Mesh/Box cells": ", ".join(map(str, n))}
    all_of_them = [
        Body("bar", bar, 0.85, (0, -.1, -.1)),
        Body("cat", {"Mesh/File": str(ROOT / "meshes/cat.msh")}, 1.6, None),
        Body("horse", {"Mesh/File": str(ROOT / "meshes/horse.msh")}, 1.6, None)]
    chosen = [(body, often) for body, often in zip(all_of_them, (14, 2, 1)) if body.name in names]
    return rng.choices(*zip(*chosen))[0]


def bounds_of(body):
    if body.low is not None:
        return body.low, body.low + [.8, .2, .2]
    points, reading = [], False
    for line in open(body.mesh["Mesh/File"]):
        if line.startswith("$Nodes"):
            reading = True
        elif line.startswith("$EndNodes"):
            break
        elif reading and len(line.split()) == 4:
            points.append([float(x) for x in line.split()[1:]])
    return np.min(points, 0), np.max(points, 0)


def obstacle(rng, low, high, toward, gap, directory):
    """Text of a shape ahead of the body, which goes along `toward`, and the test that says how deep triangles are inside."""
    centre, half = (low + high) / 2, (high - low) / 2
    # a place ahead, beyond the box of the body by `gap`
    reach = np.linalg.norm(half)
    kind = rng.choice(["plane", "sphere", "capsule", "box", "inside box", "surface"])
    ahead = centre + toward * (reach + gap)
    words = lambda *numbers: " ".join(f"{x:.9g}" for x in np.concatenate([np.ravel(n) for n in numbers]))
    if kind == "plane":
        n = -toward + 0.4 * np.array([rng.uniform(-1, 1) for _ in range(3)])
        n /= np.linalg.norm(n)
        # the furthest corner of the body's box along -n
        at = centre - n * (np.abs(n) @ half + gap)
        return f"plane {words(at, n)}", lambda x, t: -np.min((x[t] - at) @ n)
    if kind == "inside box":
        margin = gap + half * rng.uniform(.05, 1.)
        lo, hi = low - margin, high + margin
        return f"inside box {words(lo, hi)}", lambda x, t: -min(np.min(x[t] - lo), np.min(hi - x[t]))
    if kind == "sphere":
        r = reach * 10 ** rng.uniform(-1, .5)
        c = ahead + toward * r
        return f"sphere {words(c, r)}", lambda x, t: r - np.sqrt(np.min(triangle_point(x[t], c)))
    if kind == "capsule":
        r = reach * 10 ** rng.uniform(-1.3, 0)
        axis = np.cross(toward, [rng.uniform(-1, 1) for _ in range(3)])
        axis *= reach * rng.uniform(.2, 2) / np.linalg.norm(axis)
        a, b = ahead + toward * r - axis, ahead + toward * r + axis
        return f"capsule {words(a, b, r)}", lambda x, t: r - triangle_segment(x[t], a, b)
    size = reach * np.array([10 ** rng.uniform(-.8, .3) for _ in range(3)])
    c = ahead + toward * np.linalg.norm(size)
    lo, hi = c - size, c + size
    if kind == "box":
        return f"box {words(lo, hi)}", lambda x, t: 1. if triangles_meet_box(x[t], lo, hi) else -1.
    corners = np.array([[(lo, hi)[i][0], (lo, hi)[j][1], (lo, hi)[k][2]] for k in (0, 1) for j in (0, 1) for i in (0, 1)])
    faces = [(0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4), (2, 6, 7), (2, 7, 3), (0, 4, 6), (0, 6, 2),
             (1, 3, 7), (1, 7, 5)]
    file = directory / "obstacle.obj"
    file.write_text("".join("v " + words(p) + "\n" for p in corners)
                    + "".join("f " + " ".join(str(i + 1) for i in f) + "\n" for f in faces))
    return f"surface {file}", lambda x, t: 1. if triangles_meet_box(x[t], lo, hi) else -1.


def triangle_point(triangles, p):
    """Squared distances of triangles from a point."""
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    best = np.min([segment_point(a, b, p), segment_point(b, c, p), segment_point(c, a, p)], 0)
    n = np.cross(b - a, c - a)
    length = np.linalg.norm(n, axis=1)
    n /= np.maximum(length, 1e-300)[:, None]
    h = np.einsum("ij,ij->i", p - a, n)
    foot = p - h[:, None] * n
    inside = np.ones(len(a), bool)
    for u, v in ((a, b), (b, c), (c, a)):
        inside &= np.einsum("ij,ij->i", np.cross(v - u, foot - u), n) >= 0
    return np.where(inside, h * h, best)


def segment_point(a, b, p):
    d = b - a
    t = np.clip(np.einsum("ij,ij->i", p - a, d) / np.maximum(np.einsum("ij,ij->i", d, d), 1e-300), 0, 1)
    return np.sum((a + t[:, None] * d - p) ** 2, axis=1)


def triangle_segment(triangles, a, b):
    """The least distance, by samples of the segment that are refined where it is near."""
    near = lambda t: math.sqrt(np.min(triangle_point(triangles, a + t * (b - a))))
    ts = np.linspace(0, 1, 65)
    values = [near(t) for t in ts]
    i = int(np.argmin(values))
    lo, hi = ts[max(0, i - 1)], ts[min(64, i + 1)]
    for _ in range(60):
        u, v = lo + (hi - lo) / 3, hi - (hi - lo) / 3
        lo, hi = (lo, v) if near(u) < near(v) else (u, hi)
    return min(near(lo), min(values))


def triangles_meet_box(triangles, lo, hi):
    """Separating axes: three of the box, one of the triangle, nine of edges."""
    c, half = (lo + hi) / 2, (hi - lo) / 2
    v = triangles - c
    apart = np.any((np.min(v, 1) > half) | (np.max(v, 1) < -half), axis=1)
    edges = [v[:, 1] - v[:, 0], v[:, 2] - v[:, 1], v[:, 0] - v[:, 2]]
    axes = [np.cross(edges[0], edges[1])] + [np.cross(e, np.eye(3)[k]) for e in edges for k in range(3)]
    for axis in axes:
        p = np.einsum("ijk,ik->ij", v, axis)
        r = np.abs(axis) @ half
        apart |= (np.min(p, 1) > r) | (np.max(p, 1) < -r)
    return not np.all(apart)


def frames(directory):
    """Positions of each frame, and the triangles of the body's surface: faces that one tetrahedron has alone."""
    triangles = None
    for file in sorted(directory.glob("frame_*[0-9].vtu")):
        arrays, n_points, n_cells = read_vtu(file)
        points = np.array(next(v for (section, _), v in arrays.items() if section == "Points")).reshape(n_points, 3)
        if triangles is None:
            cells = np.array(arrays["Cells", "connectivity"]).reshape(n_cells, 4)
            faces = {}
            for cell in cells:
                for i in range(4):
                    face = tuple(cell[[j for j in range(4) if j != i]])
                    faces.setdefault(tuple(sorted(face)), []).append(face)
            triangles = np.array([own[0] for own in faces.values() if len(own) == 1])
        yield points, triangles


def scene(number, seed, directory, names, moving):
    rng = random.Random(f"{seed} {number}")
    body = bodies(rng, names)
    low, high = bounds_of(body)
    young = 10 ** rng.uniform(3, 10)
    waves = math.sqrt(young / 1000.)
    speed = min(10 ** rng.uniform(-1, 2), 5 * waves)
    step = float(f"{10 ** rng.uniform(-4, -1):.6g}")
    toward = np.array([rng.gauss(0, 1) for _ in range(3)])
    toward /= np.linalg.norm(toward)
    # near enough to be met within the run; more often than not at once
    gap = body.size * 10 ** rng.uniform(-2.5, -.5)
    steps = 30
    gap = min(gap, 0.5 * speed * step * steps) if rng.random() < .8 else gap
    gap = max(gap, .012 * body.size)
    shape, depth = obstacle(rng, low, high, toward, gap, directory)
    spin = speed / body.size * rng.choice([0, 0, 1]) * np.array([rng.uniform(-1, 1) for _ in range(3)])
    centre = (low + high) / 2
    # an obstacle may go no farther in a step than a quarter of the body
    of_obstacle = min(rng.random() * speed, .2 * body.size / step) if moving else 0.
    motion = -of_obstacle * toward
    v = (speed - of_obstacle) * toward
    r = [f"({x}-({c:.9g}))" for x, c in zip("xyz", centre)]
    velocity = "; ".join(f"{v[i]:.9g}+({spin[(i+1)%3]:.9g})*{r[(i+2)%3]}-({spin[(i+2)%3]:.9g})*{r[(i+1)%3]}" for i in range(3))
    keys = {**body.mesh, "Scene": "dynamic", "Material/Young's modulus": f"{young:.6g}", "Material/Poisson's ratio": "0.4",
            "Material/Density": "1000", "Initial/Velocity": velocity, "Loads/Gravity": "0, 0, -9.81",
            "Time/Step": f"{step:.6g}", "Time/End": f"{step * steps:.9g}", "Output/Formats": "vtu",
            "Solver/Maximum iterations": "400", "Obstacles/Names": "thing", "Obstacles/thing/Shape": shape,
            "Obstacles/thing/Friction": f"{rng.choice([0, 0, .1, .5, 1.]):g}"}
    if moving:
        keys["Obstacles/thing/Motion"] = "; ".join(f"{m:.9g}*t" for m in motion)
    name = f"{body.name} E {young:.1e} v {speed:.2g} h {step:.1e} {shape.split()[0]} mu {keys['Obstacles/thing/Friction']}"
    return name, keys, lambda x, triangles, frame: depth(x - min(frame, steps) * step * motion, triangles)


def gain(directory):
    """By how much the total energy at the end is above that at the start, over the start's and what gravity has added."""
    def total(row):
        return sum(float(row.get("energy_" + kind, 0)) for kind in ("elastic", "example", "kinetic", "contact"))
    file = directory / "statistics.csv"
    rows = list(csv.DictReader(open(file))) if file.exists() else []
    if len(rows) < 2:
        return -math.inf
    work = float(rows[-1]["work_gravity"]) - float(rows[0]["work_gravity"])
    return (total(rows[-1]) - work - total(rows[0])) / (total(rows[0]) + max(0, work))


def write(keys, file):
    lines = []
    for key, value in keys.items():
        *sections, name = key.split("/")
        lines += [f"subsection {s}" for s in sections] + [f"set {name} = {value}"] + ["end"] * len(sections)
    file.write_text("\n".join(lines) + "\n")


def run(number, arguments):
    directory = pathlib.Path(tempfile.mkdtemp(prefix=f"drop{number}_", dir=arguments.directory and pathlib.Path(arguments.directory).resolve()))
    name, keys, depth = scene(number, arguments.seed, directory, arguments.bodies.split(","), arguments.moving)
    write(keys, directory / "scene.prm")
    try:
        done = subprocess.run([arguments.exemplar, str(directory / "scene.prm"), "--output", str(directory / "out"), "--quiet"]
                              + ["--threads", "1"], capture_output=True, text=True, timeout=arguments.timeout)
        status, text = done.returncode, done.stderr.strip()
    except subprocess.TimeoutExpired:
        status, text = "timeout", ""
    deepest = -math.inf
    for frame, (positions, triangles) in enumerate(frames(directory / "out")):
        deepest = max(deepest, depth(positions, triangles, frame))
    gained = -math.inf if arguments.moving else gain(directory / "out")
    bad = status != 0 or deepest > 0 or gained > GAIN
    if not bad or not arguments.keep:
        shutil.rmtree(directory)
    return number, name, status, deepest, gained, text, directory


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--exemplar", default=str(ROOT / "build/release/exemplar"))
    parser.add_argument("--runs", type=int, default=100)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--bodies", default="bar,cat,horse")
    parser.add_argument("--moving", action="store_true", help="let the obstacle move, too")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--timeout", type=float, default=600)
    parser.add_argument("--directory", default=None, help="where scenes run")
    parser.add_argument("--keep", action="store_true")
    parser.add_argument("--verbose", action="store_true", help="a line for each run")
    arguments = parser.parse_args()
    counts, most = {}, -math.inf
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        for number, name, status, deepest, gained, text, directory in pool.map(
                lambda n: run(n, arguments), range(arguments.first, arguments.first + arguments.runs)):
            kind = "inside" if deepest > 0 else f"status {status}" if status != 0 or not gained > GAIN else "energy"
            most = max(most, gained)
            counts[kind] = counts.get(kind, 0) + 1
            if arguments.verbose or kind != "status 0":
                print(f"{number}: {kind}, {name}, depth {deepest:.2e}, gain {gained:.1e}: {text[-400:]} {directory if arguments.keep else ''}",
                      flush=True)
    print(", ".join(f"{n} {kind}" for kind, n in sorted(counts.items())) + f"; greatest gain of energy {most:.1e}")
    return 0 if set(counts) <= {"status 0"} else 1


if __name__ == "__main__":
    sys.exit(main())
