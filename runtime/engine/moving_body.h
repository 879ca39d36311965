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
    float before;    ///< the same at the start
    Float3 way;      ///< of the body there in the substep
};

/// Where a node stands at the end of a substep, and how it has come there.
struct BodyVisit {
    Float3 point_ws, displacement;
    float radius;  ///< metres that it keeps from the body
    float reach;   ///< metres: skin of the carrier that is farther away is none of its business
    float apart;   ///< metres more for other skin
};

/// Metres that a body is away from a place at least.
struct BodyRoom {
    float carried = 0.0f;  ///< skin that moves with the carrier alone
    float other = 0.0f;    ///< all other
};

/// Poses of a body at the ends of a frame's substeps. Its bones go straight on from pose to pose, as roots
/// do.
class MovingBody {
  public:
    /// `from` and `to` are of as many bones; `carrier` is the one that moves most hair. `around_ws`: where
    /// nodes may be, all within `reach` metres of it.
    void take(const BodyField& field, std::span<const BonePose> from, std::span<const BonePose> to,
              std::size_t carrier, std::uint32_t substeps, Float3 around_ws, float reach);
    void clear() { at_.clear(); }
    bool empty() const { return at_.empty(); }

    /// Nothing and false where the body is farther away than the reach at the end of the substep. `room` is
    /// how far the body is away then. What came in in the substep meets the plane where it
    /// did, however fast it is and however thin what it came into.
    bool touch(std::uint32_t substep, const BodyVisit& visit, BodyTouch& touch, BodyRoom& room) const;

    /// How far nodes are from where they were looked at is measured in the space of one of its bones. Skin
    /// that hangs on it alone stands still there.
    struct Carrier {
        BonePose inverse;      ///< from the world at the end of the substep
        float largest = 1;     ///< metres in the world of one there, at most
        float least = 1;       ///< share of that, at least
        float strayed = 0.0f;  ///< metres that another bone has gone against this one, ever
        /// What it adds, in this substep, to a place in the world at its start.
        BonePose step{{}, {}, {}, {}};
        float apart = 0.0f;  ///< metres that another bone goes against this one in this substep
    };
    const Carrier& carrier(std::uint32_t substep) const { return carriers_[substep]; }
    /// What was looked at before is void.
    bool lostTrack() const { return lostTrack_; }

  private:
    BodyRoom roomAround(std::uint32_t substep, Float3 point_ws) const;
    void sweep(std::uint32_t substep, const BodyVisit& visit, BodyTouch& touch) const;

    std::vector<PosedBody> at_;  ///< at the start of the frame, and at the end of each substep
    std::vector<BonePose> between_, before_;
    std::vector<BonePose> inverses_;  ///< of each bone at the end of each substep
    std::vector<float> leasts_;       ///< metres in the world of one that it carries, at least; 0: it is flat
    const BodyField* field_ = nullptr;
    std::size_t bones_ = 0, carrier_ = 0;
    std::vector<Carrier> carriers_;  ///< at the end of each substep
    bool moves_ = false;
    float strayed_ = 0.0f;
    bool lostTrack_ = true;
};

/// Per block and lane of a plane: metres that a point is from the body at rest, so far that it may come again
/// (it is pushed no farther out than it was authored). Large where the body is not near.
Floats bodyClearances(const RestShape& shape, const BodyField& body);

/// The bone of the body that moves most roots.
std::size_t carrierOf(const RestShape& shape, const BodyField& body);

/// Planes of what is known of each point and the body: where it was looked at, in the carrier's space, and
/// metres that it may go from there to skin of the carrier and to other skin, which has strayed.
inline constexpr std::size_t kBodyPlanes = 5;

}  // namespace hairloom::runtime
