// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Looks of hair by name: those that come along, and those that a person keeps in a folder.

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/groom/groom.h"

namespace hairloom {

/// Natural hair that comes along, from dark to light, hair that has been through something, hair of the face,
/// then looks that turn Sadeghi's controls (thesis, Figures 13 and 33).
struct LookPreset {
    const char* name;  ///< "auburn"
    const char* description;
    float eumelanin, pheomelanin;  ///< as HairMaterial has them
    float variation;               ///< of colour from strand to strand, 0…1
    /// Other fields of the material as a JSON object, the model among them; null: they stay.
    const char* controls = nullptr;
    /// Fields beside model and highlights, which stay; null: none.
    const char* extras = nullptr;
};
std::span<const LookPreset> lookPresets();
/// The preset of that name, or null.
const LookPreset* findLook(std::string_view name);

/// Sets melanin, which is what colours the hair from then on, the colours that this melanin makes, and their
/// variation. Presets with controls set the
/// model and all controls of its highlights, of which those that they do not name get their defaults. What
/// else there is stays, as the shape of the fibre, streaks and dye. Extras that another preset has set and
/// that are still as it has them get their defaults first.
void applyLook(const LookPreset& preset, HairMaterial& material);
/// Of the groom's material. Radii that points carry go where the look names the thickness.
void applyLook(const LookPreset& preset, Groom& groom);

std::vector<std::string> lookNames();
/// That of a view: `name` as the file `view` has it; nothing where it is empty. Error: no such look.
Status applyLookOfView(const std::string& view, const std::string& name, Groom& groom);

/// Gives the material the root and tip colours with which Kajiya-Kay shows the melanin of root and tip as
/// Marschner does.
void colourByMelanin(HairMaterial& material);

/// Names of the looks of a folder, in order; files NAME.look.json.
std::vector<std::string> savedLooks(const std::filesystem::path& folder);
/// Error: a file that is missing, or names fields that there are not.
Result<HairMaterial> loadLook(const std::filesystem::path& folder, const std::string& name);
/// The folder is made. Errors: a name that is no file name, a file that cannot be written.
Status saveLook(const std::filesystem::path& folder, const std::string& name, const HairMaterial& material);

}  // namespace hairloom
