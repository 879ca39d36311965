// SPDX-License-Identifier: GPL-3.0-or-later
// Reads what users read: the strings of the window, the command line and all errors, and the pages. None has
// a word of docs/words.txt, and strings have few semicolons.

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/source_dir.h"
#include "tests/support/temporary_folder.h"

namespace {

namespace fs = std::filesystem;

struct Passage {
    std::string place;  ///< "docs/manual.md:12"
    std::string text;   ///< in small letters, blanks joined
};

std::string readAll(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

std::string nameOf(const fs::path& file) {
    return fs::relative(file, hairloom::sourceDir()).generic_string();
}

/// Small letters, with one blank in place of each run of blanks.
std::string plain(std::string_view text) {
    std::string out;
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (std::isspace(byte) == 0) {
            out += static_cast<char>(std::tolower(byte));
        } else if (!out.empty() && out.back() != ' ') {
            out += ' ';
        }
    }
    return out;
}

/// Where the literal that begins at `at` ends, behind its quotation mark.
std::size_t endOfLiteral(const std::string& text, std::size_t at) {
    const char quote = text[at];
    for (++at; at < text.size() && text[at] != quote && text[at] != '\n'; ++at)
        if (text[at] == '\\') ++at;
    return at + 1;
}

/// String literals of C++, those that follow each other joined as the compiler joins them.
std::vector<Passage> stringsOf(const fs::path& file) {
    const std::string text = readAll(file);
    std::vector<Passage> found;
    std::size_t line = 1;
    bool joins = false;
    for (std::size_t at = 0; at < text.size();) {
        const char c = text[at];
        std::size_t end = at + 1;
        if (text.compare(at, 2, "//") == 0 || c == '#') {
            end = text.find('\n', at);
            joins = joins && c != '#';
        } else if (text.compare(at, 3, "R\"(") == 0) {
            end = text.find(")\"", at);
            found.push_back(
                {nameOf(file) + ':' + std::to_string(line), plain(text.substr(at + 3, end - at - 3))});
            joins = false;
        } else if (c == '\'' && at > 0 && std::isalnum(static_cast<unsigned char>(text[at - 1])) == 0) {
            end = endOfLiteral(text, at);
            joins = false;
        } else if (c == '"') {
            end = endOfLiteral(text, at);
            const std::string literal = text.substr(at + 1, end - at - 2);
            if (joins) {
                found.back().text = plain(found.back().text + literal);
            } else {
                found.push_back({nameOf(file) + ':' + std::to_string(line), plain(literal)});
            }
            joins = true;
        } else if (std::isspace(static_cast<unsigned char>(c)) == 0) {
            joins = false;
        }
        end = std::min(end, text.size());
        line += static_cast<std::size_t>(std::count(text.begin() + static_cast<std::ptrdiff_t>(at),
                                                    text.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
        at = end;
    }
    return found;
}

/// Paragraphs of a page without code.
std::vector<Passage> paragraphsOf(const fs::path& page) {
    std::istringstream lines(readAll(page));
    std::vector<Passage> found;
    std::string line;
    bool code = false, begins = true;
    for (std::size_t number = 1; std::getline(lines, line); ++number) {
        if (line.starts_with("```")) {
            code = !code;
            begins = true;
            continue;
        }
        if (code) continue;
        std::string prose;
        bool inlineCode = false;
        for (const char c : line) {
            if (c == '`') inlineCode = !inlineCode;
            prose += inlineCode || c == '`' ? '~' : c;
        }
        if (plain(prose).empty()) {
            begins = true;
            continue;
        }
        if (begins || prose.starts_with('|'))
            found.push_back({nameOf(page) + ':' + std::to_string(number), {}});
        begins = false;
        found.back().text = plain(found.back().text + ' ' + prose);
    }
    return found;
}

std::vector<fs::path> filesIn(const std::vector<std::string>& folders,
                              const std::vector<std::string>& suffixes) {
    std::vector<fs::path> found;
    for (const std::string& folder : folders) {
        for (const auto& entry : fs::recursive_directory_iterator(hairloom::sourceDir() / folder)) {
            if (std::ranges::find(suffixes, entry.path().extension().string()) != suffixes.end())
                found.push_back(entry.path());
        }
    }
    std::ranges::sort(found);
    return found;
}

std::vector<Passage> stringsForUsers() {
    const std::vector<fs::path> sources =
        filesIn({"editor", "cli", "core", "importers", "exporters", "runtime", "benchmarks", "samples"},
                {".cpp", ".h"});
    std::vector<Passage> all;
    for (const fs::path& source : sources) {
        const auto some = stringsOf(source);
        all.insert(all.end(), some.begin(), some.end());
    }
    return all;
}

std::vector<Passage> pagesForUsers() {
    std::vector<fs::path> pages = filesIn({"docs"}, {".md"});
    pages.push_back(hairloom::sourceDir() / "README.md");
    pages.push_back(hairloom::sourceDir() / "CONTRIBUTING.md");
    std::vector<Passage> all;
    for (const fs::path& page : pages) {
        // What has changed keeps the words of its time.
        if (page.filename() == "FormatChanges.md") continue;
        const auto some = paragraphsOf(page);
        all.insert(all.end(), some.begin(), some.end());
    }
    return all;
}

bool isWordAt(const std::string& text, std::size_t at, std::size_t length) {
    const auto isLetter = [&](std::size_t i) {
        return i < text.size() && (std::isalnum(static_cast<unsigned char>(text[i])) != 0 || text[i] == '-');
    };
    return (at == 0 || !isLetter(at - 1)) && !isLetter(at + length);
}

bool has(const std::string& text, const std::string& phrase) {
    for (std::size_t at = text.find(phrase); at != std::string::npos; at = text.find(phrase, at + 1))
        if (isWordAt(text, at, phrase.size())) return true;
    return false;
}

/// The phrases of docs/words.txt with what to write instead.
std::vector<std::pair<std::string, std::string>> phrases() {
    std::istringstream lines(readAll(hairloom::sourceDir() / "docs/words.txt"));
    std::vector<std::pair<std::string, std::string>> found;
    for (std::string line; std::getline(lines, line);) {
        const auto tab = line.find('\t');
        if (line.starts_with('#') || tab == std::string::npos) continue;
        found.emplace_back(line.substr(0, tab), line.substr(tab + 1));
    }
    return found;
}

/// A line for each phrase in a passage, with what to write instead; empty where there is none.
std::string found(const std::vector<Passage>& passages) {
    std::string all;
    for (const auto& [phrase, instead] : phrases())
        for (const Passage& passage : passages)
            if (has(passage.text, phrase))
                all += passage.place + ": \"" + phrase + "\": write " + instead + '\n';
    return all;
}

TEST(Words, OfTheListAreInNoStringThatUsersRead) {
    const auto strings = stringsForUsers();
    EXPECT_GT(strings.size(), 8000u);
    EXPECT_GT(phrases().size(), 20u);
    EXPECT_EQ(found(strings), "");
}

TEST(Words, OfTheListAreOnNoPage) {
    const auto paragraphs = pagesForUsers();
    EXPECT_GT(paragraphs.size(), 500u);
    EXPECT_EQ(found(paragraphs), "");
}

TEST(Words, AreFoundWhereTheyAreAndNowhereElse) {
    EXPECT_TRUE(has("what stands for it", "stands for"));
    EXPECT_FALSE(has("it understands for-loops", "stands for"));
    EXPECT_TRUE(has(plain("So\n  many"), "so many"));
    const hairloom::TemporaryFolder folder;
    const auto file = folder / "words.cpp";
    std::ofstream(file)
        << "// \"so many\"\n#include \"anew.h\"\nconst char c = '\"';\nf(\"so \"\n  \"many\", \"a \\\" b\");";
    const auto strings = stringsOf(file);
    ASSERT_EQ(strings.size(), 2u);
    EXPECT_EQ(strings[0].text, "so many");
    EXPECT_TRUE(strings[0].place.ends_with(":4"));
}

TEST(Words, ComeWithFewerThanFiveSemicolonsInAThousand) {
    std::size_t words = 0, semicolons = 0;
    for (const Passage& passage : stringsForUsers()) {
        // Names, style sheets and filters of file dialogs are no sentences.
        if (std::ranges::count(passage.text, ' ') < 3 || passage.text.find("{ ") != std::string::npos ||
            passage.text.find(";;") != std::string::npos)
            continue;
        words += static_cast<std::size_t>(std::ranges::count(passage.text, ' ')) + 1;
        semicolons += static_cast<std::size_t>(std::ranges::count(passage.text, ';'));
    }
    EXPECT_GT(words, 5000u);
    EXPECT_LT(1000 * semicolons, 5 * words) << semicolons << " in " << words;
}

/// Each page by itself: a few plain pages do not make up for one that is hard to read.
TEST(Words, OfEachPageComeWithFewerThanFiveSemicolonsInAThousand) {
    struct Count {
        std::size_t words = 0, semicolons = 0;
    };
    std::map<std::string, Count> pages;
    for (const Passage& passage : pagesForUsers()) {
        Count& page = pages[passage.place.substr(0, passage.place.rfind(':'))];
        page.words += static_cast<std::size_t>(std::ranges::count(passage.text, ' ')) + 1;
        page.semicolons += static_cast<std::size_t>(std::ranges::count(passage.text, ';'));
    }
    EXPECT_GT(pages.size(), 25u);
    for (const auto& [page, count] : pages)
        EXPECT_LT(1000 * count.semicolons, 5 * count.words)
            << page << ": " << count.semicolons << " in " << count.words;
}

}  // namespace
