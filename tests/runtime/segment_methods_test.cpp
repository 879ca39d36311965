// SPDX-License-Identifier: GPL-3.0-or-later
// What holds for every method with rigid segments.

#include "tests/runtime/segment_methods.h"

#include <limits>
#include <type_traits>

#include "hairloom/alternatives/projective_equations.h"
#include "hairloom/alternatives/rigid_chains.h"
#include "tests/runtime/allocations.h"
#include "tests/runtime/threads.h"

namespace hairloom::runtime {
namespace {

template <class Method>
class SegmentMethods : public testing::Test {};
struct MethodNames {
    template <class Method>
    static std::string GetName(int) {
        return std::is_same_v<Method, RigidChains> ? "chains" : "projective";
    }
};
using Methods = testing::Types<ProjectiveEquations, RigidChains>;
TYPED_TEST_SUITE(SegmentMethods, Methods, MethodNames);

TYPED_TEST(SegmentMethods, SameBitsForAnyNumberOfThreads) {
    const Strands strands = tuft(80, true);
    SimulationSettings s = springSettings();
    s.windSpeed = 8.0f;
    std::vector<std::vector<Float3>> results;
    for (const Host& host : {Host{}, hostWithThreads(1), hostWithThreads(5), hostWithThreads(3, true)}) {
        TypeParam method = makeMethod<TypeParam>(strands, s, host);
        for (int f = 1; f <= 20; ++f) {
            const auto roots = strands.roots({0.02f * std::sin(static_cast<float>(f)), 0.0f, 0.0f});
            method.step({1.0f / 60.0f, f / 60.0, roots, {}});
        }
        results.push_back(positionsOf(method));
    }
    for (const auto& result : results) EXPECT_TRUE(result == results[0]);
}

TYPED_TEST(SegmentMethods, AStepAllocatesNothing) {
    const Strands strands = tuft(50);
    SimulationSettings s = springSettings();
    s.windSpeed = 8.0f;
    TypeParam method = makeMethod<TypeParam>(strands, s);
    const std::vector<Sphere> spheres{{{0.08f, 0.02f, 0.0f}, 0.07f}};
    run(method, strands, 1, 1.0f / 60.0f, spheres);
    const auto roots = strands.roots();
    const std::size_t before = allocationCount();
    for (int f = 0; f < 10; ++f) method.step({1.0f / 60.0f, f / 60.0, roots, spheres});
    EXPECT_EQ(allocationCount(), before);
}

TYPED_TEST(SegmentMethods, NonFiniteInputIsRejected) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), huge = 1e38f;
    const Strands strands = tuft(4);
    SimulationSettings s = springSettings();
    s.windSpeed = 8.0f;
    s.angularStiffness = 1.0f;
    s.angularCurve = Ramp::straight(1.0f, 0.0f);
    TypeParam method = makeMethod<TypeParam>(strands, s);
    auto roots = strands.roots();
    roots[0].position.x = nan;
    roots[1].rotation = {0.0f, 0.0f, 0.0f, 0.0f};
    roots[2].position.y = huge;
    const std::vector<Sphere> spheres{{{nan, 0, 0}, 1.0f},
                                      {{0, 0, 0}, nan},
                                      {{huge, 0, 0}, 1.0f},
                                      {{0, 0, 0}, huge},
                                      {strands.points[0], 0.1f}};
    const float times[] = {1.0f / 60.0f, 1e-40f, huge, nan, -1.0f, std::numeric_limits<float>::infinity()};
    const double clocks[] = {std::numeric_limits<double>::quiet_NaN(), 1e308, -1e308};
    for (int f = 0; f < 60; ++f) {
        method.step({times[f % 6], clocks[f % 3], roots, spheres});
        ASSERT_LT(worstStretch(strands, positionsOf(method)), 2e-5) << f;
        std::vector<Float3> velocities(method.pointCount());
        method.readVelocities(velocities);
        for (const Float3& v : velocities) ASSERT_TRUE(isFinite(v));
    }
}

TYPED_TEST(SegmentMethods, RefusesWhatTheEngineRefuses) {
    const Strands strands = tuft(2);
    SimulationSettings s = springSettings();
    s.airDrag = -1.0f;
    EXPECT_EQ(TypeParam::make(strands.view(), s).error, "airDrag is -1 1/s; expected 0 to 1000");
    Strands torn = tuft(2);
    torn.points.pop_back();
    EXPECT_NE(TypeParam::make(torn.view(), {}).error, "");
    Strands doubled = oneSegment({0.0f, -1.0f, 0.0f}, 0.0f);
    TypeParam method = makeMethod<TypeParam>(doubled, {});
    run(method, doubled, 10);
    EXPECT_EQ(positionsOf(method)[1], Float3{});
}

TYPED_TEST(SegmentMethods, TipsLeaveSpheresAndSegmentsKeepTheirLength) {
    const Strands strands = tuft(40);
    SimulationSettings s = springSettings();
    s.angularStiffness = 0.02f;
    s.collisionRadiusRoot = s.collisionRadiusTip = 0.002f;
    TypeParam method = makeMethod<TypeParam>(strands, s);
    const std::vector<Sphere> spheres{{{0.08f, 0.005f, 0.0f}, 0.07f}};
    const auto deepest = [&] {
        float maximum = -1.0f;
        for (const Float3& p : positionsOf(method))
            maximum = std::max(maximum, 0.072f - length(p - spheres[0].center_ws));
        return maximum;
    };
    ASSERT_GT(deepest(), 0.02f) << "the sphere should stand in the hair";
    run(method, strands, 120, 1.0f / 60.0f, spheres);
    EXPECT_LT(deepest(), 1e-5f);
    EXPECT_LT(worstStretch(strands, positionsOf(method)), 2e-5);
}

TYPED_TEST(SegmentMethods, ASegmentThatRestedOnASphereStartsFromRest) {
    const Strands strands = oneSegment({1.0f, 0.0f, 0.0f}, 0.1f);
    SimulationSettings s = bare();
    s.gravity = {0.0f, -9.81f, 0.0f};
    s.collisionRadiusTip = 0.0f;
    TypeParam method = makeMethod<TypeParam>(strands, s);
    const std::vector<Sphere> spheres{{{0.1f, -0.05f, 0.0f}, 0.05f}};
    run(method, strands, 120, 1.0f / 60.0f, spheres);
    EXPECT_NEAR(length(positionsOf(method)[1] - spheres[0].center_ws), 0.05f, 1e-5f);
    const float before = positionsOf(method)[1].y;
    run(method, strands, 1);
    // ½ · (3/2) g t² and a little for the steps' sizes: a free fall, not two seconds' speed.
    EXPECT_NEAR(before - positionsOf(method)[1].y, 0.75f * 9.81f / 3600.0f, 4e-4f);
}

}  // namespace
}  // namespace hairloom::runtime
