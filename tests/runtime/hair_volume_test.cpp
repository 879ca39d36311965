// SPDX-License-Identifier: GPL-3.0-or-later
#include "hairloom/alternatives/hair_volume.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <random>

#include "tests/runtime/allocations.h"
#include "tests/runtime/strand_fixture.h"
#include "tests/runtime/threads.h"

namespace hairloom::runtime {
namespace {

struct Points {
    std::vector<Float3> positions, velocities;
};

HairVolume makeVolume(const HairVolumeSettings& settings, Host host = {}) {
    HairVolume::Result made = HairVolume::make(settings, std::move(host));
    EXPECT_EQ(made.error, "");
    return std::move(*made.volume);
}

/// Points at random in a box of `size`, with velocities of up to `speed` along each axis.
Points cloud(std::size_t count, float size, float speed) {
    std::mt19937 random(7);
    const auto uniform = [&] { return static_cast<float>(random()) * 0x1p-31f - 1.0f; };
    Points points;
    for (std::size_t i = 0; i < count; ++i) {
        points.positions.push_back(Float3{uniform(), uniform(), uniform()} * (0.5f * size));
        points.velocities.push_back(Float3{uniform(), uniform(), uniform()} * speed);
    }
    return points;
}

std::array<double, 3> momentumOf(const std::vector<Float3>& velocities) {
    std::array<double, 3> sum{};
    for (const Float3& v : velocities) {
        sum[0] += static_cast<double>(v.x);
        sum[1] += static_cast<double>(v.y);
        sum[2] += static_cast<double>(v.z);
    }
    return sum;
}

HairVolumeSettings frictionOnly(float rate) {
    HairVolumeSettings s;
    s.repulsion = 0.0f;
    s.friction = rate;
    return s;
}

TEST(HairVolume, GridConservesMassAndMomentum) {
    Points points = cloud(5000, 0.3f, 3.0f);
    for (Float3& v : points.velocities) v = v + Float3{1.0f, -2.0f, 0.5f};
    const auto before = momentumOf(points.velocities);
    HairVolume volume = makeVolume(frictionOnly(40.0f));
    EXPECT_EQ(volume.apply(points.positions, points.velocities, 1.0f / 60.0f).leftOut, 0u);
    const HairVolume::Totals totals = volume.totals();
    EXPECT_EQ(totals.mass, 5000.0);
    const auto after = momentumOf(points.velocities);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        // The unit of velocity is below 2⁻²² m/s here, and each point is rounded to half of it.
        EXPECT_NEAR(totals.momentum[axis], before[axis], 5000 * 0x1p-23) << axis;
        EXPECT_NEAR(after[axis], before[axis], 5e-3) << "friction moves momentum, it makes none";
    }
}

TEST(HairVolume, SameBitsForAnyNumberOfThreadsAndOrder) {
    HairVolumeSettings s;
    s.targetDensity = 1e4f;
    std::vector<Points> results;
    for (const Host& host : {Host{}, hostWithThreads(1), hostWithThreads(6), hostWithThreads(3, true)}) {
        Points points = cloud(4000, 0.15f, 2.0f);
        HairVolume volume = makeVolume(s, host);
        for (int f = 0; f < 3; ++f) volume.apply(points.positions, points.velocities, 1.0f / 60.0f);
        results.push_back(points);
    }
    for (const Points& points : results) EXPECT_TRUE(points.velocities == results[0].velocities);
    EXPECT_FALSE(results[0].velocities == cloud(4000, 0.15f, 2.0f).velocities);
}

TEST(HairVolume, ConcurrentWritesToOneCellLoseNothing) {
    Points points = cloud(200000, 0.004f, 2.0f);
    for (Float3& p : points.positions) p = p + Float3{0.005f, 0.005f, 0.005f};
    HairVolume volume = makeVolume(frictionOnly(1.0f), hostWithThreads(4));
    volume.apply(points.positions, points.velocities, 0.01f);
    EXPECT_EQ(volume.totals().mass, 200000.0);
}

TEST(HairVolume, IndependentOfPointOrder) {
    const Points forward = cloud(1000, 0.1f, 2.0f);
    Points a = forward, b = forward;
    std::reverse(b.positions.begin(), b.positions.end());
    std::reverse(b.velocities.begin(), b.velocities.end());
    HairVolumeSettings s;
    s.targetDensity = 1e4f;
    HairVolume volume = makeVolume(s);
    volume.apply(a.positions, a.velocities, 0.01f);
    volume.apply(b.positions, b.velocities, 0.01f);
    std::reverse(b.velocities.begin(), b.velocities.end());
    EXPECT_TRUE(a.velocities == b.velocities);
}

TEST(HairVolume, VelocitiesWithinACellConvergeToTheirMean) {
    Points points = cloud(200, 0.004f, 3.0f);
    for (Float3& p : points.positions) p = p + Float3{0.005f, 0.005f, 0.005f};
    const auto mean = momentumOf(points.velocities);
    HairVolume volume = makeVolume(frictionOnly(100.0f));
    for (int f = 0; f < 400; ++f) volume.apply(points.positions, points.velocities, 0.1f);
    for (const Float3& v : points.velocities) {
        EXPECT_NEAR(static_cast<double>(v.x), mean[0] / 200, 2e-4);
        EXPECT_NEAR(static_cast<double>(v.y), mean[1] / 200, 2e-4);
        EXPECT_NEAR(static_cast<double>(v.z), mean[2] / 200, 2e-4);
    }
}

TEST(HairVolume, FrictionDecaysByItsRateForAnyFrameTime) {
    // All points at one position: the grid's velocity is their mean, 0, and each decays by exp(−rate · t).
    for (const float dt : {0.3f, 0.1f, 0.01f}) {
        Points points{{{0.013f, 0.02f, 0.031f}, {0.013f, 0.02f, 0.031f}}, {{1, 2, 0}, {-1, -2, 0}}};
        HairVolume volume = makeVolume(frictionOnly(4.0f));
        for (int f = 0; f < static_cast<int>(std::lround(0.3f / dt)); ++f)
            volume.apply(points.positions, points.velocities, dt);
        EXPECT_NEAR(points.velocities[0].x, std::exp(-1.2f), 1e-5f) << dt;
        EXPECT_NEAR(points.velocities[1].y, -2.0f * std::exp(-1.2f), 1e-5f) << dt;
    }
}

/// Points every quarter of a cell in a cube of `cells` cells.
Points block(int cells, float cell) {
    Points points;
    const int count = 4 * cells;
    for (int z = 0; z < count; ++z)
        for (int y = 0; y < count; ++y)
            for (int x = 0; x < count; ++x)
                points.positions.push_back(
                    Float3{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)} *
                    (0.25f * cell));
    points.velocities.assign(points.positions.size(), Float3{});
    return points;
}

TEST(HairVolume, UniformDensityPushesNothingInside) {
    const float cell = 0.0078125f;
    Points points = block(8, cell);
    HairVolumeSettings s;
    s.cellSize = cell;
    s.targetDensity = 10.0f / (cell * cell * cell);
    s.repulsion = 1.0f;
    HairVolume volume = makeVolume(s);
    volume.apply(points.positions, points.velocities, 1.0f / 60.0f);
    int inside = 0;
    Float3 outwards;
    for (std::size_t i = 0; i < points.positions.size(); ++i) {
        const Float3 p = points.positions[i] * (1.0f / cell);
        const float edge = std::min({p.x, p.y, p.z, 7.75f - p.x, 7.75f - p.y, 7.75f - p.z});
        if (edge >= 3.0f) {
            EXPECT_EQ(points.velocities[i], Float3{});
            ++inside;
        }
        if (p.x == 7.75f && p.y == 4.0f && p.z == 4.0f) outwards = points.velocities[i];
    }
    EXPECT_GT(inside, 100);
    EXPECT_GT(outwards.x, 0.01f) << "the surface swells";
    EXPECT_LT(std::abs(outwards.y), 1e-6f);
}

TEST(HairVolume, ALinearDensityPushesByItsSlope) {
    // As many points at each place as its layer's number: density 64 (4x/cell) / cell³, so with p = repulsion
    // · (density/target − 1) the acceleration is −256 repulsion / (target · cell⁴).
    const float cell = 0.0078125f;
    Points points;
    for (const Float3& p : block(8, cell).positions) {
        points.positions.insert(points.positions.end(), static_cast<std::size_t>(4.0f * p.x / cell), p);
    }
    points.velocities.assign(points.positions.size(), Float3{});
    HairVolumeSettings s;
    s.cellSize = cell;
    s.targetDensity = 10.0f / (cell * cell * cell);
    s.repulsion = 0.01f;
    s.friction = 0.0f;
    HairVolume volume = makeVolume(s);
    volume.apply(points.positions, points.velocities, 0.01f);
    const float expected = -256.0f / 10.0f * 0.01f / cell * 0.01f;
    int inside = 0;
    for (std::size_t i = 0; i < points.positions.size(); ++i) {
        const Float3 p = points.positions[i] * (1.0f / cell);
        if (std::min({p.x, p.y, p.z, 7.75f - p.x, 7.75f - p.y, 7.75f - p.z}) < 3.0f) continue;
        EXPECT_NEAR(points.velocities[i].x, expected, -1e-4f * expected);
        EXPECT_NEAR(points.velocities[i].y, 0.0f, -1e-4f * expected);
        ++inside;
    }
    EXPECT_GT(inside, 100);
}

TEST(HairVolume, BelowTheTargetDensityNothingPushes) {
    Points points = cloud(500, 0.1f, 0.0f);
    HairVolumeSettings s;
    s.targetDensity = 1e9f;
    HairVolume volume = makeVolume(s);
    volume.apply(points.positions, points.velocities, 1.0f / 60.0f);
    for (const Float3& v : points.velocities) EXPECT_EQ(v, Float3{});
}

TEST(HairVolume, TwoCrossingBundlesRepel) {
    // One bundle along x, one along z, 6 mm above it: a little less than a cell.
    Points points;
    for (int i = 0; i < 200; ++i) {
        const float along = 0.0005f * static_cast<float>(i) - 0.05f;
        for (int k = 0; k < 8; ++k) {
            const float across = 0.0005f * static_cast<float>(k);
            points.positions.push_back({along, 0.052f, across});
            points.positions.push_back({across, 0.058f, along});
        }
    }
    points.velocities.assign(points.positions.size(), Float3{});
    HairVolumeSettings s;
    s.targetDensity = 1e5f;
    HairVolume volume = makeVolume(s);
    volume.apply(points.positions, points.velocities, 1.0f / 60.0f);
    double lower = 0.0, upper = 0.0;
    for (std::size_t i = 0; i < points.positions.size(); ++i) {
        const Float3 p = points.positions[i];
        if (std::abs(p.x) > 0.01f || std::abs(p.z) > 0.01f) continue;
        (p.y < 0.055f ? lower : upper) += static_cast<double>(points.velocities[i].y);
    }
    EXPECT_LT(lower, -0.01);
    EXPECT_GT(upper, 0.01);
}

TEST(HairVolume, APushMovesNoPointFartherThanHalfACell) {
    Points points = cloud(3000, 0.03f, 0.0f);
    HairVolumeSettings s;
    s.targetDensity = 1.0f;
    s.repulsion = 1000.0f;
    s.friction = 0.0f;
    HairVolume volume = makeVolume(s);
    volume.apply(points.positions, points.velocities, 1.0f);
    float farthest = 0.0f;
    for (const Float3& v : points.velocities) farthest = std::max(farthest, length(v));
    EXPECT_GT(farthest, 0.0049f);
    EXPECT_LE(farthest, 0.005001f);
}

TEST(HairVolume, MemoryIsBoundedAndCellsDoubleUntilTheyFit) {
    HairVolumeSettings s = frictionOnly(1.0f);
    s.maxNodes = 1000;
    HairVolume volume = makeVolume(s);
    const std::size_t bytes = volume.bytes();
    EXPECT_LT(bytes, 100000u);
    for (const float size : {0.01f, 0.1f, 3.0f, 1000.0f, 1.9e6f}) {
        Points points = cloud(300, size, 1.0f);
        const HairVolume::Report report = volume.apply(points.positions, points.velocities, 0.01f);
        EXPECT_LE(report.nodes, 1000u) << size;
        EXPECT_GT(report.nodes, 0u) << size;
        EXPECT_EQ(volume.totals().mass, 300.0) << size;
        const float doublings = std::log2(report.cellSize / s.cellSize);
        EXPECT_EQ(doublings, std::round(doublings)) << size;
    }
    EXPECT_EQ(volume.bytes(), bytes);
}

TEST(HairVolume, NothingIsAllocatedByApply) {
    Points points = cloud(2000, 0.2f, 1.0f);
    HairVolume volume = makeVolume({});
    const std::size_t before = allocationCount();
    for (int f = 0; f < 5; ++f) volume.apply(points.positions, points.velocities, 0.01f);
    EXPECT_EQ(allocationCount(), before);
}

TEST(HairVolume, NonFiniteInputIsRejectedAndSpeedSaturates) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), huge = 3e38f;
    Points points = cloud(100, 0.05f, 1.0f);
    points.positions[3].x = nan;
    points.positions[4].y = huge;
    points.velocities[5].z = std::numeric_limits<float>::infinity();
    points.velocities[6] = {huge, 0.0f, 0.0f};
    HairVolumeSettings s;
    s.targetDensity = 1e3f;
    HairVolume volume = makeVolume(s);
    const HairVolume::Report report = volume.apply(points.positions, points.velocities, 1.0f / 60.0f);
    EXPECT_EQ(report.leftOut, 3u);
    EXPECT_EQ(volume.totals().mass, 97.0);
    EXPECT_NEAR(volume.totals().momentum[0], 1000.0, 40.0);
    for (std::size_t i = 0; i < 100; ++i) {
        EXPECT_EQ(isFinite(points.velocities[i]), i != 5) << i;
    }
    const std::vector<Float3> before = points.velocities;
    for (const float dt : {0.0f, -1.0f, nan, std::numeric_limits<float>::infinity()}) {
        EXPECT_EQ(volume.apply(points.positions, points.velocities, dt).nodes, 0u);
        EXPECT_EQ(std::memcmp(before.data(), points.velocities.data(), before.size() * sizeof(Float3)), 0);
    }
    EXPECT_EQ(volume.apply({}, {}, 0.1f).nodes, 0u);
}

TEST(HairVolume, RefusesSettingsOutOfRange) {
    HairVolumeSettings s;
    s.friction = std::numeric_limits<float>::quiet_NaN();
    s.maxNodes = 8;
    EXPECT_EQ(HairVolume::make(s).error,
              "maxNodes is 8; expected 125 to 1e+07\nfriction is nan; expected 0 to 1000");
}

}  // namespace
}  // namespace hairloom::runtime
