# SPDX-License-Identifier: GPL-3.0-or-later
"""What memory of the weights, yield and fibres cost in default steps of the cat, as ratios of the seconds of all steps with them and
without, one run after the other; the median over pairs, and the iterations of both.

Usage: python3 tests/benchmark/measure_laws.py [--pairs N] [--program P]
"""
import argparse
import csv
import os
import statistics
import subprocess
import tempfile
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
YIELD = ["Material/Yield stress=20000", "Material/Isotropic hardening=20000"]
CASES = {"memory of the weights": ("cat_mid60_examples", ["Examples/Energy=blended"], ["Examples/Yield=100"]),
         "yield at 2 % of E": ("cat_mid60", [], YIELD),
         "yield that is never reached": ("cat_mid60", [], ["Material/Yield stress=1e9"]),
         "fibres as stiff as E": ("cat_mid60", [], ["Material/Fibre stiffness=1e6", "Material/Fibre direction=1; 0; 0"])}


def run(program, scene, settings):
    """(seconds of all steps, iterations)."""
    with tempfile.TemporaryDirectory() as directory:
        command = [program, TOP / f"tests/benchmark/scenes/{scene}.prm", "--output", f"{directory}/out", "--threads", "1", "--quiet"]
        subprocess.run([*command, *(part for setting in settings for part in ("--set", setting))], check=True,
                       env={**os.environ, "OMP_NUM_THREADS": "1"})
        with open(f"{directory}/out/statistics.csv") as file:
            steps = list(csv.DictReader(file))[1:]
    return sum(float(step["seconds_step"]) for step in steps), sum(int(step["iterations"]) for step in steps)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--pairs", type=int, default=5)
    parser.add_argument("--program", default=TOP / "build/release/exemplar")
    arguments = parser.parse_args()
    for name, (scene, base, law) in CASES.items():
        pairs = [(run(arguments.program, scene, base), run(arguments.program, scene, base + law)) for _ in range(arguments.pairs)]
        ratio = statistics.median(with_law[0] / without[0] for without, with_law in pairs)
        print(f"{name:28} {ratio:.2f}   iterations {pairs[0][0][1]} -> {pairs[0][1][1]}", flush=True)


if __name__ == "__main__":
    main()
