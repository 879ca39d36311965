// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which cards look so much alike that they can share a texture.

#include "core/cards/cards.h"

namespace hairloom::cards {

/// How a card looks from afar.
struct Look {
    static constexpr std::size_t kAcross = 8, kAlong = 16;
    std::array<float, kAcross * kAlong> coverage;
    float width = 0, length = 0;  ///< metres
    float covered = 0;            ///< m²: coverage times area

    /// 0 … about 2: mean difference of coverage, and of size by its logarithm.
    float operator-(const Look& other) const;
};
std::vector<Look> looksOf(const Hair& hair, const HairLight& light, const std::vector<Card>& cards);

/// Sets `texture` and `widen` of each card, and gives the card that each texture is to show: medoids of the
/// looks, the first from afar, then mended (Park and Jun 2009).
std::vector<std::uint32_t> shareLooks(const std::vector<Look>& looks, std::uint32_t most,
                                      std::vector<Card>& cards);

}  // namespace hairloom::cards
