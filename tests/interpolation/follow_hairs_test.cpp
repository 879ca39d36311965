// SPDX-License-Identifier: GPL-3.0-or-later
// Follow hairs (thesis §4.2, Eq. 22–23) against independent computations and the promises of the interface.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/accuracy/guide_grid.h"
#include "core/base/hash.h"
#include "core/base/parallel.h"
#include "core/geometry/curve.h"
#include "core/groom/point_width.h"
#include "core/interpolation/follow_hairs.h"

namespace hairloom {
namespace {

constexpr std::uint32_t kSide = 4;  ///< guides along one side of the plate
constexpr float kSpacing = 0.01f;

std::shared_ptr<const ScalpMesh> plate() {
    PolygonSoup soup;
    soup.positions = {{-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}};
    soup.corners = {0, 1, 2, 3};
    soup.offsets = {0, 4};
    return std::make_shared<const ScalpMesh>(ScalpMesh::make(soup).value());
}

/// A square of kSide² guides on a plate at y = 0, each a strand of `points` points bent over by `lean` metres
/// of x at the tip, 0.1 m high, with two triangles for each square of roots.
template <class Lean>
Groom field(std::uint32_t points, Lean lean, bool withScalp = true) {
    Groom groom = scenes::guidesOnGrid({kSide, kSide, points, kSpacing, 0.1f}, lean);
    if (!withScalp) return groom;
    const RootTriangulation triangulation = groom.triangulation;
    bindToScalp(groom, plate(), {});  // which forgets the triangulation
    groom.triangulation = triangulation;
    return groom;
}

float straight(std::uint32_t) {
    return 0.0f;
}
float bent(std::uint32_t s) {
    return 0.02f + 0.001f * static_cast<float>(s);
}

InterpolationSettings settingsWith(float blend, std::uint32_t followPerGuide = 50) {
    InterpolationSettings settings;
    settings.followPerGuide = followPerGuide;
    settings.blend = blend;
    settings.seed = 42;
    return settings;
}

std::vector<Vec3f> evaluate(const FollowBindings& bindings, const GuideState& state) {
    std::vector<Vec3f> positions(bindings.hairCount() * bindings.pointsPerHair);
    EXPECT_TRUE(evaluateFollowHairs(bindings, state, positions));
    return positions;
}

std::vector<Vec3f> evaluateAtRest(const Groom& groom, const FollowBindings& bindings) {
    const auto guides = guidePositions(groom, bindings);
    return evaluate(bindings, {guides, {}, {}});
}

std::span<const Vec3f> hair(const FollowBindings& bindings, std::span<const Vec3f> positions,
                            std::size_t index) {
    return positions.subspan(index * bindings.pointsPerHair, bindings.pointsPerHair);
}

float distanceToPolyline(const Vec3f& p, std::span<const Vec3f> line) {
    float best = (p - line[0]).norm();
    for (std::size_t i = 1; i < line.size(); ++i) {
        const Vec3f d = line[i] - line[i - 1];
        const float t = std::clamp((p - line[i - 1]).dot(d) / d.squaredNorm(), 0.0f, 1.0f);
        best = std::min(best, (line[i - 1] + t * d - p).norm());
    }
    return best;
}

TEST(FollowBindings, SharesAreAPartitionOfUnity) {
    const Groom groom = field(8, bent);
    const auto bindings = bindFollowHairs(groom, settingsWith(0.5f));
    ASSERT_TRUE(bindings) << bindings.error().message();
    ASSERT_EQ(bindings->hairCount(), 16u * 50u);
    EXPECT_EQ(bindings->pointsPerHair, 8u);
    for (std::size_t h = 0; h < bindings->hairCount(); ++h) {
        EXPECT_NEAR(bindings->weights[h].sum(), 1.0f, 1e-6f);
        EXPECT_NEAR(bindings->rootWeights[h].sum(), 1.0f, 1e-6f);
        EXPECT_GE(bindings->weights[h].minCoeff(), 0.0f);
        EXPECT_EQ(bindings->guides[h][0], h / 50);
        EXPECT_GE(bindings->rootWeights[h][0], bindings->rootWeights[h].tail<2>().maxCoeff());
        EXPECT_LE(bindings->wispOffsets[h].norm(), 1.0f);
    }
}

TEST(FollowBindings, RootsCoverTheTrianglesEvenly) {
    const Groom groom = field(4, straight);
    const auto bindings = bindFollowHairs(groom, settingsWith(1.0f, 2000));
    ASSERT_TRUE(bindings);
    // An inner guide owns a third of each of its six triangles: mean offset 0 by symmetry.
    const auto positions = evaluateAtRest(groom, *bindings);
    Vec3f mean = Vec3f::Zero();
    const std::uint32_t guide = kSide + 1;
    for (std::size_t h = guide * 2000; h < (guide + 1) * 2000; ++h) {
        mean += (hair(*bindings, positions, h)[0] - groom.strand(guide)[0]) / 2000.0f;
    }
    EXPECT_LT(mean.norm(), 0.0004f);
}

TEST(FollowHairs, FullWeightGivesTheGuideItself) {
    const Groom groom = field(9, bent);
    auto bindings = bindFollowHairs(groom, settingsWith(1.0f, 3));
    ASSERT_TRUE(bindings);
    for (std::size_t h = 0; h < bindings->hairCount(); ++h) {
        bindings->weights[h] = bindings->rootWeights[h] = Vec3f::UnitX();
        bindings->rootShifts[h].setZero();
    }
    const auto positions = evaluateAtRest(groom, *bindings);
    for (std::size_t h = 0; h < bindings->hairCount(); ++h) {
        for (std::size_t i = 0; i < 9; ++i) {
            EXPECT_EQ(hair(*bindings, positions, h)[i], groom.strand(h / 3)[i]) << h << " " << i;
        }
    }
}

TEST(FollowHairs, ThreeStrandsAreBarycentric) {
    const Groom groom = field(6, bent);
    const auto bindings = bindFollowHairs(groom, settingsWith(1.0f));
    ASSERT_TRUE(bindings);
    const auto positions = evaluateAtRest(groom, *bindings);
    for (std::size_t h = 0; h < bindings->hairCount(); ++h) {
        for (std::size_t i = 0; i < 6; ++i) {
            Vec3d expected = Vec3d::Zero();
            for (int k = 0; k < 3; ++k) {
                const auto strand = groom.strand(bindings->guides[h][static_cast<std::size_t>(k)]);
                expected += double{bindings->rootWeights[h][k]} * strand[i].cast<double>();
            }
            EXPECT_LT((hair(*bindings, positions, h)[i].cast<double>() - expected).norm(), 2e-7);
        }
    }
}

TEST(FollowHairs, WispsStayWithinTheirRadiusAndKeepTheirLength) {
    const Groom groom = field(16, bent);
    auto settings = settingsWith(0.0f, 200);
    settings.wispRadiusRoot = 0.001f;
    settings.wispRadiusTip = 0.003f;
    const auto bindings = bindFollowHairs(groom, settings);
    ASSERT_TRUE(bindings);
    const auto positions = evaluateAtRest(groom, *bindings);
    float widest = 0;
    for (std::size_t h = 0; h < bindings->hairCount(); ++h) {
        const auto guide = groom.strand(bindings->guides[h][0]);
        const auto follow = hair(*bindings, positions, h);
        for (std::size_t i = 0; i < follow.size(); ++i) {
            const float radius = 0.001f + 0.002f * static_cast<float>(i) / 15.0f;
            EXPECT_LE((follow[i] - guide[i]).norm(), radius * 1.0001f);
            EXPECT_LE(distanceToPolyline(follow[i], guide), radius * 1.0001f);
        }
        widest = std::max(widest, (follow.back() - guide.back()).norm());
        EXPECT_NEAR(polylineLength(follow) / polylineLength(guide), 1.0f, 0.06f);
    }
    EXPECT_GT(widest, 0.0029f);
}

TEST(FollowHairs, RootsLieOnTheScalp) {
    const Groom groom = field(5, bent);
    for (const float blend : {0.0f, 0.4f, 1.0f}) {
        const auto bindings = bindFollowHairs(groom, settingsWith(blend));
        ASSERT_TRUE(bindings);
        ASSERT_EQ(bindings->roots.size(), bindings->hairCount());
        const auto positions = evaluateAtRest(groom, *bindings);
        for (std::size_t h = 0; h < bindings->hairCount(); ++h) {
            const Vec3f root = hair(*bindings, positions, h)[0];
            EXPECT_NEAR(root.y(), 0.0f, 1e-6f);
            const SurfacePoint& surface = bindings->roots[h];
            EXPECT_LT((groom.scalp->pointAt(surface.triangle, surface.barycentric) - root).norm(), 1e-5f);
        }
    }
}

TEST(FollowHairs, BlendLiesBetweenItsEnds) {
    const Groom groom = field(7, bent, false);
    const auto at = [&](float blend) {
        const auto bindings = bindFollowHairs(groom, settingsWith(blend));
        return evaluateAtRest(groom, *bindings);
    };
    const auto wisp = at(0);
    const auto triangle = at(1);
    const auto mixed = at(0.25f);
    ASSERT_FALSE(mixed.empty());
    float apart = 0;
    for (std::size_t i = 0; i < mixed.size(); ++i) {
        apart = std::max(apart, (wisp[i] - triangle[i]).norm());
        EXPECT_LT((0.75f * wisp[i] + 0.25f * triangle[i] - mixed[i]).norm(), 1e-6f);
    }
    EXPECT_GT(apart, 1e-3f) << "the ends differ";
}

TEST(FollowHairs, APartingStaysOpen) {
    // Left columns lean left, right ones right; between columns 1 and 2 the directions differ by about 127°.
    const Groom groom = field(8, [](std::uint32_t s) { return s % kSide < 2 ? -0.2f : 0.2f; });
    const auto bindings = bindFollowHairs(groom, settingsWith(1.0f, 200));
    ASSERT_TRUE(bindings);
    const auto positions = evaluateAtRest(groom, *bindings);
    const float middle = 1.5f * kSpacing;
    std::size_t acrossTriangles = 0;
    for (std::size_t h = 0; h < bindings->hairCount(); ++h) {
        const auto follow = hair(*bindings, positions, h);
        const bool left = bindings->guides[h][0] % kSide < 2;
        EXPECT_EQ(follow.back().x() < middle, left) << "hair " << h << " hangs into the parting";
        EXPECT_NEAR(std::abs(follow.back().x() - follow[0].x()), 0.2f, 1e-4f);
        const auto& guides = bindings->guides[h];
        acrossTriangles += std::any_of(guides.begin(), guides.end(),
                                       [&](std::uint32_t g) { return (g % kSide < 2) != left; });
    }
    EXPECT_GT(acrossTriangles, 100u);
}

TEST(FollowHairs, APartingWhoseSidesHangTogetherBelowStaysOpen) {
    // Strands leave a parting between columns 1 and 2 along the skin and then hang down side by side, as long
    // hair does: the chords from root to tip are 25° apart, and the tips by 0.4 of the length.
    Groom groom = field(16, straight);
    std::vector<Vec3f> parted(groom.positions().begin(), groom.positions().end());
    for (std::uint32_t s = 0; s < groom.strandCount(); ++s) {
        const float side = s % kSide < 2 ? -1.0f : 1.0f;
        for (std::uint32_t p = 0; p < 16; ++p) {
            const float along = 0.3f * static_cast<float>(p) / 15;
            const float out = std::min(along, 0.06f);
            parted[16 * s + p] = parted[16 * s] + Vec3f{side * out, 0, along - out};
        }
    }
    groom.pointAttributes.set(attribute::kPosition, parted);
    const auto bindings = bindFollowHairs(groom, settingsWith(1.0f, 200));
    ASSERT_TRUE(bindings);
    const auto positions = evaluateAtRest(groom, *bindings);
    for (std::size_t h = 0; h < bindings->hairCount(); ++h) {
        const bool left = bindings->guides[h][0] % kSide < 2;
        const auto follow = hair(*bindings, positions, h);
        ASSERT_NEAR(follow.back().x() - follow[0].x(), left ? -0.06f : 0.06f, 1e-4f)
            << "hair " << h << " stands in the parting";
    }
}

TEST(FollowHairs, NoHairTakesTheShapeOfAnotherLayer) {
    Groom groom = field(8, [](std::uint32_t s) { return s % kSide < 2 ? 0.0f : 0.03f; });
    groom.layers.resize(2);
    std::vector<std::uint32_t> layers;
    for (std::uint32_t s = 0; s < groom.strandCount(); ++s) layers.push_back(s % kSide < 2 ? 0 : 1);
    const auto mixed = bindFollowHairs(groom, settingsWith(1.0f, 200));
    groom.strandAttributes.set(attribute::kLayer, layers);
    const auto apart = bindFollowHairs(groom, settingsWith(1.0f, 200));
    ASSERT_TRUE(mixed && apart);
    const auto between = [&](const FollowBindings& bindings) {
        const auto positions = evaluateAtRest(groom, bindings);
        std::size_t count = 0;
        for (std::size_t h = 0; h < bindings.hairCount(); ++h) {
            const auto follow = hair(bindings, positions, h);
            const float lean = follow.back().x() - follow[0].x();
            count += lean > 0.001f && lean < 0.029f;
        }
        return count;
    };
    EXPECT_GT(between(*mixed), 100u);
    EXPECT_EQ(between(*apart), 0u);
    EXPECT_EQ(apart->rootWeights, mixed->rootWeights) << "roots lie as before";
}

TEST(FollowHairs, ParallelGuidesShareFully) {
    const Groom groom = field(8, straight);
    const auto bindings = bindFollowHairs(groom, settingsWith(1.0f));
    ASSERT_TRUE(bindings);
    for (std::size_t h = 0; h < bindings->hairCount(); ++h)
        EXPECT_EQ(bindings->weights[h], bindings->rootWeights[h]);
}

TEST(FollowHairs, GuidesOfUnequalCountsAreResampled) {
    Groom groom = makeGroom({0, 3, 8}, {{0, 0, 0},
                                        {0, .05f, 0},
                                        {0, .1f, 0},
                                        {.01f, 0, 0},
                                        {.01f, .02f, 0},
                                        {.01f, .04f, 0},
                                        {.01f, .06f, 0},
                                        {.01f, .08f, 0}});
    const auto bindings = bindFollowHairs(groom, settingsWith(0.5f, 4));
    ASSERT_TRUE(bindings);
    EXPECT_EQ(bindings->pointsPerHair, 5u);
    const auto guides = guidePositions(groom, *bindings);
    EXPECT_TRUE(guides[1].isApprox(Vec3f(0, 0.025f, 0)));
    EXPECT_EQ(guides[5], Vec3f(.01f, 0, 0));
    for (const float blend : bindings->blends) EXPECT_EQ(blend, 0.0f);
}

TEST(FollowHairs, OnlyFlaggedStrandsAreGuides) {
    Groom groom = field(4, bent);
    std::vector<std::uint8_t> flags(16, 0);
    for (const std::size_t s : {0u, 3u, 12u, 15u}) flags[s] = 1;
    groom.strandAttributes.set(attribute::kGuide, flags);
    const auto bindings = bindFollowHairs(groom, settingsWith(1.0f, 10));
    ASSERT_TRUE(bindings) << bindings.error().message();
    EXPECT_THAT(bindings->guideStrands, testing::ElementsAre(0u, 3u, 12u, 15u));
    EXPECT_EQ(bindings->hairCount(), 40u);
    // They are triangulated anew: every corner of the square has a triangle.
    for (const float blend : bindings->blends) EXPECT_EQ(blend, 1.0f);
}

/// Speeds that grow with the height, all in one direction.
std::vector<Vec3f> velocities(std::size_t count, std::size_t points, const Vec3f& tipVelocity) {
    std::vector<Vec3f> values(count * points);
    for (std::size_t i = 0; i < values.size(); ++i) {
        values[i] = tipVelocity * (static_cast<float>(i % points) / static_cast<float>(points - 1));
    }
    return values;
}

TEST(WispsInMotion, FollowEquations22And23) {
    const Groom groom = field(8, straight, false);
    InterpolationSettings settings = settingsWith(0.0f, 20);
    settings.wispSpread = 0.2f;
    settings.wispSpreadLimit = 1.7f;  // reached at the last two points
    const auto bindings = bindFollowHairs(groom, settings);
    ASSERT_TRUE(bindings);
    const auto guides = guidePositions(groom, *bindings);
    const auto speeds = velocities(16, 8, Vec3f(3, 0, 4));
    const auto rest = evaluate(*bindings, {guides, {}, {}});
    const auto moving = evaluate(*bindings, {guides, speeds, {}});
    for (std::size_t h = 0; h < bindings->hairCount(); ++h) {
        for (std::size_t i = 0; i < 8; ++i) {
            const double s = static_cast<double>(i) / 7.0;
            const Vec3d v = speeds[i].cast<double>();
            const double xi = std::min(1.0 + 0.2 * s * v.norm(), 1.7);
            const Vec3d centre = groom.strand(h / 20)[i].cast<double>();
            const Vec3d offset = hair(*bindings, rest, h)[i].cast<double>() - centre;
            const Vec3d direction = v.norm() > 0 ? Vec3d(v.normalized()) : Vec3d(Vec3d::Zero());
            const Vec3d expected = centre - double{bindings->radii[i]} * (xi - 1.0) * direction + xi * offset;
            EXPECT_LT((hair(*bindings, moving, h)[i].cast<double>() - expected).norm(), 1e-6);
        }
    }
}

TEST(WispsInMotion, TheLeadingEdgeDoesNotJumpWhenTheSpeedChanges) {
    // Eq. 23 moves the centre back by what Eq. 22 adds to the radius, so the edge towards the motion stays
    // where it is: neither speeding up nor slowing down pushes it.
    const Groom groom = field(8, straight, false);
    auto bindings = bindFollowHairs(groom, settingsWith(0.0f, 1));
    ASSERT_TRUE(bindings);
    const auto guides = guidePositions(groom, *bindings);
    const Vec3f direction = bindings->rootFrames[0].col(0);
    bindings->wispOffsets.assign(bindings->hairCount(), Vec2f(1, 0));
    bindings->wisps.spread = 0.2f;
    const auto rest = evaluate(*bindings, {guides, {}, {}});
    for (const float speed : {0.0f, 1e-6f, 0.1f, 1.0f, 10.0f}) {
        const auto moving = evaluate(*bindings, {guides, velocities(16, 8, speed * direction), {}});
        for (std::size_t i = 0; i < 8; ++i) EXPECT_LT((moving[i] - rest[i]).norm(), 1e-6f) << speed;
    }
}

TEST(WispsInMotion, PositionsAreContinuousInTheVelocity) {
    const Groom groom = field(8, bent, false);
    InterpolationSettings settings = settingsWith(0.3f, 10);
    settings.wispSpread = 0.2f;
    const auto bindings = bindFollowHairs(groom, settings);
    ASSERT_TRUE(bindings);
    const auto guides = guidePositions(groom, *bindings);
    const auto positionsAt = [&](float speed) {
        return evaluate(*bindings, {guides, velocities(16, 8, Vec3f(speed, 0, 0)), {}});
    };
    const float step = 0.01f;
    auto before = positionsAt(-0.2f);
    for (float speed = -0.2f + step; speed < 0.2f; speed += step) {
        const auto after = positionsAt(speed);
        // Twice the radius times the change of ξ bounds the change of a point.
        for (std::size_t i = 0; i < after.size(); ++i) {
            ASSERT_LT((after[i] - before[i]).norm(), 2.0f * 0.004f * 0.2f * step * 1.5f);
        }
        before = after;
    }
}

TEST(FollowHairs, TurnWithTheScalp) {
    const Groom groom = field(6, bent);
    const auto bindings = bindFollowHairs(groom, settingsWith(0.4f, 10));
    ASSERT_TRUE(bindings);
    const auto rest = evaluateAtRest(groom, *bindings);
    const Quatf turn(Eigen::AngleAxisf(0.7f, Vec3f(1, 2, 3).normalized()));
    auto guides = guidePositions(groom, *bindings);
    for (Vec3f& point : guides) point = turn * point;
    const std::vector<Quatf> rotations(16, turn);
    const auto turned = evaluate(*bindings, {guides, {}, rotations});
    for (std::size_t i = 0; i < rest.size(); ++i) EXPECT_LT((turn * rest[i] - turned[i]).norm(), 1e-6f);
}

TEST(FollowHairs, SameBitsForAnyNumberOfThreads) {
    const Groom groom = field(16, bent);
    const auto hashWith = [&](std::size_t threads) {
        setThreadCount(threads);
        const auto bindings = bindFollowHairs(groom, settingsWith(0.5f, 300));
        const auto positions = evaluateAtRest(groom, *bindings);
        setThreadCount(0);
        return hashBytes(std::as_bytes(std::span(positions)));
    };
    const auto one = hashWith(1);
    EXPECT_EQ(hashWith(2), one);
    EXPECT_EQ(hashWith(5), one);
}

TEST(FollowHairs, HairsOfAGuideDoNotChangeWhenAnotherGuideGoes) {
    Groom groom = field(5, bent, false);
    groom.triangulation = {};
    std::vector<std::uint32_t> ids(16);
    for (std::uint32_t s = 0; s < 16; ++s) ids[s] = 100 + s;
    groom.strandAttributes.set(attribute::kStrandId, ids);
    const auto all = bindFollowHairs(groom, settingsWith(0.0f, 5));
    std::vector<std::uint8_t> flags(16, 1);
    flags[0] = 0;
    groom.strandAttributes.set(attribute::kGuide, flags);
    const auto fewer = bindFollowHairs(groom, settingsWith(0.0f, 5));
    ASSERT_TRUE(all && fewer);
    for (std::size_t h = 0; h < fewer->hairCount(); ++h)
        EXPECT_EQ(fewer->wispOffsets[h], all->wispOffsets[h + 5]);
}

TEST(FollowHairs, LayersHaveTheirOwnDensity) {
    Groom groom = field(5, bent);
    groom.layers = {
        {"Base", true, false, 1, {}}, {"Fringe", true, false, 0.5f, {}}, {"Bald", true, false, 0, {}}};
    std::vector<std::uint32_t> layers(16, 0);
    layers[3] = layers[4] = 1;
    layers[5] = 2;
    groom.strandAttributes.set(attribute::kLayer, layers);
    const auto all = bindFollowHairs(field(5, bent), settingsWith(0.5f, 8));
    const auto some = bindFollowHairs(groom, settingsWith(0.5f, 8));
    ASSERT_TRUE(all && some);
    EXPECT_EQ(some->hairCount(), 13 * 8u + 2 * 4u);
    std::size_t hair = 0;
    for (std::size_t guide = 0; guide < 16; ++guide) {
        const std::uint32_t expected = layers[guide] == 0 ? 8 : layers[guide] == 1 ? 4 : 0;
        EXPECT_EQ(some->hairs[guide], expected);
        for (std::uint32_t number = 0; number < expected; ++number, ++hair) {
            EXPECT_EQ(some->guides[hair], all->guides[8 * guide + number]) << "the same hair as without";
            EXPECT_EQ(some->wispOffsets[hair], all->wispOffsets[8 * guide + number]);
        }
    }
    const auto baked = bakeFollowHairs(groom, *some);
    ASSERT_TRUE(baked);
    const auto ofHairs = baked->strandAttributes.view<std::uint32_t>(attribute::kLayer);
    EXPECT_EQ(std::count(ofHairs.begin(), ofHairs.end(), 1u), 8);
}

TEST(FollowHairs, PartsOfAHairAreLeftToChance) {
    Groom groom = scenes::guidesOnGrid({40, 40, 4, kSpacing, 0.1f}, bent);
    groom.layers[0].density = 0.3f;
    const auto bindings = bindFollowHairs(groom, settingsWith(0, 1));
    ASSERT_TRUE(bindings);
    // Three standard deviations of 1,600 draws.
    EXPECT_NEAR(static_cast<double>(bindings->hairCount()), 480, 55);
    EXPECT_EQ(bindFollowHairs(groom, settingsWith(0, 1))->hairs, bindings->hairs);
    groom.layers[0].density = 0;
    EXPECT_EQ(bindFollowHairs(groom, settingsWith(0, 1))->hairCount(), 0u);
}

TEST(FollowHairs, BakesIntoABoundGroom) {
    const Groom groom = field(6, bent);
    const auto bindings = bindFollowHairs(groom, settingsWith(0.5f, 7));
    ASSERT_TRUE(bindings);
    const auto baked = bakeFollowHairs(groom, *bindings);
    ASSERT_TRUE(baked);
    EXPECT_EQ(baked->strandCount(), 112u);
    EXPECT_EQ(baked->pointCount(), 672u);
    EXPECT_EQ(baked->rootBindings().size(), 112u);
}

TEST(FollowBindings, TheFirstHairOfAGuideMayBeTheGuide) {
    const Groom groom = field(8, bent, false);
    InterpolationSettings settings = settingsWith(0.6f, 4);
    const auto without = bindFollowHairs(groom, settings);
    settings.drawGuides = true;
    const auto bindings = bindFollowHairs(groom, settings);
    ASSERT_TRUE(without && bindings);
    const auto hairs = evaluateAtRest(groom, *bindings), others = evaluateAtRest(groom, *without);
    for (std::size_t h = 0; h < bindings->hairCount(); ++h) {
        for (std::size_t i = 0; i < 8; ++i) {
            const Vec3f expected = h % 4 == 0 ? groom.strand(h / 4)[i] : hair(*without, others, h)[i];
            EXPECT_LT((hair(*bindings, hairs, h)[i] - expected).norm(), h % 4 == 0 ? 1e-6f : 1e-9f) << h;
        }
    }
}

TEST(FollowBindings, RefusesWhatIsOutOfRange) {
    const Groom groom = field(4, straight);
    EXPECT_FALSE(bindFollowHairs(Groom(), settingsWith(0.5f)));
    EXPECT_FALSE(bindFollowHairs(groom, settingsWith(1.5f)));
    EXPECT_FALSE(bindFollowHairs(groom, settingsWith(0.5f, 5000)));
    auto settings = settingsWith(0.5f);
    settings.wispRadiusTip = -1;
    EXPECT_FALSE(bindFollowHairs(groom, settings));
    settings = settingsWith(0.5f);
    settings.wispSpread = -0.1f;
    EXPECT_FALSE(bindFollowHairs(groom, settings));
    settings = settingsWith(0.5f);
    settings.wispSpreadLimit = 0.5f;
    EXPECT_FALSE(bindFollowHairs(groom, settings));
    PartingSettings parting;
    parting.endAngleDegrees = parting.beginAngleDegrees;
    EXPECT_FALSE(bindFollowHairs(groom, settingsWith(0.5f), parting));
    const auto none = bindFollowHairs(groom, settingsWith(0.5f, 0));
    ASSERT_TRUE(none);
    EXPECT_EQ(none->hairCount(), 0u);
}

TEST(FollowHairs, TakeTheWidthsOfTheGuidesAroundThem) {
    Groom groom = field(8, bent);
    const auto bindings = bindFollowHairs(groom, settingsWith(1)).value();
    EXPECT_FALSE(bakeFollowHairs(groom, bindings)->pointAttributes.has(attribute::kWidthChange));
    // A value that is linear in the place of the root and along the strand comes out as that of the hair.
    std::vector<float> changes;
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        const Vec3f root = groom.strand(s)[0];
        for (std::uint32_t p = 0; p < 8; ++p)
            changes.push_back(20 * root.x() + 10 * root.z() + 0.1f * static_cast<float>(p));
    }
    groom.pointAttributes.set(attribute::kWidthChange, changes);
    const auto baked = bakeFollowHairs(groom, bindings);
    ASSERT_TRUE(baked);
    const auto widths = widthChanges(*baked);
    ASSERT_EQ(widths.size(), baked->pointCount());
    for (std::size_t hair = 0; hair < baked->strandCount(); ++hair) {
        if (bindings.blends[hair] < 1) continue;  // of a guide in no triangle
        const Vec3f root = baked->strand(hair)[0];
        for (std::uint32_t p = 0; p < 8; ++p)
            ASSERT_NEAR(widths[8 * hair + p], 20 * root.x() + 10 * root.z() + 0.1f * static_cast<float>(p),
                        1e-4f);
    }
}

}  // namespace
}  // namespace hairloom
