// SPDX-License-Identifier: GPL-3.0-or-later
// Clang 14, by which `./dev fuzz`, `./dev check` and `./dev compilers` read the sources, rejects the views of
// libstdc++ 12, and with them each algorithm of std::ranges that returns a subrange.

#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <string>

#include "tests/architecture/includes.h"
#include "tests/support/source_dir.h"

namespace hairloom {
namespace {

const std::regex& rejected() {
    static const std::regex words(
        "std::(views::|ranges::(views::|subrange|partition\\b|stable_partition|remove\\b|remove_if|unique\\b|"
        "rotate\\b|search\\b|search_n|equal_range|find_end))");
    return words;
}

TEST(Compilers, NoSourceUsesRangesThatClang14Rejects) {
    EXPECT_TRUE(std::regex_search(std::string("std::ranges::stable_partition(used, isRead);"), rejected()));
    std::size_t lines = 0;
    for (const std::string& path : sourceFiles()) {
        std::ifstream file(sourceDir() / path);
        std::size_t number = 0;
        for (std::string line; std::getline(file, line); ++lines) {
            ++number;
            if (path.rfind("tests/architecture/", 0) == 0) continue;
            EXPECT_FALSE(std::regex_search(line, rejected())) << path << ":" << number << ": " << line;
        }
    }
    EXPECT_GT(lines, 100'000u);
}

}  // namespace
}  // namespace hairloom
