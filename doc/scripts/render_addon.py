# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw doc/figures/blender_addon.png: Blender with the creature of step 6 as body and the panel of the add-on, after a run.

Usage, from the top folder, after ninja -C build/release (Debian: xvfb, xdotool, blender):

    xvfb-run -s "-screen 0 1280x800x24" blender --python doc/scripts/render_addon.py -- build/release PICTURE.png

It prints the seconds from Run to the result.
"""
import math
import subprocess
import sys
import time
from pathlib import Path

import bpy

build, picture = (Path(word).resolve() for word in sys.argv[sys.argv.index("--") + 1:][:2])
TOP = Path(__file__).resolve().parents[2]
ADDON = "exemplar_addon"
begin = None
bpy.context.preferences.view.show_splash = False


def load(name):
    bpy.ops.wm.obj_import(filepath=str(TOP / f"meshes/surfaces/creature/{name}.obj"), forward_axis="Y", up_axis="Z")
    return bpy.context.object


def make_body():
    body = load("rest")
    body.name = "creature"
    body.shape_key_add(name="Basis")
    for name in ("crouch", "reach"):
        pose = load(name)
        key = body.shape_key_add(name=name)
        for point, vertex in zip(key.data, pose.data.vertices):
            point.co = vertex.co
        bpy.data.meshes.remove(pose.data)
    paws = body.vertex_groups.new(name="paws")
    paws.add([v.index for v in body.data.vertices if v.co.z < .05], 1., "REPLACE")
    nose = body.vertex_groups.new(name="nose")
    tip = body.data.vertices[1757].co
    nose.add([v.index for v in body.data.vertices if (v.co - tip).length < .2], 1., "REPLACE")
    return body


def pull(body, scene):
    """An empty takes the nose down and up again, by a hook."""
    hand = bpy.data.objects.new("hand", None)
    scene.collection.objects.link(hand)
    hook = body.modifiers.new("hand", "HOOK")
    hook.object, hook.vertex_group = hand, "nose"
    for frame in range(scene.frame_start, scene.frame_end + 1, 5):
        t = (frame - scene.frame_start) / (scene.frame_end - scene.frame_start)
        hand.location = (.05 * math.sin(2 * math.pi * t), 0., -.4 * math.sin(2 * math.pi * t))
        hand.keyframe_insert("location", frame=frame)


def set_up():
    global begin
    bpy.ops.object.select_all(action="SELECT")
    bpy.ops.object.delete()
    bpy.ops.preferences.addon_install(filepath=str(build / "exemplar_addon.zip"))
    bpy.ops.preferences.addon_enable(module=ADDON)
    bpy.context.preferences.addons[ADDON].preferences.program = str(build / "exemplar")
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end, scene.gravity = 1, 49, (0., 0., 0.)
    body = make_body()
    pull(body, scene)
    bpy.context.view_layer.objects.active = body
    body.exemplar.follow, body.exemplar.pin, body.exemplar.stiffness = "nose", "paws", 2e5
    bpy.ops.wm.save_as_mainfile(filepath=str(picture.with_suffix(".blend")))
    begin = time.monotonic()
    bpy.ops.exemplar.run()
    bpy.app.timers.register(look, first_interval=.5)


def look():
    running = sys.modules[ADDON].Running
    if running.job is not None:
        return .2
    print(f"{time.monotonic() - begin:.1f} s, {running.said}")
    result = bpy.data.objects["creature result"]
    bpy.context.scene.frame_set(14)
    for area in bpy.context.screen.areas:
        if area.type == "VIEW_3D":
            area.spaces.active.show_region_ui = True
            area.spaces.active.shading.color_type = "OBJECT"
            region = next(region for region in area.regions if region.type == "WINDOW")
            bpy.context.view_layer.objects.active = bpy.data.objects["creature"]
            for thing in bpy.data.objects:
                thing.select_set(thing == result)
            with bpy.context.temp_override(area=area, region=region):
                bpy.ops.view3d.view_axis(type="FRONT")
                bpy.ops.view3d.view_selected()
            sidebar = next(region for region in area.regions if region.type == "UI")
            # the tabs are at the right end, exemplar's is the last one
            x, y = sidebar.x + sidebar.width - 8, bpy.context.window.height - (sidebar.y + sidebar.height - 180)
            subprocess.run(["xdotool", "mousemove", str(x), str(y), "click", "1"], check=True)
    bpy.app.timers.register(take, first_interval=2.)
    return None


def take():
    bpy.ops.screen.screenshot(filepath=str(picture))
    bpy.ops.wm.quit_blender()


bpy.app.timers.register(set_up, first_interval=1.)
