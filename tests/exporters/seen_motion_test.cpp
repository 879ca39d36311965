// SPDX-License-Identifier: GPL-3.0-or-later
// What is seen of motions whose difference is known.
#include "exporters/seen_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace hairloom {
namespace {

constexpr int kFrames = 160;

/// Straight strands on the upper half of a ball of 10 cm, 8 points of 20 cm each.
struct Brush {
    std::vector<std::uint32_t> offsets{0}, layers;
    std::vector<Vec3f> rest;
    Brush() {
        for (int s = 0; s < 400; ++s) {
            const float up = 0.05f + 0.9f * static_cast<float>(s % 20) / 20;
            const float turn = 2 * std::numbers::pi_v<float> * static_cast<float>(s / 20) / 20;
            const float out = std::sqrt(1 - up * up);
            const Vec3f way(out * std::cos(turn), up, out * std::sin(turn));
            for (int p = 0; p < 8; ++p) rest.emplace_back(way * (0.1f + 0.2f * static_cast<float>(p) / 7));
            offsets.push_back(static_cast<std::uint32_t>(rest.size()));
            layers.push_back(s % 2);
        }
    }
    /// Each point moved by `away`, of the strand, the share of its length, and seconds.
    SeenMotion moved(const std::function<Vec3f(int, float, double)>& away) const {
        SeenMotion seen(offsets, rest, layers);
        for (int f = 0; f < kFrames; ++f) {
            std::vector<Vec3f> points = rest;
            for (std::size_t p = 0; p < points.size(); ++p)
                points[p] += away(static_cast<int>(p / 8), static_cast<float>(p % 8) / 7, f / 60.0);
            seen.add(points);
        }
        return seen;
    }
};

Vec3f swinging(float metres, double hertz, double late, float share, double t) {
    return {share * metres * static_cast<float>(std::sin(2 * std::numbers::pi * hertz * (t - late))), 0, 0};
}

TEST(SeenMotion, IsTheSameOfTheSame) {
    const Brush brush;
    const auto still = [](int, float, double) { return Vec3f(0, 0, 0); };
    const SeenMotion::Difference none = SeenMotion::between(brush.moved(still), brush.moved(still));
    EXPECT_EQ(none.largest(), 0);
    EXPECT_EQ(none.decibels, 0);
    EXPECT_EQ(SeenMotion::between(SeenMotion(brush.offsets, brush.rest, brush.layers),
                                  SeenMotion(brush.offsets, brush.rest, brush.layers))
                  .largest(),
              0)
        << "without a frame";
}

TEST(SeenMotion, DoesNotTellWhichStrandSwingsEarlier) {
    const Brush brush;
    // Each strand at its own time, and at another one.
    const auto at = [&](double later) {
        return brush.moved(
            [&](int s, float share, double t) { return swinging(0.02f, 1.5, s * 0.017 * later, share, t); });
    };
    const SeenMotion::Difference seen = SeenMotion::between(at(1), at(2.6));
    // Paths are centimetres apart.
    EXPECT_LT(seen.shape, 0.001f);
    EXPECT_LT(seen.motion, 0.0005f);
    EXPECT_LT(seen.decibels, 1);
    EXPECT_LT(seen.outline, 0.006f);
}

TEST(SeenMotion, TellsHowStronglyHairMovesAndHowFast) {
    const Brush brush;
    const auto with = [&](float metres, double hertz) {
        return brush.moved(
            [&](int s, float share, double t) { return swinging(metres, hertz, s * 0.017, share, t); });
    };
    const SeenMotion usual = with(0.02f, 2.25);
    EXPECT_NEAR(SeenMotion::between(usual, with(0.018f, 2.25)).decibels, 20 * std::log10(20 / 18.0), 0.05);
    // Root mean square of a sine over points whose shares are 1/7 … 7/7 is 0.707 · 0.639 of its height.
    const float height = 0.707f * 0.639f;
    EXPECT_NEAR(SeenMotion::between(usual, with(0.018f, 2.25)).motion, 0.002f * height, 0.0001f);
    const SeenMotion::Difference halved = SeenMotion::between(usual, with(0.01f, 2.25));
    EXPECT_NEAR(halved.decibels, 6.02, 0.05);
    EXPECT_NEAR(halved.motion, 4 * 0.02f * height, 0.002f) << "counts as wholly another motion";
    const SeenMotion::Difference faster = SeenMotion::between(usual, with(0.02f, 9));
    EXPECT_GT(faster.decibels, 20);
    EXPECT_GT(faster.motion, 0.03f);
    EXPECT_GT(
        SeenMotion::between(usual, brush.moved([](int, float, double) { return Vec3f(0, 0, 0); })).motion,
        0.03f);
}

TEST(SeenMotion, TellsWhereHairHangsOnTheMean) {
    const Brush brush;
    const auto still = [](int, float, double) { return Vec3f(0, 0, 0); };
    const SeenMotion rest = brush.moved(still);
    const auto lowered = [](int, float, double) { return Vec3f(0, -0.004f, 0); };
    EXPECT_NEAR(SeenMotion::between(rest, brush.moved(lowered)).shape, 0.004f, 1e-5f);
    // One side forwards, the other backwards: their mean is where it was.
    const auto parted = [&](int s, float, double) {
        return Vec3f(0, 0, brush.rest[8 * static_cast<std::size_t>(s)].x() > 0 ? 0.004f : -0.004f);
    };
    EXPECT_GT(SeenMotion::between(rest, brush.moved(parted)).shape, 0.0025f);
    // A layer up, the other down.
    const auto layered = [](int s, float, double) { return Vec3f(0, s % 2 == 0 ? 0.004f : -0.004f, 0); };
    EXPECT_NEAR(SeenMotion::between(rest, brush.moved(layered)).shape, 0.004f, 1e-5f);
}

TEST(SeenMotion, TellsOutlinesButNotSingleStrands) {
    const Brush brush;
    const auto still = [](int, float, double) { return Vec3f(0, 0, 0); };
    const SeenMotion rest = brush.moved(still);
    const auto longer = [&](int s, float share, double) {
        return Vec3f(brush.rest[8 * static_cast<std::size_t>(s)] * 0.1f * share);
    };
    const SeenMotion::Difference grown = SeenMotion::between(rest, brush.moved(longer));
    EXPECT_NEAR(grown.outline, 0.01f, 0.003f) << "a centimetre at the tips, which are the outline";
    const auto oneSticksOut = [&](int s, float share, double) {
        return s == 100 ? Vec3f(brush.rest[800] * 3 * share) : Vec3f(0, 0, 0);
    };
    EXPECT_LT(SeenMotion::between(rest, brush.moved(oneSticksOut)).outline, 0.002f);
}

TEST(SeenMotion, TakesFewStrandsOfFewPoints) {
    const std::vector<std::uint32_t> offsets{0, 2, 4}, layers{0, 3};
    const std::vector<Vec3f> rest{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}};
    SeenMotion a(offsets, rest, layers), b(offsets, rest, layers);
    std::vector<Vec3f> moved = rest;
    moved[1].z() = 0.1f;
    a.add(rest), b.add(moved);
    const SeenMotion::Difference seen = SeenMotion::between(a, b);
    EXPECT_TRUE(std::isfinite(seen.largest()));
    EXPECT_GT(seen.shape, 0.02f);
}

}  // namespace
}  // namespace hairloom
