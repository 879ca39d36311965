// SPDX-License-Identifier: MIT
// Coil and flexion springs.
#if defined(HAIRLOOM_RUNTIME_SPRINGS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_SPRINGS_INL_H
#undef HAIRLOOM_RUNTIME_SPRINGS_INL_H
#else
#define HAIRLOOM_RUNTIME_SPRINGS_INL_H
#endif

#include "engine/lanes-inl.h"
#include "hwy/highway.h"
#include "models/springs/spring_block.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

/// Length of an edge and its direction; down for an edge without length.
struct Edge {
    V size;
    V3 direction;
};
HWY_INLINE Edge edgeOf(V3 edge) {
    const V zero = hn::Zero(D()), one = all(1.0f);
    const V size = hn::Sqrt(dot(edge, edge));
    const auto flat = size < all(1e-10f);
    const V inverse = one / hn::IfThenElse(flat, one, size);
    return {size, select(flat, {zero, zero - one, zero}, edge * inverse)};
}

/// k·h² of the coil spring of a segment, where its ends have these inverse masses: the harmonic mean of their
/// masses times ω²·h².
HWY_INLINE V coilStep(const SubstepContext& context, V inverseMassFrom, V inverseMassTo) {
    return all(2.0f * context.springStep) / (inverseMassFrom + inverseMassTo);
}

/// Coil springs (Rünz 2012, Eq. 3; the whole force on each end).
void applySprings(const SpringBlock& block, LaneFrame&, const SubstepContext& context) {
    for (std::uint32_t lane = 0; lane < block.lanes; lane += kWidth) {
        V3 inner = zero3();
        for (std::uint32_t p = block.firstFree - 1; p < block.points; ++p) {
            const std::size_t i = std::size_t{p} * kBlockLanes + lane;
            const V mass = hn::Load(D(), block.inverseMass + i);
            V3 outer = zero3();
            if (p + 1 < block.points) {
                const Edge edge = edgeOf(load3(block.position, i + kBlockLanes) - load3(block.position, i));
                const V stretch = edge.size - hn::Load(D(), block.length + i);
                const V step = coilStep(context, mass, hn::Load(D(), block.inverseMass + i + kBlockLanes));
                outer = edge.direction * (stretch * step);
            }
            if (p >= block.firstFree)
                store3(load3(block.previous, i) - (outer - inner) * mass, block.previous, i);
            inner = outer;
        }
    }
}

/// Flexion springs between every second point (Selle et al. 2008 call them bending springs).
void applyFlexion(const SpringBlock& block, LaneFrame&, const SubstepContext&) {
    for (std::uint32_t p = 1; p + 1 < block.points; ++p) {
        for (std::uint32_t lane = 0; lane < block.lanes; lane += kWidth) {
            const std::size_t i = std::size_t{p} * kBlockLanes + lane;
            const std::size_t before = i - kBlockLanes, after = i + kBlockLanes;
            const V3 span = load3(block.rest, before) + load3(block.rest, i);
            const Edge edge = edgeOf(load3(block.position, after) - load3(block.position, before));
            const V3 pull = edge.direction *
                            ((edge.size - hn::Sqrt(dot(span, span))) * hn::Load(D(), block.stiffness + i));
            if (p + 1 >= block.firstFree)
                store3(load3(block.previous, after) + pull * hn::Load(D(), block.inverseMass + after),
                       block.previous, after);
            if (p - 1 >= block.firstFree)
                store3(load3(block.previous, before) - pull * hn::Load(D(), block.inverseMass + before),
                       block.previous, before);
        }
    }
}

/// Maximal extension by velocities (Bridson et al. 2003): impulses along segments that would leave their
/// bounds, root to tip, momentum kept.
void limitBySpeed(const SpringBlock& block, LaneFrame&, const SubstepContext& context) {
    const V longest = all(1.0f + context.maximalExtension), shortest = all(1.0f - context.maximalExtension);
    const V zero = hn::Zero(D());
    for (std::uint32_t pass = 0; pass < context.lengthIterations; ++pass) {
        for (std::uint32_t p = block.firstFree; p < block.points; ++p) {
            for (std::uint32_t lane = 0; lane < block.lanes; lane += kWidth) {
                const std::size_t i = std::size_t{p} * kBlockLanes + lane, parent = i - kBlockLanes;
                const V rest = hn::Load(D(), block.length + parent);
                const V3 from = load3(block.position, parent), to = load3(block.position, i);
                const Edge edge = edgeOf(to - from);
                const V wrong = edge.size - hn::Min(hn::Max(edge.size, rest * shortest), rest * longest);
                const V outer = hn::Load(D(), block.inverseMass + i);
                const V inner = p > block.firstFree ? hn::Load(D(), block.inverseMass + parent) : zero;
                const V3 impulse = edge.direction * (wrong / (outer + inner));
                store3(to - impulse * outer, block.position, i);
                if (p > block.firstFree) store3(from + impulse * inner, block.position, parent);
            }
        }
    }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
