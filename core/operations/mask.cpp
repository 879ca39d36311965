// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/mask.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numeric>

#include "core/base/hash.h"
#include "core/base/parallel.h"
#include "core/base/random.h"
#include "core/groom/point_dye.h"
#include "core/operations/formula.h"
#include "core/operations/length_constraint.h"

namespace hairloom {
namespace {

constexpr std::size_t kGrain = 256;
constexpr std::uint64_t kFormulaSeed = 0xf0a1;
constexpr std::array<const char*, 7> kMaps = {"none", "density", "dye", "mask1", "mask2", "mask3", "mask4"};
constexpr Field<Mask> kFields[] = {
    choiceField<&Mask::map>("map",
                            "painted map that sets the strength per strand. A map without paint is 0 "
                            "everywhere, except density, which is 1",
                            kMaps),
    boolField<&Mask::invert>("invert", "uses one minus the map"),
    rampField<&Mask::ramp>("ramp", "strength from root to tip"),
};

std::uint32_t numberOf(MaskMap map) {
    return static_cast<std::uint32_t>(map) - static_cast<std::uint32_t>(MaskMap::mask1) + 1;
}

/// The map at each point, before it is inverted.
std::vector<float> valuesOf(const Groom& groom, MaskMap map) {
    if (map == MaskMap::dye) return pointDyes(groom);
    std::vector<float> values(groom.pointCount(), map == MaskMap::none ? 1.0f : 0.0f);
    if (map == MaskMap::none) return values;
    const auto painted = map == MaskMap::density
                             ? std::span<const float>()
                             : groom.strandAttributes.view<float>(maskAttribute(numberOf(map)));
    const std::vector<SurfacePoint> roots =
        map == MaskMap::density ? groom.rootBindings() : std::vector<SurfacePoint>();
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        float value = s < painted.size() ? painted[s] : 0.0f;
        if (s < roots.size()) {
            const Triangle& corners = groom.scalp->triangles()[roots[s].triangle];
            value = groom.scalpDensity.empty() ? 1.0f : 0.0f;
            for (int c = 0; c < 3 && !groom.scalpDensity.empty(); ++c)
                value += roots[s].barycentric[c] * groom.scalpDensity[corners[static_cast<std::size_t>(c)]];
        }
        std::fill(values.begin() + groom.offsets[s], values.begin() + groom.offsets[s + 1], value);
    }
    return values;
}

}  // namespace

std::string maskAttribute(std::uint32_t number) {
    return fmt::format("mask.{}", number);
}

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

/// Maps that formulas name, where they do.
constexpr std::array<std::pair<FormulaName, MaskMap>, 6> kNamedMaps = {
    {{FormulaName::density, MaskMap::density},
     {FormulaName::dye, MaskMap::dye},
     {FormulaName::mask1, MaskMap::mask1},
     {FormulaName::mask2, MaskMap::mask2},
     {FormulaName::mask3, MaskMap::mask3},
     {FormulaName::mask4, MaskMap::mask4}}};

/// The maps that a mask reads, each once.
std::vector<MaskMap> mapsOf(const Mask& mask) {
    std::vector<MaskMap> maps;
    if (mask.map != MaskMap::none) maps.push_back(mask.map);
    if (mask.formula.empty()) return maps;
    const auto formula = Formula::read(mask.formula);
    for (const auto& [name, map] : kNamedMaps) {
        if (formula && formula->names(name) && std::ranges::find(maps, map) == maps.end())
            maps.push_back(map);
    }
    return maps;
}

/// Multiplies the shares by a formula's.
Status applyFormula(const Groom& groom, const Formula& formula, std::span<const Vec3f> positions,
                    std::vector<float>& shares) {
    const auto uvs = groom.strandAttributes.view<Vec2f>(attribute::kRootUv);
    if (uvs.size() != groom.strandCount() && (formula.names(FormulaName::u) || formula.names(FormulaName::v)))
        return fail("the formula names u or v, and the hair has no UVs", "bind it to a head with UVs");
    std::array<std::vector<float>, kNamedMaps.size()> maps;
    for (std::size_t m = 0; m < maps.size(); ++m) {
        if (formula.names(kNamedMaps[m].first)) maps[m] = valuesOf(groom, kNamedMaps[m].second);
    }
    const auto ids = groom.strandAttributes.view<std::uint32_t>(attribute::kStrandId);
    std::atomic<std::size_t> wrong = groom.strandCount();
    parallelFor(groom.strandCount(), kGrain, [&](std::size_t begin, std::size_t end) {
        std::vector<float> lengths;
        FormulaValues values{};
        const auto set = [&](FormulaName name, float value) {
            values[static_cast<std::size_t>(name)] = value;
        };
        set(FormulaName::pi, kPi);
        for (std::size_t s = begin; s < end; ++s) {
            const std::size_t first = groom.offsets[s], count = groom.offsets[s + 1] - first;
            if (count < 2) continue;
            measureSegments(positions.subspan(first, count), lengths);
            const float total = std::accumulate(lengths.begin(), lengths.end(), 0.0f);
            set(FormulaName::length, total);
            set(FormulaName::random, Random(kFormulaSeed, s < ids.size() ? ids[s] : s).uniform());
            set(FormulaName::x, positions[first].x());
            set(FormulaName::y, positions[first].y());
            set(FormulaName::z, positions[first].z());
            if (s < uvs.size()) {
                set(FormulaName::u, uvs[s].x());
                set(FormulaName::v, uvs[s].y());
            }
            float arc = 0;
            for (std::size_t i = 0; i < count; ++i) {
                arc += i > 0 ? lengths[i - 1] : 0;
                set(FormulaName::t, total > 0 ? std::min(arc / total, 1.0f) : 0.0f);
                for (std::size_t m = 0; m < maps.size(); ++m) {
                    if (!maps[m].empty()) set(kNamedMaps[m].first, maps[m][first + i]);
                }
                const float value = formula.at(values);
                if (!std::isfinite(value)) {
                    std::size_t before = wrong;
                    while (s < before && !wrong.compare_exchange_weak(before, s)) {
                    }
                }
                shares[first + i] *= std::clamp(value, 0.0f, 1.0f);
            }
        }
    });
    if (wrong == groom.strandCount()) return {};
    return fail(
        fmt::format("the formula gives no number at strand {}: it divides by 0, or takes the root or power "
                    "of less than 0",
                    wrong.load()),
        "max(…, 0.001) or if(…) keeps it away from there");
}

}  // namespace

Result<std::vector<float>> maskShares(const Groom& groom, const Mask& mask,
                                      std::span<const Vec3f> positions) {
    std::vector<float> shares = valuesOf(groom, mask.map);
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
    if (auto status = applyFormula(groom, *formula, positions, shares); !status)
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

namespace {

std::string mapState(const Groom& groom, MaskMap map) {
    switch (map) {
        case MaskMap::none:
            return {};
        case MaskMap::density:
            return fmt::format("density {:x}", hashOf(std::span<const float>(groom.scalpDensity)));
        case MaskMap::dye:
            return fmt::format("dye {} {} {}", groom.pointAttributes.version(attribute::kPointDye),
                               groom.strandAttributes.version(attribute::kDye),
                               groom.material.dyeStrength > 0);
        default:
            return fmt::format("mask {}", groom.strandAttributes.version(maskAttribute(numberOf(map))));
    }
}

}  // namespace

std::string mapState(const Groom& groom, const Mask& mask) {
    std::string state;
    for (const MaskMap map : mapsOf(mask)) state += mapState(groom, map) + ' ';
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
    if (readsMap(mask, MaskMap::density) && groom.strandCount() > 0 && groom.rootBindings().empty())
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
