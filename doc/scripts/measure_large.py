# SPDX-License-Identifier: GPL-3.0-or-later
"""Print the tables of doc/speed.md on large meshes: cholesky beside iterative, and a bar of a million cells.

Usage: python3 doc/scripts/measure_large.py [BINARY] [PART]...     on a quiet machine
PART is crossover (five minutes, 2 GB), million (a minute, 3.5 GB) or steps (15 minutes, 5 GB); all by default.
"""
import resource
import statistics
import sys
import tempfile
from pathlib import Path

from scene_runs import MEASURED, PROGRAM, bend, print_table, run_scene, twist, write_scene

HELD = {"Scene": "static", "Mesh/Generator": "box", "Time/Increments": 1, "Solver/Tolerance": 1e-6,
        "Handles/Names": "left", "Handles/left/Select": "boundary 1", **MEASURED}
# lifted at the other end, with an example that follows and two that do not
DRAGGED = {"Handles/Names": "left, right", "Handles/right/Select": "boundary 2", "Handles/right/Motion": "0; 0; t",
           "Handles/right/Components": "z",
           "Examples/Pose functions": " | ".join((bend("pi/2"), twist("pi/2"), "1.2*x; y; z"))}


def box(size, cells, gravity=0):
    return {**HELD, "Mesh/Box size": size, "Mesh/Box cells": cells, "Loads/Gravity": f"0, 0, {-gravity}"}


BODIES = [
    *(("bar 4:1:1", box("4, 1, 1", f"{4 * n}, {n}, {n}", 1)) for n in (8, 10, 12, 14, 16, 20)),
    *(("bar 20:1:1", box("20, 1, 1", f"{20 * n}, {n}, {n}", 0.01)) for n in (8, 12)),
    *(("plate 32:32:1", box("8, 8, 0.25", f"{32 * n}, {32 * n}, {n}", 0.01)) for n in (3, 4)),
    *(("bar 4:1:1, three examples", {**box("4, 1, 1", f"{4 * n}, {n}, {n}"), **DRAGGED}) for n in (12, 16, 20)),
]
# of the benchmarks: its tip sinks by a tenth of its length
MILLION = {**box("4, 1, 1", "140, 35, 35", 9.81), "Material/Young's modulus": 1e7}

# held at one end, and falling; and with that end turned to and fro
FALLING = {"Scene": "dynamic", "Material/Young's modulus": 1e6, "Material/Poisson's ratio": 0.45, "Material/Density": 1000,
           "Time/Step": 0.01, "Time/End": 0.4}
TURNED = {**FALLING, "Material/Young's modulus": 1e7, "Time/End": 0.4,
          "Handles/left/Motion": "x*(cos(0.3*sin(6*t))-1) + z*sin(0.3*sin(6*t)); 0; z*(cos(0.3*sin(6*t))-1) - x*sin(0.3*sin(6*t))"}


def moving(size, cells, motion):
    return {**{key: value for key, value in box(size, cells, 9.81).items() if key not in ("Time/Increments", "Solver/Tolerance")},
            **motion}


MOVING = [
    *(("bar 4:1:1 falls", moving("4, 1, 1", f"{4 * n}, {n}, {n}", FALLING)) for n in (8, 10, 12, 14, 16, 20, 25)),
    *(("bar 4:1:1 is turned", moving("4, 1, 1", f"{4 * n}, {n}, {n}", TURNED)) for n in (12, 16, 20)),
    *(("bar 20:1:1 falls", moving("20, 1, 1", f"{20 * n}, {n}, {n}", FALLING)) for n in (8, 12)),
    *(("plate 32:32:1 falls", moving("8, 8, 0.25", f"{32 * n}, {32 * n}, {n}", FALLING)) for n in (3, 4)),
]


def measured(program, scene, folder, solver):
    """A run, and its processor seconds."""
    used = lambda: sum(resource.getrusage(resource.RUSAGE_CHILDREN)[:2])
    before = used()
    run = run_scene(program, scene, folder / solver, {"Solver/Linear solver": solver})
    return run, used() - before


def free(summary):
    return summary["dofs"] - summary["constrained_dofs"]


def crossover(program, folder):
    """Processor seconds of a static solve, reading included, and memory."""
    table = [("body", "cells", "free DOFs", "cholesky", "iterative", "auto takes", "cholesky", "iterative")]
    for body, keys in BODIES:
        scene = write_scene(folder / "scene.prm", keys)
        auto, seconds = measured(program, scene, folder, "auto")
        chosen = auto.summary["linear_solver"]
        other = "iterative" if chosen == "cholesky" else "cholesky"
        runs = {chosen: (auto.summary, seconds)}
        run, seconds = measured(program, scene, folder, other)
        runs[other] = (run.summary, seconds)
        solvers = [runs[name] for name in ("cholesky", "iterative")]
        table.append((body, f"{auto.summary['cells']:,}", f"{free(auto.summary):,}",
                      *(f"{seconds:.1f} s" for _, seconds in solvers), chosen,
                      *(f"{summary['peak_memory_mib']:.0f} MiB" for summary, _ in solvers)))
        print(*table[-1], file=sys.stderr, flush=True)
    print_table(*table)


def million(program, folder):
    run, seconds = measured(program, write_scene(folder / "scene.prm", MILLION), folder, "auto")
    s = run.summary
    print_table(("cells", "free DOFs", "solver", "iterations", "residual", "processor time", "memory", "of a cell"),
                (f"{s['cells']:,}", f"{free(s):,}", s["linear_solver"], s["iterations"], f"{s['worst_residual']:.0e}",
                 f"{seconds:.0f} s", f"{s['peak_memory_mib'] * 2**20 / 1e9:.2f} GB", f"{s['bytes_per_cell']:,.0f} bytes"))


def steps(program, folder):
    """Quasi-Newton steps with a kept factor and with a kept multigrid hierarchy, run in turn; the better of two."""
    table = [("body", "cells", "iterations a step", "renewals", "ms a step", "mean", "memory", "auto takes")]
    for body, keys in MOVING:
        scene = write_scene(folder / "scene.prm", keys)
        solvers, measurements = ("cholesky", "iterative"), {}
        for _ in range(2):
            for solver in solvers:
                run = run_scene(program, scene, folder / solver, {"Solver/Linear solver": solver},
                                arguments=("--threads", "1"))
                times = [1e3 * row["seconds_step"] for row in run.rows if row["seconds_step"] is not None]
                measurements.setdefault(solver, []).append(
                    (run.summary, statistics.median(times), statistics.mean(times)))
        auto = run_scene(program, scene, folder / "auto", {"Time/End": keys["Time/Step"]}).summary
        both = lambda text: " / ".join(text(measurements[solver]) for solver in solvers)
        table.append((body, f"{auto['cells']:,}",
                      both(lambda runs: f"{runs[0][0]['iterations'] / runs[0][0]['steps']:.2f}"),
                      both(lambda runs: str(runs[0][0]["factorizations"])),
                      both(lambda runs: f"{min(median for _, median, _ in runs):.0f}"),
                      both(lambda runs: f"{min(mean for _, _, mean in runs):.0f}"),
                      both(lambda runs: f"{runs[0][0]['peak_memory_mib']:.0f}") + " MiB", auto["linear_solver"]))
        print(*table[-1], sep=" | ", file=sys.stderr, flush=True)
    print_table(*table)


def main():
    parts = {"crossover": crossover, "million": million, "steps": steps}
    words = sys.argv[1:]
    program = words.pop(0) if words and words[0] not in parts else PROGRAM
    for name in words or parts:
        with tempfile.TemporaryDirectory() as folder:
            parts[name](program, Path(folder))


if __name__ == "__main__":
    main()
