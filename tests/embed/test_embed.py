# SPDX-License-Identifier: GPL-3.0-or-later
"""Install the library, build main.cc and floor.cc against it alone and look at what they print. Programs of the pages, and this
one, include exemplar/exemplar.h alone.

Usage: python3 tests/embed/test_embed.py BUILD_DIRECTORY
"""
import re
import subprocess
import sys
import tempfile
from pathlib import Path


def run(*command):
    done = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(done.args)}\n{done.stdout}")
    return done.stdout


TOP = Path(__file__).resolve().parents[2]
for page in [TOP / "README.md", *TOP.glob("doc/*.md"), *TOP.glob("tests/embed/*.cc")]:
    others = set(re.findall(r"^\s*#include <(exemplar/[^>]*)>", page.read_text(), re.M)) - {"exemplar/exemplar.h"}
    assert not others, f"{page} includes {others}: programs of others include exemplar/exemplar.h alone"

with tempfile.TemporaryDirectory() as directory:
    prefix, build = Path(directory, "prefix"), Path(directory, "build")
    run("cmake", "--install", sys.argv[1], "--prefix", prefix)
    run("cmake", "-G", "Ninja", "-S", Path(__file__).parent, "-B", build, f"-DCMAKE_PREFIX_PATH={prefix}")
    run("cmake", "--build", build)
    rows = [[float(number) for number in line.split()] for line in run(build / "embed").splitlines()]
    least, left = [float(number) for number in run(build / "floor").split()]

assert len(rows) == 10, rows
assert all(abs(rest + twisted - 1) < 1e-5 for _, rest, twisted in rows), rows
grown = [twisted for _, _, twisted in rows]
assert grown == sorted(grown) and grown[-1] > grown[0] + 0.5, rows
assert -0.05 < least < -0.02 and left < 1e-6, (least, left)  # the floor of floor.cc bears the bar
