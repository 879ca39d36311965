// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gpu_simulation/kernel_key.h"

#include <fmt/format.h>

#include <cctype>

#include "runtime/shaders/simulation_types.h"

namespace hairloom::gpu_simulation {
namespace {

using runtime::Effect;
using runtime::Integrator;
using runtime::StageId;

/// "stageAngularSmallAngle();"
std::string callOf(StageId stage) {
    std::string name = runtime::stageName(stage);
    name.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(name.front())));
    return fmt::format("stage{}();", name);
}

std::uint32_t evaluationOf(Integrator integrator) {
    if (integrator == Integrator::verlet) return 0;
    return integrator == Integrator::rk4 ? 2 : 1;
}

/// Strands of a work group whose threads share them: few, so that few strands find many multiprocessors.
constexpr std::uint32_t kSharedStrands = 8;

/// A block is a work group and each of its strands a thread's, or some threads share one.
void takeBuffers(BatchShape& shape) {
    shape.storage = StrandStorage::buffers;
    shape.strands = shape.members > 1 ? kSharedStrands : runtime::kBlockLanes;
    shape.perThread = 1;
    shape.wave = 0;
}

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

std::string KernelKey::defines() const {
    const auto flag = [](bool on) { return on ? 1 : 0; };
    if (rods) {
        return fmt::format(
            "#define HAIR_RODS 1\n#define HAIR_MEMBERS {}\n#define HAIR_STRANDS {}\n#define HAIR_TOGETHER "
            "{}\n#define HAIR_CLAMPED "
            "{}\n#define HAIR_SPHERES "
            "{}\n"
            "#define HAIR_WIND {}\n#define HAIR_SLEEP {}\n#define HAIR_VELOCITIES {}\n#define HAIR_STAGES "
            "{}\n",
            shape.members, shape.strands, flag(shape.together), clampedPoints,
            static_cast<std::uint32_t>(spheres), flag(wind), flag(sleep), flag(velocities), stages);
    }
    return fmt::format(
        "#define HAIR_POINTS {}\n#define HAIR_EXACT {}\n#define HAIR_UNROLL {}\n#define HAIR_STORAGE {}\n"
        "#define HAIR_STRANDS {}\n#define HAIR_TOGETHER {}\n"
        "#define HAIR_PER_THREAD {}\n#define HAIR_WAVE {}\n"
        "#define HAIR_CLAMPED {}\n#define HAIR_EVALUATION {}\n#define HAIR_BEND {}\n#define HAIR_TARGETS {}\n"
        "#define HAIR_TENSIONS {}\n#define HAIR_SPHERES {}\n#define HAIR_WIND {}\n#define HAIR_SLEEP {}\n"
        "#define HAIR_VELOCITIES {}\n#define HAIR_STAGES {}\n",
        shape.points, flag(shape.exact), flag(shape.unrolled), static_cast<std::uint32_t>(shape.storage),
        shape.strands, flag(shape.together), shape.perThread, shape.wave, clampedPoints, evaluation, bend,
        flag(targets), flag(tensions), static_cast<std::uint32_t>(spheres), flag(wind), flag(sleep),
        flag(velocities), stages);
}

KernelKey keyFor(const runtime::EffectPlan& plan, const runtime::SimulationSettings& settings,
                 const BatchShape& shape, std::size_t spheres, bool velocities) {
    KernelKey key;
    key.shape = shape;
    key.clampedPoints = settings.clampedPoints;
    key.sleep = settings.sleepSpeed > 0.0f;
    key.velocities = velocities;
    key.rods = settings.strandModel == runtime::StrandModel::rods;
    if (key.rods) {
        takeBuffers(key.shape);
        key.spheres = sourceFor(plan, spheres);
        key.wind = plan.on(Effect::wind);
        key.stages = callsOf(plan);
        return key;
    }
    key.shape.members = 1;
    // Strands without a free point follow their roots and nothing else.
    if (shape.points <= settings.clampedPoints) {
        key.stages = callOf(StageId::roots);
        return key;
    }
    key.evaluation = evaluationOf(settings.integrator);
    if (plan.on(Effect::angular)) key.bend = plan.factored() ? 2 : 1;
    key.targets = plan.on(Effect::torsion);
    key.tensions = plan.keepsTensions();
    key.spheres = sourceFor(plan, spheres);
    key.wind = plan.on(Effect::wind);
    key.stages = callsOf(plan);
    return key;
}

std::string kernelError(const runtime::SimulationSettings& settings) {
    if (settings.integrator != Integrator::implicitEuler) return {};
    return "the integrator implicitEuler runs on the CPU only";
}

}  // namespace hairloom::gpu_simulation
