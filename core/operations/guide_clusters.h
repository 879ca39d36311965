// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Few strands that stand for many: guides by clustering, k-means on root and shape.

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/operations/strand_edit.h"

namespace hairloom {

/// fieldsOf() describes the members.
struct GuidesSettings {
    std::uint32_t count = 200;
    float rootWeight = 1;
    bool alone = true;
    std::uint64_t seed = 1;
};
std::span<const Field<GuidesSettings>> fieldsOf(const GuidesSettings&);

struct GuideClusters {
    std::vector<std::uint32_t> guides;  ///< strands of the groom, ascending
    std::vector<std::uint32_t>
        guideOf;  ///< per strand that was asked about, in their order: a strand of the groom
    /// Distance of a strand from its guide's shape at its own root, the mean along it, millimetres.
    double meanMm = 0;
    double maxMm = 0;  ///< of the worst strand
};

/// Clusters these strands (ascending, ≥ 2 points each): distances are those of the roots, times `rootWeight`,
/// and the mean of those along both strands, from their roots. Begins as k-means++ does (Arthur and
/// Vassilvitskii 2007), then Lloyd's steps; a guide is the strand nearest to the middle of its cluster. As
/// many guides as strands where there are no more. The same for any number of threads. `progress` is told the
/// share of the work that is done, 0 to 1, on the calling thread.
GuideClusters clusterGuides(const Groom& groom, std::span<const std::uint32_t> strands,
                            const GuidesSettings& settings, const std::function<void(double)>& progress = {});

/// Marks the guides among the strands that were clustered; with `alone` the others go, as do operators, and
/// as many follow hairs come from each guide.
void keepGuides(Groom& groom, std::span<const std::uint32_t> strands, const GuideClusters& clusters,
                bool alone);

/// Both for the strands of the region. Returns the number of guides.
Result<std::size_t> chooseGuides(Groom& groom, const GuidesSettings& settings, const Region& region = {});

}  // namespace hairloom
