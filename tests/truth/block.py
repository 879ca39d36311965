# SPDX-License-Identifier: GPL-3.0-or-later
"""A block of 4,000 parallel fibres, 5 cm wide and 3 cm high, lit from above and seen from its open side, by depth: light that has
been scattered more than once, of which single scattering is taken off, for fibres at random let some in through gaps."""

import subprocess
from dataclasses import dataclass

import numpy as np

import judge
import path_trace
from hair_file import Strands

FIBRES, LENGTH, HEIGHT, WIDTH = 4000, 0.08, 0.03, 0.05
BASE = 1.5
BANDS = np.array([0, 1, 2, 4, 6, 8, 10]) * 1e-3  # m
SIZE = 64  # pixels


@dataclass
class Band:
    depth_mm: tuple[float, float]
    truth: float  # mean luminance over the seeds
    dual: float  # ours by that
    volume: float


def fibres(seed: int) -> Strands:
    chance = np.random.default_rng(seed)
    points = np.zeros((FIBRES, 17, 3))
    points[:, :, 0] = np.linspace(-LENGTH / 2, LENGTH / 2, 17)
    points[:, :, 1] = BASE + chance.uniform(0, HEIGHT, (FIBRES, 1))
    points[:, :, 2] = chance.uniform(0, WIDTH, (FIBRES, 1))
    return Strands(np.arange(FIBRES + 1) * 17, points.reshape(-1, 3))


def view_of(hair: dict) -> dict:
    middle = BASE + HEIGHT / 2
    return {
        "camera": {"eye": [0, middle, 0.85], "target": [0, middle, WIDTH / 2], "up": [0, 1, 0], "fov_y_deg": 2.6},
        "size": [SIZE, SIZE],
        "hair": {**hair, "tip_scale": 1.0},
        "lights": [{"type": "directional", "to_light": [0, 1, 0], "irradiance": [np.pi] * 3}],
        "head_albedo": [0, 0, 0],
    }


def _bands(image: np.ndarray) -> np.ndarray:
    """Mean luminance at each depth, in the middle of the picture; its upper edge is seen at the fibres' nearest side."""
    metres = 2 * np.tan(np.radians(2.6 / 2)) * (0.85 - WIDTH) / SIZE
    depth = HEIGHT / 2 - (SIZE / 2 - np.arange(SIZE) - 0.5) * metres
    rows = judge.luminance(image)[:, SIZE // 4 : 3 * SIZE // 4].mean(axis=1)
    return np.array([rows[(depth >= a) & (depth < b)].mean() for a, b in zip(BANDS, BANDS[1:])])


def compare(ours, plain: list[str], hair: dict, eumelanin: float, seeds: int, samples: int) -> list[Band]:
    """Of `seeds` blocks, path-traced with `samples` paths a pixel and drawn by `ours`; `plain` are settings of their material."""
    out = ours.folder
    sums = {key: 0.0 for key in ("truth", "dual", "volume")}
    nothing = out / "nothing.obj"
    nothing.write_text("v 100 0 0\nv 101 0 0\nv 100 1 0\nf 1 2 3\n")
    view = view_of(hair)
    for seed in range(seeds):
        strands = fibres(seed)
        points, groom = out / f"block{seed}.npy", out / f"block{seed}.hairloom"
        np.save(points, strands.points.reshape(FIBRES, 17, 3).astype(np.float32))
        for command in (
            ["import", points, "--unit", "m", "-o", groom],
            ["set", groom, *plain, "-o", groom, "--force"],
        ):
            subprocess.run([str(c) for c in (ours.cli, *command)], check=True, stdout=subprocess.DEVNULL)
        curves = path_trace.write_curves(strands, hair["radius_m"], 1.0, out / f"block{seed}_curves")
        scene = path_trace.TruthScene(ours.mi, view, eumelanin, nothing, curves)
        sums["truth"] += _bands(scene.render(100, samples) - scene.render(2, samples))
        single = ours.render(groom, view, f"block{seed}", "single")
        for way in ("dual", "volume"):
            sums[way] += _bands(ours.render(groom, view, f"block{seed}", way) - single)
    return [
        Band((1e3 * a, 1e3 * b), sums["truth"][i] / seeds, *(sums[way][i] / sums["truth"][i] for way in ("dual", "volume")))
        for i, (a, b) in enumerate(zip(BANDS, BANDS[1:]))
    ]


def table(bands: list[Band]) -> str:
    lines = ["| depth, mm | path-traced | dual | volume |", "|---|---|---|---|"]
    lines += [f"| {b.depth_mm[0]:g} to {b.depth_mm[1]:g} | {b.truth:.4f} | {b.dual:.2f} | {b.volume:.2f} |" for b in bands]
    return "\n".join(lines) + "\n"
