# SPDX-License-Identifier: GPL-3.0-or-later
"""Exports a groom of three layers for each program, has the file read by that program or by the library that it reads it
with, and writes what arrives as the table of targets in docs/exchange.md. Fails where strands or layers that a format
has do not arrive, where Blenders disagree, and where hair comes back from Blender or USD without its layers."""
import argparse
import json
import os
import sys

from pxr import Gf, Sdf, UsdGeom, UsdShade

import alembic_judge
import odd_grooms
import plain_readers

WHAT = ("strands", "widths", "layers", "ids", "colours", "own attribute", "material", "settings")
LAYERS = ("Fringe", "Crown", "Tail")

# program, target or none, format, who judges
ROWS = (
    ("Blender, USD", "blender", "usdc", "Blender"),
    ("Blender, Alembic", None, "abc", "Blender"),
    ("Blender, OBJ", None, "obj-lines", "Blender"),
    ("Houdini, USD", "houdini", "usdc", "usd-core"),
    ("Maya, USD", "maya", "usda", "usd-core"),
    ("Houdini and Maya, Alembic", None, "abc", "Alembic's library"),
    ("Unreal", "unreal", "abc-unreal", "Alembic's library"),
    ("Unity", "unity", "abc", "Alembic's library"),
    ("TressFX", "tressfx", "tfx", "a reader of its page"),
    ("Jolt", "jolt", "hair", "a reader of its page"),
    ("scripts, OBJ", "plain", "obj-lines", "a reader of its page"),
    ("Cinema 4D", "plain", "obj-c4d", "a reader of its page"),
    ("scripts, PLY", None, "ply", "a reader of its page"),
)


def make_groom(cli, folder):
    made = odd_grooms.stage(folder, "targets.usdc")
    for k, name in enumerate(LAYERS):
        prim = odd_grooms.curves(made, f"/groom/{name}", k + 2, x=0.1 * k, points=8)
        prim.CreateWidthsAttr([0.0001 + 0.00001 * k] * (8 * (k + 2)))
        prim.SetWidthsInterpolation("vertex")
        odd_grooms.primvar(prim, "groom_id", Sdf.ValueTypeNames.IntArray, "uniform",
                           [100 * k + s for s in range(k + 2)])
        odd_grooms.primvar(prim, "groom_color", Sdf.ValueTypeNames.Color3fArray, "vertex",
                           [Gf.Vec3f(0.2, 0.1, 0.05 * k)] * (8 * (k + 2)))
        odd_grooms.primvar(prim, "wet", Sdf.ValueTypeNames.FloatArray, "uniform", [0.25] * (k + 2))
    made.Save()
    project = os.path.join(folder, "targets.hairloom")
    odd_grooms.run(cli, "import", os.path.join(folder, "targets.usdc"), "-o", project, "--force")
    return project


def by_blender(path, blender):
    objects = odd_grooms.blender_objects(path, blender)
    hair = [one for one in objects if one["type"] == "CURVES"] or [one for one in objects if "scalp" not in one["name"]]
    names = {name for one in hair for name in one["attributes"]}
    arrived = set()
    if sum(one["points"] for one in hair) == 8 * 9:
        arrived.add("strands")
    if all("radius" in one and 4e-5 < one["radius"][0] < 7e-5 for one in hair):
        arrived.add("widths")
    if {odd_grooms.legal(one["name"]) for one in hair} >= {odd_grooms.legal(name) for name in LAYERS}:
        arrived.add("layers")
    arrived |= {what for what, name in (("ids", "groom_id"), ("colours", "groom_color"), ("own attribute", "wet"))
                if name in names}
    if all(one["materials"] for one in hair):
        arrived.add("material")
    return arrived


def by_usd(path):
    stage, prims = odd_grooms.shown(path)
    for prim in prims:
        odd_grooms.check_prim(prim)
    arrived = {"strands"} if odd_grooms.strands_of(prims) == 9 else set()
    unit = UsdGeom.GetStageMetersPerUnit(stage)
    widths = [width * unit for prim in prims for width in UsdGeom.Curves(prim).GetWidthsAttr().Get()]
    if len(widths) == 72 and all(9e-5 < width < 1.3e-4 for width in widths):
        arrived.add("widths")
    if {prim.GetName() for prim in prims} == set(LAYERS):
        arrived.add("layers")
    for what, name in (("ids", "groom_id"), ("colours", "groom_color"), ("own attribute", "wet")):
        if all(UsdGeom.PrimvarsAPI(prim).HasPrimvar(name) for prim in prims):
            arrived.add(what)
    if all(UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial()[0] for prim in prims):
        arrived.add("material")
    settings = stage.GetDefaultPrim().GetCustomDataByKey("hairloom:settings")
    if settings and "simulation" in json.loads(settings):
        arrived.add("settings")
    return arrived


def by_alembic(path):
    objects = alembic_judge.curves_of(path)
    for one in objects:
        alembic_judge.check(one)
    arrived = {"strands"} if sum(len(one["counts"]) for one in objects) == 9 else set()
    if all(one["widths"] for one in objects):
        arrived.add("widths")
    groups = {text for one in objects for text in one["properties"].get("groom_group_name", (None, []))[1]}
    if set(LAYERS) in ({one["path"].split("/")[2] for one in objects}, groups):
        arrived.add("layers")
    names = set.intersection(*(set(one["properties"]) for one in objects))
    return arrived | {what for what, name in (("ids", "groom_id"), ("colours", "groom_color"), ("own attribute", "wet"))
                      if name in names}


def by_reader(path, form, report):
    """Strands by a reader of the format's page; of the rest what the export's own read-back found, and groups of OBJ."""
    read = getattr(plain_readers, "read_" + form.replace("-", "_"))
    arrived = {"strands"} if len(read(path)) == 9 else set()
    carried = {attribute["name"] for attribute in report["attributes"]}
    for what, names in (("widths", {"radius"}), ("ids", {"id"}), ("colours", {"point_colour", "point_color"}),
                        ("own attribute", {"wet"})):
        if carried & names:
            arrived.add(what)
    if form.startswith("obj"):
        with open(path, encoding="utf-8") as text:
            if [line[2:-1] for line in text if line.startswith("g ")] == list(LAYERS):
                arrived.add("layers")
        if form == "obj-c4d":
            arrived.add("widths")
    return arrived


def row_of(cli, folder, project, row, all_blenders):
    program, target, form, judge = row
    words = ["export", project, "--force"]
    if target:
        words += ["--target", target]
    words += ["--format", form]
    path = os.path.join(folder, f"target-{odd_grooms.legal(program)}.{form.split('-')[0]}")
    if judge == "Blender" and not all_blenders:
        return None
    report = odd_grooms.run(cli, *words, "-o", path)
    if judge == "Blender":
        arrived = [by_blender(path, blender) for blender in all_blenders]
        if any(one != arrived[0] for one in arrived):
            raise ValueError(f"Blenders disagree: {[sorted(one) for one in arrived]}")
        return arrived[0]
    if judge == "usd-core":
        return by_usd(path)
    if judge == "Alembic's library":
        return by_alembic(path)
    return by_reader(path, form, report)


def comes_back(cli, folder, project, form):
    """Whether a file of the groom, written and read, has its layers."""
    path = os.path.join(folder, "back." + form)
    again = path + ".hairloom"
    odd_grooms.run(cli, "export", project, "--format", form, "-o", path, "--force")
    odd_grooms.run(cli, "import", path, "-o", again, "--force")
    return odd_grooms.layers_of(cli, again) == odd_grooms.layers_of(cli, project)


def comes_back_from(cli, folder, project, blender):
    """Whether hair that goes to Blender as USD or Alembic, is exported there as USD and read again, has its layers."""
    wanted = [(odd_grooms.legal(name), count) for name, count in odd_grooms.layers_of(cli, project)]
    for form in ("usdc", "abc"):
        path = os.path.join(folder, "to-blender." + form)
        out = os.path.join(folder, f"from-blender-{form}.usdc")
        odd_grooms.run(cli, "export", project, "--target", "blender", "--format", form, "-o", path, "--force")
        odd_grooms.blender_objects(path, blender, "--usd", out)
        again = out + ".hairloom"
        odd_grooms.run(cli, "import", out, "-o", again, "--force")
        found = [(odd_grooms.legal(name), count) for name, count in odd_grooms.layers_of(cli, again)]
        if sorted(found) != sorted(wanted):
            raise ValueError(f"{form}: layers {wanted} came back from Blender as {found}")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cli", required=True)
    parser.add_argument("--table", help="page whose table of targets is written anew")
    parser.add_argument("-o", "--output", required=True)
    asked = parser.parse_args()
    os.makedirs(asked.output, exist_ok=True)
    found = odd_grooms.blenders()
    versions = [odd_grooms.version_of(blender) for blender in found]
    project = make_groom(asked.cli, asked.output)
    failed, lines = 0, []
    for row in ROWS:
        try:
            arrived = row_of(asked.cli, asked.output, project, row, found)
        except (ValueError, KeyError) as problem:
            print(f"FAILED {row[0]}: {problem}")
            failed += 1
            continue
        if arrived is None:
            print(f"skipped: {row[0]}, since Blender's module bpy is not there for this Python")
            continue
        if "strands" not in arrived:
            print(f"FAILED {row[0]}: strands do not arrive")
            failed += 1
        print(f"{row[0]}: {', '.join(what for what in WHAT if what in arrived)}")
        cells = " | ".join("yes" if what in arrived else "–" for what in WHAT)
        judge = f"Blender {', '.join(versions)}" if row[3] == "Blender" else row[3]
        lines.append(f"| {row[0]} | {judge} | {cells} |")
    for form in ("usda", "usdc", "abc"):
        if not comes_back(asked.cli, asked.output, project, form):
            print(f"FAILED {form}: layers do not come back")
            failed += 1
    for blender, version in zip(found, versions):
        try:
            comes_back_from(asked.cli, asked.output, project, blender)
            print(f"to Blender {version}, to USD and back: with its layers")
        except (ValueError, KeyError) as problem:
            print(f"FAILED Blender {version}: {problem}")
            failed += 1
    if asked.table and not failed and found:
        with open(asked.table, encoding="utf-8") as page:
            text = page.read()
        begin, end = text.index("| program |"), text.index("<!-- end of the table of targets -->")
        head = "| program | read by | " + " | ".join(WHAT) + " |\n|" + "---|" * (len(WHAT) + 2) + "\n"
        with open(asked.table, "w", encoding="utf-8") as page:
            page.write(text[:begin] + head + "\n".join(lines) + "\n" + text[end:])
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
