#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Comments have a subject: hardly one in a hundred begins with a word that leans on the comment above it.

    python3 tests/checks/comments.py            fails, with a list, if there are more
    python3 tests/checks/comments.py --list     lists them in any case
    python3 tests/checks/comments.py --list include/exemplar/body source/body    those of some folders
"""

import re
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
LEANING = re.compile(r"(Of|That|Those|The same|And|By)\b")
GREATEST_SHARE = 0.01
COMMENT = re.compile(r"^(?P<code>[^/\"]*)//+<?\s*(?P<text>.*)$")


def comments_of(text):
    """Number of the first line, and words, of each comment: lines that follow each other are one."""
    found, is_open = [], False
    for number, line in enumerate(text.splitlines(), 1):
        match = COMMENT.match(line)
        begins = match is not None and (match["code"].strip() != "" or "//<" in line)
        if match is None:
            is_open = False
        elif begins or not is_open:
            found.append((number, match["text"]))
            is_open = True
        else:
            found[-1] = (found[-1][0], found[-1][1] + " " + match["text"])
    return found


def files_of(folders):
    return sorted(file for folder in folders for file in Path(folder).rglob("*") if file.suffix in (".h", ".cc", ".in"))


def main(arguments):
    folders = [argument for argument in arguments if argument != "--list"] or [TOP / "include", TOP / "source"]
    n, leaning = 0, []
    for file in files_of(folders):
        for number, words in comments_of(file.read_text(errors="replace")):
            n += 1
            if LEANING.match(words):
                leaning.append(f"{file}:{number}: {words[:100]}")
    is_too_many = len(leaning) > GREATEST_SHARE * n
    if is_too_many or "--list" in arguments:
        print("\n".join(leaning))
    print(f"{len(leaning)} of {n} comments lean on the one above, {100 * len(leaning) / n:.1f} %")
    return 1 if is_too_many else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
