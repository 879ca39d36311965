// SPDX-License-Identifier: MIT
// Rods at rest, as many strands at a time as a register has doubles: the shape without load that hangs in the
// authored one, and how vertices resist. A lane never depends on those beside it, and products are rounded
// before they are added: the bits are those of any instruction set.
#if defined(HAIRLOOM_RUNTIME_ROD_REST_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_ROD_REST_INL_H
#undef HAIRLOOM_RUNTIME_ROD_REST_INL_H
#else
#define HAIRLOOM_RUNTIME_ROD_REST_INL_H
#endif

#include <algorithm>
#include <cmath>

#include "hairloom/presets.h"
#include "hwy/highway.h"
#include "models/rods/rod_rest_math-inl.h"
#include "models/rods/rods.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {
namespace at_rest {

/// B beyond which single precision cannot tell a strand's weight from its stiffness: a strand of 30 cm that
/// is as stiff hangs within a thousandth of its length of its rest shape.
inline constexpr double kStiffest = 1e3 * kHairBendingStiffness;
/// Radians by which a strand's own weight may bend it in all.
inline constexpr double kMaxHeld = 2.5;
/// Share of a vertex' stiffness that has to be left against the load that would make a held shape swing round
/// or buckle.
inline constexpr double kStableShare = 0.05;
/// A strain, in radians, that counts as none.
inline constexpr double kStraight = 1e-4;
/// Most of |v| of a vertex: 74 degrees of turn, short of where the moment is greatest.
inline constexpr double kLargest = 0.6;

/// Segment and vertex j while its strands are laid; the frames of segments are in that of the root.
struct RestPoint {
    Turn authored;  ///< of the segment
    Turn loaded;    ///< from the inner segment to this one, as authored
    Turn turn;      ///< the same without load
    Turn free;      ///< of the segment without load
    R3 tangent;     ///< of the segment as authored
    R3 flat;        ///< long diameter of a flat section, in the segment's frame
    R3 moment;      ///< of what lies beyond about the vertex, in the segment's frame
    R3 strain;  ///< v of the rotation (v, √(1 − |v|²)) from `turn` to `loaded`, in the segment's frame
    R3 strainAsLaid;   ///< the same in the root's
    R3 axis;           ///< of twist, in the root's frame
    R3 normal;         ///< long diameter, likewise
    R length, mass;    ///< metres; of the point, metres of hair
    R own, stiffness;  ///< B/l̄ as it is, and where hair is made stiffer
    R weight;          ///< |moment|
    R bent;            ///< radians that the weight bends the vertex by with its own stiffness
    R turnedAt;        ///< stiffness that `turn` and `strain` are of; −1 where they are not known
};

/// The rods of a vector of strands of one block.
class RestRods {
  public:
    /// `points` has room for the block's.
    RestRods(const RestShape& shape, const SimulationSettings& settings, RodParts parts, std::size_t index,
             RestPoint* points)
        : shape_(shape),
          settings_(settings),
          parts_(parts),
          section_(rodSectionRatios(settings)),
          block_(shape.blocks[index]),
          size_(planeSize(block_)),
          rest_(shape.planes.data() + block_.firstPlane * kRestPlanes),
          first_(settings.clampedPoints - 1),
          segments_(block_.points - 1),
          at_(points) {}

    void lay(std::uint32_t lane) {
        readStrands(lane);
        carryFrames();
        if (parts_ == RodParts::chain) {
            for (std::uint32_t j = 0; j < segments_; ++j) at_[j].free = at_[j].authored;
            return;
        }
        if (isFlat()) layFlat();
        fillStiffness(lane);
        weigh(lane);
        stiffen();
    }

    /// Whether twist matters.
    bool curved() const {
        if (isFlat()) return true;
        for (std::uint32_t j = first_; j < segments_; ++j) {
            const R3 bent = alongOf(at_[j].turn) - along();
            if (any(above(dot(bent, bent), num(kStraight * kStraight)))) return true;
        }
        return false;
    }

    /// As RodRest::planes, from `lane` on.
    void write(std::uint32_t lane, float* planes) const {
        const std::size_t count = kRodRestPlanes[static_cast<std::size_t>(parts_)];
        R3 before = alongOf(at_[0].authored);
        for (std::uint32_t p = 0; p <= segments_; ++p) {
            R3 tangent = along(), axis = along(), normal = zero3();
            Turn loaded = noTurn();
            if (p < segments_) {
                const RestPoint& at = at_[p];
                tangent = alongOf(at.free);
                axis = tangent + before;
                axis = axis * (num(1.0) / greater(lengthOf(axis), num(1e-9)));
                loaded = at.authored * inverse(at.free);
                if (isFlat()) normal = across(rotate(at.free, at.flat), axis);
                before = tangent;
            }
            const R stiffness = parts_ == RodParts::chain || p == segments_ ? num(0.0) : at_[p].stiffness;
            const R values[kRodRestPlanes[3]] = {tangent.x,  tangent.y,  tangent.z,  at_[p].mass, stiffness,
                                                 loaded.v.x, loaded.v.y, loaded.v.z, loaded.w,    axis.x,
                                                 axis.y,     axis.z,     normal.x,   normal.y,    normal.z};
            for (std::size_t plane = 0; plane < count; ++plane)
                store(values[plane], planes + plane * size_ + std::size_t{p} * kBlockLanes + lane);
        }
    }

  private:
    static constexpr double kNoLength = 1e-9;   // metres
    static constexpr double kTurnShare = 50.0;  // a turn of 1/50 counts as much as what is carried on
    static constexpr int kHalvings = 8;         // of what is held
    static constexpr double kSettled =
        1e-10;  // a step of v that is the last: each is a fraction of the one before
    static constexpr int kMostSteps = 48;       // of a vertex
    static constexpr double kLeastHeld = -9.0;  // log2 of radians

    bool isFlat() const { return parts_ == RodParts::section; }
    /// Of the segment before; the root holds the first one as authored.
    const Turn& innerAuthored(std::uint32_t j) const { return at_[j > 0 ? j - 1 : 0].authored; }

    void readStrands(std::uint32_t lane) {
        R total = num(0.0);
        const auto plane = [&](std::size_t which, std::uint32_t p) {
            return load(rest_ + which * size_ + std::size_t{p} * kBlockLanes + lane);
        };
        for (std::uint32_t j = 0; j < segments_; ++j) {
            at_[j].length = plane(3, j);
            at_[j].tangent = {plane(0, j), plane(1, j), plane(2, j)};
            total = total + at_[j].length;
        }
        total_ = total;
        for (std::uint32_t p = 0; p <= segments_; ++p) at_[p].mass = total / num(block_.points) / plane(5, p);
    }

    /// Frames of the authored shape by parallel transport.
    void carryFrames() {
        R3 before = along();
        Turn frame = noTurn();
        for (std::uint32_t j = 0; j < segments_; ++j) {
            const R3 segment = at_[j].tangent;
            const R size = lengthOf(segment);
            const Mask has = above(size, num(kNoLength));
            const R3 tangent = choose(has, segment * (num(1.0) / greater(size, num(kNoLength))), before);
            frame = choose(has, normalized(between(before, tangent) * frame), frame);
            before = tangent;
            at_[j].authored = frame;
            at_[j].tangent = alongOf(frame);
            at_[j].loaded = inverse(innerAuthored(j)) * frame;
        }
    }

    /// The long diameter of each segment, in its frame. Flat hair curls about it: where the authored shape
    /// turns it follows the axis of the turn, elsewhere it is carried on, from the root's x on.
    void layFlat() {
        R3 before = along(), normal{num(1.0), num(0.0), num(0.0)};
        for (std::uint32_t j = 0; j < segments_; ++j) {
            const R3 tangent = at_[j].tangent, turn = cross(before, tangent);
            normal = rotate(between(before, tangent), normal);
            const R side = choose(above(num(0.0), dot(turn, normal)), num(-kTurnShare), num(kTurnShare));
            if (j > 0) normal = normal + turn * side;
            normal = across(normal, tangent);
            at_[j].flat = rotate(inverse(at_[j].authored), normal);
            before = tangent;
        }
    }

    /// B/l̄. The vertex at the clamp stands for the half segment beside it, too.
    void fillStiffness(std::uint32_t lane) {
        double strand[kWide];
        for (std::size_t i = 0; i < kWide; ++i)
            strand[i] = static_cast<double>(shape_.stiffnessOf(block_.strandOfLane[lane + i]));
        const R ofStrand = loadLanes(strand);
        const R least = greater(total_ * num(1e-3 / segments_), num(1e-9));
        for (std::uint32_t j = 0; j < segments_; ++j) {
            const double share =
                static_cast<double>(settings_.angularStiffness) *
                settings_.angularCurve.at(static_cast<double>(j) / static_cast<double>(segments_));
            const R before = j > 0 ? at_[j - 1].length : num(0.0);
            R own = num(0.5) * (before + at_[j].length);
            if (j == first_ && j > 0) own = own + num(0.5) * before;
            at_[j].own = at_[j].stiffness =
                lesser(num(section_.stiffer * bendingStiffnessOf(share)) * ofStrand, num(kStiffest)) /
                greater(own, least);
            at_[j].turnedAt = num(-1.0);
            at_[j].strain = zero3();
        }
    }

    /// The moment about each vertex of what lies beyond it: Σ l t × F with the weight F beyond a segment.
    void weigh(std::uint32_t lane) {
        double down[3][kWide];
        for (std::size_t i = 0; i < kWide; ++i) {
            const Quat root = shape_.restRoots[block_.strandOfLane[lane + i]].rotation;
            const Float3 fall = runtime::rotate(conjugate(root), settings_.gravity);
            const auto share = static_cast<double>(settings_.restGravity);
            down[0][i] = static_cast<double>(fall.x) * share;
            down[1][i] = static_cast<double>(fall.y) * share;
            down[2][i] = static_cast<double>(fall.z) * share;
        }
        gravity_ = {loadLanes(down[0]), loadLanes(down[1]), loadLanes(down[2])};
        R3 moment = zero3();
        R beyond = num(0.0);
        held_ = num(0.0);
        for (std::uint32_t j = segments_; j-- > first_;) {
            RestPoint& at = at_[j];
            beyond = beyond + at_[j + 1].mass;
            moment = moment + cross(at.tangent, gravity_) * (at.length * beyond);
            at.moment = rotate(inverse(at.authored), moment);
            at.weight = lengthOf(moment);
            const Mask bends = above(at.own, num(0.0));
            at.bent = choose(bends, at.weight / choose(bends, at.own, num(1.0)), num(0.0));
            held_ = held_ + at.bent;
        }
    }

    /// Makes hair stiffer where its weight bends it most, which is near the root, until the held shape is
    /// stable: it stands for the hair around that carries it. The radians that the weight bends a strand by
    /// in all are what is searched for.
    void stiffen() {
        const Mask all = above(num(1.0), num(0.0));
        const Mask stands = holds(num(kMaxHeld), all);
        const Mask fails = butNot(all, stands);
        R held = num(kMaxHeld);
        if (any(fails)) {
            double lane[kWide], low[kWide] = {}, high[kWide], stood[kWide];
            std::fill_n(high, kWide, static_cast<double>(1 << kHalvings));
            const auto heldAt = [&](const double* step) {
                for (std::size_t i = 0; i < kWide; ++i) lane[i] = std::exp2(kLeastHeld + step[i] * stride());
                return choose(fails, loadLanes(lane), num(kMaxHeld));
            };
            for (int halving = 0; halving < kHalvings; ++halving) {
                double middle[kWide];
                for (std::size_t i = 0; i < kWide; ++i) middle[i] = 0.5 * (low[i] + high[i]);
                storeLanes(choose(holds(heldAt(middle), fails), num(1.0), num(0.0)), stood);
                for (std::size_t i = 0; i < kWide; ++i) (stood[i] > 0.5 ? low : high)[i] = middle[i];
            }
            held = heldAt(low);
        }
        unload(held);
    }
    static double stride() { return (std::log2(kMaxHeld) - kLeastHeld) / (1 << kHalvings); }

    /// What no vertex may bend by, in radians, so that the weight bends the strand by no more than `held`:
    /// the sum of the lesser of it and `bent` is concave, so each of Newton's steps from below stays below.
    R mostOf(R held) const {
        R most = held * num(1.0 / (segments_ - first_));
        for (std::uint32_t step = 0; step < segments_; ++step) {
            R below = num(0.0), count = num(0.0);
            for (std::uint32_t j = first_; j < segments_; ++j) {
                const Mask over = above(at_[j].bent, most);
                below = below + choose(over, num(0.0), at_[j].bent);
                count = count + choose(over, num(1.0), num(0.0));
            }
            const R next = (held - below) / greater(count, num(1.0));
            const Mask grows = both(above(count, num(0.5)), above(next, most));
            if (!any(grows)) break;
            most = choose(grows, next, most);
        }
        return most;
    }

    /// Stiffness of a vertex where none of a strand bends by more than 1/`stiffer`; 0 where all is as it is.
    static R stiffnessOf(const RestPoint& at, R stiffer) {
        return choose(above(at.own, num(0.0)), greater(at.own, at.weight * stiffer), at.own);
    }
    R stifferFor(R held) const {
        const Mask loose = above(held_, held);
        if (!any(loose)) return num(0.0);
        return choose(loose, num(1.0) / greater(mostOf(held), num(1e-9)), num(0.0));
    }

    /// Where the second variation of the energy of shape and weight is positive in the authored shape, by
    /// elimination from the tip. A vertex adds ½ dᵀH d + dᵀN u in the rotation u of its inner segment and u +
    /// d of its outer one, a segment ½ l uᵀ ((F·t) 1 − ½ (F tᵀ + t Fᵀ)) u with the weight F beyond it.
    Mask holds(R held, Mask which) {
        const R stiffer = stifferFor(held);
        Symmetric beyond = noMatrix();
        R weight = num(0.0);
        Mask stands = which;
        for (std::uint32_t j = segments_; j-- > first_ && any(stands);) {
            RestPoint& at = at_[j];
            const R b = stiffnessOf(at, stiffer);
            turnWithoutLoad(at, b, stands);
            weight = weight + at_[j + 1].mass;
            const R3 force = gravity_ * (weight * at.length);
            beyond.addDiagonal(dot(force, at.tangent));
            beyond.addBoth(force * num(-0.5), at.tangent);

            const R3 v = at.strainAsLaid, a = at.axis;
            const R w = root(num(1.0) - dot(v, v));
            const R more = b * num(section_.twist), softer = b * num(section_.flat);
            R3 m = v * b + a * (more * dot(a, v));
            Symmetric sum = beyond;
            const R3 twist = a * w + cross(a, v);
            sum.addSquare(v, num(0.0) - b);
            sum.addSquare(twist, more);
            if (isFlat()) {
                m = m + at.normal * (softer * dot(at.normal, v));
                sum.addSquare(at.normal * w + cross(at.normal, v), softer);
            }
            sum.addDiagonal(b - dot(m, v) - num(kStableShare) * b);
            stands = both(stands, beyond.eliminate(sum, m * w + cross(v, m)));
        }
        return stands;
    }

    /// The shape without load that hangs in the authored one under its weight.
    void unload(R held) {
        const R stiffer = stifferFor(held);
        const Mask all = above(num(1.0), num(0.0));
        for (std::uint32_t j = 0; j < first_; ++j) {
            at_[j].free = at_[j].authored;
            at_[j].turn = at_[j].loaded;
        }
        for (std::uint32_t j = first_; j < segments_; ++j) {
            RestPoint& at = at_[j];
            at.stiffness = stiffnessOf(at, stiffer);
            turnWithoutLoad(at, at.stiffness, all);
            at.free = normalized((j > 0 ? at_[j - 1].free : at_[0].authored) * at.turn);
        }
    }

    /// What `strain` leaves of the turn of a vertex without load.
    static Turn turnOf(const RestPoint& at, R3 v) {
        return at.loaded * Turn{v * num(-1.0), root(num(1.0) - dot(v, v))};
    }
    static R3 limited(R3 v) {
        const R square = dot(v, v);
        const Mask over = above(square, num(kLargest * kLargest));
        return any(over) ? choose(over, v * (num(kLargest) / root(square)), v) : v;
    }
    /// The axis of twist in the outer segment's frame, of the length that both tangents make.
    static R3 longAxisOf(const Turn& turn) { return along() + alongOf(inverse(turn)); }
    static R3 axisOf(const Turn& turn) {
        const R3 both = longAxisOf(turn);
        return both * (num(1.0) / greater(lengthOf(both), num(1e-9)));
    }

    /// Turns the vertex where its stiffness is another than the last time: Newton's steps with the derivative
    /// of a small strain, on the axis of twist that the last one gives, for the moment
    /// 2b (v w + (a w + a × v) α (v·a) + (n w + n × v) β (v·n)). They start from the last strain, which goes
    /// about with the inverse of stiffness.
    void turnWithoutLoad(RestPoint& at, R b, Mask which) const {
        which = butNot(which, equal(b, at.turnedAt));
        if (!any(which)) return;
        Mask open = both(both(which, above(b, num(0.0))), above(at.weight, num(0.0)));
        const R3 wanted = at.moment * (num(0.5) / choose(open, b, num(1.0)));
        R3 v = at.strain *
               choose(above(at.turnedAt, num(0.0)), at.turnedAt / choose(open, b, num(1.0)), num(1.0));
        v = limited(v);
        for (int step = 0; step < kMostSteps && any(open); ++step) {
            const R w = root(num(1.0) - dot(v, v));
            const R3 a = longAxisOf(at.loaded * Turn{v * num(-1.0), w});
            const R scale = num(1.0) / greater(dot(a, a), num(1e-18));
            R3 moment = v * w + (a * w + cross(a, v)) * (num(section_.twist) * dot(v, a) * scale);
            R3 n = zero3();
            if (isFlat()) {
                n = across(at.flat, a * root(scale));
                moment = moment + (n * w + cross(n, v)) * (num(section_.flat) * dot(v, n));
            }
            const R3 left = (wanted - moment) * (num(1.0) / w);
            R3 next = v + left + a * (dot(left, a) * scale * num(1.0 / (1.0 + section_.twist) - 1.0));
            if (isFlat()) next = next + n * (dot(left, n) * num(1.0 / (1.0 + section_.flat) - 1.0));
            next = limited(next);
            const R3 moved = next - v;
            v = choose(open, next, v);
            open = both(open, above(dot(moved, moved), num(kSettled * kSettled)));
        }
        const Turn turn = turnOf(at, v);
        const R3 axis = axisOf(turn);
        at.turn = choose(which, turn, at.turn);
        at.strain = choose(which, v, at.strain);
        at.strainAsLaid = choose(which, rotate(at.authored, v), at.strainAsLaid);
        at.axis = choose(which, rotate(at.authored, axis), at.axis);
        if (isFlat()) at.normal = choose(which, rotate(at.authored, across(at.flat, axis)), at.normal);
        at.turnedAt = choose(which, b, at.turnedAt);
    }

    const RestShape& shape_;
    const SimulationSettings& settings_;
    RodParts parts_;
    RodSectionRatios section_;
    const Block& block_;
    std::size_t size_;
    const float* rest_;
    std::uint32_t first_;  // segment that is free, and vertex
    std::uint32_t segments_;
    RestPoint* at_;
    R total_ = num(0.0);    // metres of hair
    R held_ = num(0.0);     // radians that the weight bends each strand by with its own stiffness
    R3 gravity_ = zero3();  // in the root's frame, as far as it is held
};

}  // namespace at_rest

/// Lays the blocks from `begin` up to `end` in `rest`.
inline void layRods(const RestShape& shape, const SimulationSettings& settings, std::size_t begin,
                    std::size_t end, RodRest& rest) {
    using at_rest::RestPoint;
    std::uint32_t most = 0;
    for (std::size_t b = begin; b < end; ++b) most = std::max(most, shape.blocks[b].points);
    Floats room(most * sizeof(RestPoint) / sizeof(float), 0.0f);  // too large for a game's stack
    auto* const points = reinterpret_cast<RestPoint*>(room.data());
    for (std::size_t b = begin; b < end; ++b) {
        at_rest::RestRods rods(shape, settings, rest.parts, b, points);
        float* const planes = rest.planes.data() + shape.blocks[b].firstPlane * rest.planeCount();
        for (std::uint32_t lane = 0; lane < kBlockLanes; lane += at_rest::kWide) {
            rods.lay(lane);
            if (!rest.curved.empty() && rest.curved[b] == 0 && rods.curved()) rest.curved[b] = 1;
            rods.write(lane, planes);
        }
    }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
