# SPDX-License-Identifier: GPL-3.0-or-later
"""Measure the steps of the benchmark scenes, print a table, write how costs grow, compare with the baseline.

Usage: python3 tests/benchmark/run_benchmarks.py [--large] [--steps N] [--repeats N] [--set 'Section/Key=value']...
                                                 [--program FILE] [--output DIRECTORY] [--write-baseline] [SCENE]...
on a quiet machine, after `ninja -C build/release benchmark_steps`. SCENE is a name in scenes/, such a name with what it is
used with ("cat_mid60 patches"), or growth-cells or growth-examples; by default all but those of a million cells, which
--large adds. --steps measures so many steps of each scene only. --set applies to all scenes. --write-baseline replaces
what the baseline has of the scenes that were measured.

A number is the median of three runs. The unit is one CHOLMOD factorisation and one solve of the scene's matrix with
`Dilatation = cells`, so that ratios to it can be compared between machines and elements. Errors are those of each step against the step solved to 1e-11 from the
same state, relative to its greatest displacement, and come from a run of their own. The whole results, results.json,
and how costs grow, growth_cells.csv and growth_examples.csv, go to DIRECTORY (output/benchmarks); those in doc/studies
are what doc/scripts/draw_plots.py draws. baseline.json, beside this file, holds ratios only. The exit status is 1 if a
run failed, otherwise 0, whatever got slower.
"""
import argparse
import csv
import json
import statistics
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
TOP = HERE.parents[1]
sys.path.insert(0, str(TOP / "tests/scenes"))
from exemplar_runner import run_program, set_words  # noqa: E402

BASELINE = HERE / "baseline.json"
SCENES = ["cat_grav", "cat_mid60", "cat_mid30", "cat_mid60_examples", "cat_invert", "cat_one_pass", "horse_grav",
          "horse_mid60", "bar100k"]
LARGE_SCENE = "bar1M"
GROWTHS = ["growth-cells", "growth-examples"]
# scenes as they are used: with patches, the default; quadratic elements; a kept multigrid hierarchy
VARIANTS = {f"{scene} patches": (scene, {"Model/Dilatation": "patches"}) for scene in SCENES}
VARIANTS["cat_mid60 P2 patches"] = ("cat_mid60", {"Model/Element": "P2", "Model/Dilatation": "patches"})
VARIANTS["bar100k patches, multigrid"] = ("bar100k", {"Model/Dilatation": "patches", "Solver/Linear solver": "iterative"})
# frozen forces with examples are no gradient, so there is nothing to compare their steps with
WITHOUT_REFERENCE = ["cat_one_pass", LARGE_SCENE]
REFERENCE_STEPS = {"bar100k": 10, "cat_mid60 P2 patches": 10}
BAR_BRICKS = [4, 8, 16]  # of the bar 4:1:1 along its short sides, with 24 n^3 tetrahedra
LARGE_BAR_BRICKS = 35
DILATATIONS = ["cells", "patches"]
EXAMPLE_COUNTS = [0, 1, 4, 16, 64]
PARTS = ["evaluate", "assemble", "factorize", "solve", "output"]
WORSE = 1.15
# below these a ratio is rounding, or nobody's concern
LEAST = {"units": 0, "worst_error": 1e-6, "share": 0.05, "ratio": 0}


class Failures:
    """What failed, told as it happens."""

    def __init__(self):
        self.seen = []

    def add(self, what):
        self.seen.append(what)
        print(f"FAILED: {what}", file=sys.stderr)


def run_once(options, scene, settings, flags, failures):
    """The JSON object of one run of benchmark_steps, None if there is none."""
    words = set_words(settings) + [word for setting in options.set for word in ("--set", setting)]
    run = run_program(HERE / f"scenes/{scene}.prm", *words, *flags, program=options.program)
    if run.status:
        failures.add(f"{scene} {' '.join(words + flags)}: {run.stderr.strip()}")
    return json.loads(run.stdout) if run.stdout else None


def median_of(runs):
    """Of objects of the same kind, number by number; what is no number comes from the first."""
    first = runs[0]
    if isinstance(first, dict):
        return {key: median_of([run[key] for run in runs]) for key in first if all(key in run for run in runs)}
    if isinstance(first, (int, float)):
        return statistics.median(runs)
    return first


def steps_flags(*limits):
    """--steps with the least of the limits that there are."""
    limits = [limit for limit in limits if limit]
    return ["--steps", str(min(limits))] if limits else []


def measure(options, scene, failures, settings=None, flags=()):
    """Medians over the runs, None if none was of any use."""
    steps = [] if "--steps" in flags else steps_flags(options.steps)
    repeats = 1 if "--no-unit" in flags else options.repeats  # there are minutes in such a run
    runs = [run_once(options, scene, settings or {}, [*steps, *flags], failures) for _ in range(repeats)]
    runs = [run for run in runs if run is not None]
    return median_of(runs) if runs else None


def measure_scene(options, name, failures):
    """Times of a scene, and its errors if it has a reference."""
    print(f"{name} ...", file=sys.stderr, flush=True)
    scene, settings = VARIANTS.get(name, (name, {}))
    if scene == LARGE_SCENE:
        return measure(options, scene, failures, flags=["--no-unit"])
    result = measure(options, scene, failures, settings)
    if result is None or scene in WITHOUT_REFERENCE:
        return result
    reference = run_once(options, scene, settings, ["--reference", "--no-unit",
                                              *steps_flags(options.steps, REFERENCE_STEPS.get(name, REFERENCE_STEPS.get(scene)))], failures)
    for key in ("worst_error", "mean_error", "steps_above_1e-3", "steps_without_reference"):
        if reference is not None:
            result[key] = reference[key]
    return result


def measure_growth_with_cells(options, failures):
    """Bars of growing numbers of cells, each dilatation, with the linear solver that auto takes: {(dilatation, cells): result}."""
    results = {}
    for dilatation in DILATATIONS:
        for n in BAR_BRICKS + ([LARGE_BAR_BRICKS] if options.large else []):
            print(f"bar of {24 * n**3} cells, {dilatation} ...", file=sys.stderr, flush=True)
            result = measure(options, "bar100k", failures, {
                "Mesh/Box cells": f"{4 * n}, {n}, {n}", "Model/Dilatation": dilatation, "Solver/Linear solver": "auto"},
                             ["--no-unit"] if n == LARGE_BAR_BRICKS else [])
            if result is not None:
                results[dilatation, result["cells"]] = result
    return results


def pose_functions(count):
    """Poses of which none is a combination of others: waves of each component along each other axis."""
    poses = []
    for i in range(count):
        component, frequency = i % 3, 1 + i // 6
        along = "xyz"[(component + 1 + i // 3 % 2) % 3]
        pose = ["x", "y", "z"]
        pose[component] += f" + {0.1 / frequency:.6g}*sin({3 * frequency}*{along})"
        poses.append("; ".join(pose))
    return " | ".join(poses)


def measure_growth_with_examples(options, failures):
    """The cat with so many examples beside the rest pose: {count: result}."""
    results = {}
    for count in EXAMPLE_COUNTS:
        print(f"cat with {count} examples ...", file=sys.stderr, flush=True)
        settings = {"Examples/Pose functions": pose_functions(count), "Examples/Include rest pose": "true",
                    "Examples/Importance": 0.8, "Examples/Energy": "scaled", "Examples/Weights": "simplex"} if count else {}
        result = measure(options, "cat_mid60", failures, settings)
        if result is not None:
            results[count] = result
    return results


def share(result):
    """Of the step's time that is not the linear solves."""
    parts = result["parts_ms"]
    total = sum(parts.values())
    return (total - parts["factorize"] - parts["solve"]) / total if total else 0


def number(value, digits=3):
    """For a table; a dash for what there is not."""
    if value is None:
        return "–"
    return f"{value:,.0f}" if abs(value) >= 1000 else f"{value:.{digits}g}"


def of_best(result, value, best):
    """A rate and its share of the machine's."""
    if value not in result:
        return "–"
    return f"{number(result[value])} ({result[value] / result[best]:.0%})"


def bar_name(dilatation, count):
    return f"bar {count} {dilatation}"


def row(name, result):
    steps = max(result["steps"], 1)
    error = number(result.get("worst_error"), 2)
    if result.get("steps_without_reference"):
        error += f" ({number(result['steps_without_reference'])} not compared)"
    return [name + (" (failed)" if "failed_step" in result else ""), number(result["cells"]), number(result["steps"]),
            number(result["mean_step_ms"]), *(number(result["parts_ms"][part]) for part in PARTS),
            number(result.get("unit_ms")), number(result.get("units")), error, number(result["cells_per_second"]),
            number(result["bytes_per_cell"]), number(result["iterations"] / steps),
            number(result["factorizations"] / steps), of_best(result, "factor_gflop_s", "dgemm_gflops"),
            of_best(result, "solve_gb_s", "triad_gb_s")]


def print_table(rows):
    """A markdown table, aligned."""
    widths = [max(len(cells[column]) for cells in rows) for column in range(len(rows[0]))]
    for index, cells in enumerate(rows):
        print("| " + " | ".join(cell.ljust(width) for cell, width in zip(cells, widths)) + " |")
        if index == 0:
            print("|" + "|".join("-" * (width + 2) for width in widths) + "|")
    print()


def print_results(results, cells, examples):
    named = {**results, **{bar_name(*key): result for key, result in cells.items()},
             **{f"cat_mid60, {count} examples": result for count, result in examples.items()}}
    if not named:
        return
    head = ["scene", "cells", "steps", "ms a step", *PARTS, "unit, ms", "units a step", "worst error", "cells/s",
            "bytes a cell", "iterations", "factorisations", "factor GFLOP/s (of dgemm)", "solve GB/s (of triad)"]
    print_table([head, *(row(name, result) for name, result in named.items())])
    first = next(iter(named.values()))
    print(f"Mean over all steps, by part in ms; {first['blas']}, core type {first['blas_core']}, one thread", end="")
    machine = [result for result in named.values() if "dgemm_gflops" in result]
    if machine:
        print(f"; dgemm {number(statistics.median(result['dgemm_gflops'] for result in machine))} GFLOP/s, "
              f"triad {number(statistics.median(result['triad_gb_s'] for result in machine))} GB/s", end="")
    print(".\n")


def write_csv(file, head, rows):
    with open(file, "w", newline="") as out:
        csv.writer(out, lineterminator="\n").writerows([head, *rows])
    print(f"wrote {file}")


def write_growths(directory, cells, examples):
    """Processor time, as the machine may be shared; of examples the time over that without."""
    if cells:
        write_csv(directory / "growth_cells.csv", ["dilatation", "cells", "ms_step"],
                  [(*key, f"{result['mean_step_cpu_ms']:.4g}") for key, result in cells.items() if "failed_step" not in result])
    ratios = example_ratios(examples)
    if ratios:
        write_csv(directory / "growth_examples.csv", ["examples", "ratio"],
                  [(count, f"{ratio:.4g}") for count, ratio in ratios.items()])


def example_ratios(examples):
    """Time of a step with so many examples to that without, each in its own units: {count: ratio}."""
    complete = {count: result for count, result in examples.items() if "failed_step" not in result}
    if 0 not in complete:
        return {}
    return {str(count): result["units"] / complete[0]["units"] for count, result in complete.items()}


def ratios_of(results, cells, examples):
    """What a baseline holds: {name: {what: ratio}}; no times, which depend on the machine."""
    ratios = {}
    for name, result in {**results, **{bar_name(*key): result for key, result in cells.items()}}.items():
        if "failed_step" in result:
            continue
        entry = {"steps": result["steps"], "share": share(result)}
        entry.update({key: result[key] for key in ("units", "worst_error") if result.get(key) is not None})
        ratios[name] = entry
    for count, ratio in example_ratios(examples).items():
        ratios[f"examples {count}"] = {"steps": examples[int(count)]["steps"], "ratio": ratio}
    return ratios


def compare(ratios, baseline):
    """Lines on what got worse, and on what cannot be compared."""
    for name, now in ratios.items():
        before = baseline.get(name)
        if before is None:
            yield f"{name}: not in the baseline"
        elif before["steps"] != now["steps"]:
            yield f"{name}: {now['steps']} steps, in the baseline {before['steps']}: not compared"
        else:
            for what in sorted(before.keys() & now.keys() & LEAST.keys()):
                if now[what] > WORSE * max(before[what], LEAST[what]):
                    yield f"{name}: WORSE: {what} is {now[what]:.3g}, was {before[what]:.3g}"


def report_baseline(options, ratios):
    if options.write_baseline:
        rounded = {name: {what: float(f"{value:.3g}") if isinstance(value, float) else value
                          for what, value in entry.items()} for name, entry in ratios.items()}
        before = json.loads(BASELINE.read_text()) if BASELINE.exists() else {}
        BASELINE.write_text(json.dumps({**before, **rounded}, indent=1) + "\n")
        print(f"wrote {BASELINE}")
    elif not BASELINE.exists():
        print("There is no baseline to compare with; --write-baseline makes one.")
    else:
        lines = list(compare(ratios, json.loads(BASELINE.read_text())))
        print("\n".join(lines) or f"Nothing is worse than the baseline by more than {WORSE - 1:.0%}.")


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", metavar="SCENE", nargs="*", help="what to measure instead of everything")
    parser.add_argument("--large", action="store_true", help="measure a million cells, too")
    parser.add_argument("--steps", type=int, help="measure so many steps of each scene only")
    parser.add_argument("--repeats", type=int, default=3, help="runs of which the median is taken")
    parser.add_argument("--set", action="append", default=[], help="setting of all scenes")
    parser.add_argument("--program", type=Path, default=TOP / "build/release/tests/benchmark/benchmark_steps")
    parser.add_argument("--output", type=Path, default=TOP / "output/benchmarks", help="directory of the results")
    parser.add_argument("--write-baseline", action="store_true", help="what is measured becomes the baseline")
    options = parser.parse_args()
    known = [*SCENES, *VARIANTS, LARGE_SCENE, *GROWTHS]
    unknown = [name for name in options.names if name not in known]
    if unknown:
        parser.error(f"no scene {', '.join(unknown)}; there are {', '.join(known)}")
    if options.steps is not None and options.steps < 1 or options.repeats < 1:
        parser.error("--steps and --repeats are at least 1")
    if not options.program.exists():
        parser.error(f"{options.program} is missing: ninja -C build/release benchmark_steps")
    if options.write_baseline and (options.set or options.steps):
        parser.error("a baseline is of scenes as they are")
    options.names = options.names or [*SCENES, *VARIANTS] + ([LARGE_SCENE] if options.large else []) + GROWTHS
    return options


def main():
    options, failures = parse_arguments(), Failures()
    results = {name: measure_scene(options, name, failures) for name in options.names if name not in GROWTHS}
    results = {name: result for name, result in results.items() if result is not None}
    cells = measure_growth_with_cells(options, failures) if "growth-cells" in options.names else {}
    examples = measure_growth_with_examples(options, failures) if "growth-examples" in options.names else {}

    options.output.mkdir(parents=True, exist_ok=True)
    everything = {"scenes": results, "cells": {bar_name(*key): result for key, result in cells.items()}, "examples": examples}
    (options.output / "results.json").write_text(json.dumps(everything, indent=1) + "\n")
    print_results(results, cells, examples)
    write_growths(options.output, cells, examples)
    report_baseline(options, ratios_of(results, cells, examples))
    sys.exit(bool(failures.seen))


if __name__ == "__main__":
    main()
