# SPDX-License-Identifier: GPL-3.0-or-later
"""What a run of exemplar reads of an object: its surface, shape keys, vertex groups and motion, in world coordinates, and the scene."""
import csv
import struct
from dataclasses import dataclass, field
from pathlib import Path

import bpy
import numpy as np

from .exemplar_blender import Failure
from .surfaces import Surface, at_rest, group_weights, in_world, seen_motion, worn_by

# Painted vertex groups of these names become maps: the key, and the factors of the weights 0 and 1.
PAINTED = {"exemplar stiffness": ("Young's modulus map", (0.1, 10.)), "exemplar density": ("Density map", (0.1, 10.)),
           "exemplar importance": ("Importance map", None)}
PAINTED_OF_SHELLS = {"exemplar thickness": ("Thickness map", (0.1, 10.))}
TENSION = "exemplar tension"  # a custom property of the body in Pa, keyed or driven, as by a bone's rotation: how its muscle pulls
MUSCLE = "exemplar muscle"    # the painted vertex group that pulls; without one all does
FIBRES = ("exemplar fibres from", "exemplar fibres to")  # vertex groups between which fibres go
REGION = "exemplar region "  # vertex groups whose names begin so are regions with weights of their own
EARTH = 9.81  # [m/s^2]
STILL = 1e-5  # of the body's size: what moves less is taken to be at rest


@dataclass
class Shot:
    """What a run is given, by names and numbers, which last when objects are renamed or deleted."""
    file: Path
    faces: list        # of the body
    matrix: list       # of the body in the first frame
    poses: list        # names of the shape keys that are examples
    worn: list         # (name, matrix at rest) of what the body wears
    regions: list = field(default_factory=list)  # names of the painted regions
    n_frames: int = 0  # after the first one
    steps: int = 1     # a frame
    notes: list = field(default_factory=list)  # what the artist should know
    obstacles: list = field(default_factory=list)  # names of the objects with Collision physics
    tension: list = field(default_factory=list)    # of the body's muscle in each frame [Pa]
    has_muscle: bool = False                       # whether a vertex group says where it is


def is_shell(settings):
    return settings.kind == "SHELL"


def painted_of(settings):
    """What may be painted."""
    return {**PAINTED, **(PAINTED_OF_SHELLS if is_shell(settings) else {})}


def unit_scale(scene):
    """Metres of a unit of the scene."""
    return scene.unit_settings.scale_length if scene.unit_settings.system != "NONE" else 1.


def gravity_of(scene):
    """In m/s^2, three numbers. Blender's unit of length counts for it, too, but a new scene has 9.81 whatever its unit becomes, and means
    the Earth's."""
    gravity = np.array(scene.gravity, dtype=float) if scene.use_gravity else np.zeros(3)
    untouched = np.allclose(gravity, (0., 0., -EARTH), atol=1e-5)
    return gravity if untouched else gravity * unit_scale(scene)


def examples_of(surface, keys):
    """{name: local places} of the shape keys that are not muted and move something."""
    size = np.linalg.norm(np.ptp(surface.rest, axis=0))
    return {name: shape for name, shape in surface.shapes.items()
            if not keys.key_blocks[name].mute and np.abs(shape - surface.rest).max() > 1e-7 * size}


def obstacles_of(body, scene):
    """Meshes with Collision physics that are seen, but for the body and what it wears: what it may not pass."""
    own = {body, *worn_by(body)}
    return [shown for shown in scene.objects
            if shown.type == "MESH" and shown.data.polygons and shown not in own and shown.visible_get()
            and any(modifier.type == "COLLISION" and modifier.show_viewport for modifier in shown.modifiers)]


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
    if abs(body.matrix_world.determinant()) < 1e-30:
        raise Failure(f"{body.name} has a scale of 0. A body has an extent along all axes.")
    if is_shell(settings):
        check_shell(body, settings)
    for name in (settings.follow, settings.pin):
        if name and name not in body.vertex_groups:
            raise Failure(f"{body.name} has no vertex group '{name}'. Choose another, or none.")
        if name and not group_weights(body, body.data, name).max() > .5:
            raise Failure(f"No vertex of {body.name} has a weight above 0.5 in the vertex group '{name}'. Paint more, or choose another.")
    if settings.regions == "PAINTED" and not regions_of(body):
        raise Failure(f"Regions are to be painted, but no vertex group of {body.name} is called '{REGION}' and a name. Paint one, or set "
                      "Regions to None.")
    for name in FIBRES if TENSION in body else ():
        if name not in body.vertex_groups or not group_weights(body, body.data, name).max() > .5:
            raise Failure(f"{body.name} has the property '{TENSION}', but no vertex with a weight above 0.5 in a vertex group '{name}'. Its "
                          "fibres go from one group to the other: paint both ends of the muscle.")
    if scene.frame_end <= scene.frame_start:
        raise Failure(f"The scene has the frames {scene.frame_start} to {scene.frame_end}. Let it end after it begins.")
    for label, begin, end in (("Follow", settings.follow_from, settings.follow_until), ("Pin", settings.pin_from, settings.pin_until)):
        if end and begin == end:
            raise Failure(f"{label} is caught and let go in the same frame, {end}. Give two, or 0 for the whole shot.")


def check_shell(body, settings):
    """Throws Failure for what is of solid bodies alone."""
    if settings.regions == "AUTO":
        raise Failure(f"Regions that are found are of solid bodies, and {body.name} is a shell. Set Regions to None or Painted.")
    if TENSION in body:
        raise Failure(f"Muscles are in solid bodies, and {body.name} is a shell with the property '{TENSION}'. Remove the property, or set Body to "
                      "Solid.")


def tension_of(body, scene):
    """The custom property in each frame, with what keys and drivers make of it [Pa]; none without it."""
    if TENSION not in body:
        return []
    values = []
    for frame in range(scene.frame_start, scene.frame_end + 1):
        scene.frame_set(frame)
        values.append(float(body.evaluated_get(bpy.context.evaluated_depsgraph_get())[TENSION]))
        if not 0. <= values[-1] < float("inf"):
            raise Failure(f"{TENSION} of {body.name} is {values[-1]:g} in frame {frame}, but muscles do not push. Keep it at 0 or more.")
    return values


def tension_formula(values, rate):
    """Straight from frame to frame, as a formula of t."""
    ramps = "".join(f"{after - before:+.9g}*min(max({rate:.12g}*t-{k},0),1)" for k, (before, after) in enumerate(zip(values, values[1:]))
                    if after != before)
    return f"max(0,{values[0]:.9g}{ramps})" if ramps else f"{values[0]:.9g}"


def regions_of(body):
    """Vertex groups that are regions."""
    return [group.name for group in body.vertex_groups if group.name.startswith(REGION) and group.name != REGION]


def span_of(begin, end, scene):
    """Keys for a handle that is caught in frame `begin` and let go in frame `end`, where these lie in the shot."""
    def seconds(frame):
        return f"{(frame - scene.frame_start) / frames_per_second(scene):.9g}"
    keys = {}
    if begin > scene.frame_start:
        keys["From"] = seconds(begin)
    if end > scene.frame_start:
        keys["Until"] = seconds(end)
    return keys


def handles_of(settings, scene, is_posed):
    """{name of the handle: its keys}; `is_posed`: the shot does not begin at rest."""
    handles = {}
    if settings.follow:
        handles["follow"] = {"Select": "map groups.csv:follow above 0.5", "Follow_cache": "rig.mdd",
                             **span_of(settings.follow_from, settings.follow_until, scene)}
    if settings.pin:
        where = {"Follow_cache": "pin.mdd"} if is_posed else {}
        handles["pin"] = {"Select": "map groups.csv:pin above 0.5", **where, **span_of(settings.pin_from, settings.pin_until, scene)}
    return handles


def is_balanced(settings, scene, shot, handles):
    """Whether the body stands as it is drawn: something must hold it in the first frame, and something pull. Obstacles bear it otherwise."""
    def from_the_start(keys):
        return "From" not in keys and keys.get("Until") != "0"
    stands_alone = not (is_shell(settings) or settings.touches_itself or shot.obstacles or shot.tension)
    return settings.balanced and stands_alone and bool(gravity_of(scene).any()) and any(map(from_the_start, handles.values()))


def notes_of(body, settings, scene, shot, is_posed):
    if is_shell(settings):
        worn = [item.name for item in worn_by(body)]
        return [f"{', '.join(worn)}: a shell carries nothing, so what {body.name} wears stays where it is."] if worn else []
    if not settings.balanced or not gravity_of(scene).any():
        return []
    if settings.touches_itself:
        return [f"{body.name} touches itself, and Balanced does nothing beside that: the body sags under its weight where it is held."]
    if shot.tension:
        return [f"{body.name} has a muscle, and Balanced does nothing beside '{TENSION}': the body sags under its weight where it is held."]
    if shot.obstacles:
        return [f"{', '.join(shot.obstacles)}: {body.name} may not pass them, and Balanced does nothing beside Collision physics: the body sags "
                "under its weight where it is held."]
    if not is_balanced(settings, scene, shot, handles_of(settings, scene, is_posed)):
        return [f"Nothing holds {body.name} in the first frame, so it falls, and Balanced does nothing: choose Follow or Pin."]
    return []


def truth(value):
    return str(value).lower()


def write_obstacle(shown, number, scene, directory):
    """An obstacle in the first frame, behind all of its modifiers, and its motion if it has one; its keys."""
    faces, places = seen_motion(shown, scene, range(scene.frame_start, scene.frame_end + 1))
    write_obj(directory / f"obstacle_{number}.obj", places[0], faces)
    keys = {"Shape": f"surface obstacle_{number}.obj", "Friction": f"{shown.collision.friction_factor:.9g}"}
    if np.any(places != places[0]):
        write_mdd(directory / f"obstacle_{number}.mdd", places, np.arange(len(places)) / frames_per_second(scene))
        keys["Follow_cache"] = f"obstacle_{number}.mdd"
    return keys


def friction_of(body):
    """Of its Collision physics, if it has these."""
    return body.collision.friction_factor if any(modifier.type == "COLLISION" for modifier in body.modifiers) else 0.


def scene_text(body, settings, scene, shot, painted, is_posed, obstacles):
    rate = frames_per_second(scene)
    keys = Keys([f"Expect the object {body.name} to move through the frames {scene.frame_start} to {scene.frame_end}.",
                 "Written by exemplar's add-on for Blender, which writes it anew when Run is pressed.",
                 *(f"pose_{i}.obj is the shape key {name}." for i, name in enumerate(shot.poses, 1)),
                 *(f"worn_{i}.obj is the object {name}." for i, (name, _) in enumerate(shot.worn, 1)),
                 *(f"Region {i} is the vertex group {name}." for i, name in enumerate(shot.regions, 1)),
                 *(f"obstacle_{i}.obj is the object {name}." for i, name in enumerate(shot.obstacles, 1))])
    keys.add("", Scene="dynamic")
    of_kind = {"Kind": "shell"} if is_shell(settings) else {"Cells": settings.cells, "Repair": truth(settings.repair)}
    mesh = {"File": "body.obj", **of_kind, "Scale": f"{unit_scale(scene):.7g}"}
    if shot.worn:
        mesh["Carry"] = ", ".join(f"worn_{i}.obj" for i in range(1, len(shot.worn) + 1))
    keys.add("Mesh", **mesh)
    material = {"Young's modulus": f"{settings.stiffness:.7g}"}
    if is_shell(settings):
        material["Thickness"] = f"{settings.thickness:.7g}"
    for name in painted:
        key, factors = painted_of(settings)[name]
        column = name.split()[1]
        material[key] = f"groups.csv:{column}" + (f" from {factors[0]} to {factors[1]}" if factors else "")
    if shot.tension:
        material["Fibre tension"] = tension_formula(shot.tension, rate)
        material["Fibre direction"] = "from map groups.csv:fibres_from above 0.5 to map groups.csv:fibres_to above 0.5"
        if shot.has_muscle:
            material["Fibre tension map"] = "groups.csv:muscle"
    keys.add("Material", **material)
    if shot.poses:
        examples = {"Poses": ", ".join(f"pose_{i}.obj" for i in range(1, len(shot.poses) + 1)),
                    "Importance": f"{settings.importance:.7g}", "Weights": settings.weights.lower()}
        if shot.regions:
            examples["Weight maps"] = ", ".join(f"groups.csv:region_{i}" for i in range(1, len(shot.regions) + 1))
        if settings.regions == "AUTO":
            examples["Regions"] = "auto"
        keys.add("Examples", **examples)
    handles = handles_of(settings, scene, is_posed)
    if handles:
        keys.add("Handles", Names=", ".join(handles))
    for name, of_handle in handles.items():
        keys.add(f"Handles/{name}", **of_handle)
    if obstacles:
        keys.add("Obstacles", Names=", ".join(obstacles))
    for name, of_obstacle in obstacles.items():
        keys.add(f"Obstacles/{name}", **of_obstacle)
    if settings.touches_itself and not is_shell(settings):
        keys.add("Contact", Self="true", Friction=f"{friction_of(body):.9g}")
    gravity = gravity_of(scene)
    if gravity.any():
        keys.add("Loads", Gravity=", ".join(f"{g:.7g}" for g in gravity), Balanced=truth(is_balanced(settings, scene, shot, handles)))
    if is_posed:
        keys.add("Initial", Pose="start.obj")
    keys.add("Time", Step=f"{1. / (rate * settings.steps):.12g}", End=f"{shot.n_frames / rate:.12g}",
             Mass_damping=f"{settings.damping:.7g}", Stiffness_damping=f"{settings.inner_damping:.7g}")
    keys.add("Output", Every=settings.steps, Formats="pc2")
    return keys.text()


def write_worn(body, directory):
    """Surfaces of what the body wears; (name, matrix at rest) of each."""
    worn = []
    with at_rest(body):
        for i, child in enumerate(worn_by(body), 1):
            surface = Surface(child)
            try:
                write_obj(directory / f"worn_{i}.obj", in_world(surface.rest, child.matrix_world), surface.faces())
            finally:
                surface.free()
            worn.append((child.name, [list(row) for row in child.matrix_world]))
    return worn


def write_tables(surface, settings, painted, regions, directory):
    groups = {handle: surface.group_weights(name) for handle, name in (("follow", settings.follow), ("pin", settings.pin)) if name}
    groups.update((name.split()[1], surface.group_weights(name)) for name in painted)
    if TENSION in surface.shown:
        groups.update((name.removeprefix("exemplar ").replace(" ", "_"), surface.group_weights(name)) for name in (*FIBRES, MUSCLE)
                      if name in surface.shown.vertex_groups)
    groups.update((f"region_{i}", surface.group_weights(name)) for i, name in enumerate(regions, 1))
    if groups:
        write_groups(directory / "groups.csv", groups)


def write_motion(surface, settings, scene, directory):
    """Caches of the handles, and the pose of the first frame. Whether that is another one than at rest."""
    frames = range(scene.frame_start, scene.frame_end + 1 if settings.follow else scene.frame_start + 1)
    rest, places = in_world(surface.rest, surface.shown.matrix_world), surface.motion(scene, frames)
    start = places[0]
    is_posed = bool(np.abs(start - rest).max() > STILL * np.linalg.norm(np.ptp(rest, axis=0)))
    if is_posed:
        write_obj(directory / "start.obj", start, surface.faces())
        if settings.pin:
            write_mdd(directory / "pin.mdd", start[None], [0.])
    if settings.follow:
        write_mdd(directory / "rig.mdd", places, np.arange(len(places)) / frames_per_second(scene))
    return is_posed


def write_scene(body, settings, scene, directory):
    """Write all that a run reads into a directory, which is made; the shot."""
    check(body, settings, scene)
    directory.mkdir(parents=True, exist_ok=True)
    shown = scene.frame_current
    scene.frame_set(scene.frame_start)  # the body begins where the object is at the first frame
    surface = Surface(body)
    try:
        matrix, keys = body.matrix_world.copy(), body.data.shape_keys
        write_obj(directory / "body.obj", in_world(surface.rest, matrix), surface.faces())
        found = obstacles_of(body, scene)
        obstacles = {f"obstacle {i}": write_obstacle(obstacle, i, scene, directory) for i, obstacle in enumerate(found, 1)}
        scene.frame_set(scene.frame_start)
        poses = examples_of(surface, keys)
        for i, shape in enumerate(poses.values(), 1):
            write_obj(directory / f"pose_{i}.obj", in_world(shape, matrix), surface.faces())
        worn = [] if is_shell(settings) else write_worn(body, directory)
        shot = Shot(directory / "scene.prm", surface.faces(), [list(row) for row in matrix], list(poses), worn,
                    regions_of(body) if settings.regions == "PAINTED" and poses else [], scene.frame_end - scene.frame_start,
                    settings.steps, obstacles=[shown.name for shown in found], tension=tension_of(body, scene),
                    has_muscle=MUSCLE in body.vertex_groups)
        scene.frame_set(scene.frame_start)
        painted = [name for name in painted_of(settings) if name in body.vertex_groups]
        write_tables(surface, settings, painted, shot.regions, directory)
        is_posed = write_motion(surface, settings, scene, directory)
        shot.notes = notes_of(body, settings, scene, shot, is_posed)
    finally:
        surface.free()
        scene.frame_set(shown)
    shot.file.write_text(scene_text(body, settings, scene, shot, painted, is_posed, obstacles), encoding="utf-8")
    return shot
