// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Skeletons of UsdSkel as the file has them: joints by their paths, where they rest and where meshes were
// bound to them.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "importers/usd_values.h"

namespace hairloom {

inline constexpr std::size_t kNoJoint = SIZE_MAX;

struct UsdJoint {
    std::string path;               ///< "hips/spine/head"
    std::string name;               ///< the last of it, or all of it where joints share that; never empty
    std::size_t parent = kNoJoint;  ///< the nearest joint above, as UsdSkel has it
    Eigen::Affine3d rest = Eigen::Affine3d::Identity();   ///< to the parent's space, without animation
    Eigen::Affine3d bind = Eigen::Affine3d::Identity();   ///< to the space that meshes were bound in
    Eigen::Affine3d world = Eigen::Affine3d::Identity();  ///< `rest` to the skeleton's space
    bool isBound = true;                                  ///< `bind` can be inverted
};

/// The joints in the file's order. `words` gets what was missing. Errors: no joints, neither rest nor bind
/// transforms, more joints than are read.
Result<std::vector<UsdJoint>> readJoints(const UsdPrim& skeleton, double time,
                                         std::vector<std::string>& words);

/// Joint of each name of a list, which have no slash before; kNoJoint where there is none.
std::vector<std::size_t> jointsNamed(const std::vector<UsdJoint>& joints,
                                     const std::vector<std::string>& paths);

/// The prims from below the root down to a path, "/a/b"; none where there is no such prim.
std::vector<const UsdPrim*> primsTo(const UsdPrim& root, std::string_view path);

/// The path that a relationship of the nearest of `levels` leads to, the innermost first; nothing where none
/// has it or the nearest one has no target.
std::optional<std::string> targetOf(std::span<const UsdLevel> levels, std::string_view relationship);

/// The nearest of `levels` that has a value of the attribute.
const UsdAttribute* inheritedOf(std::span<const UsdLevel> levels, std::string_view attribute);

}  // namespace hairloom
