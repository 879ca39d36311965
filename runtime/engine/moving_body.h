// SPDX-License-Identifier: MIT
#pragma once
// A body on its way through a frame, as rods meet it.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/state.h"
#include "hairloom/body_field.h"

namespace hairloom::runtime {

/// What a node meets of a body in a substep.
struct BodyTouch {
    Float3 normal;   ///< out of the body, unit length, world
    float distance;  ///< metres, of the node's middle at the end of the substep; negative inside
    Float3 way;      ///< of the body there in the substep
};

/// Poses of a body at the ends of a frame's substeps. Its bones go straight on from pose to pose, as roots
/// do.
class MovingBody {
  public:
    /// `poses` are of as many bones.
    void take(const BodyField& field, std::span<const BonePose> from, std::span<const BonePose> to,
              std::uint32_t substeps);
    void clear() { at_.clear(); }
    bool empty() const { return at_.empty(); }

    /// Nothing and false where the body is farther away than `reach` at the end of the substep.
    bool touch(std::uint32_t substep, Float3 point_ws, float reach, BodyTouch& touch) const;

  private:
    std::vector<PosedBody> at_;  ///< at the start of the frame, and at the end of each substep
    std::vector<BonePose> between_;
};

/// Per block and lane of a plane: metres that a point is from the body at rest, so far that it may come again
/// (it is pushed no farther out than it was authored). Large where the body is not near.
Floats bodyClearances(const RestShape& shape, const BodyField& body);

}  // namespace hairloom::runtime
