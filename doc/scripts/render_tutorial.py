#!/usr/bin/env python3
"""Run the scenes of prm/tutorial and draw the pictures of doc/tutorial, a function a step.

Usage, from the top folder:

    xvfb-run -a /usr/bin/python3 doc/scripts/render_tutorial.py build/release/exemplar [STEP]...

STEP is step1, step2 and so on; all of them by default. The runs go to output/tutorial and take
about a minute; plots also read doc/studies. Debian/Ubuntu packages: python3-vtk9 xvfb xauth gnuplot-nox.
"""
import csv
import itertools
import math
import os
import sys
from pathlib import Path

import vtk

import plots
import render_figures
from plots import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, VERMILION, smooth
from render_figures import PLAIN, WITH, WITHOUT, Picture, actor_of, animal, body, run, surface_of
from scene_runs import read_msh

STUDIES = "doc/studies"
PALE_GREEN, WALL = (0.62, 0.80, 0.62), (0.45, 0.45, 0.45)
render_figures.RUNS, render_figures.FIGURES = "output/tutorial", "doc/tutorial/figures"


def rows_of(study, **wanted):
    with open("%s/%s.csv" % (STUDIES, study), newline="") as file:
        return [row for row in csv.DictReader(file) if all(row[k] == v for k, v in wanted.items())]


def plot(name, settings, *lines):
    plots.plot("%s/%s" % (render_figures.FIGURES, name), settings, lines)


def grid_of(frame):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(frame)
    reader.Update()
    return reader.GetOutput()


def volume(frame):
    """Of the deformed body; inverted cells count as negative."""
    return volume_of(grid_of(frame))


def volume_of(grid):
    total = 0
    for i in range(grid.GetNumberOfCells()):
        a, b, c, d = (grid.GetPoint(grid.GetCell(i).GetPointId(j)) for j in range(4))
        total += vtk.vtkMath.Determinant3x3(*([p - q for p, q in zip(point, a)] for point in (b, c, d))) / 6
    return total


def block(corner, other, colour):
    cube = vtk.vtkCubeSource()
    cube.SetBounds(*(x for pair in zip(corner, other) for x in pair))
    return actor_of(cube, colour)


def heavy_elastica(load):
    """Tip (x, z) of an inextensible cantilever of length 1 under its weight, load = q L^3 / (E I): the
    slope downwards has theta'' = -load (1 - s) cos(theta), theta(0) = 0, theta'(1) = 0."""
    def shoot(bend, n=400):
        h, s, theta, x, z = 1 / n, 0.0, 0.0, 0.0, 0.0
        for _ in range(n):
            middle, bend_middle = theta + h / 2 * bend, bend - h / 2 * load * (1 - s) * math.cos(theta)
            bend -= h * load * (1 - s - h / 2) * math.cos(middle)
            theta += h * bend_middle
            x, z, s = x + h * math.cos(middle), z - h * math.sin(middle), s + h
        return bend, (x, z)

    low, high = 0.0, load
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if shoot(middle)[0] < 0 else (low, middle)
    return shoot(low)[1]


def step1(program):
    """The bar under its weight with three strains, and where its tip goes."""
    picture = Picture(1500, 1050)
    scene = "prm/tutorial/step1_bar.prm"
    strains = [("linear", WITHOUT, BLUE), ("corotational", WITH, VERMILION), ("green", PALE_GREEN, GREEN)]
    places = [(40000, 0, 390, -1.07, 3.0), (80000, 390, 660, -3.07, 5.08)]  # both with 65 pixels a metre
    for force, top, height, centre, scale in places:
        for c, (strain, colour, _) in enumerate(strains):
            frames = run(program, scene, "step1_%s_%s" % (strain, force), "Model/Strain=" + strain,
                         "Loads/weight/Force=0; 0; -%s*t" % force)
            wall = block((-0.12, -1, -1), (0, 1, 1), WALL)
            wall.GetProperty().SetOpacity(0.4)
            text = "%s, %s N: volume x %.2f" % (strain, force, volume(frames[-1]) / volume(frames[0]))
            picture.panel((500 * c, top, 500, height), [body(surface_of(frames[-1]), colour, 30), wall],
                          ((2.0, 0, centre), (-0.30, -1, 0.12), scale), text, 24)
    picture.write("step1_bar.png")

    paths = []
    for strain, _, colour in strains:
        frames = run(program, scene, "step1_path_" + strain, "Model/Strain=" + strain,
                     "Loads/weight/Force=0; 0; -160000*t", "Time/Increments=64")
        tip = grid_of(frames[0]).FindPoint(4, 0, 0)
        places = [grid_of(frame).GetPoint(tip) for frame in frames]
        style = "points pt 7 ps 0.5 lc rgb '%s'" % colour if strain == "green" else smooth(colour)
        paths.append((strain, style, [(x, z) for x, _, z in places]))
    # q L^3 / (E I) with E I = 1e6 / 12, q from 0 to 40000 N/m
    elastica = [tuple(4 * x for x in heavy_elastica(0.768 * gravity / 5)) for gravity in range(201)]
    circle = [(4 * math.cos(a * math.pi / 200), -4 * math.sin(a * math.pi / 200)) for a in range(101)]
    plot("step1_tip.svg", "set size ratio -1\nset xrange [0:4.5]\nset yrange [-4.5:0]\n"
         "set xlabel 'x of the tip [m]'\nset ylabel 'z of the tip [m]'",
         ("4 m from the wall", smooth(GREY, 3), circle),
         ("beam that cannot stretch", smooth(BLACK), elastica),
         *paths)


def blend(first, last, t):
    """The surface between two frames whose nodes go straight from one to the other."""
    middle = grid_of(first)
    ends = [grid_of(frame) for frame in (first, last)]
    for i in range(middle.GetNumberOfPoints()):
        middle.GetPoints().SetPoint(i, [(1 - t) * a + t * b for a, b in zip(*(end.GetPoint(i) for end in ends))])
    surface = vtk.vtkDataSetSurfaceFilter()
    surface.SetInputData(middle)
    surface.Update()
    return surface.GetOutput(), volume_of(middle)


def lengths(output):
    """Of the edges of the tetrahedra of final.msh, in order of their nodes' numbers."""
    mesh = read_msh(Path(output) / "final.msh")
    cells = [element[-4:] for element in mesh.elements if element[1] == 4]
    edges = sorted({tuple(sorted(edge)) for cell in cells for edge in itertools.combinations(cell, 2)})
    return [math.dist(mesh.nodes[a], mesh.nodes[b]) for a, b in edges]


def step2(program):
    """From twist to bend: strains interpolated, one pass, positions interpolated; errors of shape."""
    scene, parts = "prm/tutorial/step2_twist_to_bend.prm", 6
    newton = run(program, scene, "step2_newton")
    one_pass = run(program, scene, "step2_one_pass", "Solver/Method=one pass", "Model/Gradient=frozen", "Time/Increments=5")
    view = ((2.1, 0, 0.65), (-0.35, -1, 0.45), 2.5)
    picture = Picture(1560, 690)
    for c in range(parts):
        t = c / (parts - 1)
        shapes = []
        for frames in (newton, one_pass):
            frame = frames[c * (len(frames) - 1) // (parts - 1)]
            shapes.append((surface_of(frame), volume(frame)))
        shapes.append(blend(newton[0], newton[-1], t))
        for r, (word, (surface, size)) in enumerate(zip(("strains", "one pass", "positions"), shapes)):
            colour = PLAIN if r != 1 and c in (0, parts - 1) else (WITH, PALE_GREEN, WITHOUT)[r]
            picture.panel((260 * c, 230 * r, 260, 230), [body(surface, colour, 30)], view,
                          "%s, t = %g: %.2f" % (word, t, size / volume(newton[0])), 18)
    picture.write("step2_strip.png")

    run(program, scene, "step2_exact", "Solver/Tolerance=1e-12", "Output/Every=0")
    right = lengths("output/tutorial/step2_exact")
    curves = []
    for method, gradient, colour in (("one pass", "frozen", GREEN), ("fixed point", "frozen", BLUE),
                                     ("newton", "consistent", VERMILION)):
        points = []
        for increments in (1, 2, 5, 10, 20, 40, 80):
            name = "step2_%s_%d" % (method.replace(" ", "_"), increments)
            run(program, scene, name, "Solver/Method=" + method, "Model/Gradient=" + gradient, "Output/Every=0",
                "Time/Increments=%d" % increments)
            errors = [abs(a / b - 1) for a, b in zip(lengths("output/tutorial/" + name), right)]
            points.append((increments, max(errors)))
        curves.append((method, plots.line(plots.PALETTE.index(colour)), points))
    plot("step2_error.svg", "set termoption enhanced\nset logscale\nset format y '10^{%T}'\nset xrange [0.9:100]\nset yrange [1e-16:10]\n"
         "set xtics (1, 2, 5, 10, 20, 40, 80)\nset xlabel 'increments'\n"
         "set ylabel 'greatest relative error of an edge at the end'", *curves)


def step3(program):
    """The cat at rest and dragged with growing importance; weights and the height of its back."""
    scene = "prm/tutorial/step3_cat.prm"
    runs = [(eta, run(program, scene, "step3_" + eta, "Examples/Importance=" + eta)) for eta in ("0", "0.3", "0.6", "0.9")]
    panels = [("rest", runs[0][1][0], PLAIN)]
    panels += [("importance " + eta, frames[-1], WITH if eta != "0" else WITHOUT) for eta, frames in runs]
    picture, view = Picture(2000, 400), ((-0.12, 0, 0.55), (0.35, -1, 0.32), 0.87)
    for c, (text, frame, colour) in enumerate(panels):
        actors = animal(frame, colour, "../tutorial/step3_cat" if c else None)
        picture.panel((400 * c, 0, 400, 400), actors, view, text, 26)
    picture.write("step3_cat.png")

    ways = [("simplex", "auto", "scaled", VERMILION), ("free", "auto", "scaled", BLUE), ("free", "0", "scaled", PURPLE),
            ("simplex", "auto", "blended", GREEN), ("simplex", "auto", "mixed", ORANGE)]
    for name, column, settings in (
            ("step3_weights.svg", "weight_1", "set yrange [0:3]\nset ylabel 'weight of the arch'"),
            ("step3_back.svg", "probe_z", "set yrange [0:0.2]\nset ylabel 'rise of the back [m]'")):
        lines = []
        for weights, ridge, energy, colour in ways:
            rows = rows_of("step3_importance", **{"Examples/Weights": weights, "Examples/Weight penalty": ridge,
                                                  "Examples/Energy": energy})
            points = [(float(row["Examples/Importance"]), float(row[column])) for row in rows if row[column]]
            lines.append(("%s, %s, ridge %s" % (weights, energy, ridge),
                          plots.line(plots.PALETTE.index(colour)), points))
        plot(name, "set xrange [0:1.05]\nset xlabel 'importance'\n" + settings, *lines)


def step4(program):
    """The pose of the bowing horse, the animation, and the height of its muzzle over time."""
    view = ((0.12, 0, 0.74), (0.35, -1, 0.2), 0.92)
    frames = run(program, "prm/tutorial/step4_bow.prm", "step4_bow")
    picture = Picture(1230, 360)
    for c, (frame, t) in enumerate(zip((frames[0], frames[5], frames[-1]), ("0", "0.5", "1"))):
        picture.panel((410 * c, 0, 410, 360), animal(frame, PLAIN, "../tutorial/step4_bow"), view, "t = " + t, 22)
    picture.write("step4_bow.png")

    scene = "prm/tutorial/step4_horse.prm"
    frames = run(program, scene, "step4_horse")
    picture = Picture(1640, 640)
    for i, t in enumerate((0, 0.48, 0.72, 1, 2, 2.48, 2.72, 4)):
        picture.panel((410 * (i % 4), 320 * (i // 4), 410, 320), animal(frames[round(25 * t)], WITH), view, "t = %g s" % t, 22)
    picture.write("step4_strip.png")

    lines = []
    for title, style, settings in (
            ("without mass: the pose", smooth(BLACK, 3), ["Material/Density=1e-6", "Time/Stiffness damping=0"]),
            ("no damping", smooth(BLUE), ["Time/Stiffness damping=0"]),
            ("stiffness 0.1 s", smooth(VERMILION), []),
            ("stiffness 0.5 s", smooth(GREEN), ["Time/Stiffness damping=0.5"]),
            ("mass 3 / s", smooth(PURPLE), ["Time/Stiffness damping=0", "Time/Mass damping=3"])):
        frames = run(program, scene, "step4_" + title.replace(" ", "_").replace("/", "").replace(":", ""), *settings)
        muzzle = grid_of(frames[0]).FindPoint(0.94, 0, 1.08)
        lines.append((title, style, [(0.04 * i, grid_of(frame).GetPoint(muzzle)[2]) for i, frame in enumerate(frames)]))
    plot("step4_muzzle.svg", "set xlabel 't [s]'\nset ylabel 'height of the muzzle [m]'\n"
         "set yrange [0:1.9]", *lines)


def step5(program):
    """The bar on its way, with and without its example."""
    scene, ending = "prm/tutorial/step5_bar.prm", "Output/Every=30"
    plain = run(program, scene, "step5_plain", ending, "Examples/Importance=0")
    frames = run(program, scene, "step5_bar", ending)
    picture = Picture(1480, 250)
    shown = [(frames[0], PLAIN, "t = 0"), (frames[1], WITH, "t = 0.3 s"), (frames[2], WITH, "t = 0.6 s"),
             (plain[2], WITHOUT, "t = 0.6 s, without the example")]
    for c, (frame, colour, text) in enumerate(shown):
        picture.panel((370 * c, 0, 370, 250), [body(surface_of(frame), colour, 30)], ((2, 0, 0.4), (-0.35, -1, 0.3), 1.75),
                      text, 20)
    picture.write("step5_bar.png")


def step6(program):
    """Three surfaces, the creature on its way, and its weights."""
    picture, view = Picture(1500, 420), ((-0.13, 0, 0.72), (0.3, -1, 0.25), 1.42)
    for c, name in enumerate(("rest", "crouch", "reach")):
        reader = vtk.vtkOBJReader()
        reader.SetFileName("meshes/surfaces/creature/%s.obj" % name)
        reader.Update()
        picture.panel((500 * c, 0, 500, 420), [body(reader.GetOutput(), PLAIN, 60)], view, name + ".obj", 24)
    picture.write("step6_surfaces.png")

    frames = run(program, "prm/tutorial/step6_creature.prm", "step6/run", "Output/Formats=vtu, obj, pc2, usda")
    picture = Picture(1640, 640)
    for i, step in enumerate((0, 7, 13, 19, 25, 31, 38, 44)):
        reader = vtk.vtkOBJReader()
        reader.SetFileName(frames[step].replace(".vtu", ".obj"))
        reader.Update()
        picture.panel((410 * (i % 4), 320 * (i // 4), 410, 320), [body(reader.GetOutput(), WITH, 60)], view,
                      "t = %g s" % (0.04 * step), 22)
    picture.write("step6_strip.png")

    with open("output/tutorial/step6/run/statistics.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    lines = [(title, smooth(colour), [(float(row["time"]), float(row["weight_%d" % i])) for row in rows])
             for i, (title, colour) in enumerate((("rest", GREY), ("crouch", VERMILION), ("reach", BLUE)))]
    plot("step6_weights.svg", "set xlabel 't [s]'\nset ylabel 'weight'\nset yrange [0:1]", *lines)


def step7(program):
    """A cat of clay and an elastic one, pulled and let go; a bar that twists as it is pulled; a wire bent twice."""
    scene, view = "prm/materials/clay_cat.prm", ((-0.12, 0, 0.55), (0.35, -1, 0.32), 0.87)
    rows = [("Yield 800", WITH, run(program, scene, "step7_clay")),
            ("Yield 0", WITHOUT, run(program, scene, "step7_elastic", "Examples/Yield=0"))]
    picture = Picture(1640, 720)
    for r, (word, colour, frames) in enumerate(rows):
        for c, step in enumerate((0, 14, 20, 40)):
            picture.panel((410 * c, 360 * r, 410, 360), [body(surface_of(frames[step]), colour if step else PLAIN, 60)], view,
                          "%s, t = %g s" % (word, 0.05 * step), 22)
    picture.write("step7_clay_cat.png")

    scene, view = "prm/materials/twisting_bar.prm", ((2.4, 0, 0), (-0.5, -1, 0.4), 1.85)
    frames = run(program, scene, "step7_fibres")
    plain = run(program, scene, "step7_plain", "Material/Fibre stiffness=0")
    picture = Picture(1560, 360)
    for c, (frame, colour, text) in enumerate(((frames[0], PLAIN, "at rest"), (frames[-1], WITH, "with fibres, pulled"),
                                               (plain[-1], WITHOUT, "without fibres, pulled"))):
        picture.panel((520 * c, 0, 520, 360), [body(surface_of(frame), colour, 30)], view, text, 22)
    picture.write("step7_twisting_bar.png")

    frames = run(program, "prm/materials/paper_clip.prm", "step7_paper_clip")
    picture = Picture(1640, 280)
    for c, (step, text) in enumerate(((10, "bent up"), (20, "let go"), (30, "bent down"), (40, "let go"))):
        picture.panel((410 * c, 0, 410, 280), [body(surface_of(frames[step]), WITH, 30)], ((0.0145, 0, 0), (0, -1, 0.1), 0.0115),
                      "t = %g, %s" % (step / 40, text), 22)
    picture.write("step7_paper_clip.png")


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    os.makedirs(render_figures.FIGURES, exist_ok=True)
    steps = {name: make for name, make in globals().items() if name.startswith("step")}
    for name in sys.argv[2:] or steps:
        steps[name](os.path.abspath(sys.argv[1]))


if __name__ == "__main__":
    main()
