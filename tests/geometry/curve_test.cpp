// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry/curve.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"

namespace hairloom {
namespace {

std::vector<Vec3f> randomCurve(std::uint64_t seed, std::size_t count) {
    Random random(seed);
    std::vector<Vec3f> points(count, Vec3f::Zero());
    for (std::size_t i = 1; i < count; ++i)
        points[i] =
            points[i - 1] + Vec3f(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    return points;
}

Vec3f randomUnit(Random& random) {
    return Vec3f(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)).normalized();
}

TEST(CatmullRom, PassesThroughEveryControlPoint) {
    for (const std::size_t count : {2u, 3u, 4u, 7u, 16u}) {
        const std::vector<Vec3f> points = randomCurve(count, count);
        for (std::size_t i = 0; i < count; ++i) {
            const float x = static_cast<float>(i) / static_cast<float>(count - 1);
            EXPECT_LT((catmullRom(points, x) - points[i]).norm(), 1e-5f) << i << " of " << count;
        }
    }
}

TEST(CatmullRom, IsSmoothAtJoints) {
    const std::vector<Vec3f> points = randomCurve(1, 9);
    constexpr float kStep = 1e-3f;
    for (int i = 1; i < 8; ++i) {
        const float x = static_cast<float>(i) / 8;
        const Vec3f at = catmullRom(points, x);
        const Vec3f before = (at - catmullRom(points, x - kStep)) / kStep;
        const Vec3f after = (catmullRom(points, x + kStep) - at) / kStep;
        // The tangent there (Eq. 54) is half of what is between the neighbours, a segment being 1/8 of x.
        const Vec3f tangent =
            4 * (points[static_cast<std::size_t>(i) + 1] - points[static_cast<std::size_t>(i) - 1]);
        EXPECT_LT((before - tangent).norm(), 0.05f * tangent.norm()) << x;
        EXPECT_LT((after - tangent).norm(), 0.05f * tangent.norm()) << x;
    }
}

TEST(Resample, PointsAreEvenAlongThePolyline) {
    const std::vector<Vec3f> line = {{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 2, 0}, {1, 2, 3}};
    const std::vector<Vec3f> even = resampleEvenly(line, 13);
    ASSERT_EQ(even.size(), 13u);
    EXPECT_EQ(even.front(), line.front());
    EXPECT_EQ(even.back(), line.back());
    EXPECT_FLOAT_EQ(polylineLength(line), 6);
    for (std::size_t i = 1; i < even.size(); ++i) EXPECT_NEAR((even[i] - even[i - 1]).norm(), 0.5, 1e-6);
    const std::vector<Vec3f> point = {{1, 2, 3}, {1, 2, 3}};
    for (const Vec3f& p : resampleEvenly(point, 4)) EXPECT_EQ(p, point[0]);
}

TEST(ShortestArc, TurnsOneIntoTheOtherByTheSmallestAngle) {
    Random random(9);
    for (int i = 0; i < 2000; ++i) {
        const Vec3f from = randomUnit(random);
        // Half of the cases lie near 180°, down to where the cross product is rounding noise.
        const float spread = std::pow(10.0f, random.uniform(-8, 0));
        const Vec3f to = i % 2 == 0 ? randomUnit(random) : (-from + spread * randomUnit(random)).normalized();
        const Quatf turn = shortestArc(from, to);
        EXPECT_NEAR(turn.norm(), 1, 1e-5);
        EXPECT_LT((turn * from - to).norm(), 2e-5f) << from.transpose() << " to " << to.transpose();
        const double angle = std::atan2(from.cross(to).norm(), from.dot(to));
        EXPECT_NEAR(2 * std::atan2(turn.vec().norm(), std::abs(turn.w())), angle, 2e-3);
    }
    EXPECT_LT((shortestArc(Vec3f::UnitX(), -Vec3f::UnitX()) * Vec3f::UnitX() + Vec3f::UnitX()).norm(), 1e-6f);
}

TEST(ParallelTransport, FramesAreOrthonormalAndDoNotTwist) {
    const std::vector<Vec3f> curve = randomCurve(3, 40);
    const std::vector<Mat3f> random = parallelTransportFrames(curve, Vec3f(0.3f, 1, 0));
    EXPECT_EQ(random.size(), curve.size());
    for (const Mat3f& frame : random) {
        EXPECT_LT((frame.transpose() * frame - Mat3f::Identity()).norm(), 1e-5f);
        EXPECT_NEAR(frame.determinant(), 1, 1e-5);
    }
    // In the plane z = 0 the normal that starts along z stays along z.
    std::vector<Vec3f> arc;
    for (int i = 0; i < 50; ++i)
        arc.emplace_back(std::cos(0.1f * static_cast<float>(i)), std::sin(0.1f * static_cast<float>(i)),
                         0.0f);
    const std::vector<Mat3f> level = parallelTransportFrames(arc, Vec3f::UnitZ());
    EXPECT_EQ(level.size(), arc.size());
    for (const Mat3f& frame : level) EXPECT_GT(frame.col(0).z(), 0.9999f);
    // Neighbouring frames of a smooth space curve differ by the turn of the tangent and nothing more.
    std::vector<Vec3f> helix;
    for (int i = 0; i < 200; ++i)
        helix.emplace_back(std::cos(0.05f * static_cast<float>(i)), std::sin(0.05f * static_cast<float>(i)),
                           0.02f * static_cast<float>(i));
    const std::vector<Mat3f> frames = parallelTransportFrames(helix, Vec3f::UnitZ());
    ASSERT_EQ(frames.size(), helix.size());
    for (std::size_t i = 1; i < frames.size(); ++i) {
        const float bend = std::acos(std::min(1.0f, frames[i].col(2).dot(frames[i - 1].col(2))));
        const float turn =
            std::acos(std::min(1.0f, ((frames[i].transpose() * frames[i - 1]).trace() - 1) / 2));
        EXPECT_NEAR(turn, bend, 2e-3);
    }
}

TEST(ParallelTransport, SurvivesRepeatedPoints) {
    const std::vector<Vec3f> curve = {{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {0, 0, 0}};
    const std::vector<Mat3f> frames = parallelTransportFrames(curve, Vec3f::UnitX());
    EXPECT_EQ(frames.size(), curve.size());
    for (const Mat3f& frame : frames)
        EXPECT_LT((frame.transpose() * frame - Mat3f::Identity()).norm(), 1e-5f);
}

}  // namespace
}  // namespace hairloom
