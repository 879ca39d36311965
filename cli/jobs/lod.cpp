// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <memory>

#include "cli/documents.h"
#include "cli/job.h"
#include "cli/progress.h"
#include "core/base/stopwatch.h"
#include "core/scene/card_hair.h"
#include "core/scene/level_report.h"

namespace hairloom::cli {
namespace {

struct LodOptions {
    std::string input;
    std::string output;
    std::string levels;
    std::uint32_t cards = 200;
    cards::ChainOptions chain;
};

Result<Report> run(const LodOptions& options, const std::string& commandLine) {
    const Stopwatch watch;
    const auto specs =
        cards::parseLevels(options.levels.empty() ? cards::standardLevels(options.cards) : options.levels);
    if (!specs) return tl::unexpected(specs.error());
    const auto groom = loadDocument(options.input);
    if (!groom) return tl::unexpected(groom.error());
    const auto hair = cardHair(*groom);
    if (!hair) return tl::unexpected(inFile(hair.error(), options.input));
    cards::ChainOptions chainOptions = options.chain;
    chainOptions.strandsMoveMs = followMilliseconds(*groom);
    Progress bar("making levels", 1000);
    const auto chain = cards::makeChain(
        *hair, *specs, chainOptions,
        [&](std::string_view, double share) { bar.done(static_cast<std::size_t>(1000 * share)); }, nullptr);
    if (!chain) return tl::unexpected(inFile(chain.error(), options.input));
    const auto files = writeChain(*chain, commandLine, collidersOf(*groom), options.output);
    if (!files) return tl::unexpected(files.error());
    Report report{{"hairs", chain->strands}, {"directions", chain->views.size()}};
    report["levels"] = Report::array();
    for (const cards::Level& level : chain->levels) report["levels"].push_back(toJson(level));
    report["make_seconds"] = chain->makeSeconds;
    report["seconds"] = watch.seconds();
    report["output"] = options.output;
    report["files"] = *files;
    return report;
}

JobRun declare(CLI::App& job) {
    const auto options = std::make_shared<LodOptions>();
    job.add_option("groom", options->input, "Groom that levels are made of")->required();
    job.add_option("-o,--output", options->output,
                   "Folder for textures, meshes, pictures beside the strands, table and plot")
        ->required();
    job.add_option("--cards", options->cards, "Cards of the nearest level of cards, at most")
        ->check(CLI::Range(1, 4096));
    job.add_option("--textures", options->chain.textures,
                   "Textures of a level, at most; cards that look alike share")
        ->check(CLI::Range(1, 256));
    job.add_option(
           "--atlas", options->chain.mostSide,
           "Texels along the largest atlas; smaller ones are made where texels of two thirds of a pixel fit")
        ->check(CLI::IsMember({64, 128, 256, 512, 1024, 2048, 4096, 8192}));
    job.add_option(
           "--target-px", options->chain.targetPx,
           "Pixels that outlines of cards may be off at their distance; fewer cards where that is enough, "
           "an error where it is not reached; 0: as near as the cards come")
        ->check(CLI::Range(0.0, 100.0));
    job.add_option(
        "--levels", options->levels,
        "The chain: KIND[:AMOUNT][@PX],… of strands (share of the hairs), cards (how many) and shell "
        "(triangles), PX the height of a head in pixels from which on it serves; by default all strands, 2 "
        "in 5, cards, half and a quarter of them, a shell");
    job.add_option("--directions", options->chain.directions, "Directions that levels are judged from")
        ->check(CLI::Range(1, 360));
    return [options](const std::string& commandLine) { return run(*options, commandLine); };
}

}  // namespace

Job lodJob() {
    return {"lod", "Make levels of detail: strands, cards and a shell, each measured against the strands",
            "hair.hairloom -o levels --cards 200 --json", declare};
}

}  // namespace hairloom::cli
