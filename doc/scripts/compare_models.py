#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Print the tables of doc/paper.md that compare the models of a cell, and draw doc/figures/models.png.

Usage, from the top folder:

    xvfb-run -a /usr/bin/python3 doc/scripts/compare_models.py [BINARY]

A cat is dragged by each model, and a free bar spins; half a minute. True residuals and torques are computed
here in numpy from the final poses, independently of the program. Debian: python3-numpy python3-vtk9 xvfb xauth.
"""
import sys
import tempfile
from pathlib import Path

import numpy as np

from cells import Body, read_pose
from scene_runs import NEWTON, PROGRAM, TOP, paper_scene, print_table, read_vtu, run_scene, twist, write_scene

DIRECTION = (0.35, -1, 0.32)
# name in the picture, and what of space it shows
SCENES = {"fig2a_cat": ("2a", ((-0.22, -0.05, 0.98), DIRECTION, 1.46)),
          "fig2c_cat": ("2c", ((-0.06, -0.05, 0.62), DIRECTION, 0.98))}
IMPORTANCE, INCREMENTS, TOLERANCE = 0.9, 10, 1e-8
FULL_COLOUR = 0.05  # body lengths
MODELS = {
    "consistent": {**NEWTON, "Model/Strain": "corotational"},
    "frozen": {**NEWTON, "Model/Gradient": "frozen", "Solver/Method": "fixed point", "Solver/Maximum iterations": 500},
    "green": {**NEWTON, "Model/Strain": "green"},
    "linear": {**NEWTON, "Model/Strain": "linear"},
}


def files_of(scene, key):
    """The files that a key of a scene names."""
    line = next(line for line in scene.read_text().split("\n") if line.strip().startswith(f"set {key} "))
    return [scene.parent / file.strip() for file in line.split("=", 1)[1].split(",")]


class Comparison:
    """Final poses of a paper scene, now static, by all models, and what they are measured against."""

    def __init__(self, program, name, folder):
        scene = paper_scene(name)
        self.runs = {}
        for model, keys in MODELS.items():
            self.runs[model] = run_scene(program, scene, folder / model, check=False, settings={
                **keys, "Scene": "static", "Time/Increments": INCREMENTS, "Examples/Importance": IMPORTANCE,
                "Solver/Tolerance": TOLERANCE, "Output/Every": INCREMENTS})
        self.rest, cells = read_pose(*files_of(scene, "File"))
        self.body = Body(self.rest, cells)
        self.length = np.ptp(self.rest, axis=0).max()
        self.examples = [self.rest] + [read_pose(file)[0] for file in files_of(scene, "Poses")]
        self.places = {model: read_pose(run.output / "final.msh")[0] for model, run in self.runs.items()}
        # the handles, and nothing else, put nodes at the same places to rounding in all models
        difference = np.ptp([self.places[model] for model in MODELS], axis=0)
        self.free = difference.max(axis=1) > 1e-12

    def weights(self, name):
        return [self.runs[name].rows[-1][f"weight_{i}"] for i in range(len(self.examples))]

    def strain(self, places, name):
        F = self.body.deformation_gradient(places)
        if name == "linear":
            return (F + np.swapaxes(F, 1, 2)) / 2 - np.eye(3)
        if name == "green":
            return (np.swapaxes(F, 1, 2) @ F - np.eye(3)) / 2
        return self.body.strain(places)

    def target(self, name):
        return IMPORTANCE * sum(w * self.strain(x, name) for w, x in zip(self.weights(name), self.examples))

    def residual(self, name, force):
        """Greatest free force over the greatest force scale, Eq. (13), with the given force."""
        places, target = self.places[name], self.target(name)
        free = self.body.nodal_forces(self.body.force_stress(places, target, force))[self.free]
        return np.abs(free).max() / self.body.force_scale(self.strain(places, name), target).max()

    def ghost_torque(self, name):
        places = self.places[name]
        return self.body.ghost_torque(places, self.body.force_stress(places, self.target(name), name))

    def distances(self, name):
        """Of all nodes from the consistent pose, in lengths of the body."""
        return np.linalg.norm(self.places[name] - self.places["consistent"], axis=1) / self.length

    def seconds(self, name):
        spent = self.runs[name].summary["seconds"]
        return spent["total"] - spent["read"] - spent["output"]


def print_comparison(name, comparison):
    rows = [(name, *MODELS)]

    def add(what, value):
        rows.append((what, *(value(name) for name in MODELS)))

    add("status", lambda name: comparison.runs[name].summary["status"])
    add("residual that the program reports", lambda name: f"{comparison.runs[name].rows[-1]['residual']:.0e}")
    add("the same in numpy", lambda name: f"{comparison.residual(name, name):.0e}")
    true_force = {model: model for model in MODELS} | {"frozen": "consistent"}
    add("residual of the true gradient", lambda name: f"{comparison.residual(name, true_force[name]):.0e}")
    add("ghost torque", lambda name: f"{comparison.ghost_torque(name):.0e}")
    add("weights", lambda name: ", ".join(f"{w:.3f}" for w in comparison.weights(name)))
    add("iterations", lambda name: comparison.runs[name].summary["iterations"])
    add("seconds, consistent = 1", lambda name: f"{comparison.seconds(name) / comparison.seconds('consistent'):.1f}")
    add("min det F", lambda name: f"{comparison.runs[name].rows[-1]['min_det_F']:.2f}")
    add("inverted cells", lambda name: int(comparison.runs[name].rows[-1]["inverted_cells"]))
    add("mean distance to consistent, body lengths", lambda name: f"{comparison.distances(name).mean():.4f}")
    add("greatest distance", lambda name: f"{comparison.distances(name).max():.4f}")
    print_table(*rows)


def colours():
    """From white through orange to dark red, at FULL_COLOUR body lengths."""
    import vtk
    scale = vtk.vtkColorTransferFunction()
    steps = ((0, (0.93, 0.93, 0.90)), (0.25, (1, 0.80, 0.45)), (0.5, (0.95, 0.50, 0.15)), (1, (0.55, 0, 0)))
    for part, colour in steps:
        scale.AddRGBPoint(part * FULL_COLOUR, *colour)
    return scale


def panel_actors(comparison, model):
    """The pose by a model coloured by its distance to the consistent one, and that one in transparent grey."""
    import render_figures as render
    from vtk.util import numpy_support

    last = {name: sorted(comparison.runs[name].output.glob("frame_*.vtu"))[-1] for name in (model, "consistent")}
    surface, reference = (render.surface_of(str(last[name])) for name in (model, "consistent"))
    shift = [numpy_support.vtk_to_numpy(s.GetPointData().GetArray("displacement")) for s in (surface, reference)]
    distance = np.linalg.norm(shift[0] - shift[1], axis=1) / comparison.length
    surface.GetPointData().SetScalars(numpy_support.numpy_to_vtk(distance, deep=True))
    actor = render.body(surface, (0.6, 0.6, 0.6), 60)
    actor.GetProperty().EdgeVisibilityOff()
    actor.GetMapper().ScalarVisibilityOn()
    actor.GetMapper().SetLookupTable(colours())
    if model == "consistent":
        return [actor]
    ghost = render.body(reference, (0.45, 0.5, 0.6), 60)
    ghost.GetProperty().EdgeVisibilityOff()
    ghost.GetProperty().SetOpacity(0.3)
    return [actor, ghost]


def scale_actor():
    import vtk
    bar = vtk.vtkScalarBarActor()
    bar.SetLookupTable(colours())
    bar.SetNumberOfLabels(3)
    bar.SetLabelFormat("%.3f")
    bar.SetOrientationToHorizontal()
    bar.SetPosition(0.36, 0.1)
    bar.SetPosition2(0.4, 0.85)
    bar.UnconstrainedFontSizeOn()
    bar.GetLabelTextProperty().SetFontSize(18)
    bar.GetLabelTextProperty().SetColor(0.1, 0.1, 0.1)
    bar.GetLabelTextProperty().ShadowOff()
    bar.GetLabelTextProperty().ItalicOff()
    bar.GetLabelTextProperty().BoldOff()
    return bar


def draw(comparisons):
    """A row a scene, a column a model."""
    from render_figures import Picture
    picture = Picture(1600, 60 + 400 * len(comparisons))
    for row, (scene, comparison) in enumerate(comparisons.items()):
        name, view = SCENES[scene]
        for column, model in enumerate(MODELS):
            title = f"{name}, {model}" + (f": off by at most {comparison.distances(model).max():.3f}" if column else "")
            picture.panel((400 * column, 400 * row, 400, 400), panel_actors(comparison, model), view, title, 20)
    picture.panel((0, 400 * len(comparisons), 1600, 60), [scale_actor()], view,
                  "distance from consistent (grey), body lengths", 20)
    picture.write("models.png")


SPIN_STEPS, SPIN_STEP = 100, 0.01


def spinning_bar(program, model, folder):
    """A free bar that spins and twists, with a twisted example; positions and velocities at all steps."""
    scene = write_scene(folder / "spin.prm", {
        "Scene": "dynamic", "Mesh/Generator": "box", "Mesh/Box size": "4, 1, 1", "Mesh/Box cells": "8, 2, 2",
        "Examples/Pose functions": twist("pi/2"), "Examples/Importance": IMPORTANCE,
        "Initial/Velocity": "-5*y; 5*(x-2) - 5*(x-2)*z; 5*(x-2)*y", "Time/Step": SPIN_STEP,
        "Time/End": SPIN_STEP * SPIN_STEPS, "Solver/Tolerance": 1e-12})
    run = run_scene(program, scene, folder / model, {**MODELS[model], "Output/Every": 1})
    frames = [read_vtu(file)[0] for file in sorted(run.output.glob("frame_*.vtu"))]
    column = lambda kind, name: np.array([frame[kind, name] for frame in frames]).reshape(len(frames), -1, 3)
    return run, column("Points", "Points"), column("PointData", "velocity")


def nodal_mass(rest, cells, density=1000):
    """The consistent mass matrix of one component."""
    mass = np.zeros((len(rest), len(rest)))
    volume = Body(rest, cells).volume
    for a in range(4):
        for b in range(4):
            np.add.at(mass, (cells[:, a], cells[:, b]), density * volume / 20 * (1 + (a == b)))
    return mass


def momentum_defect(program, model, folder):
    """The defect of L_new = L + h sum v_new x M v, over |L|: its greatest in a step and its sum; how much happened."""
    run, x, v = spinning_bar(program, model, folder)
    p = nodal_mass(x[0], read_pose(run.output / "final.msh")[1]) @ v
    L = np.cross(x, p).sum(axis=1)
    defects = L[1:] - L[:-1] - SPIN_STEP * np.cross(v[1:], p[:-1]).sum(axis=1)
    size = np.linalg.norm(L[0])
    return (f"{np.linalg.norm(defects, axis=1).max() / size:.0e}", f"{np.linalg.norm(defects.sum(axis=0)) / size:.0e}",
            f"{np.ptp([row['weight_1'] for row in run.rows]):.2f}", f"{min(row['min_det_F'] for row in run.rows):.2f}")


def print_spin(program, folder):
    head = (f"a free bar, {SPIN_STEPS} steps", "greatest defect of a step", "sum over the steps",
            "range of the weight", "min det F")
    print_table(head, *((model, *momentum_defect(program, model, folder)) for model in ("consistent", "frozen")))


def main():
    program = sys.argv[1] if len(sys.argv) > 1 else PROGRAM
    with tempfile.TemporaryDirectory() as folder:
        comparisons = {name: Comparison(program, name, Path(folder, name)) for name in SCENES}
        for name, comparison in comparisons.items():
            print_comparison(name, comparison)
        print_spin(program, Path(folder))
        draw(comparisons)


if __name__ == "__main__":
    main()
