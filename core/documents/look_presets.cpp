// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/documents/look_presets.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/file.h"
#include "core/groom/file/json_reader.h"
#include "core/groom/file/settings_json.h"
#include "core/shading/melanin.h"

namespace hairloom {
namespace {

// Concentrations on the scale of Chiang et al. 2016, set by eye in between.
constexpr LookPreset kPresets[] = {
    {"black", "black hair of East Asia and Africa", 6.0f, 0.0f, 0.10f},
    {"dark brown", "nearly black in the shade", 2.6f, 0.15f, 0.15f},
    {"brown", "medium brown", 1.3f, 0.2f, 0.18f},
    {"chestnut", "brown with a red shine", 0.85f, 0.55f, 0.20f},
    {"auburn", "red-brown", 0.45f, 1.0f, 0.22f},
    {"copper", "light red", 0.15f, 0.75f, 0.22f},
    {"dark blond", "between brown and blond", 0.5f, 0.2f, 0.25f},
    {"honey", "golden blond", 0.22f, 0.22f, 0.25f},
    {"blond", "blond", 0.12f, 0.08f, 0.25f},
    {"platinum", "bleached blond", 0.03f, 0.02f, 0.12f},
    {"grey", "grey hair, with less and less pigment", 0.18f, 0.0f, 0.45f},
    {"white", "hair without pigment", 0.0f, 0.0f, 0.05f},
};
constexpr std::string_view kSuffix = ".look.json";

/// The reverse of shading::absorptionOfColour(), which is (k · ln colour)²: one colour tells k.
Vec3d colourOfAbsorption(const Vec3d& absorption, double azimuthalRoughness) {
    const double half = shading::absorptionOfColour(Vec3d::Constant(0.5), azimuthalRoughness).x();
    const double k = std::sqrt(half) / std::numbers::ln2;
    return (-absorption.cwiseMax(0.0).array().sqrt() / k).exp().matrix();
}

}  // namespace

std::span<const LookPreset> lookPresets() {
    return kPresets;
}

void applyLook(const LookPreset& preset, HairMaterial& material) {
    material.eumelanin = preset.eumelanin;
    material.pheomelanin = preset.pheomelanin;
    material.colourVariation = preset.variation;
    colourByMelanin(material);
}

void colourByMelanin(HairMaterial& material) {
    const Vec3d inside = shading::absorption(
        {static_cast<double>(material.eumelanin), static_cast<double>(material.pheomelanin)});
    const Vec3f colour =
        colourOfAbsorption(inside, static_cast<double>(material.azimuthalRoughness)).cast<float>();
    // Sun and wear lighten hair towards its tip.
    constexpr float kRoot = 0.8f;
    constexpr float kTip = 1.15f;
    material.rootColour = kRoot * colour;
    material.tipColour = (kTip * colour).cwiseMin(1.0f);
}

std::vector<std::string> savedLooks(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    std::error_code missing;
    for (const auto& entry : std::filesystem::directory_iterator(folder, missing)) {
        const std::string file = entry.path().filename().string();
        if (file.size() > kSuffix.size() && file.ends_with(kSuffix)) {
            names.push_back(file.substr(0, file.size() - kSuffix.size()));
        }
    }
    std::ranges::sort(names);
    return names;
}

Result<HairMaterial> loadLook(const std::filesystem::path& folder, const std::string& name) {
    const std::string file = (folder / (name + std::string(kSuffix))).string();
    const auto text = readTextFile(file, kMaxJsonBytes);
    if (!text) return tl::unexpected(text.error());
    const auto document = parseJson(file, *text);
    if (!document) return tl::unexpected(document.error());
    HairMaterial material;
    JsonReader reader(*document, file);
    reader.fields(material);
    reader.finish();
    if (auto status = reader.status(); !status) return tl::unexpected(status.error());
    return material;
}

Status saveLook(const std::filesystem::path& folder, const std::string& name, const HairMaterial& material) {
    if (name.empty() || name.find_first_of("/\\:*?\"<>|") != std::string::npos || name.front() == '.') {
        return fail("'" + name + "' is not a valid name for a look",
                    "expected a name without / \\ : * ? \" < > |");
    }
    std::error_code problem;
    std::filesystem::create_directories(folder, problem);
    return writeFileAtomically(folder / (name + std::string(kSuffix)), toJson(material).dump(2) + "\n");
}

}  // namespace hairloom
