# SPDX-License-Identifier: GPL-3.0-or-later
"""Print what two threads take beside other work, over what one thread takes beside it.

Usage: python3 doc/scripts/measure_busy.py [--busy N] [--runs N] [BINARY]     on a machine without other work
The other work is as many processes that only count as there are cores, or N of them. A scene, a default dynamic scene, a pose of a
surface and a mesh of it are run with one thread and with two, in turn, alone and beside that work. A ratio is the median
of the ratios of neighbouring runs, of the clock and of the processor time; a mesh has one thread whatever is asked, and shows the scatter.
"""
import argparse
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from scene_runs import PROGRAM, TOP, paper_scene, print_table

SURFACES = TOP / "meshes/surfaces/creature"


def commands(folder):
    """What is run, by name, without the program and the number of threads."""
    mesh = ["mesh", "--surface", str(SURFACES / "rest.obj"), "--cells", "10000", "--output", f"{folder}/body.msh"]
    scene = ["--quiet", "--output", f"{folder}/out", "--set", "Output/Every=0"]
    return {"demo scene": [str(paper_scene("fig2a_cat")), *scene],
            "default steps of the cat": [str(TOP / "tests/benchmark/scenes/cat_mid60.prm"), *scene, "--set", "Model/Dilatation=patches"],
            "mesh": mesh,
            "pose": ["pose", "--mesh", f"{folder}/body.msh", "--rest", str(SURFACES / "rest.obj"),
                     "--pose", str(SURFACES / "crouch.obj"), "--output", f"{folder}/poses"]}


class BusyLoops:
    """Processes that do nothing but need a core each."""

    def __init__(self, n):
        self.loops = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(n)]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for loop in self.loops:
            loop.kill()
            loop.wait()


def run(program, words, n_threads):
    """Seconds of the clock and of the processor."""
    threads = [] if words[0] == "mesh" else ["--threads", str(n_threads)]
    used = lambda: sum(resource.getrusage(resource.RUSAGE_CHILDREN)[:2])  # noqa: E731
    clock, processor = time.monotonic(), used()
    done = subprocess.run([str(program), *words, *threads], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(words)}: {done.stderr}")
    return time.monotonic() - clock, used() - processor


def measure(program, words, n_runs):
    """Seconds of the clock with one thread and with two, and the ratios of both kinds of seconds."""
    pairs = [(run(program, words, 1), run(program, words, 2)) for _ in range(n_runs)]
    seconds = [statistics.median(pair[k][0] for pair in pairs) for k in (0, 1)]
    ratios = [statistics.median(two[kind] / one[kind] for one, two in pairs) for kind in (0, 1)]
    return [f"{value:.3g}" for value in seconds] + [f"{ratio:.2f}" for ratio in ratios]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", nargs="?", type=Path, default=PROGRAM)
    parser.add_argument("--busy", type=int, default=len(os.sched_getaffinity(0)))
    parser.add_argument("--runs", type=int, default=5)
    options = parser.parse_args()
    table = [["what", "busy processes", "one thread, s", "two threads, s", "ratio", "of processor time"]]
    with tempfile.TemporaryDirectory() as folder:
        words_of = commands(folder)
        run(options.program, words_of["mesh"], 1)  # the pose needs it
        for n_busy in sorted({0, options.busy}):
            with BusyLoops(n_busy):
                for what, words in words_of.items():
                    table.append([what, n_busy, *measure(options.program, words, options.runs)])
                    print(table[-1], file=sys.stderr, flush=True)
    print_table(*table)


if __name__ == "__main__":
    main()
