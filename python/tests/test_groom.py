# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import copy
import gc
import json
import threading
import time
import unittest
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from support import InFolder, rows

import hairloom


class Arrays(unittest.TestCase):
    def setUp(self) -> None:
        self.positions, self.offsets = rows(5)
        self.groom = hairloom.Groom(self.positions, self.offsets)

    def test_views_have_the_values_and_share_memory(self) -> None:
        np.testing.assert_array_equal(self.groom.positions, self.positions)
        np.testing.assert_array_equal(self.groom.offsets, self.offsets)
        self.assertTrue(np.shares_memory(self.groom.positions, self.groom.positions))
        self.assertTrue(np.shares_memory(self.groom.positions, self.groom.points["position"]))
        self.assertTrue(np.shares_memory(self.groom.positions, self.groom.copy().positions))
        self.assertEqual((len(self.groom), self.groom.point_count, self.groom.guide_count), (5, 40, 5))

    def test_a_large_view_takes_no_time(self) -> None:
        groom = hairloom.Groom(*rows(100_000, 16))
        fastest = 1.0
        for _ in range(10):
            begin = time.perf_counter()
            view = groom.positions
            fastest = min(fastest, time.perf_counter() - begin)
        self.assertEqual(view.shape, (1_600_000, 3))
        self.assertLess(fastest, 1e-3)

    def test_a_view_stays_as_it_was_and_outlives_its_groom(self) -> None:
        view = self.groom.positions
        with self.assertRaises(ValueError):
            view[0, 0] = 1
        self.groom.positions = self.positions + np.float32(1)
        np.testing.assert_array_equal(view, self.positions)
        np.testing.assert_array_equal(self.groom.positions, self.positions + np.float32(1))
        attributes = self.groom.points
        del self.groom
        gc.collect()
        np.testing.assert_array_equal(view, self.positions)
        self.assertIn("position", attributes)

    def test_a_copy_is_independent(self) -> None:
        for other in (self.groom.copy(), copy.copy(self.groom), copy.deepcopy(self.groom)):
            other.positions = self.positions * np.float32(2)
            np.testing.assert_array_equal(self.groom.positions, self.positions)

    def test_attributes_of_every_type(self) -> None:
        arrays: dict[str, NDArray[Any]] = {
            "a": np.arange(40, dtype=np.float32),
            "b": np.zeros((40, 2), np.float32),
            "colour": np.ones((40, 3), np.float32),
            "d": np.ones((40, 4), np.float32),
            "e": np.arange(40, dtype=np.int32),
            "f": np.arange(40, dtype=np.uint32),
            "g": np.arange(40, dtype=np.uint8),
        }
        for name, values in arrays.items():
            self.groom.points[name] = values
            self.assertEqual(self.groom.points[name].dtype, values.dtype)
            np.testing.assert_array_equal(self.groom.points[name], values)
        self.assertEqual(list(self.groom.points), ["a", "b", "colour", "d", "e", "f", "g", "position"])
        del self.groom.points["a"]
        self.assertNotIn("a", self.groom.points)
        with self.assertRaises(KeyError):
            self.groom.points["a"]
        self.groom.strands["dye"] = np.full(5, 0.5, np.float32)
        self.assertEqual(len(self.groom.strands), 1)

    def test_dlpack_in_and_out(self) -> None:
        class Foreign:
            """An array of a program that speaks DLPack and nothing else."""

            def __init__(self, values: NDArray[Any]) -> None:
                self._values = values

            def __dlpack__(self, **options: object) -> object:
                return self._values.__dlpack__()

            def __dlpack_device__(self) -> object:
                return self._values.__dlpack_device__()

        moved = self.positions + np.float32(0.5)
        self.groom.positions = Foreign(moved)
        np.testing.assert_array_equal(self.groom.positions, moved)
        out = np.from_dlpack(self.groom.positions)
        self.assertTrue(np.shares_memory(out, self.groom.positions))

    def assertRefused(self, values: object, *words: str) -> None:
        with self.assertRaises(hairloom.ArgumentError) as caught:
            self.groom.positions = values
        for word in words:
            self.assertIn(word, str(caught.exception))
        np.testing.assert_array_equal(self.groom.positions, self.positions)

    def test_wrong_arrays_are_refused_and_nothing_changes(self) -> None:
        whole = np.zeros((40, 3), np.float32)
        self.assertRefused(whole.astype(np.float64), "float64", "float32")
        self.assertRefused(np.zeros((40, 4), np.float32), "(40, 4)", "(n, 3)")
        self.assertRefused(np.zeros(120, np.float32), "(120,)")
        self.assertRefused(np.zeros((39, 3), np.float32), "39", "40")
        self.assertRefused(np.zeros((80, 3), np.float32)[::2], "not contiguous", "ascontiguousarray")
        self.assertRefused(np.asfortranarray(whole), "not contiguous")
        self.assertRefused(whole.astype(">f4"), "position")
        self.assertRefused([[0.0, 0.0, 0.0]] * 40, "list")
        self.assertRefused(None, "NoneType")
        self.assertRefused(np.full((40, 3), np.nan, np.float32), "nan", "row 0")
        self.assertRefused(np.full((40, 3), np.inf, np.float32), "inf")

    def test_wrong_strands_are_refused(self) -> None:
        for offsets in ([0, 8], [8, 40], [0, 24, 8, 40], [], [0, 41]):
            with self.assertRaises(hairloom.ArgumentError):
                hairloom.Groom(self.positions, np.array(offsets, np.uint32))
        with self.assertRaises(hairloom.ArgumentError):
            hairloom.Groom(self.positions, self.offsets.astype(np.int64))
        with self.assertRaises(hairloom.ArgumentError):
            self.groom.strands["layer"] = np.zeros(4, np.uint32)
        with self.assertRaises(hairloom.Error):  # there is one layer
            self.groom.strands["layer"] = np.full(5, 7, np.uint32)
        with self.assertRaises(hairloom.ArgumentError):
            del self.groom.points["position"]


class Edits(InFolder):
    def test_operations_strokes_and_scripts(self) -> None:
        groom = self.create()
        before = groom.positions
        self.assertEqual(groom.apply("curl", radius=0.01)["touched_strands"], 60)
        self.assertFalse(np.array_equal(before, groom.positions))
        centre = before.mean(axis=0)
        stroke = groom.apply(
            "stroke", tool="puff", radius=0.2, dabs=[{"at": centre}, {"at": centre + 0.01}]
        )
        self.assertGreater(stroke["touched_strands"], 0)
        done = groom.run([{"op": "noise", "seed": 3}, {"op": "set_length", "length": 0.1}])
        self.assertEqual(done["strokes"], 2)
        with open("script.json", "w") as file:
            file.write('{"hairloom_script": 1, "operations": [{"op": "smooth"}]}')
        self.assertEqual(groom.run_script("script.json")["strokes"], 1)

    def test_a_failed_script_changes_nothing(self) -> None:
        groom = self.create()
        before = groom.positions
        wrong: list[dict[str, Any]] = [
            {"op": "curll"},
            {"op": "curl", "radius": 1e9},
            {"op": "curl", "rdius": 0.1},
        ]
        for operation in wrong:
            with self.assertRaises(hairloom.Error) as caught:
                groom.run([{"op": "noise"}, operation])
            self.assertIn("operations/1", caught.exception.what)
        with self.assertRaises(hairloom.ArgumentError):
            groom.apply("curl", radius=float("nan"))
        with self.assertRaises(hairloom.ArgumentError):
            groom.apply("curl", radius=object())
        with self.assertRaises(hairloom.ArgumentError) as twice:
            groom.apply("curl", op="noise")
        self.assertIn("op is given", str(twice.exception))
        nested: dict[str, Any] = {}
        inner = nested
        for _ in range(100_000):
            inner["a"] = inner = {}
        with self.assertRaises(hairloom.ArgumentError):
            groom.apply("curl", radius=nested)
        np.testing.assert_array_equal(groom.positions, before)
        with open("broken.json", "w") as file:
            file.write('{\n  "hairloom_script": 1,')
        with self.assertRaises(hairloom.Error) as caught:
            groom.run_script("broken.json")
        self.assertEqual(caught.exception.file, "broken.json")
        self.assertIsNotNone(caught.exception.place)

    def test_moved_points_have_no_operators(self) -> None:
        groom = self.create()
        groom.run([{"op": "add_operator", "at": 0, "operator": {"op": "curl"}}])
        self.assertIn("base_position", groom.points)
        groom.positions = groom.positions * np.float32(1.01)
        self.assertNotIn("base_position", groom.points)
        self.assertEqual([row for row in groom.validate() if row["severity"] == "error"], [])

    def test_settings(self) -> None:
        groom = self.create()
        groom.configure({"simulation": {"windSpeed": np.float32(4)}, "material": {"eumelanin": 0.3}})
        self.assertEqual(groom.settings["simulation"]["windSpeed"], 4)
        refused: list[Mapping[str, Mapping[str, Any]]] = [
            {"simulation": {"windSpeed": 1e6}},
            {"simulation": {"wind": 1}},
            {"simulatoin": {}},
        ]
        for wrong in refused:
            with self.assertRaises(hairloom.Error):
                groom.configure(wrong)
        self.assertEqual(groom.settings["simulation"]["windSpeed"], 4)

    def test_files(self) -> None:
        groom = self.create()
        groom.apply("curl")
        groom.save("saved.hairloom")
        again = hairloom.Groom.open("saved.hairloom")
        np.testing.assert_array_equal(again.positions, groom.positions)
        self.assertEqual(list(again.strands), list(groom.strands))
        with open("damaged.hairloom", "wb") as file, open("saved.hairloom", "rb") as whole:
            file.write(whole.read()[:-100])
        for path in ("nothing.hairloom", "damaged.hairloom", "."):
            with self.assertRaises(hairloom.Error) as caught:
                hairloom.Groom.open(path)
            self.assertEqual(caught.exception.file, path)
        with self.assertRaises(hairloom.Error):
            groom.save("no/such/folder.hairloom")


class Motion(InFolder):
    def test_frames(self) -> None:
        groom = self.create()
        simulation = groom.simulate("nod", frames=5, wind=(3, 0, 1))
        self.assertEqual(len(simulation), 5)
        frames = list(simulation)
        self.assertEqual([frame.number for frame in frames], [1, 2, 3, 4, 5])
        self.assertEqual(frames[2].time, 3 / 60)
        self.assertEqual(frames[0].positions.shape, groom.positions.shape)
        self.assertFalse(np.array_equal(frames[0].positions, frames[4].positions))
        self.assertGreater(float(np.abs(frames[4].velocities).max()), 0)
        self.assertEqual(simulation.stats()["frames"], 5)
        with self.assertRaises(StopIteration):
            next(simulation)

    def test_it_is_the_simulation_of_the_command_line(self) -> None:
        groom = self.create()
        simulation = groom.simulate("spin", frames=4, fps=30, pre_roll=2)
        list(simulation)
        report = hairloom.simulate("hair.hairloom", motion="spin", frames=4, fps=30, pre_roll=2)
        self.assertEqual(simulation.stats()["state_hash"], report.state_hash)

    def test_keys(self) -> None:
        groom = self.create()
        keys = {"keys": [{"t": 0, "translate": [0, 0, 0]}, {"t": 1, "translate": np.array([0.5, 0, 0])}]}
        Path("keys of a turn.json").write_text(json.dumps({"keys": [{"t": 0}, {"t": 1, "translate": [0.5, 0, 0]}]}))
        *_, other = groom.simulate(Path("keys of a turn.json"), frames=60)
        *_, last = groom.simulate(keys, frames=60)
        np.testing.assert_array_equal(other.positions, last.positions)
        self.assertAlmostEqual(float(last.positions[0, 0] - groom.positions[0, 0]), 0.5, places=3)

    def test_the_time_line_says_rate_range_and_pre_roll(self) -> None:
        self.create()
        keys = [{"t": 0}, {"t": 0.25, "degrees": 30}]
        with open("line.json", "w") as file:
            json.dump({"time_line": {"framesPerSecond": 24, "end": 0.25, "preRoll": 2, "head": keys}}, file)
        hairloom.timeline("hair.hairloom", from_="line.json", output="moving.hairloom")
        groom = hairloom.Groom.open("moving.hairloom")
        simulation = groom.simulate("timeline")
        self.assertEqual([frame.number for frame in simulation], [1, 2, 3, 4, 5, 6])
        report = hairloom.simulate("moving.hairloom", motion="timeline")
        self.assertEqual(simulation.stats()["state_hash"], report.state_hash)
        slow = list(groom.simulate("timeline", fps=4, frames=1, pre_roll=0))
        self.assertEqual([frame.time for frame in slow], [0.25])

    def test_wrong_motions(self) -> None:
        groom = self.create()
        with self.assertRaises(hairloom.Error):
            groom.simulate("jump")
        with self.assertRaises(hairloom.Error):
            groom.simulate({"keys": [{"t": -1}]})
        refused: list[dict[str, Any]] = [{"frames": 0}, {"fps": 0.5}, {"fps": float("nan")}, {"pre_roll": -1}]
        for wrong in refused:
            with self.assertRaises(hairloom.ArgumentError):
                groom.simulate("none", **wrong)
        with self.assertRaises(hairloom.ArgumentError):
            groom.simulate(7)  # type: ignore[arg-type]
        with self.assertRaises(hairloom.Error):
            groom.simulate("none", wind=(float("inf"), 0, 0))

    def test_pictures(self) -> None:
        groom = self.create()
        rest = groom.render(size=(96, 64), passes=1)
        self.assertEqual((rest.shape, rest.dtype), ((64, 96, 4), np.uint8))
        np.testing.assert_array_equal(rest, groom.render(size=(96, 64), passes=1))
        *_, frame = groom.simulate("nod", frames=20, wind=(8, 0, 0))
        self.assertGreater(float((rest != groom.render(size=(96, 64), passes=1, frame=frame)).mean()), 0.01)
        self.assertFalse(np.array_equal(rest, groom.render(size=(96, 64), passes=1, camera="back")))
        clear = groom.render(size=(96, 64), passes=1, transparent=True)
        self.assertEqual((int(clear[0, 0, 3]), int(rest[0, 0, 3])), (0, 255))
        with self.assertRaises(hairloom.ArgumentError):
            groom.render(size=(0, 10))
        with self.assertRaises(hairloom.Error):
            groom.render(camera="below")
        with self.assertRaises(hairloom.ArgumentError):
            hairloom.Groom(*rows(3)).render(frame=frame)

    def test_two_threads_on_one_groom(self) -> None:
        groom = self.create(count=400)
        busy = threading.Event()

        def draw() -> None:
            busy.set()
            groom.render(size=(512, 512), passes=4)

        thread = threading.Thread(target=draw)
        thread.start()
        busy.wait()
        refused = 0
        described = set()
        while thread.is_alive():
            described.add(repr(groom))
            try:
                len(groom)
                groom.positions
                groom.copy()
            except hairloom.BusyError as error:
                refused += 1
                self.assertIn("another thread", str(error))
        thread.join()
        self.assertGreater(refused, 0)
        self.assertIn("<hairloom.Groom: in use by another thread>", described)
        self.assertEqual(len(groom.positions), groom.point_count)

    def test_a_groom_for_each_thread(self) -> None:
        groom = self.create()
        hashes: list[str] = []

        def run(own: hairloom.Groom) -> None:
            simulation = own.simulate("nod", frames=10)
            list(simulation)
            hashes.append(simulation.stats()["state_hash"])

        threads = [threading.Thread(target=run, args=(groom.copy(),)) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(len(hashes), 4)
        self.assertEqual(len(set(hashes)), 1)


if __name__ == "__main__":
    unittest.main()
