// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/mask.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/base/parallel.h"
#include "core/operations/formula.h"
#include "core/operations/formula_values.h"
#include "core/operations/length_constraint.h"

namespace hairloom {
namespace {

constexpr std::size_t kGrain = 256;
constexpr std::array<const char*, 7> kMaps = {"none", "density", "dye", "mask1", "mask2", "mask3", "mask4"};
constexpr Field<Mask> kFields[] = {
    choiceField<&Mask::map>("map",
                            "painted map that sets the strength per strand. A map without paint is 0 "
                            "everywhere, except density, which is 1",
                            kMaps),
    boolField<&Mask::invert>("invert", "uses one minus the map"),
    rampField<&Mask::ramp>("ramp", "strength from root to tip"),
};

}  // namespace

std::span<const Field<Mask>> fieldsOf(const Mask&) {
    return kFields;
}

Mask readMask(JsonReader& reader) {
    Mask mask;
    if (!reader.has("mask")) return mask;
    JsonReader part = reader.object("mask");
    part.fields(mask);
    if (part.has("formula")) {
        mask.formula = part.string("formula");
        if (const auto read = Formula::read(mask.formula); !mask.formula.empty() && !read)
            part.complain("formula", read.error().problem, read.error().expected);
    }
    part.finish();
    return mask;
}

nlohmann::ordered_json toJson(const Mask& mask) {
    nlohmann::ordered_json json = fieldsToJson(mask);
    if (!mask.formula.empty()) json["formula"] = mask.formula;
    return json;
}

const std::vector<FieldRow>& scriptMaskFields() {
    static const std::vector<FieldRow> fields = fieldRows<Mask>();
    return fields;
}

namespace {

/// The maps that a mask reads, each once.
std::vector<MaskMap> mapsOf(const Mask& mask) {
    std::vector<MaskMap> maps;
    if (mask.map != MaskMap::none) maps.push_back(mask.map);
    if (mask.formula.empty()) return maps;
    if (const auto formula = Formula::read(mask.formula)) {
        for (const MaskMap map : mapsOf(*formula)) {
            if (std::ranges::find(maps, map) == maps.end()) maps.push_back(map);
        }
    }
    return maps;
}

}  // namespace

Result<std::vector<float>> maskShares(const Groom& groom, const Mask& mask,
                                      std::span<const Vec3f> positions) {
    std::vector<float> shares = paintedValues(groom, mask.map);
    const bool isEven = mask.ramp == runtime::Ramp();
    parallelFor(groom.strandCount(), kGrain, [&](std::size_t begin, std::size_t end) {
        std::vector<float> lengths;
        for (std::size_t s = begin; s < end; ++s) {
            const std::size_t first = groom.offsets[s], count = groom.offsets[s + 1] - first;
            if (mask.invert && mask.map != MaskMap::none) {
                for (std::size_t i = first; i < first + count; ++i) shares[i] = 1 - shares[i];
            }
            if (isEven || count < 2) continue;
            measureSegments(positions.subspan(first, count), lengths);
            float total = 0;
            for (const float length : lengths) total += length;
            float arc = 0;
            for (std::size_t i = 0; i < count; ++i) {
                arc += i > 0 ? lengths[i - 1] : 0;
                shares[first + i] *= mask.ramp.at(total > 0 ? std::min(arc / total, 1.0f) : 0.0f);
            }
        }
    });
    if (mask.formula.empty()) return shares;
    const auto formula = Formula::read(mask.formula);
    if (!formula) return tl::unexpected(formula.error());
    if (auto status = multiplyByFormula(groom, *formula, positions, shares); !status)
        return tl::unexpected(status.error());
    return shares;
}

bool readsMap(const Mask& mask, MaskMap map) {
    const std::vector<MaskMap> maps = mapsOf(mask);
    return std::ranges::find(maps, map) != maps.end();
}

bool readsMaps(const Mask& mask) {
    return !mapsOf(mask).empty();
}

std::string mapState(const Groom& groom, const Mask& mask) {
    std::string state;
    for (const MaskMap map : mapsOf(mask)) state += paintedState(groom, map) + ' ';
    if (!mask.formula.empty())
        state += fmt::format("uv {}", groom.strandAttributes.version(attribute::kRootUv));
    return state;
}

std::vector<Vec3f> blendShapes(const Groom& groom, std::span<const Vec3f> from, std::span<const Vec3f> to,
                               const BlendShares& shares) {
    std::vector<Vec3f> between(from.begin(), from.end());
    parallelFor(groom.strandCount(), kGrain, [&](std::size_t begin, std::size_t end) {
        std::vector<float> lengths;
        for (std::size_t s = begin; s < end; ++s) {
            const std::size_t first = groom.offsets[s], count = groom.offsets[s + 1] - first;
            const auto a = from.subspan(first, count), b = to.subspan(first, count);
            if (count < 2 || std::ranges::equal(a, b)) continue;
            std::size_t moved = 1;
            while (moved < count && !(shares.at(first + moved) > 0)) ++moved;
            if (moved == count) continue;
            const auto points = std::span(between).subspan(first, count);
            lengths.resize(count - 1);
            for (std::size_t i = moved; i < count; ++i) {
                const float share = shares.at(first + i);
                points[i] = a[i] + share * (b[i] - a[i]);
                const float was = (a[i] - a[i - 1]).norm();
                lengths[i - 1] = was + share * ((b[i] - b[i - 1]).norm() - was);
            }
            restoreLengthsByDirection(points.subspan(moved - 1), std::span(lengths).subspan(moved - 1));
        }
    });
    return between;
}

Result<std::size_t> runMasked(Groom& groom, const Mask& mask,
                              const std::function<Result<std::size_t>(Groom&)>& edit) {
    if (mask.isWhole()) return edit(groom);
    if (mask.map == MaskMap::density && groom.strandCount() > 0 && groom.rootBindings().empty())
        return fail("the mask's map is density, and the hair is bound to no scalp",
                    "bind it to one first, or another map");
    const Groom input = groom;
    const auto before = input.positions();
    // Before the edit, so that what a formula complains of does not hang on what is edited.
    const auto shares = maskShares(input, mask, before);
    if (!shares) return tl::unexpected(shares.error());
    const auto touched = edit(groom);
    if (!touched || *touched == 0) return touched;
    std::vector<Vec3f> after = blendShapes(groom, before, groom.positions(), {1, *shares});
    std::size_t changed = 0;
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        const auto first = static_cast<std::ptrdiff_t>(groom.offsets[s]);
        const auto end = static_cast<std::ptrdiff_t>(groom.offsets[s + 1]);
        changed += !std::equal(after.begin() + first, after.begin() + end, before.begin() + first);
    }
    groom.pointAttributes.set(attribute::kPosition, std::move(after));
    return changed;
}

}  // namespace hairloom
