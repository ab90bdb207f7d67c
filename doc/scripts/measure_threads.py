# SPDX-License-Identifier: GPL-3.0-or-later
"""Write doc/studies/threads.csv: what two threads gain, part by part, and a model of sixteen.

Usage: python3 doc/scripts/measure_threads.py [BINARY]     on a quiet machine with two cores at least
Runs each scene with one and with two threads, in turn. Seconds are of the clock, medians over the runs. Exits with 1 if
two threads give another final.msh. The model takes each part of a run by Amdahl's law: of the seconds that it takes with one
thread the share that two could not halve is not shared by sixteen either.
"""
import csv
import statistics
import sys
import tempfile

from scene_runs import PROGRAM, TOP, run_scene

PATCHES, CHOLESKY = {"Model/Dilatation": "patches"}, {"Solver/Linear solver": "cholesky"}
SCENES = [  # what, scene, settings
    ("cat, 10k cells, 120 steps", "tests/benchmark/scenes/cat_mid60", PATCHES),
    ("bar, 98k cells, 60 steps, kept factor", "tests/benchmark/scenes/bar100k", {**PATCHES, **CHOLESKY}),
    ("bar, 98k cells, 60 steps, kept multigrid", "tests/benchmark/scenes/bar100k",
     {**PATCHES, "Solver/Linear solver": "iterative"}),
    ("bar, 98k cells, static", "tests/benchmark/scenes/bar1M", {**PATCHES, **CHOLESKY, "Mesh/Box cells": "64, 16, 16"}),
    ("cat, 10k P2 cells, static", "prm/poses/cat_arch", {**PATCHES, "Model/Element": "P2", "Time/Increments": "3"}),
]
PARTS = ["evaluate", "assemble", "factorize", "solve"]
N_RUNS = 5
N_CORES = 16


def run(program, scene, settings, n_threads):
    """Seconds of the parts, and the bytes of final.msh."""
    with tempfile.TemporaryDirectory() as folder:
        done = run_scene(program, TOP / f"{scene}.prm", folder + "/out", settings, arguments=["--threads", str(n_threads)])
        return done.summary["seconds"], (done.output / "final.msh").read_bytes()


def modelled(one, two):
    """Seconds of a part with N_CORES threads."""
    serial = min(max(2 * two / one - 1, 0), 1)
    return one * (serial + (1 - serial) / N_CORES)


def measure(program, what, scene, settings):
    """A row of the table."""
    runs = [[run(program, scene, settings, n) for n in (1, 2)] for _ in range(N_RUNS)]
    if any(one[1] != two[1] for one, two in runs):
        sys.exit(f"{what}: two threads give another final.msh")
    one, two = ({part: statistics.median(pair[k][0][part] for pair in runs) for part in PARTS} for k in (0, 1))
    row = {"what": what, "one": f"{sum(one.values()):.3g}", "two": f"{sum(two.values()):.3g}",
           "speedup": f"{sum(one.values()) / sum(two.values()):.2f}"}
    row.update({part: f"{one[part] / two[part]:.2f}" for part in PARTS})
    row["sixteen"] = f"{sum(one.values()) / sum(modelled(one[part], two[part]) for part in PARTS):.1f}"
    return row


def main():
    program = sys.argv[1] if len(sys.argv) > 1 else PROGRAM
    rows = []
    for what, scene, settings in SCENES:
        rows.append(measure(program, what, scene, settings))
        print(rows[-1], flush=True)
    with open(TOP / "doc/studies/threads.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


if __name__ == "__main__":
    main()
