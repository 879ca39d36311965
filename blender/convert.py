# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's Curves as a hairloom.Groom, and back.

A Groom is in metres and has the axes of the Curves object (with Y up), so that an object that moves or turns stays the same
groom. Only its scale counts.
"""

from __future__ import annotations

import json
from collections.abc import Sequence

import bpy
import numpy as np

from .axes import to_y_up, to_z_up
from .module import Problem, hairloom

# How Blender keeps an attribute of a type: the property to read and write, scalars of an element, and their type.
STORAGE = {
    "FLOAT": ("value", 1, np.float32),
    "INT": ("value", 1, np.int32),
    "BOOLEAN": ("value", 1, np.bool_),
    "FLOAT_VECTOR": ("vector", 3, np.float32),
    "FLOAT_COLOR": ("color", 4, np.float32),
    "BYTE_COLOR": ("color", 4, np.float32),
    "QUATERNION": ("value", 4, np.float32),
    "FLOAT4X4": ("value", 16, np.float32),
    "INT8": ("value", 1, np.int32),
    "INT16_2D": ("value", 2, np.int32),
    "INT32_2D": ("value", 2, np.int32),
    "FLOAT2": ("vector", 2, np.float32),
    "FLOAT4": ("vector", 4, np.float32),
}
# Names that Hairloom gives a meaning, and their types there.
POINT_TYPES = {"radius": "FLOAT", "colour": "FLOAT_VECTOR", "dye": "FLOAT", "transparency": "FLOAT"}
CURVE_TYPES = {
    "root_uv": "FLOAT2",
    "id": "INT",
    "group": "INT",
    "layer": "INT",
    "guide": "BOOLEAN",
    "frozen": "BOOLEAN",
    "selected": "BOOLEAN",
    "hidden": "BOOLEAN",
    "colour": "FLOAT_VECTOR",
    "dye": "FLOAT",
    "melanin": "FLOAT",
    "stiffness": "FLOAT",
}
UNSIGNED = {"id", "group", "layer"}
# What the two call differently.
ATTACHMENT, ROOT_UV = "surface_uv_coordinate", "root_uv"
# An attribute of Blender whose name means something else to Hairloom travels behind this.
FOREIGN = "blender."
# What each of the two makes anew for itself.
NOT_SENT = {"position", "hairloom_rest"}
NOT_BROUGHT = {"position", "base_position", "root_triangle", "root_barycentric"}


def metres_per_unit(scene: bpy.types.Scene, obj: bpy.types.Object) -> np.ndarray:
    """Of the object's own axes. Exactly 1 for an object that is not scaled, so that nothing is rounded."""
    scale = np.array(obj.matrix_world.to_scale(), np.float64) * scene.unit_settings.scale_length
    scale[np.abs(scale - 1) < 1e-5] = 1
    if not np.all(np.isfinite(scale)) or np.min(np.abs(scale)) < 1e-9:
        raise Problem(f"'{obj.name}' has the scale {tuple(obj.matrix_world.to_scale())}: expected numbers other than 0")
    return scale.astype(np.float32)


def read(attribute: bpy.types.Attribute) -> np.ndarray:
    prop, width, kind = STORAGE[attribute.data_type]
    values = np.empty(len(attribute.data) * width, kind)
    attribute.data.foreach_get(prop, values)
    return values.reshape(-1, width) if width > 1 else values


def write(attribute: bpy.types.Attribute, values: np.ndarray) -> None:
    prop, _, kind = STORAGE[attribute.data_type]
    attribute.data.foreach_set(prop, np.ascontiguousarray(values, kind).ravel())


def positions_of(curves: bpy.types.Curves) -> np.ndarray:
    points = np.empty(len(curves.points) * 3, np.float32)
    curves.position_data.foreach_get("vector", points)
    return points.reshape(-1, 3)


def set_positions(curves: bpy.types.Curves, points: np.ndarray) -> None:
    curves.position_data.foreach_set("vector", np.ascontiguousarray(points, np.float32).ravel())


def offsets_of(curves: bpy.types.Curves) -> np.ndarray:
    offsets = np.zeros(len(curves.curves) + 1, np.int32)
    if len(offsets) > 1:
        curves.curve_offset_data.foreach_get("value", offsets)
    return offsets.view(np.uint32)


def checked(obj: bpy.types.Object | None) -> bpy.types.Curves:
    if obj is None or obj.type != "CURVES":
        raise Problem("There is no Curves object: select hair (Add > Curve > Empty Hair) first")
    curves = obj.data
    if len(curves.curves) == 0:
        raise Problem(f"'{obj.name}' has no curves: comb or add some first")
    sizes = np.diff(offsets_of(curves))
    if sizes.min() < 2:
        raise Problem(f"'{obj.name}' has a curve of {sizes.min()} point (curve {int(sizes.argmin())}): expected 2 or more")
    return curves


def surface_of(obj: bpy.types.Object, needed: bool = False) -> bpy.types.Object | None:
    surface = obj.data.surface
    if surface is not None and surface.type == "MESH" and len(surface.data.polygons) > 0:
        return surface
    if needed or surface is not None:
        raise Problem(
            f"'{obj.name}' has no surface: choose a mesh with faces at Data > Surface"
            if surface is None
            else f"The surface '{surface.name}' of '{obj.name}' is no mesh with faces"
        )
    return None


def mesh_arrays(mesh: bpy.types.Mesh) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Positions (n, 3), the vertex of each corner, and where each face starts."""
    points = np.empty(len(mesh.vertices) * 3, np.float32)
    mesh.attributes["position"].data.foreach_get("vector", points)
    corners = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    starts = np.full(len(mesh.polygons) + 1, len(mesh.loops), np.int32)
    mesh.polygons.foreach_get("loop_start", starts[:-1])
    return points.reshape(-1, 3), corners.view(np.uint32), starts.view(np.uint32)


def transformed(points: np.ndarray, matrix: Sequence[Sequence[float]]) -> np.ndarray:
    m = np.array(matrix, np.float64)
    if np.allclose(m, np.eye(4), atol=1e-9):
        return points
    return (points @ m[:3, :3].T + m[:3, 3]).astype(np.float32)


def uvs_of(mesh: bpy.types.Mesh, name: str) -> np.ndarray | None:
    layer = mesh.uv_layers.get(name) or mesh.uv_layers.active
    if layer is None:
        return None
    uvs = np.empty(len(mesh.loops) * 2, np.float32)
    layer.uv.foreach_get("vector", uvs)
    return uvs.reshape(-1, 2)


def is_ball(obj: bpy.types.Object) -> bool:
    return obj.type == "EMPTY" and obj.empty_display_type == "SPHERE"


def spheres_in(collection: bpy.types.Collection | None) -> list[bpy.types.Object]:
    if collection is None:
        return []
    return [one for one in collection.all_objects if is_ball(one)]


def capsules_between(balls: list[bpy.types.Object]) -> np.ndarray:
    """Pairs of numbers of those that are joined."""
    number = {ball.name: i for i, ball in enumerate(balls)}
    pairs = [(i, number[ball.hairloom_capsule.name]) for i, ball in enumerate(balls) if ball.hairloom_capsule and ball.hairloom_capsule.name in number]
    return np.array([pair for pair in pairs if pair[0] != pair[1]], np.uint32).reshape(-1, 2)


def _send_spheres(obj: bpy.types.Object, groom: hairloom.Groom, unit: np.ndarray, metres: float) -> None:
    into = obj.matrix_world.inverted()
    rows, balls = [], []
    for ball in spheres_in(obj.data.hairloom.colliders):
        radius = ball.empty_display_size * max(map(abs, ball.matrix_world.to_scale())) * metres
        centre = np.array([into @ ball.matrix_world.translation], np.float32) * unit
        if radius > 0:
            rows.append([*to_y_up(centre)[0], radius])
            balls.append(ball)
    if rows:
        groom.spheres = np.array(rows, np.float32)
        groom.capsules = capsules_between(balls)


def make_spheres(obj: bpy.types.Object, groom: hairloom.Groom) -> None:
    """The groom's spheres as empties that go with the surface, in a collection that becomes that of the colliders."""
    if len(groom.spheres) == 0:
        return
    collection = bpy.data.collections.new(f"{obj.name} colliders")
    for parent in obj.users_collection:
        parent.children.link(collection)
    balls = []
    for number, (centre, radius) in enumerate(zip(to_z_up(groom.spheres), groom.spheres[:, 3])):
        ball = bpy.data.objects.new(f"{obj.name} sphere {number + 1}", None)
        ball.empty_display_type, ball.empty_display_size = "SPHERE", float(radius)
        ball.location = centre
        ball.parent = obj.parent
        collection.objects.link(ball)
        balls.append(ball)
    for first, second in groom.capsules:
        balls[first].hairloom_capsule = balls[second]
    obj.data.hairloom.colliders = collection


def _type_there(name: str, on_points: bool) -> str | None:
    return (POINT_TYPES if on_points else CURVE_TYPES).get(name)


def _sent_name(attribute: bpy.types.Attribute) -> str:
    on_points = attribute.domain == "POINT"
    if not on_points and attribute.name == ATTACHMENT and attribute.data_type == "FLOAT2":
        return ROOT_UV
    expected = _type_there(attribute.name, on_points)
    clashes = (expected and expected != attribute.data_type) or attribute.name in NOT_BROUGHT | {ROOT_UV}
    return FOREIGN + attribute.name if clashes else attribute.name


def _send_attributes(curves: bpy.types.Curves, groom: hairloom.Groom, scale: float) -> list[str]:
    left = []
    for attribute in curves.attributes:
        if attribute.name in NOT_SENT:
            continue
        if attribute.data_type not in STORAGE or attribute.domain not in ("POINT", "CURVE"):
            left.append(attribute.name)
            continue
        name = _sent_name(attribute)
        values = read(attribute)
        into = groom.points if attribute.domain == "POINT" else groom.strands
        if name in UNSIGNED and attribute.domain == "CURVE":
            if name != "id" and values.min() < 0:
                raise Problem(f"The attribute '{name}' has the value {values.min()}: expected 0 or more")
            values = values.view(np.uint32)
        elif values.dtype == np.bool_:
            values = values.view(np.uint8)
        if name == "radius" and scale != 1:
            values = values * np.float32(scale)
        if values.dtype == np.float32 and not np.isfinite(values).all():
            raise Problem(f"The attribute '{attribute.name}' has a value that is not finite")
        if values.ndim == 1 or (values.dtype == np.float32 and values.shape[1] <= 4):
            into[name] = values
        else:  # of a type that Hairloom does not have, in pieces that it has
            step = 4 if values.dtype == np.float32 else 1
            for i in range(0, values.shape[1], step):
                piece = values[:, i : i + step] if step > 1 else values[:, i]
                into[f"{name}.{i // step}"] = np.ascontiguousarray(piece)
    return left


def _names(curves: bpy.types.Curves, key: str, attribute: str, word: str) -> list[str]:
    names = list(curves.get(key, []))
    values = curves.attributes.get(attribute)
    used = 0
    if values is not None and values.data_type == "INT" and values.domain == "CURVE":
        used = int(read(values).max(initial=-1)) + 1
    if used > 65536:
        raise Problem(f"The attribute '{attribute}' has the value {used - 1}: expected numbers of a {word.lower()}, from 0")
    return names + [f"{word} {i + 1}" for i in range(len(names), used)]


def to_groom(scene: bpy.types.Scene, obj: bpy.types.Object) -> tuple[hairloom.Groom, list[str]]:
    """The curves at rest, bound to their surface if they have one, and the attributes that could not go along."""
    curves = checked(obj)
    unit = metres_per_unit(scene, obj)
    rest = curves.attributes.get("hairloom_rest")  # while the hair is simulated
    points = read(rest) if rest is not None else positions_of(curves)
    if not np.isfinite(points).all():
        raise Problem(f"'{obj.name}' has a point that is not finite")
    groom = hairloom.Groom(to_y_up(points if np.all(unit == 1) else points * unit), offsets_of(curves))
    surface = surface_of(obj)
    if surface is not None:
        at, corners, starts = mesh_arrays(surface.data)
        between = obj.matrix_world.inverted() @ surface.matrix_world
        at = transformed(at, between)
        groom.set_scalp(to_y_up(at if np.all(unit == 1) else at * unit), corners, starts, uvs_of(surface.data, curves.surface_uv_map))
    _send_spheres(obj, groom, unit, scene.unit_settings.scale_length)
    if layers := _names(curves, "hairloom_layers", "layer", "Layer"):
        groom.layers = layers
    groom.groups = _names(curves, "hairloom_groups", "group", "Group")
    left = _send_attributes(curves, groom, float(np.cbrt(np.prod(np.abs(unit.astype(np.float64))))))
    if settings := curves.get("hairloom_settings"):
        groom.configure(json.loads(settings))
    return groom, left


def _default_type(name: str, values: np.ndarray, on_points: bool) -> str:
    known = _type_there(name, on_points)
    if known:
        return known
    if values.dtype == np.uint8:
        return "BOOLEAN" if values.max(initial=0) <= 1 else "INT"
    if values.dtype != np.float32:
        return "INT"
    return {1: "FLOAT", 2: "FLOAT2", 3: "FLOAT_VECTOR", 4: "FLOAT4"}[1 if values.ndim == 1 else values.shape[1]]


def _bring_attributes(curves: bpy.types.Curves, attributes: hairloom.Attributes, domain: str, scale: float, skipped: set[str]) -> None:
    on_points = domain == "POINT"
    before = {one.name: one.data_type for one in curves.attributes if one.domain == domain}
    pieces: dict[str, list[str]] = {}
    whole = []
    for name in attributes:
        stem, _, number = name.rpartition(".")
        plain = stem.removeprefix(FOREIGN)
        if number.isdigit() and before.get(plain) in ("FLOAT4X4", "INT16_2D", "INT32_2D"):
            pieces.setdefault(stem, []).append(name)
        elif name not in skipped:
            whole.append(name)
    brought = {name: attributes[name] for name in whole}
    for stem, names in pieces.items():
        columns = [attributes[name] for name in sorted(names, key=lambda one: int(one.rpartition(".")[2]))]
        brought[stem] = np.concatenate([one.reshape(len(one), -1) for one in columns], axis=1)
    for name, values in brought.items():
        there = name.removeprefix(FOREIGN)
        if name == ROOT_UV and not on_points:
            there = ATTACHMENT
        kind = before.get(there) or _default_type(name, values, on_points)
        if values.dtype == np.uint32:
            values = values.view(np.int32)
        width = STORAGE[kind][1]
        if (1 if values.ndim == 1 else values.shape[1]) != width:
            kind = _default_type(name, values, on_points)
            curves.attributes.remove(curves.attributes[there])
        if name == "radius" and scale != 1:
            values = values / np.float32(scale)
        attribute = curves.attributes.get(there)
        if attribute is not None and attribute.domain != domain:
            there = f"{there}_{domain.lower()}"
            attribute = curves.attributes.get(there)
        if attribute is None:
            attribute = curves.attributes.new(there, kind, domain)
            if attribute is None:
                raise Problem(f"Blender takes no attribute '{there}' of the type {kind}")
            there = attribute.name
        write(attribute, values)


def from_groom(scene: bpy.types.Scene, obj: bpy.types.Object, groom: hairloom.Groom) -> None:
    """Makes the curves of `obj` those of the groom. Materials, modifiers and attributes that the groom lacks stay."""
    curves = obj.data
    unit = metres_per_unit(scene, obj)
    sizes = np.diff(groom.offsets)
    if len(sizes) == 0:
        raise Problem("The project has no strands")
    if not np.array_equal(groom.offsets, offsets_of(curves)):
        if len(curves.curves):
            curves.remove_curves()
        curves.add_curves(sizes.tolist())
    points = to_z_up(groom.positions)
    set_positions(curves, points if np.all(unit == 1) else points / unit)
    scale = float(np.cbrt(np.prod(np.abs(unit.astype(np.float64)))))
    internal = {name for name in groom.points if name in NOT_BROUGHT or name.startswith("sculpt_")}
    _bring_attributes(curves, groom.points, "POINT", scale, internal)
    _bring_attributes(curves, groom.strands, "CURVE", 1, NOT_BROUGHT)
    curves["hairloom_layers"] = groom.layers
    if groom.groups:
        curves["hairloom_groups"] = groom.groups
    elif "hairloom_groups" in curves:
        del curves["hairloom_groups"]
    curves["hairloom_settings"] = json.dumps(groom.settings)
    curves.update_tag()


def make_surface(name: str, groom: hairloom.Groom) -> bpy.types.Mesh | None:
    """The groom's scalp as a mesh with the UV map 'UVMap'."""
    if groom.scalp_positions is None:
        return None
    mesh = bpy.data.meshes.new(name)
    points, triangles = to_z_up(groom.scalp_positions), groom.scalp_triangles
    mesh.vertices.add(len(points))
    mesh.attributes["position"].data.foreach_set("vector", points.ravel())
    mesh.loops.add(triangles.size)
    mesh.loops.foreach_set("vertex_index", triangles.ravel().view(np.int32))
    mesh.polygons.add(len(triangles))
    mesh.polygons.foreach_set("loop_start", np.arange(0, triangles.size, 3, dtype=np.int32))
    mesh.polygons.foreach_set("use_smooth", np.ones(len(triangles), np.bool_))
    uvs = groom.scalp_uvs
    if uvs is not None:
        mesh.uv_layers.new(name="UVMap").uv.foreach_set("vector", np.ascontiguousarray(uvs).ravel())
    mesh.update(calc_edges=True)
    return mesh
