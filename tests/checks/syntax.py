# SPDX-License-Identifier: GPL-3.0-or-later
"""Hold all files to a second compiler: Clang reads what GCC has compiled, and compiles nothing.

Usage: python3 tests/checks/syntax.py BUILD_DIRECTORY
Takes the commands of compile_commands.json there, without the headers that GCC has precompiled and without what Clang does not
know. Status 77 where there is no Clang.
"""
import concurrent.futures
import json
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

# GCC's own options, beside its warnings
OF_GCC = ("-fno-unroll-all-loops", "-funroll-all-loops", "-mmove-max=256", "-mstore-max=256", "-Winvalid-pch", "-c")


def arguments_of(command):
    """What Clang is given for a command of GCC."""
    words = shlex.split(command)
    compiler = next(i for i, word in enumerate(words) if "++" in Path(word).name)
    kept, words = [], iter(words[compiler + 1:])
    for word in words:
        if word in ("-o", "-include"):
            next(words)
        elif word not in OF_GCC and not word.startswith("-Wno-"):
            kept.append(word)
    return ["clang++", *kept, "-fsyntax-only", "-w"]


def errors_of(entry):
    done = subprocess.run(arguments_of(entry["command"]), cwd=entry["directory"], text=True, capture_output=True)
    return done.stderr if done.returncode else ""


def main():
    if shutil.which("clang++") is None:
        print("Clang is not installed.")
        return 77
    entries = [entry for entry in json.loads(Path(sys.argv[1], "compile_commands.json").read_text())
               if not entry["file"].endswith(("cmake_pch.hxx.cxx", "headers.cc"))]
    with concurrent.futures.ThreadPoolExecutor(max_workers=2) as pool:
        errors = [text for text in pool.map(errors_of, entries) if text]
    print("\n".join(errors))
    print(f"{len(entries)} units, {len(errors)} of them with errors")
    return 1 if errors or not entries else 0


if __name__ == "__main__":
    sys.exit(main())
