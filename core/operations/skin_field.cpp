// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/skin_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>

#include "core/base/parallel.h"

namespace hairloom {
namespace {

constexpr int kCells = 4;  ///< of a block, along each axis
constexpr int kCorners = kCells + 1;
constexpr std::size_t kValues = std::size_t{kCorners} * kCorners * kCorners;
constexpr float kSlopeless =
    0.2f;  ///< on the ridge between two sides of the skin the interpolated slope vanishes
constexpr double kMaxBlocks = 2e6;
constexpr float kMostBetween = 0.8661f;  ///< cells; by which interpolation between true distances may err
constexpr float kRounding = 1e-6f;       ///< metres
constexpr float kNever = -std::numeric_limits<float>::infinity();
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

float halfDiagonal(float cell) {
    return 0.5f * std::sqrt(3.0f) * cell * kCells;
}

constexpr std::size_t kCellCorners = 8;
/// Of the corners of a cell, from its first in the order of their coordinates: 000, 100, 010, 110, 001 …
constexpr std::array<std::size_t, kCellCorners> kCornerOffsets = {
    0,
    1,
    kCorners,
    kCorners + 1,
    kCorners* kCorners,
    kCorners* kCorners + 1,
    kCorners* kCorners + kCorners,
    kCorners* kCorners + kCorners + 1,
};

/// Interpolates within a cell at (x, y, z) in [0, 1]³.
struct Cell {
    float c000, c100, c010, c110, c001, c101, c011, c111;
    float x, y, z;

    float value() const {
        return mix(mix(mix(c000, c100, x), mix(c010, c110, x), y),
                   mix(mix(c001, c101, x), mix(c011, c111, x), y), z);
    }
    // The gradient, per cell.
    float alongX() const {
        return mix(mix(c100 - c000, c110 - c010, y), mix(c101 - c001, c111 - c011, y), z);
    }
    float alongY() const {
        return mix(mix(c010, c110, x) - mix(c000, c100, x), mix(c011, c111, x) - mix(c001, c101, x), z);
    }
    float alongZ() const {
        return mix(mix(c001, c101, x), mix(c011, c111, x), y) -
               mix(mix(c000, c100, x), mix(c010, c110, x), y);
    }

    /// What the distance is not below, whatever the skin looks like: no corner lies nearer than the way to
    /// it allows.
    float minimum(float size) const {
        const float xs[] = {x * x, (1 - x) * (1 - x)}, ys[] = {y * y, (1 - y) * (1 - y)},
                    zs[] = {z * z, (1 - z) * (1 - z)};
        const float corners[] = {c000, c100, c010, c110, c001, c101, c011, c111};
        float best = kNever;
        for (std::size_t i = 0; i < kCellCorners; ++i)
            best = std::max(best, corners[i] - size * std::sqrt(xs[i & 1] + ys[i >> 1 & 1] + zs[i >> 2]));
        return best;
    }

  private:
    static float mix(float a, float b, float t) { return a + t * (b - a); }
};

Cell cellAt(const float* corner, const Vec3f& t) {
    const auto at = [&](std::size_t i) { return corner[kCornerOffsets[i]]; };
    return {at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7), t.x(), t.y(), t.z()};
}

}  // namespace

SkinField::SkinField(std::shared_ptr<const Skin> skin, float cell)
    : skin_(std::move(skin)), meshBounds_(skin_->mesh().bounds()), cell_(cell) {
    const auto sizeAt = [&](float size) -> Eigen::Array3i {
        const Vec3f extent = meshBounds_.sizes() + Vec3f::Constant(2 * (kReach + size * kCells));
        return (extent / (size * kCells)).array().ceil().cast<int>();
    };
    constexpr float kGrowth = 1.1f;
    while (sizeAt(cell_).cast<double>().prod() > kMaxBlocks) cell_ *= kGrowth;
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

float SkinField::measureCentre(std::size_t block) const {
    const float measured = skin_->at(centreOf(block)).distance;
    blocks_[block].centre.store(measured, std::memory_order_relaxed);
    return measured;
}

const float* SkinField::measureCorners(std::size_t block) const {
    std::atomic<const float*>& place = blocks_[block].corners;
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

inline SkinField::Place SkinField::locate(const Vec3f& point) const {
    const Vec3f cells = (point - low_) * perCell_;
    // What is no number is not inside either.
    const auto isInside = [&](Eigen::Index i) { return cells[i] >= 0 && cells[i] < extent_[i]; };
    if (!isInside(0) || !isInside(1) || !isInside(2)) return {};
    const auto x = static_cast<std::uint32_t>(cells.x()), y = static_cast<std::uint32_t>(cells.y()),
               z = static_cast<std::uint32_t>(cells.z());
    const auto sizeX = static_cast<std::size_t>(size_.x()), sizeY = static_cast<std::size_t>(size_.y());
    return {(z / kCells * sizeY + y / kCells) * sizeX + x / kCells,
            (z % kCells * kCorners + y % kCells) * kCorners + x % kCells,
            cells - Vec3f(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z))};
}

SkinDistance SkinField::beyondTable(const Vec3f& point) const {
    const Vec3f away = point - point.cwiseMax(meshBounds_.min()).cwiseMin(meshBounds_.max());
    const float distance = away.norm();
    return {distance, distance > 0 ? Vec3f(away / distance) : Vec3f(Vec3f::UnitY())};
}

SkinDistance SkinField::interpolated(const Place& place, const Vec3f& point, float enough) const {
    const Cell cell = cellAt(corners(place.block) + place.corner, place.inCell);
    const float distance = cell.value();
    if (distance > enough) return {distance, Vec3f::UnitY()};
    const Vec3f gradient(cell.alongX(), cell.alongY(), cell.alongZ());
    const float slope = gradient.norm();
    if (slope < kSlopeless * cell_) return skin_->distanceAt(point);
    return {distance, gradient / slope};
}

SkinDistance SkinField::distanceAt(const Vec3f& point) const {
    const Place place = locate(point);
    if (place.block == kNoBlock) return beyondTable(point);
    const float centre = centreDistance(place.block);
    const float reach = halfDiagonal(cell_) + kReach;
    if (centre > reach) return {centre - (point - centreOf(place.block)).norm(), Vec3f::UnitY()};
    if (centre < -reach) return skin_->distanceAt(point);
    return interpolated(place, point, std::numeric_limits<float>::infinity());
}

SkinDistance SkinField::distanceUpTo(const Vec3f& point, float enough) const {
    const Place place = locate(point);
    if (place.block == kNoBlock) return beyondTable(point);
    // From the middle of a block the distance falls by no more than the way to its corner.
    const float centre = centreDistance(place.block);
    const float minimum = centre - halfDiagonal(cell_);
    if (minimum > enough) return {minimum, Vec3f::UnitY()};
    if (std::abs(centre) > halfDiagonal(cell_) + kReach) return distanceAt(point);
    return interpolated(place, point, enough);
}

float SkinField::minimumAt(const Vec3f& point, float enough) const {
    const Place place = locate(point);
    if (place.block == kNoBlock) return beyondTable(point).distance;
    const float centre = centreDistance(place.block);
    if (centre < -(halfDiagonal(cell_) + kReach)) return kNever;
    // The distance falls by no more than the way.
    const float fromCentre = centre - (point - centreOf(place.block)).norm() - kRounding;
    if (fromCentre > enough) return fromCentre;
    const Cell cell = cellAt(corners(place.block) + place.corner, place.inCell);
    if (const float minimum = cell.value() - kMostBetween * cell_ - kRounding; minimum > enough)
        return minimum;
    return cell.minimum(cell_) - kRounding;
}

std::shared_ptr<const SkinField> sharedSkin(const std::shared_ptr<const ScalpMesh>& scalp) {
    static std::mutex mutex;
    static std::weak_ptr<const SkinField> last;
    if (!scalp) return nullptr;
    const std::scoped_lock lock(mutex);
    auto field = last.lock();
    if (field && &field->skin().mesh() == scalp.get()) return field;
    // Not by make_shared: what `last` keeps would hold its memory.
    field.reset(new SkinField(std::make_shared<const Skin>(scalp)));
    last = field;
    return field;
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
    constexpr std::size_t kCellsAtATime = 16;
    parallelFor(near.size(), kCellsAtATime, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (std::abs(centreDistance(near[i])) <= halfDiagonal(cell_) + kReach) corners(near[i]);
        }
    });
}

}  // namespace hairloom
