# SPDX-License-Identifier: GPL-3.0-or-later
"""Legitimate scenes under the audit of energies: none of them may fail by it.

    python3 tests/fuzz/audit.py --exemplar build/release/exemplar --runs 500 --seed 1

Scenes are random and small: arches that snap through, bodies that yield in cycles, twisted bars, pressed and rolled blocks, tied pieces, balloons,
muscles, prescribed and found weights, sheets, and recorded sessions, with laws, elements, methods, tolerances and numbers of increments of their
own, static and dynamic. Prints a line a failure of the audit, with the scene's number, and counts at the end; scenes that fail for other reasons
are only counted. --keep leaves the directories of failures."""

import argparse
import collections
import concurrent.futures
import math
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "scenes"))
from drops import write
from piece_boxes import Box, write_boxes

ROOT = pathlib.Path(__file__).resolve().parents[2]
BAR = {"Mesh/Generator": "box", "Mesh/Box size": "0.8, 0.2, 0.2"}
ENDS = {"Handles/Names": "left, right", "Handles/left/Select": "boundary 1", "Handles/right/Select": "boundary 2"}


def number(x):
    return f"{x:.6g}"


def cells(rng):
    return {"Mesh/Box cells": rng.choice(["3, 1, 1", "6, 2, 2", "8, 2, 2", "8, 3, 3"])}


def wave(rng, size):
    """A function of t from 0, smooth or not, there or there and back."""
    a, n = number(size * rng.uniform(.1, 1)), rng.randint(1, 3)
    return rng.choice([f"{a}*t", f"{a}*sin({2 * n}*pi*t)", f"{a}*sin({n}*pi*t)", f"{a}*min(2*t, 1)", f"{a}*t*t", f"{a}*(t > 0.3 ? 1 : 0)",
                       f"{a}*max(t - 0.4, 0)", f"{a}*(1 - abs(1 - {2 * n}*t))"])


def motion(rng, size):
    return "; ".join(rng.choice(["0", wave(rng, size)]) for _ in range(3))


def law(rng):
    kind = rng.choice(["plain", "plain", "soft", "plastic", "plastic", "neo", "neo", "visco", "fibres", "green", "linear"])
    keys = {"Material/Young's modulus": number(10 ** rng.uniform(3, 8)), "Material/Poisson's ratio": number(rng.choice([0, .3, .45, .49, .499]))}
    young = float(keys["Material/Young's modulus"])
    if kind == "plastic":
        keys |= {"Material/Yield stress": number(young * 10 ** rng.uniform(-3, -1)),
                 "Material/Kinematic hardening": number(rng.choice([0, .01, .3]) * young),
                 "Material/Isotropic hardening": number(rng.choice([0, .01, .3]) * young),
                 "Material/Flow viscosity": number(rng.choice([0, 0, 1e-3]) * young)}
    elif kind == "neo":
        keys["Model/Background"] = "neo-hookean"
    elif kind == "visco":
        keys |= {"Material/Relaxation time": number(10 ** rng.uniform(-2, 0)), "Material/Relaxing share": number(rng.uniform(.1, .9))}
    elif kind == "fibres":
        keys |= {"Material/Fibre stiffness": number(young * 10 ** rng.uniform(-1, 1)), "Material/Fibre direction": "1; 0.3; x"}
    elif kind in ("green", "linear"):
        keys["Model/Strain"] = kind
    if rng.random() < .2:
        keys["Model/Element"] = "P2"
    if rng.random() < .3:
        keys["Model/Dilatation"] = rng.choice(["cells", "patches"])
    return keys


def steps(rng):
    if rng.random() < .5:
        return {"Scene": "static", "Time/Increments": str(rng.choice([2, 3, 5, 10, 20, 40]))}
    n, h = rng.choice([10, 20, 40]), 10 ** rng.uniform(-3, -1)
    return {"Scene": "dynamic", "Time/Step": number(1. / n if rng.random() < .5 else h), "Time/End": number(1. if rng.random() < .5 else n * h),
            "Time/Mass damping": number(rng.choice([0, 0, 5])), "Time/Stiffness damping": number(rng.choice([0, 0, 1e-2]))}


def solver(rng, keys):
    keys["Solver/Maximum iterations"] = "300"
    method = rng.choice(["auto", "newton"] if keys["Scene"] == "static" or "Contact/Bodies" in keys else ["auto", "newton", "quasi newton"])
    if rng.random() < .15 and not {"Obstacles/Names", "Contact/Bodies"} & set(keys):
        method = "fixed point"
    if method != "auto":
        keys["Solver/Method"] = method
    if keys["Scene"] == "static":
        keys.pop("Material/Flow viscosity", None)
    if keys.get("Model/Strain") == "green":
        keys.pop("Model/Dilatation", None)
    if rng.random() < .3:
        keys["Solver/Tolerance"] = rng.choice(["1e-4", "1e-6", "1e-11"])
    if rng.random() < .2 and keys["Scene"] == "dynamic":
        keys["Solver/Step tolerance"] = rng.choice(["1e-2", "1e-5"])
    return keys


def arch(rng, directory):
    rise, n = rng.uniform(.02, .2), rng.choice([8, 12, 16])
    write_boxes(directory / "arch.msh", Box((0, 0, 0), (1, .1, .04), (n, 1, rng.choice([1, 2])),
                                            lambda x, y, z: (x, y, z + rise * math.sin(math.pi * x))))
    keys = {"Mesh/File": "arch.msh", "Handles/Names": "left, right", "Handles/left/Select": "box -1 -1 -1 1e-6 1 1",
            "Handles/right/Select": "box 0.999999 -1 -1 2 1 1"}
    middle = "box 0.45 -1 -1 0.55 1 1"
    if rng.random() < .6:
        keys |= {"Handles/Names": "left, right, top", "Handles/top/Select": middle, "Handles/top/Components": "z",
                 "Handles/top/Motion": f"0; 0; -{number(rise * rng.uniform(.5, 3))}*{rng.choice(['t', 'sin(pi*t)', 'sin(2*pi*t)'])}"}
    else:
        keys |= {"Loads/Names": "top", "Loads/top/Select": middle, "Loads/top/Force": f"0; {number(rng.choice([0, .1]))}; -{number(10 ** rng.uniform(-1, 4))}",
                 "Loads/Ramp": rng.choice(["increments", "increments", "none"])}
    return keys


def dragged(rng, _):
    keys = BAR | cells(rng) | ENDS | {"Handles/right/Motion": motion(rng, .4)}
    if rng.random() < .2:
        keys |= {"Handles/right/Components": rng.choice(["x", "z", "x, y"]), "Handles/right/Motion": f"{wave(rng, .3)}; 0; 0"}
    if rng.random() < .2:
        keys |= {"Handles/right/From": number(rng.uniform(0, .5)), "Handles/right/Until": number(rng.uniform(.5, 1))}
    return keys


def twisted(rng, _):
    a = f"({wave(rng, rng.choice([1, 3, 6]))})"
    turn = f"0; y*(cos{a}-1)-z*sin{a}; z*(cos{a}-1)+y*sin{a}"
    bend = f"(x-0.4)*(cos{a}-1)+z*sin{a}; 0; z*(cos{a}-1)-(x-0.4)*sin{a}"
    return BAR | cells(rng) | ENDS | {"Handles/right/Motion": rng.choice([turn, bend])}


def loaded(rng, _):
    force = 10 ** rng.uniform(-1, 4)
    return BAR | cells(rng) | {"Handles/Names": "left", "Handles/left/Select": "boundary 1", "Loads/Names": "tip", "Loads/tip/Select": "boundary 2",
                               "Loads/tip/Force": motion(rng, force), "Loads/Gravity": f"0, 0, -{number(rng.choice([0, 9.81, 100]))}"}


def examples(rng, _):
    keys = rng.choice([dragged, loaded, twisted])(rng, _)
    poses = ["x; y*cos(2*x)-z*sin(2*x); y*sin(2*x)+z*cos(2*x)", "sin(x)+0*y; y; z+1-cos(x)", "1.2*x; 0.9*y; 0.9*z", "0.8*x; y; z + 0.2*x*x"]
    chosen = rng.sample(poses, rng.randint(1, 3))
    keys |= {"Examples/Pose functions": " | ".join(chosen), "Examples/Importance": number(rng.uniform(.2, 1)),
             "Examples/Energy": rng.choice(["scaled", "blended", "mixed"])}
    kind = rng.choice(["simplex", "free", "prescribed", "prescribed", "additive", "yield"])
    if kind == "prescribed":
        shares = [f"({wave(rng, 1)})" for _ in chosen]
        keys |= {"Examples/Weights": "prescribed", "Examples/Prescribed weights": "; ".join(["1-" + "-".join(shares)] + shares)}
    elif kind == "yield":
        keys["Examples/Yield"] = number(10 ** rng.uniform(-2, 4))
    else:
        keys["Examples/Weights"] = kind
    return keys


def muscle(rng, _):
    keys = rng.choice([dragged, loaded])(rng, _)
    keys |= {"Material/Fibre direction": rng.choice(["1; 0; 0", "1; 0.5; 0"]),
             "Material/Fibre tension": f"{number(10 ** rng.uniform(2, 5))}*{rng.choice(['t', 'abs(sin(3*pi*t))', '(t > 0.5 ? 1 : 0)', '(1 + x)*t*t', '1'])}"}
    if rng.random() < .5:
        keys["Material/Fibre tension curve"] = "0.5: 0; 1: 1; 1.5: 0"
    return keys


def pressed(rng, _):
    """Between the floor and what moves or turns, held at one end or not at all."""
    size = rng.choice(["0.8, 0.2, 0.2", "0.2, 0.2, 0.2"])
    keys = {"Mesh/Generator": "box", "Mesh/Box size": size, **cells(rng), "Obstacles/Names": "floor, press",
            "Obstacles/floor/Shape": f"plane 0 0 {number(-.1 - rng.choice([0., .002, .02]))} 0 0 1"}
    x = .4 if size.startswith("0.8") else .1
    keys["Obstacles/press/Shape"] = rng.choice([f"sphere {x} 0 0.2 0.08", f"capsule {x} -0.4 0.2 {x} 0.4 0.2 0.08",
                                               f"box {x - .1} -0.1 0.12 {x + .1} 0.1 0.3", "plane 0 0 0.12 0 0 -1"])
    side = rng.choice(["0", wave(rng, .1)])
    keys["Obstacles/press/Motion"] = f"{side}; 0; {rng.choice([f'-{number(rng.uniform(.02, .1))}*min({rng.randint(1, 3)}*t,1)', f'-0.06*sin(pi*t)'])}"
    if rng.random() < .4:
        keys["Obstacles/press/Turn"] = f"0; {number(rng.uniform(-4, 4))}*t; 0"
    for obstacle in ("floor", "press"):
        keys[f"Obstacles/{obstacle}/Friction"] = number(rng.choice([0, .2, .6]))
    if rng.random() < .7:
        keys |= {"Handles/Names": "left", "Handles/left/Select": "boundary 1"}
    else:
        keys["Obstacles/Free"] = rng.choice(["friction", "weak springs"])
    if rng.random() < .5:
        keys["Loads/Gravity"] = "0, 0, -9.81"
    return keys


def pieces(rng, directory):
    """Two blocks, of which one is moved: tied, or meeting each other."""
    gap = rng.choice([0., .01])
    write_boxes(directory / "pieces.msh", Box((0, 0, 0), (.4, .2, .2), (4, 2, 2)), Box((.4 + gap, .03, -.02), (.8, .17, .22), (4, 2, 2)))
    keys = {"Mesh/File": "pieces.msh", "Handles/Names": "left, right", "Handles/left/Select": "box -1 -1 -1 1e-6 1 1",
            "Handles/right/Select": "box 0.799999 -1 -1 2 1 1", "Handles/right/Motion": motion(rng, .1)}
    if gap == 0 or rng.random() < .5:
        keys |= {"Ties/Names": "seam", "Ties/seam/Select": f"box {.4 + gap - 1e-6} -1 -1 {.4 + gap + 1e-6} 1 1", "Ties/seam/To": "box -1 -1 -1 0.400001 1 1",
                 "Ties/seam/Stiffness": rng.choice(["rigid", "1e6", "1e9"])}
        if gap == 0:
            keys["Ties/seam/Select"] = "box 0.399999 0.02 -1 0.400001 0.18 1"
    else:
        keys |= {"Handles/right/Motion": f"-{number(rng.uniform(.01, .1))}*t; {wave(rng, .1)}; 0", "Contact/Bodies": "true",
                 "Contact/Friction": number(rng.choice([0, .3]))}
    return keys


def sheet_of(file, point, n, m, closed):
    lines = [f"v {' '.join(map(number, point(i / n, j / m)))}" for j in range(m + 1) for i in range(n + (0 if closed else 1))]
    width = n if closed else n + 1
    at = lambda i, j: j * width + i % width + 1
    for j in range(m):
        for i in range(n):
            a, b, c, d = at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)
            lines += [f"f {a} {b} {c}", f"f {a} {c} {d}"] if (i + j) % 2 else [f"f {a} {b} {d}", f"f {b} {c} {d}"]
    file.write_text("\n".join(lines) + "\n")


def sheet(rng, directory):
    kind = rng.choice(["plate", "roof", "tube"])
    rise = rng.uniform(.02, .1)
    point = {"plate": lambda u, v: (u, .5 * v, 0), "roof": lambda u, v: (u, .5 * v, rise * math.sin(math.pi * u)),
             "tube": lambda u, v: (v, .2 * math.cos(2 * math.pi * u), .2 * math.sin(2 * math.pi * u))}[kind]
    sheet_of(directory / "sheet.obj", point, 10, 6, kind == "tube")
    keys = {"Mesh/Kind": "shell", "Mesh/File": "sheet.obj", "Material/Thickness": number(10 ** rng.uniform(-3, -1.7)),
            "Material/Young's modulus": number(10 ** rng.uniform(5, 8)), "Material/Poisson's ratio": "0.3", "Handles/Names": "left, right",
            "Handles/left/Select": "box -1 -1 -1 1e-6 1 1", "Handles/right/Select": "box 0.999999 -1 -1 2 1 1",
            "Model/Shell": rng.choice(["plate", "plate", "hinges"])}
    if rng.random() < .5:
        keys["Handles/right/Motion"] = motion(rng, .2)
    else:
        keys["Loads/Gravity"] = f"0, 0, -{number(10 ** rng.uniform(-1, 1))}"
        if kind == "roof":
            keys |= {"Handles/Names": "left, right, top", "Handles/top/Select": "box 0.45 0.2 -1 0.55 0.3 1", "Handles/top/Components": "z",
                     "Handles/top/Motion": f"0; 0; -{number(rise * rng.uniform(.5, 2.5))}*t"}
    if rng.random() < .4 and keys["Model/Shell"] == "plate":
        keys["Handles/left/Slopes"] = "held"
    return keys


def balloon(rng, directory):
    lines, n, m = [], 10, 6
    ring = [(.2 * math.sin(math.pi * j / m) * math.cos(2 * math.pi * i / n), .2 * math.sin(math.pi * j / m) * math.sin(2 * math.pi * i / n),
             .2 * math.cos(math.pi * j / m)) for j in range(1, m) for i in range(n)]
    lines = [f"v {' '.join(map(number, p))}" for p in [(0, 0, .2), *ring, (0, 0, -.2)]]
    at, last = lambda i, j: 2 + j * n + i % n, len(lines)
    for i in range(n):
        lines += [f"f 1 {at(i, 0)} {at(i + 1, 0)}", f"f {last} {at(i + 1, m - 2)} {at(i, m - 2)}"]
        for j in range(m - 2):
            lines += [f"f {at(i, j)} {at(i, j + 1)} {at(i + 1, j + 1)}", f"f {at(i, j)} {at(i + 1, j + 1)} {at(i + 1, j)}"]
    (directory / "ball.obj").write_text("\n".join(lines) + "\n")
    keys = {"Mesh/Kind": "shell", "Mesh/File": "ball.obj", "Material/Thickness": "0.01", "Material/Young's modulus": number(10 ** rng.uniform(5, 7)),
            "Material/Volume stiffness": number(10 ** rng.uniform(2, 6)), "Handles/Names": "bottom", "Handles/bottom/Select": "box -1 -1 -1 1 1 -0.17"}
    if rng.random() < .5:
        keys |= {"Handles/Names": "bottom, top", "Handles/top/Select": "box -1 -1 0.17 1 1 1", "Handles/top/Motion": motion(rng, .1)}
    else:
        keys |= {"Obstacles/Names": "press", "Obstacles/press/Shape": "plane 0 0 0.21 0 0 -1",
                 "Obstacles/press/Motion": f"0; 0; -{number(rng.uniform(.03, .12))}*{rng.choice(['t', 'sin(pi*t)'])}"}
    return keys


def session(rng, directory):
    """What a hand does while the scene runs."""
    keys = rng.choice([dragged, loaded, pressed])(rng, directory)
    keys.pop("Handles/right/From", None), keys.pop("Handles/right/Until", None)
    keys["Mesh/Box cells"] = "6, 2, 2"
    at = sorted(rng.sample(range(2, 20), 4))
    nodes = rng.sample(range(10, 40), 3)
    words = " ".join(map(str, nodes))
    springs = " ".join("0.333 0 0 0" for _ in nodes)
    events = rng.choice([
        [f"{at[0]} | grab | a | {words} | {springs} 0.4 0 0 {number(10 ** rng.uniform(1, 4))}", f"{at[1]} | move | a | | 0.4 0.2 0.1",
         f"{at[2]} | move | a | | 0.3 -0.2 0.2", f"{at[3]} | release | a | |"],
        [f"{at[0]} | young | | | {number(10 ** rng.uniform(3, 7))}", f"{at[1]} | gravity | | | 0 0 -30", f"{at[2]} | gravity | | | 0 5 0",
         f"{at[3]} | poisson | | | 0.2"]])
    (directory / "hand.txt").write_text("exemplar session 1\n" + "\n".join(events) + "\n")
    return keys | {"Session/File": "hand.txt"}


def scene(n, seed, directory, families):
    rng = random.Random(f"audit {seed} {n}")
    family = rng.choice(families)
    keys = FAMILIES[family](rng, directory)
    keys = (law(rng) if keys.get("Mesh/Kind") != "shell" else {}) | keys | steps(rng)
    if family == "twisted" and keys.get("Model/Strain") == "linear":
        keys.pop("Model/Strain")  # to which a turn is a strain
    if family == "session":
        keys |= rng.choice([{"Scene": "static", "Time/Increments": "20"}, {"Scene": "dynamic", "Time/Step": "0.02", "Time/End": "0.5"}])
    if keys.get("Scene") == "dynamic":
        keys.pop("Loads/Ramp", None), keys.pop("Obstacles/Free", None)
    return family, solver(rng, keys) | {"Output/Every": "0"}


FAMILIES = {f.__name__: f for f in (arch, dragged, twisted, loaded, examples, muscle, pressed, pieces, sheet, balloon, session)}


def run(n, arguments):
    directory = pathlib.Path(tempfile.mkdtemp(prefix=f"audit{n}_", dir=arguments.directory and pathlib.Path(arguments.directory).resolve()))
    family, keys = scene(n, arguments.seed, directory, arguments.families.split(","))
    write(keys, directory / "scene.prm")
    try:
        done = subprocess.run([arguments.exemplar, str(directory / "scene.prm"), "--output", str(directory / "out"), "--threads", "1"],
                              capture_output=True, text=True, timeout=arguments.timeout)
        status, text = done.returncode, done.stderr
    except subprocess.TimeoutExpired:
        status, text = "timeout", ""
    failed = status == 2 and ("the work on the body is only" in text or "the stored energy is" in text)
    kind = "failed by the audit" if failed else f"status {status}"
    gained = "have risen by" in text
    if not (arguments.keep and (failed or (gained and arguments.gains))):
        shutil.rmtree(directory)
    return n, family, kind, gained, text, directory


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--exemplar", default=str(ROOT / "build/release/exemplar"))
    parser.add_argument("--runs", type=int, default=100)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--families", default=",".join(FAMILIES))
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--timeout", type=float, default=20)
    parser.add_argument("--directory", default=None, help="where scenes run")
    parser.add_argument("--keep", action="store_true")
    parser.add_argument("--gains", action="store_true", help="show warnings of gained energy, too")
    parser.add_argument("--verbose", action="store_true", help="a line for each run")
    arguments = parser.parse_args()
    counts = collections.Counter()
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        for n, family, kind, gained, text, directory in pool.map(lambda i: run(i, arguments),
                                                                 range(arguments.first, arguments.first + arguments.runs)):
            counts[kind] += 1
            counts["with a warning of gained energy"] += gained
            if arguments.verbose or kind == "failed by the audit" or (gained and arguments.gains):
                last = [line for line in text.split("\n") if line][-1:] if kind != "status 0" or not gained else \
                    [line for line in text.split("\n") if "have risen" in line]
                print(f"{n} {family}: {kind}: {''.join(last)[-400:]} {directory if arguments.keep else ''}", flush=True)
    print(", ".join(f"{n} {kind}" for kind, n in sorted(counts.items())))
    return 1 if counts["failed by the audit"] else 0


if __name__ == "__main__":
    sys.exit(main())
