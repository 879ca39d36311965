// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cards/cards.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>
#include <set>

#include "core/base/parallel.h"
#include "core/cards/judge.h"
#include "core/cards/rig.h"
#include "tests/cards/card_samples.h"

namespace hairloom::cards {
namespace {

using testing::HasSubstr;

Result<Cards> cardsOf(const Hair& hair, const CardOptions& options) {
    const auto light = HairLight::make(hair, nullptr);
    return makeCards(hair, *light, options, nullptr);
}

std::vector<std::uint32_t> allOf(const Hair& hair) {
    std::vector<std::uint32_t> all(hair.strandCount());
    std::iota(all.begin(), all.end(), 0u);
    return all;
}

TEST(Strip, OfARibbonLiesInItsPlaneAndHoldsIt) {
    const Hair hair = ribbonHair(300, 0.04f, 0.002f);
    const auto made = cardsOf(hair, {.cards = 1});
    ASSERT_TRUE(made) << made.error().message();
    ASSERT_EQ(made->cards.size(), 1u);
    const Strip& strip = made->cards[0].strip;
    for (std::size_t k = 0; k < strip.stations(); ++k) {
        EXPECT_GT(std::abs(strip.cross[k].x()), 0.99f) << k;
        EXPECT_GT(strip.normal[k].z(), 0.99f) << "outwards as the scalp's normal";
        EXPECT_NEAR(strip.halfWidth[k], 0.02f, 0.002f) << k;
    }
    EXPECT_NEAR(strip.length(), 0.14f, 0.005f);
}

TEST(Strip, BendsWithABowl) {
    Hair hair = ribbonHair(400, 0.04f, 0);
    constexpr float kBend = 10;  // 1/m
    for (Vec3f& p : hair.positions_ws) p.z() -= kBend * p.x() * p.x();
    const EvenHair even = evenHair(hair, 9);
    std::vector<std::uint32_t> all;
    for (std::uint32_t s = 0; s < 400; ++s) all.push_back(s);
    const Strip strip = fitStrip(even, all, hair.rootNormals_ws);
    for (std::size_t k = 0; k < strip.stations(); ++k) EXPECT_NEAR(strip.bend[k], -kBend, 0.5f) << k;
    for (const std::uint32_t s : all) {
        const auto points = even.strand(s);
        const Vec3f d = points[4] - strip.centre[4];
        const float x = d.dot(strip.cross[4]);
        EXPECT_NEAR(d.dot(strip.normal[4]), strip.bend[4] * (x * x - strip.spread[4]), 2e-4f);
    }
}

TEST(Clusters, PartTwoLayersBeforeTheyPartARibbon) {
    Hair hair = ribbonHair(300, 0.03f, 0.0005f);
    const Hair above = hair;
    for (std::size_t p = 0; p < above.positions_ws.size(); ++p) {
        hair.positions_ws.push_back(above.positions_ws[p] + Vec3f(0, 0, 0.015f));
        hair.radii.push_back(above.radii[p]), hair.albedo.push_back(above.albedo[p]);
    }
    for (std::size_t s = 0; s < above.strandCount(); ++s) {
        hair.offsets.push_back(hair.offsets.back() + 8);
        hair.rootNormals_ws.push_back(above.rootNormals_ws[s]);
    }
    const auto clusters = clusterHair(evenHair(hair, 9), allOf(hair), hair.rootNormals_ws, {2, 0}, nullptr);
    ASSERT_TRUE(clusters);
    ASSERT_EQ(clusters->size(), 2u);
    for (const Cluster& cluster : *clusters) {
        EXPECT_EQ(cluster.strands.size(), 300u);
        EXPECT_EQ(cluster.strands.front() < 300, cluster.strands.back() < 300) << "a layer each";
    }
}

TEST(Cards, OfThickHairAreTwoStripsAtRightAngles) {
    const auto made = cardsOf(ribbonHair(300, 0.04f, 0.02f), {.cards = 1});
    ASSERT_TRUE(made) << made.error().message();
    ASSERT_TRUE(made->cards[0].crossing);
    const Strip &first = made->cards[0].strip, &crossing = *made->cards[0].crossing;
    for (std::size_t k = 0; k < kStations; ++k) {
        EXPECT_GT(std::abs(crossing.cross[k].z()), 0.99f) << k;
        EXPECT_NEAR(crossing.halfWidth[k], 0.01f, 0.001f) << k;
        EXPECT_NEAR(first.halfWidth[k], 0.02f, 0.002f) << k;
        EXPECT_EQ(first.bend[k], 0) << k;
        // Strands lie from -0.01 to 0.01; the first strip is lifted, and at its root off the scalp.
        EXPECT_NEAR(crossing.centre[k].z(), 0, 0.004f) << k;
    }
    std::array<std::size_t, 2> corners{};
    for (const std::uint32_t v : made->mesh.indices) {
        const CardVertex& vertex = made->mesh.vertices[v];
        if (vertex.card != kOfCap) ++corners[vertex.crosses ? 1 : 0];
    }
    EXPECT_GT(corners[1], 0u);
    EXPECT_LE(corners[0] + corners[1], 3u * 4 * (kStations - 1)) << "no more than one bent strip";
    const auto flat = cardsOf(ribbonHair(300, 0.04f, 0.002f), {.cards = 1});
    ASSERT_TRUE(flat);
    EXPECT_FALSE(flat->cards[0].crossing);
}

TEST(Cards, ShowThickHairFromAllSides) {
    const Hair hair = ribbonHair(300, 0.04f, 0.02f);
    const auto light = HairLight::make(hair, nullptr);
    const auto made = cardsOf(hair, {.cards = 1});
    ASSERT_TRUE(made) << made.error().message();
    const auto covered = [](const Shot& shot) {
        return std::accumulate(shot.coverage.begin(), shot.coverage.end(), 0.0);
    };
    for (const View& view : viewsAround(hair, 8)) {
        constexpr std::uint32_t kHeadPx = 128;
        Plate strands(view, kSamplesPerHead), cards(view, 4 * kHeadPx);
        strands.coverByStrands(hair);
        cards.drawCards(hair, *light, *made, kHeadPx);
        const double wanted = covered(strands.developed(kHeadPx)), is = covered(cards.developed(kHeadPx));
        EXPECT_GT(is, 0.6 * wanted) << "towards " << view.toEye_ws.transpose();
        EXPECT_LT(is, 1.7 * wanted) << "towards " << view.toEye_ws.transpose();
    }
}

TEST(HeldCards, StayThickWhereTheyArePinned) {
    const Hair hair = ribbonHair(300, 0.04f, 0.02f);
    const auto made = cardsOf(hair, {.cards = 1});
    ASSERT_TRUE(made && made->cards[0].crossing);
    HeldCard held;
    held.strands = made->cards[0].strands, held.strip = made->cards[0].strip;
    const Vec3f aside(0.1f, 0.02f, 0);
    for (Vec3f& at : held.strip->centre) at += aside;
    const auto again = cardsOf(hair, {.cards = 1, .held = {held}});
    ASSERT_TRUE(again) << again.error().message();
    ASSERT_TRUE(again->cards[0].crossing);
    const Strip &before = *made->cards[0].crossing, &now = *again->cards[0].crossing;
    for (std::size_t k = 0; k < kStations; ++k) {
        EXPECT_LT((now.centre[k] - before.centre[k] - aside).norm(), 1e-4f) << k;
        EXPECT_NEAR(now.halfWidth[k], before.halfWidth[k], 1e-4f) << k;
    }
}

/// Two patches of roots with skin between, whose hairs lie in two layers and side by side beyond the roots.
Hair parted() {
    Hair hair = ribbonHair(400, 0.02f, 0);
    for (std::uint32_t s = 0; s < 400; ++s) {
        const float side = s % 2 == 0 ? 0.02f : -0.02f, layer = s % 4 < 2 ? 0.0f : 0.003f;
        for (std::uint32_t p = hair.offsets[s]; p < hair.offsets[s + 1]; ++p) {
            const float left = std::max(0.0f, 1 - 0.4f * static_cast<float>(p - hair.offsets[s]));
            hair.positions_ws[p] += Vec3f(left * side, 0, layer);
        }
    }
    return hair;
}

TEST(Clusters, PartHairThatSkinPartsBeforeLayers) {
    const Hair hair = parted();
    const auto clusters = clusterHair(evenHair(hair, 9), allOf(hair), hair.rootNormals_ws, {2, 0}, nullptr);
    ASSERT_TRUE(clusters);
    ASSERT_EQ(clusters->size(), 2u);
    for (const Cluster& cluster : *clusters) {
        for (const std::uint32_t s : cluster.strands) EXPECT_EQ(s % 2, cluster.strands[0] % 2) << s;
    }
}

TEST(Clusters, KnowWhichRootsHangTogether) {
    const Hair hair = parted();
    const EvenHair even = evenHair(hair, 9);
    const auto both = byRoots(even, allOf(hair));
    ASSERT_EQ(both.size(), 2u);
    for (const auto& piece : both) {
        EXPECT_EQ(piece.size(), 200u);
        for (const std::uint32_t s : piece) EXPECT_EQ(s % 2, piece[0] % 2);
    }
    std::vector<std::uint32_t> some = both[1];
    some.push_back(both[0][0]), some.push_back(both[0][1]);
    std::ranges::sort(some);
    const auto unequal = byRoots(even, some);
    ASSERT_GE(unequal.size(), 2u);
    EXPECT_EQ(unequal[0], both[1]) << "the largest first";
}

/// Straight hairs that rise from the plane y = 0 towards x; roots in rows and columns over a square, so that
/// its strip is straight, too.
Hair risingHair(float degrees) {
    Hair hair;
    const float angle = radians(degrees);
    for (std::uint32_t s = 0; s < 400; ++s) {
        constexpr std::uint32_t kInARow = 20;
        constexpr float kApart = 0.001f;  // metres
        const float across = static_cast<float>(s % kInARow) - 9.5f,
                    along = static_cast<float>(s / kInARow) - 9.5f;
        const Vec3f root(kApart * along, 0, kApart * across);
        for (int p = 0; p < 10; ++p) {
            hair.positions_ws.emplace_back(root + 0.006f * static_cast<float>(p) *
                                                      Vec3f(std::cos(angle), std::sin(angle), 0));
            hair.radii.push_back(0.0001f), hair.albedo.emplace_back(0.3f, 0.2f, 0.1f);
        }
        hair.offsets.push_back(static_cast<std::uint32_t>(hair.positions_ws.size()));
        hair.rootNormals_ws.emplace_back(0, 1, 0);
    }
    return hair;
}

TEST(Strip, PlacesRootsWhereTheyGrowAndNotOnItsCrease) {
    const Hair hair = risingHair(60);
    const auto made = cardsOf(hair, {.cards = 1});
    ASSERT_TRUE(made) << made.error().message();
    const Strip& strip = made->cards[0].strip;
    for (std::uint32_t s = 1; s < hair.strandCount(); ++s) {
        const auto places = placesOn(strip, hair.strand(s)), first = placesOn(strip, hair.strand(0));
        const float apart = strip.length() * (places[0].along - first[0].along);
        // The strip is lifted off the scalp towards its crease: it is a little aslant.
        const float roots = hair.strand(s)[0].x() - hair.strand(0)[0].x();
        EXPECT_NEAR(apart, roots, 0.2f * std::abs(roots) + 0.0005f) << s;
        for (std::size_t p = 1; p < places.size(); ++p)
            EXPECT_GT(places[p].along, places[p - 1].along + 0.02f)
                << "no pile at point " << p << " of " << s;
    }
}

TEST(Cards, AreLitAsTheirStrandsGoAndNotAsTheirStripLies) {
    const Hair hair = risingHair(60);
    const auto made = cardsOf(hair, {.cards = 4});
    ASSERT_TRUE(made) << made.error().message();
    const Vec3f way = (hair.strand(0)[1] - hair.strand(0)[0]).normalized();
    for (const CardVertex& v : made->mesh.vertices) {
        if (v.card == kOfCap) continue;
        EXPECT_GT(v.along_ws.dot(way), 0.99f);
        EXPECT_NEAR(v.along_ws.dot(v.normal_ws), 0, 1e-4f);
    }
}

TEST(Clusters, HoldEachStrandOnceAndStopWhereTheyAreGoodEnough) {
    const Hair hair = ballHair(2000);
    const EvenHair even = evenHair(hair, 9);
    const auto many = clusterHair(even, allOf(hair), hair.rootNormals_ws, {60, 0}, nullptr);
    ASSERT_TRUE(many);
    EXPECT_GT(many->size(), 55u);
    EXPECT_LE(many->size(), 60u);
    std::set<std::uint32_t> seen;
    for (const Cluster& cluster : *many) seen.insert(cluster.strands.begin(), cluster.strands.end());
    EXPECT_EQ(seen.size(), 2000u);
    const auto few = clusterHair(even, allOf(hair), hair.rootNormals_ws, {60, 0.02f}, nullptr);
    ASSERT_TRUE(few);
    EXPECT_LT(few->size(), many->size());
}

TEST(Clusters, LeaveOutOtherStrands) {
    const Hair hair = ballHair(300);
    const auto clusters = clusterHair(evenHair(hair, 9), {3, 5, 200}, hair.rootNormals_ws, {2, 0}, nullptr);
    ASSERT_TRUE(clusters);
    std::set<std::uint32_t> seen;
    for (const Cluster& cluster : *clusters) seen.insert(cluster.strands.begin(), cluster.strands.end());
    EXPECT_EQ(seen, (std::set<std::uint32_t>{3, 5, 200}));
}

/// Two cards of the hair as a hand has shaped them: one pinned and wider, one deleted.
std::vector<HeldCard> heldOf(const Cards& cards) {
    HeldCard wide, gone;
    wide.level = gone.level = 24;
    wide.strands = cards.cards[3].strands, gone.strands = cards.cards[7].strands;
    wide.width = 2, wide.strip = cards.cards[3].strip;
    gone.deleted = true;
    return {wide, gone};
}
const Card* cardHeldAt(const Cards& cards, std::int32_t place) {
    const auto found = std::ranges::find(cards.cards, place, &Card::held);
    return found == cards.cards.end() ? nullptr : &*found;
}

TEST(HeldCards, KeepTheirHairAndPlaceWhereTheRestIsMadeAnew) {
    Hair hair = ballHair(1500);
    const auto first = cardsOf(hair, {.cards = 24, .textures = 6});
    ASSERT_TRUE(first) << first.error().message();
    const auto held = heldOf(*first);
    // All hair is combed aside; roots stay.
    for (std::size_t s = 0; s < hair.strandCount(); ++s) {
        const float root = hair.strand(s)[0].y();
        for (std::size_t p = hair.offsets[s]; p < hair.offsets[s + 1]; ++p)
            hair.positions_ws[p].x() += 0.5f * (root - hair.positions_ws[p].y());
    }
    const auto again = cardsOf(hair, {.cards = 24, .textures = 6, .held = held});
    ASSERT_TRUE(again) << again.error().message();
    EXPECT_LE(again->cards.size(), 24u);
    std::set<std::uint32_t> seen;
    for (const Card& card : again->cards) {
        for (const std::uint32_t s : card.strands)
            EXPECT_TRUE(seen.insert(s).second) << s << " is on two cards";
    }
    EXPECT_EQ(seen.size(), hair.strandCount());
    const Card *pinned = cardHeldAt(*again, 0), *gone = cardHeldAt(*again, 1);
    ASSERT_TRUE(pinned && gone);
    EXPECT_EQ(pinned->strands, held[0].strands);
    EXPECT_EQ(pinned->strip.centre, held[0].strip->centre) << "pinned";
    EXPECT_EQ(gone->strands, held[1].strands);
    EXPECT_NE(gone->strip.centre, first->cards[7].strip.centre) << "follows its hair";
}

TEST(HeldCards, AreShapedByHandAndTheOthersAreNot) {
    const Hair hair = ballHair(1500);
    const auto first = cardsOf(hair, {.cards = 24, .textures = 6});
    ASSERT_TRUE(first);
    auto held = heldOf(*first);
    auto made = cardsOf(hair, {.cards = 24, .textures = 6, .held = held});
    ASSERT_TRUE(made);
    const CardMesh before = made->mesh;
    shapeByHand(held, *made);
    const auto place = [&](const Card* card) {
        return static_cast<std::uint32_t>(card - made->cards.data());
    };
    const std::uint32_t wide = place(cardHeldAt(*made, 0)), gone = place(cardHeldAt(*made, 1));
    const auto widthOf = [](const CardMesh& mesh, std::uint32_t card) {
        std::vector<Vec3f> root;
        for (const CardVertex& v : mesh.vertices)
            if (v.card == card && !v.crosses && v.place.y() == 0) root.push_back(v.position_ws);
        float width = 0;
        for (const Vec3f& a : root)
            for (const Vec3f& b : root) width = std::max(width, (a - b).norm());
        return width;
    };
    EXPECT_NEAR(widthOf(made->mesh, wide) / widthOf(before, wide), 2, 0.1);
    EXPECT_EQ(widthOf(made->mesh, gone), 0) << "deleted";
    for (std::uint32_t c = 0; c < made->cards.size(); ++c) {
        if (c == wide || c == gone) continue;
        EXPECT_EQ(widthOf(made->mesh, c), widthOf(before, c)) << c;
    }
    // Bent until the edges lie half of half the width outwards: no card of a ball's hair is by itself.
    held[0].bend = 0.5f, held[0].width = 1;
    shapeByHand(held, *made);
    bool lifted = false;
    for (const CardVertex& v : made->mesh.vertices) {
        if (v.card != wide || v.crosses || v.place.x() != 0) continue;
        const auto k = static_cast<std::size_t>(v.place.y() * (kStations - 1) + 0.5f);
        const Strip& strip = made->cards[wide].strip;
        const float own = strip.bend[k] * strip.halfWidth[k];
        const float height = (v.position_ws - strip.centre[k]).dot(strip.normal[k]) +
                             (strip.bend[k] + 0.5f / strip.halfWidth[k]) * strip.spread[k];
        EXPECT_NEAR(height / strip.halfWidth[k],
                    (own + 0.5f) * made->cards[wide].widen * made->cards[wide].widen, 0.02f);
        lifted = true;
    }
    EXPECT_TRUE(lifted);
}

TEST(Cards, AreTheSameForAnyNumberOfThreads) {
    const Hair hair = ballHair(1500);
    std::vector<Cards> made;
    for (const std::size_t threads : {1u, 2u, 5u}) {
        setThreadCount(threads);
        auto cards = cardsOf(hair, {.cards = 24, .textures = 6});
        ASSERT_TRUE(cards) << cards.error().message();
        made.push_back(std::move(*cards));
    }
    setThreadCount(0);
    for (std::size_t i = 1; i < made.size(); ++i) {
        ASSERT_EQ(made[i].mesh.indices, made[0].mesh.indices);
        for (std::size_t v = 0; v < made[0].mesh.vertices.size(); ++v) {
            ASSERT_EQ(made[i].mesh.vertices[v].position_ws, made[0].mesh.vertices[v].position_ws);
            ASSERT_EQ(made[i].mesh.vertices[v].tint, made[0].mesh.vertices[v].tint);
        }
        const auto &a = made[i].atlas.levels[0].texels, &b = made[0].atlas.levels[0].texels;
        ASSERT_EQ(a.size(), b.size());
        for (std::size_t t = 0; t < a.size(); ++t) {
            ASSERT_EQ(a[t].coverage, b[t].coverage);
            ASSERT_EQ(a[t].albedo, b[t].albedo);
        }
    }
}

TEST(Cards, KeepTheirBudgets) {
    const Hair hair = ballHair(1500);
    const auto made = cardsOf(hair, {.cards = 40, .textures = 5, .mostSide = 256});
    ASSERT_TRUE(made) << made.error().message();
    EXPECT_LE(made->cards.size(), 40u);
    EXPECT_EQ(made->painters.size(), 5u);
    EXPECT_EQ(made->atlas.rects.size(), 5u + made->cap.size());
    EXPECT_LE(made->atlas.side(), 256u);
    std::vector<std::size_t> rows(made->cards.size());
    for (const CardVertex& v : made->mesh.vertices) {
        if (v.card != kOfCap) ++rows[v.card];
        EXPECT_TRUE(v.position_ws.allFinite());
        EXPECT_GE(v.uv.minCoeff(), 0);
        EXPECT_LE(v.uv.maxCoeff(), 1);
        EXPECT_NEAR(v.normal_ws.norm(), 1, 1e-4f);
        EXPECT_NEAR(v.along_ws.norm(), 1, 1e-4f);
    }
    for (const std::size_t count : rows) {
        EXPECT_GE(count, 4u) << "two segments' ends of two columns";
        EXPECT_LE(count, 4u * kStations) << "two strips of two columns";
    }
}

TEST(Cards, HaveTexturesOfTheirOwnAsFarAsTheAtlasOfSharedOnesHoldsThem) {
    const Hair hair = ballHair(1500);
    const auto shared = cardsOf(hair, {.cards = 120, .textures = kSharedTextures});
    const auto made = cardsOf(hair, {.cards = 120});
    const auto own = cardsOf(hair, {.cards = 120, .textures = 120});
    ASSERT_TRUE(shared && made && own);
    EXPECT_EQ(shared->painters.size(), kSharedTextures) << "a number is kept to";
    EXPECT_EQ(own->painters.size(), own->cards.size()) << "each its own";
    EXPECT_GT(own->atlas.side(), shared->atlas.side());
    EXPECT_GT(made->painters.size(), 2 * kSharedTextures);
    EXPECT_EQ(made->atlas.side(), shared->atlas.side()) << "of the same memory";
    for (const Card& card : made->cards) EXPECT_LT(card.texture, made->painters.size());
    for (std::size_t t = 0; t < made->painters.size(); ++t) {
        const Strip& strip = made->cards[made->painters[t]].strip;
        const Rect& rect = made->atlas.rects[t];
        const float texel = strip.length() / static_cast<float>(rect.height);
        EXPECT_LE(texel, 1.1f * kLongestTexel * made->texel) << t;
    }
}

TEST(Cards, RefuseWhatCannotBe) {
    EXPECT_THAT(check(Hair{}).error().message(), HasSubstr("no strands"));
    EXPECT_THAT(check(ballHair(1)).error().message(), HasSubstr("one strand"));
    Hair flat = ballHair(3);
    for (Vec3f& p : flat.positions_ws) p = Vec3f(1, 2, 3);
    EXPECT_THAT(check(flat).error().message(), HasSubstr("no length"));
    Hair broken = ballHair(3);
    broken.positions_ws[15].x() = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THAT(check(broken).error().message(), HasSubstr("strand 1 is not finite"));
    const Hair hair = ballHair(300);
    EXPECT_THAT(cardsOf(hair, {.cards = 0}).error().message(), HasSubstr("0 cards"));
    EXPECT_THAT(cardsOf(hair, {.textures = 257}).error().message(), HasSubstr("257 textures"));
    EXPECT_THAT(cardsOf(hair, {.mostSide = 100}).error().message(), HasSubstr("power of two"));
    const auto full = cardsOf(hair, {.cards = 256, .textures = 256, .mostSide = 64});
    ASSERT_FALSE(full);
    EXPECT_THAT(full.error().message(), HasSubstr("do not fit an atlas of 64 texels; fewer textures"));
}

TEST(Cards, StopWhenTheyAreCancelled) {
    const Hair hair = ballHair(300);
    const auto light = HairLight::make(hair, nullptr);
    const std::atomic<bool> cancel = true;
    EXPECT_THAT(makeCards(hair, *light, {}, &cancel).error().message(), HasSubstr("stopped"));
}

TEST(Rig, HoldsEachVertexAndMovesItWithItsJoints) {
    const Hair hair = ballHair(800);
    const auto made = cardsOf(hair, {.cards = 30});
    ASSERT_TRUE(made);
    const auto rig = makeRig(*made, 6, 4, nullptr);
    ASSERT_TRUE(rig);
    EXPECT_LE(rig->chains(), 6u);
    const Binding binding = bind(*rig, *made);
    ASSERT_EQ(binding.weights.size(), made->mesh.vertices.size());
    for (const Vec4f& w : binding.weights) {
        EXPECT_NEAR(w.sum(), 1, 1e-5f);
        EXPECT_GE(w.minCoeff(), 0);
    }
    Eigen::Affine3f moved = Eigen::Affine3f::Identity();
    moved.translate(Vec3f(1, 2, 3));
    std::vector<Vec3f> positions(made->mesh.vertices.size());
    skin(binding, made->mesh, std::vector<Eigen::Affine3f>(rig->joints.size(), moved), positions);
    for (std::size_t v = 0; v < positions.size(); ++v)
        EXPECT_LT((positions[v] - made->mesh.vertices[v].position_ws - Vec3f(1, 2, 3)).norm(), 1e-5f);
}

}  // namespace
}  // namespace hairloom::cards
