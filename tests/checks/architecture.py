# SPDX-License-Identifier: GPL-3.0-or-later
"""Hold the includes to the rooms and wings of doc/architecture.md.

Usage: python3 tests/checks/architecture.py [--draw]
Rooms are the folders of include/exemplar and source; the folders in a room are its wings. The tables of doc/architecture.md
list both from the top of the house to its ground. A file includes headers of its own folder and of folders below it alone,
headers of a folder do not include each other in a circle, kernels include no deal.II, and no file is longer than
max_n_lines. Unit tests lie in folders with the names of rooms. Fails with what is out of order; with --draw it writes the pictures by Graphviz: of the house, and of
each room that has wings.
"""
import argparse
import re
import subprocess
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
PICTURES = TOP / "doc/figures"
max_n_lines = 600


def folders_of_page():
    """Rooms, and wings as room/wing, from the ground up: a room with wings is above them."""
    page = (TOP / "doc/architecture.md").read_text()
    table = page.split("## Rooms")[1].split("\n## ")[0]
    names = re.findall(r"^\| `([\w/]+)` \|", table, re.M)[::-1]
    rooms = [name for name in names if "/" not in name]
    return [folder for room in rooms for folder in [*(name for name in names if name.startswith(room + "/")), room]]


def room_of(folder):
    return folder.split("/")[0]


def files_of(folder):
    return sorted([*(TOP / "include/exemplar" / folder).glob("*.h*"), *(TOP / "source" / folder).glob("*.cc"),
                   *(TOP / "source" / folder).glob("*.py")])


def includes_of(file):
    """(folder, header) of each include of ours."""
    return re.findall(r"#include <exemplar/([\w/]+)/(\w+)\.h>", file.read_text())


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


def arrows(folders):
    """{(from, to)} between different folders."""
    return {(folder, other) for folder in folders for file in files_of(folder) for other, _ in includes_of(file)
            if other != folder}


def arrows_of_rooms(folders):
    """The same between rooms, where a wing is a part of its room."""
    return {(room_of(a), room_of(b)) for a, b in arrows(folders) if room_of(a) != room_of(b)}


def strange_folders(folders):
    for folder in [*TOP.glob("include/exemplar/**/"), *TOP.glob("source/**/"), *TOP.glob("tests/unit/*/")]:
        name = re.sub("^(include/exemplar|source|tests/unit)/?", "", str(folder.relative_to(TOP)))
        if name and name not in folders:
            yield f"{folder.relative_to(TOP)}: no room of doc/architecture.md"


def failures(folders):
    yield from strange_folders(folders)
    floor = {folder: number for number, folder in enumerate(folders)}
    for folder in folders:
        headers = {}
        for file in files_of(folder):
            if (n := len(file.read_text().splitlines())) > max_n_lines:
                yield f"{file.relative_to(TOP)} has {n} lines, more than {max_n_lines}: cut it"
            for other, header in includes_of(file):
                if other not in floor or floor[other] > floor[folder]:
                    yield f"{file.relative_to(TOP)} includes {other}/{header}.h, which is nothing below {folder}"
                elif other == folder and file.suffix == ".h":
                    headers.setdefault(file.stem, []).append(header)
            if folder == "kernels" and "#include <deal.II" in file.read_text():
                yield f"{file.relative_to(TOP)}: a kernel includes deal.II"
        if header := circle_among(headers):
            yield f"{folder}/{header}.h includes itself by way of others"


def above(folder, edges):
    """All folders that `folder` reaches, directly or not."""
    reached, todo = set(), [folder]
    while todo:
        for a, b in edges:
            if a == todo[-1] and b not in reached:
                reached.add(b)
                todo.insert(0, b)
        todo.pop()
    return reached


def drawing(labels, edges):
    """Boxes {name: label} and their arrows in Graphviz's language; arrows that others imply are pale."""
    lines = ["// What includes what; drawn by tests/checks/architecture.py", "digraph rooms {",
             '  rankdir = TB; node [shape = box, style = rounded, fontname = "sans-serif"];']
    lines += [f'  "{name}" [label = "{label}"];' for name, label in labels.items()]
    for a, b in sorted(edges):
        implied = any(b in above(c, edges) for x, c in edges if x == a and c != b)
        lines.append(f'  "{a}" -> "{b}"' + (' [color = "gray75"];' if implied else ";"))
    return "\n".join([*lines, "}", ""])


def pictures(folders):
    """{name: drawing} of the house and of each room that has wings."""
    wings = {room: [f for f in folders if f.startswith(room + "/")] for room in folders if "/" not in room}
    n_files = {room: sum(len(files_of(f)) for f in [room, *inside]) for room, inside in wings.items()}
    labels = {room: f"{room}\\n{n_files[room]} files" + "".join(f"\\n· {wing.split('/')[1]}" for wing in inside[::-1])
              for room, inside in reversed(wings.items())}
    yield "rooms", drawing(labels, arrows_of_rooms(folders))
    for room, inside in wings.items():
        if inside:
            labels = {wing: f"{wing}\\n" + "\\n".join(sorted({file.stem for file in files_of(wing)})) for wing in inside[::-1]}
            yield f"rooms_{room}", drawing(labels, {(a, b) for a, b in arrows(folders) if a in inside and b in inside})


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--draw", action="store_true", help="write the pictures anew")
    arguments = parser.parse_args()
    folders = folders_of_page()
    found = list(failures(folders))
    for name, text in pictures(folders):
        file = PICTURES / f"{name}.dot"
        if arguments.draw:
            file.write_text(text)
            subprocess.run(["dot", "-Tsvg", str(file), "-o", str(file.with_suffix(".svg"))], check=True)
        elif not file.exists() or file.read_text() != text:
            found.append(f"{file.relative_to(TOP)} is not of these sources: run python3 tests/checks/architecture.py --draw")
    n_rooms = sum("/" not in folder for folder in folders)
    print("\n".join(found) or f"{sum(len(files_of(f)) for f in folders)} files in {n_rooms} rooms and "
          f"{len(folders) - n_rooms} wings, {len(arrows_of_rooms(folders))} arrows between rooms: in order")
    sys.exit(bool(found))


if __name__ == "__main__":
    main()
