// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/file/layers_json.h"

#include "core/groom/file/settings_json.h"

namespace hairloom {

nlohmann::ordered_json toJson(const std::vector<Layer>& layers) {
    auto list = nlohmann::ordered_json::array();
    for (const Layer& layer : layers) {
        nlohmann::ordered_json entry{
            {"name", layer.name}, {"visible", layer.visible}, {"locked", layer.locked}};
        if (layer.density != Layer().density) entry["density"] = readableDecimal(layer.density);
        if (layer.material) entry["material"] = toJson(*layer.material);
        list.push_back(std::move(entry));
    }
    return list;
}

std::vector<Layer> readLayers(JsonReader& reader) {
    std::vector<Layer> layers;
    for (JsonReader& entry : reader.objects("layers")) {
        Layer layer{entry.string("name"), entry.boolean("visible"), entry.boolean("locked"), 1, {}};
        if (entry.has("density"))
            layer.density =
                static_cast<float>(entry.number("density", 0, static_cast<double>(kMaxLayerDensity)));
        if (entry.has("material")) {
            layer.material.emplace();
            readSettings(entry.object("material"), *layer.material);
        }
        entry.finish();
        layers.push_back(std::move(layer));
    }
    return layers;
}

}  // namespace hairloom
