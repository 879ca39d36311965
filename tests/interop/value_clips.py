# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes USD stages whose curves and transforms lie in value clips, at random, imports each with hairloom-cli as a record,
and compares it with what usd-core reads from the stage at many times: clips in text and binary, times that jump, run
backwards or at another pace, sublayers and references with offsets, manifests, templates, gaps, sets in an order."""
import argparse
import json
import os
import random
import subprocess
import sys

from pxr import Gf, Sdf, Usd, UsdGeom, Vt

TOLERANCE = 2e-6  # m
RATE = 48.0       # frames of a record


def layer(folder, name):
    path = os.path.join(folder, name)
    if os.path.exists(path):
        os.remove(path)
    return Sdf.Layer.CreateNew(path)


def line(rng, strands):
    return [Gf.Vec3f(rng.uniform(-1, 1), rng.uniform(-1, 1), 0.1 * p) for _ in range(strands) for p in range(3)]


def make_clip(folder, name, rng, strands, codes, below):
    made = layer(folder, name)
    prim = Sdf.CreatePrimInLayer(made, "/clip")
    if rng.random() < 0.9 or not below:
        points = Sdf.AttributeSpec(prim, "points", Sdf.ValueTypeNames.Point3fArray)
        for code in codes:
            made.SetTimeSample(points.path, code, line(rng, strands))
    moving = Sdf.CreatePrimInLayer(made, "/clip/kid")
    move = Sdf.AttributeSpec(moving, "xformOp:translate", Sdf.ValueTypeNames.Double3)
    for code in codes:
        made.SetTimeSample(move.path, code, Gf.Vec3d(rng.uniform(-1, 1), rng.uniform(-1, 1), 0))
    made.Save()


def define_curves(made, path, strands):
    prim = Sdf.CreatePrimInLayer(made, path)
    prim.specifier = Sdf.SpecifierDef
    prim.typeName = "BasisCurves"
    for name, kind, value in (("type", Sdf.ValueTypeNames.Token, "linear"),
                              ("curveVertexCounts", Sdf.ValueTypeNames.IntArray, [3] * strands),
                              ("widths", Sdf.ValueTypeNames.FloatArray, [0.0001])):
        spec = Sdf.AttributeSpec(prim, name, kind, Sdf.VariabilityUniform if name == "type" else Sdf.VariabilityVarying)
        spec.default = value
        if name == "widths":
            spec.SetInfo("interpolation", "constant")
    return prim


def random_times(rng, active):
    """Stage times and those of clips: straight, held, backwards, with jumps."""
    times = []
    for stage, _ in active:
        if times:
            times.append((stage, rng.uniform(0, 6)))
        begin = rng.choice((0.0, rng.uniform(0, 3)))
        times.append((stage, begin))
    times.append((active[-1][0] + rng.choice((2.0, 4.0)), rng.uniform(0, 6)))
    return times


def make(folder, number, rng):
    ext = rng.choice(("usda", "usdc"))
    strands, count = rng.randint(1, 3), rng.randint(1, 4)
    name = f"clips{number}"
    isTemplate = rng.random() < 0.2
    files, active = [], []
    at = float(rng.randint(0, 5))
    for k in range(count):
        codes = sorted({float(rng.randint(0, 12)) / 2 for _ in range(rng.randint(1, 5))})
        file = f"{name}.{k + 1:03d}.{ext}"
        if isTemplate:
            codes = sorted({k + 1.0, *(k + 1 + code / 3 for code in codes)})
        make_clip(folder, file, rng, strands, codes, k > 0)
        files.append(f"./{file}")
        active.append((at, float(k)))
        at += rng.choice((1.0, 2.0, 2.5, 3.0))
    if not isTemplate and rng.random() < 0.4:  # a clip plays twice
        active.append((at, float(rng.randrange(count))))
    clips = {"primPath": "/clip"}
    if isTemplate:
        clips.update(templateAssetPath=f"./{name}.###.{ext}", templateStartTime=1.0, templateEndTime=float(count + 1),
                     templateStride=1.0)
        if rng.random() < 0.5:
            clips["templateActiveOffset"] = rng.choice((-0.5, 0.25))
    else:
        clips.update(assetPaths=Sdf.AssetPathArray([Sdf.AssetPath(file) for file in files]),
                     active=Vt.Vec2dArray([Gf.Vec2d(*pair) for pair in active]))
        if rng.random() < 0.8:
            clips["times"] = Vt.Vec2dArray([Gf.Vec2d(*pair) for pair in random_times(rng, active)])
    if rng.random() < 0.3:
        manifest = layer(folder, f"{name}.manifest.{ext}")
        prim = Sdf.CreatePrimInLayer(manifest, "/clip")
        points = Sdf.AttributeSpec(prim, "points", Sdf.ValueTypeNames.Point3fArray)
        points.default = line(rng, strands)
        kid = Sdf.CreatePrimInLayer(manifest, "/clip/kid")
        Sdf.AttributeSpec(kid, "xformOp:translate", Sdf.ValueTypeNames.Double3).default = Gf.Vec3d(0.5, 0, 0)
        manifest.Save()
        clips["manifestAssetPath"] = Sdf.AssetPath(f"./{name}.manifest.{ext}")
    inner = layer(folder, f"{name}.topology.{ext}")
    inner.defaultPrim = "hair"
    define_curves(inner, "/hair", strands)
    kid = define_curves(inner, "/hair/kid", strands)
    Sdf.AttributeSpec(kid, "points", Sdf.ValueTypeNames.Point3fArray).default = line(rng, strands)
    Sdf.AttributeSpec(kid, "xformOp:translate", Sdf.ValueTypeNames.Double3)
    order = Sdf.AttributeSpec(kid, "xformOpOrder", Sdf.ValueTypeNames.TokenArray, Sdf.VariabilityUniform)
    order.default = ["xformOp:translate"]
    if rng.random() < 0.5:  # weaker than the clips
        points = Sdf.AttributeSpec(inner.GetPrimAtPath("/hair"), "points", Sdf.ValueTypeNames.Point3fArray)
        points.default = line(rng, strands)
    inner.Save()
    anchor = layer(folder, f"{name}.anchor.{ext}")
    anchor.defaultPrim = "hair"
    prim = Sdf.CreatePrimInLayer(anchor, "/hair")
    sets = {"default": clips}
    if rng.random() < 0.2:  # one that is not asked, or goes behind
        sets["another"] = dict(clips, primPath="/nowhere")
    prim.SetInfo("clips", sets)
    if "another" in sets and rng.random() < 0.5:
        prim.SetInfo("clipSets", Sdf.StringListOp.CreateExplicit(["default"]))
    way = rng.choice(("sublayer", "reference"))
    if way == "sublayer":
        anchor.subLayerPaths.append(f"./{name}.topology.{ext}")
    else:
        prim.specifier = Sdf.SpecifierDef
        prim.referenceList.Prepend(Sdf.Reference(f"./{name}.topology.{ext}"))
    anchor.Save()
    root = layer(folder, f"{name}.{ext}")
    offset = Sdf.LayerOffset(*rng.choice(((0, 1), (10, 1), (3, 2))))
    if rng.random() < 0.5:
        root.subLayerPaths.append(f"./{name}.anchor.{ext}")
        root.subLayerOffsets[0] = offset
    else:
        prim = Sdf.CreatePrimInLayer(root, "/hair")
        prim.specifier = Sdf.SpecifierDef
        prim.referenceList.Prepend(Sdf.Reference(f"./{name}.anchor.{ext}", layerOffset=offset))
    root.pseudoRoot.SetInfo("metersPerUnit", 1.0)
    root.pseudoRoot.SetInfo("upAxis", "Y")
    root.Save()
    return root.realPath


def positions(made, code):
    """Of all curves that have points at a time, in the stage's space; None where one has none."""
    found = []
    for path in ("/hair", "/hair/kid"):
        prim = UsdGeom.BasisCurves(made.GetPrimAtPath(path))
        points = prim.GetPointsAttr().Get(code)
        if not points:
            return None
        where = UsdGeom.XformCache(code).GetLocalToWorldTransform(prim.GetPrim())
        found += [where.Transform(Gf.Vec3d(p)) for p in points]
    return found


def run(cli, *words):
    done = subprocess.run([cli, *words, "--json"], capture_output=True, text=True)
    if done.returncode != 0:
        raise ValueError(f"{' '.join(words)}: {done.stderr.strip()[-300:]}")
    return json.loads(done.stdout)


def compare(cli, folder, path):
    made = Usd.Stage.Open(path)
    codes = set()
    for prim in ("/hair", "/hair/kid"):
        for attribute in ("points", "xformOp:translate"):
            found = made.GetPrimAtPath(prim).GetAttribute(attribute)
            codes.update(found.GetTimeSamples() if found else [])
    shapes = [positions(made, code) for code in sorted(codes)]
    if any(shape is None for shape in shapes) or all(shape == shapes[0] for shape in shapes):
        return None
    record, project, out = path + ".frames", path + ".hairloom", path + ".out.usda"
    came = run(cli, "import", path, "-o", project, "--record", record, "--fps", str(RATE), "--force")
    run(cli, "export", project, "--format", "usda", "-o", out, "--record", record, "--frames", f"0,{came['frames'] - 1}", "--force")
    read = Usd.Stage.Open(out)
    curves = [UsdGeom.BasisCurves(prim) for prim in read.Traverse() if prim.GetTypeName() == "BasisCurves"]
    worst, frames = None, sorted(curves[0].GetPointsAttr().GetTimeSamples())
    rate = made.GetTimeCodesPerSecond()
    # The record begins at the first time at which anything moves: what is held before it may go without.
    for start in sorted(codes):
        farthest = 0.0
        for index, frame in enumerate(frames):
            ours = [p for one in curves for p in one.GetPointsAttr().Get(frame)]
            theirs = positions(made, start + index * rate / RATE)
            if len(ours) != len(theirs):
                raise ValueError(f"{len(ours)} points of {len(theirs)}")
            farthest = max(farthest, *((Gf.Vec3d(a) - b).GetLength() for a, b in zip(ours, theirs)))
            if worst is not None and farthest > worst:
                break
        worst = farthest if worst is None else min(worst, farthest)
        if worst < TOLERANCE:
            break
    if worst > TOLERANCE:
        raise ValueError(f"a point is {worst:g} m from where usd-core has it")
    return len(frames)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cli", required=True)
    parser.add_argument("--count", type=int, default=60)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("-o", "--output", required=True)
    options = parser.parse_args()
    os.makedirs(options.output, exist_ok=True)
    failed = compared = frames = 0
    for number in range(options.count):
        path = make(options.output, number, random.Random(1000 * options.seed + number))
        try:
            found = compare(options.cli, options.output, path)
            compared += found is not None
            frames += found or 0
        except ValueError as error:
            failed += 1
            print(f"{os.path.basename(path)}: {error}")
    print(f"value clips: {compared} stages of {options.count} compared with usd-core in {frames} frames, {failed} differ")
    if compared < options.count / 3:
        print("too few stages have points throughout")
        return 1
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
