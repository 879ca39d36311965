// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The hair of every combination of a grid of settings, and what runs it.

#include <map>
#include <optional>
#include <vector>

#include "core/accuracy/grid.h"
#include "core/accuracy/scene_run.h"
#include "core/accuracy/thread_limit.h"

namespace hairloom {

/// Strands are resampled once for each number of points. Axes and engine must outlive it.
class GridHair {
  public:
    GridHair(SceneHair authored, const std::vector<GridAxis>& axes, const MethodMaker& gpuEngine);

    SceneHair at(const std::vector<double>& values) const;
    /// The same with another number of points; 0 for those that are authored.
    SceneHair at(const std::vector<double>& values, std::uint32_t points) const;
    /// What runs it.
    SimulationOptions optionsAt(const std::vector<double>& values) const;
    /// The finest strands of the grid with the scene's own settings.
    SceneHair finest() const;
    /// Points of the finest strands.
    std::uint32_t finestPoints() const;
    struct Some {
        SceneHair hair;
        std::vector<std::uint32_t> strands;  ///< in `hair`, ascending
    };
    /// Those strands and no others, as fast as they can be run; with all others where hair meets hair.
    Some alone(SceneHair hair, const std::vector<std::uint32_t>& strands,
               const std::vector<double>& values) const;
    ThreadLimit limitThreads(const std::vector<double>& values) const;

  private:
    bool meetsHair(const std::vector<double>& values) const { return hairHair_ && values[*hairHair_] > 0; }
    SceneHair withSettings(SceneHair hair, const std::vector<double>& values) const;

    const std::vector<GridAxis>& axes_;
    const MethodMaker& gpuEngine_;
    std::optional<std::size_t> points_, threads_, engine_, hairHair_, spheres_;
    SceneHair authored_;
    std::map<double, SceneHair> byPoints_;
};

}  // namespace hairloom
