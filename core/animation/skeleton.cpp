// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/animation/skeleton.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace hairloom {
namespace {

/// Bones from the roots down; those on a cycle are never reached.
std::vector<std::uint32_t> parentsFirst(const std::vector<Bone>& bones) {
    std::vector<std::vector<std::uint32_t>> children(bones.size());
    std::vector<std::uint32_t> order;
    for (std::uint32_t bone = 0; bone < bones.size(); ++bone) {
        const std::uint32_t parent = bones[bone].parent;
        if (parent == kNoBone) {
            order.push_back(bone);
        } else {
            children[parent].push_back(bone);
        }
    }
    for (std::size_t next = 0; next < order.size(); ++next) {
        const auto& below = children[order[next]];
        order.insert(order.end(), below.begin(), below.end());
    }
    return order;
}

}  // namespace

Result<Skeleton> Skeleton::make(std::vector<Bone> bones) {
    for (const Bone& bone : bones) {
        if (bone.parent != kNoBone && bone.parent >= bones.size()) {
            return fail(fmt::format("bone '{}' has the parent {}", bone.name, bone.parent),
                        fmt::format("there are {} bones", bones.size()));
        }
        if (!bone.rest.matrix().allFinite() || !bone.inverseBind.matrix().allFinite()) {
            return fail(fmt::format("bone '{}' has a matrix that is not finite", bone.name));
        }
    }
    Skeleton skeleton;
    skeleton.order_ = parentsFirst(bones);
    if (skeleton.order_.size() != bones.size()) {
        return fail(fmt::format("{} bones form a cycle", bones.size() - skeleton.order_.size()),
                    "expected every bone to lead to a root");
    }
    skeleton.bones_ = std::move(bones);
    return skeleton;
}

std::optional<std::uint32_t> Skeleton::find(std::string_view name) const {
    const auto found = std::ranges::find(bones_, name, &Bone::name);
    if (found == bones_.end()) return std::nullopt;
    return static_cast<std::uint32_t>(found - bones_.begin());
}

std::vector<Eigen::Affine3f> Skeleton::worldMatrices(std::span<const Eigen::Affine3f> local) const {
    assert(local.size() == bones_.size());
    std::vector<Eigen::Affine3f> world(local.begin(), local.end());
    for (const std::uint32_t bone : order_) {
        const std::uint32_t parent = bones_[bone].parent;
        if (parent != kNoBone) world[bone] = world[parent] * local[bone];
    }
    return world;
}

}  // namespace hairloom
