# SPDX-License-Identifier: GPL-3.0-or-later
"""Ours: hairloom-cli's rods on the CPU, without what the peers do not have (damping of bending, air, sleep)."""
import json
import math
import os
import resource
import subprocess
import sys
import tempfile

import numpy

import scene

CLI = sys.argv[sys.argv.index("--cli") + 1]
HEADER = 48  # bytes, and 8 before the points of each frame: docs/formats/frames.md


def cli(*words):
    """What the job says, and the processor seconds that it took."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([CLI, *words, "--json", "--threads", "1", "--force"], capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(f"{' '.join(words)}: {done.stderr.strip()}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return json.loads(done.stdout), after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def write_strands(path, rest):
    with open(path, "w") as file:
        for strand in rest:
            file.writelines("v {:.9f} {:.9f} {:.9f}\n".format(*point) for point in strand)
            file.write("l " + " ".join(str(k - len(strand)) for k in range(len(strand))) + "\n")


def read_frames(path, rest):
    with open(path, "rb") as file:
        data = file.read()
    frames, points = numpy.frombuffer(data, "<u8", 2, 16)
    each = numpy.frombuffer(data, numpy.uint8, offset=HEADER).reshape(int(frames), -1)[:, 8:8 + 12 * int(points)]
    return each.copy().view("<f4").reshape(int(frames), *rest.shape).astype(float)


def simulate(rest, substeps, damping, turning, frames):
    with tempfile.TemporaryDirectory() as folder:
        strands, groom, motion, record = (os.path.join(folder, name) for name in ("s.obj", "s.hairloom", "m.json", "r.frames"))
        write_strands(strands, rest)
        cli("import", strands, "-o", groom)
        cli("set", groom, "simulation.angularStiffness=0.5", "simulation.angularCurve=[[0,1],[1,1]]",
            f"simulation.torsionRatio={scene.TORSION}", f"simulation.dampingTime={1 / damping}", "simulation.bendDampingTime=0",
            "simulation.restGravity=0", "simulation.airDrag=0", "simulation.sleepSpeed=0", "-o", groom)
        keys = [{"t": f / scene.FPS, "axis": [0, 1, 0], "degrees": math.degrees(scene.angle(f / scene.FPS)) if turning else 0.0}
                for f in range(frames + 1)]
        with open(motion, "w") as file:
            json.dump({"keys": keys}, file)
        words = ["simulate", groom, "--motion", motion, "--engine", "cpu", "--fps", str(scene.FPS), "--substeps", str(substeps)]
        cli(*words, "--frames", str(frames), "--record", record)
        # Reading the groom is paid once: what two runs differ by is what frames cost.
        seconds = cli(*words, "--frames", str(frames + 1))[1] - cli(*words, "--frames", "1")[1]
        return read_frames(record, rest), seconds


if __name__ == "__main__":
    version = subprocess.run([CLI, "--version"], capture_output=True, text=True).stdout.split()[-1]
    scene.measure("Hairloom", version, {f"{n} substep{'s' if n > 1 else ''}": n for n in (1, 2, 4, 8, 16, 32)}, ("256 substeps", 256),
                  ("128 substeps", 128), simulate)
