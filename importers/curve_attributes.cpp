// SPDX-License-Identifier: GPL-3.0-or-later
// Other programs' names of attributes: Alembic's and USD's own, Unreal's groom schema, Blender's.

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "importers/curve_set.h"

namespace hairloom {
namespace {

RawAttribute* find(RawStrands& strands, std::string_view name) {
    const auto found = std::ranges::find(strands.attributes, name, &RawAttribute::name);
    return found == strands.attributes.end() ? nullptr : &*found;
}

void remove(RawStrands& strands, const RawAttribute* attribute) {
    strands.attributes.erase(strands.attributes.begin() + (attribute - strands.attributes.data()));
}

std::size_t strandCount(const RawStrands& strands) {
    return strands.offsets.size() - 1;
}

/// The element of a strand: its own, or its first point's; nothing of a strand without points.
std::optional<std::size_t> elementOf(const RawStrands& strands, const RawAttribute& attribute,
                                     std::size_t strand) {
    if (!attribute.perPoint) return strand;
    if (strands.offsets[strand] == strands.offsets[strand + 1]) return std::nullopt;
    return strands.offsets[strand];
}

/// Values of strands from either kind of number; fractions are cut.
std::vector<std::int32_t> wholeOfStrands(const RawStrands& strands, const RawAttribute& attribute) {
    std::vector<std::int32_t> values(strandCount(strands));
    for (std::size_t strand = 0; strand < values.size(); ++strand) {
        const auto at = elementOf(strands, attribute, strand);
        if (!at) continue;
        if (attribute.type != RawAttribute::Type::Number) {
            values[strand] = attribute.whole[*at];
        } else {
            const float value = attribute.numbers[*at * attribute.components];
            values[strand] = std::abs(value) < 2e9f ? static_cast<std::int32_t>(value) : 0;
        }
    }
    return values;
}

void takeWidths(RawStrands& strands) {
    for (const std::string_view name : {"width", "widths", "groom_width"}) {
        RawAttribute* const width = find(strands, name);
        if (width == nullptr || width->type != RawAttribute::Type::Number || width->components != 1) continue;
        strands.thickness.resize(strands.positions.size());
        for (std::size_t strand = 0; strand < strandCount(strands); ++strand) {
            for (std::size_t point = strands.offsets[strand]; point < strands.offsets[strand + 1]; ++point)
                strands.thickness[point] = width->numbers[width->perPoint ? point : strand];
        }
        return remove(strands, width);
    }
}

void takeRootUvs(RawStrands& strands) {
    for (const std::string_view name : {"groom_root_uv", "surface_uv_coordinate", "uv", "st"}) {
        RawAttribute* const uv = find(strands, name);
        if (uv == nullptr || uv->type != RawAttribute::Type::Number || uv->components < 2) continue;
        for (std::size_t strand = 0; strand < strandCount(strands); ++strand) {
            const auto at = elementOf(strands, *uv, strand);
            const float* const first = at ? &uv->numbers[*at * uv->components] : nullptr;
            strands.rootUvs.push_back(first ? Vec2f(first[0], first[1]) : Vec2f(Vec2f::Zero()));
        }
        return remove(strands, uv);
    }
}

void takeColours(RawStrands& strands) {
    for (const std::string_view name : {"groom_color", "displayColor"}) {
        RawAttribute* const colour = find(strands, name);
        if (colour == nullptr || !colour->perPoint || colour->type != RawAttribute::Type::Number ||
            colour->components < 3)
            continue;
        for (std::size_t point = 0; point < strands.positions.size(); ++point) {
            const float* const c = &colour->numbers[point * colour->components];
            strands.colours.emplace_back(c[0], c[1], c[2]);
        }
        // A fourth component is kept under the file's name.
        if (colour->components == 3) remove(strands, colour);
        return;
    }
}

void takeGuides(RawStrands& strands) {
    RawAttribute* const guide = find(strands, "groom_guide");
    if (guide == nullptr) return;
    RawAttribute flags{std::string(attribute::kGuide), false, RawAttribute::Type::Flag, 1, {}, {}};
    for (const std::int32_t value : wholeOfStrands(strands, *guide))
        flags.whole.push_back(value != 0 ? 1 : 0);
    *guide = std::move(flags);
}

void takeGroups(RawStrands& strands) {
    RawAttribute* const group = find(strands, "groom_group_id");
    if (group == nullptr) return;
    const std::vector<std::int32_t> ids = wholeOfStrands(strands, *group);
    std::map<std::int32_t, std::int32_t> indices;
    for (const std::int32_t id : ids) indices.emplace(id, 0);
    for (auto& [id, index] : indices) {
        index = static_cast<std::int32_t>(strands.groupNames.size());
        strands.groupNames.push_back(fmt::format("group {}", id));
    }
    RawAttribute found{std::string(attribute::kGroup), false, RawAttribute::Type::Index, 1, {}, {}};
    for (const std::int32_t id : ids) found.whole.push_back(indices[id]);
    *group = std::move(found);
}

/// Ids name strands: those that do not tell strands apart stay a plain attribute.
void takeIds(RawStrands& strands) {
    RawAttribute* const id = find(strands, "groom_id");
    if (id == nullptr) return;
    const std::vector<std::int32_t> ids = wholeOfStrands(strands, *id);
    const std::set<std::int32_t> different(ids.begin(), ids.end());
    if (different.size() != ids.size() || *different.begin() < 0) {
        strands.warnings.push_back(
            fileWarning("strand ids repeat or are negative", "groom_id",
                        "strands were renumbered, and the ids of the file are in \"groom_id\""));
        return;
    }
    *id = RawAttribute{std::string(attribute::kStrandId), false, RawAttribute::Type::Index, 1, {}, ids};
}

}  // namespace

void adoptAttributes(RawStrands& strands) {
    if (strandCount(strands) == 0) return;
    takeWidths(strands);
    takeRootUvs(strands);
    takeColours(strands);
    takeGuides(strands);
    takeGroups(strands);
    takeIds(strands);
}

}  // namespace hairloom
