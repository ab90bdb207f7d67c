#!/usr/bin/env python3
"""Run the paper's scenes and draw doc/figures/{fig1,fig2,fig3}.png.

Usage, from the top folder:

    xvfb-run -a /usr/bin/python3 doc/scripts/render_figures.py build/release/exemplar [FIGURE]...

FIGURE is fig1, fig2 or fig3; all of them by default. The runs go to
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


def run(program, scene, name, *settings):
    """Run a scene into RUNS/name; return its frames in order of time."""
    out = RUNS + "/" + name
    command = [program, scene, "--quiet", "--output", out] + [w for s in settings for w in ("--set", s)]
    print(" ".join(command), flush=True)
    subprocess.run(command, check=True)
    return sorted(glob.glob(os.path.join(out, "frame_*.vtu")))


def ends(program, scene, name, *settings):
    """First and last frame of a scene (10 or 100 steps, so every tenth will do)."""
    frames = run(program, scene, name, "Output/Every=10", *settings)
    return frames[0], frames[-1]


def paper_scene(program, name):
    """Frames of a paper scene: at rest, last without examples, last with examples."""
    path = "prm/paper/%s.prm" % name
    return ends(program, path, name + "_without", "Examples/Importance=0") + ends(program, path, name)[1:]


def surface_of(frame):
    """The surface of a frame, deformed, with the point data."""
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(frame)
    surface = vtk.vtkDataSetSurfaceFilter()
    surface.SetInputConnection(reader.GetOutputPort())
    surface.Update()
    return surface.GetOutput()


def handles(scene):
    """(selection, is it dragged) of every handle in a scene file."""
    found = []
    for line in open("prm/paper/%s.prm" % scene):
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


def held_points(surface, scene, dragged):
    """Present places of the surface nodes that a scene's handles hold."""
    shift = surface.GetPointData().GetArray("displacement")
    points = vtk.vtkPoints()
    for i in range(surface.GetNumberOfPoints()):
        place = surface.GetPoint(i)
        rest = [x - u for x, u in zip(place, shift.GetTuple(i))]
        if any(d == dragged and inside(k, n, rest) for k, n, d in handles(scene)):
            points.InsertNextPoint(place)
    return points


def actor_of(shape, colour):
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(shape.GetOutputPort())
    mapper.ScalarVisibilityOff()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(colour)
    actor.GetProperty().SetAmbient(0.25)
    actor.GetProperty().SetDiffuse(0.75)
    return actor


def body(surface, colour, feature_angle):
    """Smoothly shaded surface with light mesh edges."""
    normals = vtk.vtkPolyDataNormals()
    normals.SetInputData(surface)
    normals.SetFeatureAngle(feature_angle)
    actor = actor_of(normals, colour)
    actor.GetProperty().EdgeVisibilityOn()
    actor.GetProperty().SetEdgeColor([0.80 * c for c in colour])
    return actor


def dots(points, colour):
    cloud = vtk.vtkPolyData()
    cloud.SetPoints(points)
    ball = vtk.vtkSphereSource()
    ball.SetRadius(0.014)
    glyphs = vtk.vtkGlyph3D()
    glyphs.SetInputData(cloud)
    glyphs.SetSourceConnection(ball.GetOutputPort())
    return actor_of(glyphs, colour)


class Picture:
    """A white window of panels; places are pixels from the top left corner."""

    def __init__(self, width, height):
        self.width, self.height = width, height
        self.window = vtk.vtkRenderWindow()
        self.window.SetOffScreenRendering(1)
        self.window.SetSize(width, height)

    def panel(self, box, actors, view, text, size=20):
        """Actors seen in (centre, direction, half height), with a line of text."""
        x, y, w, h = box
        renderer = vtk.vtkRenderer()
        renderer.SetBackground(1, 1, 1)
        renderer.SetViewport(x / self.width, 1 - (y + h) / self.height, (x + w) / self.width, 1 - y / self.height)
        caption = vtk.vtkTextActor()
        caption.SetInput(text)
        caption.SetPosition(12, h - size - 10)
        caption.GetTextProperty().SetFontSize(size)
        caption.GetTextProperty().SetColor(0.1, 0.1, 0.1)
        for actor in actors + [caption]:
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
        writer.SetFileName(FIGURES + "/" + name)
        writer.SetInputConnection(grab.GetOutputPort())
        writer.Write()


def animal(frame, colour, scene=None):
    """An animal, with the nodes that a scene fixes and drags."""
    surface = surface_of(frame)
    actors = [body(surface, colour, 60)]
    if scene:
        actors.append(dots(held_points(surface, scene, False), FIXED))
        actors.append(dots(held_points(surface, scene, True), DRAGGED))
    return actors


def fig1(program):
    """Interpolation of a bar: a row a scene, a column a time."""
    rows = [("fig1_twist", "twist"), ("fig1_bend", "bend"), ("fig1_twist_to_bend", "twist to bend")]
    picture = Picture(1600, 720)
    view = ((2.05, 0, 0.70), (-0.35, -1, 0.45), 2.1)
    for r, (scene, title) in enumerate(rows):
        frames = run(program, "prm/paper/%s.prm" % scene, scene, "Output/Every=1")
        for c in range(5):
            frame = frames[c * (len(frames) - 1) // 4]
            bar = body(surface_of(frame), PLAIN if c in (0, 4) else WITH, 30)
            picture.panel((320 * c, 240 * r, 320, 240), [bar], view, "%s, t = %g" % (title, c / 4))
    picture.write("fig1.png")


def examples_row(program, picture, kind, poses, view, size):
    """First row of Figures 2 and 3: the rest pose and the examples."""
    runs = [ends(program, "prm/poses/%s_%s.prm" % (kind, pose), "%s_%s" % (kind, pose)) for pose in poses]
    frames = [runs[0][0]] + [last for first, last in runs]
    for c, (frame, pose) in enumerate(zip(frames, ["rest"] + poses)):
        picture.panel((size[0] * c, 0, size[0], size[1]), animal(frame, PLAIN), view, "example: " + pose)


def scene_pair(program, picture, corner, size, scene, title, examples, view):
    """A scene without and with examples, side by side, with what is held."""
    (x, y), (width, height) = corner, size
    words = ["without examples (importance 0)", "with examples " + examples]
    for c, (frame, colour, word) in enumerate(zip(paper_scene(program, scene)[1:], (WITHOUT, WITH), words)):
        picture.panel((x + c * width, y + 36, width, height - 36), animal(frame, colour, scene), view, word, 18)
    picture.panel((x, y, 2 * width, 36), [], view, title, 22)


def fig2(program):
    view = ((-0.13, -0.05, 0.72), (0.35, -1, 0.32), 1.03)
    picture = Picture(1400, 1080)
    examples_row(program, picture, "cat", ["rear", "turn", "arch", "paw"], view, (280, 280))
    scenes = [("fig2a_cat", "a: right fore paw dragged (red), one hind paw fixed (blue)", "rest, rear, turn"),
              ("fig2b_cat", "b: nose dragged, both hind paws fixed", "rest, arch, turn"),
              ("fig2c_cat", "c: right fore paw dragged, three paws fixed", "rest, paw, turn"),
              ("fig2d_cat", "d: both fore paws dragged, both hind paws fixed", "rest, arch, rear")]
    for i, (scene, title, examples) in enumerate(scenes):
        corner = (700 * (i % 2), 280 + 400 * (i // 2))
        scene_pair(program, picture, corner, (350, 400), scene, title, examples, view)
    picture.write("fig2.png")


def fig3(program):
    view = ((0.05, 0, 0.96), (0.35, -1, 0.32), 1.26)
    picture = Picture(1600, 820)
    examples_row(program, picture, "horse", ["rear", "graze", "turn"], view, (400, 370))
    scenes = [("fig3a_horse", "a: muzzle dragged (red), both hind hooves fixed (blue)", "rest, graze, turn"),
              ("fig3b_horse", "b: right fore hoof dragged, both hind hooves fixed", "rest, rear, turn")]
    for i, (scene, title, examples) in enumerate(scenes):
        scene_pair(program, picture, (800 * i, 370), (400, 450), scene, title, examples, view)
    picture.write("fig3.png")


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    os.makedirs(FIGURES, exist_ok=True)
    figures = {"fig1": fig1, "fig2": fig2, "fig3": fig3}
    for name in sys.argv[2:] or figures:
        figures[name](os.path.abspath(sys.argv[1]))


if __name__ == "__main__":
    main()
