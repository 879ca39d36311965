# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import time
import unittest

import bpy
import hairloom
import numpy as np
from support import TOP, InScene, message, points_of

RANDOM = np.random.default_rng(7)
# What foreach_get and foreach_set call the values of each type, how many there are, and what they hold.
TYPES = {
    "FLOAT": ("value", 1, lambda n: RANDOM.normal(size=n)),
    "INT": ("value", 1, lambda n: RANDOM.integers(-(2**31), 2**31 - 1, n)),
    "BOOLEAN": ("value", 1, lambda n: RANDOM.integers(0, 2, n)),
    "FLOAT_VECTOR": ("vector", 3, lambda n: RANDOM.normal(size=n)),
    "FLOAT_COLOR": ("color", 4, lambda n: RANDOM.random(n)),
    "BYTE_COLOR": ("color_srgb", 4, lambda n: RANDOM.integers(0, 256, n) / 255),
    "QUATERNION": ("value", 4, lambda n: RANDOM.normal(size=n)),
    "FLOAT4X4": ("value", 16, lambda n: RANDOM.normal(size=n)),
    "INT8": ("value", 1, lambda n: RANDOM.integers(-128, 128, n)),
    "INT16_2D": ("value", 2, lambda n: RANDOM.integers(-(2**15), 2**15, n)),
    "INT32_2D": ("value", 2, lambda n: RANDOM.integers(-(2**31), 2**31 - 1, n)),
    "FLOAT2": ("vector", 2, lambda n: RANDOM.normal(size=n)),
    "FLOAT4": ("vector", 4, lambda n: RANDOM.normal(size=n)),
}


def values(attribute) -> np.ndarray:
    prop, width, _ = TYPES[attribute.data_type]
    kind = np.int32 if "INT" in attribute.data_type else bool if attribute.data_type == "BOOLEAN" else np.float32
    found = np.empty(len(attribute.data) * width, kind)
    attribute.data.foreach_get(prop, found)
    return found


def snapshot(obj) -> dict:
    return {(one.name, one.domain, one.data_type): values(one) for one in obj.data.attributes if one.data_type in TYPES}


def fill(obj) -> None:
    """An attribute of each type of each domain, and those that mean something to either program."""
    for domain, count in (("POINT", len(obj.data.points)), ("CURVE", len(obj.data.curves))):
        for kind, (prop, width, make) in TYPES.items():
            attribute = obj.data.attributes.new(f"{kind.lower()}_of_{domain.lower()}", kind, domain)
            scalar = np.int32 if "INT" in kind or kind == "BOOLEAN" else np.float32
            attribute.data.foreach_set(prop, np.asarray(make(count * width), scalar))
    strands = len(obj.data.curves)
    for name, kind, data in (
        ("group", "INT", np.arange(strands) % 3),
        ("layer", "INT", np.arange(strands) % 2),
        ("guide", "BOOLEAN", np.arange(strands) % 5 == 0),
        ("id", "INT", np.arange(strands)[::-1].copy()),
        ("colour", "FLOAT_COLOR", RANDOM.random(strands * 4)),  # of another type than Hairloom's
        ("root_uv", "FLOAT2", RANDOM.random(strands * 2)),
        ("selected", "FLOAT", RANDOM.random(strands)),
    ):
        scalar = np.int32 if kind == "INT" else bool if kind == "BOOLEAN" else np.float32
        obj.data.attributes.new(name, kind, "CURVE").data.foreach_set(TYPES[kind][0], np.asarray(data, scalar))


class Exchange(InScene):
    def path(self) -> str:
        return str(self.folder / "hair.hairloom")

    def there_and_back(self, obj) -> float:
        began = time.perf_counter()
        self.assertEqual(bpy.ops.hairloom.send(filepath=self.path()), {"FINISHED"})
        middle = time.perf_counter()
        self.assertEqual(bpy.ops.hairloom.bring_back(), {"FINISHED"})
        self.times = (middle - began, time.perf_counter() - middle)
        return sum(self.times)

    def same(self, before: dict, after: dict) -> None:
        self.assertEqual(set(before), set(after))
        for key in before:
            np.testing.assert_array_equal(after[key].view(np.uint8), before[key].view(np.uint8), err_msg=str(key))

    def test_every_attribute_comes_back_with_its_bits(self) -> None:
        obj = self.hair(self.head())
        fill(obj)
        before = snapshot(obj)
        self.there_and_back(obj)
        self.same(before, snapshot(obj))
        self.assertEqual(list(obj.data["hairloom_layers"]), ["Layer 1", "Layer 2"])

    def test_11400_hairs_are_there_and_back_in_a_second(self) -> None:
        obj = self.hair(self.head(), 11_400)
        for name, kind, domain in (("density", "FLOAT", "CURVE"), ("tint", "FLOAT_COLOR", "POINT"), ("guide_curve_index", "INT", "CURVE")):
            attribute = obj.data.attributes.new(name, kind, domain)
            prop, width, make = TYPES[kind]
            attribute.data.foreach_set(prop, np.asarray(make(len(attribute.data) * width), np.int32 if kind == "INT" else np.float32))
        before = snapshot(obj)
        seconds = min(self.there_and_back(obj) for _ in range(3))
        print(f"11,400 x 16 there and back in {seconds:.3f} s (last: there {self.times[0]:.3f}, back {self.times[1]:.3f})")
        self.same(before, snapshot(obj))
        self.assertLess(seconds, 1)

    def test_the_project_is_what_blender_has(self) -> None:
        obj = self.hair(self.head())
        fill(obj)
        bpy.ops.hairloom.send(filepath=self.path())
        groom = hairloom.Groom.open(self.path())
        at = points_of(obj)
        np.testing.assert_array_equal(groom.positions, np.stack([at[:, 0], at[:, 2], -at[:, 1]], 1))
        np.testing.assert_array_equal(groom.points["radius"], values(obj.data.attributes["radius"]))
        uv = values(obj.data.attributes["surface_uv_coordinate"]).reshape(-1, 2)
        np.testing.assert_array_equal(groom.strands["root_uv"], uv)
        self.assertEqual(groom.guide_count, 12)
        self.assertEqual((groom.groups, groom.layers), (["Group 1", "Group 2", "Group 3"], ["Layer 1", "Layer 2"]))
        self.assertEqual(len(groom.scalp_positions), len(obj.data.surface.data.vertices))
        self.assertIn("root_triangle", groom.strands)
        self.assertFalse([one for one in groom.validate() if one["severity"] == "error"])

    def test_what_was_done_in_hairloom_comes_back(self) -> None:
        obj = self.hair(self.head())
        bpy.ops.hairloom.send(filepath=self.path())
        groom = hairloom.Groom.open(self.path())
        groom.apply("set_length", length=0.08)
        groom.apply("curl", radius=0.004)
        groom.save(self.path())
        bpy.ops.hairloom.bring_back()
        at = points_of(obj)
        expected = groom.positions
        np.testing.assert_array_equal(at, np.stack([expected[:, 0], -expected[:, 2], expected[:, 1]], 1))
        self.assertNotIn("base_position", obj.data.attributes)

    def test_other_strands_come_back(self) -> None:
        obj = self.hair(self.head())
        bpy.ops.hairloom.send(filepath=self.path())
        rows, offsets = np.zeros((9, 3), np.float32), np.array([0, 2, 5, 9], np.uint32)
        rows[:, 1] = np.arange(9) * 0.01
        hairloom.Groom(rows, offsets).save(self.path())
        bpy.ops.hairloom.bring_back()
        self.assertEqual([one.points_length for one in obj.data.curves], [2, 3, 4])
        np.testing.assert_array_equal(points_of(obj)[:, 2], rows[:, 1])

    def test_a_project_comes_with_its_scalp(self) -> None:
        from pathlib import Path

        bust = Path(hairloom.__file__).parent / "share" / "hairloom" / "samples" / "bust" / "bust.glb"
        if not bust.exists():  # in a build folder, not installed
            bust = Path(__file__).parents[2] / "samples" / "bust" / "bust.glb"
        hairloom.create(mesh=bust, scalp="material:scalp", count=200, length=0.2, output=self.path())
        bpy.ops.hairloom.bring_back(filepath=self.path())
        obj = bpy.context.active_object
        groom = hairloom.Groom.open(self.path())
        self.assertEqual(len(obj.data.curves), groom.strand_count)
        self.assertEqual(len(obj.data.surface.data.vertices), len(groom.scalp_positions))
        # Attachment names the root's place on the surface, as Blender's own tools find it.
        uv = values(obj.data.attributes["surface_uv_coordinate"])
        np.testing.assert_array_equal(uv.reshape(-1, 2), groom.strands["root_uv"])
        before = snapshot(obj)
        self.there_and_back(obj)
        self.same(before, snapshot(obj))

    def test_spheres_go_along_and_come_with_a_project(self) -> None:
        obj = self.hair(self.head())
        balls = bpy.data.collections.new("balls")
        bpy.context.scene.collection.children.link(balls)
        ball = bpy.data.objects.new("ball", None)
        ball.empty_display_type, ball.empty_display_size, ball.location = "SPHERE", 0.09, (0.1, 0.2, 1.9)
        balls.objects.link(ball)
        obj.data.hairloom.colliders = balls
        bpy.context.view_layer.update()
        bpy.ops.hairloom.send(filepath=self.path())
        np.testing.assert_allclose(hairloom.Groom.open(self.path()).spheres, [[0.1, 0.2, -0.2, 0.09]], atol=1e-6)
        bpy.context.view_layer.objects.active = None
        bpy.ops.hairloom.bring_back(filepath=self.path())
        (made,) = bpy.context.active_object.data.hairloom.colliders.objects
        self.assertAlmostEqual(made.empty_display_size, 0.09, places=6)
        np.testing.assert_allclose(made.location, (0.1, 0.2, 0.2), atol=1e-6)

    def test_capsules_go_along_and_come_with_a_project(self) -> None:
        obj = self.hair(self.head())
        balls = bpy.data.collections.new("balls")
        bpy.context.scene.collection.children.link(balls)
        made = []
        for number in range(3):
            ball = bpy.data.objects.new(f"ball {number}", None)
            ball.empty_display_type, ball.empty_display_size, ball.location = "SPHERE", 0.03, (0.1 * number, 0.3, 1.9)
            balls.objects.link(ball)
            made.append(ball)
        made[2].hairloom_capsule = made[0]
        obj.data.hairloom.colliders = balls
        bpy.context.view_layer.update()
        bpy.ops.hairloom.send(filepath=self.path())
        groom = hairloom.Groom.open(self.path())
        (pair,) = groom.capsules.tolist()
        self.assertEqual(sorted(round(float(groom.spheres[i, 0]), 3) for i in pair), [0, 0.2])
        bpy.context.view_layer.objects.active = None
        bpy.ops.hairloom.bring_back(filepath=self.path())
        joined = [one for one in bpy.context.active_object.data.hairloom.colliders.objects if one.hairloom_capsule]
        self.assertEqual(len(joined), 1)
        self.assertEqual(sorted(round(one.location.x, 3) for one in (joined[0], joined[0].hairloom_capsule)), [0, 0.2])

    def test_scale_and_units_become_metres(self) -> None:
        obj = self.hair(self.head())
        obj.parent.scale = (0.5, 0.5, 0.5)
        bpy.context.scene.unit_settings.scale_length = 0.01
        before = points_of(obj)
        bpy.ops.hairloom.send(filepath=self.path())
        groom = hairloom.Groom.open(self.path())
        np.testing.assert_allclose(groom.positions[:, 1], before[:, 2] * 0.005, rtol=1e-6)
        np.testing.assert_allclose(groom.scalp_positions.max(), 0.0005, rtol=1e-3)
        bpy.ops.hairloom.bring_back()
        np.testing.assert_allclose(points_of(obj), before, rtol=1e-6, atol=1e-9)

    def test_undo_takes_back_what_was_brought(self) -> None:
        obj = self.hair(self.head())
        bpy.ops.hairloom.send(filepath=self.path())
        groom = hairloom.Groom.open(self.path())
        groom.apply("set_length", length=0.05)
        groom.save(self.path())
        before = points_of(obj)
        bpy.ops.ed.undo_push(message="before")
        bpy.ops.hairloom.bring_back()
        self.assertFalse(np.array_equal(points_of(obj), before))
        bpy.ops.ed.undo_push(message="after")
        bpy.ops.ed.undo()
        np.testing.assert_array_equal(points_of(bpy.data.objects["hair"]), before)

    def test_bad_input_is_told_and_changes_nothing(self) -> None:
        self.assertIn("no Curves object", message(bpy.ops.hairloom.send, filepath=self.path()))
        head = self.head()
        self.assertIn("no Curves object", message(bpy.ops.hairloom.send, filepath=self.path()))
        self.assertIn("no file", message(bpy.ops.hairloom.bring_back))
        obj = self.hair(head)
        before = snapshot(obj)
        self.assertIn("missing.hairloom", message(bpy.ops.hairloom.bring_back, filepath=str(self.folder / "missing.hairloom")))
        (self.folder / "bad.hairloom").write_bytes(b"PK\x03\x04 no project")
        self.assertIn("bad.hairloom", message(bpy.ops.hairloom.bring_back, filepath=str(self.folder / "bad.hairloom")))
        self.assertIn("nowhere", message(bpy.ops.hairloom.send, filepath=str(self.folder / "nowhere" / "hair.hairloom")))
        self.same(before, snapshot(obj))
        points = points_of(obj)
        points[5, 1] = np.nan
        obj.data.position_data.foreach_set("vector", points.ravel())
        self.assertIn("not finite", message(bpy.ops.hairloom.send, filepath=self.path()))
        empty = bpy.data.objects.new("empty", bpy.data.hair_curves.new("empty"))
        bpy.context.scene.collection.objects.link(empty)
        bpy.context.view_layer.objects.active = empty
        self.assertIn("no curves", message(bpy.ops.hairloom.send, filepath=self.path()))
        empty.data.add_curves([3, 1])
        self.assertIn("curve of 1 point", message(bpy.ops.hairloom.send, filepath=self.path()))
        self.assertFalse((self.folder / "hair.hairloom").exists())

    def test_another_version_of_the_module_is_told(self) -> None:
        from importlib import metadata
        from unittest import mock

        self.hair(self.head())
        with mock.patch.object(metadata, "version", return_value="0.1.9"):
            for operator in (bpy.ops.hairloom.send, bpy.ops.hairloom.bring_back, bpy.ops.hairloom.simulate, bpy.ops.hairloom.cards):
                self.assertIn("has the version 0.1.9: expected 0.", message(operator))
        with mock.patch.dict("sys.modules", {"hairloom": None}):
            self.assertIn("cannot be loaded", message(bpy.ops.hairloom.send, filepath=self.path()))

    def test_the_extension_has_the_version_of_the_program(self) -> None:
        import re
        import tomllib

        manifest = tomllib.loads((TOP / "blender" / "blender_manifest.toml").read_text())
        (version,) = re.findall(r"project\(Hairloom VERSION ([0-9.]+)", (TOP / "CMakeLists.txt").read_text())
        self.assertEqual(manifest["version"], version)

    def test_curves_of_all_types_and_text_attributes(self) -> None:
        obj = self.hair(self.head())
        obj.data.set_types(type="POLY")
        obj.data.attributes.new("note", "STRING", "CURVE").data[2].value = b"cut"
        before = snapshot(obj)
        self.there_and_back(obj)
        self.same(before, snapshot(obj))
        self.assertEqual(obj.data.attributes["note"].data[2].value, b"cut")

    def test_a_layer_below_0_is_told(self) -> None:
        obj = self.hair(self.head())
        obj.data.attributes.new("layer", "INT", "CURVE").data[3].value = -1
        self.assertIn("'layer' has the value -1", message(bpy.ops.hairloom.send, filepath=self.path()))


if __name__ == "__main__":
    unittest.main()
