# SPDX-License-Identifier: GPL-3.0-or-later
"""Hairloom in Blender: send hair to it and back, simulate, and make cards (docs/blender.md)."""

from __future__ import annotations

import bpy

from . import operators, panel, simulate
from .module import problem

_CLASSES = (*panel.CLASSES, *operators.CLASSES)


def register() -> None:
    for one in _CLASSES:
        bpy.utils.register_class(one)
    bpy.types.Curves.hairloom = bpy.props.PointerProperty(type=panel.HairloomCurves)
    bpy.types.Object.hairloom_capsule = panel.CAPSULE
    simulate.register()
    if wrong := problem():
        print(f"Hairloom: {wrong}")


def unregister() -> None:
    simulate.unregister()
    del bpy.types.Object.hairloom_capsule
    del bpy.types.Curves.hairloom
    for one in reversed(_CLASSES):
        bpy.utils.unregister_class(one)
