# SPDX-License-Identifier: GPL-3.0-or-later
"""What frames of a surface cost, and the way of a pose through the program: from .obj to .obj.

Usage: /usr/bin/python3 doc/scripts/measure_surface_formats.py [--cells N] [--program P]

Makes the creature of meshes/surfaces (needs numpy), a mesh of N cells inside it and an example of its first pose; prints, for
each format, seconds and bytes a frame in one thread, and how far the surface of a run that is only that example (importance 1,
weight 1) is from the pose.
"""
import argparse
import csv
import json
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

REPOSITORY = Path(__file__).resolve().parents[2]
SCENE = """set Scene = {scene}
subsection Mesh
  set File = body.msh
  set Surface = creature/rest.obj
end
subsection Examples
  set Poses = poses/pose_1.msh
  {examples}
end
subsection Time
  {time}
end
"""


def read_obj(file):
    return np.array([line.split()[1:4] for line in open(file) if line.startswith("v ")], float)


def aligned(moved, to):
    """Without the rigid motion that brings them closest (Kabsch)."""
    a, b = moved - moved.mean(0), to - to.mean(0)
    u, _, vt = np.linalg.svd(a.T @ b)
    flip = np.diag([1, 1, np.sign(np.linalg.det(u @ vt))])
    return a @ u @ flip @ vt + to.mean(0)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--cells", default="10000")
    parser.add_argument("--program", type=os.path.abspath, default=REPOSITORY / "build/release/exemplar")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as holder:
        directory = Path(holder)

        def call(*arguments):
            subprocess.run([str(word) for word in arguments], cwd=directory, check=True, stdout=subprocess.DEVNULL)
        call(sys.executable, REPOSITORY / "meshes/surfaces/creature.py", "creature")
        call(options.program, "mesh", "--surface", "creature/rest.obj", "--cells", options.cells, "--output", "body.msh")
        call(options.program, "pose", "--mesh", "body.msh", "--rest", "creature/rest.obj", "--pose", "creature/pose_1.obj",
             "--output", "poses")
        rest, pose = read_obj(directory / "creature/rest.obj"), read_obj(directory / "creature/pose_1.obj")
        diagonal = np.linalg.norm(rest.max(0) - rest.min(0))

        (directory / "pose.prm").write_text(SCENE.format(scene="interpolation", time="set Increments = 4",
                                                         examples="set Prescribed weights = 1-t; t"))
        call(options.program, "pose.prm", "--set", "Output/Formats=obj", "--output", "round")
        out = read_obj(directory / "round/frame_0004.obj")
        error = np.linalg.norm(aligned(out, pose) - pose, axis=1) / diagonal * 100
        at_rest = np.abs(read_obj(directory / "round/frame_0000.obj") - rest).max() / diagonal
        with open(directory / "poses/poses.csv") as file:
            reported = next(csv.DictReader(file))
        print(f"{len(rest)} vertices; pose to pose: mean {error.mean():.3g} %, max {error.max():.3g} % of the diagonal; "
              f"poses.csv: mean {float(reported['surface_error_mean']):.3g} %, max {float(reported['surface_error_max']):.3g} %; "
              f"at rest {at_rest:.2g} of the size")

        (directory / "run.prm").write_text(SCENE.format(scene="dynamic", time="set Step = 0.01\n set End = 0.2",
                                                        examples="set Importance = 0.5"))
        for formats in ("vtu", "obj", "ply", "mdd", "pc2", "usda"):
            call(options.program, "run.prm", "--set", f"Output/Formats={formats}", "--threads", "1", "--output", "out")
            with open(directory / "out/statistics.csv") as file:
                rows = list(csv.DictReader(file))
            seconds = statistics.median(float(row["seconds_output"]) for row in rows[1:])
            read = json.loads((directory / "out/summary.json").read_text())["seconds"]["read"]
            size = statistics.median(file.stat().st_size for file in (directory / "out").glob("frame_*"))
            print(f"{formats:5} {1e3 * seconds:6.1f} ms and {size / 1e3:7.0f} kB a frame; {read:.2f} s before the first step")


if __name__ == "__main__":
    main()
