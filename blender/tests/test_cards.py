# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import unittest

import bpy
import numpy as np
from support import InScene, message, world_points


class Cards(InScene):
    def test_cards_stand_where_the_hair_is(self) -> None:
        head = self.head()
        obj = self.hair(head, 150)
        head.location, head.rotation_euler = (0.4, -0.2, 1.2), (0, 0.3, 1)
        bpy.context.view_layer.update()
        self.assertEqual(bpy.ops.hairloom.cards(count=12, atlas="256"), {"FINISHED"})
        made = [one for one in bpy.data.collections["hair cards"].objects if one.type == "MESH"]
        shown = [one for one in made if not one.hide_render]
        self.assertGreater(len(made), 1)
        self.assertEqual(len(shown), 1)
        cards = shown[0]
        bpy.context.view_layer.update()
        m = np.array(cards.matrix_world)
        points = np.empty(len(cards.data.vertices) * 3, np.float32)
        cards.data.attributes["position"].data.foreach_get("vector", points)
        points = points.reshape(-1, 3) @ m[:3, :3].T + m[:3, 3]
        hair = world_points(obj)
        # Few cards are wide, but most of each stands where hair is.
        away = np.linalg.norm(points[:, None] - hair[None], axis=2).min(axis=1)
        self.assertLess(np.median(away), 0.015)
        np.testing.assert_allclose(m, np.array(obj.matrix_world), atol=1e-6)
        images = [node.image for node in cards.data.materials[0].node_tree.nodes if node.bl_idname == "ShaderNodeTexImage"]
        self.assertTrue(images)
        self.assertTrue(all(image.size[0] > 0 for image in images))
        self.assertIs(bpy.context.active_object, obj)

    def test_bad_input_is_told(self) -> None:
        self.assertIn("no Curves object", message(bpy.ops.hairloom.cards))
        self.hair(None)
        self.assertIn("has no surface", message(bpy.ops.hairloom.cards))


if __name__ == "__main__":
    unittest.main()
