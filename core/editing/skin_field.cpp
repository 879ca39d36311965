// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/skin_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/parallel.h"

namespace hairloom::editing {
namespace {

constexpr int kCells = 4;  ///< of a block, along each axis
constexpr int kCorners = kCells + 1;
constexpr std::size_t kValues = std::size_t{kCorners} * kCorners * kCorners;
constexpr double kMostBlocks = 2e6;
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

float halfDiagonal(float cell) {
    return 0.5f * std::sqrt(3.0f) * cell * kCells;
}

std::ptrdiff_t cornerIndex(const Eigen::Array3i& cell) {
    return (cell.z() * kCorners + cell.y()) * kCorners + cell.x();
}

/// Value and gradient (per cell) at `t` in [0, 1]³ of a cell whose first corner is given.
Vec4f interpolate(const float* corner, const Vec3f& t) {
    const auto at = [&](int x, int y, int z) { return corner[(z * kCorners + y) * kCorners + x]; };
    const float x00 = at(0, 0, 0) + t.x() * (at(1, 0, 0) - at(0, 0, 0));
    const float x10 = at(0, 1, 0) + t.x() * (at(1, 1, 0) - at(0, 1, 0));
    const float x01 = at(0, 0, 1) + t.x() * (at(1, 0, 1) - at(0, 0, 1));
    const float x11 = at(0, 1, 1) + t.x() * (at(1, 1, 1) - at(0, 1, 1));
    const float y0 = x00 + t.y() * (x10 - x00);
    const float y1 = x01 + t.y() * (x11 - x01);
    const float dx0 = (at(1, 0, 0) - at(0, 0, 0)) * (1 - t.y()) + (at(1, 1, 0) - at(0, 1, 0)) * t.y();
    const float dx1 = (at(1, 0, 1) - at(0, 0, 1)) * (1 - t.y()) + (at(1, 1, 1) - at(0, 1, 1)) * t.y();
    return {y0 + t.z() * (y1 - y0), dx0 + t.z() * (dx1 - dx0),
            (x10 - x00) + t.z() * ((x11 - x01) - (x10 - x00)), y1 - y0};
}

}  // namespace

SkinField::SkinField(std::shared_ptr<const Skin> skin, float cell)
    : skin_(std::move(skin)), meshBounds_(skin_->mesh().bounds()), cell_(cell) {
    const auto sizeAt = [&](float size) -> Eigen::Array3i {
        const Vec3f extent = meshBounds_.sizes() + Vec3f::Constant(2 * (kReach + size * kCells));
        return (extent / (size * kCells)).array().ceil().cast<int>();
    };
    constexpr float kGrowth = 1.1f;
    while (sizeAt(cell_).cast<double>().prod() > kMostBlocks) cell_ *= kGrowth;
    size_ = sizeAt(cell_);
    low_ = meshBounds_.min() - Vec3f::Constant(kReach + cell_ * kCells);
    perCell_ = 1 / cell_;
    extent_ = (size_ * kCells).cast<float>();
    blocks_ = std::vector<Block>(static_cast<std::size_t>(size_.prod()));
    for (Block& block : blocks_) {
        block.centre.store(kUnknown, std::memory_order_relaxed);
        block.corners.store(nullptr, std::memory_order_relaxed);
    }
}

SkinField::~SkinField() {
    for (const Block& block : blocks_) delete[] block.corners.load();
}

Vec3f SkinField::centreOf(std::size_t block) const {
    const auto nx = static_cast<std::size_t>(size_.x());
    const auto ny = static_cast<std::size_t>(size_.y());
    const Vec3f index(static_cast<float>(block % nx), static_cast<float>(block / nx % ny),
                      static_cast<float>(block / (nx * ny)));
    return low_ + (index + Vec3f::Constant(0.5f)) * (cell_ * kCells);
}

float SkinField::centreDistance(std::size_t block) const {
    const float known = blocks_[block].centre.load(std::memory_order_relaxed);
    if (!std::isnan(known)) return known;
    const float measured = skin_->at(centreOf(block)).distance;
    blocks_[block].centre.store(measured, std::memory_order_relaxed);
    return measured;
}

const float* SkinField::corners(std::size_t block) const {
    std::atomic<const float*>& place = blocks_[block].corners;
    if (const float* known = place.load(std::memory_order_acquire)) return known;
    auto measured = std::make_unique<float[]>(kValues);
    const Vec3f first = centreOf(block) - Vec3f::Constant(0.5f * cell_ * kCells);
    for (int z = 0, i = 0; z < kCorners; ++z)
        for (int y = 0; y < kCorners; ++y)
            for (int x = 0; x < kCorners; ++x, ++i) {
                const Vec3f at = first + cell_ * Vec3f(static_cast<float>(x), static_cast<float>(y),
                                                       static_cast<float>(z));
                measured[static_cast<std::size_t>(i)] = skin_->at(at).distance;
            }
    const float* expected = nullptr;
    // Two threads may measure the same block; they find the same and one of them lets go of its copy.
    if (!place.compare_exchange_strong(expected, measured.get(), std::memory_order_acq_rel)) return expected;
    return measured.release();
}

SkinField::Place SkinField::locate(const Vec3f& point) const {
    const Vec3f cells = (point - low_) * perCell_;
    // What is no number is not inside either.
    if (!(cells.array() >= 0).all() || !(cells.array() < extent_.array()).all()) return {};
    const Eigen::Array3i whole(static_cast<int>(cells.x()), static_cast<int>(cells.y()),
                               static_cast<int>(cells.z()));
    const Eigen::Array3i block = whole / kCells;
    return {static_cast<std::size_t>((block.z() * size_.y() + block.y()) * size_.x() + block.x()),
            whole - block * kCells, cells - whole.cast<float>().matrix()};
}

SkinDistance SkinField::beyondTable(const Vec3f& point) const {
    const Vec3f away = point - point.cwiseMax(meshBounds_.min()).cwiseMin(meshBounds_.max());
    const float distance = away.norm();
    return {distance, distance > 0 ? Vec3f(away / distance) : Vec3f(Vec3f::UnitY())};
}

SkinDistance SkinField::distanceAt(const Vec3f& point) const {
    const Place place = locate(point);
    if (!place.block) return beyondTable(point);
    const float centre = centreDistance(*place.block);
    const float reach = halfDiagonal(cell_) + kReach;
    if (centre > reach) return {centre - (point - centreOf(*place.block)).norm(), Vec3f::UnitY()};
    if (centre < -reach) return skin_->distanceAt(point);
    const Vec4f value = interpolate(corners(*place.block) + cornerIndex(place.cell), place.inCell);
    const float slope = value.tail<3>().norm();
    // On the ridge between two sides of the skin the interpolated slope vanishes.
    constexpr float kSlopeless = 0.2f;
    if (slope < kSlopeless * cell_) return skin_->distanceAt(point);
    return {value[0], value.tail<3>() / slope};
}

float SkinField::distanceUpTo(const Vec3f& point, float enough) const {
    const Place place = locate(point);
    if (!place.block) return beyondTable(point).distance;
    // From the middle of a block the distance falls by no more than the way to its corner.
    const float least = centreDistance(*place.block) - halfDiagonal(cell_);
    if (least > enough) return least;
    if (least > kReach || least < -2 * halfDiagonal(cell_) - kReach) return distanceAt(point).distance;
    return interpolate(corners(*place.block) + cornerIndex(place.cell), place.inCell)[0];
}

void SkinField::prepare(std::span<const std::uint32_t> faces) const {
    std::vector<std::size_t> near;
    const float side = cell_ * kCells;
    const ScalpMesh& mesh = skin_->mesh();
    for (const std::uint32_t face : faces) {
        Box3f box;
        for (const std::uint32_t v : mesh.triangles()[face]) box.extend(mesh.positions()[v]);
        const Eigen::Array3i low =
            ((box.min() - low_ - Vec3f::Constant(kReach)) / side).array().floor().cast<int>();
        const Eigen::Array3i high =
            ((box.max() - low_ + Vec3f::Constant(kReach)) / side).array().floor().cast<int>();
        for (int z = std::max(low.z(), 0); z <= std::min(high.z(), size_.z() - 1); ++z)
            for (int y = std::max(low.y(), 0); y <= std::min(high.y(), size_.y() - 1); ++y)
                for (int x = std::max(low.x(), 0); x <= std::min(high.x(), size_.x() - 1); ++x)
                    near.push_back(static_cast<std::size_t>((z * size_.y() + y) * size_.x() + x));
    }
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    constexpr std::size_t kGrain = 16;
    parallelFor(near.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (std::abs(centreDistance(near[i])) <= halfDiagonal(cell_) + kReach) corners(near[i]);
        }
    });
}

}  // namespace hairloom::editing
