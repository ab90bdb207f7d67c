# SPDX-License-Identifier: GPL-3.0-or-later
"""Hold all files to a second compiler: Clang reads what GCC has compiled, and compiles nothing.

Usage: python3 tests/checks/syntax.py BUILD_DIRECTORY
Takes the commands of compile_commands.json there, without what Clang does not know. The headers that GCC has precompiled Clang
precompiles for itself. Status 77 where there is no Clang.
"""
import concurrent.futures
import json
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

# GCC's own options, beside its warnings
OF_GCC = ("-fno-unroll-all-loops", "-funroll-all-loops", "-mmove-max=256", "-mstore-max=256", "-Winvalid-pch", "-c")

EMPTY = "cmake_pch.hxx.cxx"  # what CMake compiles to precompile the header beside it


def arguments_of(command, headers):
    """What Clang is given for a command of GCC; `headers`, if any, stands for those that GCC has precompiled."""
    words = shlex.split(command)
    compiler = next(i for i, word in enumerate(words) if "++" in Path(word).name)
    kept, words = [], iter(words[compiler + 1:])
    for word in words:
        if word == "-o":
            next(words)
        elif word == "-include":
            next(words)
            kept += ["-include-pch", str(headers)] if headers else []
        elif word.endswith(EMPTY):
            kept.append(word.removesuffix(".cxx"))
        elif word not in OF_GCC and not word.startswith("-Wno-"):
            kept.append(word)
    return ["clang++", *kept, "-w"]


def errors_of(entry, headers, *what):
    done = subprocess.run([*arguments_of(entry["command"], headers), *what], cwd=entry["directory"], text=True, capture_output=True)
    return done.stderr if done.returncode else ""


def main():
    if shutil.which("clang++") is None:
        print("Clang is not installed.")
        return 77
    entries = [entry for entry in json.loads(Path(sys.argv[1], "compile_commands.json").read_text()) if not entry["file"].endswith("headers.cc")]
    precompiled = [entry for entry in entries if entry["file"].endswith(EMPTY)]
    units = [entry for entry in entries if entry not in precompiled]
    with tempfile.TemporaryDirectory() as directory, concurrent.futures.ThreadPoolExecutor(max_workers=2) as pool:
        headers = Path(directory, "headers.pch")
        errors = [errors_of(entry, None, "-o", str(headers)) for entry in precompiled]
        errors = [text for text in (*errors, *pool.map(lambda unit: errors_of(unit, headers, "-fsyntax-only"), units)) if text]
    print("\n".join(errors))
    print(f"{len(units)} units, {len(errors)} errors of Clang")
    return 1 if errors or not units else 0


if __name__ == "__main__":
    sys.exit(main())
