// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The chain of levels of detail: strands, fewer strands, cards, fewer cards, a shell; each measured against
// all strands at the distance that it is for.

#include <algorithm>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <variant>

#include "core/cards/measures.h"
#include "core/cards/springs.h"

namespace hairloom::cards {

enum class LevelKind { strands, cards, shell };
std::string_view nameOf(LevelKind kind);

/// A level that is asked for.
struct LevelSpec {
    LevelKind kind = LevelKind::cards;
    double amount = 0;         ///< strands: share of the hairs, ]0, 1]; cards: how many; a shell's triangles
    std::uint32_t headPx = 0;  ///< pixels along the height of a head from which it is shown: 16, 32 … 512
};
/// "strands:0.5@512,cards:200@256,shell@32"; @PX may be left out: half of the level before, 512 at first.
/// Errors: other words, numbers out of range, levels that are not ever farther.
Result<std::vector<LevelSpec>> parseLevels(std::string_view text);
/// All strands, 2 in 5, `cards`, half and a quarter of them, a shell; cards from `headPx` on, 16 … 512.
std::string standardLevels(std::uint32_t cards, std::uint32_t headPx = 256);
/// Of these those that are no strands.
std::string standardCardLevels(std::uint32_t cards, std::uint32_t headPx = 256);

struct ChainOptions {
    std::uint32_t textures = 0;     ///< at most, as CardOptions has it
    std::uint32_t segments = 24;    ///< of a card, at most
    std::uint32_t mostSide = 2048;  ///< texels along an atlas
    std::uint32_t directions = 12;  ///< that levels are judged from
    float targetPx = 0;             ///< pixels that outlines of cards may be off; 0: what the budget gives
    float springHz = kSpringHz;     ///< updates a second of the engine that springs are fitted for
    double strandsMoveMs = 0;       ///< what moving all hairs takes, as the caller measured it
    bool walk = false;              ///< Level::lights are measured, too
    bool alike = false;             ///< Level::flips are measured, too
    bool measure = false;           ///< Level::measures, from as many directions again between those
    std::vector<HeldCard> held;     ///< cards shaped by hand
};

/// How far off a level is seen that is for heads so high: in a picture of 1080 lines, 40° from its lower to
/// its upper edge. Metres.
double distanceOf(std::uint32_t headPx);
/// How wide a pixel is there, on the head.
inline double pixelMillimetres(std::uint32_t headPx) {
    return 1000 * static_cast<double>(kHeadHeight) / static_cast<double>(headPx);
}

/// Levels that are nearer are measured in pictures of heads so high: a pixel is a millimetre there.
inline constexpr std::uint32_t kNearestMeasuredPx = 256;

/// The light of a level's hair, times that of all strands, where a head is so many pixels high.
struct LightAt {
    std::uint32_t headPx = 0;
    double light = 1;
};

/// FLIP to all strands, where a head is so many pixels high, by some of the directions.
struct FlipAt {
    std::uint32_t headPx = 0;
    double flip = 0;
};

using LevelContent = std::variant<Hair, Cards, Shell>;

struct Level {
    LevelSpec spec;
    std::string name;            ///< "cards-200"
    std::uint32_t untilPx = 16;  ///< pixels along the height of a head where the next level takes over
    std::size_t hairs = 0;       ///< that are drawn one by one
    std::size_t triangles = 0;   ///< of hairs two a segment
    std::size_t bytes = 0;  ///< of vertices, indices and textures with their mip maps, as they lie on a GPU
    Difference difference;
    std::optional<Measures> measures;  ///< nothing unless asked for
    std::vector<LightAt> lights;  ///< from where it takes over to where the next does; empty unless asked for
    std::vector<FlipAt> flips;    ///< where it and each later level takes over, the nearest first; likewise
    double drawMs = 0;            ///< by the judge, on one core, mean of all directions
    double moveMs = 0;            ///< on all cores
    LevelContent content;
    std::vector<Shot> shots;    ///< of each direction, at its distance
    std::vector<Shot> strands;  ///< all strands, likewise

    std::uint32_t measuredPx() const { return std::min(spec.headPx, kNearestMeasuredPx); }
    bool failsBy(const Measure& measure) const {
        return measures && measure.fails(*measures, pixelMillimetres(measuredPx()));
    }
    /// Names of the measures that it fails; none where it was not measured.
    std::vector<std::string> fails() const {
        if (!measures) return {};
        return failsOf(*measures, pixelMillimetres(measuredPx()));
    }
    std::size_t cards() const {
        const auto* made = std::get_if<Cards>(&content);
        if (made == nullptr) return 0;
        return static_cast<std::size_t>(std::ranges::count(made->cards, false, &Card::deleted));
    }
};

struct Chain {
    std::vector<Level> levels;
    std::vector<View> views;
    std::size_t strands = 0;
    std::vector<Vec3f> roots_ws;         ///< of each strand
    Rig rig;                             ///< of the nearest cards; no chains where there are none
    std::vector<Spring> springs;         ///< of each of its chains
    std::optional<SpringFit> springFit;  ///< nothing: they are as by default
    double makeSeconds = 0;              ///< clusters, strips, textures and shells, measuring left out
};

/// Told what is being made and which share is done, every few seconds.
using Progress = std::function<void(std::string_view, double)>;

/// By levels, the largest change of light when it takes over from the one before and between its own lights
/// from there on, as a share.
std::vector<double> lightSteps(const std::vector<Level>& levels);

/// Errors: those of check() and makeCards(), a target in pixels that the cards cannot meet (it says how near
/// they come), stopped.
Result<Chain> makeChain(const Hair& hair, const std::vector<LevelSpec>& specs, const ChainOptions& options,
                        const Progress& progress, Cancel cancel);

/// Every so many-th hair at random, wider by as much. `share` in ]0, 1].
Hair thinned(const Hair& hair, double share, float widen);

}  // namespace hairloom::cards
