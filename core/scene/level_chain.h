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

/// Errors: those of levelsOf(), cardHair() and cards::makeChain().
Result<cards::Chain> makeLevels(const Groom& groom, const LevelBudget& budget, LevelsMade made,
                                const cards::Progress& progress, cards::Cancel cancel);

/// The groom's collision spheres.
std::vector<cards::Collider> collidersOf(const Groom& groom);

/// A file of cards and shells, binary glTF, before it is written.
struct LevelFile {
    std::vector<std::byte> bytes;
    ExportReport report;
};
/// Of a chain of this groom. Errors: those of cards::glbOf().
Result<LevelFile> levelFile(const cards::Chain& chain, const Groom& groom);

}  // namespace hairloom
