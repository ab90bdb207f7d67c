# SPDX-License-Identifier: GPL-3.0-or-later
"""Problems in several threads of one Python: each case is a process of its own, which a deadlock cannot hold up, and begins
with nothing but its imports, so that what is done once in a process is done by the threads. EXEMPLAR_REPETITIONS=100 does
each a hundred times."""
import os
import subprocess
import sys
import tempfile
import unittest

REPETITIONS = int(os.environ.get("EXEMPLAR_REPETITIONS", "2"))

SCENES = """
import sys, threading
import exemplar

BAR = {"Scene": "static", "Mesh": {"Generator": "box", "Box size": [2, 1, 1], "Box cells": [6, 3, 3]},
       "Handles": {"left": {"Select": "boundary 1"}, "right": {"Select": "boundary 2", "Motion": [0, 0, "0.5*t"]}},
       "Examples": {"Pose functions": [["x", "y + 0.2*x*z", "z - 0.2*x*y"]], "Importance": 0.8}, "Time": {"Increments": 2}}
ITERATIVE = {**BAR, "Solver": {"Linear solver": "iterative", "Method": "newton"}}
SWINGING = {**BAR, "Scene": "dynamic", "Solver": {"Linear solver": "iterative", "Method": "quasi newton"},
            "Time": {"Step": 0.05, "End": 0.5}}

def solved(scene):
    problem = exemplar.Problem(scene)
    problem.run()
    return problem.positions.tobytes() + problem.weights.tobytes()

def in_threads(action, arguments):
    results = [None] * len(arguments)
    def call(i):
        results[i] = action(arguments[i])
    threads = [threading.Thread(target=call, args=(i,)) for i in range(len(arguments))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return results

def expect(condition, what):
    if not condition:
        sys.exit(what)
"""


def has_multigrid():
    code = SCENES + "exemplar.Problem(ITERATIVE)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120)
    return "without Trilinos" not in done.stderr


class Threads(unittest.TestCase):
    def passes(self, code, **environment):
        for repetition in range(REPETITIONS):
            with self.subTest(repetition=repetition):
                done = subprocess.run([sys.executable, "-c", SCENES + code], capture_output=True, text=True, timeout=120,
                                      env={**os.environ, **environment})
                self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""))

    def test_first_dictionaries(self):
        self.passes("first, second = in_threads(solved, [BAR, BAR])\n"
                    "expect(first is not None and first == second, 'threads differ')")

    def test_blas_has_one_thread_while_a_problem_steps(self):
        self.passes("""
import ctypes
files = {line.split()[-1] for line in open("/proc/self/maps") if "openblas" in line}
if files: # the reference BLAS has one thread
    n_threads = ctypes.CDLL(files.pop()).openblas_get_num_threads
    expect(n_threads() == 2, "two threads are asked for")
    problem, within = exemplar.Problem(BAR), []
    problem.on_iteration(lambda report: within.append(n_threads()))
    problem.run()
    expect(set(within) == {1}, f"within a step: {within}")
    expect(n_threads() == 2, "the number before does not come back")
""", OPENBLAS_NUM_THREADS="2")

    @unittest.skipUnless(has_multigrid(), "built without Trilinos")
    def test_first_multigrid(self):
        self.passes("first, second = in_threads(solved, [ITERATIVE, ITERATIVE])\n"
                    "expect(first is not None and first == second, 'threads differ')")

    @unittest.skipUnless(has_multigrid(), "built without Trilinos")
    def test_multigrid_gives_the_bytes_of_problems_alone(self):
        self.passes("exemplar.use_one_blas_thread()\n"
                    "scenes = [ITERATIVE, SWINGING, ITERATIVE, SWINGING]\n"
                    "alone = [solved(scene) for scene in scenes[:2]]\n"
                    "expect(in_threads(solved, scenes) == 2 * alone, 'threads differ from problems alone')")

    def test_functions_of_motions_while_problems_are_collected(self):
        self.passes("""
import gc
FREE = {**BAR, "Handles": {**BAR["Handles"], "right": {"Select": "boundary 2"}}}
def dragged(scene):
    for _ in range(3):
        problem = exemplar.Problem(scene)
        problem.set_motion("right", lambda rest, t: problem.n_steps * 0 * rest + [0, 0, 0.5 * t]) # a cycle
        problem.on_iteration(lambda report: gc.collect() and problem.time >= 0)
        kept = problem.positions
        problem.run()
    expect(abs(kept - problem.rest_positions).max() == 0, "a kept array has changed")
    return problem.positions.tobytes()
alone = dragged(FREE)
expect(in_threads(dragged, 3 * [FREE]) == 3 * [alone], "threads differ")
""")

    def test_one_surface_is_filled_by_two_threads(self):
        with tempfile.TemporaryDirectory() as cache:
            surface = os.path.join(cache, "cube.obj")
            with open(surface, "w", encoding="utf-8") as file:
                for k in range(8):
                    file.write(f"v {k & 1} {k >> 1 & 1} {k >> 2}\n")
                for a, b, c, d in (1, 3, 4, 2), (5, 6, 8, 7), (1, 2, 6, 5), (3, 7, 8, 4), (1, 5, 7, 3), (2, 4, 8, 6):
                    file.write(f"f {a} {b} {c}\nf {a} {c} {d}\n")
            self.passes(f"CUBE = {{'Scene': 'static', 'Mesh': {{'File': {surface!r}}},\n"
                        "        'Handles': {'low': {'Select': 'box -1 -1 -1 2 2 0.01'}}}\n"
                        "first, second = in_threads(solved, [CUBE, CUBE])\n"
                        "expect(first is not None and first == second, 'threads differ')", XDG_CACHE_HOME=cache)

    def test_python_ends_while_threads_solve(self):
        self.passes("""
import time
import warnings
warnings.simplefilter("ignore")  # the handle goes far in that time
LONG = {**BAR, "Scene": "dynamic", "Time": {"Step": 0.01, "End": 1000}}
for _ in range(2):
    threading.Thread(target=solved, args=(LONG,), daemon=True).start()
time.sleep(0.5)
""")


if __name__ == "__main__":
    unittest.main()
