// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The hair of every combination of a grid of settings, and what runs it.

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "core/accuracy/grid.h"
#include "core/cost/scene_run.h"
#include "core/cost/thread_limit.h"

namespace hairloom {

/// Strands are resampled once for each number of points, guides are chosen once for each number of them.
class GridHair {
  public:
    /// Axes and engine must outlive it. Errors: a groom that cannot be simulated, hairs that cannot follow.
    static Result<GridHair> make(SceneHair authored, const std::vector<GridAxis>& axes,
                                 const MethodMaker& gpuEngine);

    /// What is simulated: the guides, where there is an axis of them.
    SceneHair at(const std::vector<double>& values) const;
    /// The same with another number of points, 0 for those that are authored.
    SceneHair at(const std::vector<double>& values, std::uint32_t points) const;
    /// What runs it.
    SimulationOptions optionsAt(const std::vector<double>& values) const;
    /// How much of the head's motion that sees.
    SceneTime timeAt(const std::vector<double>& values, SceneTime time) const;
    /// Hairs that follow what is simulated; null without.
    const StrandFollow* followersAt(const std::vector<double>& values) const;
    /// The finest strands of the grid with the scene's own settings, every strand for itself.
    SceneHair finest() const;
    /// Points of the finest strands.
    std::uint32_t finestPoints() const;

    /// What at() gives, without strands that those do not need: for strands of the authored hair.
    struct Some {
        SceneHair hair;
        std::vector<std::uint32_t> strands;  ///< for each of those, what it follows in `hair`
    };
    Some alone(SceneHair hair, const std::vector<std::uint32_t>& strands,
               const std::vector<double>& values) const;
    /// The same without leaving any out.
    std::vector<std::uint32_t> followedAt(const std::vector<std::uint32_t>& strands,
                                          const std::vector<double>& values) const;
    /// From points of guides to those of `followed`, strands of the authored hair: each at its own root.
    /// `framePoses`: the start, and the end of each frame.
    void moveToOwnRoots(const std::vector<double>& values, const Followed& followed,
                        std::span<const HeadPose> framePoses, Trajectory& trajectory) const;

    ThreadLimit limitThreads(const std::vector<double>& values) const;

  private:
    struct Guides {
        std::vector<std::uint32_t> strands;  ///< of the authored hair, ascending
        std::vector<std::uint32_t> of;       ///< per strand of the authored hair: its place in `strands`
    };
    GridHair(SceneHair authored, const std::vector<GridAxis>& axes, const MethodMaker& gpuEngine);
    Status bindFollowers();
    /// Points, guides and hairs of a combination; −1 where no axis says.
    std::array<double, 3> hairsAt(const std::vector<double>& values) const;
    const Guides* guidesAt(const std::vector<double>& values) const {
        return guides_ ? &byGuides_.at(values[*guides_]) : nullptr;
    }
    bool meetsHair(const std::vector<double>& values) const {
        return hairVolume_ && values[*hairVolume_] > 0;
    }
    SceneHair withSettings(SceneHair hair, const std::vector<double>& values) const;

    const std::vector<GridAxis>* axes_;
    const MethodMaker* gpuEngine_;
    std::optional<std::size_t> points_, threads_, engine_, headSeen_, hairVolume_, spheres_, guides_,
        hairsPerGuide_;
    SceneHair authored_;
    std::map<double, SceneHair> byPoints_;
    std::map<double, Guides> byGuides_;
    std::map<std::array<double, 3>, std::shared_ptr<const StrandFollow>> followers_;
};

}  // namespace hairloom
