# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair from so near that a fibre is 0.6 to 6 pixels wide, in light from the camera's side and from behind: how bright it is, and how
much pixels differ from those around them, which is what makes single hairs show."""

from dataclasses import dataclass

import numpy as np

import judge
import path_trace

WIDTHS = (0.6, 1.0, 2.0, 3.0, 6.0)  # pixels
DISTANCE = 1.0  # m
PLACES = ((0.0, 0.1), (-0.25, 0.2), (0.2, 0.25))  # right and up of the middle, of the hair's height
SIZE = 96  # pixels
FILTER = {"type": "gaussian", "stddev": 0.45}  # of hairloom-cli's averaged frames


@dataclass
class Near:
    light: str
    pixels: float  # that a fibre is wide
    single: float  # ours by the truth, mean over the places
    whole: float
    contrast: float  # ours
    true_contrast: float


def _targets(strands, forward: np.ndarray) -> list[np.ndarray]:
    """The points of the hair that a camera sees first at each of the places."""
    points = strands.points
    low, high = strands.bounds()
    middle, height = (low + high) / 2, high[1] - low[1]
    right = np.cross(forward, [0, 1, 0])
    right /= np.linalg.norm(right)
    up = np.cross(right, forward)
    targets = []
    for x, y in PLACES:
        wanted = middle + height * (x * right + y * up)
        offset = points - wanted
        across = offset - np.outer(offset @ forward, forward)
        near = points[np.linalg.norm(across, axis=1) < 0.01]
        if len(near) == 0:
            continue
        targets.append(near[np.argsort(near @ forward)[len(near) // 20]])
    return targets


def _contrast(first: np.ndarray, second: np.ndarray, coverage: np.ndarray, pixels: float) -> float:
    """Of pixels against those within a fibre and a half around, by the mean light; of two pictures of the same, whose noise then
    does not count."""
    hair = coverage > 0.5
    lights = [judge.luminance(image) for image in (first, second)]
    differences = [(light - judge.blurred(light, max(1, round(1.5 * pixels))))[hair] for light in lights]
    return float(np.sqrt(max((differences[0] * differences[1]).mean(), 0)) / np.mean([light[hair].mean() for light in lights]))


def compare(ours, groom, strands, head, curves, hair: dict, eumelanin: float, samples: int, light_of) -> list[Near]:
    """`light_of`: as truth.light_of, for a view."""
    forward = -np.array([0.42, 0.08, 0.9])
    forward /= np.linalg.norm(forward)
    targets = _targets(strands, forward)
    diameter = 2 * hair["radius_m"] * (2 + hair["tip_scale"]) / 3
    found = []
    for light in ("key", "back"):
        for pixels in WIDTHS:
            rows: list[list[np.ndarray]] = [[], [], [], []]
            sums = np.zeros(6)
            for i, target in enumerate(targets):
                fov = 2 * np.degrees(np.arctan(SIZE * diameter / pixels / 2 / DISTANCE))
                eye = target - DISTANCE * forward
                view = {
                    "camera": {"eye": eye.tolist(), "target": target.tolist(), "up": [0, 1, 0], "fov_y_deg": fov},
                    "size": [SIZE, SIZE],
                    "hair": hair,
                    "head_albedo": [0, 0, 0],
                }
                view["lights"] = [light_of(light, view)]
                scene = path_trace.TruthScene(ours.mi, view, eumelanin, head, curves, FILTER)
                first, second = (scene.render(2, samples, seed) for seed in (0, 1000))
                single, whole = (first + second) / 2, scene.render(100, samples)
                covered = scene.coverage(2)
                name = f"near_{light}_{pixels:g}_{i}"
                our_single, our_whole = (ours.render(groom, view, name, way) for way in ("single", "volume"))
                for row, image in zip(rows, (single, our_single, whole, our_whole)):
                    row.append(image)
                means = [judge.mean_where(image, covered) for image in (our_single, single, our_whole, whole)]
                sums += [*means, _contrast(our_single, our_single, covered, pixels), _contrast(first, second, covered, pixels)]
            sums /= len(targets)
            found.append(Near(light, pixels, sums[0] / sums[1], sums[2] / sums[3], sums[4], sums[5]))
            judge.save_sheet(ours.mi, rows, 2.0, ours.folder / f"near_{light}_{pixels:g}.png")
            print(table(found[-1:]).splitlines()[-1], flush=True)
    return found


def table(found: list[Near]) -> str:
    lines = ["| light | pixels | single | volume | contrast of single | path-traced |", "|---|---|---|---|---|---|"]
    lines += [
        f"| {n.light} | {n.pixels:g} | {n.single:.2f} | {n.whole:.2f} | {n.contrast:.2f} | {n.true_contrast:.2f} |" for n in found
    ]
    return "\n".join(lines) + "\n"
