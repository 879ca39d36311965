// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/accuracy/grid_hair.h"

#include <numeric>

namespace hairloom {

GridHair::GridHair(SceneHair authored, const std::vector<GridAxis>& axes, const MethodMaker& gpuEngine)
    : axes_(axes),
      gpuEngine_(gpuEngine),
      points_(findAxis(axes_, kPointsAxis)),
      threads_(findAxis(axes_, kThreadsAxis)),
      engine_(findAxis(axes_, kEngineAxis)),
      hairHair_(findAxis(axes_, kHairHairAxis)),
      spheres_(findAxis(axes_, kSpheresAxis)),
      authored_(std::move(authored)) {
    if (!points_) return;
    for (const double points : axes_[*points_].values)
        byPoints_[points] = resampledHair(authored_, static_cast<std::uint32_t>(points));
}

SceneHair GridHair::withSettings(SceneHair hair, const std::vector<double>& values) const {
    applyValues(axes_, values, hair.groom.simulation);
    if (spheres_ && static_cast<double>(hair.groom.spheres.size()) > values[*spheres_])
        hair.groom.spheres.resize(static_cast<std::size_t>(values[*spheres_]));
    return hair;
}

SceneHair GridHair::at(const std::vector<double>& values) const {
    return withSettings(points_ ? byPoints_.at(values[*points_]) : authored_, values);
}

SceneHair GridHair::at(const std::vector<double>& values, std::uint32_t points) const {
    return withSettings(points > 0 ? resampledHair(authored_, points) : authored_, values);
}

SimulationOptions GridHair::optionsAt(const std::vector<double>& values) const {
    SimulationOptions options;
    if (engine_ && values[*engine_] > 0) options.backend = gpuEngine_;
    if (meetsHair(values)) options.hairHair = runtime::HairVolumeSettings();
    return options;
}

SceneHair GridHair::finest() const {
    return points_ ? byPoints_.rbegin()->second : authored_;
}

std::uint32_t GridHair::finestPoints() const {
    return points_ ? static_cast<std::uint32_t>(byPoints_.rbegin()->first) : maxPoints(authored_.groom);
}

GridHair::Some GridHair::alone(SceneHair hair, const std::vector<std::uint32_t>& strands,
                               const std::vector<double>& values) const {
    if (meetsHair(values)) return {std::move(hair), strands};
    Some some{strandsOf(hair, strands), std::vector<std::uint32_t>(strands.size())};
    std::iota(some.strands.begin(), some.strands.end(), 0u);
    return some;
}

ThreadLimit GridHair::limitThreads(const std::vector<double>& values) const {
    return threads_ ? ThreadLimit(static_cast<std::size_t>(values[*threads_])) : ThreadLimit();
}

}  // namespace hairloom
