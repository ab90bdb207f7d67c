# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads a glTF of a run by Blender's importer: of each mesh the places of its vertices in the frames of the run, as JSON.

    blender --background --python read_gltf.py -- FILE.glb RESULT.json
"""
import json
import math
import struct
import sys

import bpy
import numpy

if "bool" not in vars(numpy):
    numpy.bool = bool  # the importer of Debian 12's Blender is older than its numpy

file, result = sys.argv[sys.argv.index("--") + 1:]
with open(file, "rb") as stream:
    data = stream.read()
n_text, = struct.unpack_from("<I", data, 12)
document = json.loads(data[20:20 + n_text])
accessor = document["accessors"][document["animations"][0]["samplers"][0]["input"]]
view = document["bufferViews"][accessor["bufferView"]]
times = struct.unpack_from(f"<{accessor['count']}f", data, 28 + n_text + view["byteOffset"])

bpy.ops.object.select_all(action="SELECT")
bpy.ops.object.delete()
bpy.ops.import_scene.gltf(filepath=file)
scene, found = bpy.context.scene, {}
rate = scene.render.fps / scene.render.fps_base
shown = [each for each in bpy.data.objects if each.type == "MESH" and each.users_scene]
for each in shown:
    found[each.name] = {"frames": [], "keys": [key.name for key in each.data.shape_keys.key_blocks[1:]],
                        "materials": [material.name for material in each.data.materials if material], "uv": len(each.data.uv_layers) > 0}
for time in times:
    frame = time * rate
    scene.frame_set(math.floor(frame), subframe=frame - math.floor(frame))
    for each in shown:
        evaluated = each.evaluated_get(bpy.context.evaluated_depsgraph_get())
        found[each.name]["frames"].append([list(evaluated.matrix_world @ vertex.co) for vertex in evaluated.to_mesh().vertices])
        evaluated.to_mesh_clear()
with open(result, "w") as stream:
    json.dump(found, stream)
