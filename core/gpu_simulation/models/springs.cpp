// SPDX-License-Identifier: GPL-3.0-or-later
// Springs on a GPU: a kernel for each integrator and plan, strands in registers, groups or buffers.
#include "runtime/models/springs/springs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/base/parallel.h"
#include "core/gpu_simulation/models/bend_reduction.h"
#include "core/gpu_simulation/models/models.h"

namespace hairloom::gpu_simulation {
namespace {

using runtime::Effect;
using runtime::Integrator;

constexpr std::size_t kBlocksPerJob = 8;
/// Floats a point that a kernel of StrandStorage::buffers works in, by kEvaluation: see storage.hlsli.
constexpr std::array<std::size_t, 4> kScratchPlanes{5, 11, 20, 26};

/// KernelKey::own.
enum Own : std::size_t {
    kEvaluation,  ///< arrays of the integrator: none, start and rate, those of RK4, a system of coil springs
    kBend,        ///< none, stiffness, factors
    kTargets,     ///< 1: rest directions
    kTensions,    ///< 1: are kept from substep to substep
};

std::uint32_t evaluationOf(const runtime::SimulationSettings& settings) {
    const bool coils = settings.lengthMethod != runtime::LengthMethod::constraint;
    switch (settings.integrator) {
        case Integrator::verlet:
            return 0;
        case Integrator::rk4:
            return 2;
        case Integrator::implicitEuler:
            return coils ? 3 : 1;
        default:
            return 1;
    }
}

/// A thread eliminates 3×3 blocks from root to tip, of which registers hold a few.
void giveStrandsToThreads(BatchShape& shape) {
    shape.unrolled = false;
    if (shape.storage != StrandStorage::lanes) return;
    shape.storage = StrandStorage::threads;
    shape.strands = runtime::kBlockLanes;
    shape.perThread = 1;
    shape.wave = 0;
}

void fillKey(const runtime::EffectPlan& plan, const runtime::SimulationSettings& settings, KernelKey& key) {
    key.shape.members = 1;
    // Strands without a free point follow their roots and nothing else.
    if (key.shape.points <= settings.clampedPoints) {
        key.spheres = SphereSource::none;
        key.wind = false;
        key.stages = callOf(runtime::StageId::roots);
        return;
    }
    key.own[kEvaluation] = evaluationOf(settings);
    if (key.own[kEvaluation] == 3) giveStrandsToThreads(key.shape);
    if (plan.on(Effect::angular)) key.own[kBend] = plan.factored() ? 2 : 1;
    key.own[kTargets] = plan.on(Effect::torsion) ? 1 : 0;
    key.own[kTensions] = plan.keepsTensions() ? 1 : 0;
}

std::string defines(const KernelKey& key) {
    const auto flag = [](bool on) { return on ? 1 : 0; };
    const BatchShape& shape = key.shape;
    return fmt::format(
        "#define HAIR_POINTS {}\n#define HAIR_EXACT {}\n#define HAIR_UNROLL {}\n#define HAIR_STORAGE {}\n"
        "#define HAIR_STRANDS {}\n#define HAIR_TOGETHER {}\n"
        "#define HAIR_PER_THREAD {}\n#define HAIR_WAVE {}\n"
        "#define HAIR_CLAMPED {}\n#define HAIR_EVALUATION {}\n#define HAIR_BEND {}\n#define HAIR_TARGETS {}\n"
        "#define HAIR_TENSIONS {}\n#define HAIR_SPHERES {}\n#define HAIR_WIND {}\n#define HAIR_SLEEP {}\n"
        "#define HAIR_VELOCITIES {}\n#define HAIR_STAGES {}\n",
        shape.points, flag(shape.exact), flag(shape.unrolled), static_cast<std::uint32_t>(shape.storage),
        shape.strands, flag(shape.together), shape.perThread, shape.wave, key.clampedPoints,
        key.own[kEvaluation], key.own[kBend], key.own[kTargets], key.own[kTensions],
        static_cast<std::uint32_t>(key.spheres), flag(key.wind), flag(key.sleep), flag(key.velocities),
        key.stages);
}

std::size_t scratchPlanes(const KernelKey& key) {
    return kScratchPlanes[key.own[kEvaluation]];
}

std::uint32_t velocitySlot(const KernelKey& key) {
    return key.shape.storage == StrandStorage::buffers ? 8 : 7;
}

std::string error(const runtime::SimulationSettings& settings) {
    if (settings.collisionSegments)
        return "segments that meet spheres run on the CPU alone. Set collisionSegments to 0 to use the GPU";
    return {};
}

/// Of angular springs, a point.
std::size_t bendFloats(const KernelKey& key) {
    if (key.own[kBend] < 2) return key.own[kBend];
    return key.shape.storage == StrandStorage::lanes ? 4 * (reductionSteps(key.shape.points) + 1) : 4;
}

class DeviceSprings final : public DeviceStrands {
  public:
    Status takeSettings(gpu::Device&, const runtime::RestShape&, const runtime::SimulationSettings&,
                        std::span<StrandBatch>) override {
        bendSubstep_ = 0.0f;
        return {};
    }

    void changePlan(const runtime::EffectPlan& before, const runtime::EffectPlan& next) override {
        if (!before.keepsTensions() && next.keepsTensions()) tensionsVoid_ = true;
    }

    Status allocate(gpu::Device& device, StrandBatch& batch) override {
        const std::size_t plane = std::size_t{batch.shape.points} * batch.slots;
        const auto have = [&](std::uint32_t slot, Effect effect, const char* name, std::size_t count,
                              std::uint32_t bytes) -> Status {
            auto& read = batch.model.read;
            auto found = std::ranges::find(read, slot, &ModelBuffer::slot);
            if (found == read.end()) found = read.insert(read.end(), {slot, effect, nullptr});
            const auto fresh = haveFloats(device, found->buffer, name, count, bytes);
            if (!fresh) return tl::unexpected(fresh.error());
            if (*fresh) bendSubstep_ = 0.0f;
            return {};
        };
        const KernelKey& key = batch.key;
        if (auto made = have(2, Effect::angular, "angular springs", plane * bendFloats(key),
                             key.own[kBend] == 1 ? 4 : 16);
            !made)
            return made;
        return have(3, Effect::torsion, "rest directions", plane * 4 * key.own[kTargets], 16);
    }

    void upload(gpu::CommandList& list, const runtime::RestShape& shape, const runtime::EffectPlan& plan,
                const runtime::SimulationSettings& settings, float h,
                std::span<const StrandBatch> batches) override {
        if (tensionsVoid_) {
            for (const StrandBatch& batch : batches) {
                const std::vector<float> none(std::size_t{batch.shape.points} * batch.slots);
                list.updateBuffer(batch.state, runtime::kStatePlanes * none.size() * sizeof(float),
                                  bytesOfVector(none));
            }
            tensionsVoid_ = false;
        }
        if (!plan.on(Effect::angular) || bendSubstep_ == h) return;
        uploadBend(list, shape, plan, settings, h, batches);
        bendSubstep_ = h;
    }

    void allocateState(const runtime::RestShape& shape, const runtime::EffectPlan& plan,
                       runtime::State& state) const override {
        if (plan.keepsTensions()) state.own[runtime::kOwnTensions].assign(shape.planeFloats, 0.0f);
    }

    void readOwn(const runtime::RestShape& shape, const StrandBatch& batch, std::span<const float> moving,
                 std::span<const float>, runtime::State& state) const override {
        if (batch.key.own[kTensions] == 0) return;
        const std::size_t plane = std::size_t{batch.shape.points} * batch.slots;
        runtime::planesOfBlocks(shape, batch.inSlots(), moving.subspan(runtime::kStatePlanes * plane),
                                state.own[runtime::kOwnTensions], 1);
    }

    void writeOwn(const runtime::RestShape& shape, const StrandBatch& batch, const runtime::State& state,
                  runtime::Vector<float>& moving, runtime::Vector<float>&) const override {
        if (state.model != runtime::StrandModel::springs || state.own[runtime::kOwnTensions].empty()) return;
        const auto tensions =
            runtime::planesOfSlots(shape, batch.inSlots(), state.own[runtime::kOwnTensions], 1);
        moving.insert(moving.end(), tensions.begin(), tensions.end());
    }

  private:
    /// The arrays of angular springs for substeps of h seconds.
    static void uploadBend(gpu::CommandList& list, const runtime::RestShape& shape,
                           const runtime::EffectPlan& plan, const runtime::SimulationSettings& settings,
                           float h, std::span<const StrandBatch> batches) {
        runtime::Bend bend;
        bend.factored = plan.factored();
        bend.targets = plan.on(Effect::torsion);
        bend.planes = runtime::Floats(shape.planeFloats * bend.planeCount(), 0.0f);
        parallelFor(shape.blocks.size(), kBlocksPerJob, [&](std::size_t first, std::size_t end) {
            for (std::size_t b = first; b < end; ++b) runtime::fillBend(shape, settings, h, b, bend);
        });
        const std::size_t planes = bend.planeCount();
        for (const StrandBatch& batch : batches) {
            const std::uint32_t kind = batch.key.own[kBend];
            const gpu::BufferPtr springs = batch.model.at(2), targets = batch.model.at(3);
            if (kind == 1) {
                auto all = runtime::planesOfSlots(shape, batch.inSlots(), bend.planes, planes);
                all.resize(std::size_t{batch.shape.points} * batch.slots);
                list.updateBuffer(springs, 0, bytesOfVector(all));
            } else if (kind == 2 && batch.key.shape.storage == StrandStorage::lanes) {
                list.updateBuffer(springs, 0,
                                  bytesOfVector(reducedBend(shape, batch, settings.clampedPoints, bend)));
            } else if (kind == 2) {
                // Planes are stiffness, inverse diagonal, lower1, lower2; the kernel has the stiffness last.
                constexpr std::array<std::size_t, 4> kFactors{1, 2, 3, 0};
                list.updateBuffer(springs, 0,
                                  bytesOfVector(runtime::quadsOfSlots(shape, batch.inSlots(), bend.planes,
                                                                      planes, kFactors)));
            }
            if (batch.key.own[kTargets] == 0) continue;
            const std::array<std::size_t, 3> directions{planes - 3, planes - 2, planes - 1};
            list.updateBuffer(targets, 0,
                              bytesOfVector(runtime::quadsOfSlots(shape, batch.inSlots(), bend.planes, planes,
                                                                  directions)));
        }
    }

    float bendSubstep_ = 0.0f;   ///< that the springs' buffers are for; 0: none
    bool tensionsVoid_ = false;  ///< those on the device are of a plan that is over
};

}  // namespace

const GpuModel& gpuSprings() {
    static const GpuModel kModel{
        .fillKey = fillKey,
        .defines = defines,
        .scratchPlanes = scratchPlanes,
        .velocitySlot = velocitySlot,
        .gatheredSlot = 6,
        .error = error,
        .storage = {},
        .make = []() -> std::unique_ptr<DeviceStrands> { return std::make_unique<DeviceSprings>(); }};
    return kModel;
}

}  // namespace hairloom::gpu_simulation
