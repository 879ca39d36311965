// SPDX-License-Identifier: GPL-3.0-or-later
// The table of docs/thesis.md: files, tests and settings that it names exist, and its counts are those of its
// rows.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/source_dir.h"

namespace {

namespace fs = std::filesystem;

std::string textOf(const fs::path& page) {
    std::ifstream in(hairloom::sourceDir() / page);
    return {std::istreambuf_iterator<char>(in), {}};
}

struct Row {
    int number = 0;
    std::string where, how, tests, verdict;
};

std::vector<Row> rowsOfThesis() {
    std::istringstream in(textOf("docs/thesis.md"));
    std::vector<Row> rows;
    const std::regex cell(R"(\|\s*([^|]*?)\s*(?=\|))");
    for (std::string line; std::getline(in, line);) {
        std::vector<std::string> cells;
        for (std::sregex_iterator at(line.begin(), line.end(), cell), end; at != end; ++at)
            cells.push_back((*at)[1]);
        if (cells.size() == 7 && !cells[0].empty() &&
            std::isdigit(static_cast<unsigned char>(cells[0][0])) != 0)
            rows.push_back({std::stoi(cells[0]), cells[3], cells[4], cells[5], cells[6]});
    }
    return rows;
}

std::vector<std::string> quoted(const std::string& text) {
    std::vector<std::string> found;
    const std::regex mark("`([^`]+)`");
    for (std::sregex_iterator at(text.begin(), text.end(), mark), end; at != end; ++at)
        found.push_back((*at)[1]);
    return found;
}

TEST(Thesis, HasARowForEachOfItsPointsInOrder) {
    const std::vector<Row> rows = rowsOfThesis();
    ASSERT_EQ(rows.size(), 142u);
    for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_EQ(rows[i].number, static_cast<int>(i) + 1);
}

TEST(Thesis, NamesFilesAndTestsThatExist) {
    for (const Row& row : rowsOfThesis()) {
        for (const std::string& file : quoted(row.where))
            EXPECT_TRUE(fs::exists(hairloom::sourceDir() / file)) << row.number << ": " << file;
        for (const std::string& test : quoted(row.tests))
            EXPECT_TRUE(fs::exists(hairloom::sourceDir() / "tests" / (test + ".cpp")))
                << row.number << ": " << test;
    }
}

TEST(Thesis, WhatWorksHasAFileATestAndAWayToReachIt) {
    std::map<std::string, int> counts;
    for (const Row& row : rowsOfThesis()) {
        const std::string verdict = row.verdict.substr(0, row.verdict.find_first_of(": "));
        ++counts[verdict];
        if (verdict != "works") {
            EXPECT_TRUE(verdict == "partly" || verdict == "missing" || verdict == "background")
                << row.number << ": " << row.verdict;
            continue;
        }
        EXPECT_FALSE(quoted(row.where).empty()) << row.number;
        EXPECT_FALSE(quoted(row.tests).empty()) << row.number;
        EXPECT_FALSE(row.how.empty()) << row.number;
    }
    const std::string said = std::to_string(counts["works"]) + " work, " + std::to_string(counts["partly"]) +
                             (counts["partly"] == 1 ? " works" : " work") + " partly, " +
                             std::to_string(counts["missing"]) + (counts["missing"] == 1 ? " is" : " are") +
                             " missing, and " + std::to_string(counts["background"]) + " are background";
    EXPECT_NE(textOf("docs/thesis.md").find(said), std::string::npos) << said;
}

TEST(Thesis, NamesSettingsAndOptionsThatExist) {
    const std::string reference = textOf("docs/reference.md");
    std::string options;
    for (const auto& entry : fs::recursive_directory_iterator(hairloom::sourceDir() / "cli")) {
        if (entry.path().extension() == ".cpp")
            options += textOf(fs::relative(entry.path(), hairloom::sourceDir()));
    }
    const std::regex setting(R"((material|simulation|interpolation)\.(\w+))"), option(R"(--[a-z][a-z-]+)");
    std::size_t seen = 0;
    for (const Row& row : rowsOfThesis()) {
        for (std::sregex_iterator at(row.how.begin(), row.how.end(), setting), end; at != end; ++at, ++seen)
            EXPECT_NE(reference.find("`" + (*at)[2].str() + "`"), std::string::npos)
                << row.number << ": " << at->str();
        for (std::sregex_iterator at(row.how.begin(), row.how.end(), option), end; at != end; ++at, ++seen)
            EXPECT_NE(options.find("\"" + at->str()), std::string::npos) << row.number << ": " << at->str();
    }
    EXPECT_GT(seen, 60u);
}

}  // namespace
