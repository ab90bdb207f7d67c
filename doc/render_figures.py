#!/usr/bin/env python3
"""Run the paper's scenes and draw doc/figures/{fig1,fig2,fig3,cat}.png.

Usage, from the top folder:

    xvfb-run -a /usr/bin/python3 doc/render_figures.py build/release/exemplar [FIGURE]...

FIGURE is fig1, fig2, fig3 or cat; all of them by default. The runs go to
output/figures and take about a minute. Debian/Ubuntu packages:
python3-vtk9 xvfb xauth.
"""
import glob
import os
import subprocess
import sys

import vtk

RUNS = "output/figures"
FIGURES = "doc/figures"
PLAIN, WITHOUT, WITH = (0.86, 0.84, 0.80), (0.62, 0.70, 0.78), (0.95, 0.68, 0.36)
FIXED, DRAGGED = (0.10, 0.25, 0.85), (0.85, 0.05, 0.10)


# --- runs ---------------------------------------------------------------

def run(program, scene, name, *settings):
    """Run a scene into RUNS/name; return its frames in order of time."""
    out = os.path.join(RUNS, name)
    command = [program, scene, "--quiet", "--output", out]
    for setting in settings:
        command += ["--set", setting]
    print(" ".join(command), flush=True)
    subprocess.run(command, check=True)
    return sorted(glob.glob(os.path.join(out, "frame_*.vtu")))


def last_frame(program, scene, name, *settings):
    """The last frame of a scene (the last step always has one)."""
    return run(program, scene, name, "Output/Every=1000000", *settings)[-1]


def with_and_without(program, name):
    """Last frames of a paper scene: without examples, with examples."""
    scene = "prm/paper/%s.prm" % name
    return (last_frame(program, scene, name + "_without", "Examples/Importance=0"),
            last_frame(program, scene, name))


def pose_frames(program, names):
    return [last_frame(program, "prm/poses/%s.prm" % name, name) for name in names]


# --- geometry -----------------------------------------------------------

def read_grid(frame):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(frame)
    reader.Update()
    return reader.GetOutput()


def rest_grid(frame):
    """A frame put back to its rest positions (points are deformed ones)."""
    grid = vtk.vtkUnstructuredGrid()
    grid.DeepCopy(read_grid(frame))
    shift = grid.GetPointData().GetArray("displacement")
    for i in range(grid.GetNumberOfPoints()):
        grid.GetPoints().SetPoint(i, [x - u for x, u in zip(grid.GetPoint(i), shift.GetTuple(i))])
    return grid


def surface_of(grid):
    surface = vtk.vtkDataSetSurfaceFilter()
    surface.SetInputData(grid)
    return surface


def handles(scene):
    """(selection, is it dragged) of every handle in a scene file."""
    found = []
    for line in open(scene):
        words = line.replace("=", " ").split()
        if words[:2] == ["set", "Select"]:
            found.append([words[2], [float(w) for w in words[3:]], False])
        elif words[:2] == ["set", "Motion"]:
            found[-1][2] = True
    return found


def inside(kind, numbers, point):
    if kind == "box":
        return all(numbers[i] <= point[i] <= numbers[i + 3] for i in range(3))
    return sum((point[i] - numbers[i]) ** 2 for i in range(3)) <= numbers[3] ** 2


def held_points(grid, scene, dragged):
    """Present places of the surface nodes that a scene's handles hold."""
    surface = surface_of(grid)
    surface.Update()
    shift = surface.GetOutput().GetPointData().GetArray("displacement")
    points = vtk.vtkPoints()
    for i in range(surface.GetOutput().GetNumberOfPoints()):
        place = surface.GetOutput().GetPoint(i)
        rest = [x - u for x, u in zip(place, shift.GetTuple(i))]
        if any(d == dragged and inside(k, n, rest) for k, n, d in handles(scene)):
            points.InsertNextPoint(place)
    return points


# --- pictures -----------------------------------------------------------

def body(grid, colour, feature_angle):
    """Smoothly shaded surface with light mesh edges."""
    surface = surface_of(grid)
    normals = vtk.vtkPolyDataNormals()
    normals.SetInputConnection(surface.GetOutputPort())
    normals.SetFeatureAngle(feature_angle)
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(normals.GetOutputPort())
    mapper.ScalarVisibilityOff()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    look = actor.GetProperty()
    look.SetColor(colour)
    look.SetAmbient(0.25)
    look.SetDiffuse(0.75)
    look.EdgeVisibilityOn()
    look.SetEdgeColor([0.80 * c for c in colour])
    return actor


def dots(points, colour, radius=0.014):
    cloud = vtk.vtkPolyData()
    cloud.SetPoints(points)
    ball = vtk.vtkSphereSource()
    ball.SetRadius(radius)
    glyphs = vtk.vtkGlyph3D()
    glyphs.SetInputData(cloud)
    glyphs.SetSourceConnection(ball.GetOutputPort())
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(glyphs.GetOutputPort())
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(colour)
    return actor


def caption(text, size=20, colour=(0.1, 0.1, 0.1), y=8):
    actor = vtk.vtkTextActor()
    actor.SetInput(text)
    actor.SetPosition(12, y)
    actor.GetTextProperty().SetFontSize(size)
    actor.GetTextProperty().SetColor(colour)
    return actor


class Picture:
    """A white window of panels; places are pixels from the top left corner."""

    def __init__(self, width, height):
        self.width, self.height = width, height
        self.window = vtk.vtkRenderWindow()
        self.window.SetOffScreenRendering(1)
        self.window.SetMultiSamples(8)
        self.window.SetSize(width, height)

    def panel(self, box, actors, view, texts):
        x, y, w, h = box
        renderer = vtk.vtkRenderer()
        renderer.SetBackground(1, 1, 1)
        renderer.SetViewport(x / self.width, 1 - (y + h) / self.height, (x + w) / self.width, 1 - y / self.height)
        for actor in actors + texts:
            renderer.AddViewProp(actor)
        self.window.AddRenderer(renderer)
        centre, direction, scale = view
        camera = renderer.GetActiveCamera()
        camera.SetFocalPoint(centre)
        camera.SetPosition([c + 5 * d for c, d in zip(centre, direction)])
        camera.SetViewUp(0, 0, 1)
        camera.ParallelProjectionOn()
        camera.SetParallelScale(scale)
        renderer.ResetCameraClippingRange()

    def write(self, name):
        self.window.Render()
        grab = vtk.vtkWindowToImageFilter()
        grab.SetInput(self.window)
        grab.ReadFrontBufferOff()
        writer = vtk.vtkPNGWriter()
        writer.SetFileName(os.path.join(FIGURES, name))
        writer.SetCompressionLevel(9)
        writer.SetInputConnection(grab.GetOutputPort())
        writer.Write()
        print("wrote", os.path.join(FIGURES, name), flush=True)


def animal(frame, colour, scene=None):
    """An animal, with the nodes that a scene fixes and drags."""
    grid = read_grid(frame)
    actors = [body(grid, colour, 60)]
    if scene:
        path = "prm/paper/%s.prm" % scene
        actors += [dots(held_points(grid, path, False), FIXED), dots(held_points(grid, path, True), DRAGGED)]
    return actors


def fig1(program):
    """Interpolation of a bar: a row a scene, a column a time."""
    rows = [("fig1_twist", "twist"), ("fig1_bend", "bend"), ("fig1_twist_to_bend", "twist to bend")]
    picture = Picture(1600, 840)
    view = ((1.45, 0, 0.85), (-0.35, -1, 0.45), 2.3)
    for r, (scene, title) in enumerate(rows):
        frames = run(program, "prm/paper/%s.prm" % scene, scene, "Output/Every=1")
        for c in range(5):
            frame = frames[c * (len(frames) - 1) // 4]
            colour = PLAIN if c in (0, 4) else WITH
            texts = [caption(("%s,  " % title if c == 0 else "") + "t = %g" % (c / 4))]
            picture.panel((320 * c, 280 * r, 320, 280), [body(read_grid(frame), colour, 30)], view, texts)
    picture.write("fig1.png")


def examples_row(program, picture, names, titles, view, size):
    """First row of Figures 2 and 3: the rest pose and the examples."""
    frames = pose_frames(program, names)
    columns = [[body(rest_grid(frames[0]), PLAIN, 60)]] + [animal(f, PLAIN) for f in frames]
    for c, (actors, title) in enumerate(zip(columns, ["rest pose"] + titles)):
        picture.panel((size[0] * c, 0, size[0], size[1]), actors, view, [caption(title)])


def scene_pair(program, picture, x, y, size, scene, title, view):
    """A scene without and with examples, side by side, with what is held."""
    width, height = size
    pair = with_and_without(program, scene)
    words = ["without examples (importance 0)", "with examples"]
    for c, (frame, colour, word) in enumerate(zip(pair, (WITHOUT, WITH), words)):
        texts = [caption(word)] + ([caption(title, 20, y=height - 32)] if c == 0 else [])
        picture.panel((x + c * width, y, width, height), animal(frame, colour, scene), view, texts)


KEY = "blue: fixed, red: dragged"


def fig2(program):
    view = ((-0.02, -0.05, 0.66), (0.35, -1, 0.32), 0.88)
    picture = Picture(1600, 1180)
    names = ["cat_rear", "cat_turn", "cat_arch", "cat_paw"]
    examples_row(program, picture, names, ["example: rear", "example: turn", "example: arch", "example: paw"], view, (320, 300))
    scenes = [("fig2a_cat", "a: right fore paw dragged"), ("fig2b_cat", "b: nose dragged"),
              ("fig2c_cat", "c: right fore paw dragged"), ("fig2d_cat", "d: both fore paws dragged")]
    for i, (scene, title) in enumerate(scenes):
        scene_pair(program, picture, 800 * (i % 2), 300 + 440 * (i // 2), (400, 440), scene,
                   title + ("   (%s)" % KEY if i == 0 else ""), view)
    picture.write("fig2.png")


def fig3(program):
    view = ((0.1, 0, 0.86), (0.35, -1, 0.32), 1.08)
    picture = Picture(1600, 820)
    names = ["horse_rear", "horse_graze", "horse_turn"]
    examples_row(program, picture, names, ["example: rear", "example: graze", "example: turn"], view, (400, 370))
    scene_pair(program, picture, 0, 370, (400, 450), "fig3a_horse", "a: muzzle dragged   (%s)" % KEY, view)
    scene_pair(program, picture, 800, 370, (400, 450), "fig3b_horse", "b: right fore hoof dragged", view)
    picture.write("fig3.png")


def cat(program):
    """Front page: the cat at rest, without and with examples."""
    scene, view = "fig2d_cat", ((-0.06, 0, 0.53), (0.35, -1, 0.32), 0.68)
    without, with_examples = with_and_without(program, scene)
    picture = Picture(1500, 460)
    panels = [([body(rest_grid(without), PLAIN, 60)], "rest"),
              (animal(without, WITHOUT, scene), "fore paws dragged, without examples"),
              (animal(with_examples, WITH, scene), "fore paws dragged, with examples")]
    for c, (actors, title) in enumerate(panels):
        picture.panel((500 * c, 0, 500, 460), actors, view, [caption(title, 24)])
    picture.write("cat.png")


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    os.makedirs(FIGURES, exist_ok=True)
    figures = {"fig1": fig1, "fig2": fig2, "fig3": fig3, "cat": cat}
    for name in sys.argv[2:] or figures:
        figures[name](os.path.abspath(sys.argv[1]))


if __name__ == "__main__":
    main()
