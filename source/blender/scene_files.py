# SPDX-License-Identifier: GPL-3.0-or-later
"""What a run of exemplar reads of an object: its surface, shape keys, vertex groups and motion, in world coordinates, and the scene."""
import csv
import struct
from pathlib import Path

import bpy
import numpy as np

from .exemplar_blender import Failure

# Painted vertex groups of these names become maps: the key, and the factors of the weights 0 and 1.
PAINTED = {"exemplar stiffness": ("Young's modulus map", (0.1, 10.)), "exemplar density": ("Density map", (0.1, 10.)),
           "exemplar importance": ("Importance map", None)}


def places_of(coordinates, matrix):
    """Local coordinates, an array of n times 3 or a collection of vertices or shape key points, in the world."""
    if not isinstance(coordinates, np.ndarray):
        numbers = np.empty(3 * len(coordinates), dtype=np.float32)
        coordinates.foreach_get("co", numbers)
        coordinates = numbers.reshape(-1, 3)
    turn = np.array(matrix, dtype=float)
    return coordinates.astype(float) @ turn[:3, :3].T + turn[:3, 3]


def rest_places(body):
    """Of the vertices at rest: those of the first shape key, if there are any, without modifiers."""
    keys = body.data.shape_keys
    return places_of(keys.reference_key.data if keys else body.data.vertices, body.matrix_world)


def poses_of(body):
    """{name: places} of the shape keys that are not muted, without the one at rest."""
    keys = body.data.shape_keys
    blocks = keys.key_blocks if keys else []
    return {key.name: places_of(key.data, body.matrix_world) for key in blocks if key != keys.reference_key and not key.mute}


def clothes_of(body):
    """Meshes that are children of the body and seen: what it wears."""
    return [child for child in body.children_recursive if child.type == "MESH" and child.data.polygons and not child.hide_viewport]


def obstacles_of(body, scene):
    """Meshes with Collision physics that are seen, but for the body and what it wears: what it may not pass."""
    own = {body, *clothes_of(body)}
    return [shown for shown in scene.objects
            if shown.type == "MESH" and shown.data.polygons and shown not in own and not shown.hide_viewport
            and any(modifier.type == "COLLISION" for modifier in shown.modifiers)]


def faces_of(shown):
    """As they are turned in the world: a mirrored object turns them over."""
    turn = -1 if shown.matrix_world.determinant() < 0 else 1
    return [tuple(face.vertices)[::turn] for face in shown.data.polygons]


def evaluated_places(body):
    """Of the vertices as modifiers and shape keys put them in the current frame."""
    shown = body.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = shown.to_mesh()
    try:
        if len(mesh.vertices) != len(body.data.vertices):
            raise Failure(f"Modifiers of {body.name} make {len(mesh.vertices)} of its {len(body.data.vertices)} vertices. Switch off in "
                          "the viewport those that change their number, such as Subdivision Surface, and keep the armature.")
        return places_of(mesh.vertices, shown.matrix_world)
    finally:
        shown.to_mesh_clear()


def motion_of(body, scene):
    """Places (frames, vertices, 3) in all frames of the scene, which then shows the frame that it has shown."""
    shown = scene.frame_current
    try:
        places = []
        for frame in range(scene.frame_start, scene.frame_end + 1):
            scene.frame_set(frame)
            places.append(evaluated_places(body))
        return np.array(places)
    finally:
        scene.frame_set(shown)


def group_weights(body, name):
    """Of each vertex in a vertex group; 0 where it is not in it."""
    group = body.vertex_groups[name].index
    weights = np.zeros(len(body.data.vertices))
    for vertex in body.data.vertices:
        for element in vertex.groups:
            if element.group == group:
                weights[vertex.index] = element.weight
    return weights


def write_obj(path, places, faces):
    with open(path, "w", encoding="utf-8") as file:
        file.writelines(f"v {x:.9g} {y:.9g} {z:.9g}\n" for x, y, z in places)
        file.writelines("f " + " ".join(str(vertex + 1) for vertex in face) + "\n" for face in faces)


def write_mdd(path, places, times):
    n_frames, n_points, _ = places.shape
    head = struct.pack(">ii", n_frames, n_points) + np.asarray(times, dtype=">f4").tobytes()
    Path(path).write_bytes(head + places.astype(">f4").tobytes())


def write_groups(path, groups):
    """A column a group, a row a vertex."""
    with open(path, "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(groups)
        table.writerows(zip(*(map("{:.6g}".format, weights) for weights in groups.values())))


def frames_per_second(scene):
    return scene.render.fps / scene.render.fps_base


class Keys:
    """Lines of a scene file."""

    def __init__(self, comment):
        self.lines = [f"# {line}" for line in comment] + [""]

    def add(self, subsection, **keys):
        names = subsection.split("/") if subsection else []
        self.lines += [f"{'  ' * i}subsection {name}" for i, name in enumerate(names)]
        self.lines += [f"{'  ' * len(names)}set {key.replace('_', ' ')} = {value}" for key, value in keys.items()]
        self.lines += [f"{'  ' * i}end" for i in reversed(range(len(names)))]

    def text(self):
        return "\n".join(self.lines) + "\n"


def check(body, settings, scene):
    """Throws Failure for what no scene can be made of."""
    if body.mode == "EDIT":
        raise Failure(f"{body.name} is being edited. Leave the edit mode first.")
    if not body.data.polygons:
        raise Failure(f"{body.name} has no faces. The body is the object whose closed surface it is.")
    for name in (settings.follow, settings.pin):
        if name and name not in body.vertex_groups:
            raise Failure(f"{body.name} has no vertex group '{name}'. Choose another, or none.")
    if scene.frame_end <= scene.frame_start:
        raise Failure(f"The scene has the frames {scene.frame_start} to {scene.frame_end}. Let it end after it begins.")


def handles_of(settings):
    """{name of the handle: its keys}."""
    handles = {}
    if settings.follow:
        handles["follow"] = {"Select": "map groups.csv:follow above 0.5", "Follow_cache": "rig.mdd"}
    if settings.pin:
        handles["pin"] = {"Select": "map groups.csv:pin above 0.5"}
    return handles


def write_obstacle(shown, number, scene, directory):
    """An obstacle at the first frame, and its motion if it has one; its keys."""
    write_obj(directory / f"obstacle_{number}.obj", evaluated_places(shown), faces_of(shown))
    keys = {"Shape": f"surface obstacle_{number}.obj", "Friction": f"{shown.collision.friction_factor:.9g}"}
    places = motion_of(shown, scene)
    if np.any(places != places[0]):
        write_mdd(directory / f"obstacle_{number}.mdd", places, np.arange(len(places)) / frames_per_second(scene))
        keys["Follow_cache"] = f"obstacle_{number}.mdd"
    return keys


def scene_text(body, settings, scene, poses, painted, obstacles):
    rate = frames_per_second(scene)
    keys = Keys([f"Expect the object {body.name} to move through the frames {scene.frame_start} to {scene.frame_end}.",
                 "Written by exemplar's add-on for Blender, which writes it anew when Run is pressed.",
                 *(f"pose_{i}.obj is the shape key {name}." for i, name in enumerate(poses, 1)),
                 *(f"worn_{i}.obj is the object {child.name}." for i, child in enumerate(clothes_of(body), 1)),
                 *(f"obstacle_{i}.obj is the object {shown.name}." for i, shown in enumerate(obstacles_of(body, scene), 1))])
    keys.add("", Scene="dynamic")
    scale = scene.unit_settings.scale_length if scene.unit_settings.system != "NONE" else 1.
    mesh = {"File": "body.obj", "Cells": settings.cells, "Repair": str(settings.repair).lower(), "Scale": f"{scale:.9g}"}
    clothes = clothes_of(body)
    if clothes:
        mesh["Carry"] = ", ".join(f"worn_{i}.obj" for i in range(1, len(clothes) + 1))
    keys.add("Mesh", **mesh)
    material = {"Young's modulus": f"{settings.stiffness:.9g}"}
    for name in painted:
        key, factors = PAINTED[name]
        column = name.split()[1]
        material[key] = f"groups.csv:{column}" + (f" from {factors[0]} to {factors[1]}" if factors else "")
    keys.add("Material", **material)
    if poses:
        keys.add("Examples", Poses=", ".join(f"pose_{i}.obj" for i in range(1, len(poses) + 1)), Importance=f"{settings.importance:.9g}")
    handles = handles_of(settings)
    if handles:
        keys.add("Handles", Names=", ".join(handles))
    for name, of_handle in handles.items():
        keys.add(f"Handles/{name}", **of_handle)
    if obstacles:
        keys.add("Obstacles", Names=", ".join(obstacles))
    for name, of_obstacle in obstacles.items():
        keys.add(f"Obstacles/{name}", **of_obstacle)
    if scene.use_gravity:
        keys.add("Loads", Gravity=", ".join(f"{g:.9g}" for g in scene.gravity))
    keys.add("Time", Step=f"{1. / rate:.12g}", End=f"{(scene.frame_end - scene.frame_start) / rate:.12g}")
    keys.add("Output", Every=1, Formats="pc2")
    return keys.text()


def write_scene(body, settings, scene, directory):
    """Write all that a run reads into a directory, which is made; the scene file."""
    check(body, settings, scene)
    directory.mkdir(parents=True, exist_ok=True)
    shown = scene.frame_current
    scene.frame_set(scene.frame_start)  # the body begins where the object is at the first frame
    try:
        faces = faces_of(body)
        write_obj(directory / "body.obj", rest_places(body), faces)
        poses = poses_of(body)
        for i, places in enumerate(poses.values(), 1):
            write_obj(directory / f"pose_{i}.obj", places, faces)
        for i, child in enumerate(clothes_of(body), 1):
            write_obj(directory / f"worn_{i}.obj", rest_places(child), faces_of(child))
        obstacles = {f"obstacle {i}": write_obstacle(shown_object, i, scene, directory)
                     for i, shown_object in enumerate(obstacles_of(body, scene), 1)}
    finally:
        scene.frame_set(shown)
    painted = [name for name in PAINTED if name in body.vertex_groups]
    groups = {handle: group_weights(body, name) for handle, name in (("follow", settings.follow), ("pin", settings.pin)) if name}
    groups.update((name.split()[1], group_weights(body, name)) for name in painted)
    if groups:
        write_groups(directory / "groups.csv", groups)
    if settings.follow:
        places = motion_of(body, scene)
        write_mdd(directory / "rig.mdd", places, np.arange(len(places)) / frames_per_second(scene))
    file = directory / "scene.prm"
    file.write_text(scene_text(body, settings, scene, poses, painted, obstacles), encoding="utf-8")
    return file
