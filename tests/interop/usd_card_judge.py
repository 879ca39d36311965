# SPDX-License-Identifier: GPL-3.0-or-later
"""usd_card_judge.py FILE.usda…: has Pixar's usd-core judge cards, each variant of them; fails on any error."""

import sys

from pxr import Usd, UsdGeom, UsdShade, UsdValidation


def triangles_of(mesh):
    """Of a mesh that is sound, in a material; says what is wrong with others."""
    counts = mesh.GetFaceVertexCountsAttr().Get()
    points = mesh.GetPointsAttr().Get()
    sound, why = UsdGeom.Mesh.ValidateTopology(mesh.GetFaceVertexIndicesAttr().Get(), counts, len(points))
    material, _ = UsdShade.MaterialBindingAPI(mesh.GetPrim()).ComputeBoundMaterial()
    if not sound or not material:
        raise SystemExit(f"{mesh.GetPath()}: {why or 'no material'}")
    return len(counts)


def main():
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    failed = False
    for file in sys.argv[1:]:
        stage = Usd.Stage.Open(file)
        levels = stage.GetDefaultPrim().GetVariantSets().GetVariantSet("lod")
        triangles = []
        for name in levels.GetVariantNames():
            levels.SetVariantSelection(name)
            meshes = [UsdGeom.Mesh(prim) for prim in stage.Traverse() if prim.IsA(UsdGeom.Mesh)]
            triangles += [triangles_of(mesh) for mesh in meshes]
        errors = UsdValidation.ValidationContext(validators).Validate(stage)
        print(f"{file}: {len(errors)} errors, triangles of its levels {triangles}")
        for error in errors:
            print(f"  {error.GetName()}: {error.GetMessage()}")
        failed = failed or bool(errors) or not triangles
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
