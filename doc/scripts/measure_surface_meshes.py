# SPDX-License-Identifier: GPL-3.0-or-later
"""How well `exemplar mesh` meets the number of cells that it is asked for, and what a dense surface does to the mesh.

Usage: python3 doc/scripts/measure_surface_meshes.py DIRECTORY [sizes|dense]     (a quarter of an hour of one core; numpy, gmsh)
`sizes`: twelve surfaces, made in DIRECTORY, with 3,000 to 100,000 cells. `dense`: the horse's skin with each triangle divided at the
middles of its edges, once and twice, and 10,000 cells. Environment: EXEMPLAR, the program.
"""
import csv
import os
import subprocess
import sys
import time
from pathlib import Path

from scene_runs import PROGRAM, TOP, print_table
from surface_bar import read_obj
from surfaces import divided, write_obj

SIZES = 3000, 10000, 30000, 100000
PLAIN = "sphere", "torus", "cat", "horse", "creature", "mouth"
CROSSING = "eyes", "face", "narrow_mouth"
HEADER = ("surface", "triangles", "asked", "cells", "over asked", "least, median angle", "slivers", "s", "what is said")


def call(*words):
    subprocess.run([str(word) for word in words], check=True, stdout=subprocess.DEVNULL)


def make_surfaces(directory):
    """(name, file, its poses) of all twelve."""
    python = sys.executable
    result = []
    for name in PLAIN:
        call(python, TOP / "tests/scenes/surfaces.py", name, directory / f"{name}.obj")
        result.append((name, directory / f"{name}.obj", []))
    call(python, TOP / "meshes/surfaces/creature.py", directory / "limbs")
    result.append(("creature's skin", directory / "limbs/rest.obj", []))
    for name in "cat", "horse":
        result.append((f"{name}'s skin", make_skin(directory, name), []))
    for name in CROSSING:
        call(python, TOP / "meshes/surfaces/crossing.py", directory, name)
        result.append((name, directory / name / "rest.obj", sorted((directory / name).glob("pose_*.obj"))))
    return result


def make_skin(directory, name):
    call("gmsh", "-2", TOP / f"meshes/{name}.geo", "-setnumber", "hs", ".0195", "-setnumber", "hi", ".0195", "-o", directory / f"{name}.msh")
    call(sys.executable, TOP / "meshes/surfaces/animals.py", name, directory / f"{name}.msh", directory / f"{name}_skin")
    return directory / f"{name}_skin/rest.obj"


def measure(name, surface, poses, cells):
    """A row of the table."""
    mesh = surface.with_name(surface.stem + "_body.msh")
    begin = time.monotonic()
    run = subprocess.run([os.environ.get("EXEMPLAR", PROGRAM), "mesh", "--surface", surface, "--cells", str(cells), "--output", mesh,
                          *(["--poses", *poses] if poses else [])], capture_output=True, text=True)
    seconds = time.monotonic() - begin
    n_triangles = sum(line.startswith("f ") for line in open(surface))
    if run.returncode:
        return (name, n_triangles, cells, "", "", "", "", f"{seconds:.1f}", run.stderr.strip())
    table = dict(list(csv.reader(open(mesh.with_suffix(".csv"))))[1:])
    said = " ".join(line for line in run.stdout.splitlines() if line.startswith("The mesh has"))
    return (name, n_triangles, cells, table["cells"], f"{int(table['cells']) / cells:.2f}",
            f"{table['angle_smallest']}°, {table['angle_median']}°", table["slivers"], f"{seconds:.1f}", said)


def split(surface):
    """The surface with each triangle divided in four, in a file beside it."""
    vertices, words = read_obj(surface)
    triangles = [[int(corner.split("/")[0]) - 1 for corner in line.split()[1:]] for line in words if line.startswith("f ")]
    file = surface.with_name(surface.stem + "_split.obj")
    write_obj(file, *divided(vertices, triangles)[:2])
    return file


def main():
    directory = Path(sys.argv[1])
    directory.mkdir(parents=True, exist_ok=True)
    parts = sys.argv[2:] or ["sizes", "dense"]
    rows = [HEADER]
    if "sizes" in parts:
        rows += [measure(*surface, cells) for surface in make_surfaces(directory) for cells in SIZES]
    if "dense" in parts:
        once = split(skin := make_skin(directory, "horse"))
        rows += [measure(name, surface, [], 10000) for name, surface in (("horse's skin", skin), ("split", once), ("split twice", split(once)))]
    print_table(*rows)


if __name__ == "__main__":
    main()
