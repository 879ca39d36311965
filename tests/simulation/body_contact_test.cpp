// SPDX-License-Identifier: GPL-3.0-or-later
// Rods and drawn hair against the baked skin of a body, measured against its mesh.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/parallel.h"
#include "core/geometry/mesh_solid.h"
#include "core/simulation/bake_body.h"
#include "core/simulation/body_push.h"
#include "core/simulation/scene_input.h"
#include "core/simulation/simulation.h"
#include "hairloom/engine.h"
#include "tests/geometry/test_meshes.h"
#include "tests/simulation/hairy_ball.h"

namespace hairloom {
namespace {

constexpr float kFrame = 1.0f / 60;
using test::bentBall;
using test::hairyBall;
using test::hairyBody;
using test::withBody;
constexpr std::uint32_t kPoints = test::kBallHairPoints;

/// Metres that points lie in the ball, but for the first two of each strand.
float deepest(std::span<const Vec3f> points, const HeadPose& pose) {
    static const Groom kGroom = hairyBall();
    static const MeshSolid ball(kGroom.scalp->positions(), kGroom.scalp->triangles());
    const Eigen::Isometry3f toBall = pose.head_ws.inverse();
    float depth = 0;
    for (std::size_t p = 0; p < points.size(); ++p) {
        const Vec3f at = toBall * points[p];
        if (p % kPoints > 1 && at.norm() < 0.1001f) depth = std::max(depth, -ball.signedDistance(at));
    }
    return depth;
}

HeadPose noddingAt(float time) {
    HeadPose pose;
    pose.head_ws = Eigen::Translation3f(0.1f * std::sin(3 * time), 0, 0) *
                   Eigen::AngleAxisf(0.6f * std::sin(6 * time), Vec3f::UnitX());
    return pose;
}

struct Ran {
    float deepest = 0;  ///< of all frames
    float drawn = 0;    ///< likewise, led out as what is drawn is
    float last = 0;     ///< of the last frame
    std::vector<Vec3f> positions_ws;
    SimulationStats stats;
};

Ran run(const Groom& groom, int frames, HeadPose (*poseAt)(float)) {
    auto made = Simulation::make(groom, poseAt(0));
    if (!made) throw std::runtime_error(made.error().message());
    const auto push = makeBodyPush(groom, groom.offsets.view(), groom.positions());
    Ran ran;
    for (int f = 1; f <= frames; ++f) {
        const HeadPose pose = poseAt(kFrame * static_cast<float>(f));
        made->step(kFrame, pose);
        ran.last = deepest(made->positions_ws(), pose);
        ran.deepest = std::max(ran.deepest, ran.last);
        std::vector<Vec3f> points(made->positions_ws().begin(), made->positions_ws().end());
        if (push) pushOutOfBody(*push, groom, pose, points);
        ran.drawn = std::max(ran.drawn, deepest(points, pose));
    }
    ran.stats = made->stats();
    ran.positions_ws.assign(made->positions_ws().begin(), made->positions_ws().end());
    return ran;
}

TEST(BodyContact, RodsStayOutOfTheSkin) {
    const Groom bare = hairyBall();
    const Groom& kept = hairyBody();
    EXPECT_GT(run(bare, 90, noddingAt).deepest, 0.03f) << "nothing else holds them";
    const Ran ran = run(kept, 90, noddingAt);
    // A tip that comes straight down at 2 m/s is stopped within two substeps, by a sphere as by a body.
    Groom round = bare;
    round.spheres = {{"ball", Vec3f::Zero(), 0.1f, ""}};
    EXPECT_LT(ran.deepest, run(round, 90, noddingAt).deepest + 5e-4f) << "as a sphere of its size holds it";
    EXPECT_LT(ran.last, 1e-3f);
    EXPECT_LT(ran.drawn, 1e-3f);
    EXPECT_EQ(ran.stats.restoredStrands, 0u);
    EXPECT_LT(ran.stats.maxStretch, 1e-3);
    const auto body = std::ranges::find(ran.stats.effects, "body", &EffectReport::name);
    ASSERT_NE(body, ran.stats.effects.end());
    EXPECT_GT(body->bytes, kept.body->bytes());
}

/// Both ends of the way: hair before the ball is struck by it, hair behind it strikes it. Without more
/// substeps in fast frames it comes 20 mm deep.
TEST(BodyContact, RodsAreLedOutOfABodyThatStartsAndStopsAtFiveMetresPerSecond) {
    const Ran ran = run(hairyBody(), 60, [](float time) {
        HeadPose pose;
        pose.head_ws = Eigen::Translation3f(5 * std::min(time, 0.3f), 0, 0);
        return pose;
    });
    EXPECT_LT(ran.deepest, 9e-3f);
    EXPECT_LT(ran.last, 1e-3f);
    EXPECT_EQ(ran.stats.restoredStrands, 0u);
}

/// Mean of substeps in a frame, as the price of one tells.
double substepsOf(const SimulationStats& stats, const Groom& groom) {
    return 1e6 * stats.millisecondsPerFrame /
           (stats.nanosecondsPerParticleSubstep * static_cast<double>(groom.pointCount()));
}

TEST(BodyContact, ThePriceOfASubstepCountsThoseThatWereTaken) {
    const Groom& groom = hairyBody();
    const auto still = run(groom, 10, [](float) { return HeadPose{}; }).stats;
    EXPECT_NEAR(substepsOf(still, groom), groom.simulation.substeps, 1e-6);
    const auto fast = run(groom, 10, [](float time) {
                          HeadPose pose;
                          pose.head_ws = Eigen::Translation3f(5 * time, 0, 0);
                          return pose;
                      }).stats;
    EXPECT_NEAR(substepsOf(fast, groom), 4 * groom.simulation.substeps, 1e-6);
}

TEST(BodyContact, HairComesToRestOnIt) {
    const Groom& groom = hairyBody();
    const Ran ran = run(groom, 900, [](float) { return HeadPose{}; });
    EXPECT_LT(ran.last, 2e-4f);
    EXPECT_LT(ran.drawn, 1e-3f);
    EXPECT_LT(ran.stats.fastestMmPerSecond, 1);
    EXPECT_EQ(ran.stats.restingStrands, groom.strandCount());
}

/// A trough of 20 cm along z: both of its slopes rise by `slope` from x = 0.
ScalpMesh trough(float slope) {
    PolygonSoup soup;
    for (const float z : {-0.1f, 0.1f}) {
        for (const Vec2f& corner : {Vec2f(0, 0), Vec2f(0.1f, 0.1f * slope), Vec2f(0.1f, -0.1f),
                                    Vec2f(-0.1f, -0.1f), Vec2f(-0.1f, 0.1f * slope)})
            soup.positions.emplace_back(corner.x(), corner.y(), z);
    }
    for (std::uint32_t i = 0; i < 5; ++i) {
        const std::uint32_t next = (i + 1) % 5;
        test::addFace(soup, {i, i + 5, next + 5, next});
    }
    // Ends, whose corner at the bottom of the trough is the one that points inwards.
    test::addFace(soup, {0, 1, 2});
    test::addFace(soup, {0, 2, 3});
    test::addFace(soup, {0, 3, 4});
    test::addFace(soup, {5, 7, 6});
    test::addFace(soup, {5, 8, 7});
    test::addFace(soup, {5, 9, 8});
    return test::meshOf(soup);
}

/// Strands that fall across a trough and are pushed along it come to lie in its fold, where the nearest skin
/// is that of one slope and of the other by turns.
TEST(BodyContact, HairComesToRestInAFold) {
    int inFold = 0;
    for (const float slope : {0.4f, 1.0f, 1.6f}) {
        SCOPED_TRACE(slope);
        std::vector<std::uint32_t> offsets{0};
        std::vector<Vec3f> positions;
        for (int s = 0; s < 24; ++s) {
            const float z = -0.05f + 0.004f * static_cast<float>(s),
                        turn = 0.08f * static_cast<float>(s - 12);
            const Vec3f root(-0.04f, 0.04f * slope, z);
            const Vec3f way = Vec3f(std::cos(turn), 0.3f, std::sin(turn)).normalized();
            for (std::uint32_t p = 0; p < kPoints; ++p)
                positions.push_back(root + 0.008f * static_cast<float>(p) * way);
            offsets.push_back(static_cast<std::uint32_t>(positions.size()));
        }
        Groom groom = makeGroom(std::move(offsets), std::move(positions));
        groom.scalp = std::make_shared<const ScalpMesh>(trough(slope));
        groom.simulation.angularStiffness = 0.02f;
        groom.simulation.restGravity = 0;
        groom.simulation.collisionRadiusRoot = groom.simulation.collisionRadiusTip = 0.001f;
        groom = withBody(std::move(groom));
        auto made = Simulation::make(groom, {});
        ASSERT_TRUE(made) << made.error().message();
        for (int f = 0; f < 900; ++f) made->step(kFrame, HeadPose{});
        EXPECT_LT(made->stats().fastestMmPerSecond, 1);
        EXPECT_EQ(made->stats().restingStrands, groom.strandCount());
        EXPECT_EQ(made->stats().restoredStrands, 0u);
        // The planes of both slopes, from equations.
        for (std::size_t p = 0; p < made->positions_ws().size(); ++p) {
            const Vec3f& at = made->positions_ws()[p];
            if (p % kPoints < 2 || std::abs(at.z()) > 0.095f || std::abs(at.x()) > 0.09f) continue;
            const float scale = 1 / std::sqrt(1 + slope * slope);
            const float left = (at.y() + slope * at.x()) * scale, right = (at.y() - slope * at.x()) * scale;
            EXPECT_GT(std::min(left, right), 0.5e-3f) << "point " << p;
            inFold += std::max(left, right) < 2e-3f ? 1 : 0;
        }
    }
    EXPECT_GT(inFold, 20) << "points touch both slopes";
}

TEST(BodyContact, GivesTheSameBitsOnAnyNumberOfThreads) {
    const Groom& groom = hairyBody();
    setThreadCount(1);
    const std::uint64_t one = run(groom, 30, noddingAt).stats.stateHash;
    setThreadCount(3);
    const std::uint64_t three = run(groom, 30, noddingAt).stats.stateHash;
    setThreadCount(0);
    EXPECT_EQ(one, three);
}

/// Nodes that look for the skin at once are gathered from many strands.
TEST(BodyContact, AStrandHangsOnNoneBesideIt) {
    const Groom& groom = hairyBody();
    const std::size_t strands = groom.strandCount();
    std::vector<std::uint32_t> offsets;
    for (std::uint32_t s = 0; s <= strands; ++s) offsets.push_back(s * kPoints);
    std::vector<Vec3f> positions;
    for (std::size_t s = strands; s-- > 0;)
        for (std::size_t p = 0; p < kPoints; ++p) positions.push_back(groom.positions()[s * kPoints + p]);
    Groom turned = makeGroom(std::move(offsets), std::move(positions));
    turned.scalp = groom.scalp;
    turned.simulation = groom.simulation;
    turned.body = groom.body;
    const Ran ran = run(groom, 60, noddingAt), other = run(turned, 60, noddingAt);
    for (std::size_t s = 0; s < strands; ++s)
        for (std::size_t p = 0; p < kPoints; ++p)
            ASSERT_EQ(ran.positions_ws[s * kPoints + p], other.positions_ws[(strands - 1 - s) * kPoints + p])
                << "strand " << s << ", point " << p;
}

TEST(BodyContact, GoesOnFromAState) {
    const Groom& groom = hairyBody();
    auto whole = Simulation::make(groom, noddingAt(0)), again = Simulation::make(groom, noddingAt(0));
    ASSERT_TRUE(whole && again);
    for (int f = 1; f <= 40; ++f) {
        whole->step(kFrame, noddingAt(kFrame * static_cast<float>(f)));
        if (f == 20) {
            ASSERT_TRUE(again->setState(*whole->state(), 20.0 / 60));
        }
        if (f > 20) again->step(kFrame, noddingAt(kFrame * static_cast<float>(f)));
    }
    EXPECT_EQ(whole->stats().stateHash, again->stats().stateHash);
}

TEST(BodyContact, AFarBodyChangesNothing) {
    Groom groom = hairyBall();
    groom.body.reset();
    const std::vector<Vec3f> without = run(groom, 20, noddingAt).positions_ws;
    auto far = std::make_shared<runtime::BodyField>(*hairyBody().body);
    far->low_ss.x += 10;
    groom.body = far;
    EXPECT_EQ(run(groom, 20, noddingAt).positions_ws, without) << "to the bit";
    groom.simulation.strandModel = runtime::StrandModel::springs;
    groom.simulation.substeps = 8;
    const std::uint64_t springs = run(groom, 20, noddingAt).stats.stateHash;
    groom.body.reset();
    EXPECT_EQ(run(groom, 20, noddingAt).stats.stateHash, springs) << "springs pass through it";
}

TEST(BodyContact, SkinThatIsNotLookedAtAgainIsAsItWas) {
    const Groom& groom = hairyBody();
    const auto body = bentBall();
    ASSERT_EQ(body->problem(), "");
    const auto scene = SceneInput::make(groom);
    ASSERT_TRUE(scene);
    const auto boneOf = [](const Eigen::Isometry3f& pose) {
        const auto column = [&](int i) {
            const Vec3f v = pose.matrix().col(i).head<3>();
            return runtime::Float3{v.x(), v.y(), v.z()};
        };
        return runtime::BonePose{column(0), column(1), column(2), column(3)};
    };
    const auto runWith = [&](bool forgets, std::shared_ptr<const runtime::BodyField> with) {
        auto made = runtime::Engine::make(scene->strands(), groom.simulation);
        EXPECT_EQ(made.engine->setBody(std::move(with)), "");
        made.engine->reset(scene->rootsAt({}));
        for (int f = 1; f <= 60; ++f) {
            const float time = kFrame * static_cast<float>(f);
            HeadPose base, top;
            base.head_ws = Eigen::Translation3f(0.05f * std::sin(4 * time), 0, 0);
            top.head_ws = base.head_ws * Eigen::AngleAxisf(0.6f * std::sin(6 * time), Vec3f::UnitX());
            const auto roots = scene->rootsAt(top);
            const std::vector<runtime::BonePose> bones{boneOf(base.head_ws), boneOf(top.head_ws)};
            runtime::FrameInput input;
            input.dt = kFrame;
            input.time = static_cast<double>(time);
            input.roots_ws = roots;
            input.body_ws = bones;
            if (forgets) {
                EXPECT_TRUE(made.engine->setState(*made.engine->state()));
            }
            made.engine->step(input);
        }
        return made.engine->stateHash();
    };
    EXPECT_EQ(runWith(false, body), runWith(true, body));
    EXPECT_NE(runWith(false, body), runWith(false, nullptr)) << "hair touches it";
}

TEST(BodyContact, PosesThatAreNoneLeaveItWhereItWas) {
    const Groom& groom = hairyBody();
    const auto scene = SceneInput::make(groom);
    ASSERT_TRUE(scene);
    const auto roots = scene->rootsAt({});
    const auto runWith = [&](std::span<const runtime::BonePose> later) {
        auto made = runtime::Engine::make(scene->strands(), groom.simulation);
        EXPECT_EQ(made.engine->setBody(groom.body), "");
        made.engine->reset(roots);
        const std::vector<runtime::BonePose> first{{}};
        for (int f = 1; f <= 30; ++f) {
            runtime::FrameInput input;
            input.dt = kFrame;
            input.time = static_cast<double>(kFrame) * f;
            input.roots_ws = roots;
            input.body_ws = f == 1 ? std::span(first) : later;
            made.engine->step(input);
        }
        return made.engine->stateHash();
    };
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    const std::vector<runtime::BonePose> same{{}}, three(3), wrong{{{kNaN, 0, 0}, {}, {}, {}}};
    const std::uint64_t expected = runWith(same);
    EXPECT_EQ(runWith({}), expected);
    EXPECT_EQ(runWith(three), expected);
    EXPECT_EQ(runWith(wrong), expected);
    // A body without size holds nothing; hair falls through and stays finite.
    const std::vector<runtime::BonePose> flat{{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {}}};
    EXPECT_NE(runWith(flat), expected);
}

TEST(BodyContact, AFieldThatIsNoneIsRefused) {
    Groom groom = hairyBody();
    auto broken = std::make_shared<runtime::BodyField>(*groom.body);
    broken->distances.pop_back();
    groom.body = broken;
    const auto made = Simulation::make(groom, {});
    ASSERT_FALSE(made);
    EXPECT_NE(made.error().message().find("body"), std::string::npos) << made.error().message();
}

TEST(BodyPush, LeavesHairAtRestAloneAndLeadsOthersOut) {
    const Groom& groom = hairyBody();
    const auto push = makeBodyPush(groom, groom.offsets.view(), groom.positions());
    ASSERT_TRUE(push);
    const HeadPose pose = noddingAt(0.3f);
    std::vector<Vec3f> points;
    for (const Vec3f& p : groom.positions()) points.push_back(pose.head_ws * p);
    const std::vector<Vec3f> rest = points;
    pushOutOfBody(*push, groom, pose, points);
    float moved = 0;
    for (std::size_t p = 0; p < points.size(); ++p) moved = std::max(moved, (points[p] - rest[p]).norm());
    EXPECT_LT(moved, 1e-5f) << "no stand-off";
    // Straight through the ball, from one side to the other.
    for (std::size_t p = 0; p < points.size(); ++p) {
        const float s = static_cast<float>(p % kPoints) / (kPoints - 1);
        points[p] = rest[p - p % kPoints] +
                    s * (pose.head_ws.translation() + Vec3f(0, 0.02f, 0) - rest[p - p % kPoints]);
    }
    EXPECT_GT(deepest(points, pose), 0.05f);
    points[kPoints + 5].x() = std::numeric_limits<float>::infinity();
    pushOutOfBody(*push, groom, pose, points);
    EXPECT_TRUE(std::isinf(points[kPoints + 5].x())) << "what is no place stays as it is";
    points[kPoints + 5] = rest[kPoints + 5];
    EXPECT_LT(deepest(points, pose), 1e-3f);
}

TEST(BodyPush, CurvesBetweenPointsStayOut) {
    Groom groom = hairyBody();
    // A hair of four points over the ball whose points are outside and whose middle is not.
    const std::vector<Vec3f> rest{{0, 0.1f, 0}, {0, 0.15f, 0}, {0, 0.2f, 0}, {0, 0.25f, 0}};
    const std::vector<std::uint32_t> offsets{0, 4};
    const auto push = makeBodyPush(groom, offsets, rest);
    std::vector<Vec3f> points{{0, 0.1f, 0}, {0.05f, 0.09f, 0}, {0.101f, 0.02f, 0}, {0.102f, -0.05f, 0}};
    const auto middle = [&] {
        return Vec3f(9.0f / 16 * (points[1] + points[2]) - 1.0f / 16 * (points[0] + points[3]));
    };
    ASSERT_LT(middle().norm(), 0.0985f);
    pushOutOfBody(*push, groom, {}, points);
    EXPECT_GT(middle().norm(), 0.0995f);
    EXPECT_EQ(points[0], rest[0]) << "roots stay";
}

}  // namespace
}  // namespace hairloom
