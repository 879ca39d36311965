// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A Python script for Unreal's editor beside a groom that was written for Unreal.

#include <filesystem>
#include <span>
#include <string>

#include "exporters/exported_attributes.h"
#include "exporters/prepared_strands.h"

namespace hairloom {

/// Imports the file into an Unreal project with the rotation and scale that it needs, looks whether groups,
/// hairs and guides arrived, and binds the groom to a skeletal mesh. Uses what the Python API of Unreal 5.1
/// to 5.7 publishes and nothing else.
std::string unrealScript(const Groom& groom, const PreparedStrands& strands,
                         std::span<const ExportedAttribute> attributes, const StrandExportOptions& options,
                         const std::filesystem::path& asset);

/// Beside the asset: "hair_unreal.py" of "hair.abc".
std::filesystem::path unrealScriptPath(const std::filesystem::path& asset);

}  // namespace hairloom
