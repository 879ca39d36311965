# SPDX-License-Identifier: GPL-3.0-or-later
"""What accuracy costs in time: error and time of a hairstyle for several numbers of substeps, as a table and, where
Matplotlib is installed, as a plot.

    python accuracy_plot.py style.hairloom plot        # writes plot.csv and plot.png

The error is the root mean square distance from a run with 64 substeps.
"""

from __future__ import annotations

import argparse

import numpy as np
from numpy.typing import NDArray

import hairloom

TRUTH = 64


def run(groom: hairloom.Groom, substeps: int, frames: int) -> tuple[NDArray[np.float32], float]:
    """Positions of all frames (frames, points, 3), metres, and milliseconds a frame."""
    groom = groom.copy()
    groom.configure({"simulation": {"substeps": substeps}})
    simulation = groom.simulate("nod", frames=frames, wind=(3, 0, 1))
    return np.stack([frame.positions for frame in simulation]), simulation.stats()["ms_per_frame"]


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("groom")
    arguments.add_argument("output", help="name without suffix")
    arguments.add_argument("--frames", type=int, default=120)
    given = arguments.parse_args()
    groom = hairloom.Groom.open(given.groom)
    truth, _ = run(groom, TRUTH, given.frames)
    rows = []
    for substeps in (1, 2, 4, 8, 16):
        positions, ms = run(groom, substeps, given.frames)
        squared = np.sum((positions.astype(np.float64) - truth) ** 2, axis=2)
        rows.append((substeps, ms, 1000 * float(np.sqrt(squared.mean()))))
    with open(given.output + ".csv", "w") as file:
        file.write("substeps,ms,error_mm\n")
        file.writelines(f"{substeps},{ms:.4f},{error:.5f}\n" for substeps, ms, error in rows)
    try:
        from matplotlib import pyplot
    except ImportError:
        print("Matplotlib is not installed, so there is a table and no plot")
        return
    figure, axes = pyplot.subplots()
    axes.loglog([row[1] for row in rows], [row[2] for row in rows], "o-")
    for substeps, ms, error in rows:
        axes.annotate(f"{substeps} substeps", (ms, error))
    axes.set(xlabel="ms per frame", ylabel="error, mm", title=given.groom)
    figure.savefig(given.output + ".png")


if __name__ == "__main__":
    main()
