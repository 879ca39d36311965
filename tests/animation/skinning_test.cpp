// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/animation/skinning.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/parallel.h"
#include "core/base/random.h"

namespace hairloom {
namespace {

Vec3f randomVector(Random& random) {
    return {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
}

Eigen::Affine3f randomRigid(Random& random) {
    return Eigen::Translation3f(randomVector(random)) *
           Eigen::AngleAxisf(random.uniform(0, 3), randomVector(random).normalized());
}

TEST(Skinning, BlendsTransformedPointsByWeight) {
    Random random(1);
    const std::vector<Eigen::Affine3f> matrices{randomRigid(random), randomRigid(random),
                                                randomRigid(random)};
    const std::vector<Vec3f> rest{randomVector(random), randomVector(random), randomVector(random)};
    SkinWeights skin{{{0, 1, 2, 0}, {2, 0, 0, 0}, {0, 0, 0, 0}},
                     {{0.5f, 0.3f, 0.2f, 0}, {1, 0, 0, 0}, {0, 0, 0, 0}}};
    std::vector<Vec3f> posed(3);
    skinPositions(rest, skin, matrices, posed);
    const Vec3d blended = 0.5 * (matrices[0] * rest[0]).cast<double>() +
                          0.3 * (matrices[1] * rest[0]).cast<double>() +
                          0.2 * (matrices[2] * rest[0]).cast<double>();
    EXPECT_LT((posed[0].cast<double>() - blended).norm(), 1e-6);
    EXPECT_LT((posed[1] - matrices[2] * rest[1]).norm(), 1e-6f);
    EXPECT_EQ(posed[2], rest[2]) << "without weights nothing moves";
}

TEST(Skinning, NormalsStayPerpendicularUnderUnevenScale) {
    Random random(2);
    const Eigen::Affine3f matrix = randomRigid(random) * Eigen::Scaling(3.0f, 0.25f, 1.5f);
    const SkinWeights skin{{{0, 0, 0, 0}}, {{1, 0, 0, 0}}};
    for (int trial = 0; trial < 50; ++trial) {
        const Vec3f u = randomVector(random), v = randomVector(random);
        const std::vector<Vec3f> rest{u.cross(v).normalized()};
        std::vector<Vec3f> posed(1);
        skinNormals(rest, skin, std::span(&matrix, 1), posed);
        const Vec3f expected = (matrix.linear() * u).cross(matrix.linear() * v).normalized();
        EXPECT_LT((posed[0] - expected).norm(), 1e-4f);
    }
    const Eigen::Affine3f flat(Eigen::Scaling(0.0f, 0.0f, 0.0f));
    const std::vector<Vec3f> up{Vec3f::UnitY()};
    std::vector<Vec3f> posed(1);
    skinNormals(up, skin, std::span(&flat, 1), posed);
    EXPECT_EQ(posed[0], up[0]);
}

TEST(Skinning, TheSameBitsForAnyNumberOfThreads) {
    Random random(3);
    constexpr std::size_t kCount = 20'000;
    std::vector<Eigen::Affine3f> matrices;
    for (int bone = 0; bone < 40; ++bone) matrices.push_back(randomRigid(random));
    std::vector<Vec3f> rest(kCount), one(kCount), many(kCount);
    SkinWeights skin;
    skin.bones.resize(kCount);
    skin.weights.resize(kCount);
    for (std::size_t vertex = 0; vertex < kCount; ++vertex) {
        rest[vertex] = randomVector(random);
        setStrongest(skin, vertex,
                     {{random.below(40), random.uniform()}, {random.below(40), random.uniform()}});
    }
    setThreadCount(1);
    skinPositions(rest, skin, matrices, one);
    setThreadCount(4);
    skinPositions(rest, skin, matrices, many);
    setThreadCount(0);
    EXPECT_EQ(one, many);
}

TEST(SkinWeights, KeepsTheStrongestAndScalesThemToOne) {
    SkinWeights skin{{{}}, {{}}};
    std::vector<std::pair<std::uint32_t, float>> influences;
    for (std::uint32_t bone = 0; bone < 10; ++bone)
        influences.emplace_back(bone, 0.01f * static_cast<float>(1 + 7 * bone % 10));
    setStrongest(skin, 0, influences);
    EXPECT_EQ(skin.bones[0], (std::array<std::uint32_t, kBonesOfVertex>{7, 4, 1, 8, 5, 2, 9, 6}));
    EXPECT_NEAR(skin.weights[0][0], 10.0f / 52, 1e-6f);
    float sum = 0;
    for (const float weight : skin.weights[0]) sum += weight;
    EXPECT_NEAR(sum, 1.0f, 1e-6f);
    EXPECT_TRUE(validate(skin, 10));
    EXPECT_FALSE(validate(skin, 9)) << "bone 9 does not exist";
    const FourWeights four = strongestFour(skin, 0);
    EXPECT_EQ(four.bones, (std::array<std::uint32_t, 4>{7, 4, 1, 8}));
    EXPECT_NEAR(four.weights[3], 7.0f / 34, 1e-6f);
    setStrongest(skin, 0, {{1, 0.1f}, {2, 0.4f}, {3, 0.05f}, {4, 0.2f}, {5, 0.3f}}, 4);
    EXPECT_EQ(skin.bones[0], (std::array<std::uint32_t, kBonesOfVertex>{2, 5, 4, 1}));
    EXPECT_NEAR(skin.weights[0][0], 0.4f, 1e-6f);
    setStrongest(skin, 0, {});
    EXPECT_EQ(skin.weights[0], (std::array<float, kBonesOfVertex>{}));
    EXPECT_TRUE(validate(skin, 0));
    EXPECT_EQ(strongestFour(skin, 0).weights, (std::array<float, 4>{}));
}

TEST(SkinWeights, ValidationRefusesWhatIsNoWeight) {
    for (const float bad : {-0.5f, std::numeric_limits<float>::quiet_NaN(), 0.5f}) {
        EXPECT_FALSE(validate(SkinWeights{{{}}, {{bad, 0, 0, 0}}}, 1)) << bad;
    }
}

}  // namespace
}  // namespace hairloom
