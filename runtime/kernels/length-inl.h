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
    places,  ///< segments get their length back; the move counts as velocity
    rates,   ///< the velocity's part that would change lengths is taken out
};

/// One Newton step on all length constraints ½(|e|²/l − l) = 0 of a strand together, or on their rates
/// e·ė/l = 0; clamped points have infinite mass. The system is tridiagonal and is solved directly (after
/// Goldenthal et al. 2007; with rates, RATTLE, Andersen 1983), so momentum travels along the whole strand in
/// one step. Collapsed segments keep a diagonal of at least ¼ of their masses': no overshoot.
template <Holding kHolding>
void holdStrands(const BlockView& block) {
    alignas(64) float ux[kMaxPoints * kWidth], uy[kMaxPoints * kWidth], uz[kMaxPoints * kWidth];
    alignas(64) float upper[kMaxPoints * kWidth], right[kMaxPoints * kWidth];
    const Planes u{ux, uy, uz};
    const V half = all(0.5f);
    const V least = all(0.25f);
    const std::uint32_t first = block.firstFree - 1;
    const std::uint32_t end = block.points - 1;
    const auto rateAt = [&](std::size_t i) { return load3(block.position, i) - load3(block.previous, i); };
    for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth) {
        const std::size_t clamped = std::size_t{first} * kBlockLanes + lane;
        V3 parent = load3(block.position, clamped);
        V3 parentRate = zero3();
        if constexpr (kHolding == Holding::rates) parentRate = rateAt(clamped);
        V3 before = zero3();
        V inverse = hn::Zero(D()), rhs = hn::Zero(D()), weight = hn::Zero(D());
        for (std::uint32_t s = first; s < end; ++s) {
            const std::size_t i = std::size_t{s} * kBlockLanes + lane;
            const V3 point = load3(block.position, i + kBlockLanes);
            const V3 edge = point - parent;
            const V3 gradient = edge * hn::Load(D(), block.inverseLength + i);
            V error;
            if constexpr (kHolding == Holding::places) {
                error = half * (dot(edge, gradient) - hn::Load(D(), block.length + i));
            } else {
                const V3 rate = rateAt(i + kBlockLanes);
                error = dot(gradient, rate - parentRate);
                parentRate = rate;
            }
            const V outerWeight = hn::Load(D(), block.inverseMass + i + kBlockLanes);
            const V squared = hn::Max(dot(gradient, gradient), least);
            const V coupling = dot(before, gradient) * weight;
            const V up = coupling * inverse;
            inverse = all(1.0f) / (squared * (weight + outerWeight) - coupling * up);
            rhs = (error + coupling * rhs) * inverse;
            const std::size_t k = std::size_t{s} * kWidth;
            hn::Store(up, D(), upper + k);
            hn::Store(rhs, D(), right + k);
            store3(gradient, u, k);
            before = gradient;
            parent = point;
            weight = outerWeight;
        }
        V3 after = zero3();
        V lambda = hn::Zero(D()), up = hn::Zero(D());
        for (std::uint32_t s = end; s-- > first;) {
            const std::size_t i = std::size_t{s + 1} * kBlockLanes + lane;
            const std::size_t k = std::size_t{s} * kWidth;
            lambda = hn::Load(D(), right + k) + up * lambda;
            const V3 tension = load3(u, k) * lambda;
            const V3 move = (after - tension) * hn::Load(D(), block.inverseMass + i);
            if constexpr (kHolding == Holding::places) {
                store3(load3(block.position, i) + move, block.position, i);
            } else {
                store3(load3(block.previous, i) - move, block.previous, i);
            }
            after = tension;
            up = hn::Load(D(), upper + k);
        }
    }
}

void holdLength(const BlockView& block, LaneFrame&, const SubstepContext& context) {
    for (std::uint32_t iteration = 0; iteration < context.lengthIterations; ++iteration)
        holdStrands<Holding::places>(block);
}

void holdRates(const BlockView& block, LaneFrame&, const SubstepContext&) {
    holdStrands<Holding::rates>(block);
}

/// Root to tip, brings segments back to between (1 − ε) and (1 + ε) of their length (Provot 1995, both ways).
/// The move counts as velocity only where that slows the point relative to its root: it never adds energy.
void limitExtension(const BlockView& block, LaneFrame& lanes, const SubstepContext& context) {
    const V longest = all(1.0f + context.maximalExtension);
    const V shortest = all(1.0f - context.maximalExtension);
    const V tiny = all(1e-12f), one = all(1.0f);
    for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth) {
        const V3 step = load3(lanes.rootStep, lane);
        V3 parent = load3(block.position, std::size_t{block.firstFree - 1} * kBlockLanes + lane);
        for (std::uint32_t p = block.firstFree; p < block.points; ++p) {
            const std::size_t i = std::size_t{p} * kBlockLanes + lane;
            const V3 position = load3(block.position, i);
            const V3 edge = position - parent;
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
            const V3 move = select(wrong, fixed - edge, zero3());
            const V3 previous = load3(block.previous, i);
            const V3 moving = position - previous - step;
            const V braking = (zero - dot(moving, move)) / (dot(move, move) + all(1e-30f));
            const V counted = hn::Min(hn::Max(braking, zero), one);
            parent = position + move;
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
