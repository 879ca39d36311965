// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/levels/level_chain.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/levels/card_hair.h"
#include "core/levels/held_cards.h"
#include "core/levels/level_motion.h"
#include "core/levels/spring_fit.h"
#include "exporters/card_character.h"

namespace hairloom {
namespace {

/// "At 30 Hz: 11.5 and 71.9 mm, at 120 Hz …"
std::string otherRates(const cards::SpringFit& fit) {
    std::string words;
    for (const cards::SpringRate& rate : fit.rates)
        if (rate.hz != fit.hz)
            words += fmt::format("{} {:g} Hz: {:.1f} and {:.1f} mm", words.empty() ? "At" : ", at", rate.hz,
                                 rate.error.meanMm, rate.error.largestMm);
    return words;
}

void addFindings(const cards::Chain& chain, const Groom& groom, ExportReport& report) {
    const IdleCardEdits idle = idleCardEdits(chain, groom);
    if (idle.lost > 0) {
        report.findings.push_back({Severity::Warning,
                                   fmt::format("{} edited cards have lost their hair", idle.lost),
                                   kCardEditsPlace, "edit the cards that replaced them"});
    }
    if (idle.unmade > 0) {
        report.findings.push_back(
            {Severity::Warning,
             fmt::format("{} edited cards are of levels that were not created", idle.unmade), kCardEditsPlace,
             "create levels with the number of cards that these were edited in"});
    }
    if (chain.springFit) {
        report.findings.push_back(
            {Severity::Info,
             fmt::format(
                 "while the head nods, springs keep joints {:.1f} mm from the strands, {:.1f} mm at most, in "
                 "an engine of {:g} updates per second. {}. Under a still head they settle {:.2g} mm at most",
                 chain.springFit->after.meanMm, chain.springFit->after.largestMm, chain.springFit->hz,
                 otherRates(*chain.springFit), chain.springFit->settlingMm),
             kSpringsPlace, "fit them for the rate of the engine that moves them"});
    } else if (chain.rig.chains() > 0) {
        report.findings.push_back(
            {Severity::Warning, "springs were not fitted: the strands of this groom cannot be simulated",
             kSpringsPlace, "tune stiffness and drag in the program that uses the file"});
    }
    if (!groom.spheres.empty()) return;
    report.findings.push_back({Severity::Warning,
                               "there are no collision spheres: chains pass through the head", "spheres",
                               "add spheres to the groom"});
}

}  // namespace

Result<std::vector<cards::LevelSpec>> levelsOf(const LevelBudget& budget, LevelsMade made) {
    if (!budget.levels.empty()) return cards::parseLevels(budget.levels);
    return cards::parseLevels(made == LevelsMade::all
                                  ? cards::standardLevels(budget.cards, budget.headPx)
                                  : cards::standardCardLevels(budget.cards, budget.headPx));
}

Result<cards::Chain> makeLevels(const Groom& groom, const LevelBudget& budget, LevelsMade made,
                                const cards::Progress& progress, cards::Cancel cancel) {
    const auto specs = levelsOf(budget, made);
    if (!specs) return tl::unexpected(specs.error());
    const auto hair = cardHair(groom);
    if (!hair) return tl::unexpected(hair.error());
    cards::ChainOptions options = budget.chain;
    std::vector<Vec3f> roots;
    for (std::size_t s = 0; s < hair->strandCount(); ++s) roots.push_back(hair->strand(s)[0]);
    options.held = heldCards(groom.cardEdits, roots).cards;
    if (made == LevelsMade::all) {
        options.strandsMoveMs = followMilliseconds(groom);
        options.walk = options.measure = options.alike = true;
    }
    auto chain = cards::makeChain(*hair, *specs, options, progress, cancel);
    if (!chain) return chain;
    // Where strands cannot be simulated, springs stay as they are set, and a finding says so.
    // Nor is there a motion to measure then.
    if (fitSpringsOf(groom, *chain, options.springHz, cancel)) (void)measureMotion(groom, *chain, cancel);
    if (cards::cancelled(cancel)) return cards::stopped();
    return chain;
}

IdleCardEdits idleCardEdits(const cards::Chain& chain, const Groom& groom) {
    const auto isMade = [&](const CardEdit& edit) {
        return std::ranges::any_of(chain.levels, [&](const cards::Level& level) {
            return level.spec.kind == cards::LevelKind::cards && level.spec.amount == edit.level;
        });
    };
    IdleCardEdits idle;
    idle.unmade =
        groom.cardEdits.size() - static_cast<std::size_t>(std::ranges::count_if(groom.cardEdits, isMade));
    for (const std::size_t edit : heldCards(groom.cardEdits, chain.roots_ws).lost)
        idle.lost += isMade(groom.cardEdits[edit]) ? 1 : 0;
    return idle;
}

ExportReport levelReport(const cards::Chain& chain, const Groom& groom) {
    ExportReport report;
    report.format = kCardFormat;
    report.strands = chain.strands;
    for (const cards::Level& level : chain.levels) {
        if (level.spec.kind == cards::LevelKind::strands) continue;
        if (const auto* made = std::get_if<cards::Cards>(&level.content))
            report.points += made->mesh.vertices.size();
        if (const auto* shell = std::get_if<cards::Shell>(&level.content))
            report.points += shell->vertices.size();
        const cards::Difference& off = level.difference;
        report.levels.push_back({level.name, level.cards(), level.triangles, level.bytes,
                                 cards::distanceOf(level.spec.headPx), off.coverage, off.flip, off.light});
    }
    if (chain.springFit) {
        report.springHz = chain.springFit->hz;
        for (const cards::SpringRate& rate : chain.springFit->rates)
            report.springRates.push_back({rate.hz, rate.error.meanMm, rate.error.largestMm});
    }
    addFindings(chain, groom, report);
    return report;
}

Result<LevelFile> levelFile(const cards::Chain& chain, const Groom& groom, cards::GlbNumbers numbers) {
    std::vector<Finding> findings;
    const cards::Character character = cardCharacter({groom, chain.roots_ws}, findings);
    auto bytes = cards::glbOf(chain, collidersOf(groom), numbers, character);
    if (!bytes) return tl::unexpected(bytes.error());
    LevelFile file{std::move(*bytes), levelReport(chain, groom)};
    file.report.findings.insert(file.report.findings.end(), findings.begin(), findings.end());
    file.report.bytes = file.bytes.size();
    return file;
}

}  // namespace hairloom
