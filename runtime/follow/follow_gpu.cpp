// SPDX-License-Identifier: MIT
#include "follow/follow_gpu.h"

#include "follow/number_bits.h"

namespace hairloom::runtime {
namespace {

shaders::float4 follow4(Float3 v, float w = 0.0f) {
    return {v.x, v.y, v.z, w};
}

}  // namespace

shaders::FollowBinding followBinding(const FollowView& view, std::size_t hair) {
    const float blend = view.blends[hair];
    const Float3 weights = view.weights[hair] * blend;
    const Float3 roots = (view.rootWeights[hair] - view.weights[hair]) * blend;
    auto guides = view.guides[hair];
    // What is no number would show even through a weight of 0.
    if (weights.y == 0.0f && roots.y == 0.0f) guides[1] = guides[0];
    if (weights.z == 0.0f && roots.z == 0.0f) guides[2] = guides[0];
    shaders::FollowBinding binding;
    binding.guides = {guides[0], guides[1], guides[2], 0};
    binding.weights = follow4(weights, 1.0f - blend);
    binding.roots = follow4(roots);
    binding.shift = follow4(view.rootShifts[hair]);
    binding.wisp = {(1.0f - blend) * view.wispOffsets[hair][0], (1.0f - blend) * view.wispOffsets[hair][1], 0,
                    0};
    return binding;
}

shaders::FollowPlane followPlane(const RootPlane& plane) {
    return {follow4(plane.x), follow4(plane.y), follow4(plane.normal)};
}

Vector<std::array<float, 2>> followSamples(const FollowView& view) {
    Vector<std::array<float, 2>> all;
    Vector<GuideSample> samples;
    for (std::size_t g = 0; g + 1 < view.guideOffsets.size(); ++g) {
        const std::uint32_t first = view.guideOffsets[g], count = view.guideOffsets[g + 1] - first;
        samples.clear();
        if (count == view.pointsPerHair) {
            for (std::uint32_t p = 0; p < count; ++p) samples.push_back({p, 0.0f});
        } else {
            sampleEvenly(view.guideRestPositions_ss.subspan(first, count), view.pointsPerHair, samples);
        }
        for (const GuideSample& sample : samples)
            all.push_back({fromBitsOf<float>(first + sample.segment), sample.share});
    }
    return all;
}

}  // namespace hairloom::runtime
