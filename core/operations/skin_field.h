// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The distance to the skin, looked up instead of searched, so that an edit may ask for it a million times a
// second.

#include <atomic>
#include <cmath>
#include <memory>
#include <span>
#include <vector>

#include "core/operations/skin.h"

namespace hairloom {

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
    /// A distance that the point's own is not below on a closed mesh, for tests whether it is above `enough`;
    /// minus infinity deep inside.
    float minimumAt(const Vec3f& point, float enough) const;
    /// Measures what lies near these faces ahead of time, in parallel.
    void prepare(std::span<const std::uint32_t> faces) const;
    float cell() const { return cell_; }
    const Skin& skin() const { return *skin_; }

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

/// The skin's own answers without a search where the field shows that a point is far enough. What keeps hair
/// outside a closed mesh gets the same bits from both.
class ScreenedSkin final : public SkinQuery {
  public:
    explicit ScreenedSkin(const SkinField& field) : field_(field) {}
    SkinDistance distanceAt(const Vec3f& point) const override { return field_.skin().distanceAt(point); }
    SkinDistance distanceUpTo(const Vec3f& point, float enough) const override {
        const float minimum = field_.minimumAt(point, enough);
        if (minimum > enough) return {minimum, Vec3f::UnitY()};
        return field_.skin().distanceAt(point);
    }

  private:
    const SkinField& field_;
};

/// The skin of a head with its field, made once while anyone holds it: making it takes longer than most
/// edits. Null for null.
std::shared_ptr<const SkinField> sharedSkin(const std::shared_ptr<const ScalpMesh>& scalp);

}  // namespace hairloom
