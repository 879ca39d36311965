// SPDX-License-Identifier: GPL-3.0-or-later
// The lists of what there is to set, and the page that is made from them.

#include <gmock/gmock.h>

#include <fstream>
#include <sstream>

#include "tests/cli/command.h"
#include "tests/support/source_dir.h"

namespace hairloom::test {
namespace {

class Reference : public CommandLineTest {};

TEST_F(Reference, PageIsUpToDate) {
    runJson("reference -o reference.md");
    EXPECT_EQ(readText(folder / "reference.md"), readText(sourceDir() / "docs/reference.md"))
        << "`hairloom-cli reference -o docs/reference.md` makes it anew";
}

TEST_F(Reference, ReadmeHasWhatTheProgramHas) {
    const std::string readme = readText(sourceDir() / "README.md");
    std::ofstream(folder / "README.md") << readme;
    runJson("reference --readme README.md --force");
    EXPECT_EQ(readText(folder / "README.md"), readme)
        << "`hairloom-cli reference --readme README.md` makes its table anew";
    std::ofstream(folder / "README.md") << "# A page without marks\n";
    EXPECT_EQ(run("reference --readme README.md --force").exitCode, 1);
    EXPECT_EQ(readText(folder / "README.md"), "# A page without marks\n");
}

TEST_F(Reference, HelpFitsAScreen) {
    for (const char* job : {"", "export", "simulate", "render", "create"}) {
        std::istringstream lines(run(std::string(job) + " --help").output);
        for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 110u) << line;
    }
    EXPECT_THAT(run("export --help").output,
                testing::HasSubstr("\n                          abc             "));
}

TEST_F(Reference, GroomListsOperationsAndBrushesWithTheirFields) {
    const auto listed = runJson("groom --list");
    const auto named = [](const nlohmann::json& rows, const char* name) -> const nlohmann::json& {
        for (const auto& row : rows) {
            if (row["name"] == name) return row;
        }
        ADD_FAILURE() << name << " is not in the list";
        return rows;
    };
    const nlohmann::json radius{{"field", "radius"}, {"unit", "m"},      {"min", 0},
                                {"max", 0.1},        {"default", 0.006}, {"meaning", "radius of the helix"}};
    EXPECT_EQ(named(listed["operators"], "curl")["fields"][0], radius);
    const auto& puff = named(listed["brushes"], "puff");
    EXPECT_EQ(puff["fields"][0]["field"], "height");
    EXPECT_EQ(puff["fields"][0]["default"], 0.01);
    EXPECT_EQ(puff["fields"][0]["max"], 0.1);
    EXPECT_EQ(named(listed["brushes"], "delete")["fields"][0]["default"], true);
    EXPECT_EQ(listed["region"].size(), 6u);
    EXPECT_EQ(listed["brush_settings"][0]["field"], "radius");
    EXPECT_EQ(run("groom hair.hairloom").exitCode, 2) << "neither --list nor a script";
}

TEST_F(Reference, JobsAsDataHaveWhatTheirHelpHas) {
    const auto written = runJson("reference --jobs jobs.json");
    const auto all = nlohmann::json::parse(readText(folder / "jobs.json"));
    ASSERT_EQ(all["jobs"].size(), written["jobs"].get<std::size_t>());
    EXPECT_EQ(all["options"].front()["name"], "version");
    for (const auto& job : all["jobs"]) {
        const std::string help = run(job["name"].get<std::string>() + " --help").output;
        EXPECT_THAT(help, testing::HasSubstr(job["does"].get<std::string>()));
        for (const auto& option : job["options"]) {
            const bool placed = option["argument"].is_null();
            EXPECT_THAT(
                help, testing::HasSubstr((placed ? option["name"] : option["argument"]).get<std::string>()));
        }
    }
    const auto optionOf = [&](const char* name, const char* wanted) -> nlohmann::json {
        for (const auto& job : all["jobs"]) {
            for (const auto& option : job["options"])
                if (job["name"] == name && option["name"] == wanted) return option;
        }
        ADD_FAILURE() << name << ' ' << wanted;
        return {};
    };
    EXPECT_EQ(optionOf("render", "camera")["choices"].size(), 7u);
    EXPECT_EQ(optionOf("simulate", "frames")["type"], "UINT");
    EXPECT_EQ(optionOf("simulate", "sag")["type"], "FLAG");
    EXPECT_EQ(optionOf("set", "fields")["many"], true);
    EXPECT_EQ(optionOf("simulate", "groom")["required"], true);
    EXPECT_EQ(optionOf("budget", "ms")["argument"], "--ms") << "an option of a group";
}

TEST_F(Reference, ManualPagesHaveEveryJobAndBrush) {
    const auto written = runJson("reference --man man");
    EXPECT_EQ(written["files"].size(), 2u);
    const std::string page = readText(folder / "man/hairloom-cli.1");
    for (const char* line : {".SH NAME", ".B \\-\\-json", ".SS export", ".SS simulate", ".B \\-\\-frames ",
                             "hairloom\\-cli simulate hair.hairloom"})
        EXPECT_THAT(page, testing::HasSubstr(line));
    // Troff takes a line that begins so for an order of its own, of which these pages use a few.
    std::istringstream lines(page);
    for (std::string line; std::getline(lines, line);) {
        if (line.empty() || line[0] != '.') continue;
        EXPECT_THAT(line, testing::MatchesRegex("\\.(TH|SH|SS|TP|PP|B|BR|RB|RI|I|RS|RE|EX|EE|br)( .*)?"));
    }
    EXPECT_THAT(readText(folder / "man/hairloom.1"), testing::HasSubstr(".B Comb\n"));
    EXPECT_EQ(run("reference").exitCode, 2) << "neither a page nor a folder";
}

}  // namespace
}  // namespace hairloom::test
