// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry/mesh_solid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/parallel.h"

namespace hairloom {
namespace {

constexpr float kInfinite = std::numeric_limits<float>::infinity();

std::vector<TriangleTree::Corners> cornersOf(std::span<const Vec3f> positions,
                                             std::span<const Triangle> triangles) {
    std::vector<TriangleTree::Corners> corners(triangles.size());
    std::ranges::transform(triangles, corners.begin(), [&](const Triangle& t) {
        return TriangleTree::Corners{positions[t[0]], positions[t[1]], positions[t[2]]};
    });
    return corners;
}

}  // namespace

MeshSolid::MeshSolid(std::span<const Vec3f> positions, std::span<const Triangle> triangles)
    : corners_(cornersOf(positions, triangles)), tree_(corners_, TriangleTree::Winding::yes) {
    for (const Triangle& t : triangles) {
        for (const std::uint32_t v : t) bounds_.extend(positions[v]);
    }
}

std::pair<Vec3f, Vec3f> MeshSolid::besideTriangle(std::size_t triangle, float depth) const {
    const auto& [a, b, c] = corners_[triangle];
    const Vec3f normal = (b - a).cross(c - a).normalized() * depth, middle = (a + b + c) / 3;
    return {middle + normal, middle - normal};
}

std::vector<std::uint32_t> MeshSolid::skin() const {
    constexpr float kBeside = 2e-4f;  // metres
    std::vector<std::uint8_t> isSkin(corners_.size(), 0);
    parallelFor(isSkin.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto [before, behind] = besideTriangle(i, kBeside);
            isSkin[i] = contains(before) != contains(behind) ? 1 : 0;
        }
    });
    std::vector<std::uint32_t> found;
    for (std::uint32_t i = 0; i < isSkin.size(); ++i) {
        if (isSkin[i]) found.push_back(i);
    }
    return found;
}

bool MeshSolid::enclosesAnything() const {
    // A hundredth of the size of the whole is less than any head is thick.
    const float depth = bounds_.isEmpty() ? 0 : 0.01f * bounds_.diagonal().norm();
    constexpr std::size_t kTried = 1000;
    for (std::size_t i = 0; i < corners_.size(); i += corners_.size() / kTried + 1) {
        // Of a mirrored part what is behind is before.
        const auto [before, behind] = besideTriangle(i, depth);
        if (contains(before) || contains(behind)) return true;
    }
    return false;
}

bool MeshSolid::contains(const Vec3f& point) const {
    return bounds_.contains(point) && std::abs(tree_.windingNumber(point)) > 0.5;
}

float MeshSolid::distance(const Vec3f& point) const {
    const auto hit = tree_.closest(point);
    return hit ? static_cast<float>(hit->distance) : kInfinite;
}

SolidGrid::SolidGrid(const MeshSolid& solid) : solid_(solid), cell_(kCell) {
    if (solid.bounds().isEmpty()) return;
    const auto sizeAt = [&](float cell) -> Eigen::Array3d {
        return (solid.bounds().sizes().array() / cell).floor().cast<double>() + 1;
    };
    constexpr float kGrowth = 1.1f;
    while (sizeAt(cell_).prod() > kMostCells) cell_ *= kGrowth;
    size_ = sizeAt(cell_).cast<int>();
    low_ = solid.bounds().min();
    const auto count = static_cast<std::size_t>(size_.prod());
    middles_ = std::make_unique<std::atomic<float>[]>(count);
    for (std::size_t i = 0; i < count; ++i)
        middles_[i].store(std::numeric_limits<float>::quiet_NaN(), std::memory_order_relaxed);
}

SolidGrid::Bound SolidGrid::at(const Vec3f& point) const {
    if (!solid_.bounds().contains(point)) return {kInfinite, 0};
    const Eigen::Array3i index =
        ((point - low_).array() / cell_).cast<int>().max(0).min(Eigen::Array3i(size_ - 1));
    const Vec3f middle = low_ + cell_ * (index.cast<float>() + 0.5f).matrix();
    std::atomic<float>& place =
        middles_[(static_cast<std::size_t>(index.z()) * static_cast<std::size_t>(size_.y()) +
                  static_cast<std::size_t>(index.y())) *
                     static_cast<std::size_t>(size_.x()) +
                 static_cast<std::size_t>(index.x())];
    float distance = place.load(std::memory_order_relaxed);
    if (std::isnan(distance)) {
        distance = solid_.signedDistance(middle);
        place.store(distance, std::memory_order_relaxed);
    }
    return {distance, (point - middle).norm()};
}

}  // namespace hairloom
