# SPDX-License-Identifier: GPL-3.0-or-later
"""Hold the sources to the table of floors in doc/architecture.md.

Usage: python3 tests/checks/architecture.py
Fails if a file belongs to no unit of the table, includes a unit that is not on a lower floor,
if a unit has no files, or if a kernel header includes deal.II.
"""
import re
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
KERNELS = ["matrix3", "lame", "polar_decomposition", "corotational", "corotational_consistent", "quadratic_cell", "linear",
           "green", "cell_model", "simd", "cell_kernels"]


def floors():
    table = (TOP / "doc/architecture.md").read_text()
    return {unit: int(floor) for floor, unit in re.findall(r"^\| (\d+) \| `(\w+)` \|", table, re.M)}


def unit_of(name, units):
    """The longest unit that begins the file's name, at a word."""
    fitting = [u for u in units if name == u or name.startswith(u + "_")]
    aliases = {"msh_writer": "msh_file", "msh_element_kinds": "msh_file"}
    return aliases.get(name) or (max(fitting, key=len) if fitting else None)


def main():
    units = floors()
    files = sorted([*TOP.glob("include/exemplar/*.h*"), *TOP.glob("source/*.cc")])
    failures, seen = [], set()
    for file in files:
        name = file.name.split(".")[0]
        unit = unit_of(name, units)
        seen.add(unit)
        if unit is None:
            failures.append(f"{file.name}: no unit of doc/architecture.md")
            continue
        text = file.read_text()
        for included in re.findall(r"#include <exemplar/(\w+)\.h>", text):
            other = unit_of(included, units)
            if other != unit and (other is None or units[other] >= units[unit]):
                failures.append(f"{file.name} (floor {units[unit]}) includes {included}.h (floor {units.get(other)})")
        if unit in KERNELS and re.search(r"#include <deal\.II", text):
            failures.append(f"{file.name}: a kernel includes deal.II")
    failures += [f"unit {unit} has no files" for unit in units if unit not in seen]
    print("\n".join(failures) or f"{len(files)} files in {len(units)} units: in order")
    sys.exit(bool(failures))


if __name__ == "__main__":
    main()
