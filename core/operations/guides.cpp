// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "core/groom/strand_subset.h"
#include "core/operations/guide_clusters.h"
#include "core/operations/operation.h"

namespace hairloom {
namespace {

/// What InterpolationSettings may have.
std::uint32_t followersOf(std::size_t strands, std::size_t guides) {
    const auto* const field = runtime::findField<InterpolationSettings>("followPerGuide");
    const std::size_t each = (strands + guides / 2) / guides;
    return static_cast<std::uint32_t>(std::min(each, static_cast<std::size_t>(field->max)));
}

}  // namespace

void keepGuides(Groom& groom, std::span<const std::uint32_t> strands, const GuideClusters& clusters,
                bool alone) {
    const auto before = groom.strandAttributes.view<std::uint8_t>(attribute::kGuide);
    std::vector<std::uint8_t> flags(before.begin(), before.end());
    flags.resize(groom.strandCount(), 1);
    for (const std::uint32_t s : strands) flags[s] = 0;
    for (const std::uint32_t s : clusters.guides) flags[s] = 1;
    groom.strandAttributes.set(attribute::kGuide, std::move(flags));
    if (!alone) return;
    std::vector<std::uint8_t> gone(groom.strandCount(), 0);
    for (const std::uint32_t s : strands) gone[s] = 1;
    for (const std::uint32_t s : clusters.guides) gone[s] = 0;
    std::vector<std::uint32_t> kept;
    for (std::uint32_t s = 0; s < gone.size(); ++s) {
        if (gone[s] == 0) kept.push_back(s);
    }
    // Without the others some operators would make another shape of the guides: that which they have stays.
    dropOperators(groom);
    groom = strandsOf(groom, kept);
    groom.interpolation.followPerGuide = followersOf(strands.size(), clusters.guides.size());
}

Result<std::size_t> chooseGuides(Groom& groom, const GuidesSettings& settings, const Region& region) {
    if (auto status = checkFields("guides", settings); !status) return tl::unexpected(status.error());
    const std::vector<std::uint32_t> strands = strandsToEdit(groom, region);
    if (strands.empty()) return std::size_t{0};
    const GuideClusters clusters = clusterGuides(groom, strands, settings);
    keepGuides(groom, strands, clusters, settings.alone);
    return clusters.guides.size();
}

Operation guidesOperation() {
    return lastingOperation<GuidesSettings, chooseGuides>("guides", 120,
                                                          "reduces strands to a few guides by clustering");
}

}  // namespace hairloom
