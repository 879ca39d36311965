// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cost/sphere_tree.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace hairloom {
namespace {

using runtime::Float3;

constexpr std::uint32_t kInner = 0xffffffffu;

float component(Float3 v, int axis) {
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

}  // namespace

SphereTree::SphereTree(std::span<const runtime::Sphere> spheres) {
    std::vector<std::uint32_t> all;
    for (std::uint32_t i = 0; i < spheres.size(); ++i) {
        if (spheres[i].radius > 0.0f) all.push_back(i);
    }
    nodes_.reserve(2 * all.size());
    if (!all.empty()) build(all, spheres);
}

void SphereTree::build(std::span<std::uint32_t> some, std::span<const runtime::Sphere> spheres) {
    const std::size_t at = nodes_.size();
    nodes_.push_back({});
    if (some.size() == 1) {
        const runtime::Sphere& sphere = spheres[some[0]];
        nodes_[at] = {sphere.center_ws, sphere.radius, static_cast<std::uint32_t>(at + 1), some[0]};
        return;
    }
    Float3 low = spheres[some[0]].center_ws, high = low;
    for (const std::uint32_t i : some) {
        const Float3 c = spheres[i].center_ws;
        low = {std::min(low.x, c.x), std::min(low.y, c.y), std::min(low.z, c.z)};
        high = {std::max(high.x, c.x), std::max(high.y, c.y), std::max(high.z, c.z)};
    }
    const Float3 centre = (low + high) * 0.5f;
    float radius = 0.0f;
    for (const std::uint32_t i : some)
        radius = std::max(radius, length(spheres[i].center_ws - centre) + spheres[i].radius);
    const std::array<float, 3> extent{high.x - low.x, high.y - low.y, high.z - low.z};
    const auto axis = static_cast<int>(std::ranges::max_element(extent) - extent.begin());
    const std::size_t half = some.size() / 2;
    std::nth_element(some.begin(), some.begin() + static_cast<std::ptrdiff_t>(half), some.end(),
                     [&](std::uint32_t a, std::uint32_t b) {
                         const float x = component(spheres[a].center_ws, axis);
                         const float y = component(spheres[b].center_ws, axis);
                         return x < y || (x == y && a < b);
                     });
    build(some.first(half), spheres);
    build(some.subspan(half), spheres);
    // Sums of roundings must not leave a sphere out.
    nodes_[at] = {centre, radius * 1.00001f, static_cast<std::uint32_t>(nodes_.size()), kInner};
}

void SphereTree::find(Float3 point, float margin, std::vector<std::uint32_t>& found) const {
    for (std::size_t i = 0; i < nodes_.size();) {
        const Node& node = nodes_[i];
        const Float3 from = point - node.centre;
        const float reach = node.radius + margin;
        const bool inside = dot(from, from) < reach * reach;
        if (inside && node.sphere != kInner) found.push_back(node.sphere);
        i = inside ? i + 1 : node.skip;
    }
}

}  // namespace hairloom
