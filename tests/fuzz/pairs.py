# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies thrown at each other: no run may fail, in no frame may an edge pass through a triangle of a surface, and none may gain energy.

    python3 tests/fuzz/pairs.py --exemplar build/release/exemplar --runs 500 --seed 1

Scenes are random: two to four bars, blocks, plates and horseshoes of some ten to some thousand cells, turned at random, with stiffness, speed (up
to twice that of waves), step, friction, method and element of their own. Frames are tested by exact arithmetic, all edges of the surface with
all triangles. Prints a line a failure, with the scene's number, and counts at the end; --keep leaves the directories of failures."""

import argparse
import collections
import concurrent.futures
import csv
import itertools
import math
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "scenes"))
from contact_reference import boundary
from drops import write
from exact_crossings import crossings
from exemplar_runner import read_vtu
from piece_boxes import Box, write_boxes

ROOT = pathlib.Path(__file__).resolve().parents[2]
DENSITY = 1000
STEPS = 30
GAIN = 0.02  # of the greatest kinetic energy
KINDS = {"bar": ((0.8, 0.2, 0.2), ((4, 1, 1), (8, 2, 2), (12, 3, 3))), "block": ((0.4, 0.4, 0.4), ((1, 1, 1), (2, 2, 2), (4, 4, 4))),
         "plate": ((0.8, 0.6, 0.06), ((6, 5, 1), (10, 8, 1), (14, 10, 2))), "horseshoe": ((1.6, 0.2, 0.15), ((12, 1, 1), (20, 2, 2)))}

Body = collections.namedtuple("Body", "kind size n turn middle velocity")


def bent(x, size):
    """A straight bar as a horseshoe."""
    angle = 0.85 * 2 * math.pi * (x[0] / size[0] - 0.5)
    radius = size[0] / (2 * math.pi) * 1.1 - (x[2] - size[2] / 2)
    return np.array([radius * math.sin(angle), x[1] - size[1] / 2, -radius * math.cos(angle)])


def random_turn(rng):
    q = np.array([rng.gauss(0, 1) for _ in range(4)])
    a, b, c, d = q / np.linalg.norm(q)
    return np.array([[1 - 2 * (c * c + d * d), 2 * (b * c - a * d), 2 * (b * d + a * c)],
                     [2 * (b * c + a * d), 1 - 2 * (b * b + d * d), 2 * (c * d - a * b)],
                     [2 * (b * d - a * c), 2 * (c * d + a * b), 1 - 2 * (b * b + c * c)]])


def place_of(body):
    def place(*x):
        x = np.array(x)
        own = bent(x, body.size) if body.kind == "horseshoe" else x - np.array(body.size) / 2
        return tuple(body.turn @ own + body.middle)
    return place


def farthest_along(body, direction):
    place = place_of(body)
    return max((place(*(f * s for f, s in zip(part, body.size))) - body.middle) @ direction
               for part in itertools.product(np.linspace(0, 1, 33), (0, 1), (0, 1)))


def bodies_of(rng, speed, step):
    """The first rests at the origin, others come towards it from places around, where a plane is between any two of them."""
    bodies = []
    for i in range(rng.choice([2, 2, 2, 3, 4])):
        kind = rng.choice(list(KINDS))
        size, choices = KINDS[kind]
        body = Body(kind, size, rng.choice(choices), random_turn(rng), np.zeros(3), np.zeros(3))
        if i > 0:
            toward = np.array([rng.gauss(0, 1) for _ in range(3)])
            toward /= np.linalg.norm(toward)
            gap = min(0.2 * speed * step * STEPS, 0.5) * rng.random() + 0.01
            away = farthest_along(bodies[0], -toward) + farthest_along(body, toward) + gap
            aim = np.array([rng.uniform(-.05, .05) for _ in range(3)])
            while any(not are_apart(body._replace(middle=-away * toward), other) for other in bodies):
                away *= 1.1
            body = body._replace(middle=-away * toward, velocity=speed * (aim + away * toward) / np.linalg.norm(aim + away * toward))
        bodies.append(body)
    return bodies


def are_apart(body, other):
    between = body.middle - other.middle
    size = np.linalg.norm(between)
    return size > 0 and farthest_along(body, -between / size) + farthest_along(other, between / size) + 0.005 < size


def velocity_formulas(bodies):
    """That of the body behind the planes between it and all others."""
    def is_behind(body):
        sides = []
        for other in bodies:
            if other is not body:
                normal = (body.middle - other.middle) / np.linalg.norm(body.middle - other.middle)
                far = 0.5 * (body.middle @ normal - farthest_along(body, -normal) + other.middle @ normal + farthest_along(other, normal))
                sides.append("+".join(f"({n:.9g})*{x}" for n, x in zip(normal, "xyz")) + f" > {far:.9g}")
        return " && ".join(f"({side})" for side in sides)

    formulas = []
    for c in range(3):
        text = "0"
        for body in bodies[1:]:
            text = f"({is_behind(body)} ? {body.velocity[c]:.9g} : {text})"
        formulas.append(text)
    return "; ".join(formulas)


def scene(number, seed, directory):
    rng = random.Random(f"pairs {seed} {number}")
    young = 10 ** rng.uniform(3, 10)
    speed = min(10 ** rng.uniform(-1, 2), 2 * math.sqrt(young / DENSITY))
    step = float(f"{min(10 ** rng.uniform(-.7, .3) / (speed * STEPS), .1):.6g}")  # of a way from .2 to 2 m
    bodies = bodies_of(rng, speed, step)
    _, cells, owners = write_boxes(directory / "pieces.msh",
                                   *(Box((0, 0, 0), body.size, body.n, place_of(body)) for body in bodies))
    method = rng.choice(["quasi newton", "quasi newton", "quasi newton", "newton"])
    element = rng.choice(["P1"] * 7 + ["P2"]) if len(cells) < 1000 else "P1"
    also = rng.choice(["Self", "Bodies"])
    keys = {"Scene": "dynamic", "Mesh/File": "pieces.msh", "Model/Element": element, "Material/Young's modulus": f"{young:.6g}",
            "Material/Poisson's ratio": "0.4", "Material/Density": str(DENSITY), "Initial/Velocity": velocity_formulas(bodies),
            f"Contact/{also}": "true", "Contact/Friction": f"{rng.choice([0, 0, .1, .5, 1.]):g}",
            "Time/Step": f"{step:.6g}", "Time/End": f"{step * STEPS:.9g}", "Solver/Method": method, "Solver/Maximum iterations": "400",
            "Output/Formats": "vtu", "Output/Every": "1"}
    name = f"{'+'.join(body.kind for body in bodies)} {len(cells)} cells {element} {method} E {young:.1e} v {speed:.2g} h {step:.1e} " \
           f"mu {keys['Contact/Friction']}"
    return f"{also} {name}", keys, np.array(cells), None if also == "Self" else owners


def flat_triangles(cells):
    """Of the surface: those of linear cells, or the four of each face of quadratic ones."""
    if cells.shape[1] == 4:
        return boundary(cells)
    middle = {frozenset((int(cell[a]), int(cell[b]))): cell[4 + k] for cell in cells
              for k, (a, b) in enumerate(((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)))}
    flat = []
    for a, b, c in boundary(cells[:, :4]):
        p, q, r = (middle[frozenset(map(int, side))] for side in ((a, b), (b, c), (c, a)))
        flat += [(a, p, r), (p, b, q), (r, q, c), (p, q, r)]
    return np.array(flat)


def crossings_of_frames(directory, cells, owners):
    """How many edges pass through triangles, of another piece if there are owners of nodes, in all frames; the number of frames."""
    n, triangles, files = 0, None, sorted(directory.glob("frame_*[0-9].vtu"))
    for file in files:
        arrays, n_points, _ = read_vtu(file)
        if triangles is None:
            of_frame = np.array(arrays["Cells", "connectivity"]).reshape(len(cells), -1)
            triangles = flat_triangles(of_frame)
            piece = {node: owners[own[0]] for cell, own in zip(of_frame, cells) for node in cell} if owners else None
        n += sum(piece is None or piece[edge[0]] != piece[triangle[0]]
                 for edge, triangle in crossings(np.array(arrays["Points", "Points"]).reshape(n_points, 3), triangles))
    return n, len(files)


def gain_and_touched(directory):
    """By how much the total energy is at most above that at the start, over the greatest kinetic one; whether anything touched."""
    file = directory / "statistics.csv"
    rows = list(csv.DictReader(open(file))) if file.exists() else []
    if len(rows) < 2:
        return -math.inf, False
    total = [sum(float(row[f"energy_{kind}"]) for kind in ("elastic", "kinetic", "body_contact")) for row in rows]
    return (max(total) - total[0]) / max(float(row["energy_kinetic"]) for row in rows), any(float(row["body_pairs"]) > 0 for row in rows)


def run(number, arguments):
    directory = pathlib.Path(tempfile.mkdtemp(prefix=f"pair{number}_", dir=arguments.directory and pathlib.Path(arguments.directory).resolve()))
    name, keys, cells, owners = scene(number, arguments.seed, directory)
    write(keys, directory / "scene.prm")
    try:
        done = subprocess.run([arguments.exemplar, "scene.prm", "--output", "out", "--quiet", "--threads", "1"], cwd=directory,
                              capture_output=True, text=True, timeout=arguments.timeout)
        status, text = done.returncode, done.stderr.strip()
    except subprocess.TimeoutExpired:
        status, text = "timeout", ""
    crossed, n_frames = crossings_of_frames(directory / "out", cells, owners)
    gained, touched = gain_and_touched(directory / "out")
    bad = status != 0 or crossed > 0 or n_frames != STEPS + 1 or gained > GAIN
    if not bad or not arguments.keep:
        shutil.rmtree(directory)
    kind = "crossed" if crossed else f"status {status}" if status != 0 else "frames" if n_frames != STEPS + 1 \
        else "energy" if gained > GAIN else "touched" if touched else "missed"
    return number, name, kind, crossed, gained, text, directory


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--exemplar", default=str(ROOT / "build/release/exemplar"))
    parser.add_argument("--runs", type=int, default=100)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--timeout", type=float, default=600)
    parser.add_argument("--directory", default=None, help="where scenes run")
    parser.add_argument("--keep", action="store_true")
    parser.add_argument("--verbose", action="store_true", help="a line for each run")
    arguments = parser.parse_args()
    arguments.exemplar = str(pathlib.Path(arguments.exemplar).resolve())
    counts, most = collections.Counter(), -math.inf
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        for number, name, kind, crossed, gained, text, directory in pool.map(
                lambda n: run(n, arguments), range(arguments.first, arguments.first + arguments.runs)):
            most = max(most, gained)
            counts[kind] += 1
            if arguments.verbose or kind not in ("touched", "missed"):
                print(f"{number}: {kind}, {name}, crossings {crossed}, gain {gained:.1e}: {text[-400:]} "
                      f"{directory if arguments.keep else ''}", flush=True)
    print(", ".join(f"{n} {kind}" for kind, n in sorted(counts.items())) + f"; greatest gain of energy {most:.1e}")
    return 0 if set(counts) <= {"touched", "missed"} else 1


if __name__ == "__main__":
    sys.exit(main())
