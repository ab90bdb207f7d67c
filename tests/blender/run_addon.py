# SPDX-License-Identifier: GPL-3.0-or-later
"""Uses the add-on as an artist does, without a window: what came of it, as JSON.

    blender --background --python run_addon.py -- ADDON.zip PROGRAM DIRECTORY RESULT.json

A bar stands on its end with a shape key that bends it; an armature of two bones holds the lower end and turns the upper one.
"""
import json
import math
import shutil
import sys
import time
from pathlib import Path

import bpy
import numpy as np

addon, program, directory, result = map(Path, sys.argv[sys.argv.index("--") + 1:][:4])
SIZE = 12  # quads along


def bar():
    """(vertices, faces) of a bar 1 x 1 x 4 that stands on z = 0."""
    vertices, number, faces = [], {}, []

    def v(i, j, k):
        if (i, j, k) not in number:
            number[i, j, k] = len(vertices)
            vertices.append((i / 4 - .5, j / 4 - .5, 4 * k / SIZE))
        return number[i, j, k]
    for k in range(SIZE):
        for i in range(4):
            faces += [(v(i, 0, k), v(i + 1, 0, k), v(i + 1, 0, k + 1), v(i, 0, k + 1)),
                      (v(i, 4, k), v(i, 4, k + 1), v(i + 1, 4, k + 1), v(i + 1, 4, k)),
                      (v(0, i, k), v(0, i, k + 1), v(0, i + 1, k + 1), v(0, i + 1, k)),
                      (v(4, i, k), v(4, i + 1, k), v(4, i + 1, k + 1), v(4, i, k + 1))]
    for i in range(4):
        for j in range(4):
            faces += [(v(i, j, 0), v(i, j + 1, 0), v(i + 1, j + 1, 0), v(i + 1, j, 0)),
                      (v(i, j, SIZE), v(i + 1, j, SIZE), v(i + 1, j + 1, SIZE), v(i, j + 1, SIZE))]
    return vertices, faces


def bent(x, y, z, angle=math.pi / 3):
    radius = 4 / angle
    a = z / radius
    return radius - (radius - x) * math.cos(a), y, (radius - x) * math.sin(a)


def make_body():
    vertices, faces = bar()
    mesh = bpy.data.meshes.new("bar")
    mesh.from_pydata(vertices, [], faces)
    body = bpy.data.objects.new("bar", mesh)
    bpy.context.scene.collection.objects.link(body)
    body.shape_key_add(name="Basis")
    key = body.shape_key_add(name="bent")
    key.data.foreach_set("co", np.array([bent(*x) for x in vertices], dtype=np.float32).ravel())
    for name, chosen in (("low", lambda z: z == 0), ("high", lambda z: z == 4)):
        group = body.vertex_groups.new(name=name)
        group.add([i for i, x in enumerate(vertices) if chosen(x[2])], 1., "REPLACE")
    stiff = body.vertex_groups.new(name="exemplar stiffness")
    stiff.add(list(range(len(vertices))), .5, "REPLACE")
    body.location = (0., 0., 1.)
    return body


def make_rig(body):
    """An armature that takes the upper end to where the shape key has it: bones point along z, their third axis against y."""
    rig = bpy.data.objects.new("rig", bpy.data.armatures.new("rig"))
    bpy.context.scene.collection.objects.link(rig)
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    for name, z in (("low", 1.), ("high", 5.)):
        bone = rig.data.edit_bones.new(name)
        bone.head, bone.tail = (0., 0., z), (0., 0., z + 1.)
    bpy.ops.object.mode_set(mode="POSE")
    bone = rig.pose.bones["high"]
    bone.rotation_mode = "XYZ"
    scene = bpy.context.scene
    x, _, z = bent(0., 0., 4.)
    for frame, part in ((scene.frame_start, 0.), (scene.frame_end, 1.)):
        bone.rotation_euler, bone.location = (0., 0., -part * math.pi / 3), (part * x, part * (z - 4.), 0.)
        bone.keyframe_insert("rotation_euler", frame=frame)
        bone.keyframe_insert("location", frame=frame)
    bpy.ops.object.mode_set(mode="OBJECT")
    modifier = body.modifiers.new("rig", "ARMATURE")
    modifier.object = rig


def wait(exemplar):
    seen = set()
    while exemplar.poll() is not None:
        seen.add(exemplar.Running.job.shown)
        time.sleep(.02)
    return len(seen)


def places(shown, frame):
    bpy.context.scene.frame_set(frame)
    shown = shown.evaluated_get(bpy.context.evaluated_depsgraph_get())
    return [list(shown.matrix_world @ vertex.co) for vertex in shown.to_mesh().vertices]


bpy.ops.wm.read_homefile(use_empty=True)
bpy.ops.preferences.addon_install(filepath=str(addon))
bpy.ops.preferences.addon_enable(module="exemplar_addon")
import exemplar_addon as exemplar  # noqa: E402

bpy.context.preferences.addons["exemplar_addon"].preferences.program = str(program)
scene = bpy.context.scene
scene.frame_start, scene.frame_end, scene.render.fps = 3, 18, 24
scene.gravity = (0., 0., -1.)
body = make_body()
make_rig(body)
hat = bpy.data.objects.new("hat", bpy.data.meshes.new("hat"))
hat.data.from_pydata([(-.3, -.3, 0), (.3, -.3, 0), (.3, .3, 0), (-.3, .3, 0)], [], [(0, 1, 2, 3)])
scene.collection.objects.link(hat)
hat.parent, hat.location = body, (0, 0, 4.05)
bpy.context.view_layer.objects.active = body
settings = body.exemplar
settings.cells, settings.follow, settings.pin = 600, "high", "low"
found = {}


def refused():
    try:
        status = bpy.ops.exemplar.run()
        return str(status)
    except RuntimeError as error:  # what an operator reports as an error
        return str(error)


found["unsaved"] = refused()
bpy.ops.wm.save_as_mainfile(filepath=str(directory / "my film.blend"))
settings.follow = "gone"
found["no group"] = refused()
settings.follow = "high"

exemplar.directory_of(body).write_text("in the way")
found["no directory"] = refused()
exemplar.directory_of(body).unlink()

found["status"] = str(bpy.ops.exemplar.run())
found["timer"] = bpy.app.timers.is_registered(exemplar.poll)
found["twice"] = refused()
body.name = "renamed"  # by the artist, while it runs
found["frames seen"] = wait(exemplar)
body.name = "bar"
found["said"] = exemplar.Running.said
found["directory"] = str(exemplar.directory_of(body))
shutil.copytree(exemplar.directory_of(body), directory / "kept")
shown = bpy.data.objects.get("bar result")
if shown is not None:
    keys = shown.data.shape_keys
    found["keys"] = [key.name for key in keys.key_blocks]
    found["rest"], found["end"], found["rig"] = places(shown, 3), places(shown, 18), places(body, 18)
    found["weights"] = [point.co[1] for point in keys.animation_data.action.fcurves[0].keyframe_points]
    found["hat"] = places(bpy.data.objects["hat result"], 18)
    found["range"] = [scene.frame_start, scene.frame_end]

# once more, mirrored, by another name; the first result is kept under a name of the artist's
shown.name = "mine"
body.scale = (-1., 1., 1.)
exemplar.start(bpy.context, body)
wait(exemplar)
found["mirrored"] = exemplar.Running.said
found["second end"] = places(bpy.data.objects["bar result"], 18)
found["second rig"] = places(body, 18)
body.scale = (1., 1., 1.)
bpy.context.view_layer.objects.active = bpy.data.objects["bar result"]
found["result"] = refused()
bpy.context.view_layer.objects.active = body

# cancelled as soon as there is a frame
scene.frame_end = 20000
settings.follow = ""
exemplar.start(bpy.context, body)
while exemplar.poll() is not None and exemplar.Running.job.shown < 0:
    time.sleep(.02)
begin = time.monotonic()
bpy.ops.exemplar.cancel()
found["seconds to cancel"] = time.monotonic() - begin
wait(exemplar)
found["cancelled"] = exemplar.Running.said
found["hidden"] = body.hide_get()
found["objects"] = sorted(item.name for item in bpy.data.objects)

# a hole in the surface
scene.frame_end = 18
settings.pin = ""
body.shape_key_clear()
mesh = body.data
faces = [tuple(face.vertices) for face in mesh.polygons][1:]
vertices = [tuple(vertex.co) for vertex in mesh.vertices]
mesh.clear_geometry()
mesh.from_pydata(vertices, [], faces)
exemplar.start(bpy.context, body)
wait(exemplar)
found["hole"] = exemplar.Running.said
found["selected"] = [vertex.index for vertex in mesh.vertices if vertex.select]
bpy.ops.preferences.addon_disable(module="exemplar_addon")
result.write_text(json.dumps(found))
