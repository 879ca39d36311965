// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/levels/held_cards.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace hairloom {
namespace {

constexpr float kSameRoot = 0.0002f;  // metres

/// Roots by the cells of a grid that they lie in.
class RootFinder {
  public:
    explicit RootFinder(std::span<const Vec3f> roots) : roots_(roots) {
        for (std::uint32_t r = 0; r < roots.size(); ++r) cells_[cellOf(roots[r])].push_back(r);
    }
    /// The nearest that is the same place and not taken.
    std::optional<std::uint32_t> find(const Vec3f& place, const std::vector<bool>& isTaken) const {
        std::optional<std::uint32_t> found;
        float nearest = kSameRoot;
        const Cell middle = cellOf(place);
        for (int i = 0; i < 27; ++i) {
            const auto cell =
                cells_.find({middle[0] + i % 3 - 1, middle[1] + i / 3 % 3 - 1, middle[2] + i / 9 - 1});
            if (cell == cells_.end()) continue;
            for (const std::uint32_t r : cell->second) {
                const float distance = (roots_[r] - place).norm();
                if (distance < nearest && !isTaken[r]) nearest = distance, found = r;
            }
        }
        return found;
    }

  private:
    using Cell = std::array<int, 3>;
    static Cell cellOf(const Vec3f& place) {
        constexpr float kCell = 5 * kSameRoot;
        Cell cell;
        for (int i = 0; i < 3; ++i)
            cell[static_cast<std::size_t>(i)] = static_cast<int>(std::floor(place[i] / kCell));
        return cell;
    }
    std::span<const Vec3f> roots_;
    std::map<Cell, std::vector<std::uint32_t>> cells_;
};

cards::Strip stripOf(const std::vector<CardStation>& stations) {
    cards::Strip strip;
    for (const CardStation& station : stations) {
        strip.centre.push_back(station.centre);
        strip.cross.push_back(station.across);
        strip.halfWidth.push_back(station.halfWidth);
        strip.bend.push_back(station.bend);
        strip.spread.push_back(station.spread);
    }
    return cards::framed(std::move(strip));
}

}  // namespace

HeldCards heldCards(std::span<const CardEdit> edits, std::span<const Vec3f> roots_ws) {
    HeldCards held;
    if (edits.empty()) return held;
    const RootFinder finder(roots_ws);
    std::map<std::uint32_t, std::vector<bool>> taken;  // by level
    for (std::size_t e = 0; e < edits.size(); ++e) {
        const CardEdit& edit = edits[e];
        auto& isTaken = taken.try_emplace(edit.level, roots_ws.size(), false).first->second;
        cards::HeldCard card;
        for (const Vec3f& root : edit.roots) {
            const auto strand = finder.find(root, isTaken);
            if (!strand) continue;
            isTaken[*strand] = true;
            card.strands.push_back(*strand);
        }
        if (2 * card.strands.size() < edit.roots.size()) {
            for (const std::uint32_t s : card.strands) isTaken[s] = false;
            held.lost.push_back(e);
            continue;
        }
        std::ranges::sort(card.strands);
        card.level = edit.level;
        card.width = edit.width, card.bend = edit.bend, card.deleted = edit.deleted;
        if (!edit.strip.empty()) card.strip = stripOf(edit.strip);
        held.cards.push_back(std::move(card));
    }
    return held;
}

CardEdit editOf(const cards::Card& card, std::uint32_t level, std::span<const Vec3f> roots_ws) {
    CardEdit edit;
    edit.level = level;
    for (const std::uint32_t s : card.strands) edit.roots.push_back(roots_ws[s]);
    return edit;
}

std::vector<CardStation> stationsOf(const cards::Strip& strip) {
    std::vector<CardStation> stations;
    for (std::size_t k = 0; k < strip.stations(); ++k)
        stations.push_back(
            {strip.centre[k], strip.cross[k], strip.halfWidth[k], strip.bend[k], strip.spread[k]});
    return stations;
}

std::optional<std::size_t> findEdit(std::span<const CardEdit> edits, const cards::Card& card,
                                    std::uint32_t level, std::span<const Vec3f> roots_ws) {
    const auto names = [&](const CardEdit& edit, std::uint32_t strand) {
        return std::ranges::any_of(edit.roots, [root = roots_ws[strand]](const Vec3f& own) {
            return (own - root).norm() < kSameRoot;
        });
    };
    // Two, since hairs of two cards may share a root.
    const auto found = std::ranges::find_if(edits, [&](const CardEdit& edit) {
        return edit.level == level && names(edit, card.strands.front()) && names(edit, card.strands.back());
    });
    if (found == edits.end()) return std::nullopt;
    return static_cast<std::size_t>(found - edits.begin());
}

}  // namespace hairloom
