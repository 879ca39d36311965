// SPDX-License-Identifier: GPL-3.0-or-later
// Streaks and the mask of the dye.
#include <gmock/gmock.h>

#include <algorithm>
#include <numeric>

#include "core/base/random.h"
#include "core/groom/point_dye.h"
#include "core/groom/streaks.h"
#include "core/groom/validate.h"
#include "core/operations/dye.h"
#include "tests/groom/groom_samples.h"

namespace hairloom {
namespace {

std::vector<Vec3f> rootsOnADisc(std::size_t count, float radius) {
    Random random(4);
    std::vector<Vec3f> roots;
    while (roots.size() < count) {
        const Vec3f p(random.uniform(-radius, radius), 0, random.uniform(-radius, radius));
        if (p.norm() < radius) roots.push_back(p);
    }
    return roots;
}

float mean(const std::vector<float>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0f) / static_cast<float>(values.size());
}

TEST(Streaks, TakeTheirShareOfTheStrands) {
    const auto roots = rootsOnADisc(4000, 0.15f);
    HairMaterial material;
    EXPECT_TRUE(streakWeights(material, roots).empty());
    for (const float share : {0.2f, 0.5f, 0.8f}) {
        material.streakShare = share;
        EXPECT_NEAR(mean(streakWeights(material, roots)), share, 0.07f);
    }
    material.streakShare = 1;
    EXPECT_EQ(mean(streakWeights(material, roots)), 1.0f);
}

TEST(Streaks, AreAsWideAsTheyShallBe) {
    HairMaterial material;
    material.streakShare = 0.5f;
    material.streakSoftness = 0;
    material.streakWidth = 0.02f;
    const auto roots = rootsOnADisc(2000, 0.1f);
    const auto weights = streakWeights(material, roots);
    // Roots a tenth of the width apart are in the same; those three widths apart know nothing of each other.
    double near = 0, nearSame = 0, far = 0, farSame = 0;
    for (std::size_t i = 0; i < roots.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            const float distance = (roots[i] - roots[j]).norm() / material.streakWidth;
            const bool same = weights[i] == weights[j];
            if (distance < 0.1f) near += 1, nearSame += same ? 1 : 0;
            if (distance > 3) far += 1, farSame += same ? 1 : 0;
        }
    }
    EXPECT_GT(nearSame / near, 0.9);
    EXPECT_NEAR(farSame / far, 0.5, 0.06);
}

TEST(Streaks, SoftnessFadesTheBorderAndSeedsMoveIt) {
    HairMaterial material;
    material.streakShare = 0.4f;
    const auto roots = rootsOnADisc(1500, 0.1f);
    const auto between = [&](float softness) {
        material.streakSoftness = softness;
        const auto weights = streakWeights(material, roots);
        return std::ranges::count_if(weights, [](float w) { return w > 0 && w < 1; });
    };
    EXPECT_EQ(between(0), 0);
    EXPECT_LT(between(0.2f), between(0.6f));
    EXPECT_LT(between(0.6f), between(1));
    const auto here = streakWeights(material, roots);
    EXPECT_EQ(here, streakWeights(material, roots));
    material.streakSeed = 2;
    EXPECT_NE(here, streakWeights(material, roots));
}

TEST(Dye, MasksABallOfRoots) {
    const auto scalp = sphereScalp();
    Groom groom = straightHair(scalp, 300, 3, 0.1f);
    const Vec3f centre = groom.strand(7)[0];
    DyeSettings settings;
    settings.centre = centre;
    settings.radius = 0.05f;
    settings.softness = 0;
    settings.amount = 0.75f;
    const auto changed = dye(groom, settings);
    ASSERT_TRUE(changed);
    const auto mask = groom.strandAttributes.view<float>(attribute::kDye);
    ASSERT_EQ(mask.size(), 300u);
    std::size_t inside = 0;
    for (std::size_t s = 0; s < mask.size(); ++s) {
        const bool in = (groom.strand(s)[0] - centre).norm() <= 0.05f;
        EXPECT_EQ(mask[s], in ? 0.75f : 0.0f) << s;
        inside += in ? 1 : 0;
    }
    EXPECT_EQ(*changed, inside);
    EXPECT_GT(inside, 0u);
    EXPECT_LT(inside, 300u);

    groom.strandAttributes.set(attribute::kFrozen, std::vector<std::uint8_t>(300, 1));
    const Version before = groom.strandAttributes.version(attribute::kDye);
    EXPECT_EQ(dye(groom, {}), 0u) << "frozen strands stay as they are";
    EXPECT_EQ(groom.strandAttributes.version(attribute::kDye), before);
    settings.amount = 2;
    EXPECT_FALSE(dye(groom, settings));
}

TEST(Dye, ReachesPaintedPoints) {
    Groom groom = straightHair(sphereScalp(), 50, 4, 0.1f);
    EXPECT_EQ(pointDyes(groom), std::vector<float>(200, 0.0f));
    groom.material.dyeStrength = 0.5f;
    EXPECT_EQ(pointDyes(groom), std::vector<float>(200, 1.0f));
    groom.strandAttributes.set(attribute::kDye, std::vector<float>(50, 0.25f));
    EXPECT_EQ(pointDyes(groom), std::vector<float>(200, 0.25f));
    std::vector<float> painted(200, 0.0f);
    for (std::size_t p = 0; p < 200; p += 4) painted[p] = 1;
    groom.pointAttributes.set(attribute::kPointDye, painted);
    EXPECT_EQ(pointDyes(groom), painted);

    DyeSettings settings;
    settings.amount = 0.5f;
    EXPECT_EQ(dye(groom, settings), 50u);
    EXPECT_EQ(pointDyes(groom), std::vector<float>(200, 0.5f));
    EXPECT_EQ(dye(groom, settings), 0u);
    EXPECT_FALSE(hasErrors(validate(groom)));
    groom.pointAttributes.edit<float>(attribute::kPointDye)[7] = 1.5f;
    EXPECT_TRUE(hasErrors(validate(groom)));
}

}  // namespace
}  // namespace hairloom
