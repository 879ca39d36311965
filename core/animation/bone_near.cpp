// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/animation/bone_near.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hairloom {
namespace {

float distanceToSegment(const Vec3f& point, const Vec3f& a, const Vec3f& b) {
    const Vec3f along = b - a;
    const float squared = along.squaredNorm();
    const float t = squared > 0 ? std::clamp((point - a).dot(along) / squared, 0.0f, 1.0f) : 0.0f;
    return (point - (a + t * along)).norm();
}

}  // namespace

std::string boneNear(const Skeleton& skeleton, const Vec3f& point_ss) {
    const auto& bones = skeleton.bones();
    // Where a bone is in the mesh's rest space is the reverse of what takes that space to the bone's.
    const auto joint = [&](std::size_t bone) -> Vec3f {
        return bones[bone].inverseBind.inverse().translation();
    };
    std::string nearest;
    float minimum = std::numeric_limits<float>::max();
    const auto offer = [&](std::size_t bone, float distance) {
        if (distance >= minimum) return;
        minimum = distance;
        nearest = bones[bone].name;
    };
    for (std::size_t b = 0; b < bones.size(); ++b) {
        // What lies beyond the end of a segment is as near to its last joint: it hangs on that.
        offer(b, (point_ss - joint(b)).norm());
        const std::uint32_t parent = bones[b].parent;
        if (parent != kNoBone) offer(parent, distanceToSegment(point_ss, joint(parent), joint(b)));
    }
    return nearest;
}

std::string boneUnder(const Actor& actor, const Vec3f& centre_ss, float radius) {
    constexpr float kNear = 0.1f;  // of the radius
    const auto positions = actor.mesh().positions();
    const SkinWeights& skin = actor.skin();
    std::vector<double> sums(actor.skeleton().bones().size(), 0.0);
    for (std::size_t v = 0; v < skin.vertexCount(); ++v) {
        if (std::abs((positions[v] - centre_ss).norm() - radius) > kNear * radius) continue;
        for (std::size_t i = 0; i < skin.weights[v].size(); ++i)
            sums[skin.bones[v][i]] += static_cast<double>(skin.weights[v][i]);
    }
    const auto most = std::ranges::max_element(sums);
    if (most == sums.end() || !(*most > 0)) return boneNear(actor.skeleton(), centre_ss);
    return actor.skeleton().bones()[static_cast<std::size_t>(most - sums.begin())].name;
}

}  // namespace hairloom
