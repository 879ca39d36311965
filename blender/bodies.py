# SPDX-License-Identifier: GPL-3.0-or-later
"""What hair collides with: the surface with its armature, and meshes of the collection of colliders."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np

from .axes import to_y_up_metres
from .convert import mesh_arrays
from .module import Problem, hairloom

MOST_BONES = 255


class Bodies:
    def __init__(self, metres: float) -> None:
        self.metres = metres
        self.points: list[np.ndarray] = []
        self.corners: list[np.ndarray] = []
        self.starts: list[np.ndarray] = []
        self.bones: list[np.ndarray] = []
        self.weights: list[np.ndarray] = []
        # What moves rigidly: an object and, of an armature, a bone, from the world at rest to its own space, and the mesh that
        # it moves. Objects by their names, since undo replaces them.
        self.movers: list[tuple[str, str | None, np.ndarray, str]] = []

    @classmethod
    def of(cls, scene: bpy.types.Scene, obj: bpy.types.Object, surface: bpy.types.Object | None, metres: float) -> Bodies:
        bodies = cls(metres)
        own = obj.data.hairloom
        meshes = [one for one in own.colliders.all_objects if one.type == "MESH" and one != surface] if own.colliders else []
        if surface is not None and own.use_surface:
            bodies._add(surface, metres)
        for mesh in meshes:
            if len(mesh.data.polygons) == 0:
                raise Problem(f"The collider '{mesh.name}' has no faces")
            bodies._add(mesh, metres)
        if len(bodies.movers) > MOST_BONES:
            raise Problem(f"{len(bodies.movers)} bones and colliders move the hair: expected {MOST_BONES} at most")
        return bodies

    def _add(self, mesh: bpy.types.Object, metres: float) -> None:
        points, corners, starts = mesh_arrays(mesh.data)
        world = to_y_up_metres(mesh.matrix_world, metres)
        vertices = sum(map(len, self.points))
        self.starts.append(starts[1:] + np.uint32(sum(map(len, self.corners))))
        self.corners.append(corners + np.uint32(vertices))
        self.points.append((points @ world[:3, :3].T + world[:3, 3]).astype(np.float32))
        bones = np.full((len(points), 4), len(self.movers), np.uint32)
        weights = np.zeros((len(points), 4), np.float32)
        weights[:, 0] = 1
        armature = armature_of(mesh)
        # What no bone moves goes with the object itself.
        self.movers.append((mesh.name, None, np.linalg.inv(world), mesh.name))
        if armature is not None:
            self._skin(mesh, armature, bones, weights)
        self.bones.append(bones)
        self.weights.append(weights)

    def _skin(self, mesh: bpy.types.Object, armature: bpy.types.Object, bones: np.ndarray, weights: np.ndarray) -> None:
        """The four strongest bones of each vertex."""
        number: dict[int, int] = {}
        for group in mesh.vertex_groups:
            bone = armature.data.bones.get(group.name)
            if bone is not None and bone.use_deform:
                number[group.index] = len(self.movers)
                # The armature moves a mesh from where the mesh is now: both objects at rest, bones at rest.
                rest = np.linalg.inv(np.array(bone.matrix_local)) @ np.linalg.inv(np.array(armature.matrix_world)) @ np.array(mesh.matrix_world)
                self.movers.append((armature.name, group.name, rest @ np.linalg.inv(to_y_up_metres(mesh.matrix_world, self.metres)), mesh.name))
        for vertex in mesh.data.vertices:
            own = sorted(((one.weight, number[one.group]) for one in vertex.groups if one.group in number and one.weight > 0), reverse=True)[:4]
            total = sum(weight for weight, _ in own)
            if total <= 0:
                continue
            weights[vertex.index] = 0
            for i, (weight, bone) in enumerate(own):
                weights[vertex.index, i] = weight / total
                bones[vertex.index, i] = bone

    def bake(self, groom: Any, cell: float) -> None:
        if not self.points:
            return
        starts = np.concatenate([np.zeros(1, np.uint32), *self.starts])
        try:
            groom.set_body(
                np.concatenate(self.points),
                np.concatenate(self.corners),
                starts,
                np.concatenate(self.bones).ravel(),
                np.concatenate(self.weights),
                cell=cell,
            )
        except hairloom.Error as error:
            names = ", ".join(dict.fromkeys(name for _, _, _, name in self.movers))
            raise Problem(f"Hair cannot collide with {names}: {error}") from None

    def matrices(self, graph: bpy.types.Depsgraph) -> np.ndarray | None:
        """Where each mover is, from rest to the world, in metres, Y up: (4 · count, 4)."""
        if not self.movers:
            return None
        found: dict[str, Any] = {}

        def evaluated(name: str) -> Any:
            if name not in found:
                obj = bpy.data.objects.get(name)
                if obj is None:
                    raise Problem(f"'{name}', which the hair collides with, is gone: start the simulation again")
                found[name] = obj.evaluated_get(graph)
            return found[name]

        rows = np.empty((len(self.movers), 4, 4), np.float64)
        for i, (name, bone, rest, _) in enumerate(self.movers):
            now = evaluated(name)
            place = now.matrix_world if bone is None else now.matrix_world @ now.pose.bones[bone].matrix
            rows[i] = to_y_up_metres(place, self.metres) @ rest
        return rows.reshape(-1, 4).astype(np.float32)


def armature_of(mesh: bpy.types.Object) -> bpy.types.Object | None:
    for modifier in mesh.modifiers:
        if modifier.type == "ARMATURE" and modifier.object is not None and modifier.show_viewport:
            return modifier.object
    return mesh.parent if mesh.parent is not None and mesh.parent.type == "ARMATURE" and mesh.parent_type == "ARMATURE" else None
