// SPDX-License-Identifier: GPL-3.0-or-later
// The journeys of docs/architecture.md: each stop is in the sources, and their number is that of the column
// "now".

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/source_dir.h"

namespace {

namespace fs = std::filesystem;

/// Names that the sources define or use, and names of their files without what follows the point.
const std::set<std::string>& names() {
    static const std::set<std::string> kNames = [] {
        std::set<std::string> found;
        for (const char* folder : {"core", "editor", "exporters", "importers", "runtime", "cli"}) {
            for (const auto& entry : fs::recursive_directory_iterator(hairloom::sourceDir() / folder)) {
                const std::string suffix = entry.path().extension().string();
                if (suffix != ".cpp" && suffix != ".h") continue;
                found.insert(entry.path().stem().string());
                std::ifstream in(entry.path());
                std::string name;
                for (char c = 0; in.get(c);) {
                    if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_') {
                        name += c;
                    } else if (!name.empty()) {
                        found.insert(name);
                        name.clear();
                    }
                }
            }
        }
        return found;
    }();
    return kNames;
}

std::vector<std::string> cellsOf(const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream in(line.substr(1));
    for (std::string cell; std::getline(in, cell, '|');) {
        const auto begin = cell.find_first_not_of(' '), end = cell.find_last_not_of(' ');
        cells.push_back(begin == std::string::npos ? "" : cell.substr(begin, end + 1 - begin));
    }
    return cells;
}

std::vector<std::string> stopsOf(const std::string& cell) {
    std::vector<std::string> stops;
    std::istringstream in(cell.substr(0, cell.find(". ")));
    for (std::string stop; std::getline(in >> std::ws, stop, ',');) stops.push_back(stop);
    return stops;
}

TEST(Journeys, HaveTheStopsThatThePageLists) {
    std::ifstream page(hairloom::sourceDir() / "docs/architecture.md");
    std::string line;
    while (std::getline(page, line) && line != "| journey | stops | before | now | aim |") {
    }
    std::getline(page, line);
    std::size_t journeys = 0;
    for (; std::getline(page, line) && line.starts_with('|'); ++journeys) {
        const auto cells = cellsOf(line);
        ASSERT_EQ(cells.size(), 5u) << line;
        const auto stops = stopsOf(cells[1]);
        for (const std::string& stop : stops) EXPECT_TRUE(names().contains(stop)) << stop << " in: " << line;
        EXPECT_EQ(std::to_string(stops.size()), cells[3]) << line;
    }
    EXPECT_GE(journeys, 6u);
    EXPECT_FALSE(names().contains("LiveLink")) << "a stop that is gone";
}

}  // namespace
