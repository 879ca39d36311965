# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import threading
import time
import unittest
from typing import Any

import numpy as np
from support import rows

import hairloom

DT = 1 / 60


class Engines(unittest.TestCase):
    def setUp(self) -> None:
        self.positions, self.offsets = rows(20)
        self.roots = np.ascontiguousarray(self.positions[self.offsets[:-1]])
        self.engine = self.make()

    def make(self, **settings: float) -> hairloom.Engine:
        engine = hairloom.Engine(self.positions, self.offsets, settings=settings)
        engine.reset(self.roots)
        return engine

    def test_it_starts_at_rest_and_falls(self) -> None:
        self.assertEqual((self.engine.strand_count, self.engine.point_count), (20, 160))
        np.testing.assert_allclose(self.engine.positions(), self.positions, atol=1e-6)
        turned = np.tile(np.array([0, 0, np.sin(np.pi / 4), np.cos(np.pi / 4)], np.float32), (20, 1))
        self.engine.reset(self.roots, turned)  # now they stand out sideways
        before = self.engine.positions()
        self.assertAlmostEqual(float(before[7, 0] - before[0, 0]), 0.07, places=4)
        for _ in range(30):
            self.engine.step(DT, self.roots, turned)
        self.assertLess(float(self.engine.positions()[7, 1]), float(before[7, 1]) - 0.001)
        self.assertAlmostEqual(self.engine.time, 0.5)
        lengths = np.linalg.norm(np.diff(self.engine.positions().reshape(20, 8, 3), axis=1), axis=2)
        np.testing.assert_allclose(lengths, 0.01, rtol=1e-3)

    def test_wind_spheres_and_settings(self) -> None:
        blown = self.make()
        for _ in range(60):
            blown.step(DT, self.roots, wind=(0, 0, 6))
        self.assertGreater(float(blown.positions()[7, 2]), 0.005)
        self.assertGreater(float(np.abs(blown.velocities()).max()), 0)
        ball = np.array([[0.1, 1.66, 0.02, 0.03]], np.float32)
        hit = self.make()
        for _ in range(60):
            hit.step(DT, self.roots, spheres=ball)
        self.assertLess(hit.measure()["max_penetration"], 1e-3)
        self.assertFalse(np.allclose(hit.positions(), self.positions, atol=1e-4))
        blown.set_settings({"gravity": [0, 0, 0]})
        with self.assertRaises(hairloom.Error):
            blown.set_settings({"gravity": 3})

    def test_stiffer_strands_move_less(self) -> None:
        factors = np.where(np.arange(20) < 10, 50, 1).astype(np.float32)
        blown, even = (hairloom.Engine(self.positions, self.offsets, stiffness=given) for given in (factors, None))
        for engine in (blown, even):
            engine.reset(self.roots)
            for _ in range(60):
                engine.step(DT, self.roots, wind=(0, 0, 6))
        moved = (blown.positions() - self.positions).reshape(20, 8, 3)
        without = (even.positions() - self.positions).reshape(20, 8, 3)
        self.assertLess(np.abs(moved[:10, -1]).max(), 0.5 * np.abs(without[:10, -1]).max())
        np.testing.assert_array_equal(moved[10:], without[10:])
        with self.assertRaisesRegex(hairloom.Error, "19 values of stiffness for 20 strands"):
            hairloom.Engine(self.positions, self.offsets, stiffness=factors[:19])
        factors[3] = -1
        with self.assertRaisesRegex(hairloom.Error, "stiffness of strand 3 is -1"):
            hairloom.Engine(self.positions, self.offsets, stiffness=factors)
        with self.assertRaises(hairloom.ArgumentError):
            hairloom.Engine(self.positions, self.offsets, stiffness=factors.astype(np.float64))

    def test_a_capsule_holds_what_its_spheres_miss(self) -> None:
        # A bar below the middles of the rows, whose ends are out of their reach.
        low, high = self.positions.min(axis=0), self.positions.max(axis=0)
        middle = (low + high) / 2
        ends = np.array([[-1, middle[1], middle[2] + 0.015, 0.02], [1, middle[1], middle[2] + 0.015, 0.02]], np.float32)

        def inside(engine: hairloom.Engine) -> float:
            points = engine.positions()
            return float(0.02 - np.hypot(points[:, 1] - middle[1], points[:, 2] - middle[2] - 0.015).min())

        missed, held = self.make(), self.make()
        for _ in range(60):
            missed.step(DT, self.roots, spheres=ends)
            held.step(DT, self.roots, spheres=ends, capsules=np.array([[0, 1]], np.uint32))
        self.assertGreater(inside(missed), 2e-3)
        self.assertLess(inside(held), 1e-3)

    def test_a_frame_of_quarters_is_its_four_quarter_frames(self) -> None:
        whole, quarters, ends = self.make(substeps=2), self.make(substeps=2), self.make(substeps=2)

        def swung(frame: int, quarter: int) -> np.ndarray[Any, Any]:
            shift = 0.05 * np.sin(9 * (frame + quarter / 4) / 30)
            return np.ascontiguousarray(self.roots + np.array([shift, 0, 0], np.float32))

        for frame in range(20):
            whole.step(1 / 30, swung(frame, 4), inner=[(swung(frame, q), None, None) for q in (1, 2, 3)])
            ends.step(1 / 30, swung(frame, 4))
            for q in (1, 2, 3, 4):
                quarters.step(1 / 120, swung(frame, q))
        self.assertEqual(whole.state_hash, quarters.state_hash)
        self.assertNotEqual(whole.state_hash, ends.state_hash)

    def test_a_cut_takes_the_hair_along(self) -> None:
        cut, whipped = self.make(), self.make()
        away = np.ascontiguousarray(self.roots + np.array([0.3, 0, 0], np.float32))
        cut.step(DT, away, cut=True)
        whipped.step(DT, away)
        still = self.make()
        still.step(DT, self.roots)
        shift = np.array([0.3, 0, 0], np.float32)
        np.testing.assert_allclose(cut.positions() - shift, still.positions(), atol=1e-5)
        self.assertGreater(float(np.abs(whipped.positions() - shift - still.positions()).max()), 0.01)

    def test_output_arrays_are_filled_in_place(self) -> None:
        out = np.zeros((160, 3), np.float32)
        self.assertIs(self.engine.positions(out), out)
        np.testing.assert_allclose(out, self.positions, atol=1e-6)
        frozen = np.zeros((160, 3), np.float32)
        frozen.flags.writeable = False
        for wrong in (
            np.zeros((160, 3)),
            np.zeros((159, 3), np.float32),
            np.zeros((320, 3), np.float32)[::2],
            np.zeros((160, 3), np.float32, order="F"),
            frozen,
            [0.0],
        ):
            with self.assertRaises(hairloom.ArgumentError):
                self.engine.positions(wrong)  # type: ignore[arg-type]

    def test_wrong_arguments(self) -> None:
        refused: list[dict[str, Any]] = [
            {"root_positions": self.roots.astype(np.float64)},
            {"root_positions": self.roots[:-1].copy()},
            {"root_positions": None},
            {"root_positions": self.roots, "root_rotations": np.zeros((20, 3), np.float32)},
            {"root_positions": self.roots, "spheres": np.array([[0, 0, 0, -1]], np.float32)},
            {"root_positions": self.roots, "capsules": np.array([[0, 1]], np.uint32)},
            {"root_positions": self.roots, "spheres": np.ones((2, 4), np.float32), "capsules": np.array([[0, 0]], np.uint32)},
            {"root_positions": self.roots, "spheres": np.ones((2, 4), np.float32), "capsules": np.array([[0, 2]], np.uint32)},
            {"root_positions": self.roots, "spheres": np.ones((2, 4), np.float32), "capsules": np.array([[0, 1]], np.int32)},
            {"root_positions": self.roots, "wind": (1e9, 0, 0)},
            {"root_positions": self.roots, "inner": 3},
            {"root_positions": self.roots, "inner": [self.roots]},
            {"root_positions": self.roots, "inner": [(self.roots, None, None)] * 16},
            {"root_positions": self.roots, "inner": [(self.roots[:-1].copy(), None, None)]},
            {"root_positions": self.roots, "inner": [(self.roots, None, np.ones((1, 4), np.float32))]},
            {"root_positions": self.roots, "dt": 0},
            {"root_positions": self.roots, "dt": float("nan")},
        ]
        before = self.engine.state_hash
        for arguments in refused:
            with self.assertRaises(hairloom.ArgumentError, msg=str(arguments)):
                self.engine.step(**{"dt": DT, **arguments})
        self.assertEqual(self.engine.state_hash, before)
        with self.assertRaises(hairloom.Error):
            hairloom.Engine(self.positions, np.arange(161, dtype=np.uint32))  # strands of one point
        with self.assertRaises(hairloom.Error):
            self.make(windSpeed=-1)
        with self.assertRaises(hairloom.Error):
            self.make(windSped=1)
        with self.assertRaises(hairloom.ArgumentError):
            hairloom.Engine(self.positions, self.offsets, masses=np.ones(3, np.float64))

    def test_threads_run_at_once_to_the_same_bits(self) -> None:
        strands, points = 2000, 16
        positions, offsets = rows(strands, points)
        roots = np.ascontiguousarray(positions[offsets[:-1]])

        def run(hashes: list[str]) -> None:
            engine = hairloom.Engine(positions, offsets)
            engine.reset(roots)
            for _ in range(20):
                engine.step(DT, roots, wind=(3, 0, 0))
            hashes.append(engine.state_hash)

        alone: list[str] = []
        run(alone)
        hashes: list[str] = []
        threads = [threading.Thread(target=run, args=(hashes,)) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(hashes, alone * 4)

    def test_steps_release_the_gil(self) -> None:
        positions, offsets = rows(60_000, 32)
        roots = np.ascontiguousarray(positions[offsets[:-1]])
        engine = hairloom.Engine(positions, offsets)
        engine.reset(roots)
        done = threading.Event()

        def step() -> None:
            steps = 0
            while steps < 5:
                try:
                    engine.step(DT, roots)
                    steps += 1
                except hairloom.BusyError:
                    pass
            done.set()

        thread = threading.Thread(target=step)
        thread.start()
        counted = busy = 0
        while not done.is_set():
            counted += 1
            try:
                engine.state_hash
            except hairloom.BusyError:
                busy += 1
            time.sleep(1e-4)
        thread.join()
        self.assertGreater(counted, 5)
        self.assertGreater(busy, 0)


if __name__ == "__main__":
    unittest.main()
