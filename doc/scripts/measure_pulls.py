# SPDX-License-Identifier: GPL-3.0-or-later
"""Print the table of doc/measured.md on strong pulls: a bar, a cat and a horse drawn out by one, three and ten lengths.

Usage: /usr/bin/python3 doc/scripts/measure_pulls.py [BINARY] [BODY]...     from anywhere
BODY is bar, cat or horse; all of them by default: half an hour. Every run is noted on stderr. Exits with 1 if a run fails.
"""
import resource
import sys
import tempfile
from pathlib import Path

from scene_runs import PROGRAM, TOP, print_table, run_scene, write_scene

# mesh, what is held, what is pulled, by which formula, how far [m]
BODIES = {
    "bar": ({"Mesh/Generator": "box", "Mesh/Box size": "4, 1, 1", "Mesh/Box cells": "16, 4, 4"},
            "boundary 1", "boundary 2", "{}; 0; 0", (4, 12, 40)),
    "cat": ({"Mesh/File": TOP / "meshes/cat.msh"}, "box -9 -9 -9 9 9 0.04", "box -9 -9 1.0434 9 9 9", "0; 0; {}", (1, 3, 10)),
    "horse": ({"Mesh/File": TOP / "meshes/horse.msh"}, "box -9 -9 -9 9 9 0.06", "box -9 -9 1.4453 9 9 9", "0; 0; {}", (1.8, 5.4, 18)),
}
TIMES = {"static": {"Time/Increments": 10}, "dynamic": {"Time/Step": 0.02, "Time/End": 1}}
RATIOS = ("0.3", "0.45", "0.49")
HEADER = ["body", "pulled by [m]", "scene", "most iterations of a step", "time [s]", "over that with cells"]


def measure(program, scene, dilatation, directory):
    """The greatest number of iterations of a step, and the seconds of the processor."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    run = run_scene(program, scene, directory / "out", {"Model/Dilatation": dilatation, "Output/Every": 1000}, False,
                    ("--threads", "1"))
    seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    print(scene.name, dilatation, run.status, f"{seconds:.2f} s", file=sys.stderr)
    if run.status:
        sys.exit(run.stderr)
    return max(row["iterations"] for row in run.rows), seconds


def text_of(values, digits):
    least, most = f"{min(values):.{digits}f}", f"{max(values):.{digits}f}"
    return least if least == most else f"{least} to {most}"


def rows_of(program, body, directory):
    mesh, held, moved, motion, ways = BODIES[body]
    for way in ways:
        for kind, times in TIMES.items():
            found = []
            for ratio in RATIOS:
                scene = write_scene(directory / f"{body}_{way}_{kind}_{ratio}.prm", {
                    "Scene": kind, **mesh, "Material/Young's modulus": "1e5", "Material/Poisson's ratio": ratio,
                    "Handles/Names": "held, moved", "Handles/held/Select": held, "Handles/moved/Select": moved,
                    "Handles/moved/Motion": motion.format(f"{way}*t"), **times})
                _, with_cells = measure(program, scene, "cells", directory)
                iterations, seconds = measure(program, scene, "patches", directory)
                found.append((iterations, seconds, seconds / with_cells))
            iterations, seconds, ratios = zip(*found)
            yield [body, way, kind, text_of(iterations, 0), text_of(seconds, 1), text_of(ratios, 1)]


def main():
    arguments = sys.argv[1:]
    program = arguments.pop(0) if arguments and arguments[0] not in BODIES else PROGRAM
    with tempfile.TemporaryDirectory() as holder:
        print_table(HEADER, *[row for body in arguments or BODIES for row in rows_of(program, body, Path(holder))])


if __name__ == "__main__":
    main()
