# SPDX-License-Identifier: GPL-3.0-or-later
"""Imports a file into Blender and prints its curves as JSON, in metres and Y up. A process of its own: Blender's
readers abort on what they do not take."""
import json
import sys

import bpy

path = sys.argv[1]
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.context.scene.render.fps = 60
if path.endswith(".abc"):
    bpy.ops.wm.alembic_import(filepath=path, as_background_job=False)
else:
    bpy.ops.wm.usd_import(filepath=path)
if len(sys.argv) > 2:
    bpy.context.scene.frame_set(int(sys.argv[2]))
graph = bpy.context.evaluated_depsgraph_get()
strands = []
for found in bpy.context.scene.objects:
    if found.type != "CURVES":
        continue
    shown = found.evaluated_get(graph)
    positions = [shown.matrix_world @ point.position for point in shown.data.points]
    at = 0
    for curve in shown.data.curves:
        # Blender's Z is up: (x, z, -y) is what it is with Y up.
        strands.append([(p.x, p.z, -p.y) for p in positions[at:at + curve.points_length]])
        at += curve.points_length
print("CURVES" + json.dumps(strands))
