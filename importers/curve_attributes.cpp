// SPDX-License-Identifier: GPL-3.0-or-later
// Other programs' names of attributes: Alembic's and USD's own, Unreal's groom schema, Blender's.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <compare>
#include <limits>
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

bool isAbsent(const RawAttribute& attribute, std::size_t element) {
    return std::ranges::any_of(attribute.absent, [&](const auto& range) {
        return element >= range.first && element < range.second;
    });
}

std::size_t absentCount(const RawAttribute& attribute) {
    std::size_t count = 0;
    for (const auto& [first, second] : attribute.absent) count += second - first;
    return count;
}

void tellAbsent(RawStrands& strands, const RawAttribute& attribute, std::string what, std::string instead) {
    const std::size_t count = absentCount(attribute);
    if (count == 0) return;
    const std::size_t all = attribute.perPoint ? strands.positions.size() : strandCount(strands);
    strands.warnings.push_back(fileWarning(
        fmt::format("{} of {} {} have no {}", count, all, attribute.perPoint ? "points" : "strands", what),
        attribute.name, std::move(instead)));
}

void takeWidths(RawStrands& strands) {
    for (const std::string_view name : {"width", "widths", "groom_width"}) {
        RawAttribute* const width = find(strands, name);
        if (width == nullptr || width->type != RawAttribute::Type::Number || width->components != 1) continue;
        strands.thickness.resize(strands.positions.size());
        for (std::size_t strand = 0; strand < strandCount(strands); ++strand) {
            for (std::size_t point = strands.offsets[strand]; point < strands.offsets[strand + 1]; ++point) {
                const std::size_t element = width->perPoint ? point : strand;
                strands.thickness[point] =
                    isAbsent(*width, element) ? std::nanf("") : width->numbers[element];
            }
        }
        tellAbsent(strands, *width, "width", "they have that of the material");
        return remove(strands, width);
    }
}

/// Strands of a part without UVs take those of the nearest root that has some: (0, 0) would be a place of its
/// own on the head.
void fillRootUvs(RawStrands& strands, const RawAttribute& uv) {
    constexpr std::size_t kMostCompared = 4096;
    std::vector<std::size_t> known, unknown;
    for (std::size_t strand = 0; strand < strandCount(strands); ++strand) {
        const auto at = elementOf(strands, uv, strand);
        if (at) (isAbsent(uv, *at) ? unknown : known).push_back(strand);
    }
    tellAbsent(strands, uv, "root UV", "they have that of the nearest root with one");
    const std::size_t step = known.size() / kMostCompared + 1;
    for (const std::size_t strand : unknown) {
        const Vec3f& root = strands.positions[strands.offsets[strand]];
        float nearest = std::numeric_limits<float>::infinity();
        for (std::size_t i = 0; i < known.size(); i += step) {
            const float distance = (strands.positions[strands.offsets[known[i]]] - root).squaredNorm();
            if (!(distance < nearest)) continue;
            nearest = distance;
            strands.rootUvs[strand] = strands.rootUvs[known[i]];
        }
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
        if (!uv->absent.empty()) fillRootUvs(strands, *uv);
        return remove(strands, uv);
    }
}

/// Strands of a part without colours look as the material has them.
void fillColours(RawStrands& strands, const RawAttribute& colour) {
    const HairMaterial material;
    for (std::size_t strand = 0; strand < strandCount(strands); ++strand) {
        const std::size_t first = strands.offsets[strand], count = strands.offsets[strand + 1] - first;
        for (std::size_t i = 0; i < count; ++i) {
            if (!isAbsent(colour, first + i)) continue;
            const float t = count > 1 ? static_cast<float>(i) / static_cast<float>(count - 1) : 0;
            strands.colours[first + i] = material.rootColour + t * (material.tipColour - material.rootColour);
        }
    }
    tellAbsent(strands, colour, "colour", "they have the material's");
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
        if (!colour->absent.empty()) fillColours(strands, *colour);
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

/// Numbers, names or both. Numbers beside names stay an attribute of strands, so that they go out again.
void takeGroups(RawStrands& strands) {
    const RawAttribute* const group = find(strands, "groom_group_id");
    const RawAttribute* const named = find(strands, "groom_group_name");
    if (group == nullptr && named == nullptr) return;
    struct Key {
        bool isThere;
        std::int32_t id, text;
        auto operator<=>(const Key&) const = default;
    };
    const std::vector<std::int32_t> ids =
                                        group ? wholeOfStrands(strands, *group) : std::vector<std::int32_t>(),
                                    texts =
                                        named ? wholeOfStrands(strands, *named) : std::vector<std::int32_t>();
    std::vector<Key> keys(strandCount(strands));
    std::map<Key, std::int32_t> indices;
    for (std::size_t strand = 0; strand < keys.size(); ++strand) {
        const auto at = group ? elementOf(strands, *group, strand) : std::nullopt;
        const bool hasId = at && !isAbsent(*group, *at);
        keys[strand] = {hasId, hasId ? ids[strand] : 0, texts.empty() ? 0 : texts[strand]};
        indices.emplace(keys[strand], 0);
    }
    for (auto& [key, index] : indices) {
        std::string name = static_cast<std::size_t>(key.text) < strands.groupTexts.size()
                               ? strands.groupTexts[static_cast<std::size_t>(key.text)]
                               : std::string();
        if (name.empty()) name = key.isThere ? fmt::format("group {}", key.id) : "no group";
        const auto known = std::ranges::find(strands.groupNames, name);
        index = static_cast<std::int32_t>(known - strands.groupNames.begin());
        if (known == strands.groupNames.end()) strands.groupNames.push_back(std::move(name));
    }
    RawAttribute found{std::string(attribute::kGroup), false, RawAttribute::Type::Index, 1, {}, {}};
    for (const Key& key : keys) found.whole.push_back(indices[key]);
    std::erase_if(strands.attributes, [&](const RawAttribute& one) {
        return one.name == "groom_group_name" || (one.name == "groom_group_id" && named == nullptr);
    });
    strands.attributes.push_back(std::move(found));
}

/// Ids name strands: those that do not tell strands apart stay a plain attribute.
void takeIds(RawStrands& strands) {
    RawAttribute* const id = find(strands, "groom_id");
    if (id == nullptr) return;
    std::vector<std::int32_t> ids = wholeOfStrands(strands, *id);
    for (std::size_t strand = 0; strand < ids.size(); ++strand) {
        const auto at = elementOf(strands, *id, strand);
        if (at && isAbsent(*id, *at)) ids[strand] = -1;
    }
    const std::set<std::int32_t> different(ids.begin(), ids.end());
    if (different.size() != ids.size() || *different.begin() < 0) {
        strands.warnings.push_back(
            fileWarning("strand ids repeat or are negative", "groom_id",
                        "strands were renumbered, and the ids of the file are in \"groom_id\""));
        *id = RawAttribute{"groom_id", false, RawAttribute::Type::Whole, 1, {}, std::move(ids)};
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
    for (const RawAttribute& attribute : strands.attributes) {
        // A flag that is not set says as much.
        if (attribute.type == RawAttribute::Type::Number || attribute.type == RawAttribute::Type::Whole)
            tellAbsent(strands, attribute, attribute.name, "it is 0 there");
    }
}

}  // namespace hairloom
