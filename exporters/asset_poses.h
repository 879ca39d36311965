// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Poses of a groom as a runtime asset has them (docs/formats/runtime.md): directions of segments, and how
// much of the amount each point takes.

#include <string>
#include <vector>

#include "exporters/asset_builder.h"
#include "exporters/prepared_strands.h"
#include "hairloom/asset.h"

namespace hairloom {

struct AssetPoses {
    std::vector<asset::Pose> records;  ///< their names are the caller's to put into the text
    std::vector<std::string> names;
    std::vector<asset::PoseDirection> directions;
    std::vector<std::uint8_t> weights;
    std::vector<Finding> findings;  ///< of poses that are left out, or that nothing follows
};

/// Poses that have a shape, of the strands that are written.
AssetPoses encodePoses(const Groom& groom, const PreparedStrands& strands);

/// How far points of the asset's poses are from the groom's, both with the strands' lengths; metres.
double poseError(const Groom& groom, const PreparedStrands& strands, const runtime::Asset& written);

}  // namespace hairloom
