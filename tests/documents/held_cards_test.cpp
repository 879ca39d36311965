// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/levels/held_cards.h"

#include <gtest/gtest.h>

#include "core/base/random.h"

namespace hairloom {
namespace {

std::vector<Vec3f> someRoots(std::size_t count) {
    Random random(4);
    std::vector<Vec3f> roots(count);
    for (Vec3f& root : roots) root = 0.2f * Vec3f(random.uniform(), random.uniform(), random.uniform());
    return roots;
}

cards::Card cardOf(std::vector<std::uint32_t> strands) {
    cards::Card card;
    card.strands = std::move(strands);
    return card;
}

TEST(HeldCards, FindTheirHairByItsRootsInWhateverOrder) {
    std::vector<Vec3f> roots = someRoots(500);
    CardEdit wide = editOf(cardOf({3, 4, 90}), 200, roots), gone = editOf(cardOf({7, 100}), 200, roots);
    wide.width = 1.5f, gone.deleted = true;
    std::ranges::reverse(roots);
    for (Vec3f& root : roots) root += Vec3f(3e-5f, -3e-5f, 0);
    const std::vector<CardEdit> edits{wide, gone};
    const HeldCards held = heldCards(edits, roots);
    ASSERT_EQ(held.cards.size(), 2u);
    EXPECT_TRUE(held.lost.empty());
    EXPECT_EQ(held.cards[0].strands, (std::vector<std::uint32_t>{409, 495, 496}));
    EXPECT_EQ(held.cards[0].width, 1.5f);
    EXPECT_TRUE(held.cards[1].deleted);
    EXPECT_EQ(findEdit(edits, cardOf({399, 492}), 200, roots), 1u);
    EXPECT_FALSE(findEdit(edits, cardOf({399, 492}), 100, roots)) << "another level";
    EXPECT_FALSE(findEdit(edits, cardOf({393}), 200, roots));
}

TEST(HeldCards, HairsOfOneRootAreHeldByOneEditEach) {
    std::vector<Vec3f> roots = someRoots(20);
    roots[6] = roots[5];
    const CardEdit one = editOf(cardOf({4, 5}), 200, roots), other = editOf(cardOf({6, 7}), 200, roots);
    const HeldCards held = heldCards(std::vector{one, other}, roots);
    ASSERT_EQ(held.cards.size(), 2u);
    EXPECT_EQ(held.cards[0].strands.size(), 2u);
    EXPECT_EQ(held.cards[1].strands.size(), 2u);
    EXPECT_FALSE(findEdit(std::vector{one}, cardOf({6, 7}), 200, roots)) << "its other hair is of no edit";
}

TEST(HeldCards, WhoseHairIsGoneAreLostAndNoHairIsHeldTwice) {
    std::vector<Vec3f> roots = someRoots(500);
    const CardEdit first = editOf(cardOf({3, 4, 90}), 200, roots);
    CardEdit second = editOf(cardOf({4, 5, 6}), 200, roots), other = editOf(cardOf({4, 5}), 100, roots);
    const CardEdit gone = editOf(cardOf({10, 11, 12}), 200, roots);
    roots[10] += Vec3f(0.01f, 0, 0), roots[11] += Vec3f(0.01f, 0, 0);
    const HeldCards held = heldCards(std::vector{first, second, other, gone}, roots);
    ASSERT_EQ(held.cards.size(), 3u);
    EXPECT_EQ(held.cards[1].strands, (std::vector<std::uint32_t>{5, 6}));
    EXPECT_EQ(held.cards[2].strands, (std::vector<std::uint32_t>{4, 5})) << "levels do not share hair";
    EXPECT_EQ(held.lost, std::vector<std::size_t>{3});
}

TEST(HeldCards, APinnedStripComesBackAsItWas) {
    cards::Strip strip;
    for (int k = 0; k < 25; ++k) {
        const float t = static_cast<float>(k) / 24;
        strip.centre.emplace_back(0.1f * t, 1.7f - 0.2f * t * t, 0.05f);
        strip.cross.push_back(Vec3f::UnitZ());
        strip.halfWidth.push_back(0.01f), strip.bend.push_back(-2), strip.spread.push_back(3e-5f);
    }
    strip = cards::framed(strip);
    const std::vector<Vec3f> roots = someRoots(20);
    CardEdit edit = editOf(cardOf({1, 2}), 50, roots);
    edit.strip = stationsOf(strip);
    const HeldCards held = heldCards(std::vector{edit}, roots);
    ASSERT_TRUE(held.cards.size() == 1 && held.cards[0].strip);
    const cards::Strip& back = *held.cards[0].strip;
    EXPECT_EQ(back.centre, strip.centre);
    for (std::size_t k = 0; k < 25; ++k) {
        EXPECT_LT((back.normal[k] - strip.normal[k]).norm(), 1e-6f) << k;
        EXPECT_LT((back.along[k] - strip.along[k]).norm(), 1e-6f) << k;
    }
}

}  // namespace
}  // namespace hairloom
