// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/corner_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace hairloom {

std::optional<CornerValues> CornerValues::make(std::vector<float> numbers, std::uint32_t components,
                                               std::vector<std::int64_t> places, std::optional<Scope> scope,
                                               const MeshCounts& mesh, std::string& problem) {
    const std::size_t count = places.empty() ? numbers.size() / components : places.size();
    const std::array<std::pair<Scope, std::size_t>, 4> rows{{{Scope::Corner, mesh.corners},
                                                             {Scope::Point, mesh.points},
                                                             {Scope::Face, mesh.faces},
                                                             {Scope::Constant, 1}}};
    const auto row = std::ranges::find_if(
        rows, [&](const auto& known) { return known.second == count && (!scope || *scope == known.first); });
    if (row == rows.end()) {
        problem = fmt::format("{} values do not fit {} corners, {} points and {} faces", count, mesh.corners,
                              mesh.points, mesh.faces);
        return std::nullopt;
    }
    CornerValues values;
    values.scope_ = row->first;
    values.components_ = components;
    values.numbers_ = std::move(numbers);
    values.places_ = std::move(places);
    return values;
}

const float* CornerValues::at(std::size_t corner, std::size_t point, std::size_t face) const {
    std::size_t place = scope_ == Scope::Corner  ? corner
                        : scope_ == Scope::Point ? point
                        : scope_ == Scope::Face  ? face
                                                 : 0;
    if (!places_.empty()) {
        const std::int64_t named = places_[place];
        if (named < 0) return nullptr;
        place = static_cast<std::size_t>(named);
    }
    return place < numbers_.size() / components_ ? &numbers_[place * components_] : nullptr;
}

}  // namespace hairloom
