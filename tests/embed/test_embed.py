# SPDX-License-Identifier: GPL-3.0-or-later
"""Install the library, build main.cc against it alone and look at the weights that it prints.

Usage: python3 tests/embed/test_embed.py BUILD_DIRECTORY
"""
import subprocess
import sys
import tempfile
from pathlib import Path


def run(*command):
    done = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(done.args)}\n{done.stdout}")
    return done.stdout


with tempfile.TemporaryDirectory() as directory:
    prefix, build = Path(directory, "prefix"), Path(directory, "build")
    run("cmake", "--install", sys.argv[1], "--prefix", prefix)
    run("cmake", "-G", "Ninja", "-S", Path(__file__).parent, "-B", build, f"-DCMAKE_PREFIX_PATH={prefix}")
    run("cmake", "--build", build)
    rows = [[float(number) for number in line.split()] for line in run(build / "embed").splitlines()]

assert len(rows) == 10, rows
assert all(abs(rest + twisted - 1) < 1e-5 for _, rest, twisted in rows), rows
grown = [twisted for _, _, twisted in rows]
assert grown == sorted(grown) and grown[-1] > grown[0] + 0.5, rows
