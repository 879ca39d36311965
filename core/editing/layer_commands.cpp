// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/layer_commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/editing/document.h"
#include "core/editing/records.h"
#include "core/editing/settings_commands.h"
#include "core/groom/strand_subset.h"
#include "core/operations/stack.h"

namespace hairloom::editing {
namespace {

/// The hair as its operators make it where strands are on these layers.
CommandResult withLayers(const Model& model, Groom next, std::vector<std::uint32_t> layers, std::string name,
                         std::string record) {
    next.strandAttributes.set(attribute::kLayer, std::move(layers));
    if (!next.operators.empty()) {
        StackCache own;
        auto shape = evaluateStack(next, model.stackCache ? *model.stackCache : own);
        if (!shape) return tl::unexpected(shape.error());
        next.pointAttributes.set(attribute::kPosition, std::move(*shape));
    }
    return replaceGroom(model, std::move(next), std::move(name), std::move(record));
}

Status checkLayer(const Groom& groom, std::uint32_t layer) {
    if (layer < groom.layers.size()) return {};
    return fail(fmt::format("layer {} does not exist", layer),
                fmt::format("there are {} layers", groom.layers.size()));
}

}  // namespace

CommandResult moveToLayer(const Model& model, std::span<const std::uint32_t> strands, std::uint32_t layer) {
    const Groom& groom = model.groom;
    if (auto status = checkLayer(groom, layer); !status) return tl::unexpected(status.error());
    std::vector<std::uint32_t> layers = layersOfStrands(groom);
    const bool moves = std::ranges::any_of(strands, [&](std::uint32_t s) { return layers[s] != layer; });
    if (!moves) return nullptr;
    for (const std::uint32_t s : strands) layers[s] = layer;
    return withLayers(model, groom, std::move(layers), "Move to " + groom.layers[layer].name,
                      recordOf("move_to_layer", {{"strands", runsOf(strands)}, {"layer", layer}}));
}

CommandResult removeLayer(const Model& model, std::uint32_t layer) {
    const Groom& groom = model.groom;
    if (auto status = checkLayer(groom, layer); !status) return tl::unexpected(status.error());
    if (groom.layers.size() == 1)
        return fail("the only layer cannot be removed", "expected a hairstyle with several layers");
    Groom next = groom;
    const std::uint32_t number = layer + 1;  // as regions count
    for (std::size_t i = 0; i < next.operators.size(); ++i) {
        const std::uint32_t of = layerOf(next.operators[i]);
        if (of == number) {
            return fail(fmt::format("operator {} uses the layer {}", i, groom.layers[layer].name),
                        "give the operator another region first");
        }
        if (of > number) setLayerOf(next.operators[i], of - 1);
    }
    std::vector<std::uint32_t> layers = layersOfStrands(groom);
    for (std::uint32_t& at : layers) at = at == layer ? 0 : at > layer ? at - 1 : at;
    next.layers.erase(next.layers.begin() + static_cast<std::ptrdiff_t>(layer));
    return withLayers(model, std::move(next), std::move(layers), "Remove layer " + groom.layers[layer].name,
                      recordOf("remove_layer", {{"layer", layer}}));
}

// --- As operations of a script ---

namespace {

std::uint32_t readLayerIndex(JsonReader& reader) {
    return static_cast<std::uint32_t>(reader.count("layer", 0, std::numeric_limits<std::uint32_t>::max()));
}

MakeCommand readMoveToLayer(JsonReader& reader) {
    return [strands = readRuns(reader, "strands"),
            layer = readLayerIndex(reader)](const Document& document) -> CommandResult {
        const Model& model = document.model();
        if (auto status = checkBelow(strands, model.groom.strandCount(), "strand"); !status)
            return tl::unexpected(status.error());
        return moveToLayer(model, strands, layer);
    };
}

MakeCommand readRemoveLayer(JsonReader& reader) {
    return [layer = readLayerIndex(reader)](const Document& document) {
        return removeLayer(document.model(), layer);
    };
}

constexpr RecordedOperation kLayerCommandsRecords[] = {
    {"move_to_layer", readMoveToLayer},
    {"remove_layer", readRemoveLayer},
};

}  // namespace

RecordList layerCommandsRecords() {
    return kLayerCommandsRecords;
}

}  // namespace hairloom::editing
