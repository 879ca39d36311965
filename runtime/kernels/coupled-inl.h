// SPDX-License-Identifier: MIT
// Bending and inextensible segments solved as one system along each strand (docs/engine.md, "Coupled").
#if defined(HAIRLOOM_RUNTIME_COUPLED_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_COUPLED_INL_H
#undef HAIRLOOM_RUNTIME_COUPLED_INL_H
#else
#define HAIRLOOM_RUNTIME_COUPLED_INL_H
#endif

#include <cmath>

#include "hwy/highway.h"
#include "kernels/bend_solve-inl.h"
#include "kernels/implicit-inl.h"
#include "kernels/lanes-inl.h"
#include "kernels/spheres-inl.h"
#include "src/kernels.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

/// γ of the lengths as a multiple of the masses beside a segment.
inline constexpr float kHardness = 2e3f;
/// And what is added to γ for the tension that a segment carries, as a multiple of tension over length.
inline constexpr float kLoadHardness = 300.0f;
/// The most of that, as a multiple of the masses: as far as single precision tells them beside γ.
inline constexpr float kMaxHardness = 1e5f;
/// How often the system of a strand is solved at most, with the same factors, until no segment's length is
/// wrong by more than this share of it, and by what rounding makes of places.
inline constexpr std::uint32_t kMaxSolves = 6;
inline constexpr float kSolved = 3e-7f;
inline constexpr float kRounding = 2.4e-7f;
/// Tension that may act along the segments as they start, as ω²h² of the wave across them; Verlet's limit is
/// 4.
inline constexpr float kHeldTension = 1.0f;

/// A segment in the system. Its length is held along `direction` by `hardness`; `across` holds it in every
/// direction.
struct CoupledSegment {
    V3 direction;
    V hardness, across;
    V wrong;  ///< ½(|e|²/l − l) before the solve
};

/// Stands in LaneFrame::solver behind the strip of strands of so many points.
struct CoupledSystem {
    CoupledSystem(const LaneFrame& lanes, std::size_t points)
        : strand{reinterpret_cast<StrandSystem::Point*>(Strip(lanes).points + points)},
          segments(reinterpret_cast<CoupledSegment*>(strand.points + points)) {}

    StrandSystem strand;
    CoupledSegment* segments;
};

HWY_INLINE V3 edgeAt(const Planes& planes, std::size_t i) {
    return load3(planes, i + kBlockLanes) - load3(planes, i);
}

HWY_INLINE S3 stiffnessOf(const CoupledSegment& s) {
    const V3 d = s.direction, g = d * s.hardness;
    return {s.across + g.x * d.x, g.x * d.y, g.x * d.z,
            s.across + g.y * d.y, g.y * d.z, s.across + g.z * d.z};
}

/// What holds a segment against turning where it carries `tension`, of either sign: beyond what Verlet holds
/// that grows in the substep itself, and would throw light points about.
HWY_INLINE V acrossOf(V tension, V inverseLength, V mass) {
    return hn::Max(hn::Abs(tension) * inverseLength - mass * all(kHeldTension), hn::Zero(D()));
}

/// 1/(w + w') of the ends of segment s; those of clamped points are 0.
HWY_INLINE V reducedMass(const BlockView& block, std::uint32_t s, std::size_t i) {
    const V inner = s < block.firstFree ? hn::Zero(D()) : hn::Load(D(), block.inverseMass + i);
    return all(1.0f) / (inner + hn::Load(D(), block.inverseMass + i + kBlockLanes));
}

/// Reads a segment at the start of the substep (`previous`) and after the integration (`position`). Returns
/// the force on its inner point, reversed on its outer one: the pulls of its joints (`pull`), the tension of
/// the last substep, what turning adds to that, and what gives the segment its length.
HWY_INLINE V3 openSegment(const BlockView& block, V3 pull, std::uint32_t s, std::size_t i,
                          CoupledSegment& segment) {
    const V zero = hn::Zero(D()), half = all(0.5f);
    const V inverseLength = hn::Load(D(), block.inverseLength + i);
    const auto flat = inverseLength <= zero;
    const V3 start = edgeAt(block.previous, i), free = edgeAt(block.position, i);
    // Segments that turn by more than 60° are held where they go.
    const auto alike = dotRoundingEach(start, free) > half * dotRoundingEach(free, free);
    const V3 direction = select(alike, start, free) * inverseLength;
    const V mass = reducedMass(block, s, i);
    const V tension = hn::Load(D(), block.tension + i);
    const V load = hn::Abs(tension) * inverseLength * all(kLoadHardness);
    const V hardness = mass * all(kHardness) + hn::Min(load, mass * all(kMaxHardness));
    const V across = acrossOf(tension, inverseLength, mass);
    const V wrong = half * (dotRoundingEach(free, free) * inverseLength - hn::Load(D(), block.length + i));
    // Points without a distance are held together.
    segment = {direction, hn::IfThenElse(flat, zero, hardness), hn::IfThenElse(flat, hardness, across),
               wrong};
    const V3 held = direction * (tension + hardness * wrong) + (free - start) * across;
    return pull + select(flat, free * hardness, held);
}

/// Factors M + (¼ + q) h² K + segments.
HWY_INLINE void factorSystem(const BlockView& block, const SubstepContext& context, std::size_t lane,
                             CoupledSystem& system) {
    const V zero = hn::Zero(D()), share = all(0.25f + context.bendRate);
    const std::uint32_t first = block.firstFree;
    S3 inner = stiffnessOf(system.segments[first - 1]);
    for (std::uint32_t p = first; p < block.points; ++p) {
        const std::size_t i = std::size_t{p} * kBlockLanes + lane;
        S3 outer{zero, zero, zero, zero, zero, zero};
        if (p + 1 < block.points) outer = stiffnessOf(system.segments[p]);
        const BendRow bend = bendRow(block, p, i);
        const V own = all(1.0f) / hn::Load(D(), block.inverseMass + i) + share * bend.diagonal;
        factorPoint(system.strand, first, p,
                    {{inner.xx + outer.xx + own, inner.xy + outer.xy, inner.xz + outer.xz,
                      inner.yy + outer.yy + own, inner.yz + outer.yz, inner.zz + outer.zz + own},
                     couplingOf(share * bend.coupling1, inner),
                     share * bend.coupling2});
        inner = outer;
    }
}

/// Fills the right side with the forces of the segments, forceOf(s, index).
template <class ForceOf>
HWY_INLINE void fillSystem(const BlockView& block, std::size_t lane, CoupledSystem& system,
                           ForceOf&& forceOf) {
    const std::uint32_t first = block.firstFree;
    V3 inner = zero3();
    for (std::uint32_t s = first - 1; s < block.points; ++s) {
        const V3 outer = s + 1 < block.points ? forceOf(s, std::size_t{s} * kBlockLanes + lane) : zero3();
        if (s >= first) system.strand.points[s].right = outer - inner;
        inner = outer;
    }
}

/// What a solve has left.
struct CoupledRest {
    hn::Mask<D> wrong;  ///< strands whose lengths are not solved
    hn::Mask<D> loose;  ///< strands with more tension than the system holds
};

/// Fills the right side with what is left of lengths and, where strands are loose, with what holds their new
/// tension.
HWY_INLINE CoupledRest reopenSystem(const BlockView& block, std::size_t lane, CoupledSystem& system) {
    const V zero = hn::Zero(D());
    CoupledRest rest{noLane(), noLane()};
    fillSystem(block, lane, system, [&](std::uint32_t s, std::size_t i) HWY_ATTR {
        CoupledSegment& segment = system.segments[s];
        const V3 edge = edgeAt(block.position, i), place = load3(block.position, i);
        const V length = hn::Load(D(), block.length + i);
        const V inverseLength = hn::Load(D(), block.inverseLength + i);
        const auto flat = inverseLength <= zero;
        segment.wrong = all(0.5f) * (dotRoundingEach(edge, edge) * inverseLength - length);
        const V distance = hn::Abs(place.x) + hn::Abs(place.y) + hn::Abs(place.z);
        const V fine = all(kSolved) * length + all(kRounding) * distance;
        rest.wrong = hn::Or(rest.wrong, hn::AndNot(flat, hn::Abs(segment.wrong) > fine));
        const V mass = reducedMass(block, s, i);
        const V tighter = acrossOf(hn::Load(D(), block.tension + i), inverseLength, mass) - segment.across;
        const auto loose = hn::AndNot(flat, tighter > segment.across + mass * all(kHeldTension));
        rest.loose = hn::Or(rest.loose, loose);
        const V added = hn::IfThenElse(loose, tighter, zero);
        segment.across = segment.across + added;
        const V3 turning = (edge - edgeAt(block.previous, i)) * added;
        const V3 held = segment.direction * (segment.hardness * segment.wrong) + turning;
        return select(flat, edge * segment.across, held);
    });
    return rest;
}

/// Solves, moves the points of the strands that are `active` and adds to their tensions.
HWY_INLINE void moveSystem(const BlockView& block, std::size_t lane, CoupledSystem& system,
                           hn::Mask<D> active) {
    const auto takeTension = [&](std::size_t s, V3 turned) HWY_ATTR {
        const CoupledSegment& segment = system.segments[s];
        const std::size_t i = s * kBlockLanes + lane;
        const V before = hn::Load(D(), block.tension + i);
        const V added = segment.hardness * (segment.wrong + dotRoundingEach(segment.direction, turned));
        hn::Store(hn::IfThenElse(active, before + added, before), D(), block.tension + i);
    };
    V3 next = zero3();
    solveSystem(system.strand, block.firstFree, block.points, [&](std::uint32_t p, V3 move) HWY_ATTR {
        const std::size_t i = std::size_t{p} * kBlockLanes + lane;
        const V3 place = load3(block.position, i);
        store3(select(active, place + move, place), block.position, i);
        if (p + 1 < block.points) takeTension(p, next - move);
        next = move;
    });
    takeTension(block.firstFree - 1, next);
}

/// Angular springs and lengths after position Verlet, as one system: (M + (¼ + q) h² K) δ = −h² K z + Gλ with
/// the lengths' Lagrange multipliers λ, by the method of multipliers (Hestenes 1969, Powell 1969) from those
/// of the last substep. The lengths' gradients G are those at the start of the substep, so that without
/// damping this is SHAKE with the mass M + ¼ h² K: it keeps the energy.
template <Shape kShape>
void bendCoupled(const BlockView& given, LaneFrame& lanes, const SubstepContext& context) {
    const BlockView block = localCopy(given);
    if (block.points <= block.firstFree) return;
    CoupledSystem system(lanes, block.points);
    Strip strip(lanes);
    for (std::uint32_t lane = 0; lane < block.lanes; lane += kWidth) {
        const PlaneRows rows(block, lane);
        SegmentPulls<kShape> pulls(block, rows, lanes, context, lane, strip);
        fillSystem(block, lane, system, [&](std::uint32_t s, std::size_t i) HWY_ATTR {
            const auto row = rows.at(s);
            const V3 pull = s + 2 < block.points ? pulls.next(row, strip.points[s]) : pulls.last(row);
            return openSegment(block, pull, s, i, system.segments[s]);
        });
        factorSystem(block, context, lane, system);
        auto active = hn::Not(noLane());
        for (std::uint32_t solve = 0; solve < kMaxSolves; ++solve) {
            if (solve > 0) {
                const CoupledRest rest = reopenSystem(block, lane, system);
                active = hn::And(active, hn::Or(rest.wrong, rest.loose));
                if (!hn::AllFalse(D(), hn::And(active, rest.loose)))
                    factorSystem(block, context, lane, system);
            }
            if (hn::AllFalse(D(), active)) break;
            moveSystem(block, lane, system, active);
        }
    }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
