// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What of a head a runtime asset needs: the triangles that roots stand on, the bones that move them,
// colliders.

#include <vector>

#include "core/groom/groom.h"
#include "core/groom/validate.h"
#include "exporters/asset_builder.h"

namespace hairloom {

struct AssetScalp {
    std::vector<asset::Root> roots;  ///< of the strands; empty without a scalp
    std::vector<asset::ScalpVertex> vertices;
    std::vector<std::uint32_t> sources;  ///< of the vertices: which of the groom's scalp
    std::vector<asset::ScalpTriangle> triangles;
    std::vector<asset::Bone> bones;
    std::vector<asset::Sphere> spheres;
    std::vector<std::uint8_t> body;  ///< the skin collider, packed; empty: none
    std::vector<Finding> findings;   ///< what there is of the head and could not be had
};

/// Of these strands of the groom. The skin comes from the groom's character file, where that has one.
AssetScalp collectScalp(const Groom& groom, std::span<const std::uint32_t> strands, AssetBuilder& builder);

}  // namespace hairloom
