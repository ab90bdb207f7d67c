# SPDX-License-Identifier: GPL-3.0-or-later
"""The surface of an object as the program gets it: vertices at rest and in the shape keys, and where the object's motion takes them.

A stack of modifiers is parted in two: the simulation stands for the first part, which moves the object, and the result keeps the rest.
"""
from contextlib import contextmanager

import bpy
import numpy as np
from mathutils import Vector
from mathutils.bvhtree import BVHTree

from .exemplar_blender import Failure

# Modifiers by which a rig or an animation moves vertices.
MOVING = {"ARMATURE", "CAST", "CLOTH", "CURVE", "HOOK", "LAPLACIANDEFORM", "LATTICE", "MESH_CACHE", "MESH_DEFORM", "MESH_SEQUENCE_CACHE",
          "SIMPLE_DEFORM", "SOFT_BODY", "SURFACE_DEFORM", "WARP", "WAVE"}


def n_replaced(shown):
    """For so many of its first modifiers the simulation stands: up to the last one that moves it, or mirrors it, as half of a body is none."""
    last = [i for i, modifier in enumerate(shown.modifiers, 1) if modifier.show_viewport and modifier.type in MOVING | {"MIRROR"}]
    return last[-1] if last else 0


def coordinates(points):
    """Local coordinates (n, 3) of a collection of vertices or of points of a shape key."""
    numbers = np.empty(3 * len(points), dtype=np.float32)
    points.foreach_get("co", numbers)
    return numbers.reshape(-1, 3).astype(float)


def in_world(places, matrix):
    turn = np.array(matrix, dtype=float)
    return places @ turn[:3, :3].T + turn[:3, 3]


def in_object(places, matrix):
    """The inverse of in_world."""
    turn = np.linalg.inv(np.array(matrix, dtype=float))
    return places @ turn[:3, :3].T + turn[:3, 3]


def group_weights(shown, mesh, name):
    """Of each vertex of a mesh in a vertex group of its object; 0 where it is not in it."""
    group = shown.vertex_groups[name].index
    weights = np.zeros(len(mesh.vertices))
    for vertex in mesh.vertices:
        for element in vertex.groups:
            if element.group == group:
                weights[vertex.index] = element.weight
    return weights


def key_shapes(shown):
    """{name: local places} of the shape keys, each as it is seen alone and in full, without the one at rest."""
    keys = shown.data.shape_keys
    if not keys:
        return {}
    rest, shapes = coordinates(keys.reference_key.data), {}
    for key in keys.key_blocks:
        if key == keys.reference_key:
            continue
        shape = coordinates(key.data)
        if keys.use_relative:
            change = shape - coordinates(key.relative_key.data)
            if key.vertex_group in shown.vertex_groups:
                change *= group_weights(shown, shown.data, key.vertex_group)[:, None]
            shape = rest + change
        shapes[key.name] = shape
    return shapes


@contextmanager
def only_modifiers(shown, names):
    """Of the modifiers that are on, only these, inside of it."""
    before = [modifier.show_viewport for modifier in shown.modifiers]
    try:
        for modifier in shown.modifiers:
            if modifier.name not in names:
                modifier.show_viewport = False
        yield
    finally:
        for modifier, was_on in zip(shown.modifiers, before):
            modifier.show_viewport = was_on


@contextmanager
def evaluated_mesh(shown):
    evaluated = shown.evaluated_get(bpy.context.evaluated_depsgraph_get())
    try:
        yield evaluated.to_mesh()
    finally:
        evaluated.to_mesh_clear()


class Surface:
    """Local places at rest (n, 3) and {name: those of a shape key}; the mesh that has these vertices, of the object or, where modifiers
    that the simulation replaces add vertices, made for it (`is_made`; who makes the surface frees it)."""

    def __init__(self, shown):
        self.shown = shown
        self.replaced = [modifier.name for modifier in shown.modifiers[:n_replaced(shown)]]
        self.mesh, self.is_made = shown.data, False
        keys = shown.data.shape_keys
        self.rest = coordinates(keys.reference_key.data if keys else shown.data.vertices)
        self.shapes = key_shapes(shown)
        if self.replaced and self._n_evaluated() != len(self.rest):
            self._apply()

    def free(self):
        if self.is_made and self.mesh.users == 0:
            bpy.data.meshes.remove(self.mesh)

    def faces(self):
        """As they are turned in the world: a mirrored object turns them over."""
        turn = -1 if self.shown.matrix_world.determinant() < 0 else 1
        return [tuple(face.vertices)[::turn] for face in self.mesh.polygons]

    def group_weights(self, name):
        return group_weights(self.shown, self.mesh, name)

    def motion(self, scene, frames):
        """Where in the world what the simulation replaces, and shape keys, take the vertices in frames of a scene: (frames, n, 3)."""
        places = []
        with only_modifiers(self.shown, self.replaced):
            for frame in frames:
                scene.frame_set(frame)
                places.append(in_world(self._moved(frame), self.shown.matrix_world))
        return np.array(places)

    def _moved(self, frame):
        with evaluated_mesh(self.shown) as mesh:
            if len(mesh.vertices) != len(self.rest):
                raise Failure(f"{', '.join(self.replaced)} of {self.shown.name} make {len(mesh.vertices)} vertices in frame {frame} and "
                              f"{len(self.rest)} at rest. Let Mirror not merge, or apply the modifiers that come before the armature.")
            return coordinates(mesh.vertices)

    def _n_evaluated(self):
        with only_modifiers(self.shown, self.replaced), evaluated_mesh(self.shown) as mesh:
            return len(mesh.vertices)

    def _apply(self):
        """Of the replaced modifiers apply those that do not move the object, to rest and shape keys."""
        stand_in = self.shown.copy()
        stand_in.data = own = self.shown.data.copy()
        bpy.context.scene.collection.objects.link(stand_in)
        try:
            if own.shape_keys:
                keys = own.shape_keys
                stand_in.shape_key_clear()
                bpy.data.batch_remove([keys])  # which Blender forgets to do, and tells of when the .blend is saved
            for modifier in list(stand_in.modifiers):
                if modifier.name not in self.replaced or modifier.type in MOVING:
                    stand_in.modifiers.remove(modifier)
            mesh, rest = self._through(stand_in, self.rest)
            shapes = {}
            for name, shape in self.shapes.items():
                shapes[name] = self._through(stand_in, shape, mesh)[1]
                if len(shapes[name]) != len(rest):
                    raise Failure(f"{', '.join(m.name for m in stand_in.modifiers)} of {self.shown.name} make {len(shapes[name])} vertices in "
                                  f"the shape key {name} and {len(rest)} at rest. Let Mirror not merge, or apply them.")
            self.mesh, self.is_made, self.rest, self.shapes = mesh, True, rest, shapes
        finally:
            bpy.data.objects.remove(stand_in)
            bpy.data.meshes.remove(own)

    @staticmethod
    def _through(stand_in, shape, mesh=None):
        """A mesh, unless there is one, and places behind the modifiers of an object whose vertices are put here."""
        stand_in.data.vertices.foreach_set("co", shape.astype(np.float32).ravel())
        stand_in.data.update()
        with evaluated_mesh(stand_in) as evaluated:
            places = coordinates(evaluated.vertices)
        if mesh is None:
            depsgraph = bpy.context.evaluated_depsgraph_get()
            mesh = bpy.data.meshes.new_from_object(stand_in.evaluated_get(depsgraph), preserve_all_data_layers=True, depsgraph=depsgraph)
        return mesh, places


class JoinedSurface:
    """Surfaces of several objects as one, in world coordinates, one object behind the other. `matrices`: the place of each object at rest. Who
    makes it frees it."""

    def __init__(self, objects, matrices):
        self.surfaces, self.matrices = [], matrices
        try:
            for shown in objects:
                self.surfaces.append(Surface(shown))
        except Failure:
            self.free()
            raise
        self.rest = self._joined([surface.rest for surface in self.surfaces])

    def free(self):
        for surface in self.surfaces:
            surface.free()

    def spans(self):
        """The range of vertices of each object."""
        ends = np.cumsum([len(surface.rest) for surface in self.surfaces])
        return [range(int(end) - len(surface.rest), int(end)) for surface, end in zip(self.surfaces, ends)]

    def faces(self):
        return joined_faces([surface.faces() for surface in self.surfaces], self.spans())

    def shapes(self, chosen):
        """{name: places} of shape keys, of which each object has chosen {name: local places}. What has no key of a name is at rest in it."""
        names = dict.fromkeys(name for own in chosen for name in own)
        return {name: self._joined([own.get(name, surface.rest) for surface, own in zip(self.surfaces, chosen)]) for name in names}

    def group_weights(self, names, absent=0.):
        """In the vertex group that `names` has for each object; `absent` where an object has no such group."""
        return np.concatenate([surface.group_weights(name) if name in surface.shown.vertex_groups else np.full(len(surface.rest), absent)
                               for surface, name in zip(self.surfaces, names)])

    def motion(self, scene, frames):
        return np.concatenate([surface.motion(scene, frames) for surface in self.surfaces], axis=1)

    def _joined(self, local):
        return np.concatenate([in_world(places, matrix) for places, matrix in zip(local, self.matrices)])


def joined_faces(faces, spans):
    """Faces of several objects, by the numbers that their vertices have in one surface."""
    return [tuple(vertex + span.start for vertex in face) for own, span in zip(faces, spans) for face in own]


def volume(places, faces):
    """Of what faces enclose."""
    triangles = places[[(face[0], *face[i:i + 2]) for face in faces for i in range(1, len(face) - 1)]]
    return abs(np.einsum("ti,ti->", triangles[:, 0], np.cross(triangles[:, 1], triangles[:, 2]))) / 6.


def lie_inside(places, others, faces):
    """Whether places lie in what faces of others enclose: rays from them cross it an odd number of times, but for a few that graze an edge."""
    if np.any(places.min(axis=0) < others.min(axis=0)) or np.any(places.max(axis=0) > others.max(axis=0)):
        return False
    tree, step = BVHTree.FromPolygons(others.tolist(), faces), 1e-5 * float(np.linalg.norm(np.ptp(others, axis=0)))
    return sum(n_crossings(tree, Vector(place), step) % 2 for place in places.tolist()) > .99 * len(places)


def n_crossings(tree, place, step):
    """Of a surface and a ray from a place in a direction that is no axis."""
    direction, n = Vector((.48, .36, .8)), 0
    while True:
        hit = tree.ray_cast(place, direction)[0]
        if hit is None:
            return n
        place, n = hit + step * direction, n + 1


def seen_motion(shown, scene, frames):
    """Faces of an object behind all of its modifiers, and where its vertices are in the world in frames of a scene: (frames, n, 3)."""
    places, faces = [], []
    for frame in frames:
        scene.frame_set(frame)
        matrix = shown.evaluated_get(bpy.context.evaluated_depsgraph_get()).matrix_world
        with evaluated_mesh(shown) as mesh:
            if places and len(mesh.vertices) != len(places[0]):
                raise Failure(f"{shown.name} has {len(places[0])} vertices in frame {frames[0]} and {len(mesh.vertices)} in frame {frame}. "
                              "What has Collision physics keeps its vertices: switch off the modifier that changes their number.")
            turn = -1 if matrix.determinant() < 0 else 1
            faces = faces or [tuple(face.vertices)[::turn] for face in mesh.polygons]
            places.append(in_world(coordinates(mesh.vertices), matrix))
    return faces, np.array(places)


def rigs_of(body):
    """Armatures that move a body: of its modifiers and among its parents."""
    rigs = [modifier.object for modifier in body.modifiers if modifier.type == "ARMATURE" and modifier.object]
    parent = body.parent
    while parent:
        rigs += [parent] if parent.type == "ARMATURE" else []
        parent = parent.parent
    return list(dict.fromkeys(rigs))


def worn_by(body):
    """Meshes that are seen and children of the body, of its armatures or of their bones."""
    rigs = rigs_of(body)
    tools = {bone.custom_shape for rig in rigs for bone in rig.pose.bones}
    tools |= {getattr(modifier, "object", None) or getattr(modifier, "target", None) for modifier in body.modifiers}
    children = dict.fromkeys([*body.children_recursive, *(child for rig in rigs for child in rig.children_recursive)])
    return [child for child in children if child != body and child.type == "MESH" and child.data.polygons and child not in tools
            and not is_above(child, body) and child.visible_get()]


def is_above(thing, body):
    while body is not None and body != thing:
        body = body.parent
    return body is not None


def all_worn_by(bodies):
    """[(mesh, number of the body that wears it)]: no mesh is worn twice, and no body is worn."""
    worn = {}
    for number, body in enumerate(bodies):
        for child in worn_by(body):
            if child not in bodies:
                worn.setdefault(child, number)
    return list(worn.items())


def matrices_at_rest(bodies):
    """Of each body in this frame. What a bone of the first one carries is where it belongs on that one at rest."""
    first, *others = bodies
    matrices = [first.matrix_world.copy()]
    with at_rest(first):
        matrices += [body.matrix_world.copy() for body in others]
    return [[list(row) for row in matrix] for matrix in matrices]


@contextmanager
def at_rest(body):
    """Body and armatures are at rest inside of it, so that children of bones are where they belong on a body at rest."""
    rigs = rigs_of(body)
    armatures = [(rig.data, rig.data.pose_position) for rig in rigs]
    alone, active = body.show_only_shape_key, body.active_shape_key_index
    try:
        for armature, _ in armatures:
            armature.pose_position = "REST"
        body.show_only_shape_key, body.active_shape_key_index = True, 0
        bpy.context.view_layer.update()
        yield
    finally:
        for armature, position in armatures:
            armature.pose_position = position
        body.show_only_shape_key, body.active_shape_key_index = alone, active
        bpy.context.view_layer.update()
