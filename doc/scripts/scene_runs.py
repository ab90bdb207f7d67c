# SPDX-License-Identifier: GPL-3.0-or-later
"""What the measuring scripts of doc/scripts share: runs of scenes and the tables they print.

Meshes, poses and results are read and written by the runner of the scene tests.
"""
import subprocess
import sys
from collections import namedtuple
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP / "tests/scenes"))
from exemplar_runner import prm, read_csv, read_msh, read_summary, read_vtu, write_msh  # noqa: E402,F401

PROGRAM = TOP / "build/release/exemplar"
Run = namedtuple("Run", "status stderr output rows summary")

# What the pages were measured with, as the paper's scenes have it; Green's strain has no other dilatation.
MEASURED = {"Model/Dilatation": "cells", "Examples/Energy": "scaled"}
# A bar 4:1:1 from 0 to 4 along x; at x = 0 it can be held, at x = 4 dragged.
BAR = {"Mesh/Generator": "box", "Mesh/Box size": "4, 1, 1", "Mesh/Box cells": "16, 4, 4", **MEASURED}
# A paper scene solved by Newton's method on the true energy, with weights between 0 and 1.
NEWTON = {"Model/Gradient": "consistent", "Solver/Method": "newton", "Examples/Weights": "simplex",
          "Examples/Weight penalty": "auto", **MEASURED}


def paper_scene(name):
    return TOP / f"prm/paper/{name}.prm"


def twist(angle):
    """Pose function of the bar twisted by a muParser expression over its length."""
    a = f"({angle})*x/4"
    return f"x; y*cos({a}) - z*sin({a}); y*sin({a}) + z*cos({a})"


def bend(angle):
    """Pose function of the bar bent to an arc; its centre line keeps its length."""
    r = f"(4/({angle}))"
    return f"({r}-z)*sin(x/{r}); y; {r} - ({r}-z)*cos(x/{r})"


def write_scene(file, keys):
    """A scene file of {"Section/Key": value}."""
    Path(file).write_text(prm(keys))
    return Path(file)


def run_scene(program, scene, output, settings=None, check=True, arguments=()):
    """Run a scene file with {"Section/Key": value} set, without frames unless asked for; what it left."""
    settings = {"Output/Every": "0", **(settings or {})}
    words = [word for key, value in settings.items() for word in ("--set", f"{key}={value}")]
    done = subprocess.run([str(program), str(scene), "--quiet", "--output", str(output), *words, *arguments],
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if check and done.returncode:
        sys.exit(f"{scene}: {done.stderr}")
    written = (Path(output) / "summary.json").exists()
    return Run(done.returncode, done.stderr, Path(output), read_csv(Path(output)) if written else [],
               read_summary(Path(output)) if written else {})


def print_table(*rows):
    """A markdown table; the first row is the head."""
    for number, row in enumerate(rows):
        print("| " + " | ".join(map(str, row)) + " |")
        if number == 0:
            print("|" + "---|" * len(row))
    print(flush=True)
