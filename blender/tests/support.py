# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes of the tests. The extension is installed (./dev addon), or read from HAIRLOOM_ADDON, its folder."""

from __future__ import annotations

import os
import sys
import tempfile
import unittest
from pathlib import Path

import bpy  # before what it brings
import numpy as np

import addon_utils  # isort: skip

TOP = Path(__file__).parents[2]
INSTALLED = "bl_ext.user_default.hairloom"


def enable() -> str:
    """The name of the extension's package, which is on from here."""
    if not (folder := os.environ.get("HAIRLOOM_ADDON")):
        if not hasattr(bpy.types.Curves, "hairloom") and addon_utils.enable(INSTALLED, default_set=False, persistent=True) is None:
            raise RuntimeError("the extension is not installed")  # a skip would hide it
        return INSTALLED
    name = Path(folder).resolve().name
    if name not in sys.modules:
        sys.path.insert(0, str(Path(folder).resolve().parent))
        __import__(name).register()
    return name


def message(function, **options) -> str:
    """What an operator reports as an error."""
    try:
        answer = function(**options)
    except RuntimeError as error:  # how Blender hands on what an operator reports
        return str(error)
    raise AssertionError(f"no error, but {answer}")


class InScene(unittest.TestCase):
    """Each test has an empty scene and an empty folder."""

    def setUp(self) -> None:
        # Not read_factory_settings(), which turns extensions off: turning one on again unpacks its wheels in place, below modules
        # that are loaded.
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        enable()
        folder = tempfile.TemporaryDirectory(prefix="hairloom-blender-test-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        bpy.context.scene.render.fps = 24
        bpy.context.scene.frame_start, bpy.context.scene.frame_end = 1, 24

    def head(self, name: str = "head", radius: float = 0.1, segments: int = 48) -> bpy.types.Object:
        """A ball with UVs, 1.7 m above the ground."""
        bpy.ops.mesh.primitive_uv_sphere_add(segments=segments, ring_count=segments // 2, radius=radius, location=(0, 0, 1.7), calc_uvs=True)
        head = bpy.context.active_object
        head.name = name
        return head

    def hair(self, head: bpy.types.Object | None, strands: int = 60, points: int = 16, length: float = 0.15) -> bpy.types.Object:
        """Straight hair on the upper half of a head, with radius and attachment."""
        curves = bpy.data.hair_curves.new("hair")
        curves.add_curves([points] * strands)
        obj = bpy.data.objects.new("hair", curves)
        bpy.context.scene.collection.objects.link(obj)
        turn = np.arange(strands) * 2.399963
        up = 0.95 - 0.85 * (np.arange(strands) + 0.5) / strands
        out = np.stack([np.cos(turn) * np.sqrt(1 - up**2), np.sin(turn) * np.sqrt(1 - up**2), up], 1)
        along = 0.1 + length * np.linspace(0, 1, points)
        at = (out[:, None, :] * along[None, :, None]).astype(np.float32)
        curves.position_data.foreach_set("vector", at.ravel())
        curves.attributes.new("radius", "FLOAT", "POINT").data.foreach_set("value", np.linspace(4e-5, 1e-5, points * strands, dtype=np.float32))
        if head is not None:
            obj.parent = head
            curves.surface, curves.surface_uv_map = head, "UVMap"
            uv = np.stack([turn / (2 * np.pi) % 1, np.arccos(up) / np.pi], 1).astype(np.float32)
            curves.attributes.new("surface_uv_coordinate", "FLOAT2", "CURVE").data.foreach_set("vector", uv.ravel())
        bpy.context.view_layer.objects.active = obj
        obj.select_set(True)
        bpy.context.view_layer.update()
        return obj


def points_of(obj: bpy.types.Object) -> np.ndarray:
    points = np.empty(len(obj.data.points) * 3, np.float32)
    obj.data.position_data.foreach_get("vector", points)
    return points.reshape(-1, 3)


def world_points(obj: bpy.types.Object) -> np.ndarray:
    m = np.array(obj.matrix_world)
    return points_of(obj) @ m[:3, :3].T + m[:3, 3]
