# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel "exemplar" of the 3D view: an object, its shape keys and vertex groups become a scene, which runs in the background."""
import textwrap
import uuid
from pathlib import Path

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty, StringProperty

from . import results, scene_files
from .exemplar_blender import Failure
from .job import FaultSearch, Job
from .scene_files import HIDDEN, MADE, is_shell
from .surfaces import Surface
from .words import in_artists_words

bl_info = {"name": "exemplar", "blender": (3, 4, 0), "version": (0, 1, 0), "category": "Animation", "author": "exemplar",
           "location": "3D View > Sidebar > exemplar", "doc_url": "", "description": "Elastic bodies that bend as their shape keys say"}

POLL = 0.2  # [s]


class Settings(bpy.types.PropertyGroup):
    kind: EnumProperty(name="Body", default="SOLID", items=[
        ("SOLID", "Solid", "The object is the closed surface of a body, which is filled with cells"),
        ("SHELL", "Shell", "The object is a sheet with a thickness, as cloth, paper, leaves and faces: open or closed")])
    thickness: FloatProperty(name="Thickness", default=1e-3, min=1e-9, precision=4, description="How thick the sheet is [m]")
    cells: IntProperty(name="Cells", default=10000, min=10, max=10 ** 7, description="How many tetrahedra fill the body, about")
    stiffness: FloatProperty(name="Stiffness", default=1e5, min=1e-3, precision=0, description="Young's modulus [Pa]")
    importance: FloatProperty(name="Importance", default=0.8, min=0, max=1, subtype="FACTOR",
                              description="How strongly the body is pulled towards its shape keys")
    energy: EnumProperty(name="Shape keys", default="LEAD", items=[
        ("LEAD", "Lead", "A part that is moved brings the whole shape key along: a fingertip closes the hand"),
        ("GUIDE", "Guide", "Shape keys draw the body gently: a part that is moved brings little of the rest along")])
    balanced: BoolProperty(name="Balanced", default=True,
                           description="The body stands under its weight as it is drawn, instead of sagging: it carries the stresses from "
                                       "the beginning. Where gravity acts, and Follow or Pin holds it in the first frame")
    follow: StringProperty(name="Follow", description="Vertex group that goes where armature, modifiers and keys put it")
    pin: StringProperty(name="Pin", description="Vertex group that stays where it is in the first frame")
    more_bodies: PointerProperty(type=bpy.types.Collection, name="More bodies",
                                 description="The other meshes in this collection that are seen are bodies of the same scene, and do not "
                                             "pass through each other. Of their settings Follow and Pin count; the others are this object's")
    follow_from: IntProperty(name="Follow from", min=0, description="Frame in which Follow catches its vertices; 0: from the beginning")
    follow_until: IntProperty(name="until", min=0, description="Frame in which Follow lets go; 0: never")
    pin_from: IntProperty(name="Pin from", min=0, description="Frame in which Pin catches its vertices; 0: from the beginning")
    pin_until: IntProperty(name="until", min=0, description="Frame in which Pin lets go; 0: never")
    weights: EnumProperty(name="Weights", default="SIMPLEX", items=[
        ("SIMPLEX", "Shared", "The weights of the shape keys and of the rest are not negative and sum to 1: for poses"),
        ("ADDITIVE", "Added", "Each shape key has a weight of its own between 0 and 1: for keys as a smile, a blink, an ear"),
        ("FREE", "Free", "They sum to 1 and may be negative or greater than 1: keys go beyond their shapes"),
        ("KEYED", "Keyed", "They are the values that the shape keys have in each frame, by keyframes or drivers: the body is drawn to this mix")])
    regions: EnumProperty(name="Regions", default="NONE", items=[
        ("NONE", "None", "The shape keys have the same weights in the whole body"),
        ("AUTO", "Found", "Parts that the shape keys strain apart from others, as limbs, have weights of their own"),
        ("PAINTED", "Painted", "Each vertex group whose name begins with 'exemplar region ' has weights of its own")])
    damping: FloatProperty(name="Damping", default=0, min=0, description="How fast all motion dies away, as in air or water [1/s]")
    inner_damping: FloatProperty(name="Inner damping", default=0, min=0, precision=4,
                                 description="How much the body resists bending fast, as flesh does [s]")
    steps: IntProperty(name="Steps", default=1, min=1, max=1000, description="Steps of the simulation a frame: more for fast motion")
    touches_itself: BoolProperty(name="Touches itself",
                                 description="No part of the body passes through another one, with the friction of its Collision physics, if it "
                                             "has these. A step takes many times as long")
    repair: BoolProperty(name="Repair", description="Mend holes and crossing faces before the body is filled")
    token: StringProperty(options={"HIDDEN"})  # identity of the body, whatever its name becomes


class Preferences(bpy.types.AddonPreferences):
    bl_idname = __name__
    program: StringProperty(name="Program", default="exemplar", subtype="FILE_PATH", description="The program exemplar")

    def draw(self, _context):
        self.layout.prop(self, "program")


class Running:
    """The run that goes on, or was the last; one at a time. What artists may rename or delete meanwhile is not held by reference."""
    job = None
    search = None  # search for faults, after a run that has failed
    token = ""     # token of the first body
    title = ""     # its name at the start
    scene = ""     # name of the scene
    start = 0      # first frame of the scene
    shot = None    # what it was given
    said = ""      # text for the panel

    @classmethod
    def is_on(cls):
        return cls.job is not None

    @classmethod
    def bodies(cls):
        """(part of the shot, its object, or None if it is no more) of each."""
        by_token = {item.exemplar.token: item for item in reversed(bpy.data.objects)}
        return [(part, by_token.get(part.token)) for part in cls.shot.parts]

    @classmethod
    def bodies_left(cls):
        return [body for _, body in cls.bodies() if body is not None]


def program_of(context):
    program = context.preferences.addons[__name__].preferences.program
    return str(Path(bpy.path.abspath(program)).resolve()) if "/" in program else program


def directory_of(body):
    """Beside the .blend, for one object."""
    if not bpy.data.filepath:
        raise Failure("Save the .blend first: the scene and what comes of it go beside it.")
    blend = Path(bpy.data.filepath)
    return blend.with_name(f"{blend.stem}_{bpy.path.clean_name(body.name)}")


def hide(shown, hidden=True):
    try:
        shown.hide_set(hidden)
    except RuntimeError:
        pass  # the object is in no collection of this view layer, so it is not seen


def hide_original(shown):
    """The result stands in its place, also in renders."""
    hide(shown)
    if HIDDEN not in shown:
        shown[HIDDEN] = {"body": Running.token, "rendered": not shown.hide_render}
        shown.hide_render = True


def show_original(shown):
    hide(shown, False)
    if HIDDEN in shown:
        shown.hide_render = not shown[HIDDEN]["rendered"]
        del shown[HIDDEN]


def show_originals(token):
    for shown in bpy.data.objects:
        if HIDDEN in shown and shown[HIDDEN]["body"] == token:
            show_original(shown)


def mark(shown, name):
    shown.name = name
    shown[MADE] = f"{Running.token}/{shown.name}"


def is_made(shown):
    return MADE in shown


def results_of(token):
    """What was made for a body and has its name still; what was renamed is the artist's."""
    return [item for item in bpy.data.objects if item.get(MADE) == f"{token}/{item.name}" and item.parent is None]


def remove_made(shown):
    for item in (*shown.children, shown):
        if is_made(item):
            mesh = item.data
            bpy.data.objects.remove(item)
            if mesh.users == 0:
                bpy.data.meshes.remove(mesh)


def identify(body):
    token = body.exemplar.token
    if not token or sum(item.exemplar.token == token for item in bpy.data.objects) > 1:
        body.exemplar.token = uuid.uuid4().hex  # a copy is another body


def start(context, body):
    """Write the scene of a body, and of its More bodies, and start its run."""
    if Running.is_on():
        raise Failure(f"{Running.title} is running. Cancel that first.")
    if is_made(body):
        raise Failure(f"{body.name} is the result of a run. Choose the object that is the body.")
    scene, bodies = context.scene, scene_files.bodies_of(body)
    for shown in bodies:
        identify(shown)
        show_originals(shown.exemplar.token)
        show_original(shown)  # hidden objects are not evaluated
    directory = directory_of(body)
    try:
        shot = scene_files.write_scene(bodies, scene, directory)
        job = Job(program_of(context), shot.file, shot.n_frames, shot.steps)
    except OSError as error:
        raise Failure(f"{directory} cannot be written ({error.strerror}). Save the .blend elsewhere.") from error
    for result in (result for part in shot.parts for result in results_of(part.token)):
        hide(result)
    Running.job, Running.search, Running.token, Running.title, Running.said = job, None, body.exemplar.token, body.name, ""
    Running.scene, Running.start, Running.shot = scene.name, scene.frame_start, shot


def poll():
    """What a timer does until the run has ended. Returns the seconds to the next call, or None."""
    if not Running.is_on():
        return None
    try:
        goes_on = advance()
    except Exception as error:  # Blender would drop the timer, and nothing would ever end the run
        stop(f"The run cannot be shown: {error}")
        goes_on = False
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()
    return POLL if goes_on else None


def advance():
    """Show how far the run is. Returns whether it goes on."""
    job = Running.job
    if Running.search is not None:
        if Running.search.is_running():
            return True
        say_faults(*Running.search.found())
    elif job.is_running():
        show_frame(job.newest_frame())
        Running.said = "\n".join([f"Frame {max(job.shown, 0)} of {job.n_frames}", *in_words("\n".join(job.messages())).splitlines()])
        return True
    elif job.failure() is None:
        show_result(job)
    else:
        remove_preview()
        Running.said = in_words(job.failure())
        say_pairs_left_out(job)
        select_overlap(job)
        if not job.cancelled and "body.obj" in job.failure():
            Running.search = FaultSearch(job)
            return True
    stop(Running.said)
    return False


def stop(said):
    """The run is over: what stands in for the body goes, and unless there is a result the body is seen again."""
    Running.job.cancel()
    if Running.search is not None and Running.search.is_running():
        Running.search.process.kill()
    remove_preview()
    if all(result.hide_get() for result in results_of(Running.token)):
        show_originals(Running.token)
        for body in Running.bodies_left():
            hide(body, False)
    Running.job, Running.search, Running.said = None, None, said


def preview_name():
    return f"{Running.title} running"


def previews():
    return [item for item in results_of(Running.token) if item.name.startswith(preview_name())]


def remove_preview():
    for item in previews():
        remove_made(item)


def show_frame(places):
    """The newest frame, by an object of its own."""
    if places is None:
        return
    preview = next(iter(previews()), None)
    if preview is None or len(preview.data.vertices) != len(places):
        mesh = bpy.data.meshes.new(preview_name())
        mesh.from_pydata(places.tolist(), [], Running.shot.faces())
        preview = bpy.data.objects.new(preview_name(), mesh)
        mark(preview, preview_name())
        (bpy.data.scenes.get(Running.scene) or bpy.context.scene).collection.objects.link(preview)
        for body in Running.bodies_left():
            hide_original(body)
    preview.data.vertices.foreach_set("co", places.astype("f4").ravel())
    preview.data.update()


def show_result(job):
    """The bodies and what they wear, moved, in the place of those of an earlier run."""
    remove_preview()
    for part in Running.shot.parts:
        for result in results_of(part.token):
            remove_made(result)
    show_originals(Running.token)
    scene = bpy.data.scenes.get(Running.scene) or bpy.context.scene
    with bpy.context.temp_override(scene=scene, view_layer=scene.view_layers[0]):
        changed = bring_in(job)
    Running.said = in_words("\n".join(["Done.", *Running.shot.notes, *changed, *job.messages()]))
    say_pairs_left_out(job)
    try:
        bpy.ops.ed.undo_push(message="exemplar result")
    except RuntimeError:
        pass  # there is no undo without a window


def bring_in(job):
    """What the artist must know of what has changed during the run."""
    prefix, changed, made = results.free_prefix(job.output.parent), [], {}
    shown = [bring_in_body(job, number, prefix, made, changed) for number in range(len(Running.shot.parts))]
    for i, (name, matrix, number) in enumerate(Running.shot.worn, 1):
        child = bpy.data.objects.get(name)
        moved = child and results.make_worn(child, matrix, shown[number], job.output / f"animation_worn_{i}.pc2", Path(f"{prefix}worn_{i}.pc2"),
                                            Running.start)
        if moved is None:
            changed.append(f"{name} is not what it was when the run began, and stays where it is.")
        else:
            made[child] = moved
            mark(moved, f"{name} result")
    results.retarget(made)
    for original in (*made, *Running.bodies_left()):
        hide_original(original)
    return changed


def bring_in_body(job, number, prefix, made, changed):
    """The result of a part of the shot; adds to what was made of which object, and to what has changed."""
    part, body = Running.bodies()[number]
    cache_file = Path(f"{prefix}residual{f'_{number + 1}' if number else ''}.pc2")
    try:
        if body is None:
            raise Failure(f"{part.name} is no more.")
        result, player = results.make_result(body, part, Running.shot, job.output, Running.start, cache_file)
        made[body] = result
    except Failure as failure:
        result, player = results.make_plain_result(part, job.output, Running.start)
        changed.append(f"{failure} The result is a surface without materials and modifiers.")
    mark(result, f"{part.name} result")
    mark(player, f"{part.name} residual")
    return result


def in_words(text):
    return in_artists_words(text, Running.job.directory, Running.shot)


def say_faults(faces, vertices):
    if (faces or vertices) and select(faces, vertices):
        Running.said += f"\n{len(faces)} faces and {len(vertices)} vertices with faults are selected: see them in edit mode."


def say_pairs_left_out(job):
    """Which parts of the surface contact leaves out, and select the vertices near the place of the first that the program names."""
    found = job.pairs_left_out()
    if found is None:
        return
    n_pairs, place = found
    Running.said += f"\n{n_pairs} pairs of parts of {Running.shot.names()} touch or cross at rest, and may pass through each other."
    vertices = scene_files.vertices_near(Running.shot, place)
    if select(set(), vertices):
        Running.said += f" {len(vertices)} vertices near the first pair are selected: see them in edit mode."


def select_overlap(job):
    """Select the vertices near the place at which the program says that two pieces overlap."""
    place = job.place_of_overlap()
    if place is None:
        return
    vertices = scene_files.vertices_near(Running.shot, place)
    if select(set(), vertices):
        Running.said += f"\n{len(vertices)} vertices near this place are selected: see them in edit mode."


def select(faces, vertices):
    """By numbers in the surface of all bodies, in those that have the faces still with which the run began. Whether nothing is left out."""
    n_faces, is_whole = 0, True
    for part, body in Running.bodies():
        own_faces = {face - n_faces for face in faces if 0 <= face - n_faces < len(part.faces)}
        own_vertices = {vertex - part.vertices.start for vertex in vertices if vertex in part.vertices}
        is_selected = select_in(body, part, own_faces, own_vertices)
        is_whole &= is_selected or not (own_faces or own_vertices)
        n_faces += len(part.faces)
    return is_whole


def select_in(body, part, faces, vertices):
    """Whether the object has the faces that it had."""
    if body is None:
        return False
    surface = Surface(body)
    is_same = not surface.is_made and surface.faces() == part.faces
    surface.free()
    if not is_same:
        return False
    for polygon in body.data.polygons:
        polygon.select = polygon.index in faces
    seen = vertices | {vertex for polygon in body.data.polygons if polygon.index in faces for vertex in polygon.vertices}
    for vertex in body.data.vertices:
        vertex.select = vertex.index in seen
    return True


class Run(bpy.types.Operator):
    """Let the active object move as an elastic body through the frames of the scene"""
    bl_idname = "exemplar.run"
    bl_label = "Run"

    @classmethod
    def poll(cls, context):
        return context.object is not None and context.object.type == "MESH"

    def execute(self, context):
        try:
            start(context, context.object)
        except Failure as failure:
            if not Running.is_on():
                Running.said = str(failure)
            self.report({"ERROR"}, str(failure))
            return {"CANCELLED"}
        if not bpy.app.timers.is_registered(poll):
            bpy.app.timers.register(poll, first_interval=POLL)
        return {"FINISHED"}


class Cancel(bpy.types.Operator):
    """End the run within a second"""
    bl_idname = "exemplar.cancel"
    bl_label = "Cancel"

    def execute(self, _context):
        if Running.is_on():
            Running.job.cancel()
        return {"FINISHED"}


class Panel(bpy.types.Panel):
    bl_idname = "VIEW3D_PT_exemplar"
    bl_label = "exemplar"
    bl_space_type, bl_region_type, bl_category = "VIEW_3D", "UI", "exemplar"

    def draw(self, context):
        layout, body = self.layout, context.object
        if body is None or body.type != "MESH":
            layout.label(text="Choose the object that is the body.")
        else:
            settings = body.exemplar
            layout.label(text=scale_line(body, context.scene))
            layout.prop(settings, "kind")
            for name in ("thickness" if is_shell(settings) else "cells", "stiffness", "importance"):
                layout.prop(settings, name)
            row = layout.row()
            row.enabled = settings.weights != "KEYED"
            row.prop(settings, "energy", expand=True)
            for name in ("follow", "pin"):
                layout.prop_search(settings, name, body, "vertex_groups")
            layout.prop(settings, "more_bodies")
            row = layout.row()
            row.enabled = bool(scene_files.gravity_of(context.scene).any()) and not is_shell(settings)
            row.prop(settings, "balanced")
        layout.operator("exemplar.cancel" if Running.is_on() else "exemplar.run")
        for line in Running.said.splitlines():
            for part in textwrap.wrap(line, max(20, context.region.width // 8)):
                layout.label(text=part)


class MorePanel(bpy.types.Panel):
    bl_idname = "VIEW3D_PT_exemplar_more"
    bl_label = "More"
    bl_parent_id = Panel.bl_idname
    bl_space_type, bl_region_type, bl_category = "VIEW_3D", "UI", "exemplar"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        return context.object is not None and context.object.type == "MESH"

    def draw(self, context):
        settings = context.object.exemplar
        for name in ("weights", "regions", "damping", "inner_damping", "steps"):
            self.layout.prop(settings, name)
        column = self.layout.column()
        column.enabled = not is_shell(settings)
        for name in ("touches_itself", "repair"):
            column.prop(settings, name)
        for handle in ("follow", "pin"):
            row = self.layout.row(align=True)
            row.enabled = bool(getattr(settings, handle))
            row.prop(settings, f"{handle}_from")
            row.prop(settings, f"{handle}_until")


def scale_line(body, scene):
    """How large the body is and how heavy things are: stiffness means nothing without these."""
    size, gravity = max(body.dimensions) * scene_files.unit_scale(scene), scene_files.gravity_of(scene)
    return f"{size:.3g} m, gravity {sum(g * g for g in gravity) ** .5:.3g} m/s²"


@bpy.app.handlers.persistent
def leave_file(*_):
    """Another .blend is opened, or the add-on goes: nobody would bring the result in."""
    if Running.is_on():
        stop("Cancelled.")


CLASSES = (Settings, Preferences, Run, Cancel, Panel, MorePanel)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Object.exemplar = PointerProperty(type=Settings)
    bpy.app.handlers.load_pre.append(leave_file)


def unregister():
    leave_file()
    bpy.app.handlers.load_pre.remove(leave_file)
    if bpy.app.timers.is_registered(poll):
        bpy.app.timers.unregister(poll)
    del bpy.types.Object.exemplar
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
