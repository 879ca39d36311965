// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Follow hairs from guides (thesis §4.2): wisps around one strand, the three strands of a root triangle, and
// both blended. Binding is done here, once per edit; evaluation is the engine's (runtime/follow.h).

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "core/groom/groom.h"
#include "hairloom/follow.h"

namespace hairloom {

/// Keeps a parting open. Where two guides diverge, hairs between them follow the nearer one alone, from the
/// root that they would have had. The share of the farther guide fades between the two limits of either
/// criterion. Guides of two layers always diverge.
struct PartingSettings {
    float beginAngleDegrees = 45;  ///< 0 … 180; between the guides' directions from root to tip
    float endAngleDegrees = 75;    ///< > begin
    float beginSpread = 0.7f;  ///< ≥ 0; how much farther apart two guides are than their roots, at their tips
                               ///< or at a quarter of their length, in lengths up to there
    float endSpread = 1.1f;  ///< > begin
};

/// Which guides each follow hair takes part of, and how. Arrays per hair are guide after guide. `guides`
/// index the guides of this binding, not the strands of the groom.
struct FollowBindings {
    std::uint32_t pointsPerHair = 0;          ///< of every guide and every follow hair
    std::vector<std::uint32_t> hairs;         ///< of each guide: how many follow it
    std::vector<std::uint32_t> guideStrands;  ///< strand of the groom of each guide
    std::vector<std::uint32_t> ids;           ///< of each guide: what its hairs are drawn by
    std::vector<Triangle> triangles;          ///< of guides: where hairs are drawn from
    std::vector<float> areas;                 ///< of each triangle, twice its m²
    std::vector<Mat3f>
        rootFrames;  ///< per guide at rest: columns span the scalp's tangent plane; the third is its normal
    std::vector<float> radii;   ///< per point of a hair: r_0, metres, radius of a wisp at rest
    runtime::WispMotion wisps;  ///< how those radii answer to speed

    std::vector<std::array<std::uint32_t, 3>> guides;  ///< the hair's own guide first
    std::vector<Vec3f> weights;  ///< ≥ 0, sum 1: shares of the guides in the hair's shape, partings kept open
    std::vector<Vec3f> rootWeights;  ///< ≥ 0, sum 1: barycentrics of the root in the root triangle
    std::vector<Vec2f> wispOffsets;  ///< in the unit disc, in the own guide's frame
    std::vector<float> blends;       ///< 0 wisp … 1 root triangle; 0 for guides in no triangle
    std::vector<Vec3f>
        rootShifts;  ///< metres, in the own guide's root frame: brings the hair's root onto the scalp
    std::vector<SurfacePoint> roots;  ///< on the scalp; empty without one

    std::size_t guideCount() const { return guideStrands.size(); }
    std::size_t hairCount() const { return guides.size(); }
};

/// Guides are the strands flagged as such, or all; the density of a guide's layer multiplies its hairs. Hairs
/// are random, by the seed, the guide's id and their number alone. Where the groom has no scalp, hairs are
/// rooted in the planes of their guides' roots. Root triangles are the groom's where they join guides only;
/// otherwise the guides are triangulated anew. Errors: no guides, a guide of fewer than two points, settings
/// out of range.
Result<FollowBindings> bindFollowHairs(const Groom& groom, const InterpolationSettings& settings,
                                       const PartingSettings& parting = {});

/// Points of the guides as evaluation takes them: guide after guide, `pointsPerHair` each; guides of another
/// number of points are resampled evenly. Metres.
std::vector<Vec3f> guidePositions(const Groom& groom, const FollowBindings& bindings);

/// The guides at one moment. Spans are guide after guide, `pointsPerHair` each.
struct GuideState {
    std::span<const Vec3f> positions;   ///< metres
    std::span<const Vec3f> velocities;  ///< m/s, or empty for hair at rest
    std::span<const Quatf>
        rotations;  ///< per guide: turn of the scalp at its root since rest, or empty for none
};

/// What the engine takes to evaluate hairs frame after frame. Guide g is the g-th of `guideStrands` and owns
/// points [guideOffsets[g], guideOffsets[g + 1]). A view: bindings and offsets must outlive it.
runtime::FollowView followView(const FollowBindings& bindings, std::span<const std::uint32_t> guideOffsets);

/// Fills `positions` (hair after hair, `pointsPerHair` each, metres). The same bits for any number of
/// threads. For one picture; who plays frames keeps the runtime::FollowHairs of followView(). Errors:
/// bindings that the engine refuses, such as weights that are no numbers.
Status evaluateFollowHairs(const FollowBindings& bindings, const GuideState& state,
                           std::span<Vec3f> positions);

/// What the guides around each point of a hair have there, by the hair's root; hair after hair,
/// `pointsPerHair` each. `values` are one a point of the groom.
std::vector<float> followHairValues(const Groom& groom, const FollowBindings& bindings,
                                    std::span<const float> values);

/// The same of values that are one a strand of the groom: one a hair, within those of the guides around it.
/// Empty where `ofStrands` is.
std::vector<float> followHairRootValues(const FollowBindings& bindings, std::span<const float> ofStrands);

/// The follow hairs at rest as a groom of its own, bound where the bindings are, with the widths that were
/// painted. Errors: as above.
Result<Groom> bakeFollowHairs(const Groom& groom, const FollowBindings& bindings);

}  // namespace hairloom
