#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What each part of a scene takes, in time and memory, and that a part which a scene does not need takes none.

Usage, from the top folder: python3 doc/scripts/measure_parts.py [PROGRAM]

Runs the cat of prm/studies/scenes/cat.prm as several kinds of scene under `perf record` (Debian: linux-perf) on one thread
and writes doc/studies/parts.csv. A minute.
Times are processor time by the functions that were running, memory is what the parts themselves count (memory_mib of
summary.json); both are of the program as it is, without changes for measuring.
"""
import csv
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
SCENE, RESULT = TOP / "prm/studies/scenes/cat.prm", TOP / "doc/studies/parts.csv"
FREQUENCY = 1000

PLAIN = {"Output/Every": "0", "Output/Checkpoint minutes": "60"}
EXAMPLES = {"Examples/Weights": "simplex"}
NONE = {"Examples/Importance": "0"}
STATIC = {**NONE, "Scene": "static", "Time/Increments": "20"}
PAPER = {"Solver/Method": "one pass", "Model/Gradient": "frozen", "Time/Mass damping": "0", "Time/End": "2"}
KINDS = {
    "static": STATIC,
    "static, iterative": {**STATIC, "Solver/Linear solver": "iterative"},
    "interpolation": {"Scene": "interpolation", "Examples/Importance": "1", "Examples/Weights": "prescribed",
                      "Examples/Prescribed weights": "1-t; t; 0", "Time/Increments": "20"},
    "dynamic": {**NONE, "Time/End": "2"},
    "dynamic, examples": {**EXAMPLES, "Time/End": "2"},
    "the paper's one pass": PAPER,
    "the same with frames": {**PAPER, "Output/Every": "1"},
    "newton, bdf2, damped": {**EXAMPLES, "Solver/Method": "newton", "Time/Scheme": "bdf2",
                             "Time/Stiffness damping": "0.001", "Time/End": "0.6"},
}

# (part, key of memory_mib, functions); of the functions that called each other the innermost that fits counts
PARTS = [
    ("start and reading (once)", "mesh", r"Problem::Problem|_dl_|call_init|Mesh::|Parameters::|sha256|OBJ_NAME"),
    ("handles and loads", None, r"::(Handles|Loads|Expression)::|LoadTerm::"),
    ("mass matrix and inertia", "mass matrix", r"::(InertiaTerm|Mass|TimeIntegrator)::"),
    ("rotations of the cells", None, r"closest_rotation|add_rotations|node_rotations|update_rotations"),
    ("forces and energies of the cells", "cells", r"evaluate_group|gather_forces|ElasticPotential::evaluate"),
    ("example strains and weights", "example poses", r"weight_linear_term|ExamplePoses|ExampleWeights|minimize_over_weights"),
    ("columns of the weights", "weight block", r"coupling|solve_weights"),
    ("frames", None, r"[Vv]tu|cell_results|write_frame|Frame"),
    ("stiffness damping", None, r"StrainDamping"),
    ("matrix", None, r"StiffnessLoops|TangentLoops|add_tangent|add_rotated_stiffness|assemble|CellScatter"),
    ("factorisation and solves", "linear solver", r"CholmodOperator::(factorize|solve|reinit)|IterativeOperator"),
    ("kept factor, L-BFGS and prediction", "quasi-Newton method",
     r"TriangularLoops|SinglePrecision|RotatedMetric|Lbfgs|LinearPrediction|QuasiNewton|CholmodOperator::(panels|keep)"),
    ("statistics, final pose, checkpoint", None, r"Diagnostics|StatisticsFile|write_msh|write_checkpoint|write_summary|RunWriter"),
]
OTHER = "everything else"


def scene_text(keys):
    """With paths that do not depend on where it lies, and without handles in an interpolation, which refuses them."""
    text = SCENE.read_text().replace("../../../", f"{TOP}/")
    if keys.get("Scene") == "interpolation":
        text = re.sub(r"^subsection Handles\n.*?^end\n", "", text, flags=re.DOTALL | re.MULTILINE)
    return text


def settings(keys):
    return [word for key, value in {**PLAIN, **keys}.items() for word in ("--set", f"{key}={value}")]


def samples(data):
    """The functions of each sample, the innermost first."""
    script = subprocess.run(["perf", "script", "--no-inline", "-i", data, "-F", "ip,sym"], check=True, stdout=subprocess.PIPE,
                            stderr=subprocess.DEVNULL, text=True).stdout
    for sample in script.split("\n\n"):
        if sample.strip():
            yield [line.strip().split(" ", 1)[-1] for line in sample.strip().splitlines()]


def part_of(functions):
    for function in functions:
        for part, _, pattern in PARTS:
            if re.search(pattern, function):
                return part
    return OTHER


def measure(program, keys):
    """Milliseconds a step and MiB of each part."""
    with tempfile.TemporaryDirectory() as folder:
        Path(f"{folder}/scene.prm").write_text(scene_text(keys))
        run = [program, f"{folder}/scene.prm", *settings(keys), "--threads", "1", "--quiet", "--output", f"{folder}/out"]
        subprocess.run(["perf", "record", "-q", "-e", "cpu-clock", "-F", str(FREQUENCY), "--call-graph", "dwarf,16384",
                        "-o", f"{folder}/perf", *run], check=True)
        summary = json.loads(Path(f"{folder}/out/summary.json").read_text())
        milliseconds = dict.fromkeys([part for part, _, _ in PARTS] + [OTHER], 0.)
        for functions in samples(f"{folder}/perf"):
            part = part_of(functions)
            milliseconds[part] += 1000. / FREQUENCY / (1 if part == PARTS[0][0] else summary["steps"])
    return milliseconds, summary["memory_mib"]


def text(milliseconds, mib):
    parts = [f"{float(f'{milliseconds:.2g}'):g} ms" if milliseconds >= 0.005 else "", f"{mib:.2g} MiB" if mib else ""]
    return ", ".join(part for part in parts if part) or "0"


def main():
    program = sys.argv[1] if len(sys.argv) > 1 else str(TOP / "build/release/exemplar")
    results = {kind: measure(program, keys) for kind, keys in KINDS.items()}
    with open(RESULT, "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["part", *KINDS])
        for part, memory, _ in [*PARTS, (OTHER, None, None)]:
            writer.writerow([part, *(text(milliseconds[part], mib.get(memory, 0)) for milliseconds, mib in results.values())])


if __name__ == "__main__":
    main()
