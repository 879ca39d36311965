// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What README.md says that the program has, from the program's own lists.

#include <string>

#include "core/base/result.h"

namespace hairloom::cli {

/// The text of a README with the table between its two marks made anew. Error: a mark is missing.
Result<std::string> withLists(const std::string& readme);

}  // namespace hairloom::cli
