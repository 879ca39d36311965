// SPDX-License-Identifier: GPL-3.0-or-later
// How strands are dealt to blocks and vectors.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "runtime/engine/kernels.h"
#include "runtime/engine/state.h"

namespace hairloom::runtime {
namespace {

constexpr std::uint32_t kSide = 16, kVector = 8;

/// Upright strands of `points` points, one on each whole place of a square lawn, in an order that jumps.
struct ShuffledLawn {
    std::vector<std::uint32_t> offsets{0};
    std::vector<Float3> positions;

    explicit ShuffledLawn(std::uint32_t points) {
        for (std::uint32_t s = 0; s < kSide * kSide; ++s) {
            const std::uint32_t place = s * 89 % (kSide * kSide);
            for (std::uint32_t p = 0; p < points; ++p) {
                positions.push_back({static_cast<float>(place % kSide), static_cast<float>(p),
                                     static_cast<float>(place / kSide)});
            }
            offsets.push_back(static_cast<std::uint32_t>(positions.size()));
        }
    }
    StrandsView view() const { return {offsets, positions}; }
    Float3 root(std::uint32_t strand) const { return positions[offsets[strand]]; }
};

/// How far some lanes of a block lie apart along x and along z, in ascending order.
std::array<float, 2> extent(const ShuffledLawn& lawn, const Block& block, std::uint32_t first,
                            std::uint32_t count) {
    Float3 low = lawn.root(block.strandOfLane[first]), high = low;
    for (std::uint32_t lane = first; lane < first + count; ++lane) {
        const Float3 p = lawn.root(block.strandOfLane[lane]);
        low = {std::min(low.x, p.x), 0.0f, std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), 0.0f, std::max(high.z, p.z)};
    }
    std::array<float, 2> sides{high.x - low.x, high.z - low.z};
    std::sort(sides.begin(), sides.end());
    return sides;
}

TEST(Grouping, EveryStrandHasOneLane) {
    const ShuffledLawn lawn(4);
    const auto shape = makeRestShape(lawn.view());
    std::vector<int> lanes(kSide * kSide, 0);
    for (const Block& block : shape->blocks) {
        for (std::uint32_t lane = 0; lane < block.strands; ++lane) ++lanes[block.strandOfLane[lane]];
    }
    EXPECT_EQ(lanes, std::vector<int>(kSide * kSide, 1));
}

TEST(Grouping, LanesOfAVectorAreNeighbours) {
    const ShuffledLawn lawn(4);
    const auto shape = makeRestShape(lawn.view());
    ASSERT_EQ(shape->blocks.size(), kSide * kSide / kBlockLanes);
    for (const Block& block : shape->blocks) {
        // 4 by 8 places, of which a vector has 2 by 4.
        EXPECT_EQ(extent(lawn, block, 0, kBlockLanes), (std::array{3.0f, 7.0f}));
        for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kVector)
            EXPECT_EQ(extent(lawn, block, lane, kVector), (std::array{1.0f, 3.0f})) << lane;
    }
}

TEST(Grouping, OnlyTheLastBlockIsNotFull) {
    const ShuffledLawn lawn(4);
    // 256 strands less those of a block and a half.
    const std::uint32_t count = kSide * kSide - 48;
    const auto shape = makeRestShape(
        {std::span(lawn.offsets).first(count + 1), std::span(lawn.positions).first(lawn.offsets[count])});
    ASSERT_EQ(shape->blocks.size(), 7u);
    for (std::size_t b = 0; b + 1 < shape->blocks.size(); ++b)
        EXPECT_EQ(shape->blocks[b].strands, kBlockLanes);
    EXPECT_EQ(shape->blocks.back().strands, 16u);
}

}  // namespace
}  // namespace hairloom::runtime
