# SPDX-License-Identifier: GPL-3.0-or-later
"""blender_judge.py FILE [FRAME] [--usd OUT]: imports a file into Blender and prints its curves as JSON, in metres and Y up, and
what objects there are; --usd writes them as Blender's own USD. A process of its own: Blender's readers abort on what they do not
take."""
import json
import sys

import bpy

words = sys.argv[1:]
out = words[words.index("--usd") + 1] if "--usd" in words else None
if out:
    del words[words.index("--usd"):]
path = words[0]
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.context.scene.render.fps = 60
if path.endswith(".abc"):
    bpy.ops.wm.alembic_import(filepath=path, as_background_job=False)
elif path.endswith(".obj"):
    bpy.ops.wm.obj_import(filepath=path)
else:
    bpy.ops.wm.usd_import(filepath=path, import_guide=True)
if len(words) > 1:
    bpy.context.scene.frame_set(int(words[1]))
if out:
    bpy.ops.wm.usd_export(filepath=out)
graph = bpy.context.evaluated_depsgraph_get()
strands, objects = [], []
for found in bpy.context.scene.objects:
    if found.type == "MESH":
        objects.append({"name": found.name, "type": "MESH", "points": len(found.data.vertices),
                        "attributes": sorted(found.data.attributes.keys()),
                        "uvs": len(found.data.uv_layers) > 0, "materials": len(found.material_slots)})
    if found.type != "CURVES":
        continue
    shown = found.evaluated_get(graph)
    positions = [shown.matrix_world @ point.position for point in shown.data.points]
    radii = [point.radius for point in shown.data.points]
    objects.append({"name": found.name, "type": "CURVES", "strands": len(shown.data.curves), "points": len(positions),
                    "radius": [min(radii), max(radii)], "attributes": sorted(shown.data.attributes.keys()),
                    "materials": len(found.material_slots)})
    at = 0
    for curve in shown.data.curves:
        # Blender's Z is up: (x, z, -y) is what it is with Y up.
        strands.append([(p.x, p.z, -p.y) for p in positions[at:at + curve.points_length]])
        at += curve.points_length
print("CURVES" + json.dumps(strands))
print("OBJECTS" + json.dumps(objects))
