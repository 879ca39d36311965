// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/documents/guides_beside_hairs.h"

#include <fmt/format.h>

#include "core/groom/point_width.h"
#include "core/groom/strand_subset.h"

namespace hairloom {

std::vector<Vec3f> guidePoints(const Groom& groom, const FollowBindings& bindings,
                               std::span<const Vec3f> positions) {
    std::vector<Vec3f> points;
    for (const std::uint32_t strand : bindings.guideStrands) {
        const auto own =
            positions.subspan(groom.offsets[strand], groom.offsets[strand + 1] - groom.offsets[strand]);
        points.insert(points.end(), own.begin(), own.end());
    }
    return points;
}

Groom guidesBesideHairs(const Groom& groom, const FollowBindings& bindings, const Groom& hairs) {
    const std::size_t guides = bindings.guideCount(), strands = guides + hairs.strandCount();
    std::vector<std::uint32_t> offsets{0};
    for (const std::uint32_t guide : bindings.guideStrands)
        offsets.push_back(offsets.back() + groom.offsets[guide + 1] - groom.offsets[guide]);
    std::vector<Vec3f> points = guidePoints(groom, bindings, groom.positions());
    for (std::size_t hair = 0; hair < hairs.strandCount(); ++hair)
        offsets.push_back(offsets.back() + hairs.offsets[hair + 1] - hairs.offsets[hair]);
    points.insert(points.end(), hairs.positions().begin(), hairs.positions().end());

    Groom both = hairs;
    Groom made = makeGroom(std::move(offsets), std::move(points));
    both.offsets = made.offsets;
    both.strandAttributes = {};
    both.pointAttributes = made.pointAttributes;
    both.groupNames = groom.groupNames;

    /// Of the guides, and of each hair what its own guide has.
    const auto spread = [&]<class T>(std::string_view name, std::span<const T> ofStrands) {
        if (ofStrands.size() != groom.strandCount()) return;
        std::vector<T> values;
        for (const std::uint32_t guide : bindings.guideStrands) values.push_back(ofStrands[guide]);
        for (const auto& closest : bindings.guides)
            values.push_back(ofStrands[bindings.guideStrands[closest[0]]]);
        both.strandAttributes.set(name, std::move(values));
    };
    const std::vector<std::uint32_t> layers = layersOfStrands(groom);
    if (groom.layers.size() > 1) spread(attribute::kLayer, std::span<const std::uint32_t>(layers));
    spread(attribute::kGroup, groom.strandAttributes.view<std::uint32_t>(attribute::kGroup));
    const auto roots = groom.rootBindings();
    const auto ofHairs = hairs.rootBindings();
    if (roots.size() == groom.strandCount() && ofHairs.size() == hairs.strandCount()) {
        std::vector<SurfacePoint> all;
        for (const std::uint32_t guide : bindings.guideStrands) all.push_back(roots[guide]);
        all.insert(all.end(), ofHairs.begin(), ofHairs.end());
        both.setRootBindings(all);
    }
    const auto changes = widthChanges(groom);
    const auto ofThem = widthChanges(hairs);
    if (!changes.empty() && ofThem.size() == hairs.pointCount()) {
        std::vector<float> all;
        for (const std::uint32_t guide : bindings.guideStrands)
            all.insert(all.end(), changes.begin() + groom.offsets[guide],
                       changes.begin() + groom.offsets[guide + 1]);
        all.insert(all.end(), ofThem.begin(), ofThem.end());
        both.pointAttributes.set(attribute::kWidthChange, std::move(all));
    }
    std::vector<std::uint8_t> flags(strands, 0);
    std::vector<std::uint32_t> ids(strands);
    std::vector<Vec3f> weights(strands, Vec3f(1, 0, 0));
    for (std::size_t s = 0; s < strands; ++s) {
        flags[s] = s < guides ? 1 : 0;
        ids[s] = static_cast<std::uint32_t>(s);
        if (s >= guides) weights[s] = bindings.weights[s - guides];
    }
    for (std::size_t k = 0; k < 3; ++k) {
        std::vector<std::int32_t> closest(strands);
        for (std::size_t s = 0; s < strands; ++s) {
            // A guide without a share is the first again: every number is one of a guide.
            const bool hasShare = s >= guides && weights[s][static_cast<Eigen::Index>(k)] > 0;
            closest[s] =
                static_cast<std::int32_t>(s < guides ? s : bindings.guides[s - guides][hasShare ? k : 0]);
        }
        both.strandAttributes.set(fmt::format("groom_closest_guides_{}", k), std::move(closest));
    }
    both.strandAttributes.set("groom_guide_weights", std::move(weights));
    both.strandAttributes.set(attribute::kGuide, std::move(flags));
    both.strandAttributes.set(attribute::kStrandId, std::move(ids));
    return both;
}

}  // namespace hairloom
