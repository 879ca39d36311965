// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/obj_text.h"

#include <algorithm>
#include <charconv>
#include <limits>

namespace hairloom {
ObjLines::ObjLines(std::string_view text) : text_(text) {
    if (text_.starts_with("\xef\xbb\xbf")) text_.remove_prefix(3);
    if (text_.find('\n') == text_.npos) lineEnd_ = '\r';
}

std::string_view ObjLines::takeLine() {
    const std::size_t end = std::min(text_.find(lineEnd_), text_.size());
    const std::string_view line = text_.substr(0, end);
    text_.remove_prefix(std::min(end + 1, text_.size()));
    ++taken_;
    return trimmed(line);
}

bool ObjLines::next() {
    while (!text_.empty()) {
        std::string_view line = takeLine();
        number_ = taken_;
        if (line.starts_with('#')) continue;
        if (line.ends_with('\\')) {
            joined_.clear();
            while (line.ends_with('\\')) {
                joined_.append(line.substr(0, line.size() - 1)).push_back(' ');
                line = text_.empty() ? std::string_view() : takeLine();
            }
            joined_.append(line);
            line = trimmed(joined_);
        }
        if (line.empty()) continue;
        rest_ = line;
        keyword_ = takeWord(rest_);
        // Names may hold a '#', data may not.
        constexpr std::size_t kLongestOfData = std::string_view("curv").size();
        if (keyword_.size() <= kLongestOfData && keyword_ != "g" && keyword_ != "o")
            rest_ = rest_.substr(0, rest_.find('#'));
        rest_ = trimmed(rest_);
        return true;
    }
    return false;
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && isBlank(text.front())) text.remove_prefix(1);
    while (!text.empty() && isBlank(text.back())) text.remove_suffix(1);
    return text;
}

std::optional<double> parseNumber(std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0;
    const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (code == std::errc::invalid_argument || end != word.data() + word.size()) return std::nullopt;
    if (code == std::errc::result_out_of_range) {
        const bool tiny = word.find("e-") != word.npos || word.find("E-") != word.npos;
        return tiny ? 0.0 : std::numeric_limits<double>::infinity();
    }
    return value;
}

std::optional<std::int64_t> parseWhole(std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);
    std::int64_t value = 0;
    const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (code != std::errc() || end != word.data() + word.size()) return std::nullopt;
    return value;
}

std::string shortened(std::string_view text) {
    constexpr std::size_t kMax = 60;
    std::string shown(text.substr(0, kMax));
    std::ranges::replace_if(
        shown,
        [](char c) { return static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) >= 0x7f; },
        '?');
    if (text.size() > kMax) shown += "…";
    return shown;
}

}  // namespace hairloom
