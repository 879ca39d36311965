// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/card_export.h"

#include <fmt/format.h>

#include "cli/documents.h"
#include "cli/progress.h"
#include "core/base/output_file.h"
#include "core/scene/card_hair.h"
#include "core/scene/level_report.h"

namespace hairloom::cli {
namespace {

std::vector<Finding> findingsOf(const Groom& groom) {
    std::vector<Finding> findings;
    findings.push_back({Severity::Info, "springs of the chains are set, not fitted to how the strands move",
                        "VRMC_springBone", "tune stiffness and drag where the file is used"});
    if (groom.spheres.empty()) {
        findings.push_back({Severity::Warning,
                            "there are no collision spheres: chains swing through the head", "spheres",
                            "add spheres to the groom"});
    }
    return findings;
}

}  // namespace

void addCardOptions(CLI::App& job, CardExportOptions& options) {
    job.add_option("--cards", options.cards, "Cards of the nearest level of cards, at most")
        ->check(CLI::Range(1, 4096));
    job.add_option("--textures", options.chain.textures,
                   "Textures of a level, at most; cards that look alike share")
        ->check(CLI::Range(1, 256));
    job.add_option(
           "--atlas", options.chain.mostSide,
           "Texels along the largest atlas; smaller ones are made where texels of two thirds of a pixel fit")
        ->check(CLI::IsMember({64, 128, 256, 512, 1024, 2048, 4096, 8192}));
    job.add_option(
           "--target-px", options.chain.targetPx,
           "Pixels that outlines of cards may be off at their distance; fewer cards where that is enough, "
           "an error where it is not reached; 0: as near as the cards come")
        ->check(CLI::Range(0.0, 100.0));
    job.add_option(
        "--levels", options.levels,
        "The chain: KIND[:AMOUNT][@PX],… of strands (share of the hairs), cards (how many) and shell "
        "(triangles), PX the height of a head in pixels from which on it serves; by default all strands, 2 "
        "in 5, cards, half and a quarter of them, a shell");
}

Result<std::vector<cards::LevelSpec>> levelsOf(const CardExportOptions& options,
                                               const std::string& standard) {
    return cards::parseLevels(options.levels.empty() ? standard : options.levels);
}

Result<Report> exportCards(const Groom& groom, const std::string& path, const CardExportOptions& options) {
    const auto specs = levelsOf(options, cards::standardCardLevels(options.cards));
    if (!specs) return tl::unexpected(specs.error());
    const auto hair = cardHair(groom);
    if (!hair) return tl::unexpected(hair.error());
    Progress bar("making cards", 1000);
    const auto chain = cards::makeChain(
        *hair, *specs, options.chain,
        [&](std::string_view, double share) { bar.done(static_cast<std::size_t>(1000 * share)); }, nullptr);
    if (!chain) return tl::unexpected(chain.error());
    std::vector<const cards::Level*> levels;
    for (const cards::Level& level : chain->levels) levels.push_back(&level);
    const auto file = cards::glbOf(levels, collidersOf(groom));
    if (!file) return tl::unexpected(file.error());
    if (auto status = writeFileAtomically(path, *file); !status) return tl::unexpected(status.error());
    std::size_t points = 0;
    Report report{{"format", kCardFormat}, {"strands", chain->strands}};
    Report rows = Report::array();
    for (const cards::Level* level : levels) {
        rows.push_back(toJson(*level));
        if (const auto* made = std::get_if<cards::Cards>(&level->content))
            points += made->mesh.vertices.size();
        if (const auto* shell = std::get_if<cards::Shell>(&level->content)) points += shell->vertices.size();
    }
    report["points"] = points;
    report["bytes"] = file->size();
    report["max_error_mm"] =
        nullptr;  // cards have no point of a strand; `levels` says how far they look from it
    report["levels"] = std::move(rows);
    report["findings"] = toReport(findingsOf(groom));
    report["output"] = path;
    return report;
}

}  // namespace hairloom::cli
