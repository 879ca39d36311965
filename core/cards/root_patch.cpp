// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cards/root_patch.h"

#include <algorithm>

namespace hairloom::cards {
namespace {

constexpr std::size_t kLeft = 20;  // one root in so many lies beyond each end

/// The ends of what holds nearly all.
std::pair<float, float> spanOf(std::vector<float> values) {
    std::ranges::sort(values);
    const std::size_t out = values.size() / kLeft;
    return {values[out], values[values.size() - 1 - out]};
}

}  // namespace

RootPatch rootPatch(const EvenHair& hair, std::span<const std::uint32_t> strands, const Strip& strip,
                    std::span<const Vec3f> rootNormals_ws) {
    RootPatch patch;
    Vec3f normal = Vec3f::Zero(), mean = Vec3f::Zero();
    for (const std::uint32_t s : strands) {
        normal += rootNormals_ws[s];
        mean += hair.strand(s)[0] / static_cast<float>(strands.size());
    }
    patch.normal = normal.norm() > 1e-6f ? Vec3f(normal.normalized()) : Vec3f::UnitY();
    const Vec3f flow = strip.centre.back() - strip.centre.front();
    const Vec3f flat = flow - flow.dot(patch.normal) * patch.normal;
    patch.along = flat.norm() > 1e-6f ? Vec3f(flat.normalized()) : patch.normal.unitOrthogonal();
    patch.across = patch.normal.cross(patch.along);
    std::vector<float> along, across, up;
    for (const std::uint32_t s : strands) {
        const Vec3f away = hair.strand(s)[0] - mean;
        along.push_back(away.dot(patch.along)), across.push_back(away.dot(patch.across));
        up.push_back(away.dot(patch.normal));
    }
    const auto [back, front] = spanOf(std::move(along));
    const auto [left, right] = spanOf(std::move(across));
    patch.halfLength = 0.5f * (front - back), patch.halfWidth = 0.5f * (right - left);
    constexpr float kClear = 0.0005f;  // metres
    patch.middle = mean + 0.5f * (back + front) * patch.along + 0.5f * (left + right) * patch.across +
                   (spanOf(std::move(up)).second + kClear) * patch.normal;
    return patch;
}

}  // namespace hairloom::cards
