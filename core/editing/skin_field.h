// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The distance to the skin, looked up instead of searched, so that a brush may ask for it a million times a
// second.

#include <atomic>
#include <cmath>
#include <memory>
#include <span>
#include <vector>

#include "core/operations/skin.h"

namespace hairloom::editing {

/// Signed distances at the corners of cells near the skin, interpolated within them. A block of cells is
/// measured when it is first asked for, so that a large mesh costs no more than the part that hair comes
/// near; the answers do not depend on who asks first. Farther than kReach outside, the distance is a lower
/// bound that is above kReach, and the direction says nothing; deep inside it is the skin's own answer.
class SkinField final : public SkinQuery {
  public:
    static constexpr float kReach = 0.01f;  ///< metres
    static constexpr float kCell = 0.002f;  ///< metres

    /// `cell` in metres; it grows where the mesh is so large that the table of blocks would exceed 32 MB.
    explicit SkinField(std::shared_ptr<const Skin> skin, float cell = kCell);
    ~SkinField() override;
    SkinField(const SkinField&) = delete;
    SkinField& operator=(const SkinField&) = delete;

    SkinDistance distanceAt(const Vec3f& point) const override;
    SkinDistance distanceUpTo(const Vec3f& point, float enough) const override;
    /// Measures what lies near these faces ahead of time, in parallel.
    void prepare(std::span<const std::uint32_t> faces) const;
    float cell() const { return cell_; }

  private:
    static constexpr std::size_t kNoBlock = ~std::size_t{0};
    struct Block {
        std::atomic<float> centre;          ///< signed distance there; not finite until measured
        std::atomic<const float*> corners;  ///< owned; null until measured
    };
    /// Where a point is: its block, or none outside the table, and its place there in cells.
    struct Place {
        std::size_t block = kNoBlock;
        std::size_t corner = 0;  ///< of the block's, the first of the cell
        Vec3f inCell;
    };
    Place locate(const Vec3f& point) const;
    SkinDistance interpolated(const Place& place, const Vec3f& point, float enough) const;
    SkinDistance beyondTable(const Vec3f& point) const;
    Vec3f centreOf(std::size_t block) const;
    // Measured where they were not.
    float centreDistance(std::size_t block) const {
        const float known = blocks_[block].centre.load(std::memory_order_relaxed);
        return std::isnan(known) ? measureCentre(block) : known;
    }
    const float* corners(std::size_t block) const {
        const float* const known = blocks_[block].corners.load(std::memory_order_acquire);
        return known ? known : measureCorners(block);
    }
    float measureCentre(std::size_t block) const;
    const float* measureCorners(std::size_t block) const;

    std::shared_ptr<const Skin> skin_;
    Box3f meshBounds_;
    Vec3f low_ = Vec3f::Zero();
    float cell_;
    float perCell_ = 0;
    Eigen::Array3i size_ = Eigen::Array3i::Zero();  ///< blocks along each axis
    Vec3f extent_ = Vec3f::Zero();                  ///< in cells
    mutable std::vector<Block> blocks_;
};

}  // namespace hairloom::editing
