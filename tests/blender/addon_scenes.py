# SPDX-License-Identifier: GPL-3.0-or-later
"""A bar that stands on its end, with an armature of two bones, and the add-on as an artist gets it: for scripts that Blender runs."""
import math
import time

import bpy
import numpy as np

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


def places(shown, frame):
    """In the world, behind all modifiers."""
    bpy.context.scene.frame_set(frame)
    shown = shown.evaluated_get(bpy.context.evaluated_depsgraph_get())
    return [list(shown.matrix_world @ vertex.co) for vertex in shown.to_mesh().vertices]


def add_key(body, name, places):
    key = body.shape_key_add(name=name, from_mix=False)
    key.data.foreach_set("co", np.array(places, dtype=np.float32).ravel())
    return key


def make_object(name, vertices, faces):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices, [], faces)
    made = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(made)
    return made


def add_group(body, name, chosen, weight=1.):
    """Of the vertices whose places are chosen."""
    group = body.vertex_groups.new(name=name)
    group.add([vertex.index for vertex in body.data.vertices if chosen(*vertex.co)], weight, "REPLACE")


def make_rig(body, begin=0., scale=1.):
    """An armature that takes the upper end from part `begin` of the way on to where the key "bent" has it: bones point along z, their third
    axis against y."""
    rig = bpy.data.objects.new("rig", bpy.data.armatures.new("rig"))
    bpy.context.scene.collection.objects.link(rig)
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    for name, z in (("low", 1.), ("high", 5.)):
        bone = rig.data.edit_bones.new(name)
        bone.head, bone.tail = (0., 0., scale * z), (0., 0., scale * (z + 1.))
    bpy.ops.object.mode_set(mode="POSE")
    bone = rig.pose.bones["high"]
    bone.rotation_mode = "XYZ"
    scene = bpy.context.scene
    x, _, z = bent(0., 0., 4.)
    for frame, part in ((scene.frame_start, begin), (scene.frame_end, 1.)):
        bone.rotation_euler = (0., 0., -part * math.pi / 3)
        bone.location = (part * scale * x, part * scale * (z - 4.), 0.)
        bone.keyframe_insert("rotation_euler", frame=frame)
        bone.keyframe_insert("location", frame=frame)
    bpy.ops.object.mode_set(mode="OBJECT")
    modifier = body.modifiers.new("rig", "ARMATURE")
    modifier.object = rig
    return rig


def install(addon, program):
    """The add-on's module, in an empty scene of the frames 3 to 18."""
    bpy.ops.wm.read_homefile(use_empty=True)
    bpy.ops.preferences.addon_install(filepath=str(addon))
    bpy.ops.preferences.addon_enable(module="exemplar_addon")
    import exemplar_addon
    bpy.context.preferences.addons["exemplar_addon"].preferences.program = str(program)
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end, scene.render.fps = 3, 18, 24
    return exemplar_addon


def wait(exemplar):
    """Until the run has ended: how many frames were seen."""
    seen = set()
    while exemplar.poll() is not None:
        seen.add(exemplar.Running.job.shown)
        time.sleep(.02)
    return len(seen)
