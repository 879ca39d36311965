// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/history.h"

#include <gmock/gmock.h>

#include "core/editing/strand_delta.h"
#include "tests/editing/editing_samples.h"
#include "tests/support/temporary_folder.h"

namespace hairloom::editing {
namespace {

TEST(History, ForgetsTheOldestBeyondItsLimitAndKeepsTheNewest) {
    Document document(hairOnHead());
    for (int i = 0; i < 6; ++i) ASSERT_TRUE(document.replay(strokeFor("puff")));
    const std::size_t all = document.history().bytes();
    EXPECT_EQ(document.history().size(), 6u);
    document.setHistoryLimit(all / 2);
    EXPECT_LE(document.history().bytes(), all / 2);
    EXPECT_LT(document.history().size(), 6u);
    EXPECT_EQ(document.history().size() + document.history().forgotten(), 6u);
    EXPECT_FALSE(document.script());
    document.setHistoryLimit(1);
    EXPECT_EQ(document.history().size(), 1u);
    EXPECT_TRUE(document.undo());
    EXPECT_FALSE(document.undo());
    EXPECT_TRUE(document.redo());
}

TEST(History, ForgetsWhatWasUndoneWhenSomethingElseIsDone) {
    Document document(hairOnHead());
    ASSERT_TRUE(document.replay(strokeFor("puff")));
    ASSERT_TRUE(document.replay(strokeFor("comb")));
    ASSERT_TRUE(document.undo());
    EXPECT_TRUE(document.canRedo());
    ASSERT_TRUE(document.replay(strokeFor("smooth")));
    EXPECT_FALSE(document.canRedo());
    EXPECT_EQ(document.history().size(), 2u);
}

TEST(History, HoldsOnlyWhatAStrokeTouched) {
    Document small(hairOnHead(300));
    ASSERT_TRUE(small.replay(strokeFor("puff")));

    Groom groom = hairOnHead(300);
    Document large(groom);
    Stroke tiny = strokeFor("puff");
    tiny.dabs.resize(1);
    tiny.settings.radius = tiny.dabs[0].radius = 0.01f;
    ASSERT_TRUE(large.replay(tiny));
    EXPECT_LT(large.history().bytes(), small.history().bytes() / 4);
}

TEST(History, DistinguishesSavedFromModified) {
    const TemporaryFolder folder;
    Document document(hairOnHead());
    EXPECT_FALSE(document.isModified());
    ASSERT_TRUE(document.replay(strokeFor("comb")));
    EXPECT_TRUE(document.isModified());
    ASSERT_TRUE(document.save(folder / "hair.hairloom"));
    EXPECT_FALSE(document.isModified());
    document.undo();
    EXPECT_TRUE(document.isModified());
    document.redo();
    EXPECT_FALSE(document.isModified());
    const auto opened = Document::open(folder / "hair.hairloom");
    ASSERT_TRUE(opened) << opened.error().message();
    EXPECT_TRUE(sameContent((*opened)->groom(), document.groom()));
    EXPECT_FALSE((*opened)->isModified());
}

TEST(Observers, AreNotifiedUntilTheyUnsubscribe) {
    Document document(hairOnHead());
    std::vector<Part> heard;
    std::size_t touched = 0;
    {
        const Subscription subscription = document.observe([&](const Change& change) {
            heard.push_back(change.parts);
            touched = std::max(touched, change.strands.size());
        });
        const Stroke stroke = strokeFor("comb");
        ASSERT_TRUE(document.beginStroke(stroke));
        ASSERT_TRUE(document.dab(stroke.dabs[0]));  // no motion yet, nothing to tell
        EXPECT_TRUE(heard.empty());
        ASSERT_TRUE(document.dab(stroke.dabs[1]));
        EXPECT_EQ(heard, std::vector{Part::Points});
        EXPECT_GT(touched, 0u);
        EXPECT_LT(touched, 300u);
        document.endStroke();
        EXPECT_TRUE(contains(heard.back(), Part::History));
        document.undo();
        EXPECT_EQ(heard.back(), Part::Points | Part::History);
    }
    const std::size_t count = heard.size();
    document.redo();
    EXPECT_EQ(heard.size(), count);
}

TEST(StrandDelta, TakesOutAndPutsBackAllAttributes) {
    const Groom before = fullGroom();
    for (const std::vector<std::uint32_t>& strands :
         {std::vector<std::uint32_t>{0}, {4}, {1, 2}, {0, 2, 4}, {0, 1, 2, 3, 4}}) {
        Groom groom = before;
        StrandDelta delta;
        delta.remove(groom, strands);
        EXPECT_EQ(groom.strandCount(), 5 - strands.size());
        EXPECT_TRUE(groom.triangulation.triangles.empty());
        for (std::size_t s = 0, old = 0; s < groom.strandCount(); ++s, ++old) {
            while (std::find(strands.begin(), strands.end(), old) != strands.end()) ++old;
            const auto a = groom.strand(s);
            const auto b = before.strand(old);
            EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end()));
            EXPECT_EQ(groom.strandAttributes.view<std::int32_t>("signed")[s],
                      before.strandAttributes.view<std::int32_t>("signed")[old]);
        }
        if (groom.strandCount() > 0) {
            EXPECT_TRUE(checkStructure(groom));
        }
        const std::uint64_t without = contentHash(groom);
        delta.exchange(groom);
        EXPECT_TRUE(sameContent(groom, before));
        delta.exchange(groom);
        EXPECT_EQ(contentHash(groom), without);
    }
}

TEST(StrandDelta, TakesStrandsOfDifferentLengths) {
    std::vector<std::uint32_t> offsets{0};
    std::vector<Vec3f> points;
    for (std::uint32_t s = 0; s < 40; ++s) {
        for (std::uint32_t p = 0; p < 2 + s % 7; ++p)
            points.emplace_back(static_cast<float>(s), static_cast<float>(p), 1);
        offsets.push_back(static_cast<std::uint32_t>(points.size()));
    }
    const Groom before = makeGroom(offsets, points);
    Groom groom = before;
    std::vector<std::uint32_t> strands;
    for (std::uint32_t s = 0; s < 40; s += 1 + s % 3) strands.push_back(s);
    const TakenStrands taken = takeOut(groom, strands);
    EXPECT_EQ(groom.pointCount() + std::accumulate(taken.counts.begin(), taken.counts.end(), 0u),
              before.pointCount());
    EXPECT_TRUE(checkStructure(groom));
    putBack(groom, taken);
    EXPECT_TRUE(sameContent(groom, before));
}

}  // namespace
}  // namespace hairloom::editing
