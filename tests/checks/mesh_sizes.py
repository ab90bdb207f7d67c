# SPDX-License-Identifier: GPL-3.0-or-later
"""The animals' .geo models still give the paper's mesh sizes within 2 %, as do the committed meshes.

Usage: python3 tests/checks/mesh_sizes.py      (EXEMPLAR is the program)
"""
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
SIZES = {"cat": (10212, 2860), "horse": (6203, 2001)}


def sizes(mesh, folder):
    """Cells and nodes as the program reads or makes them; a fresh cache, so that gmsh really runs."""
    scene = Path(folder, "scene.prm")
    scene.write_text(f"set Scene = dynamic\nsubsection Mesh\n set File = {mesh}\nend\n")
    program = os.environ.get("EXEMPLAR", str(TOP / "build/release/exemplar"))
    result = subprocess.run([program, "--validate", scene], env={**os.environ, "XDG_CACHE_HOME": folder},
                            capture_output=True, text=True)
    found = re.search(r"(\d+) cells, (\d+) nodes", result.stdout)
    if not found:
        sys.exit(result.stdout + result.stderr)
    return int(found[1]), int(found[2])


def main():
    failed = False
    for animal, wanted in SIZES.items():
        for suffix in (".geo", ".msh"):
            with tempfile.TemporaryDirectory() as folder:
                found = sizes(TOP / "meshes" / (animal + suffix), folder)
            good = all(abs(f - w) <= 0.02 * w for f, w in zip(found, wanted))
            failed = failed or not good
            print(f"{animal}{suffix}: {found[0]} cells, {found[1]} nodes; wanted {wanted[0]}, {wanted[1]}"
                  f" within 2 %: {'good' if good else 'FAILED'}")
    sys.exit(failed)


if __name__ == "__main__":
    main()
