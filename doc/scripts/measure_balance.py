# SPDX-License-Identifier: GPL-3.0-or-later
"""Print how far the rest pose of a balanced body moves: the cat on its four paws under its weight, Young's moduli of three decades.

Usage: python3 doc/scripts/measure_balance.py [BINARY]     (some minutes of one core)
"""
import math
import sys
import tempfile
from pathlib import Path

from scene_runs import PROGRAM, TOP, print_table, read_msh, run_scene, write_scene

MESH = TOP / "meshes/cat.msh"
SCENE = {"Mesh/File": MESH, "Handles/Names": "paws", "Handles/paws/Select": "box -0.6 -0.2 -0.01 0.5 0.2 0.08",
         "Loads/Gravity": "0, 0, -9.81", "Loads/Balanced": "true", "Time/Increments": None}
SCENES = {"static": {"Scene": "static", "Time/Increments": "1"},
          "dynamic, 100 steps": {"Scene": "dynamic", "Time/Step": "0.02", "Time/End": "2", "Time/Increments": None}}
EXAMPLES = {"Examples/Poses": ", ".join(str(TOP / f"meshes/poses/cat_{name}.msh") for name in ("arch", "paw", "rear", "turn"))}
CELLS = {"P1, cells": {"Model/Dilatation": "cells"}, "P1, patches": {"Model/Dilatation": "patches"}, "P2": {"Model/Element": "P2"}}


def points(file):
    return list(read_msh(file).nodes.values())


def greatest_move(run, rest):
    moved = points(run.output / "final.msh")
    size = math.dist([min(x) for x in zip(*rest)], [max(x) for x in zip(*rest)])
    return max(math.dist(a, b) for a, b in zip(moved, rest)) / size


def main():
    program = Path(sys.argv[1]) if len(sys.argv) > 1 else PROGRAM
    rest = points(MESH)
    rows = [("scene", "cells", "E", "examples", "greatest move / size", "factorisations in steps", "warned")]
    with tempfile.TemporaryDirectory() as directory:
        for kind, scene in SCENES.items():
            for name, cells in CELLS.items():
                for modulus in 1e6, 1e7, 1e8, 1e9:
                    for examples in {}, EXAMPLES:
                        keys = {**SCENE, **scene, **cells, **examples, "Material/Young's modulus": modulus}
                        file = write_scene(Path(directory) / "scene.prm", {k: v for k, v in keys.items() if v is not None})
                        run = run_scene(program, file, Path(directory) / "output")
                        stable = [w for w in run.summary["warnings"] if "Balanced" in str(w)]
                        rows.append((kind, name, f"{modulus:.0e}", "four" if examples else "none", f"{greatest_move(run, rest):.1e}",
                                     run.summary["factorizations"], "unstable" if stable else ""))
                        print(rows[-1], stable, flush=True, file=sys.stderr)
    print_table(*rows)


if __name__ == "__main__":
    main()
