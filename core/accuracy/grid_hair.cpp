// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/accuracy/grid_hair.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <numeric>

#include "core/groom/strand_subset.h"
#include "core/interpolation/strand_follow.h"
#include "core/operations/guide_clusters.h"
#include "core/simulation/scene_input.h"

namespace hairloom {
namespace {

std::vector<std::uint32_t> counting(std::size_t count) {
    std::vector<std::uint32_t> all(count);
    std::iota(all.begin(), all.end(), 0u);
    return all;
}

/// Ascending, each once.
void makeUnique(std::vector<std::uint32_t>& strands) {
    std::ranges::sort(strands);
    strands.erase(std::unique(strands.begin(), strands.end()), strands.end());
}

/// Of one that is among them; they are ascending.
std::uint32_t placeIn(const std::vector<std::uint32_t>& strands, std::uint32_t strand) {
    return static_cast<std::uint32_t>(std::ranges::lower_bound(strands, strand) - strands.begin());
}

}  // namespace

GridHair::GridHair(SceneHair authored, const std::vector<GridAxis>& axes, const MethodMaker& gpuEngine)
    : axes_(&axes),
      gpuEngine_(&gpuEngine),
      points_(findAxis(axes, kPointsAxis)),
      threads_(findAxis(axes, kThreadsAxis)),
      engine_(findAxis(axes, kEngineAxis)),
      headSeen_(findAxis(axes, kHeadSeenAxis)),
      hairVolume_(findAxis(axes, kHairVolumeAxis)),
      spheres_(findAxis(axes, kSpheresAxis)),
      guides_(findAxis(axes, kGuidesAxis)),
      hairsPerGuide_(findAxis(axes, kHairsPerGuideAxis)),
      authored_(std::move(authored)) {}

Result<GridHair> GridHair::make(SceneHair authored, const std::vector<GridAxis>& axes,
                                const MethodMaker& gpuEngine) {
    if (const auto scene = SceneInput::make(authored.groom); !scene) return tl::unexpected(scene.error());
    GridHair hair(std::move(authored), axes, gpuEngine);
    if (hair.points_) {
        for (const double points : axes[*hair.points_].values)
            hair.byPoints_[points] = resampledHair(hair.authored_, static_cast<std::uint32_t>(points));
    }
    if (hair.guides_) {
        const Groom& groom = hair.authored_.groom;
        for (const double count : axes[*hair.guides_].values) {
            GuidesSettings settings;
            settings.count = static_cast<std::uint32_t>(count);
            const GuideClusters clusters = clusterGuides(groom, counting(groom.strandCount()), settings);
            Guides& guides = hair.byGuides_[count];
            guides.strands = clusters.guides;
            for (const std::uint32_t guide : clusters.guideOf)
                guides.of.push_back(placeIn(guides.strands, guide));
        }
    }
    if (auto status = hair.bindFollowers(); !status) return tl::unexpected(status.error());
    return hair;
}

std::array<double, 3> GridHair::hairsAt(const std::vector<double>& values) const {
    const auto at = [&](const std::optional<std::size_t>& axis) { return axis ? values[*axis] : -1; };
    return {at(points_), at(guides_), at(hairsPerGuide_)};
}

Status GridHair::bindFollowers() {
    if (!hairsPerGuide_) return {};
    for (const std::vector<double>& values : combinations(*axes_)) {
        auto& follow = followers_[hairsAt(values)];
        if (follow || values[*hairsPerGuide_] == 0) continue;
        const Groom groom = at(values).groom;
        InterpolationSettings settings = groom.interpolation;
        settings.followPerGuide = static_cast<std::uint32_t>(values[*hairsPerGuide_]);
        const auto bindings = bindFollowHairs(groom, settings);
        if (!bindings) return tl::unexpected(bindings.error());
        follow = std::make_shared<const StrandFollow>(groom, *bindings);
    }
    return {};
}

SceneHair GridHair::withSettings(SceneHair hair, const std::vector<double>& values) const {
    if (const Guides* guides = guidesAt(values)) hair = strandsOf(hair, guides->strands);
    applyValues(*axes_, values, hair.groom.simulation);
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
    if (engine_ && values[*engine_] > 0) options.backend = *gpuEngine_;
    if (meetsHair(values)) options.hairVolume = runtime::HairVolumeSettings();
    return options;
}

SceneTime GridHair::timeAt(const std::vector<double>& values, SceneTime time) const {
    if (headSeen_) time.seesWithin = values[*headSeen_] > 0;
    return time;
}

const StrandFollow* GridHair::followersAt(const std::vector<double>& values) const {
    return hairsPerGuide_ ? followers_.at(hairsAt(values)).get() : nullptr;
}

SceneHair GridHair::finest() const {
    return points_ ? byPoints_.rbegin()->second : authored_;
}

std::uint32_t GridHair::finestPoints() const {
    return points_ ? static_cast<std::uint32_t>(byPoints_.rbegin()->first) : maxPoints(authored_.groom);
}

std::vector<std::uint32_t> GridHair::followedAt(const std::vector<std::uint32_t>& strands,
                                                const std::vector<double>& values) const {
    std::vector<std::uint32_t> followed = strands;
    if (const Guides* guides = guidesAt(values)) {
        for (std::uint32_t& strand : followed) strand = guides->of[strand];
    }
    return followed;
}

GridHair::Some GridHair::alone(SceneHair hair, const std::vector<std::uint32_t>& strands,
                               const std::vector<double>& values) const {
    Some some{{}, followedAt(strands, values)};
    if (meetsHair(values)) {
        some.hair = std::move(hair);
        return some;
    }
    std::vector<std::uint32_t> needed = some.strands;
    makeUnique(needed);
    for (std::uint32_t& strand : some.strands) strand = placeIn(needed, strand);
    some.hair = strandsOf(hair, needed);
    return some;
}

void GridHair::moveToOwnRoots(const std::vector<double>& values, const Followed& followed,
                              std::span<const HeadPose> framePoses, Trajectory& trajectory) const {
    const Guides* guides = guidesAt(values);
    if (!guides || trajectory.points_ws.empty()) return;
    std::vector<std::uint32_t> guideStrands;
    for (const std::uint32_t strand : followed.strands)
        guideStrands.push_back(guides->strands[guides->of[strand]]);
    std::vector<std::uint32_t> needed = followed.strands;
    needed.insert(needed.end(), guideStrands.begin(), guideStrands.end());
    makeUnique(needed);
    const auto scene = SceneInput::make(strandsOf(authored_.groom, needed));
    assert(scene);  // make() has looked at all strands
    const std::size_t shares = followed.shares.size();
    const std::size_t frames = trajectory.points_ws.size() / trajectory.pointsPerFrame;
    for (std::size_t frame = 0; frame < frames; ++frame) {
        const auto roots = scene->rootsAt(inWorld(framePoses[frame + 1]));
        Vec3f* point = trajectory.points_ws.data() + frame * trajectory.pointsPerFrame;
        for (std::size_t s = 0; s < followed.strands.size(); ++s) {
            const runtime::Float3 own = roots[placeIn(needed, followed.strands[s])].position;
            const runtime::Float3 guide = roots[placeIn(needed, guideStrands[s])].position;
            const Vec3f away(own.x - guide.x, own.y - guide.y, own.z - guide.z);
            for (std::size_t i = 0; i < shares; ++i) *point++ += away;
        }
    }
}

ThreadLimit GridHair::limitThreads(const std::vector<double>& values) const {
    return threads_ ? ThreadLimit(static_cast<std::size_t>(values[*threads_])) : ThreadLimit();
}

}  // namespace hairloom
