// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/live/head_tint.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/groom/strand_subset.h"
#include "tests/documents/small_head.h"

namespace hairloom {
namespace {

const Vec3f kSkin(0.5f, 0.4f, 0.3f);

std::vector<Vec3f> tintedHead(const Groom& groom) {
    return tinted(kSkin, groom.material.rootColour, headTint(groom));
}

/// Share of the hair's colour at a vertex, from its red.
float shareAt(const Groom& groom, const std::vector<Vec3f>& albedo, std::size_t vertex) {
    return (albedo[vertex].x() - kSkin.x()) / (groom.material.rootColour.x() - kSkin.x());
}

TEST(HeadTint, IsHalfWhereHairGrowsAndFadesBesideIt) {
    const Groom groom = smallHead();
    const auto albedo = tintedHead(groom);
    ASSERT_EQ(albedo.size(), groom.scalp->vertexCount());
    std::size_t between = 0;
    for (std::size_t v = 0; v < albedo.size(); ++v) {
        const float y = groom.scalp->positions()[v].y(), share = shareAt(groom, albedo, v);
        EXPECT_GE(share, 0);
        EXPECT_LE(share, 0.5f + 1e-6f);
        if (y > 0.07f) {
            EXPECT_GT(share, 0.45f) << "amid the roots, which begin at 3 cm";
        } else if (y < -0.05f) {
            EXPECT_EQ(share, 0) << "eight centimetres from the nearest root";
        }
        between += share > 0.05f && share < 0.45f;
    }
    EXPECT_GT(between, 0u) << "the border is no edge";
}

TEST(HeadTint, DoesNotDependOnTheNumberOfRoots) {
    const Groom many = smallHead();
    std::vector<std::uint32_t> some;
    for (std::uint32_t s = 0; s < many.strandCount(); s += 2) some.push_back(s);
    const Groom few = strandsOf(many, some);
    const auto a = tintedHead(many), b = tintedHead(few);
    for (std::size_t v = 0; v < a.size(); ++v)
        if (many.scalp->positions()[v].y() > 0.08f) {
            EXPECT_NEAR(shareAt(many, a, v), shareAt(few, b, v), 0.15f) << v;
        }
}

TEST(HeadTint, StrandsThatShareTheirRootsAreNoDivisionByZero) {
    const Groom groom = smallHead();
    std::vector<std::uint32_t> tufts;
    for (std::uint32_t s = 0; s < 40; ++s) tufts.push_back(s / 10);
    for (const Vec3f& albedo : tintedHead(strandsOf(groom, tufts))) ASSERT_TRUE(albedo.allFinite());
}

TEST(HeadTint, LeavesTheSkinWhereHairIsTooFewOrFarAway) {
    Groom groom = smallHead();
    const std::vector<Vec3f> bare(groom.scalp->vertexCount(), kSkin);
    EXPECT_EQ(tintedHead(strandsOf(groom, std::vector<std::uint32_t>{0, 1, 2})), bare);
    EXPECT_EQ(tintedHead(strandsOf(groom, {})), bare);
    groom.scalpSelection = {};
    EXPECT_EQ(tintedHead(groom), bare) << "hair that grows on no scalp";
    groom = smallHead();
    std::vector<Vec3f> away(groom.positions().begin(), groom.positions().end());
    for (Vec3f& point : away) point *= 1e6f;
    groom.pointAttributes.set(attribute::kPosition, std::move(away));
    EXPECT_EQ(tintedHead(groom), bare);
}

}  // namespace
}  // namespace hairloom
