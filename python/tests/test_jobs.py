# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import inspect
import json
import logging
import os
import pickle
import subprocess
import sys
import threading
import typing
from collections.abc import Callable
from pathlib import Path

import numpy as np
from support import BUST, SAMPLES, InFolder

import hairloom
from hairloom import jobs
from hairloom._run import PROGRAM

hair = "hair.hairloom"
# A call for each job, with a key of its report.
CALLS: dict[str, tuple[Callable[[], hairloom.Report], str]] = {
    "accuracy": (
        lambda: hairloom.accuracy(
            hair, output="accuracy", frames=4, strands=4, substeps=[1, 2], integrators=["verlet"], repeat=1,
            truth_substeps=16,
        ),
        "front",
    ),
    "bench": (lambda: hairloom.bench("material", quick=True, repeat=1), "rows"),
    "blend": (lambda: hairloom.blend(hair, with_="other.hairloom", weight=0.3, output="blend.hairloom"), "strands"),
    "budget": (lambda: hairloom.budget(hair, ms=1, frames=2, busy=True), "settings"),
    "clean": (lambda: hairloom.clean("."), "left_overs"),
    "colliders": (lambda: hairloom.colliders(hair, fit="spheres", output="c.hairloom"), "spheres"),
    "create": (
        lambda: hairloom.create(mesh=BUST, scalp="all", count=20, length=0.1, points=4, output="new.hairloom"),
        "triangles",
    ),
    "devices": (lambda: hairloom.devices(), "devices"),
    "effects": (lambda: hairloom.effects(hair, frames=2), "effects"),
    "export": (lambda: hairloom.export(hair, format="hair", output="hair.hair"), "bytes"),
    "groom": (lambda: hairloom.groom(list=True), "operators"),
    "guides": (lambda: hairloom.guides(hair, count=10, output="guides.hairloom"), "guides"),
    "import_": (lambda: hairloom.import_("other.hair", output="imported.hairloom"), "strands"),
    "info": (lambda: hairloom.info(hair), "strands"),
    "layers": (lambda: hairloom.layers(hair), "layers"),
    "lod": (lambda: hairloom.lod(hair, output="levels", levels="strands,cards:8", atlas=64, directions=2), "levels"),
    "pose": (lambda: hairloom.pose(hair, name="Rest", make=True, output="posed.hairloom"), "poses"),
    "reference": (lambda: hairloom.reference(output="reference.md"), "bytes"),
    "render": (lambda: hairloom.render(hair, output="hair.png", size="64x64", passes=1), "device"),
    "set": (lambda: hairloom.set(hair, ["simulation.windSpeed=4"], output="set.hairloom"), "changed"),
    "simulate": (lambda: hairloom.simulate(hair, frames=2, wind=(3, 0, 1)), "state_hash"),
    "spheres": (lambda: hairloom.spheres(hair, from_=SAMPLES / "bust/spheres.json", output="s.hairloom"), "added"),
    "stability": (lambda: hairloom.stability(hair, output="stability", storms=1), "certificate"),
    "stack": (lambda: hairloom.stack(hair), "operators"),
    "sweep": (lambda: hairloom.sweep("sweep.json"), "parts"),
    "takes": (lambda: hairloom.takes(hair, record="walk", motion="nod", frames=2), "takes"),
    "timeline": (lambda: hairloom.timeline(hair), "time_line"),
    "transfer": (lambda: hairloom.transfer(hair, to=BUST, output="moved.hairloom"), "strands"),
    "validate": (lambda: hairloom.validate(hair), "findings"),
}


class Jobs(InFolder):
    def test_every_job_has_a_function_with_its_options(self) -> None:
        hairloom.reference(jobs="jobs.json")
        described = json.loads(Path("jobs.json").read_text())
        names = {name.removesuffix("_") for name in jobs.__all__}
        self.assertEqual(names, {job["name"] for job in described["jobs"]})
        for job in described["jobs"]:
            function = getattr(hairloom, job["name"], None) or getattr(hairloom, job["name"] + "_")
            keywords = {name.removesuffix("_") for name in inspect.signature(function).parameters}
            for option in job["options"]:
                self.assertIn(option["name"].replace("-", "_"), keywords, job["name"])
            self.assertIn(job["does"], str(function.__doc__))

    def test_every_job_runs(self) -> None:
        self.assertEqual(set(CALLS), set(jobs.__all__), "a job without a call in this test")
        self.create(hair, 40)
        self.create("other.hairloom", 50)
        hairloom.export("other.hairloom", format="hair", output="other.hair")
        arguments = {"groom": hair, "frames": 2, "wind": "{wind},0,0"}
        over = [{"name": "wind", "values": [0, 4]}]
        Path("sweep.json").write_text(
            json.dumps({"hairloom_sweep": 1, "job": "simulate", "arguments": arguments, "over": over})
        )
        for name, (call, key) in CALLS.items():
            with self.subTest(job=name):
                report = call()
                self.assertIn(key, report)
                json.dumps(report, default=dict)

    def test_a_report_is_a_mapping_with_attributes(self) -> None:
        self.create(hair)
        report = hairloom.info(hair)
        self.assertEqual(report.strands, report["strands"])
        self.assertEqual(report.strands, 60)
        self.assertIn("strands", dir(report))
        self.assertEqual(len(report), len(dict(report)))
        with self.assertRaises(AttributeError):
            report.starnds
        self.assertEqual(dict(pickle.loads(pickle.dumps(report))), dict(report))

    def test_a_groom_in_place_of_a_file(self) -> None:
        groom = self.create()
        groom.apply("set_length", length=0.1)
        report = hairloom.export(groom, format="obj-lines", output="lines.obj")
        self.assertEqual(report.strands, 60)
        self.assertEqual(hairloom.info(groom).points, groom.point_count)

    def test_errors_say_file_place_and_expected(self) -> None:
        self.create(hair)
        Path("script.json").write_text('{\n"hairloom_script": 1, "operations": [,]}')
        with self.assertRaises(hairloom.Error) as caught:
            hairloom.groom(hair, script="script.json", output="out.hairloom")
        self.assertEqual(caught.exception.file, "script.json")
        self.assertEqual(list(caught.exception.place or {}), ["byte"])
        self.assertFalse(os.path.exists("out.hairloom"))
        with self.assertRaises(hairloom.ArgumentError) as wrong:
            hairloom.simulate(hair, frames=0)
        self.assertIn("1 to 1000000", str(wrong.exception.expected))
        with self.assertRaises(hairloom.ArgumentError):
            hairloom.simulate(hair, motion="jump")
        with self.assertRaises(hairloom.ArgumentError):
            hairloom.simulate(hair, hair_hair=typing.cast(bool, 3))
        with self.assertRaises(hairloom.ArgumentError):
            hairloom.info("a\0b")
        with self.assertRaises(hairloom.ArgumentError) as wrong:
            hairloom.set(hair, typing.cast(str, {"simulation.windSpeed": 4}), output="out.hairloom")
        self.assertIn("an argument is dict", str(wrong.exception))
        with self.assertRaises(hairloom.Error):
            hairloom.info("--help")  # a file of that name, not an option
        again = pickle.loads(pickle.dumps(caught.exception))
        self.assertEqual(str(again), str(caught.exception))

    def test_warnings_are_logged(self) -> None:
        self.create(hair)
        self.create("other.hairloom", 20)
        with self.assertLogs("hairloom", logging.WARNING) as logged:
            hairloom.blend(hair, with_="other.hairloom", weight=0.5, reach=0.001, output="blend.hairloom")
        self.assertIn("of 60 strands stay as they are", logged.output[0])

    def test_jobs_run_side_by_side(self) -> None:
        self.create(hair)
        strands: list[int] = []
        threads = [threading.Thread(target=lambda: strands.append(hairloom.info(hair).strands)) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(strands, [60] * 4)

    def test_numbers_of_numpy(self) -> None:
        self.create(hair)
        report = hairloom.simulate(hair, frames=typing.cast(int, np.int64(2)), wind=np.array([3, 0, 1]).tolist())
        self.assertEqual(report.frames, 2)
        alone = hairloom.simulate(hair, frames=2, wind=(3, 0, 1), hair_hair=True)
        again = hairloom.simulate(hair, frames=2, wind=(3, 0, 1), hair_hair=typing.cast(bool, np.bool_(True)))
        self.assertEqual(again.state_hash, alone.state_hash)
        self.assertEqual(hairloom.info(typing.cast(str, os.fsencode(hair))).strands, 60)

    def test_nothing_is_left_in_the_folder_for_temporary_files(self) -> None:
        os.mkdir("tmp")
        before = os.environ.get("TMPDIR")
        code = "import hairloom, numpy; g = hairloom.Groom.open('hair.hairloom'); hairloom.info(g); list(g.simulate({'keys': [{'t': 0}]}, frames=1))"
        self.create(hair)
        subprocess.run([sys.executable, "-c", code], check=True, env={**os.environ, "TMPDIR": os.path.abspath("tmp")})
        self.assertEqual(os.listdir("tmp"), [])
        self.assertEqual(os.environ.get("TMPDIR"), before)

    def test_import_takes_less_than_100_ms_of_a_processor(self) -> None:
        code = "import time, numpy; a = time.process_time(); import hairloom; print(time.process_time() - a)"
        took = min(float(subprocess.check_output([sys.executable, "-c", code])) for _ in range(5))
        self.assertLess(took, 0.1)

    def test_show_names_what_is_missing_and_opens_the_window(self) -> None:
        groom = self.create()
        os.environ["HAIRLOOM_WINDOW"] = "nowhere/hairloom"
        self.addCleanup(os.environ.pop, "HAIRLOOM_WINDOW")
        with self.assertRaises(hairloom.Error) as caught:
            hairloom.show(groom)
        self.assertEqual(caught.exception.file, "nowhere/hairloom")
        # In place of the window, the command line says what it was given.
        Path("window.sh").write_text(f'#!/bin/sh\n"{PROGRAM}" info "$1" --json > seen.json\n')
        os.chmod("window.sh", 0o755)
        os.environ["HAIRLOOM_WINDOW"] = os.path.abspath("window.sh")
        self.assertEqual(hairloom.show(groom, wait=True).returncode, 0)
        self.assertEqual(json.loads(Path("seen.json").read_text())["strands"], 60)
