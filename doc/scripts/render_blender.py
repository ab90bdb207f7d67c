# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw doc/tutorial/figures/step6_blender.png: the creature of step 6 at one frame, moved by its weights alone and with
the residual.

Usage, from the top folder, after the commands of doc/tutorial/step-6.md:

    blender --background output/tutorial/step6/creature.blend --python doc/scripts/render_blender.py

Takes a minute (Cycles on the CPU).
"""
import math

import bpy

FRAME, SHIFT = 20, 1.7
scene = bpy.context.scene
scene.frame_set(FRAME)

whole = bpy.data.objects["run"]
whole.data.materials.append(None)  # a slot for a colour of each object's own
weights = whole.copy()
weights.modifiers.remove(weights.modifiers["exemplar residual"])
scene.collection.objects.link(weights)
for thing, place, colour in ((weights, -SHIFT, (.45, .58, .72, 1)), (whole, SHIFT, (.9, .5, .2, 1))):
    thing.location.x += place
    material = bpy.data.materials.new(thing.name)
    material.use_nodes = True
    material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = colour
    material.node_tree.nodes["Principled BSDF"].inputs["Roughness"].default_value = .6
    thing.material_slots[0].link = "OBJECT"
    thing.material_slots[0].material = material
for polygon in whole.data.polygons:
    polygon.use_smooth = True

bpy.ops.mesh.primitive_plane_add(size=40)
sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
sun.data.energy, sun.data.angle = 1.4, .2
sun.rotation_euler = (math.radians(40), math.radians(15), 0)
camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
camera.data.type, camera.data.ortho_scale = "ORTHO", 6.8
camera.location, camera.rotation_euler = (-.15, -9, 2.9), (math.radians(76), 0, 0)
for thing in (sun, camera):
    scene.collection.objects.link(thing)
scene.camera = camera
scene.world = bpy.data.worlds.new("world")
scene.world.color = (.45, .45, .45)

scene.render.engine = "CYCLES"
scene.cycles.samples, scene.cycles.use_denoising = 48, False
scene.render.resolution_x, scene.render.resolution_y = 1200, 420
scene.view_settings.view_transform = "Standard"
scene.render.image_settings.color_mode = "RGB"
scene.render.filepath = "//../../../doc/tutorial/figures/step6_blender.png"
bpy.ops.render.render(write_still=True)
