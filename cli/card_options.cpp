// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/card_options.h"

#include "cli/error_report.h"
#include "core/cards/levels.h"

namespace hairloom::cli {

std::vector<const CLI::Option*> addCardOptions(CLI::App& job, LevelBudget& budget) {
    std::vector<const CLI::Option*> added;
    added.push_back(
        job.add_option("--cards", budget.cards, "Maximum number of cards in the nearest level of cards")
            ->check(CLI::Range(1, 4096)));
    added.push_back(
        job.add_option("--textures", budget.chain.textures,
                       "Maximum number of textures in a level. Cards that look alike share one. 0 makes "
                       "as many as fit the atlas that 32 need")
            ->check(CLI::Range(0, 256)));
    added.push_back(
        job.add_option("--segments", budget.chain.segments, "Maximum number of segments in a card")
            ->check(CLI::Range(1, 24)));
    added.push_back(job.add_option("--from-px", budget.headPx,
                                   "Head height in pixels at which the nearest level of cards starts")
                        ->check(CLI::IsMember({16, 32, 64, 128, 256, 512})));
    added.push_back(
        job.add_option("--atlas", budget.chain.mostSide,
                       "Width of the largest atlas in texels. Smaller atlases are made where texels of two "
                       "thirds of a pixel fit")
            ->check(CLI::IsMember({64, 128, 256, 512, 1024, 2048, 4096, 8192})));
    added.push_back(
        job.add_option(
               "--target-px", budget.chain.targetPx,
               "Largest error of card outlines in pixels, at their distance. Uses fewer cards where they "
               "suffice and fails if the error is not reached. 0 gives the best outlines")
            ->check(CLI::Range(0.0, 100.0)));
    added.push_back(job.add_option(
        "--levels", budget.levels,
        "Levels as KIND[:AMOUNT][@PX],… with strands (share of the hairs), cards (count) and "
        "shell (triangles). PX is the head height in pixels at which a level starts. The default "
        "is all strands, 2 in 5, cards, a half and a quarter of them, and a shell"));
    added.push_back(job.add_option("--spring-hz", budget.chain.springHz,
                                   "Updates per second of the engine that springs are fitted for. They "
                                   "swing differently at any other rate")
                        ->check(CLI::Range(10.0, 1000.0)));
    return added;
}

void checkLevels(const LevelBudget& budget) {
    if (!budget.levels.empty()) orWrongUsage(cards::parseLevels(budget.levels));
}

}  // namespace hairloom::cli
