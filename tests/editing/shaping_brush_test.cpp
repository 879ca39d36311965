// SPDX-License-Identifier: GPL-3.0-or-later
// What each brush is for that gives hair another shape: straight, curled, uneven, in locks, parted, level.

#include "core/operations/curl.h"
#include "tests/editing/editing_samples.h"

namespace hairloom::editing {
namespace {

/// Sum of the angles between segments, radians.
float bendOf(std::span<const Vec3f> points) {
    float sum = 0;
    for (std::size_t i = 2; i < points.size(); ++i) {
        const Vec3f a = (points[i - 1] - points[i - 2]).normalized(),
                    b = (points[i] - points[i - 1]).normalized();
        sum += std::acos(std::clamp(a.dot(b), -1.0f, 1.0f));
    }
    return sum;
}

Stroke overAll(const TopStrand& top, std::string_view tool, std::size_t dabs) {
    Stroke stroke = top.at(tool, {});
    stroke.settings.radius = 0.3f;
    stroke.settings.falloff = BrushCurve::falloff("constant");
    for (std::size_t i = 0; i < dabs; ++i) stroke.dabs.push_back(dabAt(stroke.settings, top.points()[8]));
    return stroke;
}

TEST(Straighten, TakesTheCurlsOutThatCurlWound) {
    TopStrand top;
    EXPECT_LT(bendOf(top.points()), 1e-2f);
    ASSERT_TRUE(top.document.replay(overAll(top, "curl", 1)));
    const float curled = bendOf(top.points());
    EXPECT_GT(curled, 3.0f);
    ASSERT_TRUE(top.document.replay(overAll(top, "straighten", 6)));
    EXPECT_LT(bendOf(top.points()), 0.3f * curled);
}

TEST(Curl, MoreDabsOfAStrokeWindNoTighter) {
    TopStrand once, often;
    ASSERT_TRUE(once.document.replay(overAll(once, "curl", 1)));
    ASSERT_TRUE(often.document.replay(overAll(often, "curl", 5)));
    EXPECT_NEAR(bendOf(often.points()), bendOf(once.points()), 0.05f * bendOf(once.points()));
}

TEST(Curl, InvertedWindsTheOtherWay) {
    TopStrand left, right;
    Stroke stroke = overAll(right, "curl", 1);
    stroke.settings.collide = false;
    stroke.settings.parameters = {{"variation", 0}};
    ASSERT_TRUE(right.document.replay(stroke));
    stroke.settings.invert = true;
    ASSERT_TRUE(left.document.replay(stroke));
    // The sign of the torsion of a few segments tells the hand.
    const auto hand = [](std::span<const Vec3f> p) {
        double sum = 0;
        for (std::size_t i = 3; i < p.size(); ++i)
            sum += static_cast<double>((p[i - 2] - p[i - 3]).cross(p[i - 1] - p[i - 2]).dot(p[i] - p[i - 1]));
        return sum;
    };
    EXPECT_LT(hand(left.points()) * hand(right.points()), 0);
}

TEST(Noise, BendsNeighboursDifferently) {
    TopStrand top;
    const Groom before = top.document.groom();
    ASSERT_TRUE(top.document.replay(overAll(top, "noise", 1)));
    std::vector<Vec3f> moves;
    for (std::size_t s = 0; s < 300; ++s)
        moves.push_back(top.document.groom().strand(s)[15] - before.strand(s)[15]);
    for (std::size_t s = 1; s < 300; ++s) EXPECT_GT((moves[s] - moves[s - 1]).norm(), 1e-5f);
    EXPECT_GT(bendOf(top.points()), 0.2f);
}

/// Mean distance of the tips near the top from their middle, metres.
float spreadOfTips(const Groom& groom, const std::vector<std::size_t>& strands) {
    Vec3f middle = Vec3f::Zero();
    for (const std::size_t s : strands) middle += groom.strand(s)[15] / static_cast<float>(strands.size());
    float sum = 0;
    for (const std::size_t s : strands) sum += (groom.strand(s)[15] - middle).norm();
    return sum / static_cast<float>(strands.size());
}
std::vector<std::size_t> strandsNearTop(const TopStrand& top) {
    std::vector<std::size_t> strands;
    for (std::size_t s = 0; s < 300; ++s) {
        if ((top.document.groom().strand(s)[8] - top.points()[8]).norm() < 0.03f) strands.push_back(s);
    }
    return strands;
}

TEST(Clump, GathersTipsAndSpreadsThem) {
    TopStrand top;
    const auto near = strandsNearTop(top);
    ASSERT_GT(near.size(), 3u);
    const float before = spreadOfTips(top.document.groom(), near);
    Stroke stroke = top.at("clump", {top.points()[8]}, 0.05f);
    ASSERT_TRUE(top.document.replay(stroke));
    EXPECT_LT(spreadOfTips(top.document.groom(), near), 0.6f * before);
    ASSERT_TRUE(top.document.undo());
    stroke.settings.invert = true;
    stroke.settings.strength = stroke.dabs[0].strength = 0.3f;
    ASSERT_TRUE(top.document.replay(stroke));
    EXPECT_GT(spreadOfTips(top.document.groom(), near), before);
}

TEST(Twist, TurnsTipsAboutTheMiddleOfTheLock) {
    TopStrand top;
    const Groom before = top.document.groom();
    const auto near = strandsNearTop(top);
    for (const bool invert : {false, true}) {
        Stroke stroke = top.at("twist", {top.points()[8]}, 0.05f);
        stroke.settings.invert = invert;
        ASSERT_TRUE(top.document.replay(stroke));
        // Seen from above, hair about the top turns one way.
        float turned = 0;
        for (const std::size_t s : near) {
            const Vec3f from = before.strand(s)[15] - top.points()[15];
            const Vec3f to = top.document.groom().strand(s)[15] - top.points()[15];
            if (s != top.strand) turned += (from.cross(to)).y() > 0 ? 1.0f : -1.0f;
        }
        EXPECT_GT(turned * (invert ? -1.0f : 1.0f), 0.5f * static_cast<float>(near.size() - 1));
        ASSERT_TRUE(top.document.undo());
    }
}

TEST(Part, LaysHairToTheSideOfItsRoot) {
    TopStrand top;
    Stroke stroke = top.at("part", {}, 0.06f);
    for (int pass = 0; pass < 2; ++pass) {
        for (int i = -6; i <= 6; ++i) {
            const Vec3f out(0, 1, 0.08f * static_cast<float>(i));
            stroke.dabs.push_back(dabAt(stroke.settings, kHeadCentre + kHeadRadius * out.normalized()));
        }
    }
    ASSERT_TRUE(top.document.replay(stroke));
    std::size_t parted = 0;
    for (std::size_t s = 0; s < 300; ++s) {
        const auto now = top.document.groom().strand(s);
        if (std::abs(now[0].x()) > 0.03f || std::abs(now[0].x()) < 0.004f || now[0].y() < 1.67f) continue;
        EXPECT_GT((now[15].x() - now[0].x()) * now[0].x(), 0) << "strand " << s << " crosses the parting";
        ++parted;
    }
    EXPECT_GT(parted, 10u);
    EXPECT_GT(nearestToSkin(top.document.groom()), 1e-4f);
}

TEST(Mirror, GivesTheShapeOfTheOtherSideAndLeavesThatAlone) {
    TopStrand top;
    const Vec3f right(0.06f, 0.12f, 0);
    Stroke comb = top.at("comb", {}, 0.05f);
    for (int i = 0; i < 6; ++i)
        comb.dabs.push_back(
            dabAt(comb.settings, kHeadCentre + right + Vec3f(0, 0, 0.006f * static_cast<float>(i))));
    ASSERT_TRUE(top.document.replay(comb));
    const Groom combed = top.document.groom();
    Stroke mirror = top.at("mirror", {kHeadCentre + Vec3f(-right.x(), right.y(), 0)}, 0.05f);
    mirror.settings.falloff = BrushCurve::falloff("constant");
    ASSERT_TRUE(top.document.replay(mirror));
    float forward = 0;
    std::size_t moved = 0;
    for (std::size_t s = 0; s < 300; ++s) {
        const auto was = combed.strand(s), now = top.document.groom().strand(s);
        if (was[0].x() > 0.03f) {
            EXPECT_TRUE(std::equal(was.begin(), was.end(), now.begin()));
        }
        if (was[15] == now[15]) continue;
        forward += now[15].z() - was[15].z();
        ++moved;
    }
    ASSERT_GT(moved, 5u);
    EXPECT_GT(forward / static_cast<float>(moved), 0.002f) << "as the combed side leads";
}

TEST(Level, BringsTipsToWhereTheStrokeBegan) {
    for (const float height : {0.06f, 0.15f}) {
        TopStrand top;
        const Vec3f begin = top.points()[0] + Vec3f(0, height, 0);
        Stroke stroke = top.at("level", {begin, begin + Vec3f(0, -0.03f, 0)}, 0.2f);
        stroke.settings.falloff = BrushCurve::falloff("constant");
        ASSERT_TRUE(top.document.replay(stroke));
        EXPECT_NEAR(top.points()[15].y(), begin.y(), 1e-4f);
        stroke.settings.parameters = {{"grow", 0}};
        ASSERT_TRUE(top.document.undo());
        ASSERT_TRUE(top.document.replay(stroke));
        EXPECT_NEAR(top.length(), std::min(height, 0.12f), 1e-3f) << "nothing grows where that is not wished";
    }
}

}  // namespace
}  // namespace hairloom::editing
