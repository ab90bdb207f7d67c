# SPDX-License-Identifier: GPL-3.0-or-later
"""Write doc/studies/machine.csv, speed.csv and roofline.csv: what the machine can do, and what a step and its parts take of it.

Usage: python3 doc/scripts/measure_speed.py [BUILD]     on a quiet machine, ten minutes; BUILD is build/release
after `ninja -C build/release benchmark_machine benchmark_factor benchmark_evaluations benchmark_steps`. One thread; medians of three runs.
doc/scripts/study_tables.py --write puts the tables into doc/speed.md, doc/scripts/draw_plots.py roofline draws.
"""
import csv
import json
import re
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
BENCHMARKS = TOP / "tests/benchmark"
STUDIES = TOP / "doc/studies"
PATCHES = "Model/Dilatation=patches"
SCENES = {"cat_mid60": "cat", "bar100k": "bar"}
STEPS = ["cat_grav", "cat_mid60", "cat_mid60_examples", "horse_mid60", "bar100k"]
N_RUNS = 3
# An evaluation of a corotational cell without examples, counted in the sources: F 54, the rotation some 250, strain, stress and forces
# 180, the mean of the patch 20. It reads the nodes, nine numbers of gradients, the volume, two moduli, the rotation before and a pressure, and
# writes the rotation (CellArrays).
OPERATIONS_OF_CELL = 500
BYTES_OF_CELL = 4 * 4 + 8 * (9 + 1 + 2 + 2 * 9 + 1)


def run(program, *arguments):
    return subprocess.run([program, *arguments], capture_output=True, text=True, check=True).stdout


def medians(runs):
    return {key: statistics.median(r[key] for r in runs) if isinstance(value, float) else value for key, value in runs[0].items()}


def write(name, rows):
    with open(STUDIES / f"{name}.csv", "w", newline="") as file:
        out = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
        out.writeheader()
        out.writerows(rows)
    print(f"wrote {STUDIES / name}.csv", flush=True)


def digits(value):
    return f"{value:.3g}"


def machine(programs):
    """What one core does at best: rows of (what, value)."""
    best = medians([json.loads(run(programs / "benchmark_machine")) for _ in range(N_RUNS)])
    names = {"gflop_s_single": "product of matrices, single precision, GFLOP/s", "gflop_s_double": "product of matrices, double precision, GFLOP/s",
             "gb_s_16_kib": "reading 16 KiB, GB/s", "gb_s_256_kib": "reading 256 KiB, GB/s", "gb_s_4_mib": "reading 4 MiB, GB/s",
             "gb_s_512_mib": "reading 512 MiB, GB/s", "gb_s_triad": "triad of 192 MiB, GB/s"}
    write("machine", [{"what": text, "value": digits(best[key])} for key, text in names.items()])
    return best


def roofline(programs):
    rows = []
    for scene, body in SCENES.items():
        file = BENCHMARKS / f"scenes/{scene}.prm"
        factor = medians([json.loads(run(programs / "benchmark_factor", file, PATCHES)) for _ in range(N_RUNS)])
        bytes_of_factor = factor["factor_mib"] * 2**20
        operations = 1e6 * factor["gflop_s"] * factor["factorize_ms"]
        told = run(programs / "benchmark_evaluations", file, "5", PATCHES)
        cells = int(re.match(r"(\d+) cells", told)[1])
        nanoseconds = float(re.search(r"evaluation .* median ([\d.]+)", told)[1])
        parts = [("evaluation", OPERATIONS_OF_CELL * cells, BYTES_OF_CELL * cells, 1e-6 * nanoseconds * cells),
                 ("solve", bytes_of_factor, 2 * bytes_of_factor, factor["solve_ms"]),
                 ("solve, seven columns", 7 * bytes_of_factor, 2 * bytes_of_factor, factor["seven_columns_ms"]),
                 ("factorisation", operations, 2 * bytes_of_factor, factor["factorize_ms"])]
        rows += [{"body": body, "part": part, "operations": digits(n), "bytes": digits(size), "milliseconds": digits(ms),
                  "operations_per_byte": digits(n / size), "gflop_s": digits(1e-6 * n / ms), "gb_s": digits(1e-6 * size / ms)}
                 for part, n, size, ms in parts]
        rows[-3]["over_reading"] = digits(factor["solve_over_reading"])
        rows[-1]["of_product"] = digits(factor["share_of_product"])
    for row in rows:
        row.setdefault("over_reading", "")
        row.setdefault("of_product", "")
    write("roofline", rows)


def steps(programs):
    names = [name for scene in STEPS for name in (scene, f"{scene} patches")]
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.executable, BENCHMARKS / "run_benchmarks.py", "--program", programs / "benchmark_steps", "--output", folder, *names],
                       check=True, stdout=subprocess.DEVNULL)
        results = json.loads((Path(folder) / "results.json").read_text())["scenes"]
    rows = []
    for name, result in results.items():
        scene, *patches = name.split()
        n = result["steps"]
        rows.append({"scene": scene, "dilatation": "patches" if patches else "cells", "cells": result["cells"],
                     "iterations": f"{result['iterations'] / n:.2f}", "factorisations": digits(result["factorizations"] / n),
                     "ms": digits(result["mean_step_cpu_ms"]), "unit_ms": digits(result["unit_cpu_ms"]), "units": digits(result["units"]),
                     "worst_error": f"{result['worst_error']:.1e}"})
    write("speed", rows)


def main():
    programs = Path(sys.argv[1] if len(sys.argv) > 1 else TOP / "build/release") / "tests/benchmark"
    print(machine(programs)["blas_core"])
    roofline(programs)
    steps(programs)


if __name__ == "__main__":
    main()
