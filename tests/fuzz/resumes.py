# SPDX-License-Identifier: GPL-3.0-or-later
"""Small scenes of all features, resumed at three steps each: the same bytes as the run that nobody stopped.

    python3 tests/fuzz/resumes.py --exemplar build/release/exemplar --runs 400 --seed 1

Odd numbers are static scenes, even ones dynamic. A scene draws a body, a law, a method and some features at random; a
combination that the program does not allow (exit status 1) is drawn again. `--resume` starts from a copy of the directory
whose checkpoint is the state that was kept for the step, as after a crash there; `--resume-from` starts from the finished
run. Prints a line for each scene that differs, and counts at the end; --keep leaves the directories of those."""

import argparse
import collections
import concurrent.futures
import pathlib
import random
import shutil
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "scenes"))
from exemplar_runner import call_program, prm, results
from piece_boxes import Box, write_boxes

STEPS = 12
BAR = {"Mesh/Generator": "box", "Mesh/Box size": "2, 1, 1", "Mesh/Box cells": "3, 2, 2"}
SOFT = {"Material/Young's modulus": "1e4", "Material/Poisson's ratio": "0.3", "Material/Density": "10"}
HELD = {"Handles/Names": "left", "Handles/left/Select": "boundary 1"}
STATIC = {"Scene": "static", "Time/Increments": str(STEPS)}
DYNAMIC = {"Scene": "dynamic", "Time/Step": "0.01", "Time/End": f"{0.01 * STEPS:g}"}
POSES = "1.3*x; y; z | x; y; z+0.2*x^2"
SHEET = "".join(f"v {x / 3:.9g} {y / 3:.9g} {0.02 * x * (3 - x):.9g}\n" for y in range(4) for x in range(7)) + "".join(
    f"f {a} {a + 1} {a + 8}\nf {a} {a + 8} {a + 7}\n" for y in range(3) for a in range(7 * y + 1, 7 * y + 7))


def added(keys, section, names):
    """{"Section/Names": ...} with more names."""
    return {f"{section}/Names": ", ".join(filter(None, [keys.get(f"{section}/Names"), *names]))}


def law(r):
    return r.choice([{}, {}, {"Model/Strain": "green"}, {"Model/Background": "neo-hookean"}, {"Model/Element": "P2"},
                     {"Material/Yield stress": "300", "Material/Kinematic hardening": "1e3"},
                     {"Material/Relaxation time": "0.1"}, {"Material/Poisson's ratio": "0.49"},
                     {"Material/Yield stress": "200", "Material/Flow viscosity": "20"},
                     {"Material/Fibre stiffness": "1e4", "Material/Fibre direction": "1; 0; 0.3"}])


def tension(_r, _keys):
    return {"Material/Fibre direction": "1; 0.2; 0", "Material/Fibre tension": "1000*T"}


def curved_tension(_r, _keys):
    return {**tension(None, None), "Material/Fibre tension curve": "0.5: 0; 1: 1; 1.5: 0"}


def examples(r, _keys):
    keys = {"Examples/Pose functions": POSES, "Examples/Importance": r.choice(["0.5", "0.8"])}
    kind = r.choice(["simplex", "free", "prescribed", "additive"])
    keys["Examples/Weights"] = kind
    if kind == "prescribed":
        keys["Examples/Prescribed weights"] = "1-0.8*T; 0.5*T; 0.3*T"
    if kind != "prescribed" and r.random() < 0.5:
        keys["Examples/Yield"] = "3"
        if r.random() < 0.5:
            keys["Examples/Creep viscosity"] = "3"
    if r.random() < 0.3:
        keys["Examples/Energy"] = r.choice(["scaled", "blended"])
    return keys


def moving_end(r, keys):
    timed = r.choice([{}, {}, {"Handles/right/Until": "U"}, {"Handles/right/From": "U"}])
    return {**added(keys, "Handles", ["right"]), "Handles/right/Select": "boundary 2", "Handles/right/Motion": "0.3*T; 0; 0.2*T*T",
            "Handles/right/Components": r.choice(["x, y, z", "x", "z"]), **timed}


def loads(r, keys):
    return {**added(keys, "Loads", ["tip"]), "Loads/tip/Select": "boundary 2",
            "Loads/tip/Force": r.choice(["0; 0; -200*T", "100*T; 50*sin(9*T); 0"])}


def gravity(r, _keys):
    return {"Loads/Gravity": "0, 0, -9.81", **r.choice([{}, {"Loads/Balanced": "true"}])}


def floor(r, keys):
    shape = r.choice(["plane 0 0 -0.52 0 0 1", "sphere 1.5 0 -1.53 1", "box 1 -2 -1 3 2 -0.52", "plane 0 0 -0.5 0 0 1"])
    timed = r.choice([{}, {}, {}, {"Obstacles/floor/Until": "U"}])
    motion = r.choice(["0; 0; 0", "0; 0; 0.1*T", "0.2*T; 0; 0.1*T"])
    return {**added(keys, "Obstacles", ["floor"]), "Obstacles/floor/Shape": shape, "Obstacles/floor/Motion": motion,
            "Obstacles/floor/Friction": r.choice(["0", "0.5"]), "Loads/Gravity": "0, 0, -9.81", **timed}


def plates(r, keys):
    """Nothing holds the body but two plates that press it."""
    return {"Handles/Names": None, "Handles/left/Select": None, **added(keys, "Obstacles", ["below", "above"]),
            "Obstacles/below/Shape": "plane 0 0 -0.5 0 0 1", "Obstacles/above/Shape": "plane 0 0 0.5 0 0 -1",
            "Obstacles/above/Motion": r.choice(["0; 0; -0.2*T", "0.1*T; 0; -0.2*T"]), "Obstacles/below/Friction": "0.5",
            "Obstacles/above/Friction": "0.5", "Obstacles/Free": r.choice(["friction", "weak springs"])}


def regions(_r, _keys):
    return {"Examples/Regions": "auto", "Examples/Pose functions": "x; y; z+0.3*max(0,0.8-x)^2 | x; y; z+0.3*max(0,x-1.2)^2"}


def method(r, scene):
    names = ["auto", "newton", "fixed point"] if scene is STATIC else ["auto", "auto", "newton", "quasi newton", "one pass",
                                                                       "fixed point"]
    return {"Solver/Method": r.choice(names), **r.choice([{}, {}, {}, {"Solver/Linear solver": "iterative"},
                                                          {"Solver/Background factor": "true"}, {"Solver/Linear solver": "umfpack"}])}


def time_scheme(r):
    return {**r.choice([{}, {"Time/Scheme": "bdf2"}]), **r.choice([{}, {}, {"Time/Mass damping": "1"}, {"Time/Stiffness damping": "0.01"}]),
            **r.choice([{}, {"Initial/Velocity": "0; 0; x"}])}


def two_pieces(r, directory):
    write_boxes(directory / "pieces.msh", Box((0, -.5, -.5), (2, .5, .5), (3, 2, 2)), Box((.4, -.4, .53), (1.4, .4, 1.13), (2, 2, 1)))
    keys = {"Mesh/File": "pieces.msh", "Handles/Names": "left", "Handles/left/Select": "box -0.1 -9 -9 0.1 9 9",
            "Loads/Gravity": "0, 0, -9.81"}
    if r.random() < 0.7:
        return {**keys, "Contact/Bodies": "true", "Contact/Friction": r.choice(["0", "0.5"]), "Handles/Names": "left, top",
                "Handles/top/Select": "box 0.3 -9 1.1 1.5 9 9", "Handles/top/Motion": r.choice(["0; 0; -0.2*T", "0.1*T; 0; -0.2*T"])}
    return {**keys, "Ties/Names": "glue", "Ties/glue/Select": "box 0.3 -9 0.52 1.5 9 0.54", "Ties/glue/To": "box -1 -9 0.49 3 9 0.51",
            "Ties/glue/Reach": "0.05"}


def shell(r, directory):
    (directory / "sheet.obj").write_text(SHEET)
    keys = {"Mesh/Kind": "shell", "Mesh/File": "sheet.obj", "Material/Thickness": "0.02", "Material/Young's modulus": "1e6",
            "Handles/Names": "left", "Handles/left/Select": "box -1 -1 -1 1e-6 9 9", "Handles/left/Slopes": r.choice(["held", "auto"]),
            "Model/Shell": r.choice(["plate", "hinges"]), "Loads/Gravity": "0, 0, -9.81"}
    if r.random() < 0.7:
        keys.update({"Handles/Names": "left, right", "Handles/right/Select": "box 1.99 -1 -1 9 9 9", "Handles/right/Motion": "0; 0; 0.2*T",
                     "Handles/right/Slopes": r.choice(["held", "free"]),
                     f"Handles/right/{r.choice(['Until', 'From'])}": r.choice(["U", "U", None])})
    if r.random() < 0.4:
        keys.update({"Obstacles/Names": "floor", "Obstacles/floor/Shape": "sphere 1 0.5 -0.4 0.3", "Obstacles/floor/Motion": "0; 0; 0.2*T",
                     "Obstacles/floor/Friction": r.choice(["0", "0.5"])})
    if r.random() < 0.4:
        keys["Examples/Pose functions"] = "x; y; z+0.1*x^2"
    return keys


def drawn(r, kind, directory):
    """A scene, which the program may not allow."""
    body = r.random()
    keys = {**SOFT, **kind}
    if body < 0.2:
        keys.update(shell(r, directory))
    elif body < 0.35:
        keys.update({**two_pieces(r, directory), **law(r)})
    else:
        keys.update({**BAR, **HELD, **law(r)})
        features = [tension, curved_tension, examples, examples, moving_end, loads, gravity, floor, floor, regions]
        chosen = r.sample(features, r.randint(1, 4)) if r.random() < 0.8 else [plates]
        for feature in chosen:
            keys.update(feature(r, keys))
    keys.update(method(r, kind))
    if kind is DYNAMIC:
        keys.update(time_scheme(r))
    end = 1. if kind is STATIC else 0.01 * STEPS
    until = f"{end * r.randint(2, STEPS - 2) / STEPS:g}"
    grows = "t" if kind is STATIC else f"(t/{end:g})"
    changed = {}
    for key, value in keys.items():
        if value is not None and key.split("/")[-1] in ("Motion", "Force", "Fibre tension", "Prescribed weights"):
            value = value.replace("T", grows)
        changed[key] = until if value == "U" else value
    return {**changed, "Output/Keep states": "true", "Solver/Maximum iterations": "200", "Output/Formats": "vtu"}


def attempt(program, directory, output, *arguments):
    return call_program("scene.prm", "--quiet", "--threads", "1", "--output", output, *arguments, program=program, cwd=directory,
                        timeout=120)


def differences(whole, parts):
    names = sorted(name for name in whole.keys() | parts.keys() if whole.get(name) != parts.get(name))
    return ", ".join(names[:3]) + (f" and {len(names) - 3} more" if len(names) > 3 else "")


def resumed(program, directory, step, how):
    """What differs after a resume at a step; empty: nothing."""
    parts = directory / f"{how}{step}"
    shutil.copytree(directory / "whole", parts)
    arguments = ["--resume-from", str(step)]
    if how == "resume":
        shutil.copy(parts / f"state_{step:04}.bin", parts / "checkpoint.bin")
        for name in ("final.msh", "summary.json"):
            (parts / name).unlink(missing_ok=True)
        arguments = ["--resume"]
    run = attempt(program, directory, parts.name, *arguments)
    if run.returncode:
        return f"status {run.returncode}: {run.stderr.strip()[-200:]}"
    return differences(results(directory / "whole"), results(parts))


def trial(program, seed, number, keep):
    """(what came out, words) of a scene."""
    r = random.Random(f"resumes {seed} {number}")
    kind = STATIC if number % 2 else DYNAMIC
    with tempfile.TemporaryDirectory(prefix="resumes") as holder:
        directory = pathlib.Path(holder)
        for _ in range(30):
            keys = drawn(r, kind, directory)
            (directory / "scene.prm").write_text(prm(keys))
            shutil.rmtree(directory / "whole", ignore_errors=True)
            run = attempt(program, directory, "whole")
            if run.returncode != 1:
                break
        if run.returncode:
            return ("not allowed" if run.returncode == 1 else "failed"), f"{number}: {run.stderr.strip()[-200:]}"
        words = [f"{how} {step}: {found}" for step in sorted(r.sample(range(1, STEPS), 3)) for how in ("resume", "resume-from")
                 if (found := resumed(program, directory, step, how))]
        if words and keep:
            shutil.copytree(directory, pathlib.Path(keep) / f"{number}", dirs_exist_ok=True)
        return ("differs" if words else "same"), f"{number}: " + "; ".join(words)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--exemplar", default="build/release/exemplar")
    parser.add_argument("--runs", type=int, default=100)
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--keep", help="directory for the scenes that differ")
    options = parser.parse_args()
    program = pathlib.Path(options.exemplar).resolve()
    counts = collections.Counter()
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        numbers = range(options.first, options.first + options.runs)
        for what, words in pool.map(lambda number: trial(program, options.seed, number, options.keep), numbers):
            counts[what] += 1
            if what != "same":
                print(what, words, flush=True)
    print(dict(counts))
    sys.exit(counts["differs"] > 0)


if __name__ == "__main__":
    main()
