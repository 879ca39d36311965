// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/card_options.h"

namespace hairloom::cli {

void addCardOptions(CLI::App& job, LevelBudget& budget) {
    job.add_option("--cards", budget.cards, "Cards of the nearest level of cards, at most")
        ->check(CLI::Range(1, 4096));
    job.add_option("--textures", budget.chain.textures,
                   "Textures of a level, at most; cards that look alike share")
        ->check(CLI::Range(1, 256));
    job.add_option("--segments", budget.chain.segments, "Segments of a card, at most")
        ->check(CLI::Range(1, 24));
    job.add_option("--from-px", budget.headPx,
                   "Height of a head in pixels from which the nearest level of cards serves")
        ->check(CLI::IsMember({16, 32, 64, 128, 256, 512}));
    job.add_option(
           "--atlas", budget.chain.mostSide,
           "Texels along the largest atlas; smaller ones are made where texels of two thirds of a pixel fit")
        ->check(CLI::IsMember({64, 128, 256, 512, 1024, 2048, 4096, 8192}));
    job.add_option(
           "--target-px", budget.chain.targetPx,
           "Pixels that outlines of cards may be off at their distance; fewer cards where that is enough, "
           "an error where it is not reached; 0: as near as the cards come")
        ->check(CLI::Range(0.0, 100.0));
    job.add_option(
        "--levels", budget.levels,
        "The chain: KIND[:AMOUNT][@PX],… of strands (share of the hairs), cards (how many) and shell "
        "(triangles), PX the height of a head in pixels from which on it serves; by default all strands, 2 "
        "in 5, cards, half and a quarter of them, a shell");
}

}  // namespace hairloom::cli
