// SPDX-License-Identifier: GPL-3.0-or-later
// Takes beside a project: their names, what becomes of them, how far two are apart.

#include "core/documents/takes.h"

#include <gmock/gmock.h>

#include <fstream>

#include "core/base/output_file.h"

#include "tests/support/temporary_folder.h"

namespace hairloom::test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

class ProjectTakes : public testing::Test {
  protected:
    ProjectTakes() { fs::create_directory(takesFolder(project)); }

    /// `frames` of a strand that stands `offset` to the side.
    void record(const std::string& name, std::uint64_t frames, float offset = 0, bool finish = true,
                float rate = 60) const {
        auto take =
            TakeWriter::open(*takePath(project, name), groom, rate, takeNotes("nod", groom, "cpu", 0));
        ASSERT_TRUE(take) << take.error().message();
        for (std::uint64_t f = 0; f < frames; ++f) {
            const Vec3f aside(f == 2 ? 2 * offset : offset, 0, 0);
            ASSERT_TRUE(take->add(std::vector<Vec3f>{aside, aside + Vec3f(0, 1, 0)}, {}));
        }
        if (!finish) return;
        ASSERT_TRUE(take->finish());
    }
    std::vector<std::string> names() const {
        std::vector<std::string> result;
        for (const Take& take : findTakes(project).takes) result.push_back(take.name);
        return result;
    }

    const TemporaryFolder own;
    const fs::path project = own.path() / "hair.v2.hairloom";
    const Groom groom = makeGroom({0, 2}, {{0, 0, 0}, {0, 1, 0}});
};

TEST_F(ProjectTakes, NamesThatAreNoneAreRefusedWithWhy) {
    EXPECT_EQ(takesFolder(project), own.path() / "hair.v2.takes");
    EXPECT_EQ(*takePath(project, "nod in wind"), own.path() / "hair.v2.takes/nod in wind.hltake");
    EXPECT_TRUE(takePath(project, "Bö-1_ñ"));
    for (const char* name : {"a/b", "..", "a\\b", ".hidden", "-x", "a\nb", "a:b", "a.", " a", "a ", "\xff",
                             "nul", "COM1", "aux.1"}) {
        const auto path = takePath(project, name);
        ASSERT_FALSE(path) << name;
        EXPECT_THAT(path.error().message(), HasSubstr("cannot name a take")) << name;
    }
    EXPECT_THAT(takePath(project, "").error().message(), HasSubstr("needs a name"));
    EXPECT_THAT(takePath(project, std::string(101, 'x')).error().message(), HasSubstr("100 bytes"));
}

TEST_F(ProjectTakes, ARecordingThatCannotBeReadStays) {
    record("a", 9, 0, false);
    const auto leftOvers = findLeftOvers(takesFolder(project));
    ASSERT_EQ(leftOvers.size(), 1u);
    {
        // As a newer program might have written it.
        std::fstream file(leftOvers[0].file, std::ios::in | std::ios::out | std::ios::binary);
        file.seekp(8);
        file.put('\x63');
    }
    EXPECT_TRUE(findTakes(project).recovered.empty());
    EXPECT_TRUE(fs::exists(leftOvers[0].file));
}

TEST_F(ProjectTakes, AreListedRenamedAndRemoved) {
    record("b", 3);
    record("a", 9);
    std::ofstream(takesFolder(project) / "broken.hltake") << "nothing";
    std::ofstream(takesFolder(project) / "notes.txt") << "nothing";
    const Takes found = findTakes(project);
    ASSERT_EQ(found.takes.size(), 3u);
    EXPECT_EQ(found.takes[0].info.frames, 9u);
    EXPECT_EQ(motionOfNotes(found.takes[0].info.notes), "nod");
    EXPECT_THAT(found.takes[2].problem, HasSubstr("is not a take"));
    EXPECT_THAT(renameTake(project, "a", "b").error().message(), HasSubstr("there is a take 'b' already"));
    EXPECT_THAT(renameTake(project, "a", "../b").error().message(), HasSubstr("cannot name a take"));
    EXPECT_THAT(renameTake(project, "c", "d").error().message(), HasSubstr("expected one of: a, b, broken"));
    ASSERT_TRUE(renameTake(project, "a", "c"));
    EXPECT_THAT(names(), ElementsAre("b", "broken", "c"));
    ASSERT_TRUE(removeTake(project, "b"));
    ASSERT_TRUE(removeTake(project, "broken"));
    EXPECT_THAT(removeTake(project, "b").error().message(), HasSubstr("there is no take 'b'"));
    ASSERT_TRUE(removeTake(project, "c"));
    EXPECT_TRUE(fs::exists(takesFolder(project))) << "with a file of somebody else";
}

TEST_F(ProjectTakes, ThoseThatWereEndedAreFoundByTheirName) {
    record("a", 10, 0, false);
    record("lost", 3, 0, false);  // no whole block
    Takes found = findTakes(project);
    EXPECT_THAT(found.recovered, ElementsAre("a"));
    ASSERT_EQ(found.takes.size(), 1u);
    EXPECT_EQ(found.takes[0].info.frames, kFramesPerBlock);
    EXPECT_FALSE(found.takes[0].info.isFinished);
    // One that replaces another leaves that as it is.
    record("a", 12, 1, false);
    EXPECT_THAT(findTakes(project).recovered, ElementsAre("a (recovered)"));
    record("a", 12, 1, false);
    EXPECT_THAT(findTakes(project).recovered, ElementsAre("a (recovered 2)"));
    EXPECT_TRUE(findTakes(project).recovered.empty());
}

TEST_F(ProjectTakes, OneThatIsBeingWrittenIsNotTouched) {
    auto take = TakeWriter::open(*takePath(project, "a"), groom, 60, "{}");
    ASSERT_TRUE(take);
    for (int f = 0; f < 20; ++f) ASSERT_TRUE(take->add(groom.positions(), {}));
    EXPECT_TRUE(findTakes(project).recovered.empty());
    EXPECT_FALSE(TakeWriter::open(*takePath(project, "a"), groom, 60, "{}")) << "nor written twice at once";
    ASSERT_TRUE(take->finish());
    EXPECT_THAT(names(), ElementsAre("a"));
}

TEST_F(ProjectTakes, DifferencesAreThoseOfThePoints) {
    record("a", 10);
    record("b", 8, 0.003f);
    std::uint64_t last = 0;
    const auto difference = compareTakes(*takePath(project, "a"), *takePath(project, "b"), groom,
                                         [&](std::uint64_t done) { last = done; });
    ASSERT_TRUE(difference) << difference.error().message();
    EXPECT_EQ(last, 8u);
    ASSERT_EQ(difference->frames.size(), 8u);
    EXPECT_NEAR(difference->frames[0].rmsMm, 3, 1e-3);
    EXPECT_NEAR(difference->largestMm, 6, 1e-3);
    EXPECT_EQ(difference->worstFrame, 2u);
    EXPECT_NEAR(difference->rmsMm, std::sqrt((7 * 9 + 36) / 8.0), 1e-3);
    record("slow", 8, 0, true, 30);
    EXPECT_THAT(compareTakes(*takePath(project, "a"), *takePath(project, "slow"), groom, [](auto) {})
                    .error()
                    .message(),
                HasSubstr("has 30 frames a second"));
}

}  // namespace
}  // namespace hairloom::test
