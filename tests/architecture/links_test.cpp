// SPDX-License-Identifier: GPL-3.0-or-later
// Follows the links of the pages: every file of ours that one names is there, and so is the heading behind a
// #.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cctype>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/support/source_dir.h"

namespace {

namespace fs = std::filesystem;
using testing::IsEmpty;

std::vector<fs::path> pages() {
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator(hairloom::sourceDir()))
        if (entry.path().extension() == ".md") found.push_back(entry.path());
    for (const auto& entry : fs::recursive_directory_iterator(hairloom::sourceDir() / "docs"))
        if (entry.path().extension() == ".md") found.push_back(entry.path());
    return found;
}

/// The page without its code, in which brackets are no links.
std::string proseOf(const fs::path& page) {
    std::ifstream file(page);
    std::string text;
    std::string line;
    bool code = false;
    while (std::getline(file, line)) {
        if (line.rfind("```", 0) == 0) code = !code;
        if (!code && line.rfind("    ", 0) != 0) text += line + "\n";
    }
    static const std::regex inlineCode("`[^`\n]*`");
    return std::regex_replace(text, inlineCode, "");
}

/// Names of a page's headings as links have them: small letters, digits and hyphens.
std::set<std::string> anchorsOf(const fs::path& page) {
    std::set<std::string> anchors;
    std::ifstream file(page);
    std::string line;
    while (std::getline(file, line)) {
        if (line.rfind('#', 0) != 0) continue;
        std::string anchor;
        for (const char c : line.substr(line.find_first_not_of("# "))) {
            if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_')
                anchor += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
            else if (c == ' ')
                anchor += '-';
        }
        anchors.insert(anchor);
    }
    return anchors;
}

TEST(Links, LeadToFilesAndHeadingsThatExist) {
    static const std::regex link(R"(\]\(([^)\s]+)\))");
    std::vector<std::string> broken;
    std::size_t count = 0;
    for (const fs::path& page : pages()) {
        const std::string text = proseOf(page);
        for (std::sregex_iterator match(text.begin(), text.end(), link), end; match != end; ++match) {
            const std::string target = (*match)[1];
            if (target.find("://") != std::string::npos) continue;
            ++count;
            const std::size_t hash = target.find('#');
            const std::string name = target.substr(0, hash);
            const fs::path file = name.empty() ? page : page.parent_path() / name;
            const bool found = fs::exists(file) && (hash == std::string::npos ||
                                                    anchorsOf(file).contains(target.substr(hash + 1)));
            if (!found)
                broken.push_back(fs::relative(page, hairloom::sourceDir()).generic_string() + " links to " +
                                 target);
        }
    }
    EXPECT_GT(count, 50u);
    EXPECT_THAT(broken, IsEmpty());
}

}  // namespace
