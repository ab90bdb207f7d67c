# SPDX-License-Identifier: GPL-3.0-or-later
"""Print the tables of doc/measured.md: iterations of Newton's method.

Usage: /usr/bin/python3 doc/scripts/measure_newton.py [BINARY] [PART]...     from anywhere; needs numpy
PART is drags, turns, interpolation or dynamics; all of them by default, in about three minutes.
"""
import inspect
import math
import sys
import tempfile
from pathlib import Path

import numpy as np

from cells import Body, read_pose
from scene_runs import BAR, NEWTON, PROGRAM, TOP, bend, paper_scene, print_table, run_scene, twist, write_scene

ANGLE = math.radians(157)
BAR_ENDS = {**BAR, "Scene": "static", "Handles/Names": "left, right", "Handles/left/Select": "boundary 1",
            "Handles/right/Select": "boundary 2", "Examples/Pose functions": twist("pi/2")}
# the end is lifted by half the length, pushed back by an eighth and turned by 90 degrees
BAR_DRAG = "-t/2; y*(cos(pi/2*t)-1) - z*sin(pi/2*t); 2*t + y*sin(pi/2*t) + z*(cos(pi/2*t)-1)"
FEET = {"cat": "box -0.6 -0.2 -0.01 0.6 0.2 0.08", "horse": "box -0.6 -0.2 -0.01 0.6 0.2 0.10"}
# what turns, and the point of the vertical axis about which it does
HEADS = {"cat": ("sphere 0.585 0 0.75 0.1", 0.585), "horse": ("box 0.76 -0.1 1.0 1.0 0.1 1.25", 0.6)}
IMPORTANCES = (0, 0.5, 0.8, 1)
FIVE = {"Scene": "static", "Time/Increments": 5, "Solver/Tolerance": 1e-8}


def iterations(run):
    """Of each step."""
    return [int(row["iterations"]) for row in run.rows[1:]]


def outcome(run):
    """Iterations of each increment, and where the run ended if it failed."""
    counts = iterations(run)
    if run.status == 0:
        return ", ".join(map(str, counts))
    return ", ".join(map(str, counts[:-1])) + f", fails in increment {len(counts)}"


def drags(program, folder):
    """Static drags in five increments to a relative residual of 1e-8. An end of the bar, whose example is twisted by
    90 degrees, is lifted by half the length, pushed back by an eighth and turned by 90 degrees; the animals are the
    paper's scenes. The numbers are the iterations of each increment."""
    bar = write_scene(folder / "bar.prm", {**BAR_ENDS, "Handles/right/Motion": BAR_DRAG})
    table, runs = [("scene", "nu", *(f"eta = {eta}" for eta in IMPORTANCES))], []
    for name, scene in (("bar", bar), ("cat, 2d", paper_scene("fig2d_cat")), ("horse, 3a", paper_scene("fig3a_horse"))):
        for nu in (0.3, 0.45):
            row = [run_scene(program, scene, folder / "out", check=False, settings={
                **NEWTON, **FIVE, "Material/Poisson's ratio": nu, "Examples/Importance": eta}) for eta in IMPORTANCES]
            table.append((name, nu, *map(outcome, row)))
            runs += row
    print_table(*table)
    counts = [count for run in runs for count in iterations(run)]
    factorizations = max(run.summary["factorizations"] / run.summary["iterations"] for run in runs)
    print(f"Mean: {sum(counts) / len(counts):.2f} iterations an increment; at most {factorizations:.2f} factorisations an "
          "iteration.\n")


def turning(axis, straight):
    """Motion by ANGLE about a vertical axis (x = axis, y = 0), or about x if axis is None: along straight lines,
    or turning."""
    c, s = (f"t*{math.cos(ANGLE)!r} - t", f"t*{math.sin(ANGLE)!r}") if straight else \
        (f"cos({ANGLE!r}*t) - 1", f"sin({ANGLE!r}*t)")
    if axis is None:
        return f"0; y*({c}) - z*({s}); y*({s}) + z*({c})"
    return f"(x-{axis})*({c}) + y*({s}); -(x-{axis})*({s}) + y*({c}); 0"


def turn_scenes():
    """(name, keys without the motion, handle that turns, its axis)"""
    yield "bar, end face", BAR_ENDS, "right", None
    meshes = TOP / "meshes"
    for animal, poses in (("cat", ("arch", "turn")), ("horse", ("graze", "turn"))):
        select, axis = HEADS[animal]
        yield f"{animal}, head", {
            "Scene": "static", "Mesh/File": meshes / f"{animal}.msh", "Handles/Names": "feet, head",
            "Examples/Poses": ", ".join(f"{meshes}/poses/{animal}_{pose}.msh" for pose in poses),
            "Handles/feet/Select": FEET[animal], "Handles/head/Select": select}, "head", axis


def turns(program, folder):
    """A handle turns by 157 degrees in five increments to 1e-8: an end of the bar about its axis, a head about the
    vertical, with all feet held. On straight paths every node goes straight to its place; with `Follow pose` they go
    together. Iterations of each increment, and the most inverted cells at the end of one."""
    table = [("scene", "eta", "straight", "inverted", "Follow pose", "inverted")]
    for name, keys, handle, axis in turn_scenes():
        straight = write_scene(folder / "straight.prm", {**keys, f"Handles/{handle}/Motion": turning(axis, True)})
        pose = write_scene(folder / "pose.prm", {**keys, f"Handles/{handle}/Motion": turning(axis, False)})
        run_scene(program, pose, folder / "pose", {"Examples/Importance": 0})
        follow = write_scene(folder / "follow.prm", {**keys, f"Handles/{handle}/Follow pose": "pose/final.msh"})
        for eta in (0, 0.8):
            runs = [run_scene(program, scene, folder / "out", check=False,
                              settings={**NEWTON, **FIVE, "Examples/Importance": eta}) for scene in (straight, follow)]
            table.append((name, eta, *(word for run in runs for word in (outcome(run), most_inverted(run)))))
    print_table(*table)


def most_inverted(run):
    return int(max(row["inverted_cells"] for row in run.rows))


FIXED_POINT = {"Solver/Method": "fixed point", "Model/Gradient": "frozen", "Solver/Maximum iterations": 500}
INTERPOLATORS = [("Newton", {}), ("fixed point, frozen", FIXED_POINT)]
INTERPOLATIONS = [("twist by 360 degrees", twist("2*pi"), 10), ("twist by 720 degrees", twist("4*pi"), 20),
                  ("bend by 180 degrees", bend("pi"), 10)]


def interpolation(program, folder):
    """A bar goes from rest to an example that prescribed weights choose, to a residual of 1e-12. The strain error is
    the greatest entry of S - I - E over all cells of final.msh, with numpy."""
    table = [("scene", "solver", "iterations of each increment", "strain error at the end")]
    for name, pose, increments in INTERPOLATIONS:
        for solver, keys in INTERPOLATORS:
            scene = write_scene(folder / "scene.prm", {
                **BAR, "Scene": "interpolation", "Examples/Pose functions": pose, "Examples/Importance": 1,
                "Examples/Weights": "prescribed", "Examples/Prescribed weights": "1-t; t",
                "Time/Increments": increments, "Solver/Tolerance": 1e-12, **keys})
            run = run_scene(program, scene, folder / "out", check=False)
            table.append((name, solver, outcome(run), f"{strain_error(pose, run):.0e}" if run.status == 0 else "-"))
    print_table(*table)


def strain_error(pose, run):
    """Greatest entry of S - I - E over the cells, with E of the analytic example."""
    places, cells = read_pose(run.output / "final.msh")
    rest = bar_nodes()
    x, y, z = rest.T
    names = {"x": x, "y": y, "z": z, "pi": np.pi, "sin": np.sin, "cos": np.cos}
    example = np.array([eval(formula, names) for formula in pose.split(";")]).T  # the program's formulas are Python's
    bar = Body(rest, cells)
    return np.abs(bar.strain(places) - bar.strain(example)).max()


def bar_nodes():
    """Of the generated bar, x fastest."""
    z, y, x = np.meshgrid(np.linspace(-0.5, 0.5, 5), np.linspace(-0.5, 0.5, 5), np.linspace(0, 4, 17), indexing="ij")
    return np.array([x.ravel(), y.ravel(), z.ravel()]).T


def dynamics(program, folder):
    """The second in which the handles of the paper's scenes move, in steps of 0.01 s: iterations of a step."""
    table = [("scene", "to 1e-3: mean", "most", "to 1e-8: mean", "most")]
    for name in ("fig2a_cat", "fig2c_cat", "fig3b_horse"):
        row = [name]
        for tolerance in (1e-3, 1e-8):
            counts = iterations(run_scene(program, paper_scene(name), folder / "out", {
                **NEWTON, "Time/Step": 0.01, "Time/End": 1, "Solver/Tolerance": tolerance}))
            row += [f"{sum(counts) / len(counts):.2f}", max(counts)]
        table.append(row)
    print_table(*table)


PARTS = {"drags": drags, "turns": turns, "interpolation": interpolation, "dynamics": dynamics}


def main():
    words = sys.argv[1:]
    program = words.pop(0) if words and words[0] not in PARTS else PROGRAM
    for name in words or PARTS:
        print(f"### {name.capitalize()}\n\n{inspect.getdoc(PARTS[name])}\n")
        with tempfile.TemporaryDirectory() as folder:
            PARTS[name](program, Path(folder))


if __name__ == "__main__":
    main()
