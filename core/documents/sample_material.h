// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Ready-made materials of the folder `samples/materials`.

#include <filesystem>
#include <string>
#include <vector>

#include "core/groom/groom.h"

namespace hairloom {

/// Names of the materials there, in order of name.
std::vector<std::string> sampleMaterials(const std::filesystem::path& samples);

/// Gives the groom a sample's material, or that of a JSON file of sections with fields (as `set --from`
/// takes). Fields that it does not name get their defaults. Radii that points carry go where the material
/// names some. Errors: no such material, listing those there are; a file that does not read.
Status applyMaterial(const std::filesystem::path& samples, const std::string& nameOrFile, Groom& groom);

}  // namespace hairloom
