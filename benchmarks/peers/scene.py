# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene that every simulator runs, and the one measure that all are held to. Metres, seconds, radians, Y up.

300 gently curved strands of 0.3 m stand off the middle of a head, from level ones to some that slope down by 57°. They are let go, and
the head turns by 0.8 radians to either side once a second, for two seconds. No air, nothing to touch, no follow hairs."""
import argparse
import csv
import datetime
import os
import platform
import statistics

import numpy

STRANDS, POINTS, LENGTH = 300, 16, 0.3
COMPARED = 10  # every thirtieth strand: errors are taken from these or fewer, times from all
FPS, FRAMES = 60, 120
HEAD, TURN, HERTZ = 0.1, 0.8, 1.0
CURVE = 0.5  # of a strand, radians. At 1.5 strands may buckle to either side, and no two runs agree
GRAVITY = 9.81
DENSITY, DIAMETER, YOUNG = 1300.0, 80e-6, 3.89e9
BENDING = YOUNG * DIAMETER**2 / (16 * DENSITY)  # EI / (density · area), m⁴/s²
TORSION = 0.75                                  # GJ / EI
DAMPING = 2.0                                   # 1/s, of velocities

# 0.1 m of this hair held level at the root: where the heavy elastica, solved as a boundary value problem, puts the tip.
CANTILEVER = 0.1
CANTILEVER_TIP = (0.071724607, -0.064747198)
CANTILEVER_DAMPING = 10.0

COLUMNS = ["peer", "version", "setting", "strands", "ms_per_frame", "ms_lowest", "ms_highest", "error_rms_mm", "error_max_mm",
           "stretch_mean_percent", "stretch_max_percent", "cantilever_mm", "converged", "doubt_mm", "machine", "date", "load"]


def rest_strands(count=STRANDS):
    """Points of the unloaded strands, count × POINTS × 3."""
    strands = numpy.empty((count, POINTS, 3))
    segment = LENGTH / (POINTS - 1)
    for s, share in enumerate(numpy.arange(count) / count):
        around, across, up = 2 * numpy.pi * share, HEAD, 0.0
        for p in range(POINTS):
            strands[s, p] = across * numpy.cos(around), up, across * numpy.sin(around)
            slope = -share - CURVE * p / (POINTS - 2)
            across, up = across + segment * numpy.cos(slope), up + segment * numpy.sin(slope)
    return strands


def cantilever_strand():
    """One level strand."""
    return numpy.array([[[p * CANTILEVER / (POINTS - 1), 0.0, 0.0] for p in range(POINTS)]])


def angle(seconds):
    """Of the head about the vertical. It is given at frames; simulators draw straight lines between them."""
    frame = min(seconds * FPS, FRAMES)
    before = min(int(frame), FRAMES - 1)
    at = [TURN * (1 - numpy.cos(2 * numpy.pi * HERTZ * f / FPS)) for f in (before, before + 1)]
    return at[0] + (frame - before) * (at[1] - at[0])


def turned(points, radians):
    """About the vertical, as a right hand does."""
    c, s = numpy.cos(radians), numpy.sin(radians)
    return points @ numpy.array([[c, 0, -s], [0, 1, 0], [s, 0, c]])


def error_mm(run, truth):
    """Root mean square and largest distance of the same points at the same frames (frames × strands × points × 3)."""
    if run.shape != truth.shape:
        raise ValueError(f"a run of {run.shape} values; expected {truth.shape}")
    squares = numpy.sum((run - truth) ** 2, axis=-1)
    if not numpy.isfinite(squares).all():
        return float("inf"), float("inf")
    return 1000 * float(numpy.sqrt(squares.mean())), 1000 * float(numpy.sqrt(squares.max()))


def stretch_percent(run, rest):
    """Mean and largest share by which a segment is longer or shorter than at rest."""
    lengths = numpy.linalg.norm(numpy.diff(run, axis=-2), axis=-1)
    shares = numpy.abs(lengths / numpy.linalg.norm(numpy.diff(rest, axis=-2), axis=-1) - 1)
    return 100 * float(shares.mean()), 100 * float(shares.max())


def cantilever_error_mm(run, rest):
    """How far the tip of the last frame is from the elastica's."""
    x, y, z = run[-1, 0, -1] - rest[0, 0]
    return 1000 * float(numpy.sqrt((x - CANTILEVER_TIP[0]) ** 2 + (y - CANTILEVER_TIP[1]) ** 2 + z * z))


def machine():
    with open("/proc/cpuinfo") as info:
        name = next(line.split(":")[1].strip() for line in info if line.startswith("model name"))
    return f"{name}, {os.cpu_count()} threads, {platform.system()}"


def measure(peer, version, settings, converged, nearly, simulate, compared=COMPARED, timed_frames=FRAMES):
    """Runs every setting and writes PEER.csv into the folder that -o names.

    simulate(rest, setting, damping, turning, frames) → positions (frames × strands × points × 3, from the end of the first frame
    on) and the processor seconds of it all, summed over threads, without what is done once. `converged` is the setting that
    counts as the simulator's own truth, and `nearly` the one whose distance from it is the doubt. `settings` and these are a label
    each with what simulate takes. Errors are taken from `compared` strands, times from all of `timed_frames` frames."""
    options = argparse.ArgumentParser()
    options.add_argument("-o", "--output", required=True)
    options.add_argument("--repeat", type=int, default=3)
    asked, _ = options.parse_known_args()
    few, all_strands, beam = rest_strands(compared), rest_strands(), cantilever_strand()
    runs = {setting: simulate(few, setting, DAMPING, True, FRAMES)[0] for setting in {converged[1], nearly[1], *settings.values()}}
    truth = runs[converged[1]]
    doubt = error_mm(runs[nearly[1]], truth)[0]
    print(f"{peer} {version}: {converged[0]} counts as true, {nearly[0]} is {doubt:.4g} mm from it", flush=True)
    times = {label: [] for label in settings}
    for _ in range(asked.repeat):  # in turns, so that a busy minute is shared
        for label, setting in settings.items():
            times[label].append(1000 * simulate(all_strands, setting, DAMPING, True, timed_frames)[1] / timed_frames)
    rows = []
    for label, setting in settings.items():
        run = runs[setting]
        bent = simulate(beam, setting, CANTILEVER_DAMPING, False, FRAMES)[0]
        values = [statistics.median(times[label]), min(times[label]), max(times[label]), *error_mm(run, truth),
                  *stretch_percent(run, few), cantilever_error_mm(bent, beam)]
        rows.append([peer, version, label, STRANDS, *(f"{value:.4g}" for value in values), converged[0], f"{doubt:.4g}", machine(),
                     datetime.date.today().isoformat(), f"{os.getloadavg()[0]:.1f}"])
        print("  " + ", ".join(f"{name} {value}" for name, value in zip(COLUMNS[2:12], rows[-1][2:12])), flush=True)
    os.makedirs(asked.output, exist_ok=True)
    with open(os.path.join(asked.output, peer.lower().replace(" ", "-") + ".csv"), "w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([COLUMNS, *rows])
