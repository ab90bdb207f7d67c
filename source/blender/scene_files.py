# SPDX-License-Identifier: GPL-3.0-or-later
"""What a run of exemplar reads of an object: its surface, shape keys, vertex groups and motion, in world coordinates, and the scene."""
import csv
import itertools
import struct
from dataclasses import dataclass, field
from pathlib import Path

import bpy
import numpy as np

from .exemplar_blender import Failure
from .surfaces import (JoinedSurface, Surface, all_worn_by, at_rest, group_weights, in_world, joined_faces, lie_inside, matrices_at_rest, seen_motion,
                       volume, worn_by)

# Painted vertex groups of these names become maps: the key, and the factors of the weights 0 and 1.
PAINTED = {"exemplar stiffness": ("Young's modulus map", (0.1, 10.)), "exemplar density": ("Density map", (0.1, 10.)),
           "exemplar importance": ("Importance map", (0., 1.))}
PAINTED_OF_SHELLS = {"exemplar thickness": ("Thickness map", (0.1, 10.))}
MADE = "exemplar made"  # custom property of objects that the add-on makes: for which body, and under which name
HIDDEN = "exemplar hidden"  # custom property of objects in whose place there is a result
TENSION = "exemplar tension"  # a custom property of the body in Pa, keyed or driven, as by a bone's rotation: how its muscle pulls
MUSCLE = "exemplar muscle"    # the painted vertex group that pulls; without one all does
FIBRES = ("exemplar fibres from", "exemplar fibres to")  # vertex groups between which fibres go
REGION = "exemplar region "  # vertex groups whose names begin so are regions with weights of their own
EARTH = 9.81  # [m/s^2]
STILL = 1e-5  # of the smallest body's size: what moves less is taken to be at rest
ENERGIES = {"LEAD": "scaled", "GUIDE": "mixed"}  # what a scene calls the choices of the panel
LOOSE = .01   # of the volume: smaller parts are dropped by Repair


@dataclass
class Part:
    """An object that is a body of a shot."""
    name: str
    token: str       # its identity
    faces: list
    matrix: list     # at rest
    poses: list      # names of its shape keys that are examples
    vertices: range  # of the surface of all


@dataclass
class Shot:
    """What a run is given, by names and numbers, which last when objects are renamed or deleted."""
    file: Path
    parts: list        # one or several; the first is the active object
    rest: np.ndarray   # places (n, 3) of their surface in the world
    poses: list        # names of the shape keys that are examples
    held: list         # handles that some object has a vertex group for: follow, pin
    painted: list      # names of the vertex groups that are maps
    worn: list         # (name, matrix at rest, number of the part) of what the bodies wear
    regions: list = field(default_factory=list)  # names of the painted regions
    weights: list = field(default_factory=list)  # of each frame a value per shape key of `poses`; empty: the run finds them
    n_frames: int = 0  # after the first one
    steps: int = 1     # a frame
    notes: list = field(default_factory=list)  # what the artist should know
    obstacles: list = field(default_factory=list)  # names of the objects with Collision physics
    tension: list = field(default_factory=list)    # of the first body's muscle in each frame [Pa]
    has_muscle: bool = False                       # whether a map says where it is
    unit: float = 1.                               # metres of a unit of the scene
    cells: int = 1                                 # how many were asked for

    def names(self):
        return ", ".join(part.name for part in self.parts)

    def rest_of(self, part):
        return self.rest[part.vertices.start:part.vertices.stop]

    def faces(self):
        return joined_faces([part.faces for part in self.parts], [part.vertices for part in self.parts])


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


def is_body(shown):
    """Whether a mesh of the panel's collection becomes a body; what a result stands in for counts as seen."""
    return shown.type == "MESH" and MADE not in shown and (HIDDEN in shown or shown.visible_get())


def bodies_of(body):
    """The object and those of its More bodies."""
    more = body.exemplar.more_bodies
    return [body, *(shown for shown in (more.all_objects if more else ()) if shown != body and is_body(shown))]


def examples_of(surface):
    """{name: local places} of the shape keys that are not muted and move something."""
    size, keys = np.linalg.norm(np.ptp(surface.rest, axis=0)), surface.shown.data.shape_keys
    return {name: shape for name, shape in surface.shapes.items()
            if not keys.key_blocks[name].mute and np.abs(shape - surface.rest).max() > 1e-7 * size}


def obstacles_of(bodies, scene):
    """Meshes with Collision physics that are seen, but for bodies and what they wear: what they may not pass."""
    own = {*bodies, *(child for child, _ in all_worn_by(bodies))}
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


def check(bodies, scene):
    """Throws Failure for what no scene can be made of."""
    settings = bodies[0].exemplar
    for body in bodies:
        check_body(body, settings)
    if len(bodies) > 1:
        check_several(bodies)
    if settings.weights == "KEYED" and settings.regions != "NONE":
        raise Failure(f"Weights are Keyed, and keyframes say one value per shape key, but Regions are "
                      f"{'Found' if settings.regions == 'AUTO' else 'Painted'}. Set Regions to None, or Weights to another choice.")
    if settings.regions == "PAINTED" and not regions_of(bodies):
        raise Failure(f"Regions are to be painted, but no vertex group of {listed(bodies)} is called '{REGION}' and a name. Paint one, or set "
                      "Regions to None.")
    check_muscle(bodies[0])
    if scene.frame_end <= scene.frame_start:
        raise Failure(f"The scene has the frames {scene.frame_start} to {scene.frame_end}. Let it end after it begins.")
    for label, begin, end in (("Follow", settings.follow_from, settings.follow_until), ("Pin", settings.pin_from, settings.pin_until)):
        if end and begin == end:
            raise Failure(f"{label} is caught and let go in the same frame, {end}. Give two, or 0 for the whole shot.")


def listed(objects):
    return ", ".join(shown.name for shown in objects)


def check_body(body, settings):
    """`settings` are those of the scene; vertex groups are the object's own."""
    if body.mode == "EDIT":
        raise Failure(f"{body.name} is being edited. Leave the edit mode first.")
    if not body.data.polygons:
        raise Failure(f"{body.name} has no faces. The body is the object whose closed surface it is.")
    if abs(body.matrix_world.determinant()) < 1e-30:
        raise Failure(f"{body.name} has a scale of 0. A body has an extent along all axes.")
    if is_shell(settings):
        check_shell(body, settings)
    for name in (body.exemplar.follow, body.exemplar.pin):
        if name and name not in body.vertex_groups:
            raise Failure(f"{body.name} has no vertex group '{name}'. Choose another, or none.")
        if name and not group_weights(body, body.data, name).max() > .5:
            raise Failure(f"No vertex of {body.name} has a weight above 0.5 in the vertex group '{name}'. Paint more, or choose another.")


def check_several(bodies):
    """Throws Failure for what bodies that meet each other cannot be."""
    shells = [body for body in bodies if is_shell(body.exemplar)]
    if shells:
        raise Failure(f"Shells meet no other bodies, and {shells[0].name} is a shell. Set its Body to Solid, or leave it out: More bodies of "
                      f"{bodies[0].name} has {listed(bodies[1:])}.")


def check_places(shot, settings):
    """Throws Failure for bodies that would be none of their own, without a word."""
    for inner, outer in itertools.permutations(shot.parts, 2):
        if lie_inside(shot.rest_of(inner), shot.rest_of(outer), outer.faces):
            raise Failure(f"{inner.name} lies inside of {outer.name}, and would be a part of it. Take it out of More bodies, or move it.")
    if not settings.repair:
        return
    volumes = {part.name: volume(shot.rest_of(part), part.faces) for part in shot.parts}
    small = [name for name, own in volumes.items() if own < LOOSE * sum(volumes.values())]
    if small:
        raise Failure(f"Repair drops what has less than 1 % of the volume of all bodies, as {', '.join(small)} has. Switch Repair off and mend the "
                      "surfaces in Blender, or take it out of More bodies.")


def check_muscle(body):
    for name in FIBRES if TENSION in body else ():
        if name not in body.vertex_groups or not group_weights(body, body.data, name).max() > .5:
            raise Failure(f"{body.name} has the property '{TENSION}', but no vertex with a weight above 0.5 in a vertex group '{name}'. Its "
                          "fibres go from one group to the other: paint both ends of the muscle.")


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


def keyed_weights(bodies, poses, scene):
    """Of each frame the value of each shape key, with what keys and drivers make of it: a key that several objects have is taken from the
    first of them."""
    owners = [next(body for body in bodies if body.data.shape_keys and name in body.data.shape_keys.key_blocks) for name in poses]
    values = []
    for frame in range(scene.frame_start, scene.frame_end + 1):
        scene.frame_set(frame)
        depsgraph = bpy.context.evaluated_depsgraph_get()
        values.append([float(owner.data.shape_keys.evaluated_get(depsgraph).key_blocks[name].value) for owner, name in zip(owners, poses)])
    if poses and not any(any(row) for row in values):
        raise Failure(f"Weights are Keyed, but the shape keys of {listed(bodies)} are 0 in all frames. Key their values, or set Weights to another "
                      "choice.")
    return values


def write_weights(path, shot, rate):
    """A row a frame: t, and the weight of each example but the rest pose."""
    with open(path, "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(["t", *(f"pose_{i}" for i in range(1, len(shot.poses) + 1))])
        table.writerows([f"{number:.9g}" for number in (frame / rate, *row)] for frame, row in enumerate(shot.weights))


def tension_formula(values, rate):
    """Straight from frame to frame, as a formula of t."""
    ramps = "".join(f"{after - before:+.9g}*min(max({rate:.12g}*t-{k},0),1)" for k, (before, after) in enumerate(zip(values, values[1:]))
                    if after != before)
    return f"max(0,{values[0]:.9g}{ramps})" if ramps else f"{values[0]:.9g}"


def regions_of(bodies):
    """Names of vertex groups that are regions; those of one name in several objects are one."""
    names = dict.fromkeys(group.name for body in bodies for group in body.vertex_groups)
    return [name for name in names if name.startswith(REGION) and name != REGION]


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


def handles_of(settings, scene, shot, is_posed):
    """{name of the handle: its keys}; `is_posed`: the shot does not begin at rest."""
    handles = {}
    if "follow" in shot.held:
        handles["follow"] = {"Select": "map groups.csv:follow above 0.5", "Follow_cache": "rig.mdd",
                             **span_of(settings.follow_from, settings.follow_until, scene)}
    if "pin" in shot.held:
        where = {"Follow_cache": "pin.mdd"} if is_posed else {}
        handles["pin"] = {"Select": "map groups.csv:pin above 0.5", **where, **span_of(settings.pin_from, settings.pin_until, scene)}
    return handles


def contact_of(settings, shot):
    """The key by which surfaces do not pass through each other, if there is one."""
    if settings.touches_itself and not is_shell(settings):
        return "Self"
    return "Bodies" if len(shot.parts) > 1 else None


def is_balanced(settings, scene, shot, handles):
    """Whether the body stands as it is drawn: something must hold it in the first frame, and something pull. Obstacles bear it otherwise."""
    def from_the_start(keys):
        return "From" not in keys and keys.get("Until") != "0"
    stands_alone = not (is_shell(settings) or contact_of(settings, shot) or shot.obstacles or shot.tension)
    return settings.balanced and stands_alone and bool(gravity_of(scene).any()) and any(map(from_the_start, handles.values()))


def notes_of(bodies, scene, shot, is_posed):
    """What the artist should know."""
    settings = bodies[0].exemplar
    notes = [without_balance(settings, scene, shot, is_posed)]
    if settings.more_bodies and len(bodies) == 1:
        notes.insert(0, f"More bodies: {settings.more_bodies.name} has no other mesh that is seen, so {shot.names()} moves alone.")
    if is_shell(settings):
        worn = listed(worn_by(bodies[0]))
        notes = [f"{worn}: a shell carries nothing, so what {shot.names()} wears stays where it is."] if worn else []
    return list(filter(None, notes))


def without_balance(settings, scene, shot, is_posed):
    """Why Balanced does nothing although it is on, or nothing."""
    if not settings.balanced or not gravity_of(scene).any():
        return ""
    name, sags = shot.parts[0].name, "the body sags under its weight where it is held."
    if len(shot.parts) > 1:
        return f"{shot.names()} do not pass through each other, and Balanced does nothing beside that: {sags}"
    if settings.touches_itself:
        return f"{name} touches itself, and Balanced does nothing beside that: {sags}"
    if shot.tension:
        return f"{name} has a muscle, and Balanced does nothing beside '{TENSION}': {sags}"
    if shot.obstacles:
        return f"{', '.join(shot.obstacles)}: {name} may not pass them, and Balanced does nothing beside Collision physics: {sags}"
    if not is_balanced(settings, scene, shot, handles_of(settings, scene, shot, is_posed)):
        return f"Nothing holds {name} in the first frame, so it falls, and Balanced does nothing: choose Follow or Pin."
    return ""


def vertices_near(shot, place):
    """Numbers of the vertices that are at rest within a cell's size of a place [m], and of the nearest."""
    distances = np.linalg.norm(shot.rest - np.array(place) / shot.unit, axis=1)
    return set(np.flatnonzero(distances <= max(cell_size(shot), distances.min())).tolist())


def cell_size(shot):
    """Edge of that many regular tetrahedra in all bodies."""
    return np.cbrt(6. * np.sqrt(2.) * volume(shot.rest, shot.faces()) / shot.cells)


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


def scene_text(body, scene, shot, is_posed, obstacles):
    settings, rate = body.exemplar, frames_per_second(scene)
    what = "object" if len(shot.parts) == 1 else "objects"
    keys = Keys([f"Expect the {what} {shot.names()} to move through the frames {scene.frame_start} to {scene.frame_end}.",
                 "Written by exemplar's add-on for Blender, which writes it anew when Run is pressed.",
                 *(f"pose_{i}.obj is the shape key {name}." for i, name in enumerate(shot.poses, 1)),
                 *(f"worn_{i}.obj is the object {name}." for i, (name, _, _) in enumerate(shot.worn, 1)),
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
    for name in shot.painted:
        key, factors = painted_of(settings)[name]
        column = name.split()[1]
        material[key] = f"groups.csv:{column}" + (f" from {factors[0]} to {factors[1]}" if factors != (0., 1.) else "")
    if shot.tension:
        material["Fibre tension"] = tension_formula(shot.tension, rate)
        material["Fibre direction"] = "from map groups.csv:fibres_from above 0.5 to map groups.csv:fibres_to above 0.5"
        if shot.has_muscle:
            material["Fibre tension map"] = "groups.csv:muscle"
    keys.add("Material", **material)
    if shot.poses:
        examples = {"Poses": ", ".join(f"pose_{i}.obj" for i in range(1, len(shot.poses) + 1)), "Importance": f"{settings.importance:.7g}"}
        if shot.weights:
            examples |= {"Weights": "prescribed", "Weights file": "weights.csv"}
        else:
            examples |= {"Energy": ENERGIES[settings.energy], "Weights": settings.weights.lower()}
        if shot.regions:
            examples["Weight maps"] = ", ".join(f"groups.csv:region_{i}" for i in range(1, len(shot.regions) + 1))
        if settings.regions == "AUTO":
            examples["Regions"] = "auto"
        keys.add("Examples", **examples)
    handles = handles_of(settings, scene, shot, is_posed)
    if handles:
        keys.add("Handles", Names=", ".join(handles))
    for name, of_handle in handles.items():
        keys.add(f"Handles/{name}", **of_handle)
    if obstacles:
        keys.add("Obstacles", Names=", ".join(obstacles))
    for name, of_obstacle in obstacles.items():
        keys.add(f"Obstacles/{name}", **of_obstacle)
    if contact_of(settings, shot):
        keys.add("Contact", **{contact_of(settings, shot): "true"}, Friction=f"{friction_of(body):.9g}")
    gravity = gravity_of(scene)
    if gravity.any():
        keys.add("Loads", Gravity=", ".join(f"{g:.7g}" for g in gravity), Balanced=truth(is_balanced(settings, scene, shot, handles)))
    if is_posed:
        keys.add("Initial", Pose="start.obj")
    keys.add("Time", Step=f"{1. / (rate * settings.steps):.12g}", End=f"{shot.n_frames / rate:.12g}",
             Mass_damping=f"{settings.damping:.7g}", Stiffness_damping=f"{settings.inner_damping:.7g}")
    keys.add("Output", Every=settings.steps, Formats="pc2")
    return keys.text()


def write_worn(bodies, directory):
    """Surfaces of what the bodies wear; (name, matrix at rest, number of the body) of each."""
    worn = []
    for i, (child, number) in enumerate(all_worn_by(bodies), 1):
        with at_rest(bodies[number]):
            surface = Surface(child)
            try:
                write_obj(directory / f"worn_{i}.obj", in_world(surface.rest, child.matrix_world), surface.faces())
            finally:
                surface.free()
            worn.append((child.name, [list(row) for row in child.matrix_world], number))
    return worn


def muscle_weights(surface, shot):
    """{column: weights} for the muscle of the first body. Fibres need a way through all bodies: through others, which do not pull, upwards."""
    others = [(places[:, 2] - places[:, 2].min()) / max(np.ptp(places[:, 2]), 1e-30)
              for places in map(shot.rest_of, shot.parts[1:])]
    first = surface.surfaces[0]
    ends = [np.concatenate([first.group_weights(name), *of_others]) for name, of_others in
            zip(FIBRES, ([height < 1 / 3 for height in others], [height > 2 / 3 for height in others]))]
    weights = {name.removeprefix("exemplar ").replace(" ", "_"): of_end for name, of_end in zip(FIBRES, ends)}
    if shot.has_muscle:
        own = first.group_weights(MUSCLE) if MUSCLE in first.shown.vertex_groups else np.ones(len(first.rest))
        weights["muscle"] = np.concatenate([own, *(np.zeros(len(height)) for height in others)])
    return weights


def write_tables(surface, settings, shot, directory):
    """Vertex groups. What has no group of what is painted is as without it: its factor is 1."""
    own = [part.shown.exemplar for part in surface.surfaces]
    groups = {handle: surface.group_weights([getattr(of_object, handle) for of_object in own]) for handle in shot.held}
    for name in shot.painted:
        low, high = painted_of(settings)[name][1]
        groups[name.split()[1]] = surface.group_weights([name] * len(own), absent=(1. - low) / (high - low))
    if shot.tension:
        groups.update(muscle_weights(surface, shot))
    groups.update((f"region_{i}", surface.group_weights([name] * len(own))) for i, name in enumerate(shot.regions, 1))
    if groups:
        write_groups(directory / "groups.csv", groups)


def write_motion(surface, shot, scene, directory):
    """Caches of the handles, and the pose of the first frame. Whether that is another one than at rest."""
    frames = range(scene.frame_start, scene.frame_end + 1 if "follow" in shot.held else scene.frame_start + 1)
    places = surface.motion(scene, frames)
    start, size = places[0], min(np.linalg.norm(np.ptp(shot.rest_of(part), axis=0)) for part in shot.parts)
    is_posed = bool(np.abs(start - shot.rest).max() > STILL * size)
    if is_posed:
        write_obj(directory / "start.obj", start, surface.faces())
        if "pin" in shot.held:
            write_mdd(directory / "pin.mdd", start[None], [0.])
    if "follow" in shot.held:
        write_mdd(directory / "rig.mdd", places, np.arange(len(places)) / frames_per_second(scene))
    return is_posed


def write_surface(surface, directory):
    """The body and its examples: the names of these, and the parts."""
    faces, examples = surface.faces(), [examples_of(own) for own in surface.surfaces]
    write_obj(directory / "body.obj", surface.rest, faces)
    poses = surface.shapes(examples)
    for i, shape in enumerate(poses.values(), 1):
        write_obj(directory / f"pose_{i}.obj", shape, faces)
    return list(poses), [Part(own.shown.name, own.shown.exemplar.token, own.faces(), matrix, list(keys), span)
                         for own, matrix, keys, span in zip(surface.surfaces, surface.matrices, examples, surface.spans())]


def make_shot(surface, bodies, scene, directory):
    """What is known of a run before its motion; writes the bodies and what they wear."""
    body, settings = bodies[0], bodies[0].exemplar
    poses, parts = write_surface(surface, directory)
    return Shot(directory / "scene.prm", parts, surface.rest, poses,
                held=[name for name in ("follow", "pin") if any(getattr(shown.exemplar, name) for shown in bodies)],
                painted=[name for name in painted_of(settings) if any(name in shown.vertex_groups for shown in bodies)],
                worn=[] if is_shell(settings) else write_worn(bodies, directory),
                regions=regions_of(bodies) if settings.regions == "PAINTED" and poses else [],
                n_frames=scene.frame_end - scene.frame_start, steps=settings.steps, tension=tension_of(body, scene),
                has_muscle=MUSCLE in body.vertex_groups or len(bodies) > 1, unit=unit_scale(scene), cells=settings.cells)


def write_scene(bodies, scene, directory):
    """Write all that a run reads into a directory, which is made; the shot. The first body's settings are those of the scene."""
    check(bodies, scene)
    directory.mkdir(parents=True, exist_ok=True)
    shown = scene.frame_current
    scene.frame_set(scene.frame_start)  # bodies begin where the objects are at the first frame
    surface = JoinedSurface(bodies, matrices_at_rest(bodies))
    try:
        shot = make_shot(surface, bodies, scene, directory)
        if len(bodies) > 1:
            check_places(shot, bodies[0].exemplar)
        scene.frame_set(scene.frame_start)
        found = obstacles_of(bodies, scene)
        obstacles = {f"obstacle {i}": write_obstacle(obstacle, i, scene, directory) for i, obstacle in enumerate(found, 1)}
        shot.obstacles = [obstacle.name for obstacle in found]
        scene.frame_set(scene.frame_start)
        if bodies[0].exemplar.weights == "KEYED":
            shot.weights = keyed_weights(bodies, shot.poses, scene)
            write_weights(directory / "weights.csv", shot, frames_per_second(scene))
            scene.frame_set(scene.frame_start)
        write_tables(surface, bodies[0].exemplar, shot, directory)
        is_posed = write_motion(surface, shot, scene, directory)
        shot.notes = notes_of(bodies, scene, shot, is_posed)
    finally:
        surface.free()
        scene.frame_set(shown)
    shot.file.write_text(scene_text(bodies[0], scene, shot, is_posed, obstacles), encoding="utf-8")
    return shot
