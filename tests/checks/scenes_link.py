#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The build of ./demo.sh (EXEMPLAR_SCENES_ONLY) links: what its objects ask for is in none of those that it leaves out, but for
what *_absent.cc stand in for.

Usage: scenes_link.py BUILD     a whole build, whose objects are read by nm
"""
import pathlib
import re
import subprocess
import sys

SOURCE = pathlib.Path(__file__).resolve().parents[2]
OBJECTS = pathlib.Path(sys.argv[1]) / "CMakeFiles"
STAND_INS = ["run/inputs/surface_inputs_absent.cc", "run/adjoint/functional_absent.cc"]


def is_left_out(path):
    return path.parent.parent.name in ("exemplar_surfaces.dir", "exemplar_gradients.dir") or re.match(
        r"cgal_(geometry|remeshing|repair|wrap)\.", path.name)


def symbols(objects, kind):
    """Demangled names, without arguments, of the functions and data that some objects define or ask for."""
    listed = subprocess.run(["nm", "-C", kind, *objects], check=True, capture_output=True, text=True).stdout
    found = re.findall(r"^[0-9a-f ]* [TDBRU] (Exemplar::.*)$", listed, re.M)
    return {re.split(r"[([]", name.removeprefix("Exemplar::"))[0] for name in found}


def main():
    objects = [path for part in ("numerics", "scenes", "surfaces", "gradients", "cgal")
               for path in OBJECTS.glob(f"exemplar_{part}.dir/**/*.o")]
    left_out = [path for path in objects if is_left_out(path)]
    kept = [path for path in objects if not is_left_out(path)]
    if not left_out or not kept:
        sys.exit(f"There are no objects of a whole build in {OBJECTS}.")
    stand_ins = set(re.findall(r"\b([\w:~]+)\(", "".join((SOURCE / "source" / file).read_text() for file in STAND_INS)))
    missing = symbols(kept, "--undefined-only") & symbols(left_out, "--defined-only")
    missing -= symbols(kept, "--defined-only") | stand_ins
    for name in sorted(missing):
        print(f"What ./demo.sh builds asks for Exemplar::{name}, which it leaves out.")
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main())
