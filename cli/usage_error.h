// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Wrong usage in the form of all other errors: what is wrong, and what would work.

#include <CLI/App.hpp>
#include <CLI/Error.hpp>

#include "core/base/result.h"

namespace hairloom::cli {

/// What `error`, thrown while `app` parsed, says: the option, its value, and the values, options or jobs that
/// would work. Names the nearest one where a word looks misspelt.
Error usageError(const CLI::App& app, const CLI::ParseError& error);

}  // namespace hairloom::cli
