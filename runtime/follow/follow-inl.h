// SPDX-License-Identifier: MIT
// Wisps of guides, one guide per lane, and hairs as sums of rows, one coordinate per lane. Included anew for
// each instruction set.
#if defined(HAIRLOOM_RUNTIME_KERNELS_FOLLOW_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_KERNELS_FOLLOW_INL_H
#undef HAIRLOOM_RUNTIME_KERNELS_FOLLOW_INL_H
#else
#define HAIRLOOM_RUNTIME_KERNELS_FOLLOW_INL_H
#endif

#include <algorithm>
#include <cstring>

#include "engine/lanes-inl.h"
#include "follow/follow_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

using DI = hn::RebindToSigned<D>;
using Indices = hn::Vec<DI>;

/// Three neighbouring floats at each lane's place.
HWY_INLINE V3 gather3(const float* base, Indices places) {
    return {hn::GatherIndex(D(), base, places), hn::GatherIndex(D(), base + 1, places),
            hn::GatherIndex(D(), base + 2, places)};
}
HWY_INLINE void scatter3(V3 v, float* base, Indices places) {
    hn::ScatterIndex(v.x, D(), base, places);
    hn::ScatterIndex(v.y, D(), base + 1, places);
    hn::ScatterIndex(v.z, D(), base + 2, places);
}

/// A cross-section's frame on its way along the strand.
struct CarriedFrame {
    V3 tangent;
    V3 normal;  ///< across the tangent

    /// Turns the frame the shortest way onto the direction of `chord`. For a normal across the tangent that
    /// turn is the reflection in the plane half-way between the directions. A chord without length, or that
    /// is no number, leaves the frame as it is; a chord straight back turns it about its normal.
    HWY_INLINE void carry(V3 chord) {
        const V squared = dot(chord, chord);
        const auto usable = hn::And(squared > all(1e-24f), squared < all(1e30f));
        const V3 next = chord * (all(1.0f) / hn::Sqrt(squared));
        const V3 half = tangent + next;
        const V size = dot(half, half);
        const V share = hn::IfThenElseZero(size > all(1e-8f), dot(half, normal) / size);
        const V3 mirrored = normal - half * (share + share);
        const V3 across = mirrored - next * dot(mirrored, next);
        const V3 turned = across * (all(1.0f) / hn::Sqrt(dot(across, across)));
        tangent = select(usable, next, tangent);
        normal = select(usable, turned, normal);
    }
};

/// The guides of one register: where the first's rows begin, and in floats from there each lane's.
struct GuideLanes {
    const float* positions;
    float* wisps;
    const float* frames;
    Indices row, wisp, frame;

    HWY_INLINE GuideLanes(const GuideRows& guides, std::size_t first, std::size_t end)
        : positions(guides.positions + first * guides.rowFloats),
          wisps(guides.wisps + first * guides.rowFloats * kWispRows),
          frames(guides.frames + first * kFrameFloats) {
        HWY_ALIGN std::int32_t guideOfLane[kWidth];
        for (std::size_t lane = 0; lane < kWidth; ++lane) {
            guideOfLane[lane] = static_cast<std::int32_t>(std::min(lane, end - 1 - first));
        }
        const Indices guide = hn::Load(DI(), guideOfLane);
        row = guide * hn::Set(DI(), static_cast<std::int32_t>(guides.rowFloats));
        wisp = row * hn::Set(DI(), static_cast<std::int32_t>(kWispRows));
        frame = guide * hn::Set(DI(), static_cast<std::int32_t>(kFrameFloats));
    }
};

HWY_INLINE void fillWispPoint(const GuideRows& guides, const GuideLanes& lanes, std::uint32_t point,
                              V3 position, V3 xAxis, V3 yAxis) {
    const float share = static_cast<float>(point) / static_cast<float>(guides.points - 1);
    const float radius = guides.radii[point];
    float* centre = lanes.wisps + std::size_t{point} * 3;
    const V3 velocity = gather3(centre, lanes.wisp);
    const V speed = hn::Sqrt(dot(velocity, velocity));
    const V widest = all(guides.motion.limit - 1.0f) / hn::Max(speed, all(1e-30f));
    const V sigma = hn::Min(all(guides.motion.spread * share), widest);
    const V xi = all(1.0f) + sigma * speed;  // Eq. 22
    // Eq. 23, where (ξ − 1) v/|v| = σ v is smooth at rest.
    scatter3(position - velocity * (all(radius) * sigma), centre, lanes.wisp);
    scatter3(xAxis * (all(radius) * xi), centre + guides.rowFloats, lanes.wisp);
    scatter3(yAxis * (all(radius) * xi), centre + 2 * guides.rowFloats, lanes.wisp);
}

void fillWisps(const GuideRows& guides, std::size_t begin, std::size_t end) {
    const std::uint32_t last = guides.points - 1;
    for (std::size_t first = begin; first < end; first += kWidth) {
        const GuideLanes lanes(guides, first, end);
        const V3 x = gather3(lanes.frames, lanes.frame);
        CarriedFrame frame{gather3(lanes.frames + 8, lanes.frame), x};
        V3 before = gather3(lanes.positions, lanes.row);
        V3 here = before;
        fillWispPoint(guides, lanes, 0, here, x, gather3(lanes.frames + 4, lanes.frame));
        for (std::uint32_t point = 0; point <= last; ++point) {
            // A point's tangent joins its neighbours.
            const V3 after =
                point < last ? gather3(lanes.positions + (std::size_t{point} + 1) * 3, lanes.row) : here;
            frame.carry(after - before);
            if (point > 0)
                fillWispPoint(guides, lanes, point, here, frame.normal, cross(frame.tangent, frame.normal));
            before = here;
            here = after;
        }
    }
}

/// Which coordinate stands in each lane of the k-th register of x y z x y z ….
HWY_INLINE auto coordinatePattern(std::size_t k) {
    HWY_ALIGN std::int32_t coordinates[kWidth];
    for (std::size_t lane = 0; lane < kWidth; ++lane) {
        coordinates[lane] = kWidth < 4 ? 0 : static_cast<std::int32_t>((k * kWidth + lane) % 3);
    }
    return hn::SetTableIndices(D(), coordinates);
}

/// A position over and over, x y z x y z …, in three registers.
class RepeatedPosition {
  public:
    HWY_INLINE RepeatedPosition()
        : first_(coordinatePattern(0)), second_(coordinatePattern(1)), third_(coordinatePattern(2)) {}

    /// `position` is x y z 0, aligned.
    HWY_INLINE V3 of(const float* place) const {
        const D d;
        if constexpr (kWidth < 4) {
            return {hn::Load(d, place), hn::Load(d, place + 1), hn::Load(d, place + 2)};
        } else {
            const V lanes = hn::LoadDup128(d, place);
            return {hn::TableLookupLanes(lanes, first_), hn::TableLookupLanes(lanes, second_),
                    hn::TableLookupLanes(lanes, third_)};
        }
    }

  private:
    decltype(coordinatePattern(0)) first_, second_, third_;
};

/// A constant over the hair, x y z 0: the shift onto the scalp, and what brings the shape's root to its
/// position in the root triangle.
HWY_INLINE void shiftOf(const GuideRows& guides, const HairBinding& hair, float* shift) {
    const hn::CappedTag<float, 4> d;
    const float* frame = guides.frames + hair.guides[0] * kFrameFloats;
    const float* root0 = guides.positions + hair.guides[0] * guides.rowFloats;
    const float* root1 = guides.positions + hair.guides[1] * guides.rowFloats;
    const float* root2 = guides.positions + hair.guides[2] * guides.rowFloats;
    for (std::size_t i = 0; i < 4; i += hn::MaxLanes(d)) {
        const auto along = hn::Set(d, hair.rootShift[0]) * hn::Load(d, frame + i) +
                           hn::Set(d, hair.rootShift[1]) * hn::Load(d, frame + 4 + i);
        const auto own = hn::Set(d, hair.rootShift[2]) * hn::Load(d, frame + 8 + i) +
                         hn::Set(d, hair.rootWeights[0]) * hn::Load(d, root0 + i);
        const auto others = hn::Set(d, hair.rootWeights[1]) * hn::Load(d, root1 + i) +
                            hn::Set(d, hair.rootWeights[2]) * hn::Load(d, root2 + i);
        hn::Store((along + own) + others, d, shift + i);
    }
}

/// The rows of one hair and their weights.
class RowSum {
  public:
    HWY_INLINE RowSum(const GuideRows& guides, const HairBinding& hair)
        : wisp_(guides.wisps + hair.guides[0] * kWispRows * guides.rowFloats), rowFloats_(guides.rowFloats) {
        for (std::size_t k = 0; k < 3; ++k) rows_[k] = guides.positions + hair.guides[k] * guides.rowFloats;
        single_ = all(hair.single);
        offsetX_ = all(hair.wispOffset[0]);
        offsetY_ = all(hair.wispOffset[1]);
        weight0_ = all(hair.weights[0]);
        weight1_ = all(hair.weights[1]);
        weight2_ = all(hair.weights[2]);
    }
    HWY_INLINE V at(std::size_t i, V shift) const {
        const D d;
        const V wisp = single_ * hn::Load(d, wisp_ + i) + offsetX_ * hn::Load(d, wisp_ + rowFloats_ + i);
        const V ends =
            offsetY_ * hn::Load(d, wisp_ + 2 * rowFloats_ + i) + weight0_ * hn::Load(d, rows_[0] + i);
        const V between = weight1_ * hn::Load(d, rows_[1] + i) + weight2_ * hn::Load(d, rows_[2] + i);
        return (wisp + ends) + (between + shift);
    }

  private:
    const float* wisp_;
    std::size_t rowFloats_;
    const float* rows_[3];
    V single_, offsetX_, offsetY_, weight0_, weight1_, weight2_;
};

HWY_INLINE void storeFirst(V v, std::size_t count, float* to) {
    if (count >= kWidth) {
        hn::StoreU(v, D(), to);
        return;
    }
    HWY_ALIGN float lanes[kWidth];
    hn::Store(v, D(), lanes);
    std::memcpy(to, lanes, count * sizeof(float));
}

void sumRows(const GuideRows& guides, std::span<const HairBinding> hairs, float* positions) {
    const D d;
    const RepeatedPosition repeated;
    const std::size_t floats = std::size_t{guides.points} * 3;
    for (const HairBinding& hair : hairs) {
        const RowSum sum(guides, hair);
        alignas(16) float place[4];
        shiftOf(guides, hair, place);
        const V3 shift = repeated.of(place);
        std::size_t i = 0;
        for (; i + 3 * kWidth <= floats; i += 3 * kWidth) {
            hn::StoreU(sum.at(i, shift.x), d, positions + i);
            hn::StoreU(sum.at(i + kWidth, shift.y), d, positions + i + kWidth);
            hn::StoreU(sum.at(i + 2 * kWidth, shift.z), d, positions + i + 2 * kWidth);
        }
        for (const V part : {shift.x, shift.y, shift.z}) {
            if (i < floats) storeFirst(sum.at(i, part), floats - i, positions + i);
            i += kWidth;
        }
        positions += floats;
    }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
