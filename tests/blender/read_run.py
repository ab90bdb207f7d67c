# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads what a run has written as Blender does: vertices a format and frame, as JSON.

    blender --background --python read_run.py -- OUTPUT_DIRECTORY EXEMPLAR_BLENDER.py RESULT.json [WEIGHT=FILE.obj]
"""
import importlib.util
import json
import sys
from pathlib import Path

import bpy

directory, script, result = map(Path, sys.argv[sys.argv.index("--") + 1:][:3])
shapes = dict(word.split("=") for word in sys.argv[sys.argv.index("--") + 4:])


def numbers(mesh):
    values = [0.] * (3 * len(mesh.vertices))
    mesh.vertices.foreach_get("co", values)
    return values


def evaluated(shown, frame):
    bpy.context.scene.frame_set(frame)
    evaluated_object = shown.evaluated_get(bpy.context.evaluated_depsgraph_get())
    values = numbers(evaluated_object.to_mesh())
    evaluated_object.to_mesh_clear()
    return values


def imported(file):
    before = set(bpy.data.objects)
    if file.suffix == ".obj":
        bpy.ops.wm.obj_import(filepath=str(file), forward_axis="Y", up_axis="Z")
    elif "ply_import" in dir(bpy.ops.wm):  # since 3.6
        bpy.ops.wm.ply_import(filepath=str(file), forward_axis="Y", up_axis="Z")
    else:
        bpy.ops.import_mesh.ply(filepath=str(file))
    added, = set(bpy.data.objects) - before
    return added


def cached(file, n_frames):
    """By the Mesh Cache modifier."""
    shown = imported(directory / "frame_0000.ply")
    modifier = shown.modifiers.new("cache", "MESH_CACHE")
    modifier.cache_format = file.suffix[1:].upper()
    modifier.filepath = str(file)
    modifier.frame_start = 1
    return [evaluated(shown, 1 + frame) for frame in range(n_frames)]


def script_module():
    spec = importlib.util.spec_from_file_location("exemplar_blender", script)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


found = {}
for extension in ("obj", "ply"):
    objects = [imported(file) for file in sorted(directory.glob(f"frame_*.{extension}"))]
    found[extension] = [numbers(shown.data) for shown in objects]
    found[f"{extension} faces"] = [list(polygon.vertices) for polygon in objects[0].data.polygons]
    if extension == "obj":
        found["obj texture"] = [tuple(point.uv) for point in objects[0].data.uv_layers[0].data]
        found["obj materials"] = [material.name for material in objects[0].data.materials]
n_frames = len(found["obj"])
for extension in ("mdd", "pc2"):
    found[extension] = cached(directory / f"animation.{extension}", n_frames)

module = script_module()
shown = module.load_run(directory, shapes)
scene = bpy.context.scene
found["range"] = [scene.frame_start, scene.frame_end]
found["frames per second"] = scene.render.fps / scene.render.fps_base
found["keys"] = [key.name for key in shown.data.shape_keys.key_blocks]
found["script"] = [evaluated(shown, 1 + frame) for frame in range(n_frames)]
found["values"] = []
for frame in range(n_frames):
    scene.frame_set(1 + frame)
    found["values"].append([key.value for key in shown.data.shape_keys.key_blocks[1:]])
shown.modifiers[module.RESIDUAL].show_viewport = False
found["without residual"] = [evaluated(shown, 1 + frame) for frame in range(n_frames)]
result.write_text(json.dumps(found))
