# SPDX-License-Identifier: GPL-3.0-or-later
"""Print Table 1 of doc/results.md: where the time of a step goes, beside the paper's.

Usage: python3 doc/measure_steps.py [BINARY]     from the top folder, on a quiet machine
Runs a cat and a horse scene five times without frames. A time is the median over the runs of the
mean over all steps of a run; the share is formed within each run.
"""
import csv
import json
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

SCENES = [("cat", "fig2a_cat", (10212, 8580, 150, 183)), ("horse", "fig3a_horse", (6203, 6003, 112, 140))]
N_RUNS = 5


def run(binary, scene):
    """Mean milliseconds of the linear solve and of the whole step, and the summary."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([binary, f"prm/paper/{scene}.prm", "--quiet", "--output", folder + "/out",
                        "--set", "Output/Every=0"], check=True)
        rows = list(csv.DictReader(Path(folder, "out/statistics.csv").open()))[1:]
        summary = json.loads(Path(folder, "out/summary.json").read_text())
    mean = lambda name: 1e3 * statistics.mean(float(row["seconds_" + name]) for row in rows)
    return mean("factorize") + mean("solve"), mean("step"), summary


def main():
    binary = sys.argv[1] if len(sys.argv) > 1 else "build/release/exemplar"
    print("| mesh | cells | DOFs | linear solve | whole step | share that is not the linear solve |")
    print("|---|---|---|---|---|---|")
    for mesh, scene, (cells, dofs, solve, step) in SCENES:
        runs = [run(binary, scene) for _ in range(N_RUNS)]
        summary = runs[0][2]
        share = statistics.median(1 - r[0] / r[1] for r in runs)
        print(f"| {mesh}, the paper | {cells:,} | {dofs:,} | {solve} ms | {step} ms | {1 - solve / step:.0%} |")
        print(f"| {mesh}, exemplar | {summary['cells']:,} | {summary['dofs']:,} |"
              f" {statistics.median(r[0] for r in runs):.1f} ms | {statistics.median(r[1] for r in runs):.1f} ms |"
              f" {share:.1%} |")
    print(f"\n{summary['blas']}, core type {summary['blas_core']}, one thread")


if __name__ == "__main__":
    main()
