// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/lock.h"

#include <algorithm>

#include "core/operations/reshape.h"

namespace hairloom::editing {

std::vector<Vec3f> middleStrand(const Groom& groom, const Reached& reached) {
    constexpr std::size_t kPoints = 16, kMaxStrands = 512;
    if (reached.strands.empty()) return {};
    std::vector<Vec3f> middle(kPoints, Vec3f::Zero());
    const std::size_t stride = (reached.strands.size() + kMaxStrands - 1) / kMaxStrands;
    float total = 0;
    for (std::size_t k = 0; k < reached.strands.size(); k += stride) {
        const auto points = groom.strand(reached.strands[k]);
        const auto weights = std::span(reached.weights).subspan(reached.begins[k], points.size());
        const float weight = std::ranges::max(weights);
        total += weight;
        for (std::size_t i = 0; i < kPoints; ++i) {
            middle[i] += weight * pointAlong(points, static_cast<float>(i) / static_cast<float>(kPoints - 1));
        }
    }
    for (Vec3f& point : middle) point /= total;
    return middle;
}

}  // namespace hairloom::editing
