// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// USD's text below its grammar: characters, words, texts, numbers and values.

#include <cstdint>
#include <string>
#include <string_view>

#include "importers/usd_stage.h"

namespace hairloom {

/// Walks over a text. What takes something says whether it was there, and leaves the first thing that was
/// wrong for error().
class UsdaScanner {
  public:
    explicit UsdaScanner(std::string_view text) : text_(text) {}

    /// Remembers what is wrong here, where nothing was before. Always false.
    bool wrong(std::string what, std::string expected);
    /// What was wrong first, in `file`.
    tl::unexpected<Error> error(const std::string& file) const;

    bool atEnd();
    char peek();
    bool take(char c);
    bool need(char c);
    /// Whether the text goes on with it, after blanks.
    bool startsWith(std::string_view word);
    /// The next characters, for messages.
    std::string shown();
    std::string_view word();
    /// The next word, left where it is.
    std::string_view nextWord();

    /// "text", 'text', or three quotation marks.
    bool takeString(std::string& into);
    /// @asset@ or @@@asset@@@.
    bool takeAsset(std::string& into);
    /// <path>.
    bool takePath(std::string& into);
    bool number(UsdValue& value);
    /// Whatever an attribute may have: a number, tuple, text, path, list of these; dictionaries are read
    /// over.
    bool value(UsdValue& into);
    bool skipBlock(char open, char close);

  private:
    void skip();
    void takeEscape(std::string& into);
    bool takeUntil(std::string_view close, std::string& into);
    bool scalar(UsdValue& value);
    bool namedScalar(UsdValue& value);
    bool tuple(UsdValue& value, int depth);
    bool element(UsdValue& value);

    std::string_view text_;
    std::size_t at_ = 0;
    std::uint64_t line_ = 1, failedLine_ = 0;
    std::string problem_, expected_;
};

}  // namespace hairloom
