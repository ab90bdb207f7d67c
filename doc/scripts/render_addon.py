# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw doc/figures/blender_addon.png: Blender with an elephant that a rig drives, of which ears, trunk and tail follow, and the panel.

Usage, from the top folder, after ninja -C build/release (Debian: xvfb, xdotool, blender):

    xvfb-run -s "-screen 0 1280x800x24" blender --python doc/scripts/render_addon.py -- build/release PICTURE.png

It prints the seconds from Run to the result, and leaves PICTURE.blend.
"""
import math
import subprocess
import sys
import time
from pathlib import Path

import bpy
from mathutils import Quaternion, Vector

build, picture = (Path(word).resolve() for word in sys.argv[sys.argv.index("--") + 1:][:2])
ADDON = "exemplar_addon"
SHOWN = 30  # frame of the picture
begin = None
bpy.context.preferences.view.show_splash = False

# Of the elephant, which looks along x: ellipsoids (place, half axes, turn about z) and tubes (places, radii).
ELLIPSOIDS = [((0., 0., 1.45), (1.05, .55, .6), 0.), ((1.2, 0., 1.85), (.42, .36, .42), 0.),
              ((.85, .48, 1.9), (.4, .08, .48), -.5), ((.85, -.48, 1.9), (.4, .08, .48), .5)]
TUBES = [([(1.45, 0., 1.8), (1.7, 0., 1.45), (1.78, 0., 1.), (1.8, 0., .55)], (.2, .16, .13, .1)),
         ([(-.95, 0., 1.6), (-1.15, 0., 1.3), (-1.2, 0., .85)], (.07, .05, .07))]
TUBES += [([(x, y, 1.2), (x, y, .16)], (.24, .2)) for x in (-.6, .6) for y in (-.3, .3)]


def add_ball(place, half_axes, turn=0.):
    bpy.ops.mesh.primitive_uv_sphere_add(segments=32, ring_count=16, location=place, scale=half_axes, rotation=(0., 0., turn))


def make_body():
    """The union of ellipsoids and tubes, whose inner faces a voxel remesh takes away."""
    for ball in ELLIPSOIDS:
        add_ball(*ball)
    for places, radii in TUBES:
        for (a, b), (r, s) in zip(zip(places, places[1:]), zip(radii, radii[1:])):
            for i in range(13):
                part = i / 12
                add_ball(Vector(a).lerp(b, part), [r + part * (s - r)] * 3)
    bpy.ops.object.select_by_type(type="MESH")
    bpy.ops.object.join()
    body = bpy.context.object
    bpy.ops.object.transform_apply()
    body.name = body.data.name = "elephant"
    remesh = body.modifiers.new("remesh", "REMESH")
    remesh.mode, remesh.voxel_size = "VOXEL", .035
    body.modifiers.new("smooth", "SMOOTH").iterations = 15
    for name in body.modifiers.keys():
        bpy.ops.object.modifier_apply(modifier=name)
    bpy.ops.object.shade_smooth()
    skin = bpy.data.materials.new("skin")
    skin.diffuse_color = (.42, .4, .44, 1.)
    body.data.materials.append(skin)
    return body


def is_free(x, y, z):
    """Ears, trunk and tail: what is outside of body and head, a little larger, and above the legs or between them."""
    outside = all(sum(((c - m) / (1.1 * r)) ** 2 for c, m, r in zip((x, y, z), place, half_axes)) > 1
                  for place, half_axes, _ in ELLIPSOIDS[:2])
    return outside and (z > 1.1 or abs(y) < .08)


def add_curl(body):
    """A shape key with the trunk raised: it turns by up to 120 degrees about its root."""
    body.shape_key_add(name="Basis")
    key = body.shape_key_add(name="trumpet", from_mix=False)
    root = Vector((1.6, 0., 1.6))
    for point in key.data:
        if point.co.x > 1.45:
            depth = min(1., max(0., (1.6 - point.co.z) / .6)) if point.co.x > 1.52 else 0.
            turn = Quaternion((0., 1., 0.), -math.radians(110) * depth)
            point.co = root + turn @ (point.co - root)


def make_rig(body, scene):
    """The trunk of the body, the head and four legs, in a walk of two steps that ends with a shake of the head."""
    rig = bpy.data.objects.new("rig", bpy.data.armatures.new("rig"))
    scene.collection.objects.link(rig)
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    bones = {"spine": ((-.9, 0., 1.5), (.8, 0., 1.5)), "head": ((.8, 0., 1.6), (1.45, 0., 1.95))}
    bones.update({f"leg {i}": ((x, y, 1.25), (x, y, .05)) for i, (x, y) in enumerate(((-.6, -.3), (.6, .3), (-.6, .3), (.6, -.3)))})
    for name, (head, tail) in bones.items():
        bone = rig.data.edit_bones.new(name)
        bone.head, bone.tail = head, tail
        bone.parent = rig.data.edit_bones["spine"] if name != "spine" else None
    bpy.ops.object.mode_set(mode="OBJECT")
    body.select_set(True)
    rig.select_set(True)
    bpy.ops.object.parent_set(type="ARMATURE_AUTO")
    rig.show_in_front = True
    for frame in range(scene.frame_start, scene.frame_end + 1, 2):
        phase = 2 * math.pi * (frame - scene.frame_start) / 24
        for bone in rig.pose.bones:
            bone.rotation_mode = "XYZ"
        for i in range(4):
            rig.pose.bones[f"leg {i}"].rotation_euler = (.3 * math.sin(phase + math.pi * (i // 2)), 0., 0.)
        rig.pose.bones["head"].rotation_euler = (.15 * math.sin(2 * phase), 0., .55 * math.sin(phase))
        rig.location = (.5 * phase / math.pi, 0., .04 * math.cos(2 * phase))
        for bone in rig.pose.bones:
            bone.keyframe_insert("rotation_euler", frame=frame)
        rig.keyframe_insert("location", frame=frame)
    return rig


def set_up():
    global begin
    bpy.ops.object.select_all(action="SELECT")
    bpy.ops.object.delete()
    bpy.ops.preferences.addon_install(filepath=str(build / "exemplar_addon.zip"))
    bpy.ops.preferences.addon_enable(module=ADDON)
    bpy.context.preferences.addons[ADDON].preferences.program = str(build / "exemplar")
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 1, 49
    body = make_body()
    add_curl(body)
    make_rig(body, scene)
    rigid = body.vertex_groups.new(name="rigid")
    rigid.add([vertex.index for vertex in body.data.vertices if not is_free(*vertex.co)], 1., "REPLACE")
    body.modifiers.new("fine", "SUBSURF")
    bpy.context.view_layer.objects.active = body
    body.exemplar.follow, body.exemplar.stiffness = "rigid", 3e5
    bpy.ops.wm.save_as_mainfile(filepath=str(picture.with_suffix(".blend")))
    begin = time.monotonic()
    bpy.ops.exemplar.run()
    bpy.app.timers.register(look, first_interval=.5)


def look():
    running = sys.modules[ADDON].Running
    if running.job is not None:
        return .2
    print(f"{time.monotonic() - begin:.1f} s, {running.said}")
    bpy.ops.wm.save_mainfile()
    result = bpy.data.objects["elephant result"]
    bpy.context.scene.frame_set(SHOWN)
    for area in bpy.context.screen.areas:
        if area.type == "VIEW_3D":
            space = area.spaces.active
            space.show_region_ui, space.shading.color_type, space.shading.show_cavity = True, "MATERIAL", True
            region = next(region for region in area.regions if region.type == "WINDOW")
            bpy.context.view_layer.objects.active = bpy.data.objects["elephant"]
            for thing in bpy.data.objects:
                thing.select_set(thing == result)
            space.region_3d.view_rotation = Vector((-1., .9, -.25)).to_track_quat("-Z", "Y")
            with bpy.context.temp_override(area=area, region=region):
                bpy.ops.view3d.view_selected()
            result.select_set(False)
            sidebar = next(region for region in area.regions if region.type == "UI")
            # the tabs are at the right end, exemplar's is the last one
            x, y = sidebar.x + sidebar.width - 8, bpy.context.window.height - (sidebar.y + sidebar.height - 180)
            subprocess.run(["xdotool", "mousemove", str(x), str(y), "click", "1"], check=True)
    bpy.app.timers.register(take, first_interval=2.)
    return None


def take():
    area = next(area for area in bpy.context.screen.areas if area.type == "VIEW_3D")
    with bpy.context.temp_override(area=area):
        bpy.ops.screen.screenshot_area(filepath=str(picture))
    bpy.ops.wm.quit_blender()


bpy.app.timers.register(set_up, first_interval=1.)
