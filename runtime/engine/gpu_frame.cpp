// SPDX-License-Identifier: MIT
#include "engine/gpu_frame.h"

#include <algorithm>
#include <cmath>

#include "engine/checks.h"
#include "engine/strand_model.h"

namespace hairloom::runtime {
namespace {

shaders::float4 gpuQuad(Float3 v, float w) {
    return {v.x, v.y, v.z, w};
}

}  // namespace

shaders::SimulationConstants frameConstants(const GpuFrame& frame, const SubstepContext& context,
                                            const FrameInput& input, const Slots& slots,
                                            std::uint32_t groupStrands) {
    const SimulationSettings& s = frame.settings;
    const Wind& wind = frame.wind;
    shaders::SimulationConstants c{};
    c.slots = slots.count;
    c.substeps = context.count;
    c.sphereCount = static_cast<std::uint32_t>(frame.spheres.size());
    c.lengthIterations = context.lengthIterations;
    c.wakingCount = static_cast<std::uint32_t>(frame.waking);
    c.windKind = static_cast<std::uint32_t>(wind.kind);
    c.wakeAll = (length(wind.mean) > 0.0f && s.airDrag > 0.0f) || frame.wakeAll ? 1 : 0;
    c.h = context.h;
    c.substep = context;
    c.dt = input.dt;
    const bool keepsWays = !modelOf(s.strandModel).keepsVelocities;
    c.rescale = frame.before > 0.0f && keepsWays ? context.h / frame.before : 1.0f;
    c.teleportDistance = teleportDistanceOf(s, input);
    const float slow = s.sleepSpeed * context.h;
    c.slowSquared = slow * slow;
    c.sleepDelay = s.sleepDelay;
    c.groups = static_cast<std::uint32_t>(slots.blocks.size()) * kBlockLanes / groupStrands;
    c.firstShare = frame.before > 0.0f ? 1.0f : 0.5f;
    c.sphereDisplacement = 0.0f;
    for (const MovingSphere& sphere : frame.spheres)
        c.sphereDisplacement = std::max(c.sphereDisplacement, length(sphere.step));
    c.gravityStep = gpuQuad(context.gravityStep, 0.0f);
    c.originShift = gpuQuad(frame.originShift, 0.0f);
    c.wind = gpuQuad(wind.mean, wind.strength);
    const double time = std::isfinite(input.time) ? input.time : 0.0;
    const auto from = windPhases(wind, time - static_cast<double>(input.dt), frame.origin_ws);
    const auto to = windPhases(wind, time, frame.origin_ws);
    static_assert(kWindModes == HAIRLOOM_WIND_MODES);
    for (std::size_t m = 0; m < kWindModes; ++m) {
        c.windAmplitudes[m] = gpuQuad(wind.modes[m].amplitude, from[m]);
        c.windWaves[m] = gpuQuad(wind.modes[m].waveVector, to[m]);
    }
    return c;
}

std::size_t sphereConstantsOf(const FrameSpheres& spheres, StrandModel model) {
    if (!modelOf(model).listsSpheres) return spheres.usable.size();
    const auto ends = std::count(spheres.ends.begin(), spheres.ends.end(), std::uint8_t{1});
    return spheres.given - static_cast<std::size_t>(ends) + 2 * spheres.capsules.size();
}

void putSphereConstants(std::span<const MovingSphere> spheres, std::span<const MovingCapsule> capsules,
                        Vector<shaders::SphereConstants>& constants) {
    constants.clear();
    constants.reserve(spheres.size() + 2 * capsules.size());
    const auto add = [&](const MovingSphere& sphere) {
        constants.push_back({gpuQuad(sphere.from_ws, sphere.radius), gpuQuad(sphere.step, 0.0f)});
    };
    for (const MovingSphere& sphere : spheres) add(sphere);
    for (const MovingCapsule& capsule : capsules) {
        for (const MovingSphere& end : capsule.ends) add(end);
    }
}

void putWaking(const FrameSpheres& spheres, Vector<shaders::float4>& reaches) {
    reaches.clear();
    for (const Sphere& sphere : spheres.waking) reaches.push_back(gpuQuad(sphere.center_ws, sphere.radius));
}

void takeFrameRoots(std::span<const RootFrame> given, float teleportDistance, bool known, FrameRoots& frame) {
    Float3 low{1e30f, 1e30f, 1e30f}, high{-1e30f, -1e30f, -1e30f};
    frame.moved.assign(frame.roots.size(), false);
    frame.motion = 0.0f;
    frame.rejected = 0;
    for (std::size_t s = 0; s < frame.roots.size(); ++s) {
        RootFrame root = given[s];
        if (!usableWithin(root, kFarthest)) {
            ++frame.rejected;
            continue;
        }
        const Float3 p = root.position;
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
        if (known && p == frame.roots[s].position && root.rotation == frame.roots[s].rotation) continue;
        const float distance = length(p - frame.roots[s].position);
        if (distance <= teleportDistance) frame.motion = std::max(frame.motion, distance);
        frame.roots[s] = root;
        frame.moved[s] = true;
    }
    frame.min_ws = low;
    frame.max_ws = high;
}

}  // namespace hairloom::runtime
