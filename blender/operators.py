# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import os
import tempfile
import time
from pathlib import Path
from typing import Any

import bpy
from bpy.props import BoolProperty, EnumProperty, IntProperty, StringProperty
from mathutils import Matrix

from . import convert, simulate
from .cache import Writer
from .module import Problem, hairloom, problem


def _object(context: bpy.types.Context) -> bpy.types.Object:
    obj = context.active_object
    convert.checked(obj)
    return obj


class _Operator(bpy.types.Operator):
    """Reports what is wrong, and leaves everything as it was."""

    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        if wrong := problem():
            self.report({"ERROR"}, wrong)
            return {"CANCELLED"}
        try:
            self.work(context)
        except (Problem, hairloom.Error, OSError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}

    def work(self, context: bpy.types.Context) -> None:
        raise NotImplementedError

    def warn_left(self, left: list[str]) -> None:
        if left:
            self.report({"WARNING"}, f"Left behind, of types that Hairloom does not have: {', '.join(left)}")


def _project_path(obj: bpy.types.Object) -> str:
    if obj.data.hairloom.project:
        return bpy.path.abspath(obj.data.hairloom.project)
    folder = bpy.path.abspath("//") if bpy.data.filepath else bpy.app.tempdir
    return os.path.join(folder, bpy.path.clean_name(obj.name) + ".hairloom")


class HAIRLOOM_OT_send(_Operator):
    """Save the curves with surface and attributes as a Hairloom project, and open it in Hairloom"""

    bl_idname = "hairloom.send"
    bl_label = "Send to Hairloom"

    filepath: StringProperty(name="Project", description="File to write. Empty: beside the blend file", subtype="FILE_PATH")
    show: BoolProperty(name="Open Hairloom", description="Open the project in Hairloom, if it is installed", default=True)

    def work(self, context: bpy.types.Context) -> None:
        obj = _object(context)
        context.view_layer.update()
        path = bpy.path.abspath(self.filepath) if self.filepath else _project_path(obj)
        groom, left = convert.to_groom(context.scene, obj)
        groom.save(path)
        obj.data.hairloom.project = path
        self.warn_left(left)
        self.report({"INFO"}, f"{groom.strand_count} strands are in {path}")
        if self.show and not bpy.app.background:
            try:
                hairloom.show(path)
            except hairloom.Error as error:
                self.report({"WARNING"}, f"The project is saved, but Hairloom cannot be opened: {error}")


class HAIRLOOM_OT_bring_back(_Operator):
    """Replace the active hair by a Hairloom project, or add it with its scalp where no hair is active"""

    bl_idname = "hairloom.bring_back"
    bl_label = "Bring Back"

    filepath: StringProperty(
        name="Project", description="Project, or any hair file that Hairloom reads. Empty: that which was sent", subtype="FILE_PATH"
    )
    filter_glob: StringProperty(default="*.hairloom;*.abc;*.usd;*.usda;*.usdc;*.hair;*.obj;*.ply;*.tfx", options={"HIDDEN"})

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        obj = context.active_object
        if self.filepath or (obj is not None and obj.type == "CURVES" and obj.data.hairloom.project):
            return self.execute(context)
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def work(self, context: bpy.types.Context) -> None:
        obj = context.active_object
        if obj is not None and obj.type != "CURVES":
            obj = None
        if obj is None and not self.filepath:
            raise Problem("There is no Curves object whose project could be brought back, and no file is given")
        path = bpy.path.abspath(self.filepath) if self.filepath else _project_path(obj)
        groom = hairloom.Groom.open(path)
        if groom.strand_count == 0:
            raise Problem(f"{path} has no strands")
        context.view_layer.update()
        if obj is None:
            obj = self._new(context, Path(path).stem, groom)
        elif obj.data.hairloom.mode != "OFF":
            simulate.stop(obj)  # a cache of other hair says nothing of this one
        convert.from_groom(context.scene, obj, groom)
        obj.data.hairloom.project = path
        self.report({"INFO"}, f"{groom.strand_count} strands are back from {path}")

    @staticmethod
    def _new(context: bpy.types.Context, name: str, groom: Any) -> bpy.types.Object:
        obj = bpy.data.objects.new(name, bpy.data.hair_curves.new(name))
        context.collection.objects.link(obj)
        mesh = convert.make_surface(f"{name} surface", groom)
        if mesh is not None:
            surface = bpy.data.objects.new(mesh.name, mesh)
            context.collection.objects.link(surface)
            obj.parent = surface
            obj.data.surface = surface
            obj.data.surface_uv_map = mesh.uv_layers[0].name if mesh.uv_layers else ""
        convert.make_spheres(obj, groom)
        if context.active_object is not None:
            context.active_object.select_set(False)
        context.view_layer.objects.active = obj
        obj.select_set(True)
        return obj


class HAIRLOOM_OT_simulate(_Operator):
    """Let the hair follow surface, armature and colliders from this frame on, as frames change"""

    bl_idname = "hairloom.simulate"
    bl_label = "Simulate"

    def work(self, context: bpy.types.Context) -> None:
        obj = _object(context)
        context.view_layer.update()
        convert.surface_of(obj, needed=True)
        simulate.start(context.scene, obj, context.evaluated_depsgraph_get())


class HAIRLOOM_OT_stop(_Operator):
    """Put the hair back to rest"""

    bl_idname = "hairloom.stop"
    bl_label = "Stop"

    def work(self, context: bpy.types.Context) -> None:
        simulate.stop(_object(context))


class HAIRLOOM_OT_bake(_Operator):
    """Simulate all frames of the scene into a file, and show the hair from there"""

    bl_idname = "hairloom.bake"
    bl_label = "Bake to Cache"

    filepath: StringProperty(name="Cache", description="File to write. Empty: beside the blend file", subtype="FILE_PATH")

    def work(self, context: bpy.types.Context) -> None:
        obj, scene, own = _object(context), context.scene, context.active_object.data.hairloom
        path = self.filepath or own.cache
        if not path:
            folder = "//hairloom_cache" if bpy.data.filepath else os.path.join(bpy.app.tempdir, "hairloom_cache")
            path = os.path.join(folder, bpy.path.clean_name(obj.name) + ".npy")
        convert.surface_of(obj, needed=True)
        before, mode = scene.frame_current, own.mode
        simulate.stop(obj)
        frames = range(scene.frame_start, scene.frame_end + 1)
        writer = Writer(Path(bpy.path.abspath(path)), len(frames), len(obj.data.points))
        wm = context.window_manager
        wm.progress_begin(0, len(frames))
        began = time.perf_counter()
        try:
            scene.frame_set(frames[0])
            simulate.start(scene, obj, context.evaluated_depsgraph_get())
            for index, frame in enumerate(frames):
                scene.frame_set(frame)
                if own.mode != "LIVE":
                    raise Problem(f"Frame {frame}: {own.status}")
                writer.add(index, obj)
                wm.progress_update(index)
            writer.finish()
        except BaseException:
            writer.discard()
            simulate.stop(obj)
            if mode == "LIVE":
                simulate.start(scene, obj, context.evaluated_depsgraph_get())
            scene.frame_set(before)
            raise
        finally:
            wm.progress_end()
        seconds = time.perf_counter() - began
        own.cache, own.cache_start, own.mode = path, frames[0], "CACHE"
        scene.frame_set(before)
        self.report({"INFO"}, f"{len(frames)} frames in {seconds:.1f} s are in {path}")


class HAIRLOOM_OT_cards(_Operator):
    """Make cards with textures from the hair, as meshes beside it"""

    bl_idname = "hairloom.cards"
    bl_label = "Cards"

    count: IntProperty(name="Cards", description="Most cards in the nearest level", default=64, min=1, max=4096)
    segments: IntProperty(name="Segments", description="Most segments of a card", default=8, min=1, max=24)
    atlas: EnumProperty(
        name="Atlas",
        description="Width of the largest texture, in texels",
        items=[(str(size), str(size), "") for size in (256, 512, 1024, 2048, 4096)],
        default="1024",
    )

    def work(self, context: bpy.types.Context) -> None:
        obj = _object(context)
        context.view_layer.update()
        convert.surface_of(obj, needed=True)
        groom, _ = convert.to_groom(context.scene, obj)
        before = set(bpy.data.objects)
        with tempfile.TemporaryDirectory(prefix="hairloom-cards-") as folder:
            file = os.path.join(folder, "cards.glb")
            hairloom.export(groom, format="gltf", cards=self.count, segments=self.segments, atlas=int(self.atlas), output=file)
            bpy.ops.import_scene.gltf(filepath=file, disable_bone_shape=True)
        made = [one for one in bpy.data.objects if one not in before]
        self._place(context, obj, made)
        context.view_layer.objects.active = obj
        obj.select_set(True)
        levels = [one.name for one in made if one.type == "MESH"]
        self.report({"INFO"}, f"Cards of '{obj.name}': {', '.join(levels)}")

    @staticmethod
    def _place(context: bpy.types.Context, obj: bpy.types.Object, made: list[bpy.types.Object]) -> None:
        """Under the hair, in a collection, with the nearest level shown."""
        collection = bpy.data.collections.new(f"{obj.name} cards")
        context.scene.collection.children.link(collection)
        back = Matrix.Diagonal((*(1 / convert.metres_per_unit(context.scene, obj)).tolist(), 1))
        for one in made:
            for other in list(one.users_collection):
                other.objects.unlink(one)
            collection.objects.link(one)
            one.select_set(False)
            if one.parent is None:
                one.parent = obj
                one.matrix_basis = back @ one.matrix_basis
        levels = [one for one in made if one.type == "MESH"]
        nearest = max(levels, key=lambda one: len(one.data.polygons) if one.name.startswith("cards") else 0)
        for one in levels:
            one.hide_render = one is not nearest
            one.hide_set(one is not nearest)


CLASSES = (HAIRLOOM_OT_send, HAIRLOOM_OT_bring_back, HAIRLOOM_OT_simulate, HAIRLOOM_OT_stop, HAIRLOOM_OT_bake, HAIRLOOM_OT_cards)
