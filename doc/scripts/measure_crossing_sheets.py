# SPDX-License-Identifier: GPL-3.0-or-later
"""Sheets that cross at rest and part in poses: how near meshes of `exemplar mesh --poses` come to all poses.

Usage: python3 doc/scripts/measure_crossing_sheets.py EXEMPLAR DIRECTORY [CELLS] [NAME]...
The surfaces are those of meshes/surfaces/crossing.py, which are written to DIRECTORY. A line each: cells, angles at rest, distance
of the surface from the mesh [% of the diagonal], and the worst of its poses: inverted cells, error of a vertex [%], longest edge
over its own; and the same of rest itself as a pose of the first pose.
"""
import csv
import subprocess
import sys
import time
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP / "meshes/surfaces"))
import crossing  # noqa: E402


def measure(exemplar, directory, cells):
    poses = sorted(directory.glob("pose_*.obj"))
    begin = time.time()
    mesh = subprocess.run([exemplar, "mesh", "--surface", directory / "rest.obj", "--cells", cells, "--output",
                           directory / "body.msh", "--poses", *poses], capture_output=True, text=True)
    seconds = time.time() - begin
    if mesh.returncode:
        return f"{directory.name}: {mesh.stderr.strip()}"
    (directory / "mesh.txt").write_text(mesh.stdout)
    pose = subprocess.run([exemplar, "pose", "--mesh", directory / "body.msh", "--rest", directory / "rest.obj", "--output",
                           directory / "poses", "--pose", *poses], capture_output=True, text=True)
    if pose.returncode:
        return f"{directory.name}: {pose.stderr.strip()}"
    table = dict(list(csv.reader(open(directory / "body.csv")))[1:])
    rows = list(csv.DictReader(open(directory / "poses/poses.csv")))

    def worst(column):
        return max(float(row[column]) for row in rows)
    return (f"| {directory.name} | {table['cells']} | {table['angle_smallest']}, {table['angle_median']} | {table['slivers']} "
            f"| {table['surface_to_mesh_max']} | {worst('inverted_cells'):.0f} | {worst('surface_error_max'):.2f} "
            f"| {worst('surface_error_mean'):.3f} | {worst('longest_edge'):.2f} | {seconds:.1f} | {worst('seconds'):.1f} |")


def main():
    exemplar, directory = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    names = sys.argv[4:] or list(crossing.SKINS)
    subprocess.run([sys.executable, TOP / "meshes/surfaces/crossing.py", directory, *names], check=True)
    for name in names:
        print(measure(exemplar, directory / name, sys.argv[3] if len(sys.argv) > 3 else "10000"), flush=True)


if __name__ == "__main__":
    main()
