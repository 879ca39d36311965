// SPDX-License-Identifier: MIT
#pragma once
// Levels of detail: which guides a level simulates, with how many points, and where the others are then. A
// guide that is not simulated keeps its own rest shape and takes over, in the frames of the roots, how far
// the nearest simulated ones have moved from theirs.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "hairloom/asset.h"
#include "hairloom/hairloom.h"
#include "hairloom/memory.h"

namespace hairloom::runtime {

/// Of one level between the finest, which simulates all, and the rigid one, which simulates nothing.
struct Level {
    bool oneSubstep;                ///< of rods; springs need theirs
    Vector<std::uint32_t> guides;   ///< that are simulated, of all, ascending
    Vector<std::uint32_t> offsets;  ///< of their points
    Vector<Float3> positions_ss;    ///< of these points at rest
    struct Sources {
        std::array<std::uint32_t, 3> guides;  ///< places in Level::guides
        std::array<float, 3> shares;          ///< sum 1
    };
    Vector<Sources> sources;  ///< of each of all guides

    std::uint32_t substepsUnder(const SimulationSettings& settings) const {
        return oneSubstep && settings.strandModel == StrandModel::rods ? 1 : settings.substeps;
    }
    std::size_t bytes() const;
};

/// What the error of a level is made of: metres, as hl_level has them.
struct LevelError {
    float still = 0;  ///< of hair at rest
    float head = 0;   ///< for each m/s of the roots, less `still`
    float wind = 0;   ///< for each m/s of wind, less `still`
};

/// Of an asset; immutable, shared by copies of an instance.
struct LevelSet {
    Vector<std::uint32_t> offsets;                    ///< of all guides' points
    Vector<Float3> rest;                              ///< of them, from their guide's root
    Vector<Level> coarser;                            ///< levels 1 …; one less than the rigid one's number
    std::array<LevelError, HL_LEVEL_COUNT> errors{};  ///< of paths
    std::array<LevelError, HL_LEVEL_COUNT> seen{};    ///< of what is seen far off

    explicit LevelSet(const Asset::Strands& strands);
    std::size_t bytes() const;
};

/// Of levels between the finest and the rigid one: points of a guide of so many, and guides of so many.
std::uint32_t pointsOfLevel(std::uint32_t level, std::uint32_t points);
std::uint32_t guidesOfLevel(std::uint32_t level, std::uint32_t guides);

/// A quantity of a guide's points at share `p` / (`count` − 1) of it, by the number of points.
Float3 sampleAt(std::span<const Float3> values, std::size_t p, std::size_t count);
float sampleAt(std::span<const float> values, std::size_t p, std::size_t count);

/// Where points are while nothing moves them: metres from their roots, in the roots' frames.
struct Standing {
    std::span<const Float3> all;        ///< of all guides: LevelSet::rest, or in poses
    std::span<const Float3> simulated;  ///< of level.guides in poses; empty: at rest
};

/// Fills `positions_ws`, the points of all guides, by those of level.guides; `roots_ws` are of all guides.
/// `moved` has room for as many points as are simulated.
void showGuides(const LevelSet& set, const Level& level, const Standing& standing,
                std::span<const RootFrame> roots_ws, std::span<const Float3> simulated_ws,
                std::span<Float3> moved, std::span<Float3> positions_ws);
/// Each goes with its root as it stands.
void showRigid(const LevelSet& set, const Standing& standing, std::span<const RootFrame> roots_ws,
               std::span<Float3> positions_ws);

/// Hairs of a guide with `all` of them that a share of them leaves: one at least.
inline std::uint32_t takenOf(std::uint32_t all, float share) {
    const auto most = static_cast<float>(all);
    return static_cast<std::uint32_t>(std::max(std::min(most, 1.0f), std::ceil(most * share)));
}

}  // namespace hairloom::runtime
