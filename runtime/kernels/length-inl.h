// SPDX-License-Identifier: MIT
// Length of segments: the constraint, and the maximal extension as post-processing.
#if defined(HAIRLOOM_RUNTIME_LENGTH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_LENGTH_INL_H
#undef HAIRLOOM_RUNTIME_LENGTH_INL_H
#else
#define HAIRLOOM_RUNTIME_LENGTH_INL_H
#endif

#include "hwy/highway.h"
#include "runtime/kernels.h"
#include "runtime/kernels/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

/// Where a strand's length is held.
enum class Holding {
    places,     ///< segments get their length back; the move counts as velocity
    placesNow,  ///< likewise, with tension along the segments as they are after the integration
    rates,      ///< the velocity's part that would change lengths is taken out
};

/// A segment's constraint gradient where the lengths are wanted, and the direction along which its tension
/// acts. For places that is the gradient at the start of the substep (SHAKE, Ryckaert et al. 1977), which
/// keeps the order and the energy of the integrator; only segments that turn by more than 60° in a substep
/// take that of now.
struct Gradients {
    V3 wanted, acting;
};
template <Holding kHolding>
HWY_INLINE Gradients gradientsOf(V3 edge, V3 edgeBefore, V inverseLength) {
    const V3 wanted = edge * inverseLength;
    if constexpr (kHolding != Holding::places) return {wanted, wanted};
    const V3 before = edgeBefore * inverseLength;
    const auto alike = dot(wanted, before) > all(0.5f) * dot(wanted, wanted);
    return {wanted, select(alike, before, wanted)};
}

/// Keeps tension for the bending of the next substep. Slowly: what bending makes of it comes back a substep
/// late. And no more than Verlet holds across a segment, by half of its limit; hardly a segment pulls as
/// much.
HWY_INLINE void keepTension(const BlockView& block, const SubstepContext& context, std::size_t i, V added) {
    const V weight =
        hn::Load(D(), block.inverseMass + i) + hn::Load(D(), block.inverseMass + i + kBlockLanes);
    const V half = all(0.5f) * hn::Load(D(), block.length + i);
    V kept = hn::Load(D(), block.tension + i) + added * all(context.tensionShare);
    const auto tooMuch = hn::Abs(kept) * weight > half;
    if (HWY_UNLIKELY(!hn::AllFalse(D(), tooMuch)))
        kept = hn::IfThenElse(tooMuch, hn::CopySign(half / weight, kept), kept);
    hn::Store(kept, D(), block.tension + i);
}

/// The tridiagonal system of a strip of strands whose lengths are held; by segment.
struct LengthSystem {
    StripRow3 acting;  ///< Gradients::acting
    StripRow upper, right;
};

/// One Newton step on all length constraints ½(|e|²/l − l) = 0 of a strand together, or on their rates
/// e·ė/l = 0; clamped points have infinite mass. The system is tridiagonal and is solved directly (after
/// Goldenthal et al. 2007; with rates, RATTLE, Andersen 1983), so momentum travels along the whole strand in
/// one step. Collapsed segments keep a diagonal of at least ¼ of their masses': no overshoot.
template <Holding kHolding>
HWY_INLINE void reduceLengths(const BlockView& block, std::size_t lane, LengthSystem& system) {
    const Planes& start = block.start.x ? block.start : block.previous;
    const V half = all(0.5f), least = all(0.25f), zero = hn::Zero(D()), one = all(1.0f);
    const std::uint32_t first = block.firstFree - 1;
    const std::size_t begin = std::size_t{first} * kBlockLanes + lane;
    const auto rateAt = [&](std::size_t i, V3 place) HWY_ATTR { return place - load3(block.previous, i); };
    V3 at = load3(block.position, begin), before = zero3(), rate = zero3();
    if constexpr (kHolding == Holding::places) before = load3(start, begin);
    if constexpr (kHolding == Holding::rates) rate = rateAt(begin, at);
    V3 lastWanted = zero3(), lastActing = zero3();
    V inner = zero, lastInverse = zero, lastRight = zero;
    for (std::uint32_t s = first; s + 1 < block.points; ++s) {
        const std::size_t i = std::size_t{s} * kBlockLanes + lane, o = i + kBlockLanes;
        const V3 to = load3(block.position, o);
        V3 edgeBefore = zero3();
        if constexpr (kHolding == Holding::places) {
            const V3 toBefore = load3(start, o);
            edgeBefore = toBefore - before;
            before = toBefore;
        }
        const auto [wanted, acting] =
            gradientsOf<kHolding>(to - at, edgeBefore, hn::Load(D(), block.inverseLength + i));
        V error;
        if constexpr (kHolding == Holding::rates) {
            const V3 toRate = rateAt(o, to);
            error = dot(wanted, toRate - rate);
            rate = toRate;
        } else {
            error = half * (dot(to - at, wanted) - hn::Load(D(), block.length + i));
        }
        const V own = hn::Max(dot(wanted, acting), least);
        const V outer = hn::Load(D(), block.inverseMass + o);
        const V below = dot(wanted, lastActing) * inner;
        const V up = dot(lastWanted, acting) * inner * lastInverse;
        lastInverse = one / (own * (inner + outer) - below * up);
        lastRight = (error + below * lastRight) * lastInverse;
        system.acting.set(s, acting);
        system.upper.set(s, up);
        system.right.set(s, lastRight);
        at = to;
        inner = outer;
        lastWanted = wanted;
        lastActing = acting;
    }
}

/// Moves the points by the tension that the system gives.
template <Holding kHolding, bool kKept>
HWY_INLINE void applyTension(const BlockView& block, const SubstepContext& context, std::size_t lane,
                             const LengthSystem& system) {
    V3 after = zero3();
    V lambda = hn::Zero(D()), upper = lambda;
    for (std::uint32_t s = block.points - 1; s-- > block.firstFree - 1;) {
        const std::size_t i = std::size_t{s} * kBlockLanes + lane, o = i + kBlockLanes;
        lambda = system.right[s] + upper * lambda;
        upper = system.upper[s];
        const V3 tension = system.acting[s] * lambda;
        const V3 move = (after - tension) * hn::Load(D(), block.inverseMass + o);
        if constexpr (kHolding != Holding::rates) {
            store3(load3(block.position, o) + move, block.position, o);
        } else {
            store3(load3(block.previous, o) - move, block.previous, o);
        }
        if constexpr (kKept) keepTension(block, context, i, lambda);
        after = tension;
    }
}

template <Holding kHolding, bool kKept = false>
void holdStrands(const BlockView& given, const SubstepContext& context) {
    const BlockView block = localCopy(given);
    LengthSystem system;
    for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth) {
        reduceLengths<kHolding>(block, lane, system);
        applyTension<kHolding, kKept>(block, context, lane, system);
    }
}

template <Holding kHolding>
void holdLength(const BlockView& block, LaneFrame&, const SubstepContext& context) {
    for (std::uint32_t iteration = 0; iteration < context.lengthIterations; ++iteration) {
        if (kHolding == Holding::places && block.tension) {
            holdStrands<kHolding, true>(block, context);
        } else {
            holdStrands<kHolding>(block, context);
        }
    }
}

void holdRates(const BlockView& block, LaneFrame&, const SubstepContext& context) {
    holdStrands<Holding::rates>(block, context);
}

/// Root to tip, brings segments back to between (1 − ε) and (1 + ε) of their length (Provot 1995, both ways).
/// The move counts as velocity only where that slows the point relative to its root: it never adds energy.
void limitExtension(const BlockView& given, LaneFrame& lanes, const SubstepContext& context) {
    const BlockView block = localCopy(given);
    const V longest = all(1.0f + context.maximalExtension);
    const V shortest = all(1.0f - context.maximalExtension);
    const V tiny = all(1e-12f), one = all(1.0f);
    for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth) {
        const V3 step = load3(lanes.rootStep, lane);
        V3 parent = load3(block.position, std::size_t{block.firstFree - 1} * kBlockLanes + lane);
        for (std::uint32_t p = block.firstFree; p < block.points; ++p) {
            const std::size_t i = std::size_t{p} * kBlockLanes + lane;
            const V3 position = load3(block.position, i);
            const V3 from = parent, edge = position - from;
            const V rest = hn::Load(D(), block.length + (i - kBlockLanes));
            const V low = rest * shortest, high = rest * longest;
            const V squared = dot(edge, edge);
            const auto wrong = hn::Or(squared > high * high, squared < low * low);
            parent = position;
            if (HWY_LIKELY(hn::AllFalse(D(), wrong))) continue;
            const V size = hn::Sqrt(squared);
            const auto collapsed = size < tiny;
            const V bounded = hn::Min(hn::Max(size, low), high);
            const V scale = bounded / hn::IfThenElse(collapsed, one, size);
            const V zero = hn::Zero(D());
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
            store3(previous + move * (one - counted), block.previous, i);
        }
    }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
