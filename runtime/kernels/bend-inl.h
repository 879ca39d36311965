// SPDX-License-Identifier: MIT
// Angular springs (docs/engine.md): as forces, and solved together along each strand.
#if defined(HAIRLOOM_RUNTIME_BEND_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_BEND_INL_H
#undef HAIRLOOM_RUNTIME_BEND_INL_H
#else
#define HAIRLOOM_RUNTIME_BEND_INL_H
#endif

#include "hwy/highway.h"
#include "runtime/kernels.h"
#include "runtime/kernels/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

/// Where angular springs read a strand.
enum class Bending {
    forces,    ///< at `position`
    implicit,  ///< frames at `previous`, pulls q of the way from there to `position` farther on
};
/// How a joint knows its rest direction.
enum class Shape {
    straight,  ///< its inner segment goes on
    curved,    ///< by the frame carried along the strand
    held,      ///< likewise, less what its own weight bends it by
};

/// s = κ·h²·(t − target) of each joint of a block; those past the last segment are zero.
struct Pulls {
    alignas(64) float x[kMaxPoints * kBlockLanes], y[kMaxPoints * kBlockLanes], z[kMaxPoints * kBlockLanes];
    Planes planes() { return {x, y, z}; }
};

/// A segment's direction: by its rest length, or of unit length.
template <bool kExact>
HWY_INLINE V3 tangentOf(V3 edge, V inverseLength) {
    if constexpr (!kExact) return edge * inverseLength;
    const V squared = dot(edge, edge);
    const auto flat = squared < all(1e-20f);
    const V size = hn::Sqrt(hn::IfThenElse(flat, all(1.0f), squared));
    return edge * hn::IfThenElse(flat, hn::Zero(D()), all(1.0f) / size);
}

/// Eq. 4, root to tip: the frame of each segment is that of the one before, turned by the shortest arc that
/// takes its rest direction to its own.
template <Bending kBending, Shape kShape, bool kExact>
void measurePulls(const BlockView& block, const LaneFrame& lanes, const SubstepContext& context,
                  Pulls& pulls) {
    constexpr bool kImplicit = kBending == Bending::implicit;
    constexpr bool kFrames = kShape != Shape::straight;
    const Planes& place = kImplicit ? block.previous : block.position;
    const V q = all(context.bendRate);
    alignas(64) float frame[4][kBlockLanes], inner[3][kBlockLanes], pulled[3][kBlockLanes];
    const std::uint32_t first = block.firstFree - 1;
    for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth) {
        store4(load4(lanes.rotation, lane), frame, lane);
        // The root's own direction stands for a segment before the first.
        V3 before = rotate(load4(lanes.rotation, lane),
                           load3(block.rest, lane) * hn::Load(D(), block.inverseLength + lane));
        store3(before, inner, lane);
        store3(before, pulled, lane);
    }
    for (std::uint32_t j = 0; j + 1 < block.points; ++j) {
        for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth) {
            const std::size_t i = std::size_t{j} * kBlockLanes + lane;
            const V inverseLength = hn::Load(D(), block.inverseLength + i);
            const V3 from = load3(place, i), to = load3(place, i + kBlockLanes);
            const V3 tangent = tangentOf<kExact>(to - from, inverseLength);
            V3 ahead = tangent;
            if constexpr (kImplicit) {
                const V3 moved =
                    (load3(block.position, i + kBlockLanes) - to) - (load3(block.position, i) - from);
                ahead = tangent + moved * (inverseLength * q);
            }
            if (j >= first) {
                V3 off = ahead - load3(pulled, lane);
                if constexpr (kFrames) {
                    const V3 target = rotate(load4(frame, lane), load3(block.target, i));
                    off = off - (target - load3(inner, lane));
                }
                store3(off * hn::Load(D(), block.stiffness + i), pulls.planes(), i);
            }
            if constexpr (kFrames) {
                const V4 carried = load4(frame, lane);
                const V3 rest =
                    rotate(carried, kShape == Shape::held || j < first ? load3(block.rest, i) * inverseLength
                                                                       : load3(block.target, i));
                store4(multiply(shortestArc(rest, tangent), carried), frame, lane);
            }
            store3(tangent, inner, lane);
            store3(ahead, pulled, lane);
        }
    }
    const std::size_t last = std::size_t{block.points - 1} * kBlockLanes;
    for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth)
        store3(zero3(), pulls.planes(), last + lane);
}

/// The gradient of the energy by segment s, times h²: (s_s − s_{s+1})/l, or the part of it across the segment
/// by its true length.
template <bool kExact>
HWY_INLINE V3 segmentPull(const BlockView& block, Pulls& pulls, std::size_t i) {
    const V3 difference = load3(pulls.planes(), i) - load3(pulls.planes(), i + kBlockLanes);
    const V inverseLength = hn::Load(D(), block.inverseLength + i);
    if constexpr (!kExact) return difference * inverseLength;
    const V3 edge = load3(block.position, i + kBlockLanes) - load3(block.position, i);
    const V3 tangent = tangentOf<true>(edge, inverseLength);
    const V size = hn::Max(dot(edge, tangent), hn::Load(D(), block.length + i) * all(0.1f));
    const V3 across = difference - tangent * dot(difference, tangent);
    return across * (all(1.0f) / hn::Max(size, all(1e-9f)));
}

/// Angular springs as forces.
template <Shape kShape, bool kExact>
void applyAngular(const BlockView& block, LaneFrame& lanes, const SubstepContext& context) {
    Pulls pulls;
    measurePulls<Bending::forces, kShape, kExact>(block, lanes, context, pulls);
    for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth) {
        const std::size_t before = std::size_t{block.firstFree - 1} * kBlockLanes + lane;
        V3 inner = segmentPull<kExact>(block, pulls, before);
        for (std::uint32_t p = block.firstFree; p < block.points; ++p) {
            const std::size_t i = std::size_t{p} * kBlockLanes + lane;
            const V3 outer = p + 1 < block.points ? segmentPull<kExact>(block, pulls, i) : zero3();
            const V3 kick = (inner - outer) * hn::Load(D(), block.inverseMass + i);
            store3(load3(block.previous, i) + kick, block.previous, i);
            inner = outer;
        }
    }
}

/// Solves (M + share·K) δ = −(forces of `pulls`) along each strand with the factors of the block, and calls
/// take(index, δ), tip to root.
template <class Take>
HWY_INLINE void solveBend(const BlockView& block, Pulls& pulls, Take&& take) {
    for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth) {
        const std::size_t before = std::size_t{block.firstFree - 1} * kBlockLanes + lane;
        V3 inner = segmentPull<false>(block, pulls, before);
        V3 right1 = zero3(), right2 = zero3();
        for (std::uint32_t p = block.firstFree; p < block.points; ++p) {
            const std::size_t i = std::size_t{p} * kBlockLanes + lane;
            const V3 outer = p + 1 < block.points ? segmentPull<false>(block, pulls, i) : zero3();
            const V3 right = (outer - inner) - right1 * hn::Load(D(), block.lower1 + i) -
                             right2 * hn::Load(D(), block.lower2 + i);
            // The pulls of the joints before are no longer needed.
            store3(right, pulls.planes(), i - kBlockLanes);
            inner = outer;
            right2 = right1;
            right1 = right;
        }
        V3 next1 = zero3(), next2 = zero3();
        V lower1 = hn::Zero(D()), lower2 = hn::Zero(D()), lower2Next = hn::Zero(D());
        for (std::uint32_t p = block.points; p-- > block.firstFree;) {
            const std::size_t i = std::size_t{p} * kBlockLanes + lane;
            const V3 delta =
                load3(pulls.planes(), i - kBlockLanes) * hn::Load(D(), block.inverseDiagonal + i) -
                next1 * lower1 - next2 * lower2;
            take(i, delta);
            next2 = next1;
            next1 = delta;
            lower2 = lower2Next;
            lower2Next = hn::Load(D(), block.lower2 + i);
            lower1 = hn::Load(D(), block.lower1 + i);
        }
    }
}

/// Angular springs after position Verlet: the step of their force through (M + (¼ + q) h² K)⁻¹, stable for
/// any stiffness (docs/engine.md).
template <Shape kShape>
void bendBack(const BlockView& block, LaneFrame& lanes, const SubstepContext& context) {
    Pulls pulls;
    measurePulls<Bending::implicit, kShape, false>(block, lanes, context, pulls);
    solveBend(block, pulls,
              [&](std::size_t i, V3 delta) { store3(load3(block.position, i) + delta, block.position, i); });
}

/// Closes a step of backward Euler whose displacement is `rate`.
HWY_INLINE void finishImplicit(const BlockView& block, const LaneFrame& lanes, const SubstepContext& context,
                               std::size_t i, V3 rate) {
    const V3 step = load3(lanes.rootStep, i % kBlockLanes);
    const V3 after = step + (rate - step) * all(context.velocityShare);
    const V3 place = load3(block.start, i) + after;
    store3(place, block.position, i);
    store3(place - after, block.previous, i);
}

/// Puts clamped points to the end of their way.
HWY_INLINE void finishClamped(const BlockView& block) {
    const std::size_t end = std::size_t{block.firstFree} * kBlockLanes;
    for (std::size_t i = 0; i < end; i += kWidth) {
        const V3 start = load3(block.start, i);
        store3(start, block.previous, i);
        store3(start + load3(block.rate, i), block.position, i);
    }
}

/// Backward Euler without stiff forces: symplectic Euler.
void advanceFree(const BlockView& block, LaneFrame& lanes, const SubstepContext& context) {
    finishClamped(block);
    const std::size_t end = std::size_t{block.points} * kBlockLanes;
    for (std::size_t i = std::size_t{block.firstFree} * kBlockLanes; i < end; i += kWidth)
        finishImplicit(block, lanes, context, i, load3(block.position, i) - load3(block.previous, i));
}

/// Backward Euler (Eq. 9) with angular springs: (M + h² K) d = M u + h² f, where u + h² f/M is the
/// displacement that the forces left, so that d = u + h² f/M + δ with (M + h² K) δ = −h² K of it.
void advanceImplicitBend(const BlockView& block, LaneFrame& lanes, const SubstepContext& context) {
    Pulls pulls;
    const std::uint32_t first = block.firstFree - 1;
    for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth) {
        V3 inner = zero3();
        for (std::uint32_t j = 0; j + 1 < block.points; ++j) {
            const std::size_t i = std::size_t{j} * kBlockLanes + lane, o = i + kBlockLanes;
            const V3 from = load3(block.position, i) - load3(block.previous, i);
            const V3 to = load3(block.position, o) - load3(block.previous, o);
            const V3 rate = (to - from) * hn::Load(D(), block.inverseLength + i);
            if (j >= first) store3((rate - inner) * hn::Load(D(), block.stiffness + i), pulls.planes(), i);
            inner = rate;
        }
        store3(zero3(), pulls.planes(), std::size_t{block.points - 1} * kBlockLanes + lane);
    }
    finishClamped(block);
    solveBend(block, pulls, [&](std::size_t i, V3 delta) {
        const V3 rate = load3(block.position, i) - load3(block.previous, i);
        finishImplicit(block, lanes, context, i, rate + delta);
    });
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
