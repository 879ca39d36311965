// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gpu_simulation/kernel_key.h"

#include <fmt/format.h>

#include <cctype>

#include "core/gpu_simulation/strand_model.h"
#include "runtime/shaders/simulation_types.h"

namespace hairloom::gpu_simulation {
namespace {

using runtime::Effect;
using runtime::StageId;

/// "stageRoots(); stageRod();"
std::string callsOf(const runtime::EffectPlan& plan) {
    std::string calls;
    for (const StageId stage : plan.stages()) {
        if (!calls.empty()) calls.push_back(' ');
        calls.append(callOf(stage));
    }
    return calls;
}

SphereSource sourceFor(const runtime::EffectPlan& plan, std::size_t spheres) {
    if (!plan.on(Effect::collision)) return SphereSource::none;
    return spheres > HAIRLOOM_CONSTANT_SPHERES ? SphereSource::buffer : SphereSource::constants;
}

}  // namespace

std::string callOf(StageId stage) {
    std::string name = runtime::stageName(stage);
    name.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(name.front())));
    return fmt::format("stage{}();", name);
}

const char* KernelKey::source() const {
    return runtime::modelOf(model).gpuSource;
}

std::string KernelKey::defines() const {
    return gpuModelOf(model).defines(*this);
}

KernelKey keyFor(const runtime::EffectPlan& plan, const runtime::SimulationSettings& settings,
                 const BatchShape& shape, std::size_t spheres, bool velocities, bool body) {
    KernelKey key;
    key.model = settings.strandModel;
    key.shape = shape;
    key.clampedPoints = settings.clampedPoints;
    key.sleep = settings.sleepSpeed > 0.0f;
    key.velocities = velocities;
    key.body = body;
    key.spheres = sourceFor(plan, spheres);
    key.wind = plan.on(Effect::wind);
    key.stages = callsOf(plan);
    gpuModelOf(key.model).fillKey(plan, settings, key);
    return key;
}

std::string kernelError(const runtime::SimulationSettings& settings) {
    if (settings.hairHair && settings.strandModel == runtime::StrandModel::rods)
        return "hair-hair collision runs on the CPU alone. Set hairHair to 0 to use the GPU";
    if (settings.windShelter > 0)
        return "wind that goes around spheres runs on the CPU alone. Set windShelter to 0 to use the GPU";
    return gpuModelOf(settings.strandModel).error(settings);
}

}  // namespace hairloom::gpu_simulation
