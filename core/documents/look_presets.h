// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Looks of hair by name: those that come along, and those that a person keeps in a folder.

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/groom/material.h"

namespace hairloom {

/// Natural and dyed hair that comes along, from dark to light.
struct LookPreset {
    const char* name;  ///< "auburn"
    const char* description;
    float eumelanin, pheomelanin;  ///< as HairMaterial has them
    float variation;               ///< of colour from strand to strand, 0…1
};
std::span<const LookPreset> lookPresets();

/// Sets melanin, the colours that this melanin makes, and their variation; shape of the fibre, model and its
/// controls stay.
void applyLook(const LookPreset& preset, HairMaterial& material);

/// Gives the material the root and tip colours that its melanin makes.
void colourByMelanin(HairMaterial& material);

/// Names of the looks of a folder, in order; files NAME.look.json.
std::vector<std::string> savedLooks(const std::filesystem::path& folder);
/// Error: a file that is missing, or names fields that there are not.
Result<HairMaterial> loadLook(const std::filesystem::path& folder, const std::string& name);
/// The folder is made. Errors: a name that is no file name, a file that cannot be written.
Status saveLook(const std::filesystem::path& folder, const std::string& name, const HairMaterial& material);

}  // namespace hairloom
