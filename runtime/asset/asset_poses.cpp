// SPDX-License-Identifier: MIT
// Poses of an asset: whether they are sound, and where their points are.
#include "asset/asset_error.h"
#include "asset/pose_directions.h"
#include "hairloom/asset.h"

namespace hairloom::runtime {

using namespace asset;

std::optional<AssetError> Asset::checkPoses() const {
    const auto all = poses();
    const std::size_t segments = pointCount() - strands.size();
    if (all.size() > kMaxPoses)
        return damaged(placeOf(all.data()),
                       number(all.size()) + " poses; expected at most " + number(kMaxPoses));
    if (poseDirections().size() != all.size() * segments)
        return damaged(placeOf(poseDirections().data()), number(poseDirections().size()) + " directions of " +
                                                             number(all.size()) + " poses; expected " +
                                                             number(segments) + " of each");
    if (poseWeights().size() % pointCount() != 0)
        return damaged(placeOf(poseWeights().data()), number(poseWeights().size()) +
                                                          " weights of poses; expected " +
                                                          number(pointCount()) + " of each");
    for (const Pose& pose : all) {
        const auto wrong = [&](const char* words) {
            return damaged(placeOf(&pose), std::string("a pose ") + words);
        };
        if (pose.name.at > texts.size() || pose.name.bytes > texts.size() - pose.name.at)
            return wrong("without name");
        if (!(pose.amount >= 0 && pose.amount <= 1)) return wrong("whose amount is not from 0 to 1");
        if (pose.weights > poseWeights().size() / pointCount())
            return wrong("whose weights are not in the file");
    }
    return std::nullopt;
}

Asset::PoseArrays Asset::poseArrays(std::size_t pose, const Strands& rest) const {
    PoseArrays arrays;
    arrays.positions_ss.reserve(rest.positions_ss.size());
    const std::size_t segments = rest.positions_ss.size() - strands.size();
    const PoseDirection* direction = poseDirections().data() + pose * segments;
    for (std::size_t s = 0; s < strands.size(); ++s) {
        Float3 at;
        arrays.positions_ss.push_back(at);
        for (std::uint32_t p = rest.offsets[s] + 1; p < rest.offsets[s + 1]; ++p, ++direction) {
            at = at + directionOf(*direction) * length(rest.positions_ss[p] - rest.positions_ss[p - 1]);
            arrays.positions_ss.push_back(at);
        }
    }
    if (const std::uint32_t weights = poses()[pose].weights; weights > 0) {
        const std::size_t points = rest.positions_ss.size();
        for (const std::uint8_t weight : poseWeights().subspan((weights - 1) * points, points))
            arrays.weights.push_back(static_cast<float>(weight) / 255.0f);
    }
    return arrays;
}

}  // namespace hairloom::runtime
