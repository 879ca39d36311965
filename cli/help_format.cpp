// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/help_format.h"

#include <fmt/format.h>

namespace hairloom::cli {
namespace {

constexpr std::size_t kWidth = 100, kColumn = 26;

void addSentence(std::string& text, const std::string& sentence) {
    if (!text.empty()) text += text.back() == '.' || text.back() == '\n' ? " " : ". ";
    text += sentence;
}

std::string namesOf(const std::set<CLI::Option*>& options) {
    std::string names;
    for (const CLI::Option* option : options) names += (names.empty() ? "" : ", ") + option->get_name();
    return names;
}

}  // namespace

OptionValues valuesOf(const CLI::Option& option) {
    const std::string words = option.get_type_name();
    OptionValues values{words.substr(0, words.find_first_of(":{")), {}, {}};
    const auto between = [&](char open, char close) -> std::string {
        const auto begin = words.find(open), end = words.rfind(close);
        if (begin == std::string::npos || end == std::string::npos || end < begin) return {};
        return words.substr(begin + 1, end - begin - 1);
    };
    values.choices = between('{', '}');
    values.range = between('[', ']');
    return values;
}

std::string meaningOf(const CLI::Option& option) {
    const OptionValues kind = valuesOf(option);
    const std::string said = option.get_description();
    const auto list = said.find('\n');
    std::string text = said.substr(0, list);
    // A description that lists its choices has named them.
    if (!kind.choices.empty() && list == std::string::npos)
        addSentence(text, fmt::format("One of: {}", spaced(kind.choices)));
    if (!kind.range.empty()) addSentence(text, fmt::format("Range: {}", kind.range));
    if (!option.get_default_str().empty())
        addSentence(text, fmt::format("Default: {}", option.get_default_str()));
    if (option.get_required()) addSentence(text, "Required");
    if (!option.get_needs().empty()) addSentence(text, fmt::format("Needs {}", namesOf(option.get_needs())));
    if (!option.get_excludes().empty())
        addSentence(text, fmt::format("Excludes {}", namesOf(option.get_excludes())));
    return list == std::string::npos ? text : text + said.substr(list);
}

std::string termOf(const CLI::Option& option) {
    if (option.get_positional()) return option.get_name(true);
    const std::string type = valuesOf(option).type;
    return option.get_name(false, true) + (type.empty() ? "" : " " + type);
}

std::string spaced(std::string_view list) {
    std::string out;
    for (const char c : list) out += c == ',' ? ", " : std::string(1, c);
    return out;
}

std::string wrapped(std::string_view text, std::size_t width, std::size_t indent) {
    std::string out;
    std::size_t column = indent;
    while (!text.empty()) {
        const auto end = text.find(' ');
        const std::string_view word = text.substr(0, end);
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
        if (column > indent && column + 1 + word.size() > width) {
            out += '\n' + std::string(indent, ' ');
            column = indent;
        } else if (column > indent) {
            out += ' ';
            ++column;
        }
        out += word;
        column += word.size();
    }
    return out;
}

std::string HelpFormatter::make_option(const CLI::Option* option, bool isPositional) const {
    const OptionValues kind = valuesOf(*option);
    std::string left = "  " + make_option_name(option, isPositional);
    if (!isPositional && !kind.type.empty()) left += " " + kind.type;
    left += left.size() + 2 > kColumn ? "\n" + std::string(kColumn, ' ')
                                      : std::string(kColumn - left.size(), ' ');
    std::string out;
    std::string_view rest;
    const std::string meaning = meaningOf(*option);
    for (rest = meaning; !rest.empty();) {
        const auto end = rest.find('\n');
        const std::string_view line = rest.substr(0, end);
        rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
        // The term of a list keeps its column.
        const auto gap = line.find("  ");
        const auto text = gap == std::string_view::npos ? 0 : line.find_first_not_of(' ', gap);
        out += out.empty() ? left : std::string(kColumn, ' ');
        out += line.substr(0, text);
        out += wrapped(line.substr(text), kWidth, kColumn + text) + '\n';
    }
    return out.empty() ? left + '\n' : out;
}

}  // namespace hairloom::cli
