// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Guides as the proposed schemas of USD have deformable curves ("PhysicsCurvesDeformableSimAPI" and what goes
// with it), which simulators read before USD's own library knows them.

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "exporters/exported_parts.h"

namespace hairloom {

/// A property of a prim.
struct UsdField {
    std::string type, name;  ///< "float", "physics:density"
    bool isUniform = false;
    std::string interpolation;  ///< empty: none
    /// A text is a token.
    std::variant<float, Vec3f, std::string, std::vector<std::int32_t>, std::vector<Vec3f>> value;
};
/// A prim, or what one has beside the rest.
struct UsdNode {
    std::string type, name;
    std::vector<std::string> schemas;
    std::vector<UsdField> fields;
    std::vector<std::pair<std::string, std::string>> targets;  ///< names and paths of relationships
    std::vector<UsdNode> children;
};

struct UsdPhysics {
    std::vector<UsdNode> ofParts;  ///< what each part has more; empty of those that follow
    UsdNode beside;                ///< below /groom: gravity, the material, and what holds the roots
};
/// Of the guides where there are hairs beside them, else of all strands, at `positions`. `name` is free below
/// /groom. Stiffnesses are those of the groom's settings at the root, for a round fibre as thick as the mean.
UsdPhysics usdPhysics(const Groom& groom, const PreparedStrands& strands, std::span<const ExportedPart> parts,
                      const std::string& name);

/// Unit vectors across each segment that leaves a point, turned no further along a strand than it bends.
std::vector<Vec3f> framesAlong(std::span<const Vec3f> strand);

}  // namespace hairloom
