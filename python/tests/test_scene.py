# SPDX-License-Identifier: GPL-3.0-or-later
"""What a host tells of its scene: scalp, body, spheres, layers, and frames."""

from __future__ import annotations

import unittest

import numpy as np
from numpy.typing import NDArray
from support import rows

import hairloom

DT = 1 / 60


def box(low: tuple[float, float, float], high: tuple[float, float, float]) -> tuple[NDArray[np.float32], NDArray[np.uint32], NDArray[np.uint32]]:
    """A closed box of six quads, as positions, corners and offsets."""
    points = np.array([[(low, high)[i >> a & 1][a] for a in range(3)] for i in range(8)], np.float32)
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return points, np.array(quads, np.uint32).ravel(), np.arange(0, 25, 4, dtype=np.uint32)


BOX = box((-0.1, 1.7, -0.1), (0.3, 1.8, 0.1))


class Scenes(unittest.TestCase):
    def setUp(self) -> None:
        self.groom = hairloom.Groom(*rows(20))

    def test_a_scalp_binds_roots_where_they_are(self) -> None:
        before = self.groom.positions
        self.assertIsNone(self.groom.scalp_positions)
        uvs = np.zeros((24, 2), np.float32)
        uvs[:, 0] = BOX[0][BOX[1], 0]
        distances = self.groom.set_scalp(*BOX, uvs)
        self.assertLess(float(distances.max()), 1e-6)
        np.testing.assert_array_equal(self.groom.positions, before)
        np.testing.assert_allclose(self.groom.strands["root_uv"][:, 0], before[self.groom.offsets[:-1], 0], atol=1e-6)
        positions, triangles, corner_uvs = self.groom.scalp_positions, self.groom.scalp_triangles, self.groom.scalp_uvs
        assert positions is not None and triangles is not None and corner_uvs is not None
        self.assertEqual((positions.shape, triangles.shape, corner_uvs.shape), ((8, 3), (12, 3), (36, 2)))
        self.assertFalse([one for one in self.groom.validate() if one["severity"] == "error"])

    def test_a_scalp_that_is_none_is_told(self) -> None:
        points, corners, offsets = BOX
        for arguments, told in (
            ((points.astype(np.float64), corners, offsets), "float64"),
            ((points, corners.astype(np.int32), offsets), "int32"),
            ((points, corners, offsets[:-1]), "offsets"),
            ((points, corners + np.uint32(4), offsets), ""),
            ((points, corners[:0], np.zeros(1, np.uint32)), ""),
            ((points, corners, offsets, np.zeros((3, 2), np.float32)), "uvs"),
        ):
            with self.assertRaises(hairloom.Error) as caught:
                self.groom.set_scalp(*arguments)
            self.assertIn(told, str(caught.exception))
        self.assertIsNone(self.groom.scalp_positions)

    def test_layers_and_groups_have_names(self) -> None:
        self.groom.layers = ["top", "sides"]
        self.groom.groups = ["left", "right"]
        self.groom.strands["layer"] = np.arange(20, dtype=np.uint32) % 2
        self.groom.strands["group"] = np.arange(20, dtype=np.uint32) % 2
        self.assertEqual((self.groom.layers, self.groom.groups), (["top", "sides"], ["left", "right"]))
        with self.assertRaises(hairloom.Error):
            self.groom.layers = ["one"]
        with self.assertRaises(hairloom.Error):
            self.groom.groups = []
        self.assertEqual(self.groom.layers, ["top", "sides"])

    def test_a_live_simulation_follows_its_scalp(self) -> None:
        self.groom.set_scalp(*BOX)
        live = self.groom.live(scalp=BOX[0])
        np.testing.assert_allclose(live.positions(), self.groom.positions, atol=1e-6)
        roots = self.groom.positions[self.groom.offsets[:-1]]
        lag = 0.0
        for frame in range(1, 31):
            live.step(DT, scalp=BOX[0] + np.array([frame * 0.01, 0, 0], np.float32))
            tips = live.positions()[self.groom.offsets[1:] - 1]
            lag = max(lag, frame * 0.01 - float((tips - roots)[:, 0].mean()))
        self.assertGreater(lag, 0.005)
        np.testing.assert_allclose(live.positions()[self.groom.offsets[:-1]], roots + [0.3, 0, 0], atol=1e-5)
        self.assertAlmostEqual(live.time, 0.5)
        first = live.stats()["state_hash"]
        live.reset(scalp=BOX[0])
        for frame in range(1, 31):
            live.step(DT, scalp=BOX[0] + np.array([frame * 0.01, 0, 0], np.float32))
        self.assertEqual(live.stats()["state_hash"], first)

    def test_wind_and_settings_act_from_the_next_step(self) -> None:
        live = self.groom.live()
        live.set_settings({"gravity": [0, 0, 0]})
        for _ in range(30):
            live.step(DT, wind=(0, 0, 8))
        self.assertGreater(float(live.positions()[:, 2].max()), 0.01)
        with self.assertRaises(hairloom.Error):
            live.set_settings({"gravitation": 3})

    def test_a_body_with_bones_pushes_hair(self) -> None:
        # Two boxes beside the hair. The second is brought into it.
        first, second = box((-0.5, 1.5, -0.1), (-0.4, 1.7, 0.1)), box((0.05, 1.5, 0.3), (0.15, 1.69, 0.5))
        points = np.concatenate([first[0], second[0]])
        corners = np.concatenate([first[1], second[1] + np.uint32(8)])
        offsets = np.concatenate([first[2], second[2][1:] + np.uint32(24)])
        bones = np.zeros((16, 4), np.uint32)
        bones[8:] = 1
        weights = np.zeros((16, 4), np.float32)
        weights[:, 0] = 1
        report = self.groom.set_body(points, corners, offsets, bones.ravel(), weights, cell=0.004)
        self.assertLess(report["worst_gap"], 0.003)
        matrices = np.tile(np.eye(4, dtype=np.float32), (2, 1, 1))
        live = self.groom.live(bones=matrices.reshape(-1, 4))
        for frame in range(1, 61):
            matrices[1, 2, 3] = -0.3 * min(frame / 40, 1)
            live.step(DT, bones=matrices.reshape(-1, 4))
        points_now = live.positions()
        inside = (points_now > [0.055, 1.5, 0.005]).all(axis=1) & (points_now < [0.145, 1.685, 0.195]).all(axis=1)
        self.assertFalse(inside.any())
        self.assertLess(float(points_now[:, 2].min()), -0.001)  # pushed ahead of it

    def test_spheres_push_hair(self) -> None:
        live = self.groom.live(spheres=np.array([[0.1, 1.65, 0.5, 0.05]], np.float32))
        for frame in range(1, 61):
            live.step(DT, spheres=np.array([[0.1, 1.65, 0.5 - 0.45 * min(frame / 40, 1), 0.05]], np.float32))
        depth = 0.05 - np.linalg.norm(live.positions() - [0.1, 1.65, 0.05], axis=1)
        self.assertLess(float(depth.max()), 0.002)
        self.assertEqual(self.groom.spheres.shape, (0, 4))
        self.groom.spheres = np.array([[0, 1, 0, 0.1]], np.float32)
        self.assertEqual(self.groom.spheres.tolist(), [[0, 1, 0, np.float32(0.1)]])

    def test_a_scene_that_does_not_fit_is_told(self) -> None:
        eye = np.eye(4, dtype=np.float32)
        live = self.groom.live(head=eye)
        for change, told in (
            ({"scalp": BOX[0]}, "scalp"),
            ({"bones": eye}, "bones"),
            ({"head": eye * 2}, "rigid"),
            ({"head": eye[:3]}, "rows"),
            ({"spheres": np.array([[0, 0, 0, 0]], np.float32)}, "radius"),
            ({"wind": (0, 0, 1e6)}, "wind"),
        ):
            with self.assertRaises(hairloom.ArgumentError) as caught:
                live.step(DT, **change)
            self.assertIn(told, str(caught.exception))
        for dt in (0, -1, 0.2, float("nan")):
            with self.assertRaises(hairloom.ArgumentError):
                live.step(dt)
        self.groom.set_scalp(*BOX)
        with self.assertRaises(hairloom.ArgumentError):
            self.groom.live(scalp=BOX[0][:5])
        with self.assertRaises(hairloom.Error):
            self.groom.set_body(BOX[0], BOX[1][:4], np.array([0, 4], np.uint32))  # a sheet
        with self.assertRaises(hairloom.ArgumentError):
            self.groom.set_body(*BOX, bones=np.zeros(32, np.uint32))
        with self.assertRaises(hairloom.Error):
            self.groom.set_body(*BOX, np.zeros(32, np.uint32), np.full((8, 4), -1, np.float32))

    def test_a_refused_step_changes_no_spheres(self) -> None:
        hit, clear = self.groom.live(), self.groom.live()
        with self.assertRaises(hairloom.ArgumentError):
            hit.step(DT, spheres=np.array([[0.1, 1.65, 0, 0.03]], np.float32), wind=(0, 0, 1e6))
        for live in (hit, clear):
            live.step(DT)
        self.assertEqual(hit.stats()["state_hash"], clear.stats()["state_hash"])

    def test_empty_arrays_are_contiguous(self) -> None:
        live = self.groom.live()
        live.step(DT, spheres=np.array([], np.float32).reshape(-1, 4))
        self.groom.spheres = np.empty((0, 4), np.float32)


if __name__ == "__main__":
    unittest.main()
