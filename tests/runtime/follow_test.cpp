// SPDX-License-Identifier: GPL-3.0-or-later
// Follow hairs (thesis §4.2, Eqs. 22 and 23).
#include <algorithm>
#include <cstring>
#include <limits>
#include <numbers>

#include "runtime/engine/kernels.h"
#include "tests/runtime/allocations.h"
#include "tests/runtime/follow_fixture.h"
#include "tests/runtime/instruction_sets.h"
#include "tests/runtime/threads.h"

namespace hairloom::runtime {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

std::vector<Float3> straight(Float3 root, Float3 direction, std::uint32_t points, float segment = 0.01f) {
    std::vector<Float3> strand;
    for (std::uint32_t i = 0; i < points; ++i)
        strand.push_back(root + direction * (segment * static_cast<float>(i)));
    return strand;
}

/// One guide up the y axis and one hair of its wisp.
FollowScene oneWisp(std::array<float, 2> offset, std::uint32_t points = 8) {
    FollowScene scene(points);
    scene.addGuide(straight({}, {0.0f, 1.0f, 0.0f}, points));
    scene.addHair({0, 0, 0}, {1.0f, 0.0f, 0.0f}, offset, 0.0f);
    return scene;
}

float largestDistance(const std::vector<Float3>& a, const std::vector<Float3>& b) {
    EXPECT_EQ(a.size(), b.size());
    float largest = 0.0f;
    for (std::size_t i = 0; i < a.size(); ++i) largest = std::fmax(largest, length(a[i] - b[i]));
    return largest;
}

bool sameBits(const std::vector<Float3>& a, const std::vector<Float3>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Float3)) == 0;
}

void moveRigidly(FollowScene& scene, Quat turn, Float3 shift) {
    for (Float3& p : scene.positions) p = rotate(turn, p) + shift;
    for (Float3& v : scene.velocities) v = rotate(turn, v);
    for (Quat& q : scene.rotations) q = turn * q;
}

TEST(FollowHairs, MatchAPlainEvaluation) {
    for (const std::uint32_t points : {2u, 3u, 5u, 8u, 16u, 17u, 22u, 33u}) {
        const FollowScene scene = tangled(points);
        const PlainFollowHairs plain(scene);
        const std::vector<Float3> hairs = scene.evaluate();
        double worst = 0.0;
        for (std::size_t h = 0; h < scene.hairs(); ++h) {
            for (std::uint32_t i = 0; i < points; ++i) {
                worst = std::fmax(worst, (Double3(hairs[h * points + i]) - plain.point(h, i)).norm());
            }
        }
        EXPECT_LT(worst, 5e-7) << points;
    }
}

TEST(FollowHairs, MoveRigidlyWithTheirGuides) {
    FollowScene scene = tangled(16);
    std::vector<Float3> expected = scene.evaluate();
    const Quat turn = turnAbout({0.6f, 0.0f, 0.8f}, 1.9f);
    const Float3 shift{0.2f, -0.1f, 0.3f};
    for (Float3& p : expected) p = rotate(turn, p) + shift;
    moveRigidly(scene, turn, shift);
    EXPECT_LT(largestDistance(scene.evaluate(), expected), 1e-6f);
}

TEST(FollowHairs, BlendsLieBetweenTheirEnds) {
    FollowScene scene = tangled(12);
    const auto at = [&](float blend) {
        std::fill(scene.blends.begin(), scene.blends.end(), blend);
        return scene.evaluate();
    };
    const auto wisp = at(0.0f), mixed = at(0.25f), triangle = at(1.0f);
    std::vector<Float3> expected;
    for (std::size_t i = 0; i < wisp.size(); ++i) expected.push_back(wisp[i] * 0.75f + triangle[i] * 0.25f);
    EXPECT_LT(largestDistance(mixed, expected), 5e-7f);
}

TEST(FollowHairs, Blend0UsesOneGuideAndBlend1NoClump) {
    FollowScene scene = tangled(12);
    std::fill(scene.blends.begin(), scene.blends.end(), 0.0f);
    const auto wisp = scene.evaluate();
    FollowScene other = scene;
    std::reverse(other.weights.begin(), other.weights.end());
    std::reverse(other.rootWeights.begin(), other.rootWeights.end());
    EXPECT_TRUE(sameBits(other.evaluate(), wisp));

    std::fill(scene.blends.begin(), scene.blends.end(), 1.0f);
    const auto triangle = scene.evaluate();
    other = scene;
    std::reverse(other.wispOffsets.begin(), other.wispOffsets.end());
    std::fill(other.velocities.begin(), other.velocities.end(), Float3{9.0f, 0.0f, 0.0f});
    EXPECT_LT(largestDistance(other.evaluate(), triangle), 1e-8f);
}

TEST(FollowHairs, OfFullWeightAreTheGuideItself) {
    FollowScene scene = tangled(16, 5, 0);
    for (std::uint32_t g = 0; g < 5; ++g)
        scene.addHair({g, (g + 1) % 5, (g + 2) % 5}, {1.0f, 0.0f, 0.0f}, {}, 1.0f);
    EXPECT_TRUE(sameBits(scene.evaluate(), scene.positions));
}

TEST(FollowHairs, APartingKeepsTheRootAndTheShapeOfOneGuide) {
    FollowScene scene(6);
    scene.addGuide(straight({}, {-0.6f, 0.8f, 0.0f}, 6));
    scene.addGuide(straight({0.02f, 0.0f, 0.0f}, {0.6f, 0.8f, 0.0f}, 6));
    scene.addHair({0, 1, 1}, {1.0f, 0.0f, 0.0f}, {}, 1.0f);
    scene.rootWeights[0] = {0.75f, 0.25f, 0.0f};
    std::vector<Float3> expected = straight({0.005f, 0.0f, 0.0f}, {-0.6f, 0.8f, 0.0f}, 6);
    EXPECT_LT(largestDistance(scene.evaluate(), expected), 1e-8f);
}

TEST(FollowHairs, ShiftsOntoTheScalpTurnWithIt) {
    FollowScene scene = oneWisp({0.0f, 0.0f}, 4);
    scene.rootShifts[0] = {0.001f, 0.002f, 0.003f};  // x, −z and y at rest
    const Quat turn = turnAbout({0.0f, 1.0f, 0.0f}, std::numbers::pi_v<float> / 2.0f);
    scene.rotations[0] = {turn.x * 3.0f, turn.y * 3.0f, turn.z * 3.0f, turn.w * 3.0f};  // x → −z, −z → −x
    const std::vector<Float3> hair = scene.evaluate();
    for (std::uint32_t i = 0; i < 4; ++i) {
        const Float3 expected{-0.002f, 0.01f * static_cast<float>(i) + 0.003f, -0.001f};
        EXPECT_LT(length(hair[i] - expected), 1e-8f);
    }
}

TEST(Wisps, AreCarriedWithoutTwist) {
    // A strand curled in a plane keeps what lies across the plane across it, and what lies in it at its side.
    constexpr std::uint32_t kPoints = 64;
    FollowScene scene(kPoints);
    std::vector<Float3> curl;
    for (std::uint32_t i = 0; i < kPoints; ++i) {
        const float angle = 0.15f * static_cast<float>(i);  // one and a half turns
        curl.push_back({0.05f - 0.05f * std::cos(angle), 0.05f * std::sin(angle), 0.0f});
    }
    scene.addGuide(curl);
    scene.addHair({0, 0, 0}, {1.0f, 0.0f, 0.0f}, {0.0f, 1.0f}, 0.0f);
    scene.addHair({0, 0, 0}, {1.0f, 0.0f, 0.0f}, {1.0f, 0.0f}, 0.0f);
    const std::vector<Float3> hairs = scene.evaluate();
    for (std::uint32_t i = 0; i < kPoints; ++i) {
        EXPECT_LT(length(hairs[i] - curl[i] - Float3{0.0f, 0.0f, -scene.radii[i]}), 1e-7f) << i;
        const Float3 side = hairs[kPoints + i] - curl[i];
        const Float3 inward = Float3{0.05f, 0.0f, 0.0f} - curl[i];
        if (i + 1 == kPoints) continue;  // its tangent is the last segment
        EXPECT_NEAR(dot(side, inward), scene.radii[i] * 0.05f, 1e-7f) << i;
    }
}

TEST(Wisps, StayContinuousThroughTheVertical) {
    // Tilted planes of the scalp, and a strand that swings through straight up and straight down.
    for (const float end : {1.0f, -1.0f}) {
        FollowScene scene(10);
        scene.addGuide(straight({}, {1.0f, 0.0f, 0.0f}, 10));
        scene.planes[0] = {{0.0f, 0.0f, -1.0f}, {0.0f, 1.0f, 0.0f}, {1.0f, 0.0f, 0.0f}};
        scene.addHair({0, 0, 0}, {1.0f, 0.0f, 0.0f}, {1.0f, 0.0f}, 0.0f);
        scene.addHair({0, 0, 0}, {1.0f, 0.0f, 0.0f}, {0.0f, 1.0f}, 0.0f);
        constexpr float kStep = 0.01f;
        std::vector<Float3> before;
        for (float angle = 1.3f; angle < 1.9f; angle += kStep) {
            // Swings a little beside the vertical, where a fixed up direction would spin the frame.
            scene.positions = straight({}, {std::cos(angle), end * std::sin(angle), 1e-3f}, 10);
            const std::vector<Float3> now = scene.evaluate();
            // A point moves by no more than its height and its radius times the angle.
            if (!before.empty()) {
                EXPECT_LT(largestDistance(now, before), (0.09f + 2.0f * 0.005f) * kStep);
            }
            before = now;
        }
    }
}

TEST(Wisps, LieInTheScalpAtTheRootHoweverTheStrandLies) {
    FollowScene scene = tangled(9);
    std::fill(scene.blends.begin(), scene.blends.end(), 0.0f);
    std::fill(scene.rootShifts.begin(), scene.rootShifts.end(), Float3{});
    for (Float3& v : scene.velocities) v = v * 10.0f;
    const std::vector<Float3> hairs = scene.evaluate();
    for (std::size_t h = 0; h < scene.hairs(); ++h) {
        const std::uint32_t g = scene.guides[h][0];
        const auto [x, y] = scene.wispOffsets[h];
        const Float3 inPlane = scene.planes[g].x * x + scene.planes[g].y * y;
        Quat turn = scene.rotations[g];
        ASSERT_TRUE(normalize(turn));
        const Float3 expected = scene.positions[scene.offsets[g]] + rotate(turn, inPlane) * scene.radii[0];
        EXPECT_LT(length(hairs[h * 9] - expected), 1e-7f);
    }
}

TEST(WispsInMotion, WidenWithSpeedTowardsTheTip) {
    // Across the motion Eq. 22 alone acts: the hair beside the centre moves out by ξ.
    FollowScene scene = oneWisp({0.0f, 1.0f});  // towards −z
    scene.velocities.assign(8, {4.0f, 0.0f, 0.0f});
    scene.wisps.spread = 0.25f;
    const std::vector<Float3> hair = scene.evaluate();
    for (std::uint32_t i = 0; i < 8; ++i) {
        const float xi = 1.0f + 0.25f * scene.share(i) * 4.0f;
        EXPECT_NEAR(hair[i].z, -xi * scene.radii[i], 1e-8f);
        EXPECT_NEAR(hair[i].x, -(xi - 1.0f) * scene.radii[i], 1e-8f);  // Eq. 23
    }
}

TEST(WispsInMotion, TheLeadingEdgeStaysWhereItIs) {
    FollowScene scene = oneWisp({1.0f, 0.0f});
    const std::vector<Float3> rest = scene.evaluate();
    for (const float speed : {1e-20f, 1e-6f, 0.1f, 1.0f, 10.0f, 100.0f}) {
        scene.velocities.assign(8, {speed, 0.0f, 0.0f});
        EXPECT_LT(largestDistance(scene.evaluate(), rest), 1e-8f * (1.0f + speed)) << speed;
    }
}

TEST(WispsInMotion, NoHairGetsAheadOfTheWispAtRest) {
    for (int k = 0; k < 12; ++k) {
        const float angle = 0.5f * static_cast<float>(k);
        FollowScene scene = oneWisp({std::cos(angle), std::sin(angle)});
        scene.velocities.assign(8, {7.0f, 0.0f, 0.0f});
        const std::vector<Float3> hair = scene.evaluate();
        for (std::uint32_t i = 0; i < 8; ++i) EXPECT_LE(hair[i].x, scene.radii[i] + 1e-8f);
    }
}

TEST(WispsInMotion, AreContinuousInTheVelocityAndThroughRest) {
    FollowScene scene = tangled(8);
    scene.wisps.spread = 0.2f;
    const auto at = [&](float speed) {
        std::fill(scene.velocities.begin(), scene.velocities.end(), Float3{0.6f * speed, 0.0f, 0.8f * speed});
        return scene.evaluate();
    };
    constexpr float kStep = 0.01f;
    std::vector<Float3> before = at(-0.2f);
    for (int k = -19; k <= 20; ++k) {
        const std::vector<Float3> now = at(0.01f * static_cast<float>(k));
        // Eqs. 22 and 23 each move a point by r σ dv at most, Eq. 22 times its offset, at most √2.
        EXPECT_LT(largestDistance(now, before), 2.42f * 0.005f * 0.2f * kStep + 1e-7f);
        before = now;
    }
}

TEST(WispsInMotion, NoVelocitiesAreGuidesAtRest) {
    FollowScene scene = tangled(16);
    std::fill(scene.velocities.begin(), scene.velocities.end(), Float3{});
    const std::vector<Float3> atRest = scene.evaluate();
    for (const Float3& p : atRest) ASSERT_TRUE(isFinite(p));
    scene.velocities.clear();
    EXPECT_TRUE(sameBits(scene.evaluate(), atRest));
    std::fill(scene.rotations.begin(), scene.rotations.end(), Quat{});
    const std::vector<Float3> unturned = scene.evaluate();
    scene.rotations.clear();
    EXPECT_TRUE(sameBits(scene.evaluate(), unturned));
}

TEST(GuidesOfOtherCounts, AreTakenAtEvenSharesOfTheirLengthAtRest) {
    FollowScene scene(5);
    // 0.04 m in segments of 1 and 3 cm: points of the hair at 0, 1, 2, 3 and 4 cm.
    scene.addGuide({{0.0f, 0.0f, 0.0f}, {0.0f, 0.01f, 0.0f}, {0.0f, 0.04f, 0.0f}});
    scene.addHair({0, 0, 0}, {1.0f, 0.0f, 0.0f}, {}, 1.0f);
    EXPECT_LT(largestDistance(scene.evaluate(), straight({}, {0.0f, 1.0f, 0.0f}, 5)), 1e-8f);
    // Moved, they stay on the same places of the guide, even as a segment stretches.
    scene.positions = {{0.0f, 0.0f, 0.0f}, {0.01f, 0.0f, 0.0f}, {0.01f, 0.06f, 0.0f}};
    const std::vector<Float3> expected{{0.0f, 0.0f, 0.0f},
                                       {0.01f, 0.0f, 0.0f},
                                       {0.01f, 0.02f, 0.0f},
                                       {0.01f, 0.04f, 0.0f},
                                       {0.01f, 0.06f, 0.0f}};
    EXPECT_LT(largestDistance(scene.evaluate(), expected), 1e-8f);
}

TEST(GuidesOfOtherCounts, BringTheirVelocities) {
    // The same straight guide, moving alike, as 8 and as 15 points: every second is one of the 8.
    FollowScene fine = oneWisp({0.3f, -0.8f});
    fine.offsets = {0};
    fine.rest.clear();
    fine.planes.clear();
    fine.rotations.clear();
    fine.addGuide(straight({}, {0.0f, 1.0f, 0.0f}, 15, 0.005f));
    for (std::uint32_t i = 0; i < 15; ++i) fine.velocities[i] = {0.5f * static_cast<float>(i), 0.0f, 1.0f};
    FollowScene coarse = oneWisp({0.3f, -0.8f});
    for (std::uint32_t i = 0; i < 8; ++i) coarse.velocities[i] = fine.velocities[std::size_t{2} * i];
    EXPECT_LT(largestDistance(fine.evaluate(), coarse.evaluate()), 1e-8f);
}

TEST(GuidesOfOtherCounts, OfNoLengthGiveHairsOfNone) {
    FollowScene scene(4);
    scene.addGuide({{0.1f, 0.2f, 0.3f}, {0.1f, 0.2f, 0.3f}});
    scene.addHair({0, 0, 0}, {1.0f, 0.0f, 0.0f}, {0.5f, 0.5f}, 0.0f);
    // Where there is no direction the cross-section stays in the scalp.
    for (const Float3& p : scene.evaluate()) EXPECT_NEAR(p.y, 0.2f, 1e-7f);
}

TEST(FollowHairs, SameBitsForAnyNumberOfThreadsAndOrder) {
    const FollowScene scene = tangled(17, 150, 3000);
    const std::vector<Float3> serial = scene.evaluate();
    EXPECT_TRUE(sameBits(scene.evaluate(hostWithThreads(1)), serial));
    EXPECT_TRUE(sameBits(scene.evaluate(hostWithThreads(7)), serial));
    EXPECT_TRUE(sameBits(scene.evaluate(hostWithThreads(3, true)), serial));
}

TEST(FollowHairs, SameBitsForEveryInstructionSetThatRoundsAlike) {
    for (const std::uint32_t points : {2u, 5u, 16u, 22u}) {
        const FollowScene scene = tangled(points);
        std::vector<Float3> expected[2];
        forEveryInstructionSet([&] {
            const std::vector<Float3> positions = scene.evaluate();
            std::vector<Float3>& first = expected[kernels().fuses ? 1 : 0];
            if (first.empty()) first = positions;
            EXPECT_TRUE(sameBits(positions, first)) << points;
        });
    }
}

TEST(FollowHairs, EvaluationAllocatesNothing) {
    const FollowScene scene = tangled(16);
    FollowHairs::Result made = FollowHairs::make(scene.view());
    ASSERT_TRUE(made.hairs);
    std::vector<Float3> hairs(scene.hairs() * 16);
    Host host;
    host.parallelFor = [](std::size_t count, std::size_t, const Host::Body& body) { body(0, count); };
    const GuideMotion motion{scene.positions, scene.velocities, scene.rotations};
    const std::size_t before = allocationCount();
    made.hairs->evaluate(motion, hairs);
    made.hairs->evaluate(motion, hairs, host);
    EXPECT_EQ(allocationCount(), before);
}

TEST(FollowHairs, AreFilledWithoutTouchingWhatLiesBeside) {
    for (const std::uint32_t points : {2u, 5u, 7u, 16u, 19u}) {
        const FollowScene scene = tangled(points, 7, 9);
        FollowHairs::Result made = FollowHairs::make(scene.view());
        ASSERT_TRUE(made.hairs);
        const Float3 guard{7.0f, 8.0f, 9.0f};
        std::vector<Float3> memory(scene.hairs() * points + 2, guard);
        made.hairs->evaluate({scene.positions, scene.velocities, scene.rotations},
                             std::span(memory).subspan(1, scene.hairs() * points));
        EXPECT_EQ(memory.front(), guard);
        EXPECT_EQ(memory.back(), guard);
        EXPECT_TRUE(sameBits({memory.begin() + 1, memory.end() - 1}, scene.evaluate()));
    }
}

/// Whether a hair takes part of the guide.
bool follows(const FollowScene& scene, std::size_t hair, std::uint32_t guide) {
    const auto& of = scene.guides[hair];
    if (of[0] == guide) return true;
    return scene.blends[hair] > 0.0f && (of[1] == guide || of[2] == guide);
}

TEST(FollowHairs, AreNonFiniteOnlyWhereTheirGuidesAre) {
    FollowScene scene = tangled(16);
    const std::vector<Float3> sound = scene.evaluate();
    for (const float bad : {kNan, std::numeric_limits<float>::infinity()}) {
        FollowScene broken = scene;
        broken.positions[broken.offsets[4] + 7].y = bad;
        broken.velocities[broken.offsets[9] + 3].z = bad;
        const std::vector<Float3> hairs = broken.evaluate();
        for (std::size_t h = 0; h < scene.hairs(); ++h) {
            for (std::uint32_t i = 0; i < 16; ++i) {
                const bool lost = (i == 7 && follows(scene, h, 4)) || (i == 3 && scene.guides[h][0] == 9);
                ASSERT_EQ(isFinite(hairs[h * 16 + i]), !lost) << h << " " << i;
                if (follows(scene, h, 4) || lost) continue;
                ASSERT_EQ(hairs[h * 16 + i], sound[h * 16 + i]);
            }
        }
    }
}

TEST(FollowHairs, NonFiniteRootAffectsOnlyItsHairs) {
    FollowScene scene = tangled(8);
    scene.positions[scene.offsets[2]].x = kNan;
    const std::vector<Float3> hairs = scene.evaluate();
    for (std::size_t h = 0; h < scene.hairs(); ++h) {
        if (follows(scene, h, 2)) continue;
        for (std::uint32_t i = 0; i < 8; ++i) ASSERT_TRUE(isFinite(hairs[h * 8 + i])) << h;
    }
}

TEST(FollowHairs, InvalidRotationIsIdentity) {
    FollowScene scene = tangled(8);
    scene.rotations[1] = {0.0f, 0.0f, 0.0f, 1.0f};
    const std::vector<Float3> unturned = scene.evaluate();
    for (const Quat none : {Quat{kNan, 0.0f, 0.0f, 1.0f}, Quat{0.0f, 0.0f, 0.0f, 0.0f}}) {
        scene.rotations[1] = none;
        EXPECT_TRUE(sameBits(scene.evaluate(), unturned));
    }
}

TEST(FollowHairs, OfNoGuideAreNone) {
    const FollowScene scene = tangled(8, 3, 0);
    EXPECT_TRUE(scene.evaluate().empty());
}

TEST(FollowHairs, RefuseWhatDoesNotFitInWords) {
    const auto errorAfter = [](auto&& spoil) {
        FollowScene scene = tangled(8);
        spoil(scene);
        const FollowHairs::Result made = FollowHairs::make(scene.view());
        EXPECT_EQ(made.hairs.has_value(), made.error.empty());
        return made.error;
    };
    EXPECT_EQ(errorAfter([](FollowScene&) {}), "");
    EXPECT_EQ(errorAfter([](FollowScene& s) { s.guides[7][2] = 21; }), "hair 7 follows guide 21 of 21");
    EXPECT_EQ(errorAfter([](FollowScene& s) { s.weights[3].x += 0.1f; }),
              "hair 3 has weights that are not shares of 1");
    EXPECT_EQ(errorAfter([](FollowScene& s) {
                  s.rootWeights[3] = {2.0f, -1.0f, 0.0f};
              }),
              "hair 3 has root weights that are not shares of 1");
    EXPECT_EQ(errorAfter([](FollowScene& s) { s.blends[0] = kNan; }),
              "hair 0 has a blend that is not between 0 and 1");
    EXPECT_EQ(errorAfter([](FollowScene& s) { s.wispOffsets[1][1] = kNan; }),
              "hair 1 has a wisp offset that is not finite");
    EXPECT_EQ(errorAfter([](FollowScene& s) { s.rootShifts[1].z = kNan; }),
              "hair 1 has a root shift that is not finite");
    EXPECT_EQ(errorAfter([](FollowScene& s) { s.radii[5] = -1.0f; }),
              "the wisp radius at point 5 is not a length");
    EXPECT_EQ(errorAfter([](FollowScene& s) { s.planes[5].y.x = kNan; }),
              "the root plane of guide 5 is not finite");
    EXPECT_EQ(errorAfter([](FollowScene& s) { s.rest[5].y = kNan; }), "rest position 5 is not finite");
    EXPECT_EQ(errorAfter([](FollowScene& s) { s.blends.pop_back(); }), "299 blends; expected 300");
    EXPECT_EQ(errorAfter([](FollowScene& s) { s.points = 1; }), "1 points per hair; expected 2 to 1048576");
    EXPECT_EQ(errorAfter([](FollowScene& s) { s.offsets = {}; }),
              "no guide offsets from 0; expected guide count + 1 of them");
    EXPECT_EQ(errorAfter([](FollowScene& s) { s.offsets[2] = s.offsets[1] + 1; }),
              "guide 1 runs from point 8 to 9; expected two points or more");
    EXPECT_EQ(errorAfter([](FollowScene& s) {
                  s.offsets[1] = 7;
                  s.rest.clear();
              }),
              "0 rest positions of guides; expected 168");
}

}  // namespace
}  // namespace hairloom::runtime
