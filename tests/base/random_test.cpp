// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/base/random.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace hairloom {
namespace {

TEST(Random, SequenceDependsOnSeedAndStreamOnly) {
    Random a(7, 3), b(7, 3), otherSeed(8, 3), otherStream(7, 4);
    int equalSeed = 0, equalStream = 0;
    for (int i = 0; i < 1000; ++i) {
        const std::uint32_t value = a.next();
        EXPECT_EQ(value, b.next());
        equalSeed += value == otherSeed.next();
        equalStream += value == otherStream.next();
    }
    EXPECT_LE(equalSeed, 1);
    EXPECT_LE(equalStream, 1);
}

TEST(Random, UniformFillsTheIntervalEvenly) {
    Random random(1);
    constexpr int kBins = 64, kDraws = 640'000;
    std::array<int, kBins> counts{};
    for (int i = 0; i < kDraws; ++i) {
        const float u = random.uniform();
        ASSERT_GE(u, 0.0f);
        ASSERT_LT(u, 1.0f);
        ++counts[static_cast<std::size_t>(u * kBins)];
    }
    double chiSquare = 0;
    for (const int count : counts) chiSquare += std::pow(count - kDraws / kBins, 2) / (kDraws / kBins);
    // 63 degrees of freedom: 103.4 is exceeded once in a thousand fair draws.
    EXPECT_LT(chiSquare, 103.4);
}

TEST(Random, BelowIsUnbiasedWhereTheRangeDoesNotDivideTheWord) {
    Random random(5);
    constexpr std::uint32_t kRange = 3u << 30u;  // modulo would hit the first third twice as often
    int first = 0;
    constexpr int kDraws = 90'000;
    for (int i = 0; i < kDraws; ++i) first += random.below(kRange) < (1u << 30u);
    EXPECT_NEAR(first, kDraws / 3, 4 * std::sqrt(kDraws * 2.0 / 9.0));
}

}  // namespace
}  // namespace hairloom
