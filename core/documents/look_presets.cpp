// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/documents/look_presets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

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
    {"salt and pepper", "dark hair, of which a third of the strands are white", 2.2f, 0.05f, 0.18f, nullptr,
     R"({"greyShare": 0.35})"},
    {"grown-out roots", "bleached blond, and three centimetres of dark brown at the root", 2.4f, 0.15f, 0.18f,
     nullptr,
     R"({"dyeStrength": 0.97, "dyeColour": [0.78, 0.64, 0.44], "dyeRegrowth": 0.03, "dyeRegrowthSoftness": 0.018})"},
    {"wet", "wet hair: dark, with two narrow, strong highlights. The operator Clump sticks it together", 4.5f,
     0.15f, 0.05f,
     R"({"shadingModel": "sadeghi", "rIntensity": 4, "rWidth": 0.3, "ttIntensity": 0.5, "trtIntensity": 1.5,
         "trtWidth": 0.4, "glintIntensity": 0.3})"},
    {"peach fuzz", "fine, colourless down of skin", 0.02f, 0.02f, 0.1f, nullptr,
     R"({"rootRadius": 8e-6, "tipScale": 0.25, "tipOpacity": 0.4})"},
    {"brows", "short, thick hairs that taper", 2.4f, 0.2f, 0.12f, nullptr,
     R"({"rootRadius": 4e-5, "tipScale": 0.12})"},
    {"lashes", "dark, thick hairs with fine tips", 6.0f, 0.1f, 0.05f, nullptr,
     R"({"rootRadius": 5.5e-5, "tipScale": 0.06})"},
    {"glossy", "dark hair with one narrow, strong highlight", 3.0f, 0.1f, 0.08f,
     R"({"shadingModel": "sadeghi", "rIntensity": 2.5, "rWidth": 0.5, "trtIntensity": 0.6, "glintIntensity": 0.4})"},
    {"satin", "brown hair with wide, soft highlights and no glints", 1.2f, 0.25f, 0.12f,
     R"({"shadingModel": "sadeghi", "rIntensity": 0.7, "rWidth": 2.2, "trtWidth": 1.8, "glintIntensity": 0})"},
    {"glints", "chestnut hair that sparkles as it turns", 0.8f, 0.5f, 0.2f,
     R"({"shadingModel": "sadeghi", "rIntensity": 0.8, "trtIntensity": 1.3, "trtWidth": 0.8, "glintIntensity": 5,
         "glintWidthDegrees": 6, "glintNearDegrees": 25, "glintFarDegrees": 60})"},
    {"backlit", "blond hair that glows against the light", 0.15f, 0.15f, 0.2f,
     R"({"shadingModel": "sadeghi", "ttIntensity": 2.5, "ttAzimuthalWidth": 1.6, "ttColour": [1, 0.85, 0.6],
         "rIntensity": 0.7})"},
    {"neon", "black hair with violet and cyan highlights", 5.0f, 0.0f, 0.1f,
     R"({"shadingModel": "sadeghi", "rColour": [0.55, 0.2, 1], "rIntensity": 2.5, "rShiftDegrees": -2,
         "trtColour": [0.1, 0.9, 1], "trtIntensity": 8, "trtShiftDegrees": 8, "trtWidth": 0.8})"},
};
constexpr std::string_view kSuffix = ".look.json";

void reset(std::string_view name, HairMaterial& material) {
    const Field<HairMaterial>& field = *runtime::findField<HairMaterial>(name);
    for (std::uint32_t c = 0; c < field.components(); ++c) field.set(material, defaultValue(field, c), c);
}

/// The model's and its highlights' fields as by default.
void resetHighlights(HairMaterial& material) {
    constexpr std::string_view kControls[] = {
        "shadingModel",      "rIntensity",       "ttIntensity",    "trtIntensity",     "rWidth",
        "ttWidth",           "trtWidth",         "rShiftDegrees",  "ttShiftDegrees",   "trtShiftDegrees",
        "rColour",           "ttColour",         "trtColour",      "ttAzimuthalWidth", "glintIntensity",
        "glintWidthDegrees", "glintNearDegrees", "glintFarDegrees"};
    for (const std::string_view name : kControls) reset(name, material);
}

void setFields(const LookPreset& preset, const char* fields, HairMaterial& material) {
    const auto document = nlohmann::json::parse(fields);
    JsonReader reader(document, preset.name);
    reader.fields(material);
    assert(reader.ok());
}

/// What extras of presets have left behind.
void resetExtras(HairMaterial& material) {
    for (const LookPreset& preset : kPresets) {
        if (!preset.extras) continue;
        HairMaterial with = material;
        setFields(preset, preset.extras, with);
        if (toJson(with) != toJson(material)) continue;
        const auto extras = nlohmann::json::parse(preset.extras);
        for (const auto& [name, value] : extras.items()) reset(name, material);
    }
}

}  // namespace

std::span<const LookPreset> lookPresets() {
    return kPresets;
}

const LookPreset* findLook(std::string_view name) {
    const auto* const found =
        std::ranges::find(kPresets, name, [](const LookPreset& one) { return std::string_view(one.name); });
    return found == std::end(kPresets) ? nullptr : found;
}

void applyLook(const LookPreset& preset, HairMaterial& material) {
    resetExtras(material);
    material.eumelanin = preset.eumelanin;
    material.pheomelanin = preset.pheomelanin;
    material.colourVariation = preset.variation;
    material.colourSource = ColourSource::melanin;
    colourByMelanin(material);
    if (preset.controls) {
        resetHighlights(material);
        setFields(preset, preset.controls, material);
    }
    if (preset.extras) setFields(preset, preset.extras, material);
}

void applyLook(const LookPreset& preset, Groom& groom) {
    applyLook(preset, groom.material);
    const bool namesThickness = preset.extras && nlohmann::json::parse(preset.extras).contains("rootRadius");
    if (namesThickness) groom.pointAttributes.erase(attribute::kRadius);
}

std::vector<std::string> lookNames() {
    std::vector<std::string> names;
    for (const LookPreset& preset : kPresets) names.emplace_back(preset.name);
    return names;
}

Status applyLookOfView(const std::string& view, const std::string& name, Groom& groom) {
    if (name.empty()) return {};
    const LookPreset* const look = findLook(name);
    if (!look)
        return failIn(view, {}, fmt::format("/look is '{}'", name),
                      fmt::format("one of {}", fmt::join(lookNames(), ", ")));
    applyLook(*look, groom);
    return {};
}

void colourByMelanin(HairMaterial& material) {
    const Vec3d inside = shading::absorption(
        {static_cast<double>(material.eumelanin), static_cast<double>(material.pheomelanin)});
    const auto colour = [&](float factor) -> Vec3f {
        return shading::kajiyaColour(static_cast<double>(factor) * inside,
                                     static_cast<double>(material.azimuthalRoughness))
            .cast<float>();
    };
    material.rootColour = colour(1);
    material.tipColour = colour(material.tipMelanin);
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
