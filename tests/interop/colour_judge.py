# SPDX-License-Identifier: GPL-3.0-or-later
"""colour_judge.py --cli HAIRLOOM-CLI -o FOLDER GROOM...: renders each groom without a config and through views of one, and holds the
images against OpenColorIO 2.6 and OpenEXR, the libraries' own Python modules. Fails beyond one code value of 255, or where an OpenEXR
file does not say which space it is in."""
import argparse
import json
import pathlib
import subprocess
import sys

import numpy
import OpenEXR
import PyOpenColorIO as OCIO
from PIL import Image

CONFIG = pathlib.Path(__file__).parents[1] / "colour/studio/config.ocio"
VIEWS = [("sRGB", "Film"), ("sRGB", "Warm film"), ("sRGB", "Un-tone-mapped"), ("sRGB", "Raw"), ("Rec. 1886", "Un-tone-mapped")]
EXPOSURE = 1.5
SPACES = {"none": ("lin_rec709_scene", (0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290)),
          str(CONFIG): ("lin_ap1_scene", (0.713, 0.293, 0.165, 0.830, 0.128, 0.044, 0.32168, 0.33767))}


def render(cli, groom, out, config, more=()):
    words = [cli, "render", groom, "-o", f"{out}.png", "--exr", f"{out}.exr", "--size", "256x256", "--aa", "msaa4", "--exposure", str(EXPOSURE),
             "--color-config", config, "--json", *more]
    done = subprocess.run(words, capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(f"{' '.join(words)}: {done.stderr.strip()}")
    return json.loads(done.stdout)


def light_of(path, config):
    """Pixels of an OpenEXR file, after a look at what it says of its space."""
    with OpenEXR.File(path) as file:
        header = dict(file.header())
        channel = file.channels()["RGBA"].pixels
    name, chromaticities = SPACES[config]
    if header.get("colorInteropID") != name:
        raise ValueError(f"{path}: colorInteropID {header.get('colorInteropID')}, expected {name}")
    if not numpy.allclose(header["chromaticities"], chromaticities, atol=1e-6):
        raise ValueError(f"{path}: chromaticities {header['chromaticities']}, expected {chromaticities}")
    return numpy.ascontiguousarray(channel[..., :3], dtype=numpy.float32)


def converted(processor, pixels):
    out = pixels.copy().reshape(-1, 3)
    processor.getDefaultCPUProcessor().applyRGB(out)
    return out.reshape(pixels.shape)


def main():
    words = argparse.ArgumentParser()
    words.add_argument("--cli", required=True)
    words.add_argument("-o", required=True, type=pathlib.Path)
    words.add_argument("grooms", nargs="+")
    asked = words.parse_args()
    asked.o.mkdir(parents=True, exist_ok=True)
    config = OCIO.Config.CreateFromFile(str(CONFIG))
    working = config.getProcessor("lin_rec709", "scene_linear")
    failed = False
    for groom in asked.grooms:
        name = pathlib.Path(groom).stem
        render(asked.cli, groom, asked.o / name, "none")
        plain = light_of(str(asked.o / f"{name}.exr"), "none")
        for display, view in VIEWS:
            out = asked.o / f"{name}-{view}-{display}".replace(" ", "-")
            render(asked.cli, groom, out, str(CONFIG), ["--display", display, "--view-transform", view])
            light = light_of(f"{out}.exr", str(CONFIG))
            expected = converted(working, plain)
            off = float(numpy.max(numpy.abs(light - expected) / (1e-3 + expected)))
            through = config.getProcessor("scene_linear", display, view, OCIO.TRANSFORM_DIR_FORWARD)
            codes = numpy.rint(numpy.clip(converted(through, EXPOSURE * light), 0, 1) * 255)
            shown = numpy.asarray(Image.open(f"{out}.png"))[..., :3].astype(float)
            codes_off = int(numpy.max(numpy.abs(codes - shown)))
            good = off < 1e-4 and codes_off <= 1
            failed |= not good
            print(f"{'ok  ' if good else 'FAIL'} {name}, {display}, {view}: {codes_off} of 255, light {off:.1e} by OpenColorIO {OCIO.__version__}")
    sys.exit(failed)


main()
