// SPDX-License-Identifier: GPL-3.0-or-later
// What else hair may do wrong, on hair that is made to do it.
#include "core/accuracy/other_errors.h"

#include <gtest/gtest.h>

#include "core/geometry/shapes.h"
#include "tests/accuracy/hair.h"

namespace hairloom::test {
namespace {

OtherErrors restOf(const Groom& groom) {
    OtherErrors errors;
    const auto status = measureRest(sampleStrands(groom, groom.strandCount(), 1), {}, {}, errors);
    EXPECT_TRUE(status) << status.error().message();
    return errors;
}

TEST(OtherErrors, RodsThatCarryTheirWeightHoldTheirShapeAndLooseHairDrops) {
    Groom groom = straightHair(4, 12);
    const OtherErrors held = restOf(groom);
    EXPECT_LT(held.dropMm, 1);
    EXPECT_LT(held.returnMm, 1);
    EXPECT_LT(held.restSpeed, 0.005);
    groom.simulation.strandModel = runtime::StrandModel::springs;
    groom.simulation.substeps = 8;
    groom.simulation.angularStiffness = 0;
    const OtherErrors loose = restOf(groom);
    EXPECT_GT(loose.dropMm, 100) << "from level to hanging: 20 cm of hair";
    EXPECT_LT(loose.returnMm, 5) << "hanging is where it comes back to";
}

TEST(OtherErrors, WindIsLeftOut) {
    Groom groom = straightHair(4, 12);
    groom.simulation.windSpeed = 20;
    EXPECT_LT(restOf(groom).dropMm, 1);
}

/// A head of 10 cm, which moves by 1 m along x, and points so far from its middle.
TEST(OtherErrors, DepthsInTheHeadAreFoundInEveryFrameHoweverItMoves) {
    Groom groom = straightHair(1, 4);
    groom.scalp = std::make_shared<const ScalpMesh>(shapes::meshOf(shapes::icosphere(4, 0.1f)));
    HeadPose rest, moved, bent;
    moved.head_ws.pretranslate(Vec3f(1, 0, 0));
    bent.origin_ws = Vec3d(0, 2, 0);
    for (const Vec3f& position : groom.scalp->positions())
        bent.scalpPositions_ws.push_back(position + Vec3f(1, 0, 0));
    const std::vector<HeadPose> poses{rest, moved, bent};
    const auto at = [](float first, float second) {
        Trajectory trajectory;
        trajectory.frames = 2;
        trajectory.pointsPerFrame = 1;
        trajectory.points_ws = {Vec3f(1, first, 0), Vec3f(1, 2 + second, 0)};
        return trajectory;
    };
    const Trajectory outside = at(0.11f, 0.11f), first = at(0.08f, 0.11f), second = at(0.11f, 0.07f);
    const Trajectory* const all[] = {&outside, &first, &second};
    const std::vector<double> depths = headDepths(groom, poses, all);
    EXPECT_EQ(depths[0], 0);
    EXPECT_NEAR(depths[1], 20, 0.3);
    EXPECT_NEAR(depths[2], 30, 0.3);
    groom.scalp.reset();
    EXPECT_EQ(headDepths(groom, poses, all)[2], 0) << "no head";
}

}  // namespace
}  // namespace hairloom::test
