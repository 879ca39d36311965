// SPDX-License-Identifier: MIT
#pragma once
// Which guides each follow hair takes part of, drawn at random: by the seed, a guide's id and the hair's
// number alone, so that an asset holds a few numbers in place of tens of thousands of hairs.

#include <array>
#include <cstdint>
#include <span>

#include "hairloom/follow.h"
#include "hairloom/host.h"
#include "hairloom/math.h"
#include "hairloom/memory.h"

namespace hairloom::runtime {

/// Keeps a parting open: where two guides diverge, hairs between them follow the nearer one alone. The share
/// of the farther guide fades between the two limits of either criterion.
struct PartingLimits {
    float beginAngleDegrees, endAngleDegrees;  ///< between the guides' directions from root to tip
    float beginSpread, endSpread;  ///< how much farther apart two guides are than their roots, at their tips
                                   ///< or at a quarter of their length, in lengths up to there
};

struct FollowRecipe {
    static constexpr float kQuarter = 0.25f;  ///< of a guide's length: where `quarters_ss` lie

    std::uint64_t seed = 1;
    std::span<const std::uint32_t> hairs;  ///< of each guide
    float blend = 0;                       ///< 0 wisp … 1 root triangle
    bool drawGuides = false;               ///< the first hair of each guide is the guide itself
    PartingLimits parting{};
    std::span<const std::uint32_t> ids;  ///< of each guide: its hairs stay the same while others come and go
    /// Of each guide. Hairs follow guides of their own layer alone. Empty: all are of one.
    std::span<const std::uint32_t> layers;
    std::span<const Float3> roots_ss;  ///< of each guide
    std::span<const Float3>
        quarters_ss;                  ///< of each guide, at a quarter of its length. Empty: tips alone count
    std::span<const Float3> tips_ss;  ///< of each guide
    std::span<const float> lengths;   ///< of each guide, metres
    std::span<const std::array<std::uint32_t, 3>> triangles;  ///< of guides
    std::span<const float> areas;                             ///< of each triangle, in any unit
};

/// As FollowView has them: all of the first guide, then all of the next.
struct DrawnHairs {
    Vector<std::array<std::uint32_t, 3>> guides;
    Vector<Float3> weights, rootWeights;
    Vector<std::array<float, 2>> wispOffsets;
    Vector<float> blends;
};

/// Triangles must name guides that there are. The same bits for any number of threads.
DrawnHairs drawFollowHairs(const FollowRecipe& recipe, const Host& host = {});

/// The direction in which a hair's root is put onto the scalp: the mean of its guides' normals, in the root
/// plane of its own guide. Of unit length.
Float3 shiftDirection(std::span<const RootPlane> planes_ss, const std::array<std::uint32_t, 3>& guides,
                      Float3 rootWeights);

/// Metres.
float polylineLength(std::span<const Float3> points);

/// The point at `share` 0 … 1 of the length of a polyline of at least one point.
Float3 pointAtShare(std::span<const Float3> points, float share);

/// Half the width of a wisp at each of `points` ≥ 2 points of a hair, metres: straight from root to tip.
Vector<float> wispRadii(float root, float tip, std::uint32_t points);

}  // namespace hairloom::runtime
