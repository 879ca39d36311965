# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, FloatVectorProperty, IntProperty, PointerProperty, StringProperty

from . import simulate
from .convert import is_ball
from .module import problem


class HairloomCurves(bpy.types.PropertyGroup):
    """What Hairloom keeps with hair, in the blend file."""

    project: StringProperty(name="Project", description="The Hairloom project of this hair", subtype="FILE_PATH")
    mode: EnumProperty(
        name="Mode",
        items=[
            ("OFF", "At Rest", "The hair is as it was groomed"),
            ("LIVE", "Live", "The hair is simulated as frames change"),
            ("CACHE", "Cached", "The hair is shown from a cache"),
        ],
        options={"HIDDEN"},
    )
    status: StringProperty(options={"HIDDEN", "SKIP_SAVE"})
    cache: StringProperty(name="Cache", description="File of baked frames", subtype="FILE_PATH")
    cache_start: IntProperty(options={"HIDDEN"})
    colliders: PointerProperty(
        name="Colliders", description="Closed meshes and empties of the display type Sphere that hair collides with", type=bpy.types.Collection
    )
    use_surface: BoolProperty(name="Collide with Surface", description="Keep hair out of the surface that it grows on", default=True)
    cell: FloatProperty(name="Detail", description="Finest millimetres between distances to colliders", default=4, min=0.5, max=50)
    wind: FloatVectorProperty(name="Wind", description="Metres a second in the world. All 0: as the project says", subtype="VELOCITY", size=3)
    pre_roll: IntProperty(name="Pre-roll", description="Frames that the hair settles before the first", min=0, max=1000)


# Of an empty of the type Sphere.
CAPSULE = PointerProperty(
    name="Capsule with",
    description="Hair collides with the hull of both spheres where both are colliders of it",
    type=bpy.types.Object,
    poll=lambda self, other: other != self and is_ball(other),
)


class HAIRLOOM_PT_hair(bpy.types.Panel):
    bl_label = "Hairloom"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Hairloom"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        if wrong := problem():
            layout.label(text=wrong, icon="ERROR")
            return
        obj = context.active_object
        if obj is not None and is_ball(obj):
            layout.prop(obj, "hairloom_capsule")
            return
        if obj is None or obj.type != "CURVES":
            layout.label(text="Select hair, or bring some in")
            layout.operator("hairloom.bring_back", text="Bring In…", icon="IMPORT")
            return
        own = obj.data.hairloom
        layout.prop(own, "project")
        row = layout.row(align=True)
        row.operator("hairloom.send", icon="EXPORT")
        row.operator("hairloom.bring_back", icon="IMPORT")
        layout.separator()
        column = layout.column()
        column.enabled = own.mode == "OFF"
        column.prop(obj.data, "surface")
        column.prop(own, "colliders")
        column.prop(own, "use_surface")
        column.prop(own, "cell")
        column.prop(own, "pre_roll")
        layout.prop(own, "wind")
        row = layout.row(align=True)
        if own.mode == "OFF":
            row.operator("hairloom.simulate", icon="PLAY")
        else:
            row.operator("hairloom.stop", icon="SNAP_FACE")
        row.operator("hairloom.bake", icon="FILE_CACHE")
        layout.prop(own, "cache")
        if own.status:
            layout.label(text=own.status, icon="ERROR")
        elif own.mode == "LIVE" and (stats := simulate.stats(obj)):
            layout.label(text=f"{stats['ms_per_frame']:.1f} ms per frame")
        layout.separator()
        layout.operator("hairloom.cards", icon="MESH_GRID")


CLASSES = (HairloomCurves, HAIRLOOM_PT_hair)
