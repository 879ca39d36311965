// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/animation/skeleton.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hairloom {
namespace {

Bone bone(const char* name, std::uint32_t parent, const Vec3f& offset) {
    Bone made;
    made.name = name;
    made.parent = parent;
    made.rest = Eigen::Translation3f(offset) * Eigen::AngleAxisf(0.3f, Vec3f::UnitZ());
    return made;
}

std::vector<Eigen::Affine3f> restOf(const Skeleton& skeleton) {
    std::vector<Eigen::Affine3f> local;
    for (const Bone& each : skeleton.bones()) local.push_back(each.rest);
    return local;
}

TEST(Skeleton, WorldMatricesMultiplyDownTheChainInAnyBoneOrder) {
    const auto down = Skeleton::make({bone("hip", kNoBone, {0, 1, 0}), bone("neck", 0, {0, 0.5f, 0}),
                                      bone("head", 1, {0.1f, 0.2f, 0})})
                          .value();
    const auto up = Skeleton::make({bone("head", 1, {0.1f, 0.2f, 0}), bone("neck", 2, {0, 0.5f, 0}),
                                    bone("hip", kNoBone, {0, 1, 0})})
                        .value();
    const Eigen::Affine3f expected = down.bones()[0].rest * down.bones()[1].rest * down.bones()[2].rest;
    EXPECT_TRUE(down.worldMatrices(restOf(down))[2].isApprox(expected, 1e-6f));
    EXPECT_TRUE(up.worldMatrices(restOf(up))[0].isApprox(expected, 1e-6f));
    EXPECT_EQ(up.find("neck"), 1u);
    EXPECT_EQ(up.find("tail"), std::nullopt);
}

TEST(Skeleton, RefusesCyclesMissingParentsAndNonFiniteMatrices) {
    EXPECT_FALSE(Skeleton::make({bone("a", 1, {0, 0, 0}), bone("b", 0, {0, 0, 0})}));
    EXPECT_FALSE(Skeleton::make({bone("a", 0, {0, 0, 0})}));
    EXPECT_FALSE(Skeleton::make({bone("a", 7, {0, 0, 0})}));
    EXPECT_FALSE(Skeleton::make({bone("a", kNoBone, {0, std::nanf(""), 0})}));
    EXPECT_TRUE(Skeleton::make({}));
}

}  // namespace
}  // namespace hairloom
