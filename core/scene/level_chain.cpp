// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/level_chain.h"

#include "core/scene/card_hair.h"

namespace hairloom {
namespace {

void addFindings(const Groom& groom, ExportReport& report) {
    report.findings.push_back({Severity::Info,
                               "springs of the chains are set, not fitted to how the strands move",
                               "VRMC_springBone", "tune stiffness and drag where the file is used"});
    if (!groom.spheres.empty()) return;
    report.findings.push_back({Severity::Warning,
                               "there are no collision spheres: chains swing through the head", "spheres",
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
    if (made == LevelsMade::all) options.strandsMoveMs = followMilliseconds(groom);
    return cards::makeChain(*hair, *specs, options, progress, cancel);
}

std::vector<cards::Collider> collidersOf(const Groom& groom) {
    std::vector<cards::Collider> colliders;
    for (const CollisionSphere& sphere : groom.spheres) colliders.push_back({sphere.centre, sphere.radius});
    return colliders;
}

Result<LevelFile> levelFile(const cards::Chain& chain, const Groom& groom) {
    LevelFile result;
    ExportReport& report = result.report;
    report.format = kCardFormat;
    report.strands = chain.strands;
    std::vector<const cards::Level*> levels;
    for (const cards::Level& level : chain.levels) {
        if (level.spec.kind == cards::LevelKind::strands) continue;
        levels.push_back(&level);
        if (const auto* made = std::get_if<cards::Cards>(&level.content))
            report.points += made->mesh.vertices.size();
        if (const auto* shell = std::get_if<cards::Shell>(&level.content))
            report.points += shell->vertices.size();
        const cards::Difference& off = level.difference;
        report.levels.push_back({level.name, level.cards(), level.triangles, level.bytes,
                                 cards::distanceOf(level.spec.headPx), off.coverage, off.flip, off.light});
    }
    auto bytes = cards::glbOf(levels, collidersOf(groom));
    if (!bytes) return tl::unexpected(bytes.error());
    result.bytes = std::move(*bytes);
    report.bytes = result.bytes.size();
    addFindings(groom, report);
    return result;
}

}  // namespace hairloom
