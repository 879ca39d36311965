// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/penetration.h"

#include <algorithm>

#include "core/base/parallel.h"
#include "core/groom/spheres.h"

namespace hairloom::editing {
namespace {

constexpr std::size_t kGrain = 256;
constexpr float kInside = 1e-6f;

float depthAt(const Vec3f& point, const ColliderDistance& colliders, const SkinQuery* skin) {
    const float depth = skin ? std::max(0.0f, -skin->distanceAt(point).distance) : 0.0f;
    return std::max(depth, -colliders(point));
}

}  // namespace

Penetration penetrationOf(std::span<const std::uint32_t> offsets, std::span<const Vec3f> positions,
                          std::span<const CollisionSphere> spheres, const SkinQuery* skin) {
    Penetration result;
    result.perPoint.assign(positions.size(), 0.0f);
    const std::size_t strands = offsets.empty() ? 0 : offsets.size() - 1;
    const ColliderDistance colliders(spheres);
    parallelFor(strands, kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) {
            for (std::uint32_t p = offsets[s] + 1; p < offsets[s + 1]; ++p)
                result.perPoint[p] = depthAt(positions[p], colliders, skin);
        }
    });
    for (const float depth : result.perPoint) {
        result.worst = std::max(result.worst, depth);
        result.points += depth > kInside ? 1 : 0;
    }
    return result;
}

}  // namespace hairloom::editing
