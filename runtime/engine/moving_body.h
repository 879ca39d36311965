// SPDX-License-Identifier: MIT
#pragma once
// A body on its way through a frame, as rods meet it.

#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "engine/body_table.h"
#include "engine/state.h"
#include "hairloom/body_field.h"
#include "hairloom/memory.h"

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
};

/// Poses of a body at the ends of a frame's substeps. Its bones go straight on from pose to pose, as roots
/// do.
class MovingBody {
  public:
    static constexpr std::size_t kMostCarriers = 8;

    /// `from` and `to` are of as many bones; `carriers` are the ones in whose spaces nodes are looked for.
    /// `field` and `table` are of one body and outlive it.
    void take(const BodyField& field, const BodyTable& table, std::span<const BonePose> from,
              std::span<const BonePose> to, std::span<const std::uint32_t> carriers, std::uint32_t substeps);
    /// Takes the memory that frames of up to so many substeps need.
    void reserve(const BodyField& field, const BodyTable& table, std::span<const std::uint32_t> carriers,
                 std::uint32_t substeps);
    /// Keeps its memory for the next frame.
    void clear() { field_ = nullptr; }
    bool empty() const { return field_ == nullptr; }
    const BodyField& field() const { return *field_; }
    const BodyTable& table() const { return *table_; }
    float cell() const { return field_->cell; }

    /// What came in in the substep meets the plane where it did, however fast it is and however thin what it
    /// came into. `touch` is of the plane at the end; nodes may be `near` metres from the body.
    void sweep(std::uint32_t substep, const BodyVisit& visit, float near, BodyTouch& touch) const;

    /// How far nodes are from where they were looked at is measured in the space of a bone. Skin that hangs
    /// on it alone stands still there.
    struct Carrier {
        BonePose inverse;        ///< from the world at the end of the substep
        BonePose inverseBefore;  ///< and at its start
        BonePose before;         ///< to the world at its start
        float largest = 1;       ///< metres in the world of one there, at most
        float least = 1;         ///< share of that, at least
        float apart = 0.0f;      ///< metres that other skin goes against this bone in the substep, at most
        float strayed = 0.0f;    ///< the same, ever
        std::uint32_t bone = 0;
        bool usable = false;  ///< it is not flat
    };
    std::span<const Carrier> carriers(std::uint32_t substep) const {
        return std::span(carriers_).subspan(substep * carrierCount_, carrierCount_);
    }
    /// All bones move alike in the substep.
    bool isWhole(std::uint32_t substep) const { return wholes_[substep] != 0; }
    bool moves() const { return moves_; }
    /// Of each bone at the start of the frame.
    std::span<const BonePose> starts() const { return starts_; }
    /// At the start of a substep; at its end with one more.
    const PosedBody& posed(std::uint32_t substep) const { return at_[substep]; }
    /// Of each bone at the end of a substep, and metres in the world of one that it carries, at least; 0: it
    /// is flat.
    std::span<const BonePose> inverses(std::uint32_t substep) const {
        return std::span(inverses_).subspan(substep * bones_, bones_);
    }
    std::span<const float> leasts(std::uint32_t substep) const {
        return std::span(leasts_).subspan(substep * bones_, bones_);
    }
    /// What was looked at before is void.
    bool lostTrack() const { return lostTrack_; }

  private:
    void takeCarriers(std::uint32_t substep, std::span<const std::uint32_t> bones,
                      std::span<const BonePose> before, std::span<const BonePose> after);
    float stray(std::size_t carrier, const BonePose& way, std::span<const BonePose> before,
                std::span<const BonePose> after) const;

    /// At the start of the frame, and at the end of each substep; behind them those of longer frames before.
    Vector<PosedBody> at_;
    Vector<BonePose> between_, before_, starts_;
    Vector<BonePose> inverses_;  ///< of each bone at the end of each substep
    Vector<float> leasts_;       ///< metres in the world of one that it carries, at least; 0: it is flat
    const BodyField* field_ = nullptr;
    const BodyTable* table_ = nullptr;
    std::size_t bones_ = 0, carrierCount_ = 0;
    Vector<Carrier> carriers_;  ///< of each substep
    Vector<std::uint8_t> wholes_;
    std::array<float, kMostCarriers> strayed_{};
    bool moves_ = false, lostTrack_ = true;
};

/// How a body goes on from `known`, its bones at the end of the last frame, to those that a frame gives.
struct BodyWay {
    std::span<const BonePose> from, to;  ///< as many; empty: it never had a pose
    bool moves = false;
    bool isCut = false;  ///< it is carried along: what was known of where it was is void
};
/// Bones that are not finite, or not as many as the field's or one, leave it where it is. What comes farther
/// than `teleportDistance` (metres) is cut.
BodyWay bodyWay(const BodyField& field, std::span<const BonePose> given, std::span<const BonePose> known,
                float teleportDistance);

/// Metres in the world of one that a bone carries, at least; 0: it is flat.
float leastStretch(const BonePose& pose);

/// More substeps than a frame usually has, where hair or roots beside a body go so far (metres in the frame)
/// that a substep would take them through it: what one substep has to push out by a segment's length it turns
/// by a right angle. At most kMostMoreSubsteps times as many.
std::uint32_t substepsBesideBody(float way, std::uint32_t usual);
inline constexpr std::uint32_t kMostMoreSubsteps = 4;

/// Per block and lane of a plane: metres that a point is from the body at rest, so far that it may come again
/// (it is pushed no farther out than it was authored). Large where the body is not near.
Floats bodyClearances(const RestShape& shape, const BodyField& body);

/// Bones of the body in whose spaces nodes are looked for: the one that moves most roots first, then those
/// that alone move most of the body; at most MovingBody::kMostCarriers.
Vector<std::uint32_t> carriersOf(const RestShape& shape, const BodyField& body);

/// Planes of what is known of each point and the body: where it was looked at, in its carrier's space, metres
/// that it may go from there to skin of the carrier and to other skin, which has strayed, and the carrier.
inline constexpr std::size_t kBodyPlanes = 6;
/// Planes of what a state keeps of each point and the body, for skin that folds: normal of the plane that the
/// point met in the last substep, world, 0 for none, and metres that it ended outside of that; the same of
/// another one that pressed it there.
inline constexpr std::size_t kFoldPlanes = 8;

}  // namespace hairloom::runtime
