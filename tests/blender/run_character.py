# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on with characters as artists have them: what came of a case, as JSON.

    blender --background --python run_character.py -- ADDON.zip PROGRAM DIRECTORY RESULT.json CASE

CASE is a function of this file without its `case_`.
"""
import json
import math
import shutil
import sys
import time
from pathlib import Path

import bpy
import numpy as np
from mathutils.bvhtree import BVHTree

sys.path.append(str(Path(__file__).parent))
from addon_scenes import add_group, add_key, bar, bent, install, make_object, make_rig, places, wait  # noqa: E402

addon, program, directory, result, case = sys.argv[sys.argv.index("--") + 1:][:5]
directory = Path(directory)
exemplar = install(addon, program)
scene = bpy.context.scene


def make_body(scale=1.):
    """A bar with texture, two materials, smooth faces, keys of all kinds and groups."""
    vertices, faces = bar()
    body = make_object("bar", [[scale * c for c in x] for x in vertices], faces)
    mesh = body.data
    layer = mesh.uv_layers.new(name="skin")
    for loop in mesh.loops:
        x = vertices[loop.vertex_index]
        layer.data[loop.index].uv = (x[0] + .1 * x[1], x[2] / 4)
    for name in ("fur", "nails"):
        mesh.materials.append(bpy.data.materials.new(name))
    mesh.polygons.foreach_set("material_index", [i % 2 for i in range(len(faces))])
    mesh.polygons.foreach_set("use_smooth", [True] * len(faces))
    body.shape_key_add(name="Basis")
    add_key(body, "bent", [[scale * c for c in bent(*x)] for x in vertices])
    add_group(body, "feet", lambda x, y, z: z == 0)
    add_group(body, "head", lambda x, y, z: z == scale * 4)
    for name in ("low", "high"):  # of the bones
        group = body.vertex_groups.new(name=name)
        for i, x in enumerate(vertices):
            group.add([i], x[2] / 4 if name == "high" else 1 - x[2] / 4, "REPLACE")
    body.location = (0., 0., scale)
    return body


def add_hard_keys(body):
    """A muted key, one that moves nothing, and one relative to another that acts in a group only."""
    x = np.array([tuple(vertex.co) for vertex in body.data.vertices])
    add_key(body, "put away", x + 1.).mute = True
    add_key(body, "nothing", x)
    twice = np.array([tuple(point.co) for point in body.data.shape_keys.key_blocks["bent"].data])
    twice[:, 0] += .3 * x[:, 2]
    key = add_key(body, "more", twice)
    key.relative_key = body.data.shape_keys.key_blocks["bent"]
    add_group(body, "upper half", lambda x, y, z: z > 2)
    key.vertex_group = "upper half"


def make_clothes(body, rig):
    """A collar that the armature moves, an eye on a bone, a bone's own shape, and what is hidden."""
    collar = make_object("collar", [(-.6, -.6, 5.1), (.6, -.6, 5.1), (.6, .6, 5.1), (-.6, .6, 5.1)], [(0, 1, 2, 3)])
    add_group(collar, "high", lambda x, y, z: True)
    collar.modifiers.new("rig", "ARMATURE").object = rig
    collar.modifiers.new("cloth", "SOLIDIFY").thickness = .1
    collar.parent = rig
    square = ([(-.1, 0., -.1), (.1, 0., -.1), (0., 0., .1)], [(0, 1, 2)])
    for name in ("eye", "tool", "hidden"):
        thing = make_object(name, *square)
        thing.parent, thing.parent_type, thing.parent_bone = rig, "BONE", "high"
        thing.location = (0., -1.2, .55)  # from the bone's tail, before the upper end
    bpy.data.objects["hidden"].hide_set(True)
    rig.pose.bones["high"].custom_shape = bpy.data.objects["tool"]


def begin(body, follow="head", pin="feet", **settings):
    """What Run has refused, or nothing."""
    body.exemplar.cells, body.exemplar.follow, body.exemplar.pin = 600, follow, pin
    for name, value in settings.items():
        setattr(body.exemplar, name, value)
    bpy.context.view_layer.objects.active = body
    bpy.ops.wm.save_as_mainfile(filepath=str(directory / "film.blend"))
    try:
        bpy.ops.exemplar.run()
    except RuntimeError as error:
        return str(error)
    return ""


def run(body, **settings):
    refused = begin(body, **settings)
    if refused:
        return refused
    wait(exemplar)
    return exemplar.Running.said


def modifiers_of(shown):
    return [[modifier.name, modifier.show_viewport, modifier.show_render] for modifier in shown.modifiers]


def what_it_has(shown):
    mesh = shown.data
    keys = mesh.shape_keys
    return {"uv": [list(point.uv) for point in mesh.uv_layers[0].data], "uv name": mesh.uv_layers[0].name,
            "materials": [material.name for material in mesh.materials], "material of": [face.material_index for face in mesh.polygons],
            "smooth": [face.use_smooth for face in mesh.polygons], "groups": [group.name for group in shown.vertex_groups],
            "group of": [sorted(element.group for element in vertex.groups) for vertex in mesh.vertices],
            "keys": [[key.name, key.mute] for key in keys.key_blocks] if keys else None}


def without_what_is_behind(shown, frames):
    """Places in frames without the modifiers behind the residual."""
    names = shown.modifiers.keys()
    for name in names[names.index("exemplar residual") + 1:]:
        shown.modifiers[name].show_viewport = False
    return [places(shown, frame) for frame in frames]


def run_places():
    """Of the run, in its frames."""
    return exemplar.exemplar_blender.read_pc2(exemplar.directory_of(bpy.data.objects["bar"]) / "output/animation.pc2").tolist()


def scene_file():
    return (exemplar.directory_of(bpy.data.objects["bar"]) / "scene.prm").read_text()


def case_character():
    body = make_body()
    add_hard_keys(body)
    rig = make_rig(body, begin=.5)
    rig.pose.bones["low"].location = (0., 0., .1)  # along y of the world
    body.modifiers.new("fine", "SUBSURF")
    body.parent = rig
    make_clothes(body, rig)
    make_object("prop of nobody", *bar()).location = (9., 0., 0.)
    hug = bpy.data.objects["collar"].modifiers.new("hug", "SHRINKWRAP")
    hug.target, hug.show_viewport = body, False
    body.modifiers["fine"].keyframe_insert("levels", frame=3)
    body.keyframe_insert("location", frame=3)
    found = {"before places": [list(body.matrix_world @ vertex.co) for vertex in body.data.vertices]}
    found.update(said=run(body), before=what_it_has(body), prm=scene_file())
    shown = bpy.data.objects["bar result"]
    found.update(after=what_it_has(shown), modifiers=modifiers_of(shown), hidden=[body.hide_get(), body.hide_render])
    found["values"] = {curve.data_path: curve.keyframe_points[-1].co[1] for curve in shown.data.shape_keys.animation_data.action.fcurves}
    found["fine"] = len(places(shown, 18))
    found["hug"] = bpy.data.objects["collar result"].modifiers["hug"].target.name
    found["curves"] = [curve.data_path for curve in shown.animation_data.action.fcurves]
    found["objects"] = sorted(item.name for item in bpy.data.objects)
    found["caches"] = [modifier.filepath for item in bpy.data.objects for modifier in item.modifiers if modifier.type == "MESH_CACHE"]
    for name in ("collar", "eye"):
        found[name] = modifiers_of(bpy.data.objects[f"{name} result"])
        found[f"{name} ends"] = places(bpy.data.objects[f"{name} result"], 18), places(bpy.data.objects[name], 18)
    found["run"], found["shown"] = run_places(), without_what_is_behind(shown, range(3, 19))
    body.modifiers["fine"].show_viewport = False
    exemplar.show_originals(body.exemplar.token)
    found["rig"] = [places(body, frame) for frame in (3, 18)]
    body.modifiers["rig"].show_viewport = False
    body.data.shape_keys.key_blocks["more"].value = 1.
    found["more"] = places(body, 3)
    body.data.shape_keys.key_blocks["more"].value = 0.
    found["pose 2"] = exemplar.exemplar_blender.read_obj(exemplar.directory_of(body) / "pose_2.obj")[0].tolist()

    # the folder goes elsewhere
    bpy.ops.wm.save_mainfile()
    (directory / "elsewhere").mkdir()
    for name in ("film.blend", "film_bar"):
        shutil.move(directory / name, directory / "elsewhere" / name)
    bpy.ops.wm.open_mainfile(filepath=str(directory / "elsewhere/film.blend"))
    found["moved folder"] = places(bpy.data.objects["bar result"], 18)
    return found


def case_half():
    """Of the bar there is half; Mirror makes the other one."""
    vertices, faces = bar()
    kept = [face for face in faces if all(vertices[i][0] >= 0 for i in face)]
    used = sorted({i for face in kept for i in face})
    body = make_object("bar", [vertices[i] for i in used], [[used.index(i) for i in face] for face in kept])
    body.data.materials.append(bpy.data.materials.new("fur"))
    body.data.uv_layers.new(name="skin")
    body.data.polygons.foreach_set("use_smooth", [True] * len(kept))
    body.shape_key_add(name="Basis")
    add_key(body, "thick", [(1.3 * x, y, z) for x, y, z in (vertices[i] for i in used)])
    for name, height in (("feet", 0), ("low", 0), ("head", 4), ("high", 4)):
        add_group(body, name, lambda x, y, z: z == height)
    body.location = (0., 0., 1.)
    body.modifiers.new("other side", "MIRROR")
    make_rig(body)
    body.modifiers.new("fine", "SUBSURF")
    found = {"said": run(body)}
    shown = bpy.data.objects["bar result"]
    found.update(after=what_it_has(shown), modifiers=modifiers_of(shown), vertices=len(shown.data.vertices))
    found["run"], found["shown"] = run_places(), without_what_is_behind(shown, range(3, 19))
    body.modifiers.remove(body.modifiers["rig"])
    found["stray keys"] = sum(keys.user is None for keys in bpy.data.shape_keys)
    found["without rig"] = [run(body, follow="", stiffness=2e6), len(bpy.data.objects["bar result"].data.vertices)]
    return found


def case_centimetres():
    found = {}
    for name, unit in (("metres", 1.), ("centimetres", .01)):
        scene.unit_settings.scale_length = unit
        body = make_body(1. / unit)
        make_rig(body, scale=1. / unit)
        found[f"{name} said"] = run(body, follow="", stiffness=1e6, balanced=False)
        found[name] = (unit * np.array(run_places()[-1])).tolist()
        found[f"{name} prm"] = scene_file()
        for item in list(bpy.data.objects):
            bpy.data.objects.remove(item)
    scene.gravity = (0., 0., -981.)
    found["gravity"] = exemplar.scene_files.gravity_of(scene).tolist()
    return found


def case_added():
    body = make_body()
    make_rig(body)
    found = {"said": run(body, weights="ADDITIVE"), "prm": scene_file()}
    shown = bpy.data.objects["bar result"]
    found["keys"] = [key.name for key in shown.data.shape_keys.key_blocks]
    found["run"], found["shown"] = run_places(), without_what_is_behind(shown, range(3, 19))
    return found


def case_keyed_weights():
    """Keys that add up to more than 1 for a while, one keyed and one driven by the other."""
    body = make_body()
    keys = body.data.shape_keys
    add_key(body, "twisted", [(x * math.cos(.2 * z) - y * math.sin(.2 * z), x * math.sin(.2 * z) + y * math.cos(.2 * z), z)
                              for x, y, z in bar()[0]])
    still = run(body, follow="", pin="feet", weights="KEYED", stiffness=1e6, steps=2)
    for frame, value in ((3, 0.), (11, .9), (18, .25)):
        keys.key_blocks["bent"].value = value
        keys.key_blocks["bent"].keyframe_insert("value", frame=frame)
    driver = keys.key_blocks["twisted"].driver_add("value").driver
    driver.type = "SCRIPTED"
    of = driver.variables.new()
    of.name, of.targets[0].id_type, of.targets[0].id, of.targets[0].data_path = "bent", "KEY", keys, 'key_blocks["bent"].value'
    driver.expression = "bent / 2"
    wanted = []
    for frame in range(3, 19):
        scene.frame_set(frame)
        wanted.append([keys.key_blocks[name].value for name in ("bent", "twisted")])
    found = {"still": still, "wanted": wanted, "painted": run(body, follow="", pin="feet", regions="AUTO")}
    found |= {"said": run(body, follow="", pin="feet", regions="NONE"), "prm": scene_file(), "values": []}
    shown = bpy.data.objects["bar result"].data.shape_keys
    for frame in range(3, 19):
        scene.frame_set(frame)
        found["values"].append([shown.key_blocks[name].value for name in ("bent", "twisted")])
    found |= {"shown": [places(bpy.data.objects["bar result"], frame) for frame in range(3, 19)], "run": run_places()}
    return found


def case_regions():
    body = make_body()
    for name, chosen in (("exemplar region top", lambda x, y, z: z > 2), ("exemplar region foot", lambda x, y, z: z < 1)):
        add_group(body, name, chosen)
    make_rig(body)
    body.data.shape_keys.key_blocks["bent"].value = .1  # as the artist left it
    found = {"said": run(body, regions="PAINTED", weights="FREE", damping=1., inner_damping=.01, steps=2), "prm": scene_file()}
    shown = bpy.data.objects["bar result"]
    found["keys"] = [key.name for key in shown.data.shape_keys.key_blocks]
    found["run"], found["shown"] = run_places(), without_what_is_behind(shown, range(3, 19))
    return found


def case_obstacles():
    """A body that nothing holds falls on a floor of one face, which Subdivision makes many of, and which rises; a wall is hidden."""
    body = make_body()
    floor = make_object("floor", [(-5., -5., .7), (5., -5., .7), (5., 5., .7), (-5., 5., .7)], [(0, 1, 2, 3)])
    floor.modifiers.new("fine", "SUBSURF").subdivision_type = "SIMPLE"
    floor.modifiers.new("touch", "COLLISION")
    floor.collision.friction_factor = .25
    for frame, height in ((3, 0.), (18, .2)):
        floor.location = (0., 0., height)
        floor.keyframe_insert("location", frame=frame)
    wall = make_object("wall", [(2., -5., 0.), (2., 5., 0.), (2., 0., 5.)], [(0, 1, 2)])
    wall.modifiers.new("touch", "COLLISION")
    wall.hide_set(True)
    found = {"said": run(body, follow="", pin="", stiffness=1e6), "prm": scene_file()}
    found["least"] = [min(x[2] for x in frame) for frame in run_places()]
    floor.modifiers.new("grow", "BUILD").frame_duration = 10
    found["grows"] = run(body, follow="", pin="", stiffness=1e6)
    return found


def case_shell():
    """A sheet of quads, held along one side, with a key that curls it and a collision object in its way; it wears a badge."""
    vertices = [(i / 8 - .5, j / 8 - .5, 1.) for j in range(9) for i in range(9)]
    sheet = make_object("bar", vertices, [(9 * j + i, 9 * j + i + 1, 9 * j + i + 10, 9 * j + i + 9) for j in range(8) for i in range(8)])
    sheet.shape_key_add(name="Basis")
    add_key(sheet, "curl", [(math.sin(.5 + x) - .5, y, 1. - math.cos(.5 + x) + 1.) for x, y, _ in vertices])
    add_group(sheet, "edge", lambda x, y, z: x < -.45)
    add_group(sheet, "exemplar thickness", lambda x, y, z: y > 0, .5)
    badge = make_object("badge", [(0., 0., 1.1), (.1, 0., 1.1), (0., .1, 1.1)], [(0, 1, 2)])
    badge.parent = sheet
    table = make_object("table", [(-2., -2., .6), (2., -2., .6), (2., 2., .6), (-2., 2., .6)], [(0, 1, 2, 3)])
    table.modifiers.new("touch", "COLLISION")
    settings = {"follow": "", "pin": "edge", "kind": "SHELL", "thickness": 5e-3, "stiffness": 1e5, "importance": .1}
    found = {"said": run(sheet, **settings), "prm": scene_file(), "run": run_places()}
    result = bpy.data.objects["bar result"]
    found["shown"] = [places(result, frame) for frame in range(3, 19)]
    found["keys"] = [key.name for key in result.data.shape_keys.key_blocks]
    found["found regions"] = run(sheet, **settings, regions="AUTO")
    sheet["exemplar tension"] = 1.
    found["muscle"] = run(sheet, **settings, regions="NONE")
    return found


def case_touches_itself():
    """Two bars in one object, of which the upper one falls on the lower one."""
    vertices, faces = bar()
    upper = [(.6 * y, .6 * x, z / 4 + 4.3) for x, y, z in vertices]
    body = make_object("bar", vertices + upper, faces + [[i + len(vertices) for i in reversed(face)] for face in faces])
    add_group(body, "feet", lambda x, y, z: z == 0)
    found = {"said": run(body, follow="", stiffness=1e6, touches_itself=True), "prm": scene_file()}
    found["least"] = [min(x[2] for x in frame[len(vertices):]) for frame in run_places()]
    found["top"] = [max(x[2] for x in frame[:len(vertices)]) for frame in run_places()]
    return found


def make_second():
    """A mirrored bar across the first one and above it, in a collection with a hidden mesh: it has Subdivision, its own key, and a muted one
    of the same name as the first one's."""
    vertices, faces = bar()
    second = make_object("second", [(.8 * z - 1.6, .6 * x, .6 * y) for x, y, z in vertices], faces)
    second.data.uv_layers.new(name="skin")
    second.shape_key_add(name="Basis")
    x = np.array([tuple(vertex.co) for vertex in second.data.vertices])
    add_key(second, "arched", x - np.outer(.1 * x[:, 0] ** 2, [0., 0., 1.]))
    add_key(second, "bent", x + [0., 0., 1.]).mute = True
    add_group(second, "end", lambda x, y, z: x < -1.55)
    second.modifiers.new("fine", "SUBSURF")
    second.location, second.scale = (0., 0., 5.4), (-1., 1., 1.)
    more = bpy.data.collections.new("things")
    scene.collection.children.link(more)
    for shown in (second, make_object("unseen", *bar())):
        scene.collection.objects.unlink(shown)
        more.objects.link(shown)
    bpy.data.objects["unseen"].hide_set(True)
    return second, more


def base_places(shown, frame):
    """Where the object takes its vertices at rest."""
    scene.frame_set(frame)
    return [list(shown.matrix_world @ vertex.co) for vertex in shown.data.vertices]


def parts_of(of_run):
    """Of the places in each frame: those of each object."""
    return [[[frame[i] for i in part.vertices] for frame in of_run] for part in exemplar.Running.shot.parts]


def overlaps():
    """Pairs of faces of the first body and of the second one that cross in each frame of the run."""
    faces = [part.faces for part in exemplar.Running.shot.parts]
    return [len(BVHTree.FromPolygons(first, faces[0]).overlap(BVHTree.FromPolygons(second, faces[1])))
            for first, second in zip(*parts_of(run_places()))]


def keyed(shown):
    return sorted(curve.data_path for curve in shown.data.shape_keys.animation_data.action.fcurves)


def case_bodies():
    """A bar falls on another one, whose feet are pinned; both wear something and have Collision physics."""
    body, (second, more) = make_body(), make_second()
    for name, wearer, place in (("belt", body, (0., -.55, 2.)), ("flag", second, (1., -.35, 0.))):
        thing = make_object(name, [(0., 0., 0.), (.1, 0., 0.), (0., 0., .1)], [(0, 1, 2)])
        thing.parent, thing.location = wearer, place
    for shown in (body, second):
        shown.modifiers.new("touch", "COLLISION")
    body.collision.friction_factor = .25
    found = {"before": [what_it_has(shown) for shown in (body, second)], "said": run(body, follow="", stiffness=1e6, more_bodies=more)}
    found.update(prm=scene_file(), run=parts_of(run_places()), overlaps=overlaps())
    results = [bpy.data.objects["bar result"], bpy.data.objects["second result"]]
    found.update(after=list(map(what_it_has, results)), modifiers=list(map(modifiers_of, results)), keyed=list(map(keyed, results)))
    found["shown"] = [without_what_is_behind(shown, range(3, 19)) for shown in results]
    found["parents"] = [bpy.data.objects[f"{name} result"].parent.name for name in ("belt", "flag")]
    found["hidden"] = [[shown.hide_get(), shown.hide_render] for shown in (body, second)]
    found["objects"] = sorted(item.name for item in bpy.data.objects)
    found["caches"] = sorted(modifier.filepath for item in bpy.data.objects for modifier in item.modifiers if modifier.type == "MESH_CACHE")
    return found


def case_bodies_that_change():
    """The second body is led by its own group, by a keyed motion; it gets other faces while it runs. Then a run is cancelled."""
    body, (second, more) = make_body(), make_second()
    second.exemplar.follow = "end"
    for frame, height in ((3, 5.4), (18, 5.8)):
        second.location[2] = height
        second.keyframe_insert("location", frame=frame)
    add_group(second, "exemplar stiffness", lambda x, y, z: True, 1.)
    settings = {"follow": "", "stiffness": 1e6, "more_bodies": more}
    found = {"refused": begin(body, **settings), "prm": scene_file()}
    found["stiffness"] = [row.split(",")[2] for row in (exemplar.directory_of(body) / "groups.csv").read_text().split()[1:]]
    second.data.polygons[0].flip()
    body.name = "renamed"
    wait(exemplar)
    body.name = "bar"
    found.update(said=exemplar.Running.said, run=parts_of(run_places()), overlaps=overlaps())
    found["shown"] = [[places(bpy.data.objects[f"{name} result"], frame) for frame in range(3, 19)] for name in ("bar", "second")]
    found["led"] = [[x for x, weight in zip(base_places(second, frame), second.data.vertices) if weight.co[0] < -1.55] for frame in (3, 18)]
    found["hidden"] = [shown.hide_get() for shown in (body, second)]

    scene.frame_end = 20000
    second.data.polygons[0].flip()
    second.exemplar.follow = ""
    found["refused"] += begin(body, **settings)
    while exemplar.poll() is not None and not exemplar.previews():
        time.sleep(.02)
    found["preview"] = [len(shown.data.vertices) for shown in exemplar.previews()]
    found["hidden meanwhile"] = [shown.hide_get() for shown in (body, second)]
    bpy.ops.exemplar.cancel()
    wait(exemplar)
    found.update(cancelled=exemplar.Running.said, seen=[not shown.hide_get() and not shown.hide_render for shown in (body, second)],
                 objects=sorted(item.name for item in bpy.data.objects))

    scene.frame_end = 5
    found["refused"] += begin(body, **settings)
    bpy.data.objects.remove(second)
    wait(exemplar)
    found["deleted"], found["run of deleted"] = exemplar.Running.said, parts_of(run_places())
    found["shown of deleted"] = [places(bpy.data.objects[f"{name} result"], 5) for name in ("bar", "second")]
    return found


def case_bodies_with_regions():
    """An eye on a bone of a body that does not begin at rest: both have painted regions and a key of the same name, and the bone leads both."""
    body = make_body()
    rig = make_rig(body, begin=.5)
    vertices, faces = bar()
    eye = make_object("eye", [(.3 * x, .3 * y, .1 * z) for x, y, z in vertices], faces)
    eye.parent, eye.parent_type, eye.parent_bone = rig, "BONE", "high"
    eye.location = (0., -1.2, .55)
    eye.shape_key_add(name="Basis")
    add_key(eye, "bent", [(.3 * x, .3 * y, .13 * z) for x, y, z in vertices])
    add_group(eye, "back", lambda x, y, z: z == 0)
    eye.exemplar.follow = "back"
    more = bpy.data.collections.new("eyes")
    scene.collection.children.link(more)
    more.objects.link(eye)
    add_group(body, "exemplar region top", lambda x, y, z: z > 2.)
    add_group(body, "exemplar region foot", lambda x, y, z: z < 1.)
    add_group(eye, "exemplar region lens", lambda x, y, z: z > .2)
    found = {"posed": places(eye, 3), "said": run(body, more_bodies=more, regions="PAINTED"), "prm": scene_file()}
    found["run"] = parts_of(run_places())
    results = [bpy.data.objects["bar result"], bpy.data.objects["eye result"]]
    found["shown"] = [[places(shown, frame) for frame in range(3, 19)] for shown in results]
    found["keys"] = [[key.name for key in shown.data.shape_keys.key_blocks] for shown in results]
    rig.data.pose_position = "REST"
    exemplar.show_originals(body.exemplar.token)
    found["at rest"] = places(eye, 3)
    found["written"] = exemplar.exemplar_blender.read_obj(exemplar.directory_of(body) / "body.obj")[0][len(vertices):].tolist()
    eye.scale = (.3, .3, .3)
    found["small"] = run(body, repair=True)
    return found


def case_mistakes_of_bodies():
    body, (second, more) = make_body(), make_second()
    settings = {"follow": "", "stiffness": 1e6, "more_bodies": more}
    second.exemplar.pin = "gone"
    found = {"no group": run(body, **settings)}
    second.exemplar.pin, second.exemplar.kind = "", "SHELL"
    found["a shell"] = run(body, **settings)
    second.exemplar.kind = "SOLID"
    found["shells"] = run(body, **settings, kind="SHELL")
    second.location = (0., 0., 5.)
    scene.frame_end = 5
    found["parted by keys"] = run(body, **settings, kind="SOLID")
    found["near"] = [sum(vertex.select for vertex in shown.data.vertices) for shown in (body, second)]
    body.data.shape_keys.key_blocks["bent"].mute = second.data.shape_keys.key_blocks["arched"].mute = True
    found["crossing"] = run(body, **settings)
    found["selected"] = [sum(face.select for face in shown.data.polygons) for shown in (body, second)]
    second.location, second.scale = (0., 0., 3.), (-.1, .5, .5)
    found["inside"] = run(body, **settings)
    for shown in (body, second):
        shown.shape_key_clear()
    second.location = (0., 0., 5.)
    second.scale = (-1., 1., 1.)
    found["one piece"] = run(body, **settings, repair=True)
    second.hide_set(True)
    found["alone"] = run(body, **settings)
    found["alone prm"] = scene_file()
    return found


def case_bodies_with_a_muscle():
    """The first one's muscle pulls, and the second one, which lies apart, keeps its length."""
    body, (second, more) = make_body(), make_second()
    body["exemplar tension"] = 2e5
    add_group(body, "exemplar fibres from", lambda x, y, z: z == 0)
    add_group(body, "exemplar fibres to", lambda x, y, z: z == 4)
    scene.gravity = (0., 0., 0.)
    return {"said": run(body, follow="", stiffness=1e6, more_bodies=more), "prm": scene_file(), "run": parts_of(run_places())}


def case_pairs_left_out():
    """A bar that is bent until its ends cross; a key parts them."""
    vertices, faces = bar()
    thin = [(.4 * x, .4 * y, z) for x, y, z in vertices]
    body = make_object("bar", [bent(*x, angle=1.02 * 2 * math.pi) for x in thin], faces)
    body.shape_key_add(name="Basis")
    add_key(body, "open", [bent(*x, angle=.7 * 2 * math.pi) for x in thin])
    body.vertex_groups.new(name="middle").add([i for i, x in enumerate(vertices) if abs(x[2] - 2.) < .4], 1., "REPLACE")
    body.scale = (50., 50., 50.)
    scene.unit_settings.scale_length = .02
    scene.frame_end = 4
    found = {"said": run(body, follow="", pin="middle", stiffness=1e6, touches_itself=True)}
    found["selected"] = [vertices[vertex.index] for vertex in body.data.vertices if vertex.select]
    found["at rest"] = [list(vertex.co) for vertex in body.data.vertices if vertex.select]
    return found


def case_tension():
    """A bone's rotation drives the muscle of a bar that hangs at its head."""
    body = make_body()
    rig = make_rig(body)
    body["exemplar tension"] = 0.
    missing = run(body, follow="", pin="head", balanced=False)
    add_group(body, "exemplar fibres from", lambda x, y, z: z == 0)
    add_group(body, "exemplar fibres to", lambda x, y, z: z == 4)
    driver = body.driver_add('["exemplar tension"]').driver
    driver.type = "SCRIPTED"
    turn = driver.variables.new()
    turn.name, turn.type = "turn", "TRANSFORMS"
    turn.targets[0].id, turn.targets[0].bone_target = rig, "high"
    turn.targets[0].transform_type, turn.targets[0].rotation_mode, turn.targets[0].transform_space = "ROT_Z", "XYZ", "LOCAL_SPACE"
    driver.expression = "20000 * abs(turn)"
    scene.gravity = (0., 0., 0.)
    body.modifiers.clear()
    found = {"missing": missing, "said": run(body, follow="", pin="head", stiffness=1e5, balanced=False), "prm": scene_file(), "run": run_places()}
    add_group(body, "exemplar muscle", lambda x, y, z: False)
    found["nowhere"] = run(body, follow="", pin="head", stiffness=1e5, balanced=False)
    found["nowhere run"] = run_places()
    return found


def case_spans():
    body = make_body()
    make_rig(body)
    found = {"said": run(body, follow_until=10, pin_from=5), "prm": scene_file(), "end": run_places()[-1], "same": run(body, follow_from=10)}
    return found


def case_words():
    """Messages of the program."""
    body = make_body()
    scene.gravity = (0., 0., -200.)
    found = {"soft": run(body, follow="", stiffness=1e4)}
    found["unbalanced"] = run(body, follow="", stiffness=1e4, balanced=False)
    found["nothing holds"] = run(body, follow="", pin="", balanced=True)
    found["nothing holds prm"] = scene_file()
    add_group(body, "nobody", lambda x, y, z: False)
    found["empty group"] = run(body, follow="", pin="nobody")
    add_key(body, "inside out", [(-c[0], c[1], c[2]) for c in (vertex.co for vertex in body.data.vertices)])
    found["bad key"] = run(body, follow="", pin="feet")
    return found


Path(result).write_text(json.dumps(globals()[f"case_{case}"]()))
