# SPDX-License-Identifier: GPL-3.0-or-later
"""How far two linear pictures are apart, and sheets that show them side by side."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


def luminance(image: np.ndarray) -> np.ndarray:
    return image @ _LUMINANCE


def mean_where(image: np.ndarray, coverage: np.ndarray) -> float:
    """Mean luminance of the pixels that hair covers at least half."""
    return float(luminance(image)[coverage > 0.5].mean())


def mean_colour_where(image: np.ndarray, coverage: np.ndarray) -> np.ndarray:
    return image[coverage > 0.5].mean(axis=0)


def blurred(image: np.ndarray, radius: int) -> np.ndarray:
    """Box means over (2 radius + 1)² pixels, by running sums."""
    for axis in (0, 1):
        padding = [(0, 0)] * image.ndim
        padding[axis] = (radius + 1, radius)
        sums = np.cumsum(np.pad(image, padding, mode="edge"), axis=axis)
        width = 2 * radius + 1
        upper = np.take(sums, range(width, sums.shape[axis]), axis=axis)
        lower = np.take(sums, range(sums.shape[axis] - width), axis=axis)
        image = (upper - lower) / width
    return image


@dataclass
class Closeness:
    """Of a picture of ours, where hair covers, luminance blurred by 4 pixels; light as ours by the truth's."""

    relative_mse: float  # squares of differences by those of the truth, none darker than 1 % of the bright parts
    mean: float
    dim: float  # where the truth has 5 to 25 % of its brightest percentile
    bright: float  # and more than half of that
    correlation: float


def closeness(image: np.ndarray, truth: np.ndarray, coverage: np.ndarray) -> Closeness:
    a, b = blurred(luminance(image), 4), blurred(luminance(truth), 4)
    hair = coverage > 0.5
    top = np.percentile(b[hair], 99)

    def light(where: np.ndarray) -> float:
        return float(a[where].sum() / b[where].sum()) if where.any() else float("nan")

    return Closeness(
        float(((a - b) ** 2 / (b**2 + (0.01 * top) ** 2))[hair].mean()),
        light(hair),
        light(hair & (b > 0.05 * top) & (b < 0.25 * top)),
        light(hair & (b > 0.5 * top)),
        float(np.corrcoef(a[hair], b[hair])[0, 1]),
    )


def to_display(image: np.ndarray, exposure: float) -> np.ndarray:
    """sRGB in 0 … 1 without tone mapping."""
    x = np.clip(image * exposure, 0, 1)
    return np.where(x <= 0.0031308, 12.92 * x, 1.055 * np.power(x, 1 / 2.4) - 0.055)


def flip(image: np.ndarray, truth: np.ndarray, exposure: float) -> float:
    """Mean FLIP of the displayed pictures, 0 equal … 1."""
    import flip_evaluator

    shown = [np.ascontiguousarray(to_display(i, exposure), dtype=np.float32) for i in (truth, image)]
    _, mean, _ = flip_evaluator.evaluate(*shown, "LDR", inputsRGB=True, applyMagma=False)
    return float(mean)


def save_sheet(mi, rows: list[list[np.ndarray]], exposure: float, path: Path) -> None:
    """Pictures of equal size in rows, with a thin gap."""
    gap = 4
    height, width, _ = rows[0][0].shape
    columns = max(len(row) for row in rows)
    sheet = np.ones((len(rows) * (height + gap) - gap, columns * (width + gap) - gap, 3), dtype=np.float32)
    for y, row in enumerate(rows):
        for x, image in enumerate(row):
            top, left = y * (height + gap), x * (width + gap)
            sheet[top : top + height, left : left + width] = to_display(image, exposure)
    bitmap = mi.Bitmap((sheet * 255 + 0.5).astype(np.uint8))
    bitmap.set_srgb_gamma(True)
    bitmap.write(str(path))
