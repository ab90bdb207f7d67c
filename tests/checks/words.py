# SPDX-License-Identifier: GPL-3.0-or-later
"""Every class, struct and enum of include/exemplar is explained: by a `///` comment directly above its definition, or by a row
of a table, or an item of a list, of doc/glossary.md or doc/architecture.md that names it in backticks. Lists those that are not.

Usage: python3 tests/checks/words.py
"""
import re
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
DEFINITION = re.compile(r"^ *(?:class|struct|enum class|enum) (\w+)(?: final)?(?: *:[^;{]*)?\s*(?:\{|$)")


def rows():
    """All words in backticks of the tables and lists."""
    pages = "\n".join((TOP / "doc" / page).read_text() for page in ("glossary.md", "architecture.md"))
    return {name for row in re.findall(r"^(?:\||- ).*", pages, re.MULTILINE) for name in re.findall(r"`(\w+)`", row)}


def undocumented(lines):
    """(line, name) of types without a comment above them, which a template's parameters may part from them."""
    for i, line in enumerate(lines):
        found = DEFINITION.match(line)
        if found:
            above = i - 1
            while above > 0 and re.match(r" *(template|>|typename|class \w+,)", lines[above]):
                above -= 1
            if not lines[above].lstrip().startswith("///"):
                yield i + 1, found[1]


def main():
    explained = rows()
    faults = [f"{file.relative_to(TOP)}:{line}: {name}" for file in sorted((TOP / "include/exemplar").rglob("*.h"))
              for line, name in undocumented(file.read_text().splitlines()) if name not in explained]
    print("\n".join(faults) or "all types are explained")
    if faults:
        sys.exit(f"{len(faults)} types have neither a /// comment above them nor a row in doc/glossary.md or doc/architecture.md")


main()
