# SPDX-License-Identifier: GPL-3.0-or-later
"""Uses the add-on as an artist does, without a window: what came of it, as JSON.

    blender --background --python run_addon.py -- ADDON.zip PROGRAM DIRECTORY RESULT.json

A bar stands on its end with a shape key that bends it; an armature of two bones holds the lower end and turns the upper one.
"""
import json
import shutil
import sys
import time
from pathlib import Path

import bpy

sys.path.append(str(Path(__file__).parent))
from addon_scenes import add_group, add_key, bar, bent, install, make_object, make_rig, places, wait  # noqa: E402

addon, program, directory, result = map(Path, sys.argv[sys.argv.index("--") + 1:][:4])


def make_body():
    vertices, faces = bar()
    body = make_object("bar", vertices, faces)
    body.shape_key_add(name="Basis")
    add_key(body, "bent", [bent(*x) for x in vertices])
    add_group(body, "low", lambda x, y, z: z == 0)
    add_group(body, "high", lambda x, y, z: z == 4)
    add_group(body, "exemplar stiffness", lambda x, y, z: True, .5)
    body.location = (0., 0., 1.)
    return body


exemplar = install(addon, program)
scene = bpy.context.scene
scene.gravity = (0., 0., -1.)
body = make_body()
make_rig(body)
hat = make_object("hat", [(-.3, -.3, 0), (.3, -.3, 0), (.3, .3, 0), (-.3, .3, 0)], [(0, 1, 2, 3)])
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
