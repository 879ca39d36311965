// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What hair looks like to the shaders of games, for writers that hold it.

#include <cstdint>
#include <vector>

#include "exporters/report.h"
#include "hairloom/asset_format.h"

namespace hairloom {

/// In the records of runtime assets (docs/formats/runtime.md).
struct HairLooks {
    std::vector<runtime::asset::Material> materials;  ///< of the hairstyle, then of layers with their own
    std::vector<std::uint16_t> tables;                ///< asset::kTableHalves for each that has tables
    std::vector<runtime::asset::HairLook> hairs;      ///< one of each follow hair; empty: all are alike
    std::vector<Finding> findings;                    ///< what does not look as in pictures
};

}  // namespace hairloom
