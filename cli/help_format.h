// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How `--help` looks: within 100 columns, a choice of many each on a line of its own.

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <string>
#include <string_view>

namespace hairloom::cli {

/// What an option takes, read from the parser's name of its type: "TEXT:{y,z}", "INT:INT in [0 - 1024]".
struct OptionValues {
    std::string type;     ///< TEXT
    std::string choices;  ///< "y,z", or empty
    std::string range;    ///< "0 - 1024", or empty
};
OptionValues valuesOf(const CLI::Option& option);

/// What an option does, with its choices, range and default, what it needs and what it excludes. A list of
/// choices with a meaning each follows in lines of its own: `abc  Alembic`.
std::string meaningOf(const CLI::Option& option);

/// `-o,--output TEXT`, or the name of an argument that stands without one.
std::string termOf(const CLI::Option& option);

/// Lines of an option's description stay lines; each is wrapped, and what follows two spaces inside a line
/// hangs under itself: `abc  Alembic`.
class HelpFormatter : public CLI::Formatter {
  public:
    std::string make_option(const CLI::Option* option, bool isPositional) const override;
};

/// A list with a space after each comma, so that a line can end there.
std::string spaced(std::string_view list);

/// `text` in lines of at most `width` columns, without the last line's end.
/// All but the first are indented by `indent` columns, which count.
std::string wrapped(std::string_view text, std::size_t width, std::size_t indent);

}  // namespace hairloom::cli
