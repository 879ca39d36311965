// SPDX-License-Identifier: GPL-3.0-or-later
// Rods on spheres and capsules against closed equations: a chain in its angles that falls on a circle, a
// pendulum that lies on a plane, a strand that slides over a bar, and what restitution may do.
#include "core/stability/contact_scenes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hairloom {
namespace {

TEST(RodContact, AStrandThatFallsOnASphereFollowsTheChain) {
    const FallOnASphere fall;
    const double two = fall.error(2), eight = fall.error(8), thirtyTwo = fall.error(32);
    EXPECT_LT(two, 0.003);
    EXPECT_LT(eight, 0.001);
    EXPECT_LT(thirtyTwo, eight / 3.0);
}

TEST(RodContact, FrictionHoldsBelowItsAngleAndLetsSlideAbove) {
    EXPECT_LT(slideOnAPlane(0.95, 2).slid, 0.0002);
    EXPECT_LT(slideOnAPlane(0.95, 32).slid, 0.0002);
    for (const double over : {1.1, 1.5}) {
        const Slide coarse = slideOnAPlane(over, 2), fine = slideOnAPlane(over, 16);
        EXPECT_NEAR(coarse.slid, coarse.due, 0.05 * coarse.due) << over;
        EXPECT_NEAR(fine.slid, fine.due, 0.03 * fine.due) << over;
    }
}

TEST(RodContact, AStrandOverABarHasTheTensionsOfACapstan) {
    for (const float friction : {0.2f, 0.5f, 0.8f}) {
        for (const std::uint32_t substeps : {2u, 8u}) {
            const Capstan found = strandOverABar(friction, substeps);
            EXPECT_NEAR(found.ratio, found.due, 0.04 * found.due) << friction << ' ' << substeps;
            // The strand's weight on the bar adds to it.
            EXPECT_GT(found.due, std::exp(static_cast<double>(friction) * found.wrap));
            EXPECT_LT(found.due, 1.4 * std::exp(static_cast<double>(friction) * found.wrap));
        }
    }
}

TEST(RodContact, ABounceComesToRestAndAddsNoEnergy) {
    for (const float restitution : {0.2f, 0.5f, 1.0f}) {
        const Bounce bounce = bounceOnASphere(restitution);
        // What bounces back whole loses nothing to the sphere, and takes longer.
        EXPECT_LT(bounce.speed, restitution < 1 ? 0.005 : 0.02) << restitution;
        EXPECT_LT(bounce.gained, 1e-4) << restitution;
    }
}

TEST(RodContact, GravityThatChangesIsNoEnergyFromNothing) {
    EXPECT_EQ(guardedWhereGravityChanges(), 0u);
}

}  // namespace
}  // namespace hairloom
