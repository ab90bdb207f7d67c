# SPDX-License-Identifier: GPL-3.0-or-later
"""What gradients cost: processor time of all derivatives over that of what they are derivatives of, on the cat with three
examples, and the memory that they take beyond the recorded states.

Usage: OPENBLAS_NUM_THREADS=1 PYTHONPATH=build/release/python /usr/bin/python3 doc/scripts/measure_gradient_cost.py [STEPS]
Three rows: an equilibrium by Newton's method, STEPS increments, and STEPS steps of the default dynamics (100).
"""
import re
import sys
import tempfile
import time
import warnings
from pathlib import Path

import exemplar
import numpy as np

from scene_runs import print_table

ROOT = Path(__file__).parents[2]
SCENE = ROOT / "tests/benchmark/scenes/cat_mid60_examples.prm"
STEP = 1 / 60


def scene(is_static, n):
    text = SCENE.read_text().replace("../../../", f"{ROOT}/")
    if not is_static:
        return text.replace("set End = 2\n", f"set End = {n * STEP!r}\n")
    text = text.replace("set Scene = dynamic", "set Scene = static").replace("2*pi*0.5*t", "0.5*pi*t")
    time_of_statics = f"subsection Time\n  set Increments = {n}\nend\nsubsection Solver\n  set Method = newton\nend\n"
    return re.sub(r"subsection Time.*?end\n", time_of_statics, text, flags=re.S)


def memory(key):
    """In MB, of this process."""
    return next(int(line.split()[1]) / 1e3 for line in Path("/proc/self/status").read_text().splitlines() if line.startswith(key))


def timed(function):
    start = time.process_time()
    result = function()
    return result, time.process_time() - start


def recorded(problem):
    with problem.record() as trajectory:
        problem.run()
    return trajectory


def row(name, is_static, n):
    with tempfile.NamedTemporaryFile("w", suffix=".prm") as file:
        file.write(scene(is_static, n))
        file.flush()
        problem = exemplar.Problem(file.name)
    trajectory, forward = timed(lambda: recorded(problem))
    shape = problem.positions.shape
    by_positions = [np.random.default_rng(i).standard_normal(shape) for i in range(len(trajectory))]
    Path("/proc/self/clear_refs").write_text("5")  # the greatest memory is measured anew
    before = memory("VmRSS")
    _, backward = timed(lambda: trajectory.vjp(by_positions))
    return [name, len(trajectory), f"{1e3 * forward / n:.1f}", f"{1e3 * backward / n:.1f}", f"{backward / forward:.2f}",
            f"{memory('VmHWM') - before:.0f}"]


def main():
    warnings.simplefilter("ignore")
    n = int(sys.argv[1]) if len(sys.argv) > 1 else 100
    print_table(["motion", "steps", "a step [ms]", "its gradient [ms]", "ratio", "memory [MB]"],
                row("equilibrium", True, 1), row("increments", True, n), row("dynamics", False, n))


if __name__ == "__main__":
    main()
