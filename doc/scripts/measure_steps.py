# SPDX-License-Identifier: GPL-3.0-or-later
"""Print the first table of doc/measured.md: where the time of a step goes, beside the paper's.

Usage: python3 doc/scripts/measure_steps.py [BINARY]     on a quiet machine
Runs a cat and a horse scene five times without frames. A time is the median over the runs of the
mean over all steps of a run; the share is formed within each run.
"""
import statistics
import sys
import tempfile

from scene_runs import PROGRAM, paper_scene, run_scene

SCENES = [("cat", "fig2a_cat", (10212, 8580, 150, 183)), ("horse", "fig3a_horse", (6203, 6003, 112, 140))]
N_RUNS = 5


def run(program, scene):
    """Mean milliseconds of the linear solve and of the whole step, and the summary."""
    with tempfile.TemporaryDirectory() as folder:
        done = run_scene(program, paper_scene(scene), folder + "/out", arguments=["--threads", "1"])
    mean = lambda name: 1e3 * statistics.mean(float(row["seconds_" + name]) for row in done.rows[1:])
    return mean("factorize") + mean("solve"), mean("step"), done.summary


def main():
    program = sys.argv[1] if len(sys.argv) > 1 else PROGRAM
    print("| mesh | cells | DOFs | linear solve | whole step | share that is not the linear solve |")
    print("|---|---|---|---|---|---|")
    for mesh, scene, (cells, dofs, solve, step) in SCENES:
        runs = [run(program, scene) for _ in range(N_RUNS)]
        summary = runs[0][2]
        share = statistics.median(1 - r[0] / r[1] for r in runs)
        print(f"| {mesh}, the paper | {cells:,} | {dofs:,} | {solve} ms | {step} ms | {1 - solve / step:.0%} |")
        print(f"| {mesh}, exemplar | {summary['cells']:,} | {summary['dofs']:,} |"
              f" {statistics.median(r[0] for r in runs):.1f} ms | {statistics.median(r[1] for r in runs):.1f} ms |"
              f" {share:.1%} |")
    print(f"\n{summary['blas']}, core type {summary['blas_core']}, one thread")


if __name__ == "__main__":
    main()
