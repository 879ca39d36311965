// SPDX-License-Identifier: MIT
// Inner loops of hair-hair collision, compiled once for each instruction set.
#include "engine/hair_kernel.h"

#include <algorithm>

// Vector types stand in structs, which scalable vectors cannot.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/hair_kernel.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "engine/lanes-inl.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

constexpr std::size_t kNodeCorners = 8;
constexpr float kNoHairPlace = 1e5f;  // cells

/// Where the points of one row of a block are: the least of their eight nodes, or −1 outside of the grid, and
/// their weights there.
struct alignas(64) HairRow {
    std::int32_t node[kBlockLanes];
    float weights[kNodeCorners][kBlockLanes];
};

HWY_INLINE void findRow(const HairBlock& block, const HairFrame& frame, std::size_t row, HairRow& to) {
    const hn::RebindToSigned<D> integers;
    for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth) {
        const V3 at = load3(block.places + row + lane, block.pitch);
        V3 corner, part;
        auto inside = noLane();
        const auto split = [&](V place, int axis, V& least, V& share, bool first) {
            const V from = place - all(static_cast<float>(frame.box.low[axis]));
            const auto here =
                hn::And(from >= hn::Zero(D()), from < all(static_cast<float>(frame.box.size[axis] - 1)));
            inside = first ? here : hn::And(inside, here);
            least = hn::Floor(from);
            share = from - least;
        };
        split(at.x, 0, corner.x, part.x, true);
        split(at.y, 1, corner.y, part.y, false);
        split(at.z, 2, corner.z, part.z, false);
        const V rows = all(static_cast<float>(frame.box.size[1])),
                along = all(static_cast<float>(frame.box.size[0]));
        const V node = hn::MulAdd(hn::MulAdd(corner.z, rows, corner.y), along, corner.x);
        hn::Store(hn::ConvertTo(integers, hn::IfThenElse(inside, node, all(-1.0f))), integers,
                  to.node + lane);
        const V one = all(1.0f);
        const V x[] = {one - part.x, part.x}, y[] = {one - part.y, part.y}, z[] = {one - part.z, part.z};
        for (std::size_t corners = 0; corners < kNodeCorners; ++corners)
            hn::Store(x[corners & 1] * y[corners >> 1 & 1] * z[corners >> 2], D(),
                      to.weights[corners] + lane);
    }
}

struct HairCorners {
    explicit HairCorners(const HairBox& box) {
        const auto row = static_cast<std::size_t>(box.size[0]),
                   slice = row * static_cast<std::size_t>(box.size[1]);
        for (std::size_t corner = 0; corner < kNodeCorners; ++corner)
            offsets[corner] = (corner & 1) + (corner >> 1 & 1) * row + (corner >> 2) * slice;
    }
    std::size_t offsets[kNodeCorners];
};

void locateHair(const HairBlock& block, const HairFrame& frame, HairBounds& bounds) {
    float lows[3] = {kNoHairPlace, kNoHairPlace, kNoHairPlace},
          highs[3] = {-kNoHairPlace, -kNoHairPlace, -kNoHairPlace};
    const V ahead = all(frame.ahead);
    for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth) {
        const V3 root = load3(block.roots + lane, kBlockLanes) - all3(frame.head);
        const V center[] = {all(frame.center.x), all(frame.center.y), all(frame.center.z)};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const V3 row = all3(frame.axes[axis]);
            const V base = dot(row, root) + center[axis];
            float* const to = block.places + axis * block.pitch + lane;
            V low = all(kNoHairPlace), high = all(-kNoHairPlace);
            for (std::uint32_t p = 0; p < block.points; ++p) {
                const std::size_t i = std::size_t{p} * kBlockLanes;
                const float* const now = block.moving + lane + i;
                const V3 position = load3(now, block.pitch);
                const V3 moved = position - load3(now + 3 * block.pitch, block.pitch);
                const V at = dot(row, mulAdd(moved, ahead, position)) + base;
                hn::Store(at, D(), to + i);
                low = hn::IfThenElse(at < low, at, low);
                high = hn::IfThenElse(at > high, at, high);
            }
            lows[axis] = std::min(lows[axis], laneMin(low));
            highs[axis] = std::max(highs[axis], laneMax(high));
        }
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        bounds.low[axis] = lows[axis];
        bounds.high[axis] = highs[axis];
    }
}

HWY_INLINE V3 velocityAt(const HairBlock& block, const HairFrame& frame, std::size_t i) {
    const V3 moved =
        load3(block.moving + i, block.pitch) - load3(block.moving + 3 * block.pitch + i, block.pitch);
    return moved * all(frame.rate) - all3(frame.reference);
}

HWY_INLINE V wholeVelocity(V v) {
    const V most = all(kMostHairVelocity), least = all(-kMostHairVelocity);
    v = hn::IfThenElse(v < most, v, most);
    v = hn::IfThenElse(v > least, v, least);
    return hn::Round(v * all(1.0f / kHairVelocityUnit));
}

void depositHair(const HairBlock& block, const HairFrame& frame, double* sums) {
    using Doubles = hn::CappedTag<double, kHairSums>;
    using Floats4 = hn::Rebind<float, Doubles>;
    constexpr std::size_t kStep = hn::MaxLanes(Doubles());
    const HairCorners corners(frame.box);
    HairRow row;
    alignas(64) float moving[kBlockLanes * kHairSums];
    for (std::uint32_t p = 0; p < block.points; ++p) {
        const std::size_t first = std::size_t{p} * kBlockLanes;
        findRow(block, frame, first, row);
        for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth) {
            const V share = hn::Load(D(), block.share + first + lane);
            for (auto& weights : row.weights)
                hn::Store(hn::Round(hn::Load(D(), weights + lane) * share), D(), weights + lane);
            const V3 v = velocityAt(block, frame, first + lane);
            hn::StoreInterleaved4(all(1.0f), wholeVelocity(v.x), wholeVelocity(v.y), wholeVelocity(v.z), D(),
                                  moving + lane * kHairSums);
        }
        for (std::uint32_t lane = 0; lane < block.strands; ++lane) {
            if (row.node[lane] < 0) continue;
            double* const node = sums + static_cast<std::size_t>(row.node[lane]) * kHairSums;
            for (std::size_t part = 0; part < kHairSums; part += kStep) {
                const auto each =
                    hn::PromoteTo(Doubles(), hn::LoadU(Floats4(), moving + lane * kHairSums + part));
                for (std::size_t corner = 0; corner < kNodeCorners; ++corner) {
                    double* const at = node + corners.offsets[corner] * kHairSums + part;
                    const auto weight = hn::Set(Doubles(), static_cast<double>(row.weights[corner][lane]));
                    hn::StoreU(hn::MulAdd(weight, each, hn::LoadU(Doubles(), at)), Doubles(), at);
                }
            }
        }
    }
}

/// Pressure and friction, as an acceleration and the rate at which they resist: with both a substep blends
/// the velocity of a point with that around it.
void pressHair(const HairBlock& block, const HairFrame& frame, const float* fields) {
    using Four = hn::CappedTag<float, 4>;
    constexpr std::size_t kStep = hn::MaxLanes(Four());
    const HairCorners corners(frame.box);
    HairRow row;
    alignas(64) float pushes[kBlockLanes * 4], motions[kBlockLanes * 4];
    for (std::uint32_t p = 0; p < block.points; ++p) {
        const std::size_t first = std::size_t{p} * kBlockLanes;
        findRow(block, frame, first, row);
        for (std::uint32_t lane = 0; lane < kBlockLanes; ++lane) {
            float *const push = pushes + 4 * lane, *const motion = motions + 4 * lane;
            const float* const node = row.node[lane] < 0
                                          ? nullptr
                                          : fields + static_cast<std::size_t>(row.node[lane]) * kHairFields;
            for (std::size_t part = 0; part < 4; part += kStep) {
                auto a = hn::Zero(Four()), b = a;
                for (std::size_t corner = 0; node && corner < kNodeCorners; ++corner) {
                    const float* const at = node + corners.offsets[corner] * kHairFields + part;
                    const auto weight = hn::Set(Four(), row.weights[corner][lane]);
                    a = hn::MulAdd(weight, hn::LoadU(Four(), at), a);
                    b = hn::MulAdd(weight, hn::LoadU(Four(), at + kFieldVelocity), b);
                }
                hn::StoreU(a, Four(), push + part);
                hn::StoreU(b, Four(), motion + part);
            }
        }
        for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth) {
            V3 push, around;
            V density, slows;
            hn::LoadInterleaved4(D(), pushes + 4 * lane, push.x, push.y, push.z, density);
            hn::LoadInterleaved4(D(), motions + 4 * lane, around.x, around.y, around.z, slows);
            const std::size_t i = first + lane;
            const V3 slip = velocityAt(block, frame, i) - around;
            const V slips = hn::Sqrt(dot(slip, slip)), sticks = all(frame.stickSpeed);
            // What is no number sticks.
            const V speed = hn::IfThenElse(slips > sticks, slips, sticks);
            const V rubs = hn::Min(density, all(1.0f)) * (all(frame.cohesion) + all(frame.friction) / speed);
            const V3 pull = mulAdd(around + all3(frame.reference), rubs, push);
            store3(pull, block.felt + i, block.pitch);
            hn::Store(rubs + slows, D(), block.felt + 3 * block.pitch + i);
        }
    }
}

void relaxHair(const HairRelaxation& r) {
    const V speed = all(r.speed);
    std::size_t i = r.first;
    const auto sumAround = [&](auto tag, std::size_t at) {
        const float* const now = r.now + at;
        return (hn::LoadU(tag, now - 1) + hn::LoadU(tag, now + 1)) +
               (hn::LoadU(tag, now - r.row) + hn::LoadU(tag, now + r.row)) +
               (hn::LoadU(tag, now - r.slice) + hn::LoadU(tag, now + r.slice));
    };
    for (; i + kWidth <= r.end; i += kWidth) {
        const V old = hn::LoadU(D(), r.next + i);
        const V wanted =
            hn::MulAdd(hn::LoadU(D(), r.gain + i), sumAround(D(), i), hn::LoadU(D(), r.bias + i));
        hn::StoreU(hn::MulAdd(speed, wanted - old, old), D(), r.next + i);
    }
    using One = hn::CappedTag<float, 1>;
    for (; i < r.end; ++i) {
        const auto old = hn::LoadU(One(), r.next + i);
        const auto wanted =
            hn::MulAdd(hn::LoadU(One(), r.gain + i), sumAround(One(), i), hn::LoadU(One(), r.bias + i));
        hn::StoreU(hn::MulAdd(hn::Set(One(), r.speed), wanted - old, old), One(), r.next + i);
    }
}

const HairKernels& hairKernelsOfTarget() {
    static const HairKernels kTable{locateHair, depositHair, pressHair, relaxHair};
    return kTable;
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hairloom::runtime {

HWY_EXPORT(hairKernelsOfTarget);

const HairKernels& hairKernels() {
    return HWY_DYNAMIC_DISPATCH(hairKernelsOfTarget)();
}

}  // namespace hairloom::runtime
#endif
