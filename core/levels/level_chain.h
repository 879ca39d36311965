// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Levels of detail of a groom by a budget, and their way into a file.

#include <filesystem>
#include <string>
#include <vector>

#include "core/cards/glb.h"
#include "core/cards/levels.h"
#include "core/groom/groom.h"
#include "exporters/report.h"

namespace hairloom {

/// The format of cards.
inline constexpr const char* kCardFormat = "gltf";
/// Where findings about cards shaped by hand are.
inline constexpr const char* kCardEditsPlace = "card_edits";
/// And about how chains of joints swing.
inline constexpr const char* kSpringsPlace = "VRMC_springBone";

/// What a chain may cost.
struct LevelBudget {
    std::uint32_t cards = 200;   ///< of the nearest level of cards, at most
    std::uint32_t headPx = 256;  ///< pixels of head height from which that level serves: 16, 32 … 512
    std::string levels;          ///< the chain in words (parseLevels()), which the two above then do not set
    cards::ChainOptions chain;
};

/// Strands come first in a whole chain; files of cards go without.
enum class LevelsMade { all, cardsAndShell };
Result<std::vector<cards::LevelSpec>> levelsOf(const LevelBudget& budget, LevelsMade made);

/// With the groom's cards by hand, and springs that are fitted where its strands can be simulated. Errors:
/// those of levelsOf(), cardHair() and cards::makeChain(), stopped.
Result<cards::Chain> makeLevels(const Groom& groom, const LevelBudget& budget, LevelsMade made,
                                const cards::Progress& progress, cards::Cancel cancel);

/// Cards shaped by hand that do nothing in a chain of this groom.
struct IdleCardEdits {
    std::size_t lost = 0;    ///< whose hair is gone
    std::size_t unmade = 0;  ///< of levels that the chain does not have
};
IdleCardEdits idleCardEdits(const cards::Chain& chain, const Groom& groom);

/// A file of cards and shells, binary glTF, before it is written.
struct LevelFile {
    std::vector<std::byte> bytes;
    ExportReport report;
};
/// Of a chain of this groom. Errors: those of cards::glbOf().
Result<LevelFile> levelFile(const cards::Chain& chain, const Groom& groom,
                            cards::GlbNumbers numbers = cards::GlbNumbers::floats);

/// What a file of the chain's cards and shells holds and what is to be said of it; it has no bytes yet.
ExportReport levelReport(const cards::Chain& chain, const Groom& groom);

}  // namespace hairloom
