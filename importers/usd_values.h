// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What prims of a composed stage are at a time: values, transforms, and what is shown.

#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "core/base/math.h"
#include "importers/usd_stage.h"

namespace hairloom {

/// The value at a time, or at the first one that there is. Between samples quaternions turn the shorter way;
/// whole numbers and samples of unlike size are held.
UsdValue valueAt(const UsdAttribute& attribute, double time);

/// A prim's transform, or that of a copy that an instancer makes.
struct UsdLevel {
    const UsdPrim* prim = nullptr;
    bool isInstance = false;   ///< of `prim`, a PointInstancer
    std::size_t instance = 0;  ///< by its place in protoIndices
};

/// From the innermost level's space to the file's, in double. Errors: transforms that are none.
Result<Eigen::Affine3d> toFile(std::span<const UsdLevel> levels, double time);
/// Times at which the transforms of the levels are given.
void addTimes(std::span<const UsdLevel> levels, std::set<double>& times);

/// What is looked for in a stage: hair, or heads.
enum class UsdShape : std::uint8_t { Curves, Meshes };

/// Curves or a mesh that the stage shows.
struct UsdShownPrim {
    UsdPrim* prim = nullptr;
    std::string path;
    std::vector<UsdLevel> levels;  ///< from the root to the prim
    bool isGuide = false;          ///< its purpose is to guide others
    bool isLast = true;            ///< nobody else needs the prim's values
};

struct UsdShown {
    std::vector<UsdShownPrim> prims;
    std::vector<std::string> leftOut;  ///< "/old/hair is not visible"
};

/// Active, visible, defined prims of a shape, of purposes that pictures show, and guides; those of instancers
/// once for each of their instances. Visibility and instances are those at `time`. Errors: more copies than
/// are read.
Result<UsdShown> shownPrims(UsdPrim& root, UsdShape shape, double time);

}  // namespace hairloom
