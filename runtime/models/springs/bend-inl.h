// SPDX-License-Identifier: MIT
// Angular springs (docs/engine.md) and the frames that they carry; as forces.
#if defined(HAIRLOOM_RUNTIME_BEND_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_BEND_INL_H
#undef HAIRLOOM_RUNTIME_BEND_INL_H
#else
#define HAIRLOOM_RUNTIME_BEND_INL_H
#endif

#include <cmath>

#include "engine/lanes-inl.h"
#include "hwy/highway.h"
#include "models/springs/spring_block.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

/// How a joint knows its rest direction.
enum class Shape {
    straight,  ///< its inner segment goes on
    curved,    ///< by the frame carried along the strand
};

/// s = κ·h²·(t − target) of each joint of a block, in LaneFrame::solver; those past the last segment are
/// zero.
HWY_INLINE Planes pullsOf(const SpringBlock& block, const LaneFrame& lanes) {
    return {lanes.solver, block.points * kBlockLanes + kPlanePadding};
}

/// A segment's direction: by its rest length, or of unit length.
template <bool kExact>
HWY_INLINE V3 tangentOf(V3 edge, V inverseLength) {
    if constexpr (!kExact) return edge * inverseLength;
    const V squared = dot(edge, edge);
    const auto flat = squared < all(1e-20f);
    const V size = hn::Sqrt(hn::IfThenElse(flat, all(1.0f), squared));
    return edge * hn::IfThenElse(flat, hn::Zero(D()), all(1.0f) / size);
}

/// The frame of a segment, carried root to tip: that of the one before, turned by the shortest arc (Melax
/// 2000) that takes one direction to the other (Eq. 4). Its tangent is the segment's, so one normal is all
/// there is to carry: the arc from a to b takes a normal u of a to u − (b·u)/(1 + a·b) · (a + b), which stays
/// bounded at 180°. `along` is a·b. Each normal waits for the one before; the division, which need not,
/// stands outside of that chain.
HWY_INLINE V3 carryNormalBy(V3 normal, V3 from, V3 to, V onePlusAlong) {
    return negMulAdd((from + to) * (all(1.0f) / onePlusAlong), dot(to, normal), normal);
}
HWY_INLINE V3 carryNormal(V3 normal, V3 from, V3 to, V along) {
    return carryNormalBy(normal, from, to, hn::Max(all(1.0f) + along, all(1e-6f)));
}
/// Where the turn is known not to be near 180°.
HWY_INLINE V3 carryOpenNormal(V3 normal, V3 from, V3 to, V along) {
    return carryNormalBy(normal, from, to, all(1.0f) + along);
}

/// A vector given in a segment's frame.
HWY_INLINE V3 fromFrame(V3 tangent, V3 normal, V3 local) {
    return mulAdd(cross(tangent, normal), local.z, mulAdd(normal, local.y, tangent * local.x));
}

/// The direction that the root carries, before the first segment.
HWY_INLINE V3 rootDirection(const SpringBlock& block, const LaneFrame& lanes, std::size_t lane) {
    return rotate(load4(lanes.rotation, lane),
                  load3(block.rest, lane) * hn::Load(D(), block.inverseLength + lane));
}
/// The normal that it carries; of curved hair.
HWY_INLINE V3 rootNormal(const SpringBlock& block, const LaneFrame& lanes, std::size_t lane) {
    return rotate(load4(lanes.rotation, lane),
                  load3(block.target, std::size_t{block.points - 1} * kBlockLanes + lane));
}

/// Pulls of angular springs at `position`.
template <Shape kShape, bool kExact>
void measurePulls(const SpringBlock& block, const LaneFrame& lanes, Planes pulls) {
    constexpr bool kFrames = kShape == Shape::curved;
    alignas(64) float inner[3][kBlockLanes], units[3][kBlockLanes], normals[3][kBlockLanes];
    const std::uint32_t first = block.firstFree - 1;
    for (std::uint32_t lane = 0; lane < block.lanes; lane += kWidth) {
        const V3 tangent = rootDirection(block, lanes, lane);
        V3 normal = zero3();
        if constexpr (kFrames) normal = rootNormal(block, lanes, lane);
        store3(tangent, inner, lane);
        store3(tangent, units, lane);
        store3(normal, normals, lane);
        store3(zero3(), pulls, std::size_t{block.points - 1} * kBlockLanes + lane);
    }
    for (std::uint32_t j = 0; j + 1 < block.points; ++j) {
        for (std::uint32_t lane = 0; lane < block.lanes; lane += kWidth) {
            const std::size_t i = std::size_t{j} * kBlockLanes + lane;
            const V3 edge = load3(block.position, i + kBlockLanes) - load3(block.position, i);
            const V3 tangent = tangentOf<kExact>(edge, hn::Load(D(), block.inverseLength + i));
            if (j >= first) {
                V3 off = tangent - load3(inner, lane);
                if constexpr (kFrames)
                    off = off - fromFrame(load3(units, lane), load3(normals, lane), load3(block.target, i));
                store3(off * hn::Load(D(), block.stiffness + i), pulls, i);
            }
            if constexpr (kFrames) {
                // Springs may stretch: a frame needs directions of unit length.
                const V3 unit = tangentOf<true>(edge, hn::Load(D(), block.inverseLength + i));
                const V3 before = load3(units, lane);
                store3(carryNormal(load3(normals, lane), before, unit, dot(before, unit)), normals, lane);
                store3(unit, units, lane);
            }
            store3(tangent, inner, lane);
        }
    }
}

/// The gradient of the energy by segment s, times h²: (s_s − s_{s+1})/l, or the part of it across the segment
/// by its true length.
template <bool kExact>
HWY_INLINE V3 segmentPull(const SpringBlock& block, Planes pulls, std::size_t i) {
    const V3 difference = load3(pulls, i) - load3(pulls, i + kBlockLanes);
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
void applyAngular(const SpringBlock& block, LaneFrame& lanes, const SubstepContext&) {
    const Planes pulls = pullsOf(block, lanes);
    measurePulls<kShape, kExact>(block, lanes, pulls);
    for (std::uint32_t lane = 0; lane < block.lanes; lane += kWidth) {
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

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
