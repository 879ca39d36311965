// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/strand_subset.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <type_traits>

namespace hairloom {
namespace {

AttributeSet chosen(const AttributeSet& attributes, std::span<const std::uint32_t> elements) {
    AttributeSet result;
    for (const auto& [name, data] : attributes.all()) {
        std::visit(
            [&, &key = name](const auto& array) {
                using Array = std::remove_cvref_t<decltype(array)>;
                std::vector<std::remove_cvref_t<decltype(array[0])>> values;
                values.reserve(elements.size());
                for (const std::uint32_t element : elements) values.push_back(array[element]);
                result.set(key, AttributeData(Array(std::move(values))));
            },
            data);
    }
    return result;
}

}  // namespace

Groom strandsOf(const Groom& groom, std::span<const std::uint32_t> strands) {
    std::vector<std::uint32_t> offsets{0}, points;
    for (const std::uint32_t strand : strands) {
        for (std::uint32_t p = groom.offsets[strand]; p < groom.offsets[strand + 1]; ++p) points.push_back(p);
        offsets.push_back(static_cast<std::uint32_t>(points.size()));
    }
    return strandsOf(groom, strands, std::move(offsets), points);
}

Groom strandsOf(const Groom& groom, std::span<const std::uint32_t> strands,
                std::vector<std::uint32_t> offsets, std::span<const std::uint32_t> points) {
    Groom some = groom;
    some.offsets = CowArray<std::uint32_t>(std::move(offsets));
    some.pointAttributes = chosen(groom.pointAttributes, points);
    some.strandAttributes = chosen(groom.strandAttributes, strands);
    some.triangulation = {};
    return some;
}

std::vector<std::uint32_t> layersOfStrands(const Groom& groom) {
    const auto layers = groom.strandAttributes.view<std::uint32_t>(attribute::kLayer);
    std::vector<std::uint32_t> all(groom.strandCount(), 0);
    if (layers.size() == all.size()) std::ranges::copy(layers, all.begin());
    return all;
}

std::vector<std::uint32_t> strandsOfLayer(const Groom& groom, std::uint32_t layer) {
    const std::vector<std::uint32_t> layers = layersOfStrands(groom);
    std::vector<std::uint32_t> strands;
    for (std::uint32_t s = 0; s < layers.size(); ++s) {
        if (layers[s] == layer) strands.push_back(s);
    }
    return strands;
}

Result<std::vector<std::uint32_t>> strandsOfLayers(const Groom& groom, std::span<const std::string> names) {
    std::set<std::uint32_t> wanted;
    for (const std::string& name : names) {
        bool found = false;
        std::string known;
        for (std::uint32_t layer = 0; layer < groom.layers.size(); ++layer) {
            known += (layer > 0 ? ", " : "") + groom.layers[layer].name;
            if (groom.layers[layer].name != name) continue;
            wanted.insert(layer);
            found = true;
        }
        if (!found) return fail(fmt::format("no layer is called '{}'", name), "expected some of " + known);
    }
    const std::vector<std::uint32_t> layers = layersOfStrands(groom);
    std::vector<std::uint32_t> strands;
    for (std::uint32_t s = 0; s < layers.size(); ++s) {
        if (wanted.contains(layers[s])) strands.push_back(s);
    }
    return strands;
}

}  // namespace hairloom
