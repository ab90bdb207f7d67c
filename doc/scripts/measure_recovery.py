# SPDX-License-Identifier: GPL-3.0-or-later
"""Print the table of doc/measured.md on recovery: bodies without loads that start crushed, flat or mirrored.

Usage: /usr/bin/python3 doc/scripts/measure_recovery.py [BINARY] [BODY]...     from anywhere; needs numpy
BODY is bar, bar-examples or cat; all of them by default. The bar takes a minute, the cat about
five; every run is noted on stderr. Exits with 1 if a run crashes or writes what is no number.
"""
import statistics
import sys
import tempfile
from collections import Counter
from pathlib import Path

import numpy as np

from scene_runs import BAR, MEASURED, PROGRAM, TOP, bend, print_table, read_msh, run_scene, twist, write_msh, write_scene

SEEDS = 20
STATIC = {"Scene": "static", "Time/Increments": 1, **MEASURED}
SMALL_BAR = {**BAR, "Mesh/Box cells": "8, 2, 2", "Handles/Names": "end", "Handles/end/Select": "boundary 1"}
CAT_FEET = (-0.6, -0.2, -0.01, 0.6, 0.2, 0.08)
BODIES = {
    "bar": SMALL_BAR,
    "bar-examples": {**SMALL_BAR, "Examples/Pose functions": twist("pi/2") + " | " + bend("pi/2")},
    "cat": {"Mesh/File": TOP / "meshes/cat.msh", "Handles/Names": "feet",
            "Handles/feet/Select": "box " + " ".join(map(str, CAT_FEET))},
}
OUTCOMES = ["rest", "an example", "other minimum", "other minimum with inverted cells", "exit 2", "defect"]


def random_start(rest, random):
    """Every node anywhere in the box around the body."""
    return random.uniform(rest.min(axis=0), rest.max(axis=0), rest.shape)


def along_normal(rest, random, factor):
    """Distances from a random plane through the centroid times a factor."""
    normal = random.normal(size=3)
    normal /= np.linalg.norm(normal)
    return rest + (factor - 1) * np.outer((rest - rest.mean(axis=0)) @ normal, normal)


STARTS = {
    "random": random_start,
    "flattened": lambda rest, random: along_normal(rest, random, 0),
    "mirrored": lambda rest, random: along_normal(rest, random, -1),
}


def held_nodes(name, rest):
    if name == "cat":
        return ((rest >= CAT_FEET[:3]) & (rest <= CAT_FEET[3:])).all(axis=1)
    return rest[:, 0] < 1e-9


def outcome_of(run, rest):
    """One of OUTCOMES."""
    if run.status == 2:
        return "exit 2"
    if run.status or not all(np.isfinite(value) for value in run.rows[-1].values() if isinstance(value, float)):
        return "defect"
    places = np.array(list(read_msh(run.output / "final.msh").nodes.values()))
    if not np.isfinite(places).all():
        return "defect"
    if np.linalg.norm(places - rest, axis=1).max() < 1e-6 * np.ptp(rest, axis=0).max():
        return "rest"
    row = run.rows[-1]
    if row["inverted_cells"]:
        return "other minimum with inverted cells"
    # the energy with examples is a small part of what it is without them
    left = row["energy_elastic"] + row.get("energy_example", 0)
    return "an example" if left < 0.01 * row["energy_elastic"] else "other minimum"


def recover(program, name, mesh, start, seed, folder):
    """Run one start; what came of it and the iterations."""
    rest = np.array(list(mesh.nodes.values()))
    places = STARTS[start](rest, np.random.default_rng(seed))
    held = held_nodes(name, rest)
    places[held] = rest[held]
    write_msh(folder / "start.msh", mesh._replace(nodes=dict(zip(mesh.nodes, places))))
    scene = write_scene(folder / "scene.prm", {**BODIES[name], **STATIC, "Initial/Pose": "start.msh"})
    run = run_scene(program, scene, folder / "out", check=False)
    outcome = outcome_of(run, rest)
    iterations = int(run.rows[-1]["iterations"]) if run.rows else 0
    print(f"{name}, {start}, seed {seed}: {outcome}, {iterations} iterations {run.stderr.strip()}", file=sys.stderr,
          flush=True)
    return outcome, iterations


def rest_mesh(program, name, folder):
    """The body as it is left by a static scene in which nothing moves."""
    run = run_scene(program, write_scene(folder / "rest.prm", {**BODIES[name], **STATIC}), folder / "rest")
    return read_msh(run.output / "final.msh")


def row(program, name, mesh, start, folder):
    runs = [recover(program, name, mesh, start, seed, folder) for seed in range(SEEDS)]
    counts = Counter(outcome for outcome, _ in runs)
    recovered = [iterations for outcome, iterations in runs if outcome == "rest"]
    return counts["defect"], (name, start, *(counts[outcome] for outcome in OUTCOMES),
                              f"{statistics.median(recovered):g}" if recovered else "-",
                              max(recovered, default="-"))


def main():
    words = sys.argv[1:]
    program = words.pop(0) if words and words[0] not in BODIES else PROGRAM
    table, defects = [("body", "start", *OUTCOMES, "iterations to rest, median", "most")], 0
    for name in words or BODIES:
        with tempfile.TemporaryDirectory() as folder:
            mesh = rest_mesh(program, name, Path(folder))
            for start in STARTS:
                found, line = row(program, name, mesh, start, Path(folder))
                table.append(line)
                defects += found
    print_table(*table)
    sys.exit(defects > 0)


if __name__ == "__main__":
    main()
