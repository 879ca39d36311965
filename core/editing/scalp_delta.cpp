// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/scalp_delta.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace hairloom::editing {

FaceSet differentFaces(const FaceSet& a, const FaceSet& b) {
    FaceSet different;
    std::set_symmetric_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(different));
    return different;
}

void FaceDelta::set(Groom& groom, FaceSet faces, std::string expression) {
    const bool isFirst = toggled_.empty();
    FaceSet changed = differentFaces(groom.scalpSelection, faces);
    if (changed.empty()) return;
    toggled_ = differentFaces(toggled_, changed);
    if (isFirst) expression_ = groom.scalpExpression;
    groom.scalpSelection = std::move(faces);
    groom.scalpExpression = std::move(expression);
}

void FaceDelta::exchange(Groom& groom) {
    if (toggled_.empty()) return;
    groom.scalpSelection = differentFaces(groom.scalpSelection, toggled_);
    std::swap(groom.scalpExpression, expression_);
}

std::size_t FaceDelta::bytes() const {
    return toggled_.capacity() * sizeof(std::uint32_t) + expression_.capacity();
}

void DensityDelta::set(Groom& groom, std::span<const std::uint32_t> vertices, std::span<const float> values) {
    if (vertices.empty()) return;
    if (vertices_.empty()) absent_ = groom.scalpDensity.empty();
    groom.scalpDensity.resize(groom.scalp->vertexCount(), 1.0f);
    std::vector<std::uint32_t> all;
    std::set_union(vertices_.begin(), vertices_.end(), vertices.begin(), vertices.end(),
                   std::back_inserter(all));
    std::vector<float> before(all.size());
    std::size_t old = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const bool isKept = old < vertices_.size() && vertices_[old] == all[i];
        before[i] = isKept ? values_[old] : groom.scalpDensity[all[i]];
        old += isKept ? 1 : 0;
    }
    for (std::size_t i = 0; i < vertices.size(); ++i) groom.scalpDensity[vertices[i]] = values[i];
    vertices_ = std::move(all);
    values_ = std::move(before);
}

void DensityDelta::exchange(Groom& groom) {
    if (vertices_.empty()) return;
    const bool absentNow = groom.scalpDensity.empty();
    groom.scalpDensity.resize(groom.scalp->vertexCount(), 1.0f);
    for (std::size_t i = 0; i < vertices_.size(); ++i)
        std::swap(groom.scalpDensity[vertices_[i]], values_[i]);
    if (absent_) groom.scalpDensity.clear();
    absent_ = absentNow;
}

std::size_t DensityDelta::bytes() const {
    return vertices_.capacity() * sizeof(std::uint32_t) + values_.capacity() * sizeof(float);
}

}  // namespace hairloom::editing
