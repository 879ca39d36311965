// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Cards that somebody shaped by hand, between the groom that keeps them and the hair that they stand for.

#include <span>

#include "core/cards/cards.h"
#include "core/groom/card_edits.h"

namespace hairloom {

struct HeldCards {
    std::vector<cards::HeldCard> cards;
    std::vector<std::size_t> lost;  ///< edits fewer than half of whose roots are there: they hold nothing
};

/// An edit holds the strands whose roots are its own, within 0.2 mm; of two edits of a level that name a root
/// the first has its strand. `roots_ws` at rest, one a strand.
HeldCards heldCards(std::span<const CardEdit> edits, std::span<const Vec3f> roots_ws);

/// An edit of a card that does nothing yet. `roots_ws` of all strands.
CardEdit editOf(const cards::Card& card, std::uint32_t level, std::span<const Vec3f> roots_ws);
/// Its strip as it is: what a pinned card keeps.
std::vector<CardStation> stationsOf(const cards::Strip& strip);

/// The edit of that level which holds the card's first and last hair.
std::optional<std::size_t> findEdit(std::span<const CardEdit> edits, const cards::Card& card,
                                    std::uint32_t level, std::span<const Vec3f> roots_ws);

}  // namespace hairloom
