// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The lines, words and numbers of OBJ files; PLY's text has the same words and numbers.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace hairloom {

/// Goes through a text line by line: joins lines that end in a backslash, leaves out comments and empty
/// lines, accepts LF, CR LF, lone CR, a byte order mark and a last line without an end.
class ObjLines {
  public:
    /// `text` must outlive the lines.
    explicit ObjLines(std::string_view text);

    /// The next line with a keyword; false at the end of the text.
    bool next();
    std::uint64_t number() const { return number_; }       ///< of the line's first part, counted from 1
    std::string_view keyword() const { return keyword_; }  ///< valid until next()
    std::string_view rest() const { return rest_; }        ///< without blanks around it, valid until next()

  private:
    std::string_view takeLine();

    std::string_view text_;
    char lineEnd_ = '\n';
    std::string joined_;
    std::string_view keyword_, rest_;
    std::uint64_t number_ = 0;
    std::uint64_t taken_ = 0;
};

/// Whether a character stands between words; line ends do, where a line is searched.
constexpr bool isBlank(char c) {
    return c == ' ' || (c >= '\t' && c <= '\r') || c == '\0';
}

/// Removes the first word from `text` and returns it; empty when there is none. Inline because reading a file
/// of strands is little else.
inline std::string_view takeWord(std::string_view& text) {
    const char* begin = text.data();
    const char* const stop = begin + text.size();
    while (begin != stop && isBlank(*begin)) ++begin;
    const char* end = begin;
    while (end != stop && !isBlank(*end)) ++end;
    text = {end, static_cast<std::size_t>(stop - end)};
    return {begin, static_cast<std::size_t>(end - begin)};
}

/// The text without blanks around it.
std::string_view trimmed(std::string_view text);

/// A decimal number, also with a leading plus, infinite where it is too large. Empty when the word is no
/// number or goes on after it.
std::optional<double> parseNumber(std::string_view word);

/// A whole number, also with a leading plus. Empty when the word is none, goes on after it or is too large.
std::optional<std::int64_t> parseWhole(std::string_view word);

/// At most 60 bytes of printable characters, for messages.
std::string shortened(std::string_view text);

}  // namespace hairloom
