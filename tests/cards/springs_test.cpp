// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cards/springs.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hairloom::cards {
namespace {

/// Two chains of four bones of 5 cm that hang beside a head.
Rig hangingRig() {
    Rig rig;
    rig.perChain = 5;
    for (const float side : {-0.1f, 0.1f}) {
        std::vector<Vec3f> curve;
        for (std::uint32_t k = 0; k < kStations; ++k)
            curve.emplace_back(side, 1.7f - 0.2f * static_cast<float>(k) / (kStations - 1), 0.0f);
        for (std::uint32_t j = 0; j < rig.perChain; ++j)
            rig.joints.push_back(
                {curve[std::size_t{6} * j], j == 0 ? 0 : static_cast<std::int32_t>(rig.joints.size()) - 1});
        rig.curves.push_back(std::move(curve));
    }
    return rig;
}

/// Shaken about the axis through the ears.
std::vector<Eigen::Isometry3f> shaken(int frames) {
    std::vector<Eigen::Isometry3f> heads;
    for (int f = 0; f < frames; ++f) {
        const float angle = 0.4f * std::sin(0.13f * static_cast<float>(f));
        heads.push_back(Eigen::Translation3f(0, 1.6f, 0) * Eigen::AngleAxisf(angle, Vec3f::UnitX()) *
                        Eigen::Translation3f(0, -1.6f, 0));
    }
    return heads;
}

ChainMotion motionBy(const Rig& rig, const std::vector<Spring>& springs, int frames) {
    ChainMotion motion;
    motion.heads_ws = shaken(frames);
    motion.joints_ws.resize(motion.heads_ws.size());
    for (std::size_t chain = 0; chain < rig.chains(); ++chain) {
        const auto moved = swing(rig, chain, springs[chain], motion.heads_ws, {});
        for (std::size_t f = 0; f < moved.size(); ++f)
            motion.joints_ws[f].insert(motion.joints_ws[f].end(), moved[f].begin(), moved[f].end());
    }
    return motion;
}

TEST(Springs, HangStillUnderAHeadThatIsStillAndKeepTheLengthsOfBones) {
    const Rig rig = hangingRig();
    const std::vector<Eigen::Isometry3f> still(30, Eigen::Isometry3f::Identity());
    for (const auto& joints : swing(rig, 0, {}, still, {}))
        for (std::uint32_t j = 0; j < 5; ++j)
            EXPECT_LT((joints[j] - rig.joints[1 + j].position_ws).norm(), 1e-5f);
    const auto moved = swing(rig, 1, {}, shaken(60), {});
    float farthest = 0;
    for (const auto& joints : moved) {
        for (std::uint32_t j = 0; j + 1 < 5; ++j)
            EXPECT_NEAR((joints[j + 1] - joints[j]).norm(), 0.05f, 1e-4f);
        farthest = std::max(farthest, (joints[4] - rig.joints[10].position_ws).norm());
    }
    EXPECT_GT(farthest, 0.01f);
}

TEST(Springs, StayOutOfSpheres) {
    const Rig rig = hangingRig();
    const std::vector<Collider> colliders{{Vec3f(-0.1f, 1.5f, 0.02f), 0.05f}};
    const Spring spring;
    const auto joints =
        swing(rig, 0, spring, std::vector<Eigen::Isometry3f>(60, Eigen::Isometry3f::Identity()), colliders)
            .back();
    EXPECT_GT((joints[4] - colliders[0].centre_ws).norm(), 0.05f);
}

TEST(Springs, AreFoundByTheMotionThatTheyMade) {
    const Rig rig = hangingRig();
    std::vector<Spring> made(2);
    made[0].stiffness = 0.3f, made[0].tipStiffness = 0.1f, made[0].drag = 0.15f, made[0].gravity = 0.1f;
    made[1].stiffness = 1.6f, made[1].tipStiffness = 1.2f, made[1].drag = 0.7f, made[1].gravity = 0.4f;
    const ChainMotion wanted = motionBy(rig, made, 90);
    const auto found = fitSprings(rig, wanted, {}, nullptr);
    ASSERT_TRUE(found) << found.error().message();
    const SpringError before = springError(rig, std::vector<Spring>(2), wanted, {}),
                      after = springError(rig, *found, wanted, {});
    EXPECT_GT(before.meanMm, 3);
    EXPECT_LT(after.meanMm, 0.5);
    EXPECT_LT(after.largestMm, 3);
    EXPECT_GT((*found)[1].drag, (*found)[0].drag);
    EXPECT_EQ(springError(rig, made, wanted, {}).largestMm, 0);
}

/// As hangingRig(), but the chains stand out from the head, so that gravity bends them.
Rig standingRig() {
    Rig rig = hangingRig();
    for (Joint& joint : rig.joints) {
        if (joint.parent >= 0) joint.position_ws = {1.8f - joint.position_ws.y(), 1.7f, 0};
    }
    return rig;
}

TEST(Springs, SettleWhereTheyStay) {
    const Rig rig = standingRig();
    Spring soft;
    soft.stiffness = 0.6f, soft.tipStiffness = 0.3f, soft.gravity = 0.2f;
    const std::vector<Eigen::Isometry3f> still(600, Eigen::Isometry3f::Identity());
    const auto joints = swing(rig, 0, soft, still, {}).back();
    float farthest = 0;
    for (std::uint32_t j = 0; j < 5; ++j)
        farthest = std::max(farthest, (joints[j] - rig.joints[1 + j].position_ws).norm());
    EXPECT_GT(farthest, 0.02f);
    EXPECT_NEAR(settling(rig, 0, soft), farthest, 1e-4f) << "what is computed is what they swing to";
    // Motion that asks for gravity, of hair that hangs where it is.
    ChainMotion wanted = motionBy(rig, std::vector<Spring>(2, soft), 90);
    const auto found = fitSprings(rig, wanted, {}, nullptr);
    ASSERT_TRUE(found) << found.error().message();
    for (std::size_t c = 0; c < 2; ++c) EXPECT_LT(settling(rig, c, (*found)[c]), 0.001f) << c;
}

TEST(Springs, TouchNothingAtRest) {
    const Rig rig = hangingRig();
    // One that a joint stands in, one 3 mm beside a joint, one far away.
    const std::vector<Collider> colliders{
        {Vec3f(-0.1f, 1.5f, 0.02f), 0.05f}, {Vec3f(-0.1f, 1.6f, 0.053f), 0.05f}, {Vec3f(0, 1, 0), 0.05f}};
    EXPECT_EQ(collidersOfChain(rig, 0, colliders), (std::vector<std::uint32_t>{1, 2}));
    EXPECT_EQ(collidersOfChain(rig, 1, colliders), (std::vector<std::uint32_t>{0, 1, 2}));
    const auto found = fitSprings(rig, motionBy(rig, std::vector<Spring>(2), 30), colliders, nullptr);
    ASSERT_TRUE(found) << found.error().message();
    EXPECT_NEAR((*found)[0].hitRadius, 0.003f, 1e-5f);
    EXPECT_EQ((*found)[1].hitRadius, Spring().hitRadius);
}

TEST(Springs, TurnJointsAsTheirBonesTurn) {
    const Rig rig = hangingRig();
    const auto heads = shaken(40);
    std::vector<std::vector<Vec3f>> still, swung;
    for (std::size_t c = 0; c < 2; ++c) {
        swung.push_back(swing(rig, c, {}, heads, {}).back());
        still.emplace_back();
        for (std::uint32_t j = 0; j < 5; ++j)
            still.back().push_back(heads[7] * rig.joints[1 + c * rig.perChain + j].position_ws);
    }
    // Chains that go with the head are moved as it is.
    const Vec3f point(0.1f, 1.62f, 0.03f);
    for (const Eigen::Affine3f& motion : jointMotions(rig, heads[7], still))
        EXPECT_LT((motion * point - heads[7] * point).norm(), 1e-5f);
    // Others take each joint to where it is, and the next along its bone.
    const auto motions = jointMotions(rig, heads.back(), swung);
    ASSERT_EQ(motions.size(), rig.joints.size());
    for (std::size_t c = 0; c < 2; ++c)
        for (std::uint32_t j = 0; j < 5; ++j) {
            const std::size_t of = 1 + c * rig.perChain + j;
            EXPECT_LT((motions[of] * rig.joints[of].position_ws - swung[c][j]).norm(), 1e-5f);
            EXPECT_LT((motions[of].linear() * motions[of].linear().transpose() - Eigen::Matrix3f::Identity())
                          .norm(),
                      1e-4f);
            if (j + 1 == 5) continue;
            EXPECT_LT((motions[of] * rig.joints[of + 1].position_ws - swung[c][j + 1]).norm(), 1e-4f);
        }
}

TEST(Springs, SwingDifferentlyAtEachRateAndAreFittedForOne) {
    const Rig rig = hangingRig();
    const Spring spring{0.3f, 0.1f, 0.15f, 0.1f, 0.008f};
    ChainMotion wanted = motionBy(rig, std::vector<Spring>(2, spring), 90);
    // What they make at 60 updates a second they do not make at others, where the head moves as it did.
    const auto shakenAt = [](float hz) {
        std::vector<Eigen::Isometry3f> heads;
        for (int f = 0; static_cast<float>(f) <= 89 * hz / 60; ++f) {
            const float angle = 0.4f * std::sin(0.13f * 60 / hz * static_cast<float>(f));
            heads.push_back(Eigen::Translation3f(0, 1.6f, 0) * Eigen::AngleAxisf(angle, Vec3f::UnitX()) *
                            Eigen::Translation3f(0, -1.6f, 0));
        }
        return heads;
    };
    for (const float hz : {30.0f, 144.0f}) {
        const ChainMotion other = atRate(wanted, hz, shakenAt(hz));
        EXPECT_EQ(other.hz, hz);
        const auto found = fitSprings(rig, other, {}, nullptr);
        ASSERT_TRUE(found) << found.error().message();
        const SpringError as60 = springError(rig, std::vector<Spring>(2, spring), other, {}),
                          fitted = springError(rig, *found, other, {});
        EXPECT_GT(as60.meanMm, 3) << hz;
        EXPECT_LT(fitted.meanMm, 0.5 * as60.meanMm) << hz;
    }
    EXPECT_EQ(springError(rig, std::vector<Spring>(2, spring), wanted, {}).largestMm, 0);
}

TEST(Springs, MotionAtAnotherRateGoesThroughTheSameJoints) {
    const Rig rig = hangingRig();
    const ChainMotion motion = motionBy(rig, std::vector<Spring>(2), 60);
    std::vector<Eigen::Isometry3f> twice, half;
    for (int f = 0; f < 119; ++f) {
        const float angle = 0.4f * std::sin(0.065f * static_cast<float>(f));
        twice.push_back(Eigen::Translation3f(0, 1.6f, 0) * Eigen::AngleAxisf(angle, Vec3f::UnitX()) *
                        Eigen::Translation3f(0, -1.6f, 0));
    }
    for (std::size_t f = 0; f < 60; f += 2) half.push_back(motion.heads_ws[f]);
    const ChainMotion finer = atRate(motion, 120, twice), coarser = atRate(motion, 30, half);
    ASSERT_EQ(finer.joints_ws.size(), 119u);
    for (std::size_t f = 0; f < 60; ++f)
        for (std::size_t j = 0; j < 10; ++j) {
            EXPECT_LT((finer.joints_ws[2 * f][j] - motion.joints_ws[f][j]).norm(), 1e-5f);
            if (f % 2 == 1) continue;
            EXPECT_LT((coarser.joints_ws[f / 2][j] - motion.joints_ws[f][j]).norm(), 1e-5f);
        }
    // Between two frames they lie near the middle of a curve: nearer to a chord than it is long.
    for (std::size_t f = 10; f < 50; ++f) {
        const Vec3f middle = 0.5f * (motion.joints_ws[f][4] + motion.joints_ws[f + 1][4]);
        EXPECT_LT((finer.joints_ws[2 * f + 1][4] - middle).norm(), 0.004f);
    }
}

TEST(Springs, StopWhenTheyAreCancelled) {
    const std::atomic<bool> cancel = true;
    const Rig rig = hangingRig();
    EXPECT_FALSE(fitSprings(rig, motionBy(rig, std::vector<Spring>(2), 3), {}, &cancel));
}

}  // namespace
}  // namespace hairloom::cards
