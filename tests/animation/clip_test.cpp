// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/animation/clip.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hairloom {
namespace {

Quatf turn(float angle, const Vec3f& axis) {
    return Quatf(Eigen::AngleAxisf(angle, axis.normalized()));
}

TEST(Clip, RotationBetweenTwoKeysTurnsEvenlyAboutOneAxis) {
    const Vec3f axis = Vec3f(1, 2, -0.5f).normalized();
    const Track<Quatf> track{{1.0f, 3.0f}, {turn(0.2f, axis), turn(2.6f, axis)}};
    for (int step = 0; step <= 20; ++step) {
        const float fraction = static_cast<float>(step) / 20.0f;
        const Quatf expected = turn(0.2f + fraction * 2.4f, axis);
        EXPECT_LT(sample(track, 1.0f + 2.0f * fraction).angularDistance(expected), 2e-3f) << fraction;
    }
}

TEST(Clip, RotationMatchesTheClosedFormOfSlerp) {
    const Quatf a = turn(0.7f, {0, 1, 0}), b = turn(1.9f, {1, 0, 1});
    const Track<Quatf> track{{0.0f, 1.0f}, {a, b}};
    const double theta = std::acos(static_cast<double>(a.dot(b)));
    for (const double t : {0.0, 0.1, 0.5, 0.77, 1.0}) {
        const Eigen::Vector4d expected = (std::sin((1 - t) * theta) * a.coeffs().cast<double>() +
                                          std::sin(t * theta) * b.coeffs().cast<double>()) /
                                         std::sin(theta);
        const Eigen::Vector4d found = sample(track, static_cast<float>(t)).coeffs().cast<double>();
        EXPECT_LT((found - expected).norm(), 1e-6) << t;
    }
}

TEST(Clip, RotationTakesTheShorterArc) {
    Quatf far = turn(0.4f, {0, 0, 1});
    far.coeffs() *= -1;
    const Track<Quatf> track{{0.0f, 1.0f}, {turn(0.0f, {0, 0, 1}), far}};
    EXPECT_LT(sample(track, 0.5f).angularDistance(turn(0.2f, {0, 0, 1})), 1e-3f);
}

TEST(Clip, TracksAreLinearBetweenKeysAndConstantOutside) {
    const Track<Vec3f> track{{1.0f, 2.0f, 4.0f}, {{0, 0, 0}, {2, 0, 0}, {2, 8, 0}}};
    EXPECT_EQ(sample(track, 0.0f, Vec3f::Ones()), Vec3f(0, 0, 0));
    EXPECT_EQ(sample(track, 1.5f, Vec3f::Ones()), Vec3f(1, 0, 0));
    EXPECT_EQ(sample(track, 3.0f, Vec3f::Ones()), Vec3f(2, 4, 0));
    EXPECT_EQ(sample(track, 9.0f, Vec3f::Ones()), Vec3f(2, 8, 0));
    EXPECT_EQ(sample(Track<Vec3f>{}, 9.0f, Vec3f::Ones()), Vec3f(1, 1, 1));
}

struct OneBone {
    OneBone() {
        Bone bone;
        bone.name = "head";
        bone.rest = Eigen::Affine3f(Eigen::Translation3f(9, 9, 9));
        skeleton = Skeleton::make({bone}).value();
        Channel channel;
        channel.translation = {{0.0f, 2.0f}, {{0, 0, 0}, {4, 0, 0}}};
        channel.scale = {{0.0f}, {{2, 2, 2}}};
        clip = {"walk", 2.0f, {channel}};
    }
    float at(float time, Wrap wrap) const {
        return localMatrices(skeleton, clip, time, wrap)[0].translation().x();
    }
    Skeleton skeleton;
    Clip clip;
};

TEST(Clip, LoopsOrHoldsOutsideItsDuration) {
    const OneBone moved;
    EXPECT_FLOAT_EQ(moved.at(2.5f, Wrap::Clamp), 4.0f);
    EXPECT_FLOAT_EQ(moved.at(-1.0f, Wrap::Clamp), 0.0f);
    EXPECT_FLOAT_EQ(moved.at(2.5f, Wrap::Loop), 1.0f);
    EXPECT_FLOAT_EQ(moved.at(-0.5f, Wrap::Loop), 3.0f);
    const auto matrix = localMatrices(moved.skeleton, moved.clip, 1.0f, Wrap::Clamp)[0];
    EXPECT_TRUE((matrix * Vec3f(1, 1, 1)).isApprox(Vec3f(4, 2, 2)));
    EXPECT_EQ(localMatrices(moved.skeleton)[0].translation(), Vec3f(9, 9, 9));
}

TEST(Clip, PosesBlendBoneByBone) {
    const auto at = [](const Vec3f& place, float angle, float scale) {
        return Eigen::Affine3f(Eigen::Translation3f(place) * turn(angle, {0, 0, 1}) * Eigen::Scaling(scale));
    };
    const std::vector<Eigen::Affine3f> from{at({0, 0, 0}, 3.0f, 1), at({1, 2, 3}, 0.4f, 1)};
    const std::vector<Eigen::Affine3f> to{at({2, 0, 4}, -3.0f, 3), from[1]};
    const auto half = blended(from, to, 0.5f);
    EXPECT_TRUE(half[0].isApprox(at({1, 0, 2}, kPi, 2), 1e-5f)) << "over pi, which is nearer than over 0";
    EXPECT_EQ(half[1].matrix(), from[1].matrix()) << "what is the same stays, bit by bit";
    EXPECT_TRUE(blended(from, to, 0)[0].isApprox(from[0], 1e-5f));
    EXPECT_TRUE(blended(from, to, 1)[0].isApprox(to[0], 1e-5f));
}

TEST(Clip, ValidationNamesClipAndBone) {
    OneBone broken;
    EXPECT_TRUE(validate(broken.clip, broken.skeleton));
    broken.clip.channels[0].translation.times = {1.0f, 1.0f};
    const auto status = validate(broken.clip, broken.skeleton);
    ASSERT_FALSE(status);
    EXPECT_NE(status.error().message().find("clip 'walk', bone 'head', translation"), std::string::npos);
    broken = OneBone();
    broken.clip.channels[0].bone = 1;
    EXPECT_FALSE(validate(broken.clip, broken.skeleton));
    broken = OneBone();
    broken.clip.channels[0].rotation = {{0.0f}, {Quatf(0, 0, 0, 0)}};
    EXPECT_FALSE(validate(broken.clip, broken.skeleton));
    broken = OneBone();
    broken.clip.channels[0].scale.times.clear();
    EXPECT_FALSE(validate(broken.clip, broken.skeleton));
}

}  // namespace
}  // namespace hairloom
