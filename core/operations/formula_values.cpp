// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/formula_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numeric>

#include "core/base/parallel.h"
#include "core/base/random.h"
#include "core/operations/length_constraint.h"

namespace hairloom {
namespace {

constexpr std::size_t kStrandsAtOnce = 256;
constexpr std::uint64_t kFormulaSeed = 0xf0a1;

/// Maps that formulas name.
constexpr std::array<std::pair<FormulaName, MaskMap>, 6> kNamedMaps = {
    {{FormulaName::density, MaskMap::density},
     {FormulaName::dye, MaskMap::dye},
     {FormulaName::mask1, MaskMap::mask1},
     {FormulaName::mask2, MaskMap::mask2},
     {FormulaName::mask3, MaskMap::mask3},
     {FormulaName::mask4, MaskMap::mask4}}};

/// What the names of one formula stand for, strand by strand and point by point.
class NamedValues {
  public:
    static Result<NamedValues> make(const Groom& groom, const Formula& formula) {
        NamedValues values(groom);
        if (values.uvs_.size() != groom.strandCount() &&
            (formula.names(FormulaName::u) || formula.names(FormulaName::v)))
            return fail("the formula names u or v, and the hair has no UVs", "bind it to a head with UVs");
        if (formula.names(FormulaName::density) && groom.strandCount() > 0 && groom.rootBindings().empty())
            return fail("the formula names density, and the hair is bound to no scalp",
                        "bind it to one first, or name another map");
        for (std::size_t m = 0; m < kNamedMaps.size(); ++m) {
            if (formula.names(kNamedMaps[m].first))
                values.maps_[m] = paintedValues(groom, kNamedMaps[m].second);
        }
        return values;
    }

    /// Those of a strand and its root. `lengths` are of its segments.
    void setStrand(std::size_t s, const Vec3f& root, std::span<const float> lengths,
                   FormulaValues& values) const {
        set(values, FormulaName::pi, kPi);
        set(values, FormulaName::length, std::accumulate(lengths.begin(), lengths.end(), 0.0f));
        set(values, FormulaName::random, Random(kFormulaSeed, s < ids_.size() ? ids_[s] : s).uniform());
        set(values, FormulaName::x, root.x());
        set(values, FormulaName::y, root.y());
        set(values, FormulaName::z, root.z());
        if (s < uvs_.size()) {
            set(values, FormulaName::u, uvs_[s].x());
            set(values, FormulaName::v, uvs_[s].y());
        }
    }
    void setMaps(std::size_t point, FormulaValues& values) const {
        for (std::size_t m = 0; m < maps_.size(); ++m) {
            if (!maps_[m].empty()) set(values, kNamedMaps[m].first, maps_[m][point]);
        }
    }
    static void set(FormulaValues& values, FormulaName name, float value) {
        values[static_cast<std::size_t>(name)] = value;
    }

  private:
    explicit NamedValues(const Groom& groom)
        : uvs_(groom.strandAttributes.view<Vec2f>(attribute::kRootUv)),
          ids_(groom.strandAttributes.view<std::uint32_t>(attribute::kStrandId)) {}

    std::span<const Vec2f> uvs_;
    std::span<const std::uint32_t> ids_;
    std::array<std::vector<float>, kNamedMaps.size()> maps_;
};

/// The first strand at which something went wrong, whatever thread met it.
class FirstStrand {
  public:
    void meet(std::size_t strand) {
        std::size_t before = first_;
        while (strand < before && !first_.compare_exchange_weak(before, strand)) {
        }
    }
    Status status() const {
        if (first_ == kNone) return {};
        return fail(
            fmt::format("the formula gives no number at strand {}: it divides by 0, or takes the root "
                        "or power of less than 0",
                        first_.load()),
            "max(…, 0.001) or if(…) keeps it away from there");
    }

  private:
    static constexpr std::size_t kNone = ~std::size_t{0};
    std::atomic<std::size_t> first_ = kNone;
};

}  // namespace

std::vector<MaskMap> mapsOf(const Formula& formula) {
    std::vector<MaskMap> maps;
    for (const auto& [name, map] : kNamedMaps) {
        if (formula.names(name)) maps.push_back(map);
    }
    return maps;
}

Status multiplyByFormula(const Groom& groom, const Formula& formula, std::span<const Vec3f> positions,
                         std::vector<float>& shares) {
    const auto named = NamedValues::make(groom, formula);
    if (!named) return tl::unexpected(named.error());
    FirstStrand wrong;
    parallelFor(groom.strandCount(), kStrandsAtOnce, [&](std::size_t begin, std::size_t end) {
        std::vector<float> lengths;
        FormulaValues values{};
        for (std::size_t s = begin; s < end; ++s) {
            const std::size_t first = groom.offsets[s], count = groom.offsets[s + 1] - first;
            if (count < 2) continue;
            measureSegments(positions.subspan(first, count), lengths);
            named->setStrand(s, positions[first], lengths, values);
            const float total = values[static_cast<std::size_t>(FormulaName::length)];
            float arc = 0;
            for (std::size_t i = 0; i < count; ++i) {
                arc += i > 0 ? lengths[i - 1] : 0;
                NamedValues::set(values, FormulaName::t, total > 0 ? std::min(arc / total, 1.0f) : 0.0f);
                named->setMaps(first + i, values);
                const float value = formula.at(values);
                if (!std::isfinite(value)) wrong.meet(s);
                shares[first + i] *= std::clamp(value, 0.0f, 1.0f);
            }
        }
    });
    return wrong.status();
}

Result<std::vector<float>> formulaOfStrands(const Groom& groom, const Formula& formula,
                                            std::span<const std::uint32_t> strands) {
    const auto named = NamedValues::make(groom, formula);
    if (!named) return tl::unexpected(named.error());
    const auto positions = groom.positions();
    std::vector<float> results(groom.strandCount(), 0.0f);
    FirstStrand wrong;
    parallelFor(strands.size(), kStrandsAtOnce, [&](std::size_t begin, std::size_t end) {
        std::vector<float> lengths;
        FormulaValues values{};
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t s = strands[i], first = groom.offsets[s];
            measureSegments(positions.subspan(first, groom.offsets[s + 1] - first), lengths);
            named->setStrand(s, positions[first], lengths, values);
            named->setMaps(first, values);
            results[s] = formula.at(values);
            if (!std::isfinite(results[s])) wrong.meet(s);
        }
    });
    if (auto status = wrong.status(); !status) return tl::unexpected(status.error());
    return results;
}

Result<Formula> readSettingFormula(std::string_view text) {
    auto formula = Formula::read(text);
    if (formula && formula->names(FormulaName::t))
        return fail(
            "formula: t is the place along the strand, and this setting has one value for each strand",
            "the mask takes a ramp, or a formula with t");
    return formula;
}

SettingFormulas readFormulas(JsonReader& reader, std::span<const char* const> fields) {
    SettingFormulas formulas;
    if (!reader.has("formulas")) return formulas;
    JsonReader part = reader.object("formulas");
    for (const std::string& name : part.keys()) {
        if (std::ranges::find(fields, name) == fields.end()) {
            std::string known;
            for (const char* field : fields) known += (known.empty() ? "" : ", ") + std::string(field);
            part.complain(name, fmt::format("'{}' takes no formula", name),
                          known.empty() ? "this operation takes none" : "expected one of " + known);
            break;
        }
        const std::string text = part.string(name);
        if (!part.ok()) break;
        if (const auto read = readSettingFormula(text); !read)
            part.complain(name, read.error().problem, read.error().expected);
        formulas[name] = text;
    }
    return formulas;
}

std::vector<MaskMap> mapsOf(const SettingFormulas& formulas) {
    std::vector<MaskMap> maps;
    for (const auto& [field, text] : formulas) {
        const auto formula = Formula::read(text);
        if (!formula) continue;
        for (const MaskMap map : mapsOf(*formula)) {
            if (std::ranges::find(maps, map) == maps.end()) maps.push_back(map);
        }
    }
    return maps;
}

std::string formulaState(const Groom& groom, const SettingFormulas& formulas) {
    if (formulas.empty()) return {};
    std::string state = fmt::format("uv {}", groom.strandAttributes.version(attribute::kRootUv));
    for (const MaskMap map : mapsOf(formulas)) state += ' ' + paintedState(groom, map);
    return state;
}

}  // namespace hairloom
