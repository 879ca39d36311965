// SPDX-License-Identifier: MIT
// Whether hair comes to rest, tried: no linear theory tells of springs that feed energy into a shape.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "hairloom/engine.h"
#include "hairloom/stable.h"

namespace hairloom::runtime {
namespace {

constexpr std::size_t kMostStrands = 16;  // at most: the most curved ones and others, half of each
/// Points times substeps of a trial: some tenths of a second, so that a window can wait for it.
constexpr double kMostWork = 4e6;
constexpr float kDampingTime = 0.5f;  // seconds, at most; what then moves after the trial is fed

/// Angle in radians by which the directions of a strand turn from root to tip, all together.
float turnOf(std::span<const Float3> points) {
    float turned = 0.0f;
    for (std::size_t i = 2; i < points.size(); ++i) {
        const Float3 a = points[i - 1] - points[i - 2], b = points[i] - points[i - 1];
        turned += std::atan2(length(cross(a, b)), dot(a, b));
    }
    return turned;
}

/// The strands to try, in their order: those that turn most, and others evenly from root to root.
std::vector<std::uint32_t> chosenOf(const StrandsView& strands, std::size_t count) {
    std::vector<std::uint32_t> order(strands.offsets.size() - 1);
    std::iota(order.begin(), order.end(), 0u);
    if (order.size() <= count) return order;
    std::vector<float> turns;
    for (const std::uint32_t s : order) {
        turns.push_back(turnOf(strands.restPositions_ss.subspan(
            strands.offsets[s], strands.offsets[s + 1] - strands.offsets[s])));
    }
    std::vector<std::uint32_t> chosen;
    for (std::size_t i = 0; i < count / 2; ++i)
        chosen.push_back(static_cast<std::uint32_t>(2 * i * order.size() / count));
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return turns[a] > turns[b]; });
    chosen.insert(chosen.end(), order.begin(),
                  order.begin() + static_cast<std::ptrdiff_t>(count - count / 2));
    std::sort(chosen.begin(), chosen.end());
    chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
    return chosen;
}

/// Some strands of others.
struct Sample {
    std::vector<std::uint32_t> offsets{0};
    std::vector<Float3> positions_ss;
    std::vector<Quat> rotations_ss;
    std::vector<float> masses, stiffness;
    std::vector<RootFrame> roots_ws;

    Sample(const StrandsView& strands, std::span<const std::uint32_t> chosen) {
        for (const std::uint32_t s : chosen) {
            const std::uint32_t first = strands.offsets[s], end = strands.offsets[s + 1];
            for (std::uint32_t p = first; p < end; ++p) {
                positions_ss.push_back(strands.restPositions_ss[p]);
                if (!strands.masses.empty()) masses.push_back(strands.masses[p]);
            }
            const Quat turned = strands.rootRotations_ss.empty() ? Quat{} : strands.rootRotations_ss[s];
            if (!strands.rootRotations_ss.empty()) rotations_ss.push_back(turned);
            if (!strands.stiffness.empty()) stiffness.push_back(strands.stiffness[s]);
            offsets.push_back(static_cast<std::uint32_t>(positions_ss.size()));
            roots_ws.push_back({strands.restPositions_ss[first], turned});
        }
    }
    StrandsView view() const { return {offsets, positions_ss, rotations_ss, masses, stiffness}; }
};

}  // namespace

RestTrial tryRest(const StrandsView& strands, const SimulationSettings& settings, float frameTime) {
    RestTrial trial;
    if (settings.strandModel == StrandModel::rods || strands.offsets.size() < 2) return trial;
    std::uint32_t longest = 0;
    for (std::size_t s = 0; s + 1 < strands.offsets.size(); ++s)
        longest = std::max(longest, strands.offsets[s + 1] - strands.offsets[s]);
    const auto frames = static_cast<std::uint32_t>(std::ceil(kTrialSeconds / static_cast<double>(frameTime)));
    const double each = static_cast<double>(longest) * substepsIn(settings, frameTime) * frames;
    const auto count = std::min(kMostStrands, static_cast<std::size_t>(kMostWork / each));
    if (count < 2) return trial;

    SimulationSettings calm = settings;
    calm.windSpeed = 0.0f;
    calm.dampingTime =
        settings.dampingTime > 0.0f ? std::min(settings.dampingTime, kDampingTime) : kDampingTime;
    const Sample sample(strands, chosenOf(strands, count));
    Engine::Result made = Engine::make(sample.view(), calm, {});
    if (!made.engine) return trial;
    for (std::uint32_t f = 1; f <= frames; ++f) {
        FrameInput input;
        input.dt = frameTime;
        input.time = static_cast<double>(f) * static_cast<double>(frameTime);
        input.roots_ws = sample.roots_ws;
        made.engine->step(input);
    }
    std::vector<Float3> velocities(sample.positions_ss.size());
    made.engine->readVelocities(velocities);
    trial.strands = static_cast<std::uint32_t>(sample.roots_ws.size());
    for (std::size_t s = 0; s < sample.roots_ws.size(); ++s) {
        float fastest = 0.0f;
        for (std::uint32_t p = sample.offsets[s]; p < sample.offsets[s + 1]; ++p)
            fastest = std::max(fastest, length(velocities[p]));
        if (fastest > kTrialSpeed) ++trial.moving;
        trial.fastest = std::max(trial.fastest, fastest);
    }
    return trial;
}

}  // namespace hairloom::runtime
