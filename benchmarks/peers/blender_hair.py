# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's Hair Dynamics (experimental): rods by position based dynamics, a node group of Blender's own assets."""
import math
import os
import time

import bpy
import numpy

import scene

UV_CELLS = 20  # across and down: each root has a triangle of its own in the texture


def to_blender(points):
    """Z up there."""
    return numpy.stack([points[..., 0], -points[..., 2], points[..., 1]], axis=-1)


def from_blender(points):
    return numpy.stack([points[..., 0], points[..., 2], -points[..., 1]], axis=-1)


def root_uv(strand):
    return strand % UV_CELLS / UV_CELLS, strand // UV_CELLS / UV_CELLS


def make_scalp(rest):
    """A small triangle under each root."""
    mesh = bpy.data.meshes.new("scalp")
    corners = to_blender(rest[:, :1]) + numpy.array([[-1, -1, 0], [2, -1, 0], [-1, 2, 0]]) * 1e-3
    mesh.from_pydata(corners.reshape(-1, 3).tolist(), [], numpy.arange(3 * len(rest)).reshape(-1, 3).tolist())
    texture = mesh.uv_layers.new(name="UVMap")
    for s in range(len(rest)):
        u, v = root_uv(s)
        for k, corner in enumerate([(u, v), (u + 0.03, v), (u, v + 0.03)]):
            texture.data[3 * s + k].uv = corner
    return bpy.data.objects.new("scalp", mesh)


def make_hair(rest, scalp):
    curves = bpy.data.hair_curves.new("hair")
    curves.add_curves([rest.shape[1]] * len(rest))
    curves.attributes["position"].data.foreach_set("vector", to_blender(rest).astype(numpy.float32).reshape(-1))
    uv = curves.attributes.new("surface_uv_coordinate", "FLOAT2", "CURVE")
    for s in range(len(rest)):
        uv.data[s].vector = [x + 0.01 for x in root_uv(s)]
    curves.surface, curves.surface_uv_map = scalp, "UVMap"
    hair = bpy.data.objects.new("hair", curves)
    hair.parent = scalp
    return hair


def turn(scalp, frames):
    for frame in range(frames + 1):
        scalp.rotation_euler = 0, 0, scene.angle(frame / scene.FPS)
        scalp.keyframe_insert("rotation_euler", index=2, frame=frame)
    for curve in scalp.animation_data.action.layers[0].strips[0].channelbags[0].fcurves:
        for key in curve.keyframe_points:
            key.interpolation = "LINEAR"


def bendiness(rest):
    """Their softness b stands for a beam whose tip would sink by tan(b π/2) of its length, as small bending has it: g L³/(8 B)."""
    length = numpy.linalg.norm(numpy.diff(rest[0], axis=0), axis=1).sum()
    return 2 / math.pi * math.atan(scene.GRAVITY * length**3 / (8 * scene.BENDING))


def build(rest, setting, damping, turning, frames):
    bpy.ops.wm.read_factory_settings(use_empty=True)  # a node group keeps what it has simulated: every run is a new scene
    assets = os.path.join(bpy.utils.system_resource("DATAFILES"), "assets", "nodes", "geometry_nodes_dynamics_assets.blend")
    with bpy.data.libraries.load(assets) as (_, wanted):
        wanted.node_groups = ["Hair Dynamics"]
    now = bpy.context.scene
    now.render.fps, now.frame_start, now.frame_end = scene.FPS, 0, frames
    scalp = make_scalp(rest)
    hair = make_hair(rest, scalp)
    now.collection.objects.link(scalp)
    now.collection.objects.link(hair)
    if turning:
        turn(scalp, frames)
    group = bpy.data.node_groups["Hair Dynamics"]
    modifier = hair.modifiers.new("dynamics", "NODES")
    modifier.node_group = group
    wanted = {"Mode": "Physics (Experimental)", "Substeps": setting[0], "Constraint Steps": setting[1], "Stretchiness": 0.0,
              "Bendiness": bendiness(rest), "Root Bendiness": 0.0, "Linear": damping, "Angular": 0.0}
    for item in group.interface.items_tree:
        if item.item_type == "SOCKET" and item.in_out == "INPUT" and item.name in wanted:
            getattr(modifier.properties.inputs, item.identifier).value = wanted.pop(item.name)
    if wanted:
        raise RuntimeError(f"Hair Dynamics has no {', '.join(wanted)}")
    return now, hair


def simulate(rest, setting, damping, turning, frames):
    now, hair = build(rest, setting, damping, turning, frames)
    positions, flat = numpy.empty((frames, *rest.shape)), numpy.empty(rest.size, numpy.float32)
    now.frame_set(0)
    seconds = 0.0
    for frame in range(1, frames + 1):
        before = time.process_time()
        now.frame_set(frame)
        shown = hair.evaluated_get(bpy.context.evaluated_depsgraph_get())
        seconds += time.process_time() - before
        shown.data.attributes["position"].data.foreach_get("vector", flat)
        place = numpy.array(shown.matrix_world)
        positions[frame - 1] = from_blender(flat.reshape(rest.shape) @ place[:3, :3].T + place[:3, 3])
    return positions, seconds


if __name__ == "__main__":
    ladder = [(1, 1), (8, 1), (10, 5), (10, 15), (10, 30), (20, 30), (10, 100)]
    # More of either loses it to single precision.
    scene.measure("Blender", bpy.app.version_string.split()[0], {f"{a} substep{'s' if a > 1 else ''} × {b}": (a, b) for a, b in ladder},
                  ("20 substeps × 300", (20, 300)), ("10 substeps × 300", (10, 300)), simulate, timed_frames=30)
