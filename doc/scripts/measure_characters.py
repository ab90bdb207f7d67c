# SPDX-License-Identifier: GPL-3.0-or-later
"""How near a body comes to an artist's poses, and what meshing it with them and deforming it to them takes.

Usage: python3 doc/scripts/measure_characters.py OUTPUT REST POSE... [--cells 10000,30000] [--busy 1] [--unit PROGRAM] [--no-poses]
REST and each POSE are surfaces of one vertex order. Processor seconds are divided by those of the creature of meshes/surfaces deformed to its
crouch on 10,000 cells with one thread, by PROGRAM (`--unit`, of another version perhaps) in the same hour and beside the same other work: `--busy` processes that
only count. A line for each mesh, made with the poses or (`--no-poses`) without, and a line for each pose, with one thread and with two.
Environment: EXEMPLAR, the program.
"""
import argparse
import csv
import os
import resource
import subprocess
import sys
from pathlib import Path

from measure_busy import BusyLoops
from scene_runs import PROGRAM, TOP, print_table

CREATURE = TOP / "meshes/surfaces/creature"
HEADER = ["pose", "cells", "inverted", "vertex error most %", "mean %", "longest edge over its own", "one thread, units", "two threads, units"]


def processor_seconds(program, *words):
    def used():
        return sum(resource.getrusage(resource.RUSAGE_CHILDREN)[:2])
    begin = used()
    done = subprocess.run([str(program), *map(str, words)], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, words))}: {done.stderr}")
    return used() - begin


def make_mesh(program, rest, poses, n_cells, mesh):
    with_poses = ["--poses", *poses] if poses else []
    return processor_seconds(program, "mesh", "--surface", rest, "--cells", n_cells, "--output", mesh, *with_poses)


def deform(program, mesh, rest, pose, output, n_threads):
    """Processor seconds, and the row of the table of poses."""
    seconds = processor_seconds(program, "pose", "--mesh", mesh, "--rest", rest, "--pose", pose, "--output", output, "--threads", n_threads)
    with open(output / "poses.csv") as file:
        return seconds, next(csv.DictReader(file))


def creature_seconds(program, unit, output):
    """Processor seconds of the creature's crouch by the program `unit`."""
    mesh = output / "creature.msh"
    make_mesh(unit, CREATURE / "rest.obj", [], 10000, mesh)
    return deform(unit, mesh, CREATURE / "rest.obj", CREATURE / "crouch.obj", output / "creature", 1)[0]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("output", type=Path)
    parser.add_argument("rest", type=Path)
    parser.add_argument("poses", type=Path, nargs="+")
    parser.add_argument("--cells", default="10000,30000")
    parser.add_argument("--busy", type=int, default=1)
    parser.add_argument("--unit", type=Path)
    parser.add_argument("--no-poses", action="store_true")
    options = parser.parse_args()
    program = Path(os.environ.get("EXEMPLAR", PROGRAM))
    options.output.mkdir(parents=True, exist_ok=True)
    with BusyLoops(options.busy):
        unit = creature_seconds(program, options.unit or program, options.output)
        print(f"unit: {unit:.2f} s", flush=True)
        table = [HEADER]
        for n_cells in options.cells.split(","):
            mesh = options.output / f"body_{n_cells}.msh"
            seconds = make_mesh(program, options.rest, [] if options.no_poses else options.poses, n_cells, mesh)
            print(f"mesh of {n_cells} cells: {seconds:.1f} s, {seconds / unit:.2f} units", flush=True)
            for pose in options.poses:
                one, row = deform(program, mesh, options.rest, pose, options.output / "poses", 1)
                two, _ = deform(program, mesh, options.rest, pose, options.output / "poses", 2)
                table.append([pose.stem, n_cells, row["inverted_cells"], row["surface_error_max"], row["surface_error_mean"], row["longest_edge"],
                              f"{one / unit:.2f}", f"{two / unit:.2f}"])
                print(*table[-1], flush=True)
    print_table(*table)


if __name__ == "__main__":
    main()
