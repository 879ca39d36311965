// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What levels of detail may cost, as the command line asks for it.

#include <CLI/App.hpp>

#include <vector>

#include "core/levels/level_chain.h"

namespace hairloom::cli {

/// --cards, --textures, --segments, --from-px, --atlas, --target-px, --levels, --spring-hz; these in order.
std::vector<const CLI::Option*> addCardOptions(CLI::App& job, LevelBudget& budget);
/// Throws WrongUsage where --levels names none.
void checkLevels(const LevelBudget& budget);

}  // namespace hairloom::cli
