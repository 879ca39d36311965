// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Cards of levels of detail that somebody shaped by hand.

#include <cstdint>
#include <vector>

#include "core/base/math.h"

namespace hairloom {

/// A cross-section of a pinned card; metres, the scalp's rest space.
struct CardStation {
    Vec3f centre = Vec3f::Zero();
    Vec3f across = Vec3f::UnitX();  ///< unit
    float halfWidth = 0.001f;       ///< > 0
    float bend = 0;                 ///< 1/m; 0 is flat
    float spread = 0;               ///< m², mean square of its hairs' places across
};
inline constexpr std::size_t kCardStations = 25;  ///< of a strip

/// It keeps the hair that it stands for when the level is made anew.
struct CardEdit {
    std::uint32_t level = 200;  ///< the level of so many cards, 1 … 4096
    std::vector<Vec3f> roots;   ///< of its hairs; metres, the scalp's rest space; at least one
    float width = 1;            ///< factor, kLeastCardWidth … kMostCardWidth
    float bend = 0;        ///< added: how far its edges lie outwards, as a share of half its width, -1 … 1
    bool deleted = false;  ///< no card stands for the hair
    std::vector<CardStation> strip;  ///< pinned: it stays as it is here, kCardStations; else empty
};
inline constexpr float kLeastCardWidth = 0.1f, kMostCardWidth = 4;
inline constexpr std::size_t kMaxCardEdits = 4096;
inline constexpr std::size_t kMaxCardRoots = 60'000;  ///< of all edits of a groom

}  // namespace hairloom
