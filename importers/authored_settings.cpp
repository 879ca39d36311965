// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/authored_settings.h"

#include <fmt/format.h>

#include <charconv>

#include "core/groom/file/layers_json.h"
#include "core/groom/file/operators_json.h"
#include "core/groom/file/settings_json.h"
#include "core/groom/mask_names.h"

namespace hairloom {

std::string settingsText(const Groom& groom) {
    nlohmann::ordered_json json{
        {"simulation", toJson(groom.simulation)}, {"material", toJson(groom.material)},
        {"shadows", toJson(groom.shadows)},       {"interpolation", toJson(groom.interpolation)},
        {"placement", toJson(groom.placement)},   {"spheres", toJson(groom.spheres)},
        {"layers", toJson(groom.layers)},         {"operators", toJson(groom.operators)}};
    if (!groom.maskNames.empty()) json["masks"] = maskNamesToJson(groom.maskNames);
    return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

Result<std::shared_ptr<const Groom>> readSettingsText(const std::string& file, const std::string& text) {
    const auto json = parseJson(file, text);
    if (!json) return tl::unexpected(json.error());
    auto authored = std::make_shared<Groom>();
    JsonReader reader(*json, file);
    readSettings(reader.object("simulation"), authored->simulation);
    readSettings(reader.object("material"), authored->material);
    if (reader.has("shadows")) readSettings(reader.object("shadows"), authored->shadows);
    readSettings(reader.object("interpolation"), authored->interpolation);
    readSettings(reader.object("placement"), authored->placement);
    authored->spheres = readSphereList(reader);
    authored->layers = readLayers(reader);
    authored->operators = readOperatorList(reader, readOperatorShape);
    if (reader.has("masks")) readMaskNames(reader.object("masks"), authored->maskNames);
    if (auto status = reader.status(); !status) {
        // There is no byte of the file to point at.
        return failIn(file, {}, "its settings: " + status.error().problem, status.error().expected);
    }
    return authored;
}

namespace {

/// A text that the prim has as customData or, of older files, as an attribute.
const std::string* usdText(const UsdPrim& prim, std::string_view name) {
    const std::string key = fmt::format("{}:{}", kUsdDictionary, name);
    if (const auto found = prim.customTexts.find(key); found != prim.customTexts.end()) return &found->second;
    const UsdAttribute* const attribute = prim.find(key);
    return attribute == nullptr || attribute->value.texts.empty() ? nullptr : &attribute->value.texts.front();
}

}  // namespace

void takeUsdSettings(const UsdPrim& root, const std::string& file, RawStrands& strands) {
    for (const UsdPrim& prim : root.children) {
        const std::string* const text = usdText(prim, kUsdSettings);
        if (text == nullptr) continue;
        auto authored = readSettingsText(file, *text);
        if (!authored) {
            strands.warnings.push_back(fileWarning(authored.error().problem + "; they were left out",
                                                   prim.name, authored.error().expected));
            continue;
        }
        strands.authored = std::move(*authored);
        if (const std::string* const shape = usdText(prim, kUsdShape))
            std::from_chars(shape->data(), shape->data() + shape->size(), strands.authoredShape);
        return;
    }
}

}  // namespace hairloom
