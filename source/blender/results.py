# SPDX-License-Identifier: GPL-3.0-or-later
"""What the artist gets back: copies of the body and of what it wears, with all that they have, moved by the run."""
import itertools
from pathlib import Path

import bpy
import numpy as np
from mathutils import Matrix

from . import exemplar_blender
from .exemplar_blender import Failure
from .surfaces import Surface, in_object

PLACE = ("location", "rotation", "scale", "delta_")  # properties that move an object as a whole


def make_result(body, part, shot, output, start, cache_file):
    """A copy of an object that was a part of the run: its shape keys with the run's weights, the residual and the modifiers behind what moved
    it. It, and what plays the residual."""
    run = exemplar_blender.Run(output, part.vertices)
    surface = Surface(body)
    if surface.faces() != part.faces:
        surface.free()
        raise Failure(f"{body.name} has other faces since the run began.")
    result = still_copy(body, surface, part.matrix)
    values = weights_of_keys(result, surface, part, shot, run)
    if values:
        exemplar_blender.animate_keys(result, values, start)
    places = in_object(run.places, result.matrix_basis)
    residual = exemplar_blender.residual_of(places, surface.rest, {name: surface.shapes[name] for name in values}, values)
    player, _ = exemplar_blender.add_residual(result, surface.rest, residual, start, cache_file, len(surface.replaced))
    show(result, body)
    return result, player


def make_plain_result(part, output, start):
    """A new object for a body that is not what it was, or is no more."""
    result = exemplar_blender.load_run(output, start=start, up="z", playback=False, vertices=part.vertices)
    return result, result.children[0]


def make_worn(child, matrix, result, file, cache_file, start):
    """A copy of what the body wears, which a point cache moves before its own modifiers; None if it has other vertices by now."""
    places = exemplar_blender.read_pc2(file)
    surface = Surface(child)
    if len(surface.rest) != places.shape[1]:
        surface.free()
        return None
    shown = still_copy(child, surface, matrix, result)
    exemplar_blender.write_pc2(cache_file, in_object(places, shown.matrix_basis))
    exemplar_blender.play_cache(shown, "exemplar", cache_file, start, len(surface.replaced))
    show(shown, child)
    return shown


def still_copy(shown, surface, matrix, parent=None):
    """A copy of an object and its mesh that stands still, with the modifiers off for which the simulation stands; in no collection. Its
    place is its matrix_basis, also with a parent, which has none: a matrix with shear is no place of an object."""
    copy = shown.copy()
    copy.data = surface.mesh if surface.is_made else shown.data.copy()
    copy.exemplar.token = ""  # another body
    keep_modifiers_animation(copy)
    copy.constraints.clear()
    copy.delta_location, copy.delta_rotation_euler, copy.delta_scale = (0., 0., 0.), (0., 0., 0.), (1., 1., 1.)
    copy.delta_rotation_quaternion = (1., 0., 0., 0.)
    copy.parent = parent
    copy.parent_type, copy.parent_bone = "OBJECT", ""
    if parent is not None:
        copy.matrix_parent_inverse = parent.matrix_basis.inverted()
    copy.matrix_basis = Matrix(matrix)
    for modifier in copy.modifiers[:len(surface.replaced)]:
        modifier.show_viewport = modifier.show_render = False
    if surface.is_made:
        rest = shown.data.shape_keys.reference_key.name if surface.shapes else ""
        exemplar_blender.add_shape_keys(copy, {name: (name, shape) for name, shape in surface.shapes.items()}, rest)
    silence_keys(copy)
    return copy


def show(copy, original):
    """Where the original is. Until then it is not evaluated whenever it is changed."""
    collections = [c for c in original.users_collection if c in bpy.context.scene.collection.children_recursive]
    (collections or [bpy.context.scene.collection])[0].objects.link(copy)


def keep_modifiers_animation(copy):
    """Of an object's animation, which it shares with the original, keep what does not move the object as a whole."""
    data = copy.animation_data
    if data is None:
        return
    for track in list(data.nla_tracks):
        data.nla_tracks.remove(track)
    for driver in [driver for driver in data.drivers if driver.data_path.startswith(PLACE)]:
        data.drivers.remove(driver)
    if data.action is not None:
        data.action = data.action.copy()
        for curve in [curve for curve in data.action.fcurves if curve.data_path.startswith((*PLACE, "pose", "constraints"))]:
            data.action.fcurves.remove(curve)


def silence_keys(copy):
    """Shape keys of a copy are those of its original, at 0 and without what moved them."""
    keys = copy.data.shape_keys
    copy.show_only_shape_key = False
    if keys is None:
        return
    keys.animation_data_clear()
    keys.use_relative = True
    for key in keys.key_blocks:
        key.value = 0.


def weights_of_keys(result, surface, part, shot, run):
    """{name of a shape key of the part: a value a frame}. Regions have keys of their own, which are added to the result and to the surface's
    shapes."""
    weights, values = run.weights(), {}
    named = dict(enumerate(["elsewhere", *(name.split(maxsplit=2)[2] for name in shot.regions)]))
    numbers = sorted({int(name.split("_")[1]) for name in weights if name.count("_") == 2})
    for i, pose in enumerate(shot.poses, 1):
        if pose not in part.poses:
            continue
        if not numbers:
            if f"weight_{i}" in weights and pose in surface.shapes:
                values[pose] = weights[f"weight_{i}"]
            continue
        for r in numbers:
            region, weight = named[r] if shot.regions else f"region {r}", f"weight_{r}_{i}"
            if weight in weights:
                key = result.shape_key_add(name=f"{pose} {region}", from_mix=False)
                surface.shapes[key.name] = in_object(run.read_shape(weight), result.matrix_basis)
                key.data.foreach_set("co", surface.shapes[key.name].astype(np.float32).ravel())
                values[key.name] = weights[weight]
    return values


def retarget(made):
    """Modifiers of the copies, {original: copy}, that looked at an original look at its copy."""
    for copy in made.values():
        for modifier in copy.modifiers:
            for name in ("object", "target", "auxiliary_target", "offset_object", "mirror_object"):
                if getattr(modifier, name, None) in made:
                    setattr(modifier, name, made[getattr(modifier, name)])


def free_prefix(directory):
    """For the files of a result: those of an earlier one that is kept are not written over."""
    used = {Path(bpy.path.abspath(modifier.filepath)).name for item in bpy.data.objects for modifier in item.modifiers
            if modifier.type == "MESH_CACHE"}
    return next(directory / f"take_{i}_" for i in itertools.count(1) if not any(name.startswith(f"take_{i}_") for name in used))
