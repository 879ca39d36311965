# SPDX-License-Identifier: GPL-3.0-or-later
"""Exports grooms in every format, has each file checked by a program that is not Hairloom, and writes what came out as
the table of docs/exchange.md. Fails where a judge finds other counts, or a point farther than 0.001 mm."""
import argparse
import json
import math
import os
import subprocess
import sys

import odd_grooms
import plain_readers

CLOSE_MM = 0.001
MOVING = ("abc", "abc-unreal", "usda", "usdc")
LAST_FRAME = 3

# format, what comes in, what a judge makes of what goes out
ROWS = [
    ("abc", "curves of every basis, animated", "Blender"),
    ("abc-unreal", "as abc, Unreal's groom schema", "Blender"),
    ("usda", "BasisCurves, NurbsCurves, HermiteCurves of composed stages, animated", "Pixar's usd-core"),
    ("usdc", "as usda", "Pixar's usd-core"),
    ("hair", "yes", "a reader of its own page"),
    ("tfx", "versions 3 and 4", "a reader of its own page"),
    ("ply", "lists of vertices, edges", "a reader of its own page"),
    ("obj-lines", "lines, curves of degree 1 to 7, rational or not", "a reader of its own page"),
    ("obj-c4d", "ribbons of three orders", "a reader of its own page"),
]


def run(cli, *words):
    done = subprocess.run([cli, *words, "--json"], capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(f"{' '.join(words)}: {done.stderr.strip()}")
    return json.loads(done.stdout)


def materialx_inputs():
    """Inputs and outputs of each node that MaterialX defines."""
    import MaterialX
    library = MaterialX.createDocument()
    MaterialX.loadLibraries(MaterialX.getDefaultDataLibraryFolders(), MaterialX.getDefaultDataSearchPath(), library)
    return {node.getName(): {"inputs:" + one.getName() for one in node.getInputs()} |
            {"outputs:" + one.getName() for one in node.getOutputs()} for node in library.getNodeDefs()}


def check_shaders(stage):
    """Of MaterialX, which usd-core does not have: nodes that there are, and their inputs."""
    from pxr import UsdShade
    known = None
    for prim in stage.Traverse():
        name = UsdShade.Shader(prim).GetIdAttr().Get() if prim.IsA(UsdShade.Shader) else None
        if not name or not name.startswith("ND_"):
            continue
        known = known or materialx_inputs()
        if name not in known:
            raise ValueError(f"{prim.GetPath()}: MaterialX has no node {name}")
        extra = {one for one in prim.GetAuthoredPropertyNames() if one != "info:id"} - known[name]
        if extra:
            raise ValueError(f"{prim.GetPath()}: {name} has no {sorted(extra)}")


def read_usd(path, frame=None):
    from pxr import Usd, UsdGeom, UsdValidation
    stage = Usd.Stage.Open(path)
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    problems = [problem for problem in UsdValidation.ValidationContext(validators).Validate(stage)
                if "shaderId 'ND_" not in problem.GetErrorAsString()]
    if problems:
        raise ValueError(problems[0].GetErrorAsString())
    check_shaders(stage)
    strands = []
    for prim in stage.Traverse():
        if not prim.IsA(UsdGeom.BasisCurves):
            continue
        curves = UsdGeom.BasisCurves(prim)
        points = curves.GetPointsAttr().Get() if frame is None else curves.GetPointsAttr().Get(frame)
        counts = list(curves.GetCurveVertexCountsAttr().Get())
        # Pixar's library adds nothing up by itself.
        widths = curves.GetWidthsAttr().Get()
        if len(widths) != len(points):
            raise ValueError(f"{len(widths)} widths for {len(points)} points")
        for primvar in UsdGeom.PrimvarsAPI(prim).GetPrimvars():
            expected = {"vertex": len(points), "uniform": len(counts)}.get(primvar.GetInterpolation())
            if expected is not None and len(primvar.Get()) != expected:
                raise ValueError(f"{primvar.GetName()} has {len(primvar.Get())} values")
        scale = UsdGeom.GetStageMetersPerUnit(stage)
        strands += plain_readers.split([tuple(scale * c for c in p) for p in points], counts)
    return strands


def read_blender(path, frame=None):
    judge = os.path.join(os.path.dirname(__file__), "blender_judge.py")
    words = [] if frame is None else [str(frame)]
    done = subprocess.run([odd_grooms.blenders()[-1], judge, path, *words], capture_output=True, text=True)
    lines = [line for line in done.stdout.splitlines() if line.startswith("CURVES")]
    if not lines:
        raise ValueError(f"Blender ended with {done.returncode}: {done.stderr.strip()[-200:]}")
    return json.loads(lines[0][len("CURVES"):])


def worst_mm(found, expected):
    if [len(strand) for strand in found] != [len(strand) for strand in expected]:
        raise ValueError(f"{len(found)} strands of {sum(map(len, found))} points; expected {len(expected)} of "
                         f"{sum(map(len, expected))}")
    return max((1000 * math.dist(a, b) for f, e in zip(found, expected) for a, b in zip(f, e)), default=0)


def judged(row, groom, folder, cli, blender):
    """Error in mm by the judge, and the report of the export."""
    name, _, judge = row
    path = os.path.join(folder, f"{os.path.basename(groom)}.{name}.{name.split('-')[0]}")
    words = ["export", groom, "--format", name, "--output-unit", "m", "--up", "y", "--force", "-o", path]
    # The same points in all formats: TressFX has 16 on every strand.
    report = run(cli, *words, "--points", "16")
    if judge == "Blender" and not blender:
        return None, report
    truth = os.path.join(folder, f"{os.path.basename(groom)}.truth.hair")
    run(cli, "export", groom, "--format", "hair", "--points", "16", "--force", "-o", truth)
    read = {"Blender": read_blender, "Pixar's usd-core": read_usd}.get(judge)
    if read is None:
        read = getattr(plain_readers, "read_" + name.replace("-", "_"))
    worst = worst_mm(read(path), plain_readers.read_hair(truth))
    if name in MOVING:
        worst = max(worst, moving(read, words, path, truth, groom, cli))
    return worst, report


def moving(read, words, path, truth, groom, cli):
    """Error in mm of the last frame of simulated hair."""
    record = path + ".frames"
    run(cli, "simulate", groom, "--motion", "nod", "--frames", str(LAST_FRAME + 1), "--record", record, "--force")
    run(cli, *words, "--points", "16", "--record", record, "--frames", f"0,{LAST_FRAME}")
    run(cli, "export", groom, "--format", "hair", "--points", "16", "--record", record, "--frames",
        f"{LAST_FRAME},{LAST_FRAME}", "--force", "-o", truth)
    return worst_mm(read(path, LAST_FRAME), plain_readers.read_hair(truth))


def check_guides(groom, folder, cli, blender):
    """Hairs with their guides beside them, deformable: usd-core tells both apart, every hair names guides that there are, and
    Blender shows the hairs alone."""
    from pxr import Usd, UsdGeom
    path = os.path.join(folder, os.path.basename(groom) + ".all.usdc")
    hairs = run(cli, "export", groom, "--what", "hairs", "--format", "usdc", "--force", "-o", path)["strands"]
    both = run(cli, "export", groom, "--what", "all", "--physics", "--format", "usdc", "--force", "-o", path)["strands"]
    read_usd(path)
    stage = Usd.Stage.Open(path)
    counts, guides, named = {}, set(), set()
    for prim in stage.Traverse():
        if not prim.IsA(UsdGeom.BasisCurves):
            continue
        purpose = UsdGeom.Imageable(prim).ComputePurpose()
        counts[purpose] = counts.get(purpose, 0) + len(UsdGeom.Curves(prim).GetCurveVertexCountsAttr().Get())
        primvars = UsdGeom.PrimvarsAPI(prim)
        if purpose == "guide":
            guides |= set(primvars.GetPrimvar("groom_id").Get())
            rest = prim.GetAttribute("physics:restShapePoints").Get()
            if rest != UsdGeom.Curves(prim).GetPointsAttr().Get():
                raise ValueError(f"{prim.GetPath()}: a rest shape of {len(rest)} points")
        else:
            for k in range(3):
                named |= set(primvars.GetPrimvar(f"groom_closest_guides_{k}").Get())
    if counts != {"default": hairs, "guide": both - hairs} or not named <= guides:
        raise ValueError(f"{counts} of {hairs} hairs and {both - hairs} guides; {len(named - guides)} guides are named that are not there")
    if blender and len(read_blender(path)) != hairs:
        raise ValueError(f"Blender shows {len(read_blender(path))} strands of {hairs} hairs")
    return counts


def main():
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--cli", required=True)
    options.add_argument("--table", help="page whose table is written anew")
    options.add_argument("-o", "--output", required=True)
    options.add_argument("grooms", nargs="+")
    asked = options.parse_args()
    os.makedirs(asked.output, exist_ok=True)
    blender = bool(odd_grooms.blenders())
    if not blender:
        print("skipped: Blender's judgement, since its module bpy is not there for this Python")
    failed, lines = 0, []
    try:
        print(f"guides beside hairs: {check_guides(asked.grooms[0], asked.output, asked.cli, blender)}")
    except (RuntimeError, ValueError) as problem:
        print(f"FAILED guides beside hairs: {problem}")
        failed += 1
    for row in ROWS:
        name, comes_in, judge = row
        errors, own, carried = [], [], set()
        for groom in asked.grooms:
            try:
                error, report = judged(row, groom, asked.output, asked.cli, blender)
            except (RuntimeError, ValueError) as problem:
                print(f"FAILED {name} {groom}: {problem}")
                failed += 1
                continue
            if error is not None:
                errors.append(error)
            own.append(report["max_error_mm"])
            carried |= {attribute["name"] for attribute in report["attributes"]}
        verdict = f"{max(errors):.2g} mm" if errors else "not checked"
        if errors and max(errors) > CLOSE_MM:
            failed += 1
        print(f"{name}: {judge}: {verdict}")
        lines.append(f"| `{name}` | {comes_in} | {'yes, moving' if name in MOVING else 'yes'} | {', '.join(sorted(carried)) or 'widths'} | {judge} | {verdict} |")
    if asked.table and not failed:
        text = open(asked.table).read()
        begin, end = text.index("| format |"), text.index("<!-- end of the table -->")
        head = "| format | in | out | attributes of the samples | checked by | farthest point |\n|---|---|---|---|---|---|\n"
        with open(asked.table, "w") as page:
            page.write(text[:begin] + head + "\n".join(lines) + "\n" + text[end:])
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
