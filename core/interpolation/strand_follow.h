// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Follow hairs of a whole groom frame after frame: bindings name guides by their strands, so that what moves
// all strands, on whatever device, hands over all its points as they are.

#include <span>
#include <vector>

#include "core/interpolation/follow_hairs.h"

namespace hairloom {

/// Owns the arrays of view(); nothing of groom or bindings is kept.
class StrandFollow {
  public:
    StrandFollow(const Groom& groom, const FollowBindings& bindings);

    /// Every strand of the groom is a guide, most of which nobody may follow. Valid while this lives.
    runtime::FollowView view() const;
    std::size_t hairCount() const { return guides_.size(); }
    std::uint32_t pointsPerHair() const { return pointsPerHair_; }

  private:
    std::uint32_t pointsPerHair_ = 0;
    std::vector<std::uint32_t> offsets_;
    std::vector<Vec3f> rest_;
    std::vector<Mat3f> rootFrames_;
    std::vector<float> radii_;
    runtime::WispMotion wisps_;
    std::vector<std::array<std::uint32_t, 3>> guides_;
    std::vector<Vec3f> weights_, rootWeights_, rootShifts_;
    std::vector<Vec2f> wispOffsets_;
    std::vector<float> blends_;
};

}  // namespace hairloom
