// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/skin_field.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/base/parallel.h"
#include "tests/geometry/test_meshes.h"
#include "tests/groom/groom_samples.h"

namespace hairloom {
namespace {

std::shared_ptr<const ScalpMesh> boxScalp() {
    PolygonSoup box;
    for (const float x : {-0.05f, 0.05f})
        for (const float y : {-0.05f, 0.05f})
            for (const float z : {-0.05f, 0.05f}) box.positions.emplace_back(x, y, z);
    for (const auto& quad : {std::array<std::uint32_t, 4>{0, 1, 3, 2},
                             {4, 6, 7, 5},
                             {0, 4, 5, 1},
                             {2, 3, 7, 6},
                             {0, 2, 6, 4},
                             {1, 5, 7, 3}}) {
        box.corners.insert(box.corners.end(), quad.begin(), quad.end());
        box.offsets.push_back(static_cast<std::uint32_t>(box.corners.size()));
    }
    return std::make_shared<const ScalpMesh>(test::meshOf(box));
}

TEST(SkinField, IsNearTheExactDistanceWhereItIsAskedFor) {
    const auto skin = std::make_shared<const Skin>(sphereScalp(0.09f, 4, Vec3f::Zero()));
    const SkinField field(skin);
    Random random(1);
    int near = 0;
    for (int i = 0; i < 4000; ++i) {
        const Vec3f point = test::randomPoint(random, 0.12f);
        const Skin::Sample exact = skin->at(point);
        const SkinDistance quick = field.distanceAt(point);
        const SkinDistance upTo = field.distanceUpTo(point, 0.001f);
        if (upTo.distance > 0.001f) {
            EXPECT_LE(upTo.distance, quick.distance + 1e-5f);
        } else {
            EXPECT_EQ(upTo.distance, quick.distance);
            EXPECT_EQ(upTo.outward, quick.outward);
        }
        if (std::abs(exact.distance) < SkinField::kReach) {
            ++near;
            EXPECT_NEAR(quick.distance, exact.distance, 1e-4f);
            EXPECT_GT(quick.outward.dot(exact.outward), 0.98f);
            EXPECT_NEAR(quick.outward.norm(), 1, 1e-5f);
        } else if (exact.distance > 0) {
            EXPECT_GE(quick.distance, SkinField::kReach - 1e-4f);
            EXPECT_LE(quick.distance, exact.distance + 1e-4f);
        } else {
            EXPECT_LT(quick.distance, -SkinField::kReach + 1e-4f);
        }
    }
    EXPECT_GT(near, 300);
}

TEST(SkinField, MissesSharpEdgesByLessThanAThirdOfACell) {
    const auto skin = std::make_shared<const Skin>(boxScalp());
    ASSERT_LT(skin->at(Vec3f::Zero()).distance, 0);
    const SkinField field(skin);
    Random random(2);
    float worst = 0;
    for (int i = 0; i < 6000; ++i) {
        const Vec3f point = test::randomPoint(random, 0.058f);
        const float exact = skin->at(point).distance;
        if (std::abs(exact) < 0.5f * SkinField::kReach)
            worst = std::max(worst, std::abs(field.distanceAt(point).distance - exact));
    }
    EXPECT_LT(worst, SkinField::kCell / 3);
    EXPECT_GT(worst, 1e-6f);
}

/// The shortcut against the whole question: beside and within the table, deep inside, at the edges of cells,
/// at what is no number.
TEST(SkinField, AnswersUpToADistanceAsItAnswersAtAll) {
    const auto skin = std::make_shared<const Skin>(sphereScalp(0.09f, 3, Vec3f::Zero()));
    const SkinField field(skin);
    Random random(7);
    int near = 0, enoughs = 0;
    for (int i = 0; i < 6000; ++i) {
        Vec3f point = test::randomPoint(random, i % 5 == 0 ? 0.3f : 0.11f);
        if (i % 7 == 0) point = 0.002f * (point / 0.002f).array().round().matrix();
        const float enough = random.uniform(-0.03f, 0.03f);
        const SkinDistance whole = field.distanceAt(point);
        const SkinDistance upTo = field.distanceUpTo(point, enough);
        if (upTo.distance > enough) {
            ++enoughs;
            ASSERT_GT(whole.distance, enough - 1e-6f);
        } else {
            ++near;
            ASSERT_EQ(upTo.distance, whole.distance);
            ASSERT_EQ(upTo.outward, whole.outward);
        }
    }
    EXPECT_GT(near, 500);
    EXPECT_GT(enoughs, 500);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
        Vec3f nowhere(0, 0.09f, 0);
        nowhere[axis] = nan;
        EXPECT_FALSE(field.distanceUpTo(nowhere, 0.001f).distance < 0.001f);
        nowhere[axis] = 1e30f;
        EXPECT_GT(field.distanceUpTo(nowhere, 0.001f).distance, 0.001f);
    }
}

/// What a search could find is never nearer than the field says.
TEST(SkinField, ScreensOutNoPointThatIsNear) {
    const auto skin = std::make_shared<const Skin>(boxScalp());
    const SkinField field(skin);
    const ScreenedSkin screened(field);
    Random random(9);
    int spared = 0, searched = 0;
    for (int i = 0; i < 20000; ++i) {
        Vec3f point = test::randomPoint(random, i % 5 == 0 ? 0.3f : 0.06f);
        if (i % 7 == 0) point = 0.002f * (point / 0.002f).array().round().matrix();
        const float enough = random.uniform(0, 0.008f);
        const SkinDistance exact = skin->distanceAt(point);
        const SkinDistance answer = screened.distanceUpTo(point, enough);
        EXPECT_EQ(screened.distanceAt(point).distance, exact.distance);
        if (answer.distance == exact.distance && answer.outward == exact.outward) {
            ++searched;
        } else {
            ++spared;
            ASSERT_GT(answer.distance, enough);
            ASSERT_LE(answer.distance, exact.distance + 1e-6f);
        }
    }
    EXPECT_GT(spared, 2000);
    EXPECT_GT(searched, 2000);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(screened.distanceUpTo(Vec3f(nan, 0, 0), 0.001f).distance < 0.001f);
}

TEST(SkinField, AnswersAlikeForAnyNumberOfThreadsAndOrder) {
    const auto skin = std::make_shared<const Skin>(sphereScalp(0.09f, 3, Vec3f::Zero()));
    constexpr std::size_t kPoints = 2000;
    std::vector<float> first(kPoints), second(kPoints);
    const auto ask = [&](const SkinField& field, std::vector<float>& answers, bool backwards) {
        parallelFor(kPoints, 16, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const std::size_t k = backwards ? kPoints - 1 - i : i;
                Random random(3, k);
                answers[k] = field.distanceAt(test::randomPoint(random, 0.11f)).distance;
            }
        });
    };
    setThreadCount(1);
    ask(SkinField(skin), first, false);
    setThreadCount(4);
    const SkinField field(skin);
    std::vector<std::uint32_t> faces(100);
    std::iota(faces.begin(), faces.end(), 0u);
    field.prepare(faces);
    ask(field, second, true);
    setThreadCount(0);
    EXPECT_EQ(first, second);
}

TEST(SkinField, GrowsItsCellsOnLargeMeshes) {
    const auto skin = std::make_shared<const Skin>(sphereScalp(4.0f, 2, Vec3f::Zero()));
    const SkinField field(skin);
    EXPECT_GT(field.cell(), 2 * SkinField::kCell);
    EXPECT_NEAR(field.distanceAt(Vec3f(0, 4.001f, 0)).distance, skin->at(Vec3f(0, 4.001f, 0)).distance,
                2e-3f);
}

}  // namespace
}  // namespace hairloom
