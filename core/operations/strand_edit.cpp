// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/strand_edit.h"

#include <algorithm>
#include <atomic>
#include <numeric>
#include <optional>

#include "core/base/parallel.h"
#include "core/operations/length_constraint.h"

namespace hairloom {
namespace {

constexpr std::size_t kGrain = 64;
constexpr std::size_t kPointsToScreen = 20'000;  ///< fewer are searched for faster than the field is measured
constexpr Field<Region> kRegionFields[] = {
    field<&Region::point>("point", "m", -kAnywhere, kAnywhere, "a point on the plane that limits the region"),
    field<&Region::normal>(
        "normal", "", -kAnywhere, kAnywhere,
        "normal of the plane, which points to the affected side. Zero affects all strands"),
    field<&Region::fade>("fade", "m", 0, 1, "width of the edge in which strands are affected at random"),
    seedField<&Region::seed>("seed", "random seed of the edge"),
    field<&Region::layer>("layer", "", 0, 1000, "affected layer, numbered from 1: 0 is all layers"),
    field<&Region::group>("group", "", 0, 100'000,
                          "affected group of the hair file, numbered from 1: 0 is all groups"),
};

std::uint32_t idOf(const Groom& groom, std::size_t strand) {
    const auto ids = groom.strandAttributes.view<std::uint32_t>(attribute::kStrandId);
    return strand < ids.size() ? ids[strand] : static_cast<std::uint32_t>(strand);
}

std::size_t layerOf(const Groom& groom, std::size_t strand) {
    const auto layers = groom.strandAttributes.view<std::uint32_t>(attribute::kLayer);
    return strand < layers.size() ? layers[strand] : 0;
}

bool reaches(const Region& region, const Groom& groom, std::size_t strand) {
    if (region.layer != 0 && layerOf(groom, strand) + 1 != region.layer) return false;
    if (region.group != 0) {
        const auto groups = groom.strandAttributes.view<std::uint32_t>(attribute::kGroup);
        if (strand >= groups.size() || groups[strand] + 1 != region.group) return false;
    }
    if (region.normal.isZero(0.0f)) return true;
    const float distance = (groom.strand(strand)[0] - region.point).dot(region.normal.normalized());
    Random random(region.seed, idOf(groom, strand));
    return distance >= region.fade * (random.uniform() - 0.5f);
}

bool editable(const Groom& groom, std::size_t strand) {
    if (groom.offsets[strand + 1] - groom.offsets[strand] < 2) return false;
    const auto frozen = groom.strandAttributes.view<std::uint8_t>(attribute::kFrozen);
    if (strand < frozen.size() && frozen[strand] != 0) return false;
    const std::size_t layer = layerOf(groom, strand);
    return layer >= groom.layers.size() || !groom.layers[layer].locked;
}

}  // namespace

std::vector<std::uint32_t> strandsToEdit(const Groom& groom, const Region& region) {
    std::vector<std::uint32_t> strands;
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        if (editable(groom, s) && reaches(region, groom, s)) strands.push_back(static_cast<std::uint32_t>(s));
    }
    return strands;
}

std::span<const Field<Region>> fieldsOf(const Region&) {
    return kRegionFields;
}

float StrandEdit::totalLength() const {
    return std::accumulate(lengths.begin(), lengths.end(), 0.0f);
}

std::size_t editStrands(Groom& groom, const Region& region, const EditOptions& options,
                        const std::function<void(StrandEdit&)>& edit) {
    const std::vector<std::uint32_t> strands = strandsToEdit(groom, region);
    if (strands.empty()) return 0;
    const bool usesSkin = options.needsSkin || options.clearance >= 0;
    const std::shared_ptr<const SkinField> field = usesSkin ? sharedSkin(groom.scalp) : nullptr;
    const Skin* const skin = field ? &field->skin() : nullptr;
    std::optional<ScreenedSkin> screened;
    if (field && strands.size() * groom.pointCount() >= kPointsToScreen * groom.strandCount())
        screened.emplace(*field);
    const SkinQuery* const outside = screened ? &*screened : static_cast<const SkinQuery*>(skin);
    const auto before = groom.positions();
    std::vector<Vec3f> after(before.begin(), before.end());
    std::atomic<std::size_t> changed{0};
    parallelFor(strands.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        std::vector<float> lengths, turns;
        for (std::size_t i = begin; i < end && (options.cancelled == nullptr || !*options.cancelled); ++i) {
            const std::size_t s = strands[i];
            const std::size_t first = groom.offsets[s];
            const std::span<Vec3f> points = std::span(after).subspan(first, groom.offsets[s + 1] - first);
            measureSegments(points, lengths);
            measureTurns(points, turns);
            StrandEdit strand{points, lengths, turns, s, idOf(groom, s), skin, outside};
            edit(strand);
            measureSegments(points, lengths);
            if (options.turns == Turns::asMade) measureTurns(points, turns);
            settle(points, lengths, turns, options.clearance >= 0 ? outside : nullptr, options.clearance);
            changed += !std::equal(points.begin(), points.end(),
                                   before.begin() + static_cast<std::ptrdiff_t>(first));
        }
    });
    if (changed > 0) groom.pointAttributes.set(attribute::kPosition, std::move(after));
    return changed;
}

}  // namespace hairloom
