#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What an error of space and step together costs, by element, mesh and step, doc/choosing.md.

    /usr/bin/python3 doc/scripts/measure_time_to_error.py [bar] [cat] [--program P]

bar is prm/studies/scenes/bar.prm, held at one end, the other lifted in a second, with one example. cat is
prm/studies/scenes/cat_turned.prm, whose soles are turned; the finer cat is it with each cell cut in eight, so that both are one polyhedron. The error is the root mean square over the nodes of the coarsest mesh, weighed by their
volumes, of the position at the end, over that of the displacement. The truth is quadratic elements with the mean dilatation of a
cell on the finest mesh that they can take here, BDF2 with a twentieth of the greatest step and a step tolerance of 1e-6. Seconds are processor
seconds of the run on one thread times the share that the steps have of its clock, the least of two runs. One pass is the
paper's method. Writes doc/studies/time_to_error_BODY.csv. Half an hour.
"""
import csv
import json
import os
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

from measure_space_error import MESHES, SCENES, TOP, nodes_among, places_of, volumes_of, write_msh
from space_elements import np, read_mesh, refined
from study_tables import ELEMENTS

STUDIES = TOP / "doc/studies"
STEPS = (0.05, 0.025, 0.0125, 0.00625, 0.003125)
SCENE = {"bar": "bar.prm", "cat": "cat_turned.prm"}
HANDLE = {"bar": "right", "cat": "soles"}
COMMON = {"Output/Every": 0, "Examples/Energy": "mixed", "Examples/Weights": "simplex"}  # the defaults
REFERENCE = {"Time/Scheme": "bdf2", "Time/Step": 0.0025, "Solver/Step tolerance": 1e-6,
             "Model/Element": "P2", "Model/Dilatation": "patches"}


def meshes_of(body, folder):
    """Settings of the meshes from the coarsest on; the last is the reference's."""
    if body == "bar":
        return [{"Mesh/Box cells": f"{4 * n}, {n}, {n}"} for n in (2, 4, 6, 8)]
    places, cells = read_mesh(MESHES / "cat_68mm.geo")
    meshes = []
    for level in range(2):
        write_msh(folder / f"{level}.msh", places, cells)
        meshes.append({"Mesh/File": folder / f"{level}.msh"})
        places, cells = refined(places, cells)
    return meshes


def run(program, body, settings, folder):
    """Places of the nodes at the end, processor seconds of the time stepping and summary.json."""
    settings = {**COMMON, **settings}
    words = [word for name, value in settings.items() for word in ("--set", f"{name}={value}")]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([program, SCENES / SCENE[body], "--quiet", "--threads", "1", "--output", folder / "out", *words], check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    summary = json.loads((folder / "out/summary.json").read_text())
    seconds = summary["seconds"]
    of_steps = sum(seconds[phase] for phase in ("evaluate", "assemble", "factorize", "solve"))
    processor = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return places_of(folder / "out/final.msh"), processor * of_steps / seconds["total"], summary


class Truth:
    """Where the nodes of the coarsest mesh really go."""

    def __init__(self, program, body, meshes, folder):
        self.rest, cells = self.rest_of(program, body, meshes[0], folder)
        self.volumes = volumes_of(self.rest, cells)[:, None]
        fine, _ = self.rest_of(program, body, meshes[-1], folder)
        places, _, _ = run(program, body, {**meshes[-1], **REFERENCE}, folder)
        self.u = (places - fine)[nodes_among(self.rest, fine)]

    @staticmethod
    def rest_of(program, body, mesh, folder):
        run(program, body, {**mesh, "Scene": "static", f"Handles/{HANDLE[body]}/Motion": "0; 0; 0", "Examples/Importance": 0,
                            "Model/Dilatation": "cells"}, folder)
        return read_mesh(folder / "out/final.msh")

    def error(self, places, fine_rest):
        u = (places - fine_rest)[nodes_among(self.rest, fine_rest)]
        return np.sqrt((self.volumes * (u - self.u) ** 2).sum() / (self.volumes * self.u ** 2).sum())


def kinds_of_runs(is_finest):
    """The name of the element, and settings."""
    for (element, dilatation), name in ELEMENTS.items():
        if is_finest and element == "P2":
            continue  # these are the truth
        for scheme in ("implicit euler", "bdf2"):
            for step in STEPS:
                settings = {"Model/Element": element, "Model/Dilatation": dilatation, "Time/Scheme": scheme, "Time/Step": step}
                yield name, settings
                if name == "P1" and scheme == "implicit euler":
                    yield "P1, one pass", {**settings, "Solver/Method": "one pass"}


def measure(program, body, folder):
    meshes = meshes_of(body, folder)
    truth = Truth(program, body, meshes, folder)
    for mesh in meshes:
        rest, _ = Truth.rest_of(program, body, mesh, folder)
        for name, settings in kinds_of_runs(mesh is meshes[-1]):
            places, first, summary = run(program, body, {**mesh, **settings}, folder)
            _, second, _ = run(program, body, {**mesh, **settings}, folder)
            yield {"element": name, "cells": f"{summary['cells']} cells", "step": settings["Time/Step"], "scheme": settings["Time/Scheme"],
                   "status": summary["status"], "error_position_l2": f"{truth.error(places, rest):.4g}",
                   "seconds_median": f"{min(first, second):.4g}"}


def main():
    words = sys.argv[1:]
    program = words[words.index("--program") + 1] if "--program" in words else str(TOP / "build/release/exemplar")
    bodies = [word for word in words if word in SCENE] or list(SCENE)
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    for body in bodies:
        rows = []
        with tempfile.TemporaryDirectory() as folder:
            for row in measure(program, body, Path(folder)):
                print(*row.values(), flush=True)
                rows.append(row)
        with open(STUDIES / f"time_to_error_{body}.csv", "w", newline="") as file:
            writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)


if __name__ == "__main__":
    main()
