# SPDX-License-Identifier: GPL-3.0-or-later
"""What the gradient of a function of 100 steps by Young's modulus of all cells costs beside the steps, in seconds of the
processor and in memory beyond the recorded states, with the default dilatation of patches and with that of cells. The least of
a few rounds of each is shown.

Usage: PYTHONPATH=build/release/python python3 tests/benchmark/benchmark_trajectory.py [--rounds N] [SCENE...]
"""
import argparse
import time
import warnings
from pathlib import Path

import numpy as np

import exemplar

SCENES = Path(__file__).parent / "scenes"
ROOT = Path(__file__).parents[2]
CELLS = "set Dilatation = cells"


def highest_memory():
    """Of this process since the last call [MB]."""
    highest = next(line for line in open("/proc/self/status") if line.startswith("VmHWM")).split()[1]
    Path("/proc/self/clear_refs").write_text("5")
    return int(highest) / 1024


def seconds(action):
    begin = time.process_time()
    action()
    return time.process_time() - begin


def measure(scene, dilatation, n_steps, rounds):
    text = scene.read_text().replace("../../../", f"{ROOT}/")
    if CELLS not in text:
        raise SystemExit(f"{scene} does not have the line '{CELLS}', in which the dilatation is varied.")
    problem = exemplar.Problem(text.replace(CELLS, f"set Dilatation = {dilatation}"))
    by_positions = [np.ones_like(problem.positions)] * n_steps
    forward, backward, beyond = [], [], []

    def steps():
        for _ in range(n_steps):
            problem.step()
    for _ in range(rounds):
        problem.reset()
        with problem.record() as trajectory:
            forward.append(seconds(steps))
        highest_memory()
        before = highest_memory()
        backward.append(seconds(lambda: trajectory.vjp(by_positions)))
        beyond.append(highest_memory() - before)
    print(f"{scene.stem}, {dilatation}: {len(problem.cells)} cells, {n_steps} steps: forward {min(forward):.3f} s, backward {min(backward):.3f} s, "
          f"ratio {min(backward) / min(forward):.2f}; memory {beyond[0]:.1f} MB, in further rounds {min(beyond):.1f} MB")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("scenes", nargs="*", type=Path, default=[SCENES / f"{name}.prm" for name in
                                                                 ("cat_grav", "cat_mid60", "cat_mid60_examples")])
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--steps", type=int, default=100)
    arguments = parser.parse_args()
    warnings.simplefilter("ignore")
    for scene in arguments.scenes:
        for dilatation in ("patches", "cells"):
            measure(scene, dilatation, arguments.steps, arguments.rounds)


if __name__ == "__main__":
    main()
