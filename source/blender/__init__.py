# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel "exemplar" of the 3D view: an object, its shape keys and vertex groups become a scene, which runs in the background."""
import textwrap
from pathlib import Path

import bpy
from bpy.props import BoolProperty, FloatProperty, IntProperty, PointerProperty, StringProperty

from . import scene_files
from .exemplar_blender import Failure, load_run
from .job import Job, find_faults

bl_info = {"name": "exemplar", "blender": (3, 4, 0), "version": (0, 1, 0), "category": "Animation", "author": "exemplar",
           "location": "3D View > Sidebar > exemplar", "doc_url": "", "description": "Elastic bodies that bend as their shape keys say"}

POLL = 0.2  # [s]


class Settings(bpy.types.PropertyGroup):
    cells: IntProperty(name="Cells", default=10000, min=10, max=10 ** 7, description="How many tetrahedra fill the body, about")
    stiffness: FloatProperty(name="Stiffness", default=1e5, min=1e-3, precision=0, description="Young's modulus [Pa]")
    importance: FloatProperty(name="Importance", default=0.9, min=0, max=1, subtype="FACTOR",
                              description="How strongly the body is pulled towards its shape keys")
    follow: StringProperty(name="Follow", description="Vertex group that goes where armature, modifiers and keys put it")
    pin: StringProperty(name="Pin", description="Vertex group that stays where it is at rest")
    repair: BoolProperty(name="Repair", description="Mend holes and crossing faces before the body is filled")


class Preferences(bpy.types.AddonPreferences):
    bl_idname = __name__
    program: StringProperty(name="Program", default="exemplar", subtype="FILE_PATH", description="The program exemplar")

    def draw(self, _context):
        self.layout.prop(self, "program")


class Running:
    """The run that goes on, or was the last; one at a time."""
    job = None
    body = None     # its name
    preview = None  # name of the object that shows the newest frame
    said = ""       # for the panel


def program_of(context):
    return bpy.path.abspath(context.preferences.addons[__name__].preferences.program)


def directory_of(body):
    """Beside the .blend, for one object."""
    if not bpy.data.filepath:
        raise Failure("Save the .blend first: the scene and what comes of it go beside it.")
    blend = Path(bpy.data.filepath)
    return blend.with_name(f"{blend.stem}_{bpy.path.clean_name(body.name)}")


def start(context, body):
    """Write the scene of a body and start its run."""
    if Running.job is not None and Running.job.is_running():
        raise Failure(f"{Running.body} is running. Cancel that first.")
    scene = context.scene
    file = scene_files.write_scene(body, body.exemplar, scene, directory_of(body))
    Running.job, Running.body, Running.said = Job(program_of(context), file, scene.frame_end - scene.frame_start), body.name, ""
    Running.preview = None


def poll():
    """What a timer does until the run has ended. Returns the seconds to the next call, or None."""
    job = Running.job
    was_running = job.is_running()
    show(job)
    if was_running:
        Running.said = f"Frame {max(job.shown, 0)} of {job.n_steps}"
        result = POLL
    else:
        finish(job)
        result = None
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()
    return result


def show(job):
    """The newest frame, by an object of its own."""
    places = job.newest_frame()
    if places is None:
        return
    preview = bpy.data.objects.get(Running.preview or "")
    if preview is None:
        body = bpy.data.objects[Running.body]
        mesh = bpy.data.meshes.new(f"{body.name} running")
        mesh.from_pydata(places.tolist(), [], [tuple(face.vertices) for face in body.data.polygons])
        preview = bpy.data.objects.new(mesh.name, mesh)
        bpy.context.scene.collection.objects.link(preview)
        Running.preview = preview.name
        body.hide_set(True)
    preview.data.vertices.foreach_set("co", places.astype("f4").ravel())
    preview.data.update()


def finish(job):
    """Show the result with its keys and weights, or say what was wrong and select where."""
    preview = bpy.data.objects.get(Running.preview or "")
    if preview is not None:
        bpy.data.meshes.remove(preview.data)
    body = bpy.data.objects.get(Running.body)
    failure = job.status()
    if failure is None:
        remove_result(f"{Running.body} result")
        result = load_run(job.output, start=bpy.context.scene.frame_start, up="z")
        result.name = f"{Running.body} result"
        for child in result.children:
            child.name = f"{Running.body} residual"
        Running.said = "\n".join(["Done.", *(line for line in job.messages() if line.startswith("Warning"))])
    else:
        Running.said = failure
        if body is not None:
            body.hide_set(False)
            select_faults(job, body)


def remove_result(name):
    """That of an earlier run, with what plays its residual. One that was renamed is kept."""
    result = bpy.data.objects.get(name)
    for shown in (*result.children, result) if result is not None else ():
        bpy.data.meshes.remove(shown.data)


def select_faults(job, body):
    faces, vertices = find_faults(job.process.args[0], job.output.with_name("body.obj")) if not job.cancelled else ([], [])
    if not faces and not vertices:
        return
    for polygon in body.data.polygons:
        polygon.select = polygon.index in set(faces)
    corners = {vertex for face in faces for vertex in body.data.polygons[face].vertices}
    for vertex in body.data.vertices:
        vertex.select = vertex.index in corners or vertex.index in set(vertices)
    Running.said += f"\n{len(faces)} faces and {len(vertices)} vertices with faults are selected: see them in edit mode."


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
            Running.said = str(failure)
            self.report({"ERROR"}, str(failure))
            return {"CANCELLED"}
        bpy.app.timers.register(poll, first_interval=POLL)
        return {"FINISHED"}


class Cancel(bpy.types.Operator):
    """End the run after the step that it makes"""
    bl_idname = "exemplar.cancel"
    bl_label = "Cancel"

    def execute(self, _context):
        if Running.job is not None:
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
            for name in ("cells", "stiffness", "importance"):
                layout.prop(settings, name)
            for name in ("follow", "pin"):
                layout.prop_search(settings, name, body, "vertex_groups")
            layout.prop(settings, "repair")
        running = Running.job is not None and Running.job.is_running()
        layout.operator("exemplar.cancel" if running else "exemplar.run")
        for line in Running.said.splitlines():
            for part in textwrap.wrap(line, max(20, context.region.width // 8)):
                layout.label(text=part)


CLASSES = (Settings, Preferences, Run, Cancel, Panel)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Object.exemplar = PointerProperty(type=Settings)


def unregister():
    if Running.job is not None:
        Running.job.cancel()
    del bpy.types.Object.exemplar
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
