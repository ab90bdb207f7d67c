# SPDX-License-Identifier: GPL-3.0-or-later
"""What the Python module costs, as ratios within one run: each is the median over pairs of measurements one after the other.

Usage: PYTHONPATH=build/release/python /usr/bin/python3 tests/benchmark/measure_python.py [--pairs N] [NAME...]
Names: vjp, change, hessian, step, leaks; all without any. EXEMPLAR names the program. Seconds are processor time.
"""
import argparse
import csv
import gc
import os
import resource
import statistics
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np

import exemplar

TOP = Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("EXEMPLAR", str(TOP / "build/release/exemplar"))
CAT = {"Scene": "static", "Mesh": {"File": TOP / "meshes/cat.msh"}, "Time": {"Increments": 1},
       "Examples": {"Poses": [TOP / "meshes/poses/cat_arch.msh", TOP / "meshes/poses/cat_rear.msh"], "Importance": 0.9},
       "Handles": {"hind": {"Select": "box -0.52 -0.2 -0.01  -0.27 0.2 0.08"},
                   "fore": {"Select": "box 0.26 -0.2 -0.01  0.5 0.2 0.08", "Motion": ["-0.22*t", 0, "0.05*t"]}}}
BAR = {"Scene": "static", "Mesh": {"Generator": "box", "Box size": [4, 1, 1], "Box cells": [16, 4, 4]}, "Time": {"Increments": 1},
       "Examples": {"Pose functions": [["(8/pi-z)*sin(pi*x/8)", "y", "8/pi-(8/pi-z)*cos(pi*x/8)"]], "Importance": 0.8},
       "Handles": {"left": {"Select": "boundary 1"}, "right": {"Select": "boundary 2", "Motion": [0, 0, "t"], "Components": "z"}}}
DYNAMIC = {**CAT, "Scene": "dynamic", "Time": {"Step": 0.02, "End": 2}}


def seconds(action):
    begin = time.process_time()
    action()
    return time.process_time() - begin


def ratio_of(first, second, pairs):
    """(median of first/second, median seconds of each); both are functions that return seconds."""
    measured = [(first(), second()) for _ in range(pairs)]
    return (statistics.median(a / b for a, b in measured), *(statistics.median(column) for column in zip(*measured)))


def vjp(pairs):
    """Backward by all parameters over the forward solve from rest, of which it is the gradient."""
    problem = exemplar.Problem(CAT)
    by_positions = np.random.default_rng(1).normal(size=problem.positions.shape)

    def forward():
        problem.reset()
        return seconds(problem.run)
    forward()
    backward, solve, ratio = [], [], []
    for _ in range(pairs):
        solve.append(forward())
        backward.append(seconds(lambda: problem.vjp(by_positions)))
        ratio.append(backward[-1] / solve[-1])
    yield "cat: vjp / solve", (statistics.median(ratio), statistics.median(backward), statistics.median(solve)), 1.0


def change(pairs):
    """A new E and a solve, over a solve alone."""
    for name, scene in ("bar", BAR), ("cat", CAT):
        problem = exemplar.Problem(scene)
        problem.run()
        young = np.full(len(problem.cells), 1e6)

        def alone():
            problem.reset()
            return seconds(problem.run)

        def changed():
            problem.reset()
            nonlocal young
            young = young * 1.01

            def both():
                problem.set_material(young=young)
                problem.run()
            return seconds(both)
        alone()
        yield f"{name}: new E and solve / solve", ratio_of(changed, alone, pairs), 1.1


def hessian(pairs):
    """A matrix of scipy over coupling(), which evaluates and assembles the same and returns two columns."""
    problem = exemplar.Problem(CAT)
    problem.run()
    problem.hessian()
    yield "cat: hessian / assembly", ratio_of(lambda: seconds(problem.hessian), lambda: seconds(problem.coupling), 3 * pairs), 2.0


def as_text(section, level=0):
    """A scene of a dictionary as the program reads it."""
    lines = []
    for key, value in section.items():
        if isinstance(value, dict):
            names = [f"  set Names = {', '.join(value)}"] if key == "Handles" else []
            lines += [f"subsection {key}", *names, as_text(value), "end"]
        else:
            separator = "; " if key == "Motion" else " " if key == "Select" else ", "
            if key == "Pose functions":
                value = " | ".join("; ".join(pose) for pose in value)
            lines.append(f"set {key} = {separator.join(map(str, value)) if isinstance(value, list) else value}")
    return "\n".join(lines)


def program_seconds(scene, directory, keys):
    """Of all steps of a run by the program, without its output."""
    file, output = Path(directory, "scene.prm"), Path(directory, "out")
    file.write_text(as_text(scene) + "\n")
    options = [word for key, value in {"Output/Every": 0, **keys}.items() for word in ("--set", f"{key}={value}")]
    subprocess.run([PROGRAM, file, "--quiet", "--threads", "1", "--output", output, *options], check=True)
    with open(output / "statistics.csv", newline="") as lines:
        rows = list(csv.DictReader(lines))
    return sum(float(row["seconds_step"]) - float(row["seconds_output"]) for row in rows[1:])


def step(pairs):
    """100 steps of the cat from Python over the same in the program, without its output; wall clock, as the program's."""
    def python():
        problem = exemplar.Problem(DYNAMIC)
        begin = time.perf_counter()
        problem.run()
        return time.perf_counter() - begin

    def program():
        with tempfile.TemporaryDirectory() as directory:
            return program_seconds(DYNAMIC, directory, {"Output/Checkpoint minutes": 1000})
    yield "cat: 100 steps / program's", ratio_of(python, program, pairs), 1.02


def leaks(_):
    """Memory that 200 problems with gradients leave, after 20: MB."""
    def one():
        problem = exemplar.Problem(BAR)
        problem.set_motion("right", lambda rest, t: 0 * rest + [0, 0, 0.3 * t + 0 * problem.time])  # a cycle
        problem.run()
        problem.vjp(np.ones_like(problem.positions))

    def memory_after(n):
        for _ in range(n):
            one()
            gc.collect()  # Python counts objects, not their memory: cycles of few large ones wait long
        return resident()
    before = memory_after(20)
    after = memory_after(200)
    yield "200 bars: MB that stay", (after - before, after, before), 5


def resident():
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * resource.getpagesize() / 1e6


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--pairs", type=int, default=7)
    parser.add_argument("names", nargs="*")
    arguments = parser.parse_args()
    exemplar.use_one_blas_thread()
    print(f"{'':32s} {'ratio':>7s} {'goal':>6s} {'of':>10s} {'over':>10s}")
    for measure in (vjp, change, hessian, step, leaks):
        if not arguments.names or measure.__name__ in arguments.names:
            for name, (ratio, first, second), goal in measure(arguments.pairs):
                print(f"{name:32s} {ratio:7.3f} {goal:6.2f} {first:10.5f} {second:10.5f}", flush=True)


if __name__ == "__main__":
    main()
