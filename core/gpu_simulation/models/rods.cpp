// SPDX-License-Identifier: GPL-3.0-or-later
// Rods on a GPU: a thread per strand, or some that share it, and all that a strand has in buffers.
#include "runtime/models/rods/rods.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/gpu_simulation/models/models.h"
#include "core/simulation/strand_method.h"
#include "runtime/engine/moving_body.h"
#include "runtime/models/rods/rod_slots.h"
#include "runtime/shaders/body_types.h"

namespace hairloom::gpu_simulation {
namespace {

using gpu::Usage;
using runtime::Effect;

/// Strands of a work group whose threads share them: few, so that few strands find many multiprocessors.
constexpr std::uint32_t kSharedStrands = 8;

/// Of KernelKey::own: rods follow poses.
constexpr std::size_t kPoses = 0;
constexpr std::uint32_t kPoseSlot = 10;

/// A block is a work group and each of its strands a thread's, or some threads share one.
void fillKey(const runtime::EffectPlan& plan, const runtime::SimulationSettings&, KernelKey& key) {
    key.own[kPoses] = plan.on(Effect::pose) ? 1 : 0;
    BatchShape& shape = key.shape;
    shape.storage = StrandStorage::buffers;
    shape.strands = shape.members > 1 ? kSharedStrands : runtime::kBlockLanes;
    shape.perThread = 1;
    shape.wave = 0;
    // Skin is met as spheres are, by code that is there for these.
    if (key.body && key.spheres == SphereSource::none) key.spheres = SphereSource::constants;
}

std::string defines(const KernelKey& key) {
    const auto flag = [](bool on) { return on ? 1 : 0; };
    return fmt::format(
        "#define HAIR_RODS 1\n#define HAIR_MEMBERS {}\n#define HAIR_STRANDS {}\n#define HAIR_TOGETHER {}\n"
        "#define HAIR_CLAMPED {}\n#define HAIR_SPHERES {}\n#define HAIR_WIND {}\n#define HAIR_SLEEP {}\n"
        "#define HAIR_VELOCITIES {}\n#define HAIR_BODY {}\n#define HAIR_STAGES {}\n{}",
        key.shape.members, key.shape.strands, flag(key.shape.together), key.clampedPoints,
        static_cast<std::uint32_t>(key.spheres), flag(key.wind), flag(key.sleep), flag(key.velocities),
        flag(key.body), key.stages, key.own[kPoses] > 0 ? "#define HAIR_POSES 1\n" : "");
}

std::size_t scratchPlanes(const KernelKey& key) {
    const bool contacts = key.spheres != SphereSource::none;
    return HAIRLOOM_ROD_WORK_PLANES + (contacts ? HAIRLOOM_ROD_CONTACT_PLANES : 0) +
           (key.body ? HAIRLOOM_ROD_BODY_PLANES : 0);
}

std::uint32_t velocitySlot(const KernelKey&) {
    return 6;
}

class DeviceRods final : public DeviceStrands {
  public:
    Status takeSettings(gpu::Device& device, const runtime::RestShape& shape,
                        const runtime::SimulationSettings& settings,
                        std::span<StrandBatch> batches) override {
        const bool same = rest_ && runtime::haveEqualRodEnergy(settings, settings_);
        settings_ = settings;
        // What rods rest in follows from no other settings.
        if (same) return {};
        if (rest_) energyKnown_ = false;
        posesAreOld_ = true;
        rest_ = runtime::makeRodRest(shape, settings);
        touches_.folds =
            std::ranges::any_of(batches, [](const StrandBatch& b) { return b.clearances != nullptr; });
        for (StrandBatch& batch : batches) {
            if (auto made = makeBuffers(device, shape, batch); !made) return made;
        }
        return {};
    }

    void takePoses(const runtime::RestShape& shape, const runtime::SimulationSettings& settings,
                   const runtime::PoseChange& change) override {
        const bool followed = poses_.isOn();
        runtime::PoseChange known = change;
        known.others = std::exchange(posesAreOld_, false) || known.others;
        poses_.take(shape, settings, *rest_, known, applicationHost());
        posesChanged_ = true;
        if (followed || poses_.isOn()) energyKnown_ = false;
    }

    Status allocate(gpu::Device& device, StrandBatch& batch) override {
        auto& read = batch.model.read;
        const bool has = batch.model.at(kPoseSlot) != nullptr, needs = batch.key.own[kPoses] > 0;
        if (has == needs) return {};
        std::erase_if(read, [](const ModelBuffer& buffer) { return buffer.slot == kPoseSlot; });
        if (!needs) return {};
        const std::size_t points = std::size_t{batch.shape.points} * batch.slots;
        auto made = makeBuffer<shaders::float4>(device, "poses of rods", Usage::ShaderRead, 2 * points, {});
        if (!made) return tl::unexpected(made.error());
        read.push_back({kPoseSlot, Effect::pose, std::move(*made)});
        posesChanged_ = true;
        return {};
    }

    void upload(gpu::CommandList& list, const runtime::RestShape& shape, const runtime::EffectPlan&,
                const runtime::SimulationSettings&, float, std::span<const StrandBatch> batches) override {
        if (!posesChanged_) return;
        for (const StrandBatch& batch : batches) {
            const gpu::BufferPtr buffer = batch.model.at(kPoseSlot);
            // While its kernel is being made, there is none.
            if (buffer == nullptr) return;
            // The kernel that still runs until there is one without poses pulls nowhere then.
            const runtime::Vector<shaders::float4> rows =
                poses_.isOn() ? posesOfSlots(shape, batch.inSlots(), poses_)
                              : runtime::Vector<shaders::float4>(2 * batch.inSlots().planeSize());
            list.updateBuffer(buffer, 0, bytesOfVector(rows));
        }
        posesChanged_ = false;
    }

    void setConstants(gpu::CommandList& list, const runtime::SubstepContext& context,
                      const runtime::Wind& wind, float before, const StrandBatch& batch) const override {
        const std::uint32_t fresh = fresh_         ? HAIRLOOM_RODS_FRESH
                                    : energyKnown_ ? 0
                                                   : HAIRLOOM_RODS_OF_OTHER_ENERGY;
        auto constants = runtime::rodConstants(context, wind, before, batch.inSlots(), fresh);
        // While the kernel for more of them is being made.
        if (batch.key.spheres == SphereSource::constants) {
            const std::size_t spheres =
                std::min<std::size_t>(context.spheres.size(), HAIRLOOM_CONSTANT_SPHERES);
            constants.capsules = std::min(
                constants.capsules, static_cast<std::uint32_t>((HAIRLOOM_CONSTANT_SPHERES - spheres) / 2));
        }
        list.setConstants(2, gpu::bytesOf(constants));
    }

    void closeFrame() override {
        fresh_ = false;
        energyKnown_ = true;
    }

    void allocateState(const runtime::RestShape& shape, const runtime::EffectPlan&,
                       runtime::State& state) const override {
        runtime::allocateRods(shape, rest_->parts, touches_, state);
    }

    void placeAtRest(const runtime::RestShape& shape, runtime::State& state, std::size_t index,
                     runtime::LaneRange lanes) const override {
        runtime::placeRodAtRest(shape, *rest_, state, index, lanes);
    }

    /// A state of another model, or of chains, becomes one of these rods.
    std::optional<runtime::State> takeState(const runtime::RestShape& shape,
                                            const runtime::State& given) override {
        fresh_ = false;
        const bool bends = rest_->parts >= runtime::RodParts::bending;
        const bool complete = given.model == runtime::StrandModel::rods &&
                              !(bends && given.own[runtime::kOwnStrains].empty()) &&
                              !(touches_.folds && given.own[runtime::kOwnFolds].empty());
        if (complete) return {};
        std::optional<runtime::State> made = given;
        runtime::completeRods(shape, *rest_, touches_, *made);
        return made;
    }

    void readOwn(const runtime::RestShape& shape, const StrandBatch& batch, std::span<const float>,
                 std::span<const float> own, runtime::State& state) const override {
        runtime::rodStateToBlocks(shape, batch.inSlots(), own, state);
    }

    void writeOwn(const runtime::RestShape& shape, const StrandBatch& batch, const runtime::State& state,
                  runtime::Vector<float>&, runtime::Vector<float>& own) const override {
        own = runtime::rodStateOfSlots(shape, batch.inSlots(), state, touches_.folds);
    }

  private:
    Status makeBuffers(gpu::Device& device, const runtime::RestShape& shape, StrandBatch& batch) const {
        const runtime::RodSlots rods = runtime::rodsOfSlots(shape, batch.inSlots(), *rest_);
        Status status;
        const auto make = [&]<class T>(const char* name, std::uint32_t slot,
                                       const runtime::Vector<T>& content) {
            if (!status) return;
            auto made = makeBuffer<T>(device, name, Usage::ShaderRead, content.size(), content);
            if (!made) {
                status = tl::unexpected(made.error());
                return;
            }
            batch.model.read.push_back({slot, Effect::angular, std::move(*made)});
        };
        std::erase_if(batch.model.read, [](const ModelBuffer& buffer) { return buffer.slot != kPoseSlot; });
        make("rods at rest", 2, rods.rest);
        make("masses of rods", 3, rods.masses);
        make("curved blocks", 9, rods.curved);
        if (!status || batch.model.state.buffer != nullptr) return status;
        const std::size_t rows =
            std::size_t{batch.shape.points} *
                (runtime::kRodStatePlanes + (touches_.folds ? runtime::kFoldPlanes : 0)) +
            runtime::kRodLaneRows;
        auto made = makeBuffer<float>(device, "rods", Usage::ShaderRead | Usage::UnorderedAccess,
                                      rows * batch.slots, {});
        if (!made) return tl::unexpected(made.error());
        batch.model.state = {5, Effect::angular, std::move(*made)};
        return {};
    }

    std::optional<runtime::RodRest> rest_;  ///< once settings were taken
    runtime::RodTouches touches_{.loads = true};
    runtime::RodPoses poses_;
    bool posesAreOld_ = false;              ///< since rest_ is another
    bool posesChanged_ = false;             ///< since they were sent
    runtime::SimulationSettings settings_;  ///< that rest_ was made with
    bool energyKnown_ = true;               ///< what rods had before the frame is energy under these settings
    bool fresh_ = true;                     ///< the device has places of rods, and nothing else yet
};

}  // namespace

const GpuModel& gpuRods() {
    static const GpuModel kModel{
        .fillKey = fillKey,
        .defines = defines,
        .scratchPlanes = scratchPlanes,
        .velocitySlot = velocitySlot,
        .gatheredSlot = 8,
        .error = [](const runtime::SimulationSettings&) { return std::string(); },
        // A thread takes a rod, and finds those of its neighbours beside it.
        .storage = StrandStorage::threads,
        .make = []() -> std::unique_ptr<DeviceStrands> { return std::make_unique<DeviceRods>(); }};
    return kModel;
}

}  // namespace hairloom::gpu_simulation
