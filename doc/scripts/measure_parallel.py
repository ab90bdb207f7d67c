#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""How several processes scale: doc/studies/parallel.csv, for doc/parallel.md.

    python3 doc/scripts/measure_parallel.py [CASE...] [--repeat N] [--program P]
    python3 doc/scripts/measure_parallel.py --model        doc/studies/parallel_model.csv, from these measurements

`speedup` is that of cells a second. The runs of a case are interleaved, and the least of N (3) counts, as other work of the machine can only add to it. Seconds are of the
clock: all; of it reading the mesh, partitioning it and building the problem; and in dynamics the median step. Memory is the
greatest of each process. On a quiet machine with two cores, an hour.
"""
import argparse
import csv
import json
import math
import os
import statistics
import subprocess
import tempfile
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
FILE = TOP / "doc/studies/parallel.csv"
SCENES = TOP / "tests/benchmark/scenes"
ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMP_NUM_THREADS": "1",
               "OPENBLAS_NUM_THREADS": "1"}
ITERATIVE, CHOLESKY = {"Solver/Linear solver": "iterative"}, {"Solver/Linear solver": "cholesky"}
STATIC = "static, multigrid"
STEPS = {"Time/End": 0.5}  # 50 steps
# case: [what, scene, settings, processes]
CASES = {
    "static_100k": [[STATIC, "bar1M.prm", {"Mesh/Box cells": "64, 16, 16", **ITERATIVE}, n] for n in (1, 2)],
    "static_1M": [[STATIC, "bar1M.prm", ITERATIVE, n] for n in (1, 2)],
    "static_greatest": [[STATIC, "bar1M.prm", {"Mesh/Box cells": "240, 60, 60", **ITERATIVE}, n] for n in (1, 2)],  # 15 GiB
    "weak": [[STATIC, "bar1M.prm", {"Mesh/Box cells": cells, **ITERATIVE}, n]
             for n, cells in ((1, "112, 28, 28"), (2, "224, 28, 28"))],
    "patches_500k": [["static, multigrid, patches", "bar1M.prm",
                      {"Mesh/Box cells": "112, 28, 28", "Model/Dilatation": "patches", **ITERATIVE}, n] for n in (1, 2)],
    "swing_100k": [["50 steps, kept factor", "bar100k.prm", {**STEPS, **CHOLESKY}, 1],
                   *[["50 steps, kept multigrid", "bar100k.prm", {**STEPS, **ITERATIVE}, n] for n in (1, 2)]],
    "swing_400k": [["50 steps, kept factor", "bar100k.prm", {**STEPS, "Mesh/Box cells": "104, 26, 26", **CHOLESKY}, 1],
                   *[["50 steps, kept multigrid", "bar100k.prm", {**STEPS, "Mesh/Box cells": "104, 26, 26", **ITERATIVE}, n]
                     for n in (1, 2)]],
}
MODEL = TOP / "doc/studies/parallel_model.csv"
COLUMNS = ["case", "steps", "what", "cells", "processes", "seconds", "seconds_read", "seconds_step", "iterations", "factorizations",
           "memory_mib", "memory_root_mib", "memory_others_mib", "speedup"]


def run(program, case, what, scene, settings, n):
    with tempfile.TemporaryDirectory() as folder:
        words = [word for key, value in settings.items() for word in ("--set", f"{key}={value}")]
        start = [program] if n == 1 else ["mpirun", "-n", str(n), program]
        subprocess.run([*start, SCENES / scene, "--quiet", "--output", Path(folder) / "out", *words], check=True,
                       env=ENVIRONMENT)
        summary = json.loads((Path(folder) / "out/summary.json").read_text())
        with open(Path(folder) / "out/statistics.csv", newline="") as file:
            steps = [float(row["seconds_step"]) for row in csv.DictReader(file) if row["seconds_step"]]
    peaks = summary.get("peak_memory_mib_of_processes", [summary["peak_memory_mib"]])
    return {"case": case, "steps": len(steps) if len(steps) > 1 else "", "what": what, "cells": summary["cells"], "processes": n, "seconds": summary["seconds"]["total"],
            "seconds_read": summary["seconds"]["read"],
            "seconds_step": statistics.median(steps) if len(steps) > 1 else "", "iterations": summary["iterations"],
            "factorizations": summary["factorizations"], "memory_mib": round(sum(peaks)), "memory_root_mib": round(peaks[0]),
            "memory_others_mib": round(max(peaks[1:])) if n > 1 else "", "speedup": ""}


def measure(program, case, repeat):
    runs = [[] for _ in CASES[case]]
    for _ in range(repeat):
        for found, (what, scene, settings, n) in zip(runs, CASES[case]):
            found.append(run(program, case, what, scene, settings, n))
            print(found[-1], flush=True)
    rows = []
    for found in runs:
        least = min(found, key=lambda row: row["seconds"])
        if least["seconds_step"]:
            least["seconds_step"] = min(row["seconds_step"] for row in found)
        rows.append(least)
    for row in rows:
        measure_of = "seconds_step" if row["seconds_step"] else "seconds"
        for alone in rows:
            if alone["what"] == row["what"] and alone["processes"] == 1:
                row["speedup"] = round(alone[measure_of] / row[measure_of] * row["cells"] / alone["cells"], 2)
    return [rounded(row) for row in rows]


def rounded(row):
    """To three digits."""
    return {key: float(f"{value:.3g}") if isinstance(value, float) else value for key, value in row.items()}


def rows_of(case):
    with FILE.open(newline="") as file:
        return [row for row in csv.DictReader(file) if row["case"] == case]


def model():
    """doc/parallel.md says what it assumes."""
    cells, nodes_a_cell, crowded = 100e6, 1 / 5.5, 1.5
    neighbours, latency, bandwidth, levels, products, cycles = 14, 2e-6, 5e9, 5, 6, 2
    static = rows_of("static_1M")[0]
    swing = next(row for row in rows_of("swing_400k") if "multigrid" in row["what"])
    static_second = (float(static["seconds"]) - float(static["seconds_read"])) / float(static["cells"])
    step_second = float(swing["seconds_step"]) / float(swing["cells"])
    iterations = float(swing["iterations"]) / 50
    conjugate = 69 * (cells / 1e6) ** (1 / 6)
    rows = []
    for n in (64, 4096):
        shared = 6 * (cells * nodes_a_cell / n) ** (2 / 3) if n > 1 else 0
        exchanges = iterations * (3 + cycles * levels * products)
        # coarser levels have an eighth of the nodes, and so on
        volume = 24 * shared * iterations * (3 + cycles * products * 8 / 7)
        messages = 2 * neighbours * exchanges if n > 1 else 0
        gather = iterations * 12 * (latency * math.log2(n) + 8 * n / bandwidth)
        talking = messages * latency + volume / bandwidth + gather
        step = crowded * step_second * cells / n + talking
        of_static = (crowded * static_second * cells / n * (cells / 1e6) ** (1 / 6)
                     + 2 * conjugate * (2 * neighbours * (1 + levels * products) * latency
                                        + 24 * shared * (1 + products * 8 / 7) / bandwidth))
        memory = 1.1 * float(static["memory_mib"]) / float(static["cells"]) * 2 ** 20 * cells / n
        rows.append({"processes": n, "cells_each": round(cells / n), "shared": round(shared), "messages_step": round(messages),
                     "volume_step": volume / 1e6, "seconds_step": step, "efficiency": (step - talking) / step,
                     "cg": round(conjugate), "seconds_static": of_static, "memory_each": memory / 1e9})
    with MODEL.open("w", newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(map(rounded, rows))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", nargs="*", metavar="CASE", help=", ".join(CASES))
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--program", default=str(TOP / "build/release/exemplar"))
    parser.add_argument("--model", action="store_true")
    options = parser.parse_args()
    if options.model:
        model()
        return
    cases = options.cases or list(CASES)
    kept = {row["case"]: [] for row in csv.DictReader(FILE.open(newline=""))} if FILE.exists() else {}
    if FILE.exists():
        for row in csv.DictReader(FILE.open(newline="")):
            kept[row["case"]].append(row)
    for case in cases:
        kept[case] = measure(options.program, case, options.repeat)
        with FILE.open("w", newline="") as file:
            writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
            writer.writeheader()
            for name in CASES:
                writer.writerows(kept.get(name, []))


if __name__ == "__main__":
    main()
