// SPDX-License-Identifier: GPL-3.0-or-later
// What people call painted masks: the rules, and that files, hashes and comparisons have them.
#include <gmock/gmock.h>

#include "core/base/file.h"
#include "core/groom/file/project_file.h"
#include "core/groom/groom_diff.h"
#include "core/groom/groom_hash.h"
#include "core/groom/mask_names.h"
#include "core/groom/validate.h"
#include "tests/groom/groom_samples.h"
#include "tests/support/temporary_folder.h"

namespace hairloom {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Names = std::vector<std::string>;

std::string problemOf(const Names& names, std::uint32_t number, std::string_view name) {
    const auto changed = maskNamesWith(names, number, name);
    return changed ? "taken" : changed.error().message();
}

TEST(MaskNames, AreGivenAndTakenAway) {
    Groom groom;
    EXPECT_EQ(maskName(groom, 2), "Mask 2");
    groom.maskNames = maskNamesWith({}, 2, "  Fringe ").value();
    EXPECT_THAT(groom.maskNames, ElementsAre("", "Fringe"));
    EXPECT_EQ(maskName(groom, 1), "Mask 1");
    EXPECT_EQ(maskName(groom, 2), "Fringe");
    EXPECT_EQ(maskName(groom, 4), "Mask 4");
    EXPECT_THAT(maskNamesWith(groom.maskNames, 2, "").value(), IsEmpty());
    EXPECT_THAT(maskNamesWith(groom.maskNames, 2, "mask 2").value(), IsEmpty()) << "that is no name";
    EXPECT_THAT(maskNamesWith(groom.maskNames, 2, "fringe").value(), ElementsAre("", "fringe"));
}

TEST(MaskNames, AreFoundByNameAndNumber) {
    Groom groom;
    groom.maskNames = {"", "Nacken – unten"};
    EXPECT_EQ(findMask(groom, "nacken – unten").value(), 2u);
    EXPECT_EQ(findMask(groom, "2").value(), 2u);
    EXPECT_EQ(findMask(groom, "Mask 3").value(), 3u);
    EXPECT_EQ(findMask(groom, "mask 2").value(), 2u) << "formulas and lists have its number";
    for (const char* name : {"5", "0", "fringe", ""}) EXPECT_FALSE(findMask(groom, name)) << name;
    EXPECT_THAT(findMask(groom, "fringe").error().message(),
                HasSubstr("no mask is called 'fringe'; one of: Mask 1, Nacken – unten, Mask 3, Mask 4"));
}

TEST(MaskNames, ThatNobodyCouldTellApartAreRefused) {
    const Names names{"Fringe"};
    EXPECT_THAT(problemOf(names, 2, "FRINGE"), HasSubstr("masks 1 and 2 are both called 'FRINGE'"));
    EXPECT_THAT(problemOf(names, 2, "7"), HasSubstr("mask 2 is called '7', as a number"));
    EXPECT_THAT(problemOf(names, 2, "mask 3"), HasSubstr("mask 2 is called 'mask 3', as mask 3 is"));
    EXPECT_THAT(problemOf(names, 2, "a\nb"), HasSubstr("control characters"));
    EXPECT_THAT(problemOf(names, 2, std::string(kLongestMaskName + 1, 'a')), HasSubstr("65 bytes long"));
    EXPECT_THAT(problemOf(names, 5, "Nape"), HasSubstr("there is no mask 5"));
    EXPECT_THAT(problemOf(names, 0, "Nape"), HasSubstr("there is no mask 0"));
    EXPECT_EQ(problemOf(names, 2, std::string(kLongestMaskName, 'a')), "taken");
}

TEST(MaskNames, AreInProjectsAndInNoneThatHasNone) {
    const TemporaryFolder folder;
    Groom groom = fullGroom();
    ASSERT_TRUE(saveProject(groom, folder / "a.hairloom"));
    EXPECT_THAT(readTextFile((folder / "a.hairloom").string(), 1u << 26u).value(),
                testing::Not(HasSubstr("\"masks\"")));
    const auto without = contentHash(groom);
    groom.maskNames = {"", "Fringe"};
    EXPECT_NE(contentHash(groom), without);
    ASSERT_TRUE(saveProject(groom, folder / "b.hairloom"));
    const auto loaded = readProjectFile(folder / "b.hairloom");
    ASSERT_TRUE(loaded) << loaded.error().message();
    EXPECT_EQ(loaded->maskNames, groom.maskNames);
    EXPECT_TRUE(sameContent(*loaded, groom));
    groom.maskNames = {"Fringe", "fringe"};
    const auto refused = saveProject(groom, folder / "b.hairloom");
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message(), HasSubstr("masks 1 and 2 are both called 'fringe'"));
    EXPECT_THAT(validate(groom), testing::Not(IsEmpty()));
}

TEST(MaskNames, ThatAreWrongInAFileAreNamedByTheirPlace) {
    const auto problem = [](const char* text) {
        const auto json = nlohmann::json::parse(text);
        JsonReader reader(json, "a.json");
        Names names;
        readMaskNames(reader.object("masks"), names);
        const auto status = reader.status();
        return status ? "taken" : status.error().message();
    };
    EXPECT_EQ(problem(R"({"masks": {"1": "Fringe", "4": "Nape"}})"), "taken");
    EXPECT_THAT(problem(R"({"masks": {"5": "Nape"}})"), HasSubstr("/masks/5 is not a mask; expected 1 to 4"));
    EXPECT_THAT(problem(R"({"masks": {"x": "Nape"}})"), HasSubstr("/masks/x is not a mask"));
    EXPECT_THAT(problem(R"({"masks": {"1": 3}})"), HasSubstr("/masks/1 is 3"));
    EXPECT_THAT(problem(R"({"masks": ["Nape"]})"), HasSubstr("masks"));
    EXPECT_THAT(problem(R"({"masks": {"1": "Nape", "2": "nape"}})"),
                HasSubstr("/masks/2 cannot be its name: masks 1 and 2 are both called 'nape'"));
}

TEST(MaskNames, AreCompared) {
    Groom before = fullGroom(), after = before;
    before.maskNames = {"Fringe", "Nape"};
    after.maskNames = {"Bangs", "", "Beard"};
    std::vector<std::string> words;
    for (const GroomDifference& one : compare({before, "a.hairloom"}, {after, "a.hairloom"}).differences)
        words.push_back(inWords(one));
    EXPECT_THAT(words, testing::UnorderedElementsAre(HasSubstr("masks.1: \"Fringe\" → \"Bangs\""),
                                                     HasSubstr("masks.2"), HasSubstr("masks.3")));
}

}  // namespace
}  // namespace hairloom
