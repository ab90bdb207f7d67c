#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""How a stack of boxes depends on the time step: three cubes of 0.2 m (E = 1e6 Pa, 5 mm apart, the middle one 2 cm aside) fall onto each other.

    python3 doc/scripts/measure_stack.py --exemplar build/release/exemplar

Prints the table of doc/contact.md: for each step and scheme the greatest change of a node from the run with the next greater step, as part of
the height of the stack, and how far the upper cube tilts. Three minutes."""

import argparse
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tests" / "scenes"))
from exemplar_runner import nodes_of, prm, read_vtu
from piece_boxes import Box, write_boxes

SIDE, GAP, SHIFT, LEVELS = 0.2, 0.005, 0.02, 3
STEPS = (0.008, 0.004, 0.002, 0.001, 0.0005)
SCHEMES = {"implicit euler": {}, "implicit euler, damped": {"Time/Stiffness damping": "0.002"}, "bdf2": {"Time/Scheme": "bdf2"}}
SCENE = {"Scene": "dynamic", "Mesh/File": "pieces.msh", "Material/Young's modulus": "1e6", "Material/Poisson's ratio": "0.3",
         "Material/Density": "1000", "Contact/Bodies": "true", "Contact/Friction": "0.5", "Loads/Gravity": "0, 0, -9.81",
         "Handles/Names": "base", "Handles/base/Select": "box -1 -1 -1  9 9 0.001", "Time/End": "0.5",
         "Solver/Step tolerance": "1e-6", "Solver/Tolerance": "1e-9"}


def cube(level):
    low, aside = level * (SIDE + GAP), SHIFT * (level % 2)
    return Box((aside, 0, low), (SIDE + aside, SIDE, low + SIDE), (2, 2, 2))


def tilt(rest, now):
    """By how much the best rotation turns the vertical [rad]."""
    u, _, v = np.linalg.svd((rest - rest.mean(0)).T @ (now - now.mean(0)))
    return np.arccos(min(1, (v.T @ u.T)[2, 2]))


def run(program, directory, scheme, step):
    """Places of the nodes at the end, and the greatest tilt of the upper cube in the frames."""
    places, _, owners = write_boxes(directory / "pieces.msh", *map(cube, range(LEVELS)))
    upper = np.array(owners) == LEVELS - 1
    output = directory / f"{scheme}_{step}"
    scene = {**SCENE, **SCHEMES[scheme], "Time/Step": str(step), "Output/Every": str(round(0.05 / step)), "Output/Directory": str(output)}
    (directory / "scene.prm").write_text(prm(scene))
    subprocess.run([program, "scene.prm", "--quiet"], cwd=directory, check=True)
    end = nodes_of(output / "final.msh")
    tilts = []
    for file in output.glob("frame_*.vtu"):
        arrays, n, _ = read_vtu(file)
        tilts.append(tilt(np.array(places)[upper], np.array(arrays["Points", "Points"]).reshape(n, 3)[upper]))
    return np.array([end[i + 1] for i in range(len(end))]), max(tilts)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--exemplar", default="build/release/exemplar")
    program = str(pathlib.Path(parser.parse_args().exemplar).resolve())
    print("| Step | " + " | ".join(f"{scheme}: change; tilt" for scheme in SCHEMES) + " |\n" + "| --- " * (len(SCHEMES) + 1) + "|")
    before = {}
    with tempfile.TemporaryDirectory() as name:
        for step in STEPS:
            cells = [f"{step:g}"]
            for scheme in SCHEMES:
                end, most = run(program, pathlib.Path(name), scheme, step)
                change = f"{np.abs(end - before[scheme]).max() / (LEVELS * SIDE):.1e}" if scheme in before else "–"
                cells.append(f"{change}; {np.degrees(most):.2f}°")
                before[scheme] = end
            print("| " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
