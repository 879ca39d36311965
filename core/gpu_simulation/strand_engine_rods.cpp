// SPDX-License-Identifier: GPL-3.0-or-later
// Strands as elastic rods: what the device is told of them.
#include "core/gpu_simulation/strand_engine_impl.h"

namespace hairloom::gpu_simulation {

/// Takes what strands are as rods under these settings, or that they are none.
Status StrandEngine::Impl::takeRods(const runtime::SimulationSettings& settings) {
    known.reset();
    if (settings.strandModel != runtime::StrandModel::rods) {
        rodRest = {};
        for (StrandBatch& batch : batches)
            batch.rodRest = batch.rodMasses = batch.curvedBlocks = batch.rodState = nullptr;
        return {};
    }
    // Strands that were none before go on from where they are.
    rodsFresh = rodsFresh || rodRest.planes.empty();
    rodEnergyKnown =
        rodEnergyKnown && (rodRest.planes.empty() || runtime::haveEqualRodEnergy(settings, rodSettings));
    rodSettings = settings;
    rodRest = runtime::makeRodRest(*shape, settings);
    for (StrandBatch& batch : batches) {
        if (auto made = makeRodBuffers(batch); !made) return made;
    }
    return {};
}

Status StrandEngine::Impl::makeRodBuffers(StrandBatch& batch) const {
    using gpu::Usage;
    const runtime::RodSlots rods = runtime::rodsOfSlots(*shape, batch.inSlots(), rodRest);
    Status status;
    const auto make = [&]<class T>(gpu::BufferPtr& buffer, const char* name, Usage usage, std::size_t count,
                                   std::span<const T> content) {
        if (!status) return;
        auto made = makeBuffer<T>(device, name, usage, count, content);
        if (made) {
            buffer = std::move(*made);
        } else {
            status = tl::unexpected(made.error());
        }
    };
    make(batch.rodRest, "rods at rest", Usage::ShaderRead, rods.rest.size(),
         std::span<const shaders::float4>(rods.rest));
    make(batch.rodMasses, "masses of rods", Usage::ShaderRead, rods.masses.size(),
         std::span<const float>(rods.masses));
    make(batch.curvedBlocks, "curved blocks", Usage::ShaderRead, rods.curved.size(),
         std::span<const std::uint32_t>(rods.curved));
    if (batch.rodState == nullptr) {
        const std::size_t floats =
            (std::size_t{batch.shape.points} * runtime::kRodStatePlanes + runtime::kRodLaneRows) *
            batch.slots;
        make(batch.rodState, "rods", Usage::ShaderRead | Usage::UnorderedAccess, floats,
             std::span<const float>());
    }
    return status;
}

/// Gives a state the arrays of rods, as far as the settings call for them.
void StrandEngine::Impl::allocateRods(runtime::State& state) const {
    state.model = run.settings.strandModel;
    if (!rodRest.planes.empty()) runtime::allocateRods(*shape, rodRest.parts, true, state);
}

shaders::RodConstants StrandEngine::Impl::rodConstants(const runtime::SubstepContext& context,
                                                       const StrandBatch& batch) const {
    const std::uint32_t fresh = rodsFresh        ? HAIRLOOM_RODS_FRESH
                                : rodEnergyKnown ? 0
                                                 : HAIRLOOM_RODS_OF_OTHER_ENERGY;
    return runtime::rodConstants(context, run.wind.wind, substep, batch.inSlots(), fresh);
}

}  // namespace hairloom::gpu_simulation
