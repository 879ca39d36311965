// SPDX-License-Identifier: MIT
// Length of segments: the constraint, and the maximal extension as post-processing.
#if defined(HAIRLOOM_RUNTIME_LENGTH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_LENGTH_INL_H
#undef HAIRLOOM_RUNTIME_LENGTH_INL_H
#else
#define HAIRLOOM_RUNTIME_LENGTH_INL_H
#endif

#include "engine/lanes-inl.h"
#include "hwy/highway.h"
#include "models/springs/bend_solve-inl.h"
#include "models/springs/spring_block-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

/// Where a strand's length is held.
enum class LengthProjection {
    positions,                     ///< segments get their length back; the move counts as velocity
    positionsWithCurrentGradient,  ///< likewise, with tension along the segments as they are after the
                                   ///< integration
    displacements,                 ///< the velocity's part that would change lengths is taken out
};

/// Keeps tension for the bending of the next substep. Slowly: what bending makes of it comes back a substep
/// late. Returns by how much it is more than Verlet holds across the segment, half of its limit, in a measure
/// of its own; `weight` is the sum of its points' inverse masses.
template <class Row>
HWY_INLINE V keepTension(const Row& row, const SubstepContext& context, V weight, V added) {
    const V kept = hn::MulAdd(added, all(context.tensionShare), row.tension());
    row.setTension(kept);
    return hn::MulSub(hn::Abs(kept), weight, row.halfLength());
}

/// Brings tensions that are too much back to what Verlet holds; hardly a segment pulls as much.
template <class Rows>
HWY_NOINLINE void cutTensions(const SpringBlock& block, const Rows& rows) {
    auto row = rows.at(block.firstFree - 1);
    for (std::size_t left = block.points - block.firstFree; left > 0; --left, row.advance()) {
        const V maximum = row.halfLength() / (row.inverseMass() + (row + 1).inverseMass());
        row.setTension(hn::Max(hn::Min(row.tension(), maximum), hn::Neg(maximum)));
    }
}

/// One Newton step on all length constraints ½(|e|²/l − l) = 0 of a strand together, or on their rates
/// e·ė/l = 0; clamped points have infinite mass. The system is tridiagonal and is solved directly (after
/// Goldenthal et al. 2007; with displacements, RATTLE, Andersen 1983), so momentum travels along the whole
/// strand in one step. Collapsed segments keep a diagonal of at least ¼ of their masses': no overshoot.
///
/// Tension of positions acts along the gradient at the start of the substep (SHAKE, Ryckaert et al. 1977),
/// which keeps the order and the energy of the integrator; only that of segments that turn by more than 60°
/// in a substep acts along the gradient of now.
///
/// This eliminates segments, tip to root: the points outer to a segment first.
template <LengthProjection kProjection>
class LengthElimination {
  public:
    HWY_INLINE LengthElimination() {
        outer_ = outerDisplacement_ = wanted_ = zero3();
        outerMass_ = right_ = inverse_ = hn::Zero(D());
    }

    /// The last point of the strands, behind which nothing pulls; `stepDisplacement` is its displacement in
    /// the substep.
    template <class Row>
    HWY_INLINE void open(const Row& row, Strip::Point& point, V3 position, V3 stepDisplacement) {
        store3(zero3(), point.direction);
        outer_ = position;
        outerDisplacement_ = stepDisplacement;
        outerMass_ = row.inverseMass();
    }

    /// A segment from its inner point at `position`. Strip::Point::direction is the gradient at the start
    /// where tension acts along that, and becomes the one along which it acts.
    template <bool kClamped, class Row>
    HWY_INLINE void take(const Row& row, Strip::Point& point, V3 position, V3 stepDisplacement) {
        const V one = all(1.0f);
        const V3 wanted = (outer_ - position) * row.inverseLength();
        const V squared = dot(wanted, wanted);
        // Of the outer segment; few registers are left for it.
        const V above = dot(wanted, load3((&point + 1)->direction)) * outerMass_;
        V3 acting = wanted;
        V own = squared, error;
        if constexpr (kProjection == LengthProjection::positions) {
            acting = load3(point.direction);
            own = dot(wanted, acting);
            const auto alike = own + own > squared;
            if (HWY_UNLIKELY(!hn::AllTrue(D(), alike))) {
                acting = select(alike, acting, wanted);
                own = hn::IfThenElse(alike, own, squared);
                store3(acting, point.direction);
            }
        } else {
            store3(acting, point.direction);
        }
        if constexpr (kProjection == LengthProjection::displacements) {
            error = dot(wanted, outerDisplacement_ - stepDisplacement);
            outerDisplacement_ = stepDisplacement;
        } else {
            error = hn::MulSub(squared, row.halfLength(), row.halfLength());
        }
        const V innerMass = kClamped ? hn::Zero(D()) : row.inverseMass();
        // One segment waits for the last one's division: as little as can be stands between the two.
        const V uncut = dot(wanted_, acting) * outerMass_;
        const V upper = uncut * inverse_;
        const V whole = hn::Max(own, all(0.25f)) * (innerMass + outerMass_);
        inverse_ = one / hn::NegMulAdd(above * uncut, inverse_, whole);
        right_ = hn::MulAdd(above, right_, error) * inverse_;
        store(upper, (&point + 1)->upper);
        store(right_, point.tension);
        outer_ = position;
        outerMass_ = innerMass;
        wanted_ = wanted;
    }

  private:
    V3 outer_, outerDisplacement_;  // of the outer point
    V outerMass_;
    V3 wanted_;  // of the outer segment
    V right_, inverse_;
};

/// Moves the points by the tension that the system gives, root to tip.
template <LengthProjection kProjection, bool kKept, class Rows>
HWY_INLINE void applyTension(const SpringBlock& block, const Rows& rows, const SubstepContext& context,
                             std::size_t lane, Strip& strip) {
    const Planes& moving = kProjection == LengthProjection::displacements ? block.previous : block.position;
    float* at = moving.x + block.firstFree * kBlockLanes + lane;
    auto row = rows.at(block.firstFree - 1);
    Strip::Point* point = strip.points + (block.firstFree - 1);
    V lambda = load(point->tension), innerMass = row.inverseMass();
    V3 inner = load3(point->direction) * lambda;
    V excess = hn::Zero(D());
    const auto keep = [&](V mass) HWY_ATTR {
        excess = hn::Max(excess, keepTension(row, context, innerMass + mass, lambda));
    };
    const auto move = [&](V3 force, V mass) HWY_ATTR {
        const V3 before = load3(at, block.pitch);
        store3(kProjection == LengthProjection::displacements ? negMulAdd(force, mass, before)
                                                              : mulAdd(force, mass, before),
               at, block.pitch);
    };
    for (std::size_t left = block.points - block.firstFree; left > 1; --left, at += kBlockLanes) {
        const V mass = (row + 1).inverseMass();
        if constexpr (kKept) keep(mass);
        row.advance();
        ++point;
        lambda = hn::MulAdd(load(point->upper), lambda, load(point->tension));
        const V3 outer = load3(point->direction) * lambda;
        move(outer - inner, mass);
        inner = outer;
        innerMass = mass;
    }
    const V mass = (row + 1).inverseMass();
    if constexpr (kKept) keep(mass);
    move(zero3() - inner, mass);
    if (kKept && HWY_UNLIKELY(!hn::AllFalse(D(), excess > hn::Zero(D())))) cutTensions(block, rows);
}

/// Fills the directions at the start of the substep.
template <class Rows>
HWY_INLINE void readStart(const SpringBlock& block, const Rows& rows, std::size_t lane, Strip& strip) {
    const Planes& start = block.start.x ? block.start : block.previous;
    V3 from = load3(start, (block.firstFree - 1) * kBlockLanes + lane);
    for (std::size_t s = block.firstFree - 1; s + 1 < block.points; ++s) {
        const V3 to = load3(start, (s + 1) * kBlockLanes + lane);
        store3((to - from) * rows.at(s).inverseLength(), strip.points[s].direction);
        from = to;
    }
}

template <LengthProjection kProjection, class Rows>
HWY_INLINE void reduceLengths(const SpringBlock& block, const Rows& rows, std::size_t lane, Strip& strip) {
    if constexpr (kProjection == LengthProjection::positions) readStart(block, rows, lane, strip);
    LengthElimination<kProjection> lengths;
    std::size_t i = (block.points - 1) * kBlockLanes + lane;
    const auto stepDisplacementAt = [&](V3 position) HWY_ATTR {
        return kProjection == LengthProjection::displacements ? position - load3(block.previous, i) : zero3();
    };
    V3 position = load3(block.position, i);
    lengths.open(rows.at(block.points - 1), strip.points[block.points - 1], position,
                 stepDisplacementAt(position));
    for (std::size_t s = block.points - 1; s-- > block.firstFree;) {
        i -= kBlockLanes;
        position = load3(block.position, i);
        lengths.template take<false>(rows.at(s), strip.points[s], position, stepDisplacementAt(position));
    }
    i -= kBlockLanes;
    position = load3(block.position, i);
    const std::size_t clamped = block.firstFree - 1;
    lengths.template take<true>(rows.at(clamped), strip.points[clamped], position,
                                stepDisplacementAt(position));
}

template <LengthProjection kProjection, bool kKept = false>
void projectStrands(const SpringBlock& given, const LaneFrame& lanes, const SubstepContext& context) {
    const SpringBlock block = localCopy(given);
    if (block.points <= block.firstFree) return;
    Strip strip(lanes);
    for (std::size_t lane = 0; lane < block.lanes; lane += kWidth) {
        const PlaneRows rows(block, lane);
        reduceLengths<kProjection>(block, rows, lane, strip);
        applyTension<kProjection, kKept>(block, rows, context, lane, strip);
    }
}

template <LengthProjection kProjection>
void projectLength(const SpringBlock& block, LaneFrame& lanes, const SubstepContext& context) {
    for (std::uint32_t iteration = 0; iteration < context.lengthIterations; ++iteration) {
        if (kProjection == LengthProjection::positions && block.tension) {
            projectStrands<kProjection, true>(block, lanes, context);
        } else {
            projectStrands<kProjection>(block, lanes, context);
        }
    }
}

void projectDisplacements(const SpringBlock& block, LaneFrame& lanes, const SubstepContext& context) {
    projectStrands<LengthProjection::displacements>(block, lanes, context);
}

/// The stages of angular springs and lengths of a strip in one go, with the same bits: points stay at hand
/// from the one to the other.
template <Shape kShape, class Rows>
HWY_INLINE void bendAndProjectStrip(const SpringBlock& block, const Rows& rows, const LaneFrame& lanes,
                                    const SubstepContext& context, std::size_t lane, Strip& strip) {
    pullStrip<kShape, true>(block, rows, lanes, context, lane, strip);
    LengthElimination<LengthProjection::positions> lengths;
    float* at = block.position.x + (block.points - 1) * kBlockLanes + lane;
    const auto move = [&](V3 delta) HWY_ATTR {
        const V3 position = load3(at, block.pitch) + delta;
        store3(position, at, block.pitch);
        at -= kBlockLanes;
        return position;
    };
    finishBend(
        block, rows, strip,
        [&](const auto& row, Strip::Point& point, V3 delta)
            HWY_ATTR { lengths.open(row, point, move(delta), zero3()); },
        [&](const auto& row, Strip::Point& point, V3 delta)
            HWY_ATTR { lengths.template take<false>(row, point, move(delta), zero3()); });
    const std::size_t clamped = block.firstFree - 1;
    lengths.template take<true>(rows.at(clamped), strip.points[clamped], load3(at, block.pitch), zero3());
    applyTension<LengthProjection::positions, true>(block, rows, context, lane, strip);
    for (std::uint32_t iteration = 1; iteration < context.lengthIterations; ++iteration) {
        reduceLengths<LengthProjection::positions>(block, rows, lane, strip);
        applyTension<LengthProjection::positions, true>(block, rows, context, lane, strip);
    }
}

/// Between the substeps of a frame nothing else reads what CopiedRows copies.
template <Shape kShape>
void bendAndProject(const SpringBlock& given, LaneFrame& lanes, const SubstepContext& context) {
    constexpr bool kCurved = kShape == Shape::curved;
    const SpringBlock block = localCopy(given);
    if (block.points <= block.firstFree) return;
    Strip strip(lanes);
    for (std::size_t lane = 0; lane < block.lanes; lane += kWidth) {
        const PlaneRows planes(block, lane);
        if (block.points > kMaxCopied) {
            bendAndProjectStrip<kShape>(block, planes, lanes, context, lane, strip);
            continue;
        }
        const CopiedRows<kCurved> rows(block, lanes, lane);
        if (context.index == 0) {
            for (std::size_t p = 0; p < block.points; ++p) rows.at(p).fill(planes.at(p));
        }
        bendAndProjectStrip<kShape>(block, rows, lanes, context, lane, strip);
        if (context.index + 1 < context.count) continue;
        for (std::size_t p = 0; p + 1 < block.points; ++p) planes.at(p).setTension(rows.at(p).tension());
    }
}

/// Whether a segment of a strip may be longer or shorter than the maximal extension allows. Looks at all of
/// them before it asks, and with room for rounding.
HWY_INLINE bool mayExceed(const SpringBlock& block, float maximum, float minimum, std::size_t lane) {
    const V middle = all(0.5f * (maximum + minimum)), half = all(0.5f * (maximum - minimum) - 1e-6f);
    V3 parent = load3(block.position, (block.firstFree - 1) * kBlockLanes + lane);
    V excess = hn::Zero(D());
    for (std::size_t p = block.firstFree; p < block.points; ++p) {
        const std::size_t i = p * kBlockLanes + lane;
        const V3 position = load3(block.position, i), edge = position - parent;
        const V rest = hn::Load(D(), block.length + (i - kBlockLanes));
        const V whole = rest * rest;
        const V off = hn::Abs(hn::NegMulAdd(whole, middle, dot(edge, edge)));
        excess = hn::Max(excess, hn::NegMulAdd(whole, half, off));
        parent = position;
    }
    return !hn::AllFalse(D(), excess > hn::Zero(D()));
}

/// Root to tip, brings segments back to between (1 − ε) and (1 + ε) of their length (Provot 1995, both ways).
/// The move counts as velocity only where that slows the point relative to its root: it never adds energy.
void limitExtension(const SpringBlock& given, LaneFrame& lanes, const SubstepContext& context) {
    const SpringBlock block = localCopy(given);
    const float longest = 1.0f + context.maximalExtension, shortest = 1.0f - context.maximalExtension;
    const float maximum = longest * longest, minimum = shortest * shortest;
    const V tiny = all(1e-12f), one = all(1.0f), zero = hn::Zero(D());
    for (std::uint32_t lane = 0; lane < block.lanes; lane += kWidth) {
        if (HWY_LIKELY(!mayExceed(block, maximum, minimum, lane))) continue;
        const V3 step = load3(lanes.rootDisplacement, lane);
        V3 parent = load3(block.position, (block.firstFree - 1) * kBlockLanes + lane);
        for (std::size_t p = block.firstFree; p < block.points; ++p) {
            const std::size_t i = p * kBlockLanes + lane;
            const V3 position = load3(block.position, i);
            const V3 from = parent, edge = position - from;
            const V rest = hn::Load(D(), block.length + (i - kBlockLanes));
            const V whole = rest * rest;
            const V squared = dot(edge, edge);
            const auto wrong = hn::Or(squared > whole * all(maximum), squared < whole * all(minimum));
            parent = position;
            if (hn::AllFalse(D(), wrong)) continue;
            const V size = hn::Sqrt(squared);
            const auto collapsed = size < tiny;
            const V bounded = hn::Min(hn::Max(size, rest * all(shortest)), rest * all(longest));
            const V scale = bounded / hn::IfThenElse(collapsed, one, size);
            const V3 fixed{hn::IfThenElse(collapsed, zero, edge.x * scale),
                           hn::IfThenElse(collapsed, zero - bounded, edge.y * scale),
                           hn::IfThenElse(collapsed, zero, edge.z * scale)};
            // Not position + move: of a point that was far away only rounding would be left.
            parent = select(wrong, from + fixed, position);
            const V3 move = select(wrong, fixed - edge, zero3());
            const V3 previous = load3(block.previous, i);
            const V3 moving = position - previous - step;
            const V braking = (zero - dot(moving, move)) / (dot(move, move) + all(1e-30f));
            const V counted = hn::Min(hn::Max(braking, zero), one);
            store3(parent, block.position, i);
            store3(mulAdd(move, one - counted, previous), block.previous, i);
        }
    }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
