// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <limits>

#include "core/groom/validate.h"
#include "tests/groom/groom_samples.h"

namespace hairloom {
namespace {

constexpr float kLength = 0.2f;

FaceSet upperHalf(const ScalpMesh& scalp) {
    FaceSet faces;
    for (std::uint32_t t = 0; t < scalp.triangleCount(); ++t)
        if (scalp.triangleNormal(t).y() > 0) faces.push_back(t);
    return faces;
}

/// One root in the middle of each face, beginning with `first`.
std::vector<SurfacePoint> middlesOf(const FaceSet& faces, std::size_t count, std::size_t first = 0) {
    std::vector<SurfacePoint> roots;
    for (std::size_t i = 0; i < count; ++i) roots.push_back({faces[first + i], Vec3f::Constant(1.0f / 3)});
    return roots;
}

TEST(Grow, StrandsStandStraightAndEvenOnTheScalpsNormals) {
    const auto scalp = sphereScalp();
    const FaceSet faces = upperHalf(*scalp);
    const auto roots = middlesOf(faces, 40);
    constexpr std::uint32_t kPoints = 7;
    const Result<Groom> groom = growStraight(scalp, faces, roots, kLength, kPoints);
    ASSERT_TRUE(groom) << groom.error().message();
    ASSERT_EQ(groom->strandCount(), roots.size());
    EXPECT_EQ(groom->scalp, scalp);
    EXPECT_EQ(groom->scalpSelection, faces);
    const auto ids = groom->strandAttributes.view<std::uint32_t>(attribute::kStrandId);
    const auto uvs = groom->strandAttributes.view<Vec2f>(attribute::kRootUv);
    const auto bindings = groom->rootBindings();
    ASSERT_EQ(bindings.size(), roots.size());
    for (std::uint32_t s = 0; s < roots.size(); ++s) {
        EXPECT_EQ(ids[s], s);
        EXPECT_EQ(bindings[s].triangle, roots[s].triangle);
        // On this sphere the normals are the directions from its centre at the corners, interpolated.
        const Triangle& corners = scalp->triangles()[roots[s].triangle];
        Vec3d root = Vec3d::Zero(), normal = Vec3d::Zero();
        for (const std::uint32_t c : corners) {
            root += scalp->positions()[c].cast<double>() / 3;
            normal += (scalp->positions()[c] - Vec3f(0, 1.6f, 0)).cast<double>();
        }
        normal.normalize();
        const auto strand = groom->strand(s);
        ASSERT_EQ(strand.size(), kPoints);
        for (std::uint32_t p = 0; p < kPoints; ++p) {
            const Vec3d expected = root + normal * (double{kLength} * p / (kPoints - 1));
            EXPECT_LT((strand[p].cast<double>() - expected).norm(), 1e-6);
        }
        Vec2d uv = Vec2d::Zero();
        for (std::size_t c = 0; c < 3; ++c)
            uv += scalp->cornerUvs()[3 * std::size_t{roots[s].triangle} + c].cast<double>() / 3;
        EXPECT_LT((uvs[s].cast<double>() - uv).norm(), 1e-6);
    }
}

TEST(Grow, RadiiTaperAsTheMaterialSays) {
    const auto scalp = sphereScalp();
    const FaceSet faces = upperHalf(*scalp);
    const Result<Groom> groom = growStraight(scalp, faces, middlesOf(faces, 2), kLength, 3);
    ASSERT_TRUE(groom);
    const auto radii = groom->pointAttributes.view<float>(attribute::kRadius);
    const float root = groom->material.rootRadius, tip = root * groom->material.tipScale;
    ASSERT_EQ(radii.size(), 6u);
    for (const std::size_t first : {0u, 3u}) {
        EXPECT_FLOAT_EQ(radii[first], root);
        EXPECT_FLOAT_EQ(radii[first + 1], (root + tip) / 2);
        EXPECT_FLOAT_EQ(radii[first + 2], tip);
    }
}

TEST(Grow, RootsAreTriangulatedWhereTheyCanBe) {
    const auto scalp = sphereScalp();
    const FaceSet faces = upperHalf(*scalp);
    const Result<Groom> many = growStraight(scalp, faces, middlesOf(faces, faces.size()), kLength, 4);
    ASSERT_TRUE(many);
    EXPECT_GT(many->triangulation.triangles.size(), faces.size());
    EXPECT_TRUE(many->triangulation.alone.empty());
    for (const std::size_t count : {1u, 2u}) {
        const Result<Groom> few = growStraight(scalp, faces, middlesOf(faces, count), kLength, 4);
        ASSERT_TRUE(few) << few.error().message();
        EXPECT_EQ(few->strandCount(), count);
        EXPECT_TRUE(few->triangulation.triangles.empty());
        EXPECT_EQ(few->triangulation.alone.size(), count);
        EXPECT_FALSE(hasErrors(validate(*few)));
    }
    // Three strands on one place make no triangle either.
    const std::vector<SurfacePoint> same(3, middlesOf(faces, 1).front());
    const Result<Groom> tuft = growStraight(scalp, faces, same, kLength, 4);
    ASSERT_TRUE(tuft) << tuft.error().message();
    EXPECT_EQ(tuft->strandCount(), 3u);
    EXPECT_EQ(tuft->triangulation.coincident.size(), 2u);
    EXPECT_EQ(tuft->triangulation.alone, std::vector<std::uint32_t>{0});
}

TEST(Grow, WhatCannotBeGrownIsRefused) {
    const auto scalp = sphereScalp();
    const FaceSet faces = upperHalf(*scalp);
    const auto roots = middlesOf(faces, 5);
    EXPECT_FALSE(growStraight(nullptr, faces, roots, kLength, 4));
    EXPECT_FALSE(growStraight(scalp, {}, roots, kLength, 4));
    for (const float length :
         {0.0f, -1.0f, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
        EXPECT_FALSE(growStraight(scalp, faces, roots, length, 4)) << length;
    }
    EXPECT_FALSE(growStraight(scalp, faces, roots, kLength, 1));
    EXPECT_FALSE(growStraight(scalp, faces, roots, kLength, 0xffffffffu))
        << "more points than can be counted";
    auto beside = roots;
    beside[3].triangle = static_cast<std::uint32_t>(scalp->triangleCount());
    EXPECT_FALSE(growStraight(scalp, faces, beside, kLength, 4));
    FaceSet others(faces.begin() + 5, faces.end());
    const Result<Groom> outside = growStraight(scalp, others, roots, kLength, 4);
    ASSERT_FALSE(outside);
    EXPECT_NE(outside.error().message().find("root 0"), std::string::npos) << outside.error().message();
}

}  // namespace
}  // namespace hairloom
