// SPDX-License-Identifier: GPL-3.0-or-later
// Clumps within clumps, and clumps that wander.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/operations/clump.h"
#include "core/operations/clump_centres.h"
#include "core/operations/drape.h"
#include "core/operations/noise.h"
#include "tests/groom/groom_samples.h"

namespace hairloom {
namespace {

constexpr std::size_t kStrands = 300;

/// Hair that falls around a head, with bends.
Groom wavyHair() {
    Groom groom = straightHair(sphereScalp(0.09f, 4, Vec3f(0, 1.6f, 0)), kStrands, 24, 0.2f);
    DrapeSettings fall;
    fall.amount = 0.9f;
    EXPECT_TRUE(drape(groom, fall));
    NoiseSettings waves;
    waves.amplitude = 0.004f;
    EXPECT_TRUE(noise(groom, waves));
    return groom;
}

/// Mean distance of tips from those of their leaders, metres.
double apart(const Groom& groom, std::span<const std::uint32_t> leaders) {
    double sum = 0;
    for (std::size_t s = 0; s < groom.strandCount(); ++s)
        sum += static_cast<double>((groom.strand(s).back() - groom.strand(leaders[s]).back()).norm());
    return sum / static_cast<double>(groom.strandCount());
}

TEST(Clump, SmallClumpsGatherWholeInLargeOnes) {
    const Groom before = wavyHair();
    ClumpSettings settings;
    settings.spacing = 0.06f;
    settings.spacing2 = 0.02f;
    settings.strength = 0.5f;
    settings.strength2 = 1;
    settings.variation = 0;
    settings.levels = 2;
    Groom large = before, both = before, loose = before;
    settings.levels = 1;
    ASSERT_TRUE(clump(large, settings));
    settings.levels = 2;
    ASSERT_TRUE(clump(both, settings));
    settings.strength2 = 0;
    ASSERT_TRUE(clump(loose, settings));
    // With a strength of 0 for the large clumps only the small ones are gathered; who leads them is seen
    // there.
    Groom small = before;
    ClumpSettings alone = settings;
    alone.strength = 0;
    alone.strength2 = 1;
    ASSERT_TRUE(clump(small, alone));
    std::vector<std::uint32_t> leaders(kStrands);
    for (std::uint32_t s = 0; s < kStrands; ++s) {
        float nearest = 1;
        for (std::uint32_t other = 0; other < kStrands; ++other) {
            const auto a = small.strand(other), b = before.strand(other);
            if (!std::equal(a.begin(), a.end(), b.begin())) continue;  // only leaders stay
            const float distance = (before.strand(s)[0] - b[0]).norm();
            if (distance < nearest) nearest = distance, leaders[s] = other;
        }
    }
    EXPECT_LT(apart(small, leaders), 0.6 * apart(before, leaders));
    EXPECT_LT(apart(both, leaders), 0.7 * apart(large, leaders)) << "small clumps are tight";
    EXPECT_GT(apart(loose, leaders), 1.5 * apart(both, leaders));
    const auto largest = chooseCentres(before, settings.spacing, settings.seed);
    EXPECT_LT(apart(both, largest), 0.9 * apart(small, largest)) << "and nearer to each other";
}

TEST(Clump, NoiseMovesClumpsAsAWhole) {
    const Groom before = wavyHair();
    ClumpSettings settings;
    settings.spacing = 0.03f;
    settings.strength = 1;
    settings.variation = 0;
    Groom still = before, noisy = before;
    ASSERT_TRUE(clump(still, settings));
    settings.noise = 0.01f;
    ASSERT_TRUE(clump(noisy, settings));
    const auto leaders = chooseCentres(before, settings.spacing, settings.seed);
    double moved = 0;
    for (std::size_t s = 0; s < kStrands; ++s)
        moved += static_cast<double>((noisy.strand(s).back() - still.strand(s).back()).norm()) / kStrands;
    EXPECT_GT(moved, 0.003);
    EXPECT_LT(apart(noisy, leaders), apart(still, leaders) + 0.35 * moved);
}

/// Where hair is gathered on three levels it does not turn round.
TEST(Clump, NoLevelFoldsAStrand) {
    const Groom before = wavyHair();
    for (const float strength : {0.3f, 0.7f, 1.0f}) {
        ClumpSettings settings;
        settings.levels = 3;
        settings.spacing = 0.05f;
        settings.spacing2 = 0.02f;
        settings.spacing3 = 0.008f;
        settings.strength = settings.strength2 = settings.strength3 = strength;
        Groom after = before;
        ASSERT_TRUE(clump(after, settings));
        for (std::size_t s = 0; s < kStrands; ++s)
            EXPECT_LT(largestTurn(after.strand(s)), largestTurn(before.strand(s)) + 30) << s;
    }
}

}  // namespace
}  // namespace hairloom
