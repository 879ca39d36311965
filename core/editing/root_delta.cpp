// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/root_delta.h"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <utility>

namespace hairloom::editing {

RootDelta::Root RootDelta::rootOf(const Groom& groom, std::uint32_t strand) {
    const auto uvs = groom.strandAttributes.view<Vec2f>(attribute::kRootUv);
    return {{groom.strandAttributes.view<std::uint32_t>(attribute::kRootTriangle)[strand],
             groom.strandAttributes.view<Vec3f>(attribute::kRootBarycentric)[strand]},
            strand < uvs.size() ? uvs[strand] : Vec2f(Vec2f::Zero())};
}

void RootDelta::keep(Groom& groom, std::span<const std::uint32_t> strands) {
    if (strands.empty()) return;
    if (strands_.empty()) triangulation_ = std::exchange(groom.triangulation, {});
    std::vector<std::uint32_t> both;
    std::ranges::set_union(strands_, strands, std::back_inserter(both));
    if (both.size() != strands_.size()) {
        std::vector<Root> roots;
        std::size_t old = 0;
        for (const std::uint32_t strand : both) {
            const bool isKept = old < strands_.size() && strands_[old] == strand;
            roots.push_back(isKept ? roots_[old++] : rootOf(groom, strand));
        }
        strands_ = std::move(both);
        roots_ = std::move(roots);
    }
    const auto base = groom.pointAttributes.view<Vec3f>(attribute::kBasePosition);
    if (base.size() == groom.pointCount()) base_.keep(groom.offsets.view(), base, strands);
}

const SurfacePoint& RootDelta::kept(std::uint32_t strand) const {
    const auto found = std::ranges::lower_bound(strands_, strand);
    assert(found != strands_.end() && *found == strand);
    return roots_[static_cast<std::size_t>(found - strands_.begin())].place;
}

void RootDelta::finish(Groom& groom) {
    if (strands_.empty()) return;
    if (!base_.empty())
        base_.finish(groom.offsets.view(), groom.pointAttributes.view<Vec3f>(attribute::kBasePosition));
    std::size_t moved = 0;
    for (std::size_t k = 0; k < strands_.size(); ++k) {
        const Root now = rootOf(groom, strands_[k]);
        const SurfacePoint& before = roots_[k].place;
        if (now.place.triangle == before.triangle && now.place.barycentric == before.barycentric) continue;
        strands_[moved] = strands_[k];
        roots_[moved++] = roots_[k];
    }
    strands_.resize(moved);
    roots_.resize(moved);
    if (!empty()) return;
    groom.triangulation = std::move(triangulation_);
    *this = {};
}

void RootDelta::exchange(Groom& groom) {
    if (empty()) return;
    auto& triangles = groom.strandAttributes.edit<std::uint32_t>(attribute::kRootTriangle);
    auto& barycentrics = groom.strandAttributes.edit<Vec3f>(attribute::kRootBarycentric);
    const bool hasUvs = groom.strandAttributes.has(attribute::kRootUv);
    for (std::size_t k = 0; k < strands_.size(); ++k) {
        std::swap(triangles[strands_[k]], roots_[k].place.triangle);
        std::swap(barycentrics[strands_[k]], roots_[k].place.barycentric);
    }
    if (hasUvs) {
        auto& uvs = groom.strandAttributes.edit<Vec2f>(attribute::kRootUv);
        for (std::size_t k = 0; k < strands_.size(); ++k) std::swap(uvs[strands_[k]], roots_[k].uv);
    }
    if (!base_.empty())
        base_.exchange(groom.offsets.view(), groom.pointAttributes.edit<Vec3f>(attribute::kBasePosition));
    std::swap(groom.triangulation, triangulation_);
}

std::size_t RootDelta::bytes() const {
    return strands_.capacity() * sizeof(std::uint32_t) + roots_.capacity() * sizeof(Root) +
           base_.heapBytes() + triangulation_.triangles.capacity() * sizeof(Triangle);
}

}  // namespace hairloom::editing
