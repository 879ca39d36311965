// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/strand_bounds.h"

#include "core/base/parallel.h"

namespace hairloom::editing {
namespace {

constexpr std::size_t kGrain = 4096;

}  // namespace

StrandBounds::Box StrandBounds::boxOf(std::span<const Vec3f> points) {
    // An empty box is beyond any test's reach.
    constexpr float kNowhere = 1e30f;
    if (points.empty()) return {Vec3f::Constant(kNowhere), Vec3f::Constant(-kNowhere)};
    // Four numbers at a time compile to vectors; the fourth is the next point's.
    static_assert(sizeof(Vec3f) == 3 * sizeof(float));
    const float* const xyz = points.data()->data();
    Eigen::Array4f low = Eigen::Array4f::Constant(kNowhere), high = -low;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const Eigen::Array4f wide = Eigen::Map<const Eigen::Array4f>(xyz + 3 * i);
        low = low.min(wide);
        high = high.max(wide);
    }
    return {low.head<3>().matrix().cwiseMin(points.back()), high.head<3>().matrix().cwiseMax(points.back())};
}

void StrandBounds::rebuild(const Groom& groom) {
    boxes_.resize(groom.strandCount());
    const auto positions = groom.positions();
    const auto offsets = groom.offsets.view();
    parallelFor(boxes_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s)
            boxes_[s] = boxOf(positions.subspan(offsets[s], offsets[s + 1] - offsets[s]));
    });
}

void StrandBounds::append(const Groom& groom) {
    for (std::size_t s = boxes_.size(); s < groom.strandCount(); ++s)
        boxes_.push_back(boxOf(groom.strand(s)));
}

void StrandBounds::update(const Groom& groom, std::span<const std::uint32_t> strands) {
    const auto positions = groom.positions();
    const auto offsets = groom.offsets.view();
    parallelFor(strands.size(), kGrain / 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const std::uint32_t s = strands[k];
            boxes_[s] = boxOf(positions.subspan(offsets[s], offsets[s + 1] - offsets[s]));
        }
    });
}

std::vector<std::uint32_t> StrandBounds::gather(
    const std::function<void(std::size_t, std::size_t, std::vector<std::uint32_t>&)>& piece) const {
    std::vector<std::vector<std::uint32_t>> found((boxes_.size() + kGrain - 1) / kGrain);
    parallelFor(boxes_.size(), kGrain,
                [&](std::size_t begin, std::size_t end) { piece(begin, end, found[begin / kGrain]); });
    std::vector<std::uint32_t> all;
    for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
    return all;
}

}  // namespace hairloom::editing
