// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/accuracy/run_preview.h"

#include <algorithm>

namespace hairloom {
namespace {

/// Where each point of `to` lies on the same strand of `from`: between two points, by arc length.
class PointsOnOther {
  public:
    PointsOnOther(const SceneHair& from, const SceneHair& to) {
        for (std::size_t s = 0; s < to.groom.strandCount(); ++s) {
            const std::uint32_t last = from.groom.offsets[s + 1] - 1;
            std::uint32_t at = from.groom.offsets[s];
            for (std::uint32_t p = to.groom.offsets[s]; p < to.groom.offsets[s + 1]; ++p) {
                const float share = to.arcShares[p];
                while (at + 1 < last && from.arcShares[at + 1] < share) ++at;
                const std::uint32_t next = std::min(at + 1, last);
                const float span = from.arcShares[next] - from.arcShares[at];
                const float t = span > 0 ? std::clamp((share - from.arcShares[at]) / span, 0.0f, 1.0f) : 0.0f;
                places_.push_back({at, next, t});
            }
        }
    }

    std::vector<Vec3f> read(std::span<const Vec3f> positions) const {
        std::vector<Vec3f> result;
        result.reserve(places_.size());
        for (const Place& place : places_)
            result.push_back(positions[place.from] + place.t * (positions[place.to] - positions[place.from]));
        return result;
    }

  private:
    struct Place {
        std::uint32_t from, to;
        float t;  ///< of the way between them
    };
    std::vector<Place> places_;
};

}  // namespace

Result<RunPreview> previewRun(const Groom& groom, const HeadMotion& motion, const WorkPrecision& measured,
                              std::size_t run, const std::function<bool()>& cancelled) {
    const std::vector<double>& values = measured.runs[run].values;
    const SceneHair authored = sampleStrands(groom, groom.strandCount(), 0);
    SceneHair hair = authored;
    if (const auto points = findAxis(measured.options.axes, kPointsAxis))
        hair = resampledHair(authored, static_cast<std::uint32_t>(values[*points]));
    applyValues(measured.options.axes, values, hair.groom.simulation);
    const PointsOnOther points(hair, authored);
    RunPreview preview;
    SceneTime time = measured.options.time;
    const auto headSeen = findAxis(measured.options.axes, kHeadSeenAxis);
    const std::uint32_t within = headSeen && values[*headSeen] == 0 ? 0 : time.posesWithin;
    time.posesWithin = 0;
    preview.poses = posesOf(motion, time);
    auto simulation = Simulation::make(hair.groom, preview.poses.front(), {});
    if (!simulation) return tl::unexpected(simulation.error());
    for (std::size_t frame = 0; frame < preview.poses.size(); ++frame) {
        if (cancelled && cancelled())
            return fail("the preview was cancelled", "expected it to run to its end");
        if (frame > 0) {
            const float at = static_cast<float>(frame), rate = time.framesPerSecond;
            const HeadPose& before = preview.poses[frame - 1];
            simulation->step(1 / rate, stepOf(motion, before, (at - 1) / rate, at / rate, within));
        }
        preview.positions_ws.push_back(points.read(simulation->positions_ws()));
    }
    return preview;
}

std::vector<std::uint32_t> strandsFarthestApart(const Groom& groom, const RunPreview& a, const RunPreview& b,
                                                double share) {
    std::vector<std::pair<float, std::uint32_t>> apart;
    for (std::uint32_t s = 0; s < groom.strandCount(); ++s) {
        float farthest = 0;
        for (std::size_t frame = 0; frame < a.positions_ws.size(); ++frame) {
            for (std::uint32_t p = groom.offsets[s]; p < groom.offsets[s + 1]; ++p)
                farthest = std::max(farthest, (a.positions_ws[frame][p] - b.positions_ws[frame][p]).norm());
        }
        if (farthest > 0) apart.emplace_back(farthest, s);
    }
    // Of equal ones the first.
    std::ranges::sort(apart, [](const auto& x, const auto& y) {
        return x.first != y.first ? x.first > y.first : x.second < y.second;
    });
    const auto most = static_cast<std::size_t>(share * static_cast<double>(groom.strandCount()));
    apart.resize(std::min(apart.size(), std::max<std::size_t>(most, 1)));
    std::vector<std::uint32_t> strands;
    for (const auto& [distance, strand] : apart) strands.push_back(strand);
    std::ranges::sort(strands);
    return strands;
}

}  // namespace hairloom
