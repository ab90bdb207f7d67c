# SPDX-License-Identifier: GPL-3.0-or-later
"""Hold the includes to the rooms of doc/architecture.md.

Usage: python3 tests/checks/architecture.py [--draw]
Rooms are the folders of include/exemplar and source. The table of doc/architecture.md lists them from the top of the
house to its ground. A file includes headers of its own room and of rooms below it alone, headers of a room do not
include each other in a circle, and kernels include no deal.II. Unit tests lie in folders of the same names. Fails with
what is out of order; with --draw it writes the picture of the rooms and their arrows, by Graphviz.
"""
import argparse
import re
import subprocess
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
PICTURE = TOP / "doc/figures/rooms.dot"


def rooms_of_page():
    """From the ground up."""
    page = (TOP / "doc/architecture.md").read_text()
    table = page.split("## Rooms")[1].split("\n## ")[0]
    return re.findall(r"^\| `(\w+)` \|", table, re.M)[::-1]


def files_of(room):
    return sorted([*(TOP / "include/exemplar" / room).glob("*.h*"), *(TOP / "source" / room).glob("*.cc")])


def includes_of(file):
    """(room, header) of each include of ours."""
    return re.findall(r"#include <exemplar/(\w+)/(\w+)\.h>", file.read_text())


def circle_among(headers):
    """A header that includes itself by way of others, or None; {header: headers that it includes}."""
    state = {}

    def visit(header):
        state[header] = "open"
        for other in headers.get(header, []):
            if state.get(other) == "open" or (other not in state and visit(other)):
                return True
        state[header] = "done"
        return False

    return next((header for header in headers if header not in state and visit(header)), None)


def arrows(rooms):
    """{(from, to)} between different rooms."""
    return {(room, other) for room in rooms for file in files_of(room) for other, _ in includes_of(file)
            if other != room}


def failures(rooms):
    floor = {room: number for number, room in enumerate(rooms)}
    for folder in [*TOP.glob("include/exemplar/*"), *TOP.glob("source/*"), *TOP.glob("tests/unit/*/")]:
        if folder.is_file() and folder.suffix != ".h" or folder.is_dir() and folder.name not in floor:
            yield f"{folder.relative_to(TOP)}: no room of doc/architecture.md"
    for room in rooms:
        headers = {}
        for file in files_of(room):
            text = file.read_text()
            for other, header in includes_of(file):
                if other not in floor or floor[other] > floor[room]:
                    yield f"{file.relative_to(TOP)} includes {other}/{header}.h, which is no room below {room}"
                elif other == room and file.suffix == ".h":
                    headers.setdefault(file.stem, []).append(header)
            if room == "kernels" and "#include <deal.II" in text:
                yield f"{file.relative_to(TOP)}: a kernel includes deal.II"
        if header := circle_among(headers):
            yield f"{room}/{header}.h includes itself by way of others"


def above(room, edges):
    """All rooms that `room` reaches, directly or not."""
    reached, todo = set(), [room]
    while todo:
        for a, b in edges:
            if a == todo[-1] and b not in reached:
                reached.add(b)
                todo.insert(0, b)
        todo.pop()
    return reached


def drawing(rooms):
    """The house in Graphviz's language, each arrow of it; those that others imply are pale."""
    edges = arrows(rooms)
    lines = ["// Rooms and what includes what; drawn by tests/checks/architecture.py", "digraph rooms {",
             '  rankdir = TB; node [shape = box, style = rounded, fontname = "sans-serif"];']
    for room in rooms[::-1]:
        lines.append(f'  {room} [label = "{room}\\n{len(files_of(room))} files"];')
    for a, b in sorted(edges):
        implied = any(b in above(c, edges) for x, c in edges if x == a and c != b)
        lines.append(f"  {a} -> {b}" + (' [color = "gray75"];' if implied else ";"))
    return "\n".join([*lines, "}", ""])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--draw", action="store_true", help="write the picture anew")
    arguments = parser.parse_args()
    rooms = rooms_of_page()
    found = list(failures(rooms))
    if arguments.draw:
        PICTURE.write_text(drawing(rooms))
        subprocess.run(["dot", "-Tsvg", str(PICTURE), "-o", str(PICTURE.with_suffix(".svg"))], check=True)
    elif not PICTURE.exists() or PICTURE.read_text() != drawing(rooms):
        found.append("doc/figures/rooms.dot is not of these sources: run python3 tests/checks/architecture.py --draw")
    n_files = sum(len(files_of(room)) for room in rooms)
    print("\n".join(found) or f"{n_files} files in {len(rooms)} rooms, {len(arrows(rooms))} arrows: in order")
    sys.exit(bool(found))


if __name__ == "__main__":
    main()
