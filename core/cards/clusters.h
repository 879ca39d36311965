// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Bundles of strands that a strip each can stand for.

#include "core/cards/strip.h"

namespace hairloom::cards {

struct ClusterOptions {
    std::uint32_t most = 200;  ///< bundles, ≥ 1
    float goodEnough =
        0;  ///< metres; no bundle is split whose strands are that near to their strip, root mean square
};

struct Cluster {
    std::vector<std::uint32_t> strands;  ///< ascending, at least one
    Strip strip;                         ///< stations of the hair
    double error = 0;                    ///< sum over the strands of weight · m² off the strip
};

/// Of `strands`, ascending, at least one; others stay out. The bundle of the most error is split until there
/// are enough: along the direction in which its strands differ most, off the surface before across it, since
/// a strip can be wide but not thick. Then strands change over to the strip that they lie nearest to. At last
/// bundles are parted whose roots do not hang together, since a strip over both would cover the skin between.
/// In order of their first strand. The same for any number of threads. Errors: stopped.
Result<std::vector<Cluster>> clusterHair(const EvenHair& hair, std::vector<std::uint32_t> strands,
                                         std::span<const Vec3f> rootNormals_ws, const ClusterOptions& options,
                                         Cancel cancel);

/// Strands whose roots hang together: no farther from the next than a few times what is usual among them. By
/// size, the largest first.
std::vector<std::vector<std::uint32_t>> byRoots(const EvenHair& hair, std::span<const std::uint32_t> strands);

}  // namespace hairloom::cards
