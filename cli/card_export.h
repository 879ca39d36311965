// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Hair as cards into a file: what `export --format gltf` does.

#include <CLI/App.hpp>

#include "cli/job.h"
#include "core/cards/levels.h"
#include "core/groom/groom.h"

namespace hairloom::cli {

inline constexpr const char* kCardFormat = "gltf";

struct CardExportOptions {
    std::uint32_t cards = 200;
    std::string levels;
    cards::ChainOptions chain;
};

/// --cards, --textures, --atlas, --target-px, --levels.
void addCardOptions(CLI::App& job, CardExportOptions& options);

/// The chain that is asked for; where nothing is said, `standard`.
Result<std::vector<cards::LevelSpec>> levelsOf(const CardExportOptions& options, const std::string& standard);

/// Makes the levels of cards and shells and writes them; the report says how far each is from the strands.
/// Errors: those of makeChain() and glbOf(), a file that cannot be written.
Result<Report> exportCards(const Groom& groom, const std::string& path, const CardExportOptions& options);

}  // namespace hairloom::cli
