// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cards/cap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include "core/cards/cap_fit.h"
#include "core/cards/rig.h"
#include "tests/cards/card_samples.h"

namespace hairloom::cards {
namespace {

constexpr float kBall = 0.1f;  // metres, radius of the ball that samples stand on
constexpr float kTolerance = 0.0003f;
constexpr float kShownLength = 0.012f;  // metres of a hair

std::vector<CapChart> capOf(const Hair& hair, float tolerance) {
    auto cap = makeCap(hair, tolerance, nullptr);
    EXPECT_TRUE(cap);
    return cap ? std::move(*cap) : std::vector<CapChart>{};
}

/// Where a line from the middle of the ball meets a triangle, as a factor; negative: nowhere.
float hit(const Vec3f& direction, const Vec3f& a, const Vec3f& b, const Vec3f& c) {
    Eigen::Matrix3f columns;
    columns << a, b, c;
    const Vec3f shares = columns.fullPivLu().solve(direction);
    constexpr float kEdge = -1e-4f;
    return shares.minCoeff() < kEdge ? -1 : 1 / shares.sum();
}

/// Distances from the middle at which the cap lies in a direction.
std::vector<float> distances(const std::vector<CapChart>& cap, const Vec3f& direction) {
    std::vector<float> found;
    for (const CapChart& chart : cap) {
        for (std::size_t i = 0; i + 2 < chart.indices.size(); i += 3) {
            const auto at = [&](std::size_t k) { return chart.vertices[chart.indices[i + k]].position_ws; };
            const float distance = hit(direction, at(0), at(1), at(2));
            if (distance > 0) found.push_back(distance);
        }
    }
    return found;
}

TEST(Cap, LiesJustAboveTheSkinAtAllRoots) {
    const Hair hair = ballHair(1500);
    const auto cap = capOf(hair, kTolerance);
    for (std::size_t s = 0; s < hair.strandCount(); ++s) {
        const auto found = distances(cap, hair.rootNormals_ws[s]);
        ASSERT_FALSE(found.empty()) << "no seam at root " << s;
        for (const float distance : found) {
            EXPECT_GT(distance, kBall) << "skin does not show through at root " << s;
            EXPECT_LT(distance, kBall + 0.003f) << "no flap at root " << s;
        }
    }
}

TEST(Cap, FacesOutwards) {
    for (const CapChart& chart : capOf(ballHair(1500), kTolerance)) {
        for (std::size_t i = 0; i + 2 < chart.indices.size(); i += 3) {
            const auto at = [&](std::size_t k) { return chart.vertices[chart.indices[i + k]].position_ws; };
            EXPECT_GT((at(1) - at(0)).cross(at(2) - at(0)).dot(at(0)), 0);
        }
        for (const CapChart::Vertex& v : chart.vertices)
            EXPECT_GT(v.normal_ws.dot(v.position_ws.normalized()), 0.9f);
    }
}

TEST(Cap, DoesNotHangBetweenSkinAndSkinBehindIt) {
    Hair hair = ballHair(1500);
    const Hair front = hair;
    const Vec3f behind(0, 0, -0.3f);
    const auto points = static_cast<std::uint32_t>(front.positions_ws.size());
    for (std::size_t s = 1; s < front.offsets.size(); ++s) hair.offsets.push_back(points + front.offsets[s]);
    for (const Vec3f& point : front.positions_ws) hair.positions_ws.push_back(point + behind);
    hair.radii.insert(hair.radii.end(), front.radii.begin(), front.radii.end());
    hair.albedo.insert(hair.albedo.end(), front.albedo.begin(), front.albedo.end());
    hair.rootNormals_ws.insert(hair.rootNormals_ws.end(), front.rootNormals_ws.begin(),
                               front.rootNormals_ws.end());
    for (const CapChart& chart : capOf(hair, kTolerance)) {
        for (const std::uint32_t index : chart.indices) {
            const Vec3f& at = chart.vertices[index].position_ws;
            const float off = std::min(std::abs(at.norm() - kBall), std::abs((at - behind).norm() - kBall));
            ASSERT_LT(off, 0.01f) << "a flap at " << at.transpose();
        }
    }
}

TEST(Cap, IsOfFewerTrianglesFartherAway) {
    const auto triangles = [](float tolerance) {
        std::size_t count = 0;
        for (const CapChart& chart : capOf(ballHair(1500), tolerance)) count += chart.indices.size() / 3;
        return count;
    };
    EXPECT_GT(triangles(0.0003f), 2 * triangles(0.0012f));
}

TEST(Cap, StopsWhenItIsCancelled) {
    const std::atomic<bool> cancel{true};
    EXPECT_FALSE(makeCap(ballHair(1500), kTolerance, &cancel));
}

/// Strands of 20 mm on the plane y = 0, `lean` radians off its normal, all one way.
Hair uprightHair(std::uint32_t strands, float lean) {
    Hair hair;
    const Vec3f way(0, std::cos(lean), std::sin(lean));
    for (std::uint32_t s = 0; s < strands; ++s) {
        for (const float along : {0.0f, 0.01f, 0.02f}) {
            hair.positions_ws.emplace_back(Vec3f(0.002f * static_cast<float>(s), 0, 0) + along * way);
            hair.radii.push_back(0.0001f), hair.albedo.emplace_back(0.2f, 0.1f, 0.05f);
        }
        hair.offsets.push_back(static_cast<std::uint32_t>(hair.positions_ws.size()));
        hair.rootNormals_ws.emplace_back(0, 1, 0);
    }
    return hair;
}

TEST(Cap, HoldsHairThatStandsUpAsFarAsItHidesSkin) {
    constexpr std::uint32_t kStrands = 40;
    const Hair laid = laidRoots(uprightHair(kStrands, 0)).hair;
    Vec3f sum = Vec3f::Zero();
    for (std::uint32_t s = 0; s < kStrands; ++s) {
        const Vec3f way = laid.strand(s).back() - laid.strand(s).front();
        EXPECT_NEAR(way.y(), 0, 1e-6f) << "on the skin";
        EXPECT_NEAR(way.norm(), kShownLength / 2, 1e-5f);
        sum += way;
    }
    EXPECT_LT(sum.norm(), 0.5f * kStrands * kShownLength / 2) << "not all one way";
}

TEST(Cap, HoldsHairThatLeansAsFarAsItLeans) {
    constexpr float kLean = 0.25f;
    const Hair laid = laidRoots(uprightHair(5, kLean)).hair;
    for (std::uint32_t s = 0; s < 5; ++s) {
        const Vec3f way = laid.strand(s).back() - laid.strand(s).front();
        EXPECT_LT((way - Vec3f(0, 0, kShownLength * std::sin(kLean))).norm(), 1e-5f);
    }
}

TEST(Cap, IsTransparentBeyondTheHairsAndThinsTowardsThem) {
    const Hair hair = ballHair(6000);  // from 0.3 to 0.98 of the ball's height
    const auto light = HairLight::make(hair, nullptr);
    ASSERT_TRUE(light);
    const LaidRoots laid = laidRoots(hair);
    double within = 0, withinCount = 0, outermost = 0, outermostCount = 0;
    for (const CapChart& chart : capOf(hair, kTolerance)) {
        constexpr std::uint32_t kSide = 200;
        const Picture picture = bakeCap(hair, laid, *light, chart, 1, kSide, kSide);
        for (std::uint32_t y = 0; y < kSide; ++y) {
            for (std::uint32_t x = 0; x < kSide; ++x) {
                const float u = (static_cast<float>(x) + 0.5f) / kSide,
                            v = (static_cast<float>(y) + 0.5f) / kSide;
                const Strip& plane = chart.plane;
                Vec3f at = (1 - v) * plane.centre[0] + v * plane.centre[1] +
                           (2 * u - 1) * plane.halfWidth[0] * plane.cross[0];
                // Straight down onto the ball.
                const Vec3f& out = plane.normal[0];
                at -= at.dot(out) * out;
                if (at.norm() >= 0.9f * kBall) continue;
                at += std::sqrt(kBall * kBall - at.squaredNorm()) * out;
                const float height = at.y() / kBall;
                const Texel& texel = picture.at(x, y);
                EXPECT_GE(texel.along, 0);
                EXPECT_LE(texel.along, 0.12f) << "a twelfth of the length of a hair and a little";
                // The lowest roots are at 0.3, and their hairs are laid downwards.
                if (height < 0.3f - 1.4f * kShownLength / kBall) {
                    EXPECT_EQ(texel.coverage, 0) << "skin beyond the hairs";
                } else if (height > 0.25f && height < 0.295f) {
                    outermost += static_cast<double>(texel.coverage), ++outermostCount;
                } else if (height > 0.4f && height < 0.7f) {
                    within += static_cast<double>(texel.coverage), ++withinCount;
                }
            }
        }
    }
    ASSERT_GT(withinCount, 0);
    ASSERT_GT(outermostCount, 0);
    EXPECT_GT(within / withinCount, 0.1);
    EXPECT_LT(outermost / outermostCount, 0.6 * within / withinCount);
}

/// Hair that lies on the plane y = 0, within 30 mm of its middle, and hides half of it.
Hair lyingHair() {
    constexpr float kSide = 0.06f, kLength = 0.012f, kRadius = 0.0002f;
    const auto strands =
        static_cast<std::uint32_t>(std::log(2.0f) * kSide * (kSide + kLength) / (2 * kRadius * kLength));
    Hair hair;
    for (std::uint32_t s = 0; s < strands; ++s) {
        Random random(19, s);
        const Vec3f root(random.uniform(-0.5f, 0.5f) * kSide, 0,
                         random.uniform(-0.5f, 0.5f) * (kSide + kLength) - 0.5f * kLength);
        for (const float t : {0.0f, 0.5f, 1.0f}) {
            hair.positions_ws.emplace_back(root + t * Vec3f(0, 0.0004f, kLength));
            hair.radii.push_back(kRadius), hair.albedo.emplace_back(0.2f, 0.1f, 0.05f);
        }
        hair.offsets.push_back(static_cast<std::uint32_t>(hair.positions_ws.size()));
        hair.rootNormals_ws.emplace_back(0, 1, 0);
    }
    return hair;
}

/// A card over the half of the plane with x below 0.
std::vector<WornTriangle> halfCovered(const Picture& picture, float height) {
    const Vec3f a(-0.1f, height, -0.1f), b(0, height, -0.1f), c(-0.1f, height, 0.1f), d(0, height, 0.1f);
    return {{&picture, {a, b, c}, {Vec2f(0, 0), Vec2f(1, 0), Vec2f(0, 1)}},
            {&picture, {b, d, c}, {Vec2f(1, 0), Vec2f(1, 1), Vec2f(0, 1)}}};
}

/// Mean coverage where the card is, away from its border, and where it is not.
std::array<double, 2> coverageOfHalves(const CapChart& chart, const Picture& picture) {
    std::array<double, 2> sums{}, counts{};
    const Strip& plane = chart.plane;
    for (std::uint32_t y = 0; y < picture.height; ++y) {
        for (std::uint32_t x = 0; x < picture.width; ++x) {
            const float u = (static_cast<float>(x) + 0.5f) / static_cast<float>(picture.width),
                        v = (static_cast<float>(y) + 0.5f) / static_cast<float>(picture.height);
            const Vec3f at = (1 - v) * plane.centre[0] + v * plane.centre[1] +
                             (2 * u - 1) * plane.halfWidth[0] * plane.cross[0];
            if (std::abs(at.x()) < 0.006f || std::abs(at.x()) > 0.024f || std::abs(at.z()) > 0.024f) continue;
            const std::size_t half = at.x() < 0 ? 0 : 1;
            sums[half] += static_cast<double>(picture.at(x, y).coverage), counts[half] += 1;
        }
    }
    return {sums[0] / counts[0], sums[1] / counts[1]};
}

TEST(Cap, IsThinnerWhereCardsHideMoreSkinThanStrandsDo) {
    const Hair hair = lyingHair();
    const auto light = HairLight::make(hair, nullptr);
    ASSERT_TRUE(light);
    const auto cap = capOf(hair, kTolerance);
    ASSERT_EQ(cap.size(), 1u);
    const Picture whole = bakeCap(hair, laidRoots(hair), *light, cap[0], 1, 72, 84);
    const auto alone = coverageOfHalves(cap[0], whole);
    // It wears the first 12 mm of strands that go on.
    EXPECT_GT(alone[0], 0.2);
    EXPECT_GT(alone[1], 0.2);
    const auto halves = [&](float coverage, float height) {
        Picture card{1, 1, std::vector<Texel>(1)}, picture = whole;
        card.texels[0].coverage = coverage;
        leaveToCards(halfCovered(card, height), cap[0], picture);
        return coverageOfHalves(cap[0], picture);
    };
    // Straight on strands hide 0.5 of the skin, aslant more: 0.65 at 48 degrees.
    const auto under = halves(0.45f, 0.002f);
    const double together = 1 - (1 - 0.45) * (1 - under[0]);
    EXPECT_GT(together, 0.57);
    EXPECT_LT(together, 0.69) << "all of the cap would make it 0.73";
    EXPECT_NEAR(under[1], alone[1], 1e-5) << "where there is no card";
    EXPECT_LT(halves(0.9f, 0.002f)[0], 0.25 * alone[0]) << "the card hides more by itself";
    EXPECT_NEAR(halves(0.9f, 0.05f)[0], alone[0], 1e-5) << "a card that hangs far from the skin";
    const double sparse = halves(0.05f, 0.002f)[0];
    EXPECT_LT(sparse, alone[0] + 1e-6) << "no denser than it was";
    EXPECT_GT(sparse, 0.9 * alone[0]);
}

/// Skin that a level shows and strands hide, and the other way round, summed up over where the cap decides.
struct Wrong {
    double bare = 0, hidden = 0;
    double all() const { return bare + hidden; }
};
class CapJudge {
  public:
    CapJudge(std::span<const Shot> strands, std::span<const Shot> without, std::span<const Shot> with)
        : strands_(strands), without_(without), with_(with) {}
    Wrong wrong(std::span<const Shot> level) const {
        Wrong sum;
        for (std::size_t v = 0; v < strands_.size(); ++v) {
            // By squares of 4 pixels: which hair covers which pixel is chance.
            constexpr std::uint32_t kSide = 4;
            for (std::uint32_t y = 0; y + kSide <= strands_[v].height; y += kSide) {
                for (std::uint32_t x = 0; x + kSide <= strands_[v].width; x += kSide) {
                    double more = 0, decides = 0;
                    for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
                        const std::size_t at = std::size_t{y + i / kSide} * strands_[v].width + x + i % kSide;
                        more += static_cast<double>(level[v].skin[at] - strands_[v].skin[at]);
                        decides += static_cast<double>(without_[v].skin[at] - with_[v].skin[at]);
                    }
                    constexpr double kDecides = 0.25;
                    if (decides < kDecides * kSide * kSide) continue;
                    (more > 0 ? sum.bare : sum.hidden) += std::abs(more);
                }
            }
        }
        return sum;
    }

  private:
    std::span<const Shot> strands_, without_, with_;
};

TEST(Cap, IsFittedToTheSkinThatStrandsLeaveBare) {
    Hair hair = ballHair(6000);
    addBallHead(hair);
    const auto light = HairLight::make(hair, nullptr);
    ASSERT_TRUE(light);
    auto made = makeCards(hair, *light, {.cards = 60, .texel = 0.001f}, nullptr);
    ASSERT_TRUE(made) << made.error().message();
    constexpr std::uint32_t kPx = 128;
    const std::vector<View> views = viewsAround(hair, 6);
    const StrandLight onStrands = strandLight(hair, *light);
    const auto shots = [&](const auto& draw) {
        std::vector<Shot> all;
        for (const View& view : views) {
            Plate plate(view, 6 * kPx);
            plate.drawHead(hair);
            draw(plate);
            all.push_back(plate.developed(kPx));
        }
        return all;
    };
    const auto strands = shots([&](Plate& plate) { plate.drawStrands(hair, onStrands); });
    const auto level = [&] {
        return shots([&](Plate& plate) { plate.drawCards(hair, *light, *made, kPx); });
    };
    const CapSight sight(hair, made->cap, views, kPx);
    const auto levelShowing = [&](float shown) {
        for (CapChart& chart : made->cap) chart.wanted.assign(chart.hidden.size(), shown);
        EXPECT_TRUE(bakeAtlas(hair, *light, 1, *made, nullptr));
        return level();
    };
    const auto without = levelShowing(0), with = levelShowing(0.9f);  // far too little, far too much
    const CapJudge judge(strands, without, with);
    const double bare = judge.wrong(without).all(), hidden = judge.wrong(with).all();
    for (const auto* before : {&without, &with}) {
        levelShowing(before == &without ? 0 : 0.9f);
        sight.fit(strands, *before, *made);
        ASSERT_TRUE(bakeAtlas(hair, *light, 1, *made, nullptr));
        EXPECT_LT(judge.wrong(level()).all(), 0.6 * (before == &without ? bare : hidden));
    }
}

TEST(Cap, StaysAsItIsWithoutAHead) {
    const Hair hair = ballHair(1500);
    const auto light = HairLight::make(hair, nullptr);
    ASSERT_TRUE(light);
    auto made = makeCards(hair, *light, {.cards = 20}, nullptr);
    ASSERT_TRUE(made);
    const std::vector<View> views = viewsAround(hair, 2);
    std::vector<Shot> level;
    for (const View& view : views) {
        Plate plate(view, 256);
        plate.drawCards(hair, *light, *made, 64);
        level.push_back(plate.developed(64));
    }
    const std::vector<Texel> before = made->atlas.levels[0].texels;
    CapSight(hair, made->cap, views, 64).fit(level, level, *made);
    ASSERT_TRUE(bakeAtlas(hair, *light, 1, *made, nullptr));
    for (std::size_t t = 0; t < before.size(); ++t)
        ASSERT_EQ(made->atlas.levels[0].texels[t].coverage, before[t].coverage);
}

TEST(Cap, MovesWithTheHeadAndWearsTexturesOfItsOwn) {
    const Hair hair = ballHair(1500);
    const auto light = HairLight::make(hair, nullptr);
    const auto made = makeCards(hair, *light, {.cards = 20, .textures = 4}, nullptr);
    ASSERT_TRUE(made) << made.error().message();
    const auto rig = makeRig(*made, 4, 3, nullptr);
    ASSERT_TRUE(rig);
    const Binding binding = bind(*rig, *made);
    std::size_t count = 0, expected = 0;
    for (std::size_t v = 0; v < made->mesh.vertices.size(); ++v) {
        const CardVertex& vertex = made->mesh.vertices[v];
        EXPECT_EQ(vertex.card == kOfCap, vertex.texture >= 4u);
        ASSERT_LT(vertex.texture, made->atlas.rects.size());
        if (vertex.card != kOfCap) continue;
        ++count;
        EXPECT_EQ(vertex.hangs, 0);
        EXPECT_EQ(binding.joints[v], (std::array<std::uint16_t, 4>{}));
        EXPECT_EQ(binding.weights[v], Vec4f(1, 0, 0, 0));
    }
    for (const CapChart& chart : made->cap) expected += chart.vertices.size();
    EXPECT_EQ(count, expected);
    EXPECT_GT(count, 0u);
    EXPECT_EQ(made->mesh.vertices[made->mesh.indices[0]].card, kOfCap) << "innermost, so it comes first";
}

TEST(Cap, GoesWithTheLastCard) {
    const Hair hair = ballHair(300);
    const auto light = HairLight::make(hair, nullptr);
    auto made = makeCards(hair, *light, {.cards = 3, .textures = 2}, nullptr);
    ASSERT_TRUE(made);
    for (Card& card : made->cards) card.deleted = true;
    buildMesh(*made);
    EXPECT_TRUE(made->mesh.indices.empty());
}

}  // namespace
}  // namespace hairloom::cards
