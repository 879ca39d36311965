# SPDX-License-Identifier: GPL-3.0-or-later
"""make_blender.py PROJECT OUT.png: brings a project into Blender, turns its head, simulates, and draws a frame. With the Python of a
Blender in which the extension is installed (./dev addon)."""

from __future__ import annotations

import math
import sys
import time

import bpy

import addon_utils  # isort: skip

project, picture = sys.argv[1:]
if not hasattr(bpy.types.Curves, "hairloom"):
    addon_utils.enable("bl_ext.user_default.hairloom")
bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
scene = bpy.context.scene
scene.render.fps, scene.frame_start, scene.frame_end = 24, 1, 20

bpy.ops.hairloom.bring_back(filepath=project)
hair = bpy.context.active_object
head = hair.data.surface
for frame, angle in ((1, -70), (3, -70), (9, 35)):
    head.rotation_euler = (0, 0, math.radians(angle))
    head.keyframe_insert("rotation_euler", frame=frame)
scene.frame_set(1)
bpy.ops.hairloom.simulate()
began = time.perf_counter()
for frame in range(1, 10):
    scene.frame_set(frame)
print(f"{len(hair.data.curves)} x {hair.data.curves[0].points_length}: {(time.perf_counter() - began) / 9 * 1e3:.1f} ms a frame")
assert hair.data.hairloom.mode == "LIVE", hair.data.hairloom.status


def material(name: str, kind: str, **inputs: object) -> bpy.types.Material:
    made = bpy.data.materials.new(name)
    nodes = made.node_tree.nodes
    nodes.clear()
    shader, out = nodes.new(kind), nodes.new("ShaderNodeOutputMaterial")
    for key, value in inputs.items():
        shader.inputs[key.replace("_", " ")].default_value = value
    made.node_tree.links.new(shader.outputs[0], out.inputs["Surface"])
    return made


head.data.materials.append(material("skin", "ShaderNodeBsdfPrincipled", Base_Color=(0.55, 0.42, 0.36, 1), Roughness=0.6))
shine = material("hair", "ShaderNodeBsdfHairPrincipled")
node = next(one for one in shine.node_tree.nodes if one.bl_idname == "ShaderNodeBsdfHairPrincipled")
node.parametrization = "MELANIN"
node.inputs["Melanin"].default_value = 0.55
hair.data.materials.append(shine)
# Guides alone are few: they stand for locks.
radius = hair.data.attributes["radius"].data
values = [0.0] * len(radius)
radius.foreach_get("value", values)
radius.foreach_set("value", [value * 8 for value in values])

for place, strength in (((1.2, -1.6, 2.4), 40), ((-1.8, -0.8, 1.9), 15), ((0.3, 1.8, 2.3), 30)):
    light = bpy.data.objects.new("light", bpy.data.lights.new("light", "AREA"))
    light.data.energy, light.data.size, light.location = strength, 0.8, place
    light.constraints.new("TRACK_TO").target = head
    scene.collection.objects.link(light)
camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
scene.collection.objects.link(camera)
target = bpy.data.objects.new("target", None)
points = [head.matrix_world @ vertex.co for vertex in head.data.vertices]
top = max(point.z for point in points)
target.location = (0, 0, top - 0.16)
scene.collection.objects.link(target)
camera.location = (0.35, -1.1, top - 0.1)
camera.data.lens = 85
camera.constraints.new("TRACK_TO").target = target
scene.camera = camera
scene.world = bpy.data.worlds.new("world")
scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.25, 0.27, 0.3, 1)
scene.render.engine, scene.cycles.device, scene.cycles.samples = "CYCLES", "CPU", 24
scene.cycles.use_denoising = True
scene.view_settings.view_transform = "Standard"
scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 640, 640, 100
scene.render.image_settings.file_format = "PNG"
scene.render.filepath = picture
bpy.ops.render.render(write_still=True)
