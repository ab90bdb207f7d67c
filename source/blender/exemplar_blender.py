# SPDX-License-Identifier: GPL-3.0-or-later
"""Brings a run of exemplar into Blender (3.4 or later): the surface with the poses as shape keys, their values keyed
from the run's weights, and what the weights miss as a point cache that is added to them.

    blender --python exemplar_blender.py -- OUTPUT_DIRECTORY [--shape weight_1=crouch.obj]... [--up y|z]
            [--start FRAME] [--save FILE.blend]

OUTPUT_DIRECTORY is that of a run with Output/Formats = pc2 or mdd. Sum of rest, weighted shape keys and residual is the
simulated surface; the modifier "exemplar residual" may be hidden, or its input Residual turned down. With --shape a
shape of the artist's own, of the same vertex order, takes the place of the run's; the residual is then what that one
misses. See doc/surfaces.md.
"""
import argparse
import csv
import re
import struct
import sys
from pathlib import Path

import bpy
import numpy as np

RESIDUAL = "exemplar residual"


class Failure(Exception):
    """Something about the input that the user can change."""


# Files that a run has written


def read_obj(path):
    """Vertices (n, 3); faces; for each corner its point of texture, or none; for each face its material's name."""
    vertices, texture, faces, corners, materials, material = [], [], [], [], [], None
    with open(path, encoding="utf-8", errors="surrogateescape") as file:
        for line in file:
            words = line.split()
            if not words:
                continue
            if words[0] == "v":
                vertices.append([float(word) for word in words[1:4]])
            elif words[0] == "vt":
                texture.append([float(word) for word in (words[1:3] + ["0"])[:2]])
            elif words[0] == "usemtl":
                material = " ".join(words[1:])
            elif words[0] == "f":
                indices = [word.split("/") for word in words[1:]]
                faces.append([_index(i[0], vertices) for i in indices])
                materials.append(material)
                has_texture = all(len(i) > 1 and i[1] for i in indices)
                corners += [texture[_index(i[1], texture)] if has_texture else None for i in indices]
    return np.array(vertices), faces, corners, materials


def _index(word, things):
    index = int(word)
    return index - 1 if index > 0 else len(things) + index


def read_pc2(path):
    """Places (frames, vertices, 3)."""
    data = path.read_bytes()
    if data[:12] != b"POINTCACHE2\0":
        raise Failure(f"{path} is no PC2 file.")
    _, n_points, _, _, n_frames = struct.unpack("<iiffi", data[12:32])
    return np.frombuffer(data, "<f4", offset=32).reshape(n_frames, n_points, 3).astype(float)


def read_mdd(path):
    data = path.read_bytes()
    n_frames, n_points = struct.unpack(">ii", data[:8])
    return np.frombuffer(data, ">f4", offset=8 + 4 * n_frames).reshape(n_frames, n_points, 3).astype(float)


def write_pc2(path, places):
    n_frames, n_points, _ = places.shape
    head = b"POINTCACHE2\0" + struct.pack("<iiffi", 1, n_points, 0., 1., n_frames)
    Path(path).write_bytes(head + places.astype("<f4").tobytes())


class Run:
    """What a run has left in its output directory; with a range of vertices only this part of its surface, without textures and materials."""

    def __init__(self, directory, vertices=None):
        self.directory = Path(directory).resolve()
        if not (self.directory / "parameters.prm").exists():
            raise Failure(f"{directory} is not the output directory of a run of exemplar.")
        self.parameters = (self.directory / "parameters.prm").read_text()
        self.extension, self.places = self._read_animation()
        self.rest, self.faces, self.corners, self.materials = read_obj(self.directory / "rest.obj")
        self.rows = self._rows_of_frames()
        self.vertices = vertices or range(len(self.rest))
        if vertices is not None:
            self._take(vertices)

    def _take(self, vertices):
        """Of places and faces keep those of a part."""
        self.places, self.rest = self.places[:, vertices.start:vertices.stop], self.rest[vertices.start:vertices.stop]
        self.faces = [[vertex - vertices.start for vertex in face] for face in self.faces if face[0] in vertices]
        self.corners, self.materials = [], []

    def read_shape(self, name):
        """Places of an example, weight_1 and so on, as the run shows it."""
        return read_obj(self.directory / f"{name}.obj")[0][self.vertices.start:self.vertices.stop]

    def _read_animation(self):
        for extension, read in (("pc2", read_pc2), ("mdd", read_mdd)):
            file = self.directory / f"animation.{extension}"
            if file.exists():
                return extension, read(file)
        raise Failure(f"{self.directory} has no animation.pc2 or animation.mdd. Run the scene with Output/Formats = pc2.")

    def _rows_of_frames(self):
        """The rows of statistics.csv that have a frame."""
        with open(self.directory / "statistics.csv", newline="") as file:
            rows = {int(row["step"]): row for row in csv.DictReader(file)}
        names = [re.fullmatch(rf"frame_(\d+)\.{self.extension}", file.name) for file in self.directory.iterdir()]
        steps = sorted(int(name[1]) for name in names if name)
        if len(steps) != len(self.places):  # frame files were deleted: frames are of every so many steps, and of the last
            every = int(self.parameter("Every") or 1)
            steps = sorted({step for step in rows if step % every == 0} | {max(rows)})
            if len(steps) > len(self.places):
                steps = steps[:len(self.places)]
        if len(steps) != len(self.places) or any(step not in rows for step in steps):
            raise Failure(f"animation.{self.extension} of {self.directory} has {len(self.places)} frames, which do not "
                          "agree with statistics.csv. Run the scene anew.")
        return [rows[step] for step in steps]

    def parameter(self, key):
        found = re.search(rf"^\s*set {key}\s*=[ \t]*(.*)$", self.parameters, re.MULTILINE)
        return found[1].strip() if found else None

    def weights(self):
        """{name: a value a frame} of the weights."""
        names = [name for name in self.rows[0] if re.fullmatch(r"weight_[0-9_]+", name)]
        return {name: np.array([float(row[name] or 0) for row in self.rows]) for name in names}

    def frames_per_second(self):
        times = [float(row["time"]) for row in self.rows]
        if self.parameter("Scene") != "dynamic" or len(times) < 2:
            return None
        return 1. / (times[1] - times[0])

    def z_is_up(self):
        gravity = [float(word) for word in (self.parameter("Gravity") or "0, 0, 0").split(",")]
        return abs(gravity[2]) > abs(gravity[1])


# Objects made in Blender


def make_object(name, run):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([tuple(vertex) for vertex in run.rest], [], run.faces)
    if run.corners and all(corner is not None for corner in run.corners):
        layer = mesh.uv_layers.new(name="UVMap")
        layer.data.foreach_set("uv", np.array(run.corners, dtype=np.float32).ravel())
    slots = list(dict.fromkeys(material for material in run.materials if material))
    for slot in slots:
        mesh.materials.append(bpy.data.materials.get(slot) or bpy.data.materials.new(slot))
    if slots:
        mesh.polygons.foreach_set("material_index", [slots.index(m) if m else 0 for m in run.materials])
    mesh.update()
    shown = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(shown)
    return shown


def read_shapes(run, own):
    """{weight's name: (name of the key, places)} of the poses; those that are the rest surface are left out."""
    shapes = {}
    for name in run.weights():
        file = Path(own[name]) if name in own else run.directory / f"{name}.obj"
        places = read_obj(file)[0] if name in own else run.read_shape(name)
        if places.shape != run.rest.shape:
            raise Failure(f"{file} has {len(places)} vertices, but the surface of the run has {len(run.rest)}. A shape "
                          "needs the same vertices in the same order.")
        if not np.array_equal(places, run.rest):
            shapes[name] = (file.stem, places)
    unknown = set(own) - set(run.weights())
    if unknown:
        raise Failure(f"--shape: the run has no {', '.join(sorted(unknown))}; it has {', '.join(run.weights()) or 'none'}.")
    return shapes


def add_shape_keys(shown, shapes, rest="rest"):
    """A shape key a pose, {weight's name: (name of the key, places)}, behind one at rest; the names that the keys got, by weights."""
    if not shapes:
        return {}
    shown.shape_key_add(name=rest, from_mix=False)
    names = {}
    for weight, (name, places) in shapes.items():
        key = shown.shape_key_add(name=name, from_mix=False)
        key.data.foreach_set("co", places.astype(np.float32).ravel())
        names[weight] = key.name
    return names


def animate_keys(shown, values, start):
    """Keyframes of shape keys, {name: a value a frame}, from the frame `start` on."""
    keys = shown.data.shape_keys
    keys.animation_data_create().action = bpy.data.actions.new(f"{shown.name} weights")
    for name, of_frames in values.items():
        key = keys.key_blocks[name]
        key.slider_min = max(-10., min(0., of_frames.min()))
        key.slider_max = min(10., max(1., of_frames.max()))
        curve = new_curve(keys, f'key_blocks["{bpy.utils.escape_identifier(name)}"].value')
        curve.keyframe_points.add(len(of_frames))
        frames = np.arange(start, start + len(of_frames))
        curve.keyframe_points.foreach_set("co", np.column_stack([frames, of_frames]).ravel().astype(np.float32))
        for point in curve.keyframe_points:
            point.interpolation = "LINEAR"
        curve.update()


def new_curve(keys, path):
    action = keys.animation_data.action
    if hasattr(action, "fcurve_ensure_for_datablock"):  # 5.0 has curves in layers alone
        return action.fcurve_ensure_for_datablock(keys, path)
    return action.fcurves.new(path)


def residual_of(places, rest, shapes, values):
    """What rest (n, 3) and weighted shapes {name: (n, 3)} miss of places (frames, n, 3), by the single precision that Blender has."""
    rest = rest.astype(np.float32).astype(float)
    residual = places - rest
    for name, shape in shapes.items():
        change = shape.astype(np.float32).astype(float) - rest
        residual -= values[name].astype(np.float32).astype(float)[:, None, None] * change
    return residual


def relative(file):
    """The path of a file from the .blend on, which may move with it; as it is, without a .blend."""
    try:
        return bpy.path.relpath(str(file)) if bpy.data.filepath else str(file)
    except ValueError:  # on another drive
        return str(file)


def new_modifier(shown, name, kind, index=None):
    """A modifier at a place in the stack, else the last one."""
    modifier = shown.modifiers.new(name, kind)
    if index is not None and index < len(shown.modifiers) - 1:
        with bpy.context.temp_override(object=shown, active_object=shown):
            bpy.ops.object.modifier_move_to_index(modifier=modifier.name, index=index)
    return modifier


def play_cache(shown, name, file, start, index=None):
    """A modifier, at a place in the stack, that puts the vertices where a .pc2 file has them, from the frame `start` on."""
    cache = new_modifier(shown, name, "MESH_CACHE", index)
    cache.cache_format, cache.filepath, cache.frame_start, cache.interpolation = "PC2", relative(file), start, "LINEAR"
    return cache


def add_residual(shown, rest, residual, start, file, index=None):
    """Hidden points play the residual (frames, n, 3) from a point cache; a modifier, at a place in the stack, adds it to the keys' sum. The
    points, and the modifier that plays."""
    rest = rest.astype(np.float32)
    write_pc2(file, rest + residual)
    name = f"{shown.name} residual"
    player = bpy.data.objects.new(name, bpy.data.meshes.new(name))
    player.data.from_pydata(rest.tolist(), [], [])
    attribute = player.data.attributes.new("rest", "FLOAT_VECTOR", "POINT")
    attribute.data.foreach_set("vector", rest.ravel())
    bpy.context.scene.collection.objects.link(player)
    cache = play_cache(player, "residual", file, start)
    player.hide_render = True
    player.hide_set(True)
    player.parent = shown
    modifier = new_modifier(shown, RESIDUAL, "NODES", index)
    modifier.node_group = residual_nodes(player)
    return player, cache


def residual_nodes(player):
    """Nodes: position + Residual (position of the player - its attribute "rest"), vertex by vertex."""
    tree = bpy.data.node_groups.new(RESIDUAL, "GeometryNodeTree")
    if hasattr(tree, "interface"):  # since 4.0
        tree.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
        factor = tree.interface.new_socket("Residual", in_out="INPUT", socket_type="NodeSocketFloat")
        tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    else:
        tree.inputs.new("NodeSocketGeometry", "Geometry")
        factor = tree.inputs.new("NodeSocketFloat", "Residual")
        tree.outputs.new("NodeSocketGeometry", "Geometry")
    factor.default_value, factor.min_value, factor.max_value = 1., 0., 1.

    def node(kind, **settings):
        made = tree.nodes.new(kind)
        for name, value in settings.items():
            setattr(made, name, value)
        return made

    def socket(sockets, name):
        return next(s for s in sockets if s.name == name and s.enabled)

    def link(source, target):
        tree.links.new(source, target)

    inputs, outputs = node("NodeGroupInput"), node("NodeGroupOutput")
    info = node("GeometryNodeObjectInfo")
    info.inputs["Object"].default_value = player
    rest = node("GeometryNodeInputNamedAttribute", data_type="FLOAT_VECTOR")
    rest.inputs["Name"].default_value = "rest"
    difference = node("ShaderNodeVectorMath", operation="SUBTRACT")
    link(node("GeometryNodeInputPosition").outputs[0], difference.inputs[0])
    link(socket(rest.outputs, "Attribute"), difference.inputs[1])
    sample = node("GeometryNodeSampleIndex", data_type="FLOAT_VECTOR", domain="POINT")
    link(info.outputs["Geometry"], sample.inputs["Geometry"])
    link(difference.outputs[0], socket(sample.inputs, "Value"))
    link(node("GeometryNodeInputIndex").outputs[0], sample.inputs["Index"])
    scaled = node("ShaderNodeVectorMath", operation="SCALE")
    link(socket(sample.outputs, "Value"), scaled.inputs[0])
    link(inputs.outputs["Residual"], scaled.inputs["Scale"])
    moved = node("GeometryNodeSetPosition")
    link(inputs.outputs["Geometry"], moved.inputs["Geometry"])
    link(scaled.outputs[0], moved.inputs["Offset"])
    link(moved.outputs["Geometry"], outputs.inputs["Geometry"])
    return tree


def set_playback(run, start):
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = start, start + len(run.places) - 1
    rate = run.frames_per_second()
    if rate is not None:
        scene.render.fps = max(1, round(rate))
        scene.render.fps_base = scene.render.fps / rate
    scene.frame_set(start)


def load_run(directory, shapes=None, up=None, start=1, save=None, playback=True, vertices=None):
    """Load a run; the object. `shapes` are {weight's name: file} of the artist's own. With `playback` the scene gets the frames and
    the frame rate of the run. A range of vertices is the part of the surface that is shown."""
    run = Run(directory, vertices)
    found = read_shapes(run, shapes or {})
    shown = make_object(run.directory.name, run)
    shapes = {weight: places for weight, (_, places) in found.items()}
    names = add_shape_keys(shown, found)
    if names:
        animate_keys(shown, {name: run.weights()[weight] for weight, name in names.items()}, start)
    part = f"_from_{vertices.start + 1}" if vertices is not None and vertices.start > 0 else ""
    file = run.directory / (f"{Path(save).stem}_residual{part}.pc2" if save else f"residual{part}.pc2")
    _, cache = add_residual(shown, run.rest, residual_of(run.places, run.rest, shapes, run.weights()), start, file)
    if not (run.z_is_up() if up is None else up == "z"):
        shown.rotation_euler[0] = np.pi / 2
    if playback:
        set_playback(run, start)
    if save:
        bpy.ops.wm.save_as_mainfile(filepath=str(Path(save).resolve()))
        cache.filepath = relative(file)
        bpy.ops.wm.save_mainfile()
    return shown


def main(arguments):
    parser = argparse.ArgumentParser(prog="exemplar_blender.py", description=__doc__.split("\n\n")[0])
    parser.add_argument("directory", help="output directory of the run")
    parser.add_argument("--shape", action="append", default=[], metavar="WEIGHT=FILE.obj",
                        help="a shape of your own for a weight of statistics.csv")
    parser.add_argument("--up", choices=["y", "z"], help="axis that points up in the run; else gravity decides, or y")
    parser.add_argument("--start", type=int, default=1, help="frame of Blender that shows the first frame")
    parser.add_argument("--save", metavar="FILE.blend", help="save what was made")
    options = parser.parse_args(arguments)
    shapes = dict(shape.split("=", 1) for shape in options.shape if "=" in shape)
    if len(shapes) != len(options.shape):
        parser.error("--shape takes WEIGHT=FILE.obj, each weight once")
    if bpy.app.background and not bpy.data.filepath:
        bpy.ops.wm.read_homefile(use_empty=True)  # without the cube that a new file has
    shown = load_run(options.directory, shapes, options.up, options.start, options.save)
    keys = shown.data.shape_keys
    print(f"{shown.name}: {len(shown.data.vertices)} vertices, {bpy.context.scene.frame_end - options.start + 1} frames, "
          f"{len(keys.key_blocks) - 1 if keys else 0} shape keys")


if __name__ == "__main__":
    try:
        main(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else [])
    except Failure as failure:
        sys.exit(f"exemplar_blender.py: {failure}")
