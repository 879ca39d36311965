// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a file of strands has of settings, as the project file has them: simulation, material, interpolation,
// placement, spheres, layers and operators.

#include <memory>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/groom/groom.h"
#include "importers/raw_strands.h"
#include "importers/usd_stage.h"

namespace hairloom {

/// The dictionary in a USD prim's customData that holds them, and its text of them.
inline constexpr std::string_view kUsdDictionary = "hairloom", kUsdSettings = "settings";
/// Likewise, the hash of the points that the operators made, as a decimal number.
inline constexpr std::string_view kUsdShape = "shape";

/// JSON.
std::string settingsText(const Groom& groom);

/// A groom with these and nothing else. Errors: no JSON, unknown names, values out of range.
Result<std::shared_ptr<const Groom>> readSettingsText(const std::string& file, const std::string& text);

/// Those of the first prim below the root that has some, in version 0.1 as attributes. What is wrong with
/// them is a warning.
void takeUsdSettings(const UsdPrim& root, const std::string& file, RawStrands& strands);

}  // namespace hairloom
