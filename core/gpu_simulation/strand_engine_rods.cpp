// SPDX-License-Identifier: GPL-3.0-or-later
// Strands as elastic rods: what the device is told of them.
#include <array>
#include <cmath>

#include "core/gpu_simulation/strand_engine_impl.h"
#include "runtime/engine/checks.h"

namespace hairloom::gpu_simulation {
namespace {

using gpu::Usage;
using runtime::Float3;
using runtime::kBlockLanes;

static_assert(HAIRLOOM_ROD_STATE_PLANES == runtime::kRodStatePlanes);
static_assert(runtime::kRodNoStep == static_cast<float>(HAIRLOOM_ROD_NO_STEP));
static_assert(runtime::kRodNoEnergy == static_cast<float>(HAIRLOOM_ROD_NO_ENERGY));
static_assert(runtime::kRodLaneRows == 2);

// Planes of runtime::RodRest, in threes and fours as the kernel reads them.
constexpr std::array<std::size_t, 3> kTangent{0, 1, 2};
constexpr std::array<std::size_t, 4> kTangentAndBend{0, 1, 2, runtime::kRodBendPlane};
constexpr std::array<std::size_t, 4> kRestRotation{runtime::kRodRotationPlane, runtime::kRodRotationPlane + 1,
                                                   runtime::kRodRotationPlane + 2,
                                                   runtime::kRodRotationPlane + 3};
constexpr std::array<std::size_t, 3> kAxis{runtime::kRodAxisPlane, runtime::kRodAxisPlane + 1,
                                           runtime::kRodAxisPlane + 2};
constexpr std::array<std::size_t, 3> kNormal{runtime::kRodNormalPlane, runtime::kRodNormalPlane + 1,
                                             runtime::kRodNormalPlane + 2};
constexpr std::array<std::size_t, 1> kMass{runtime::kRodMassPlane};

}  // namespace

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
    const auto quads = [&](std::span<const std::size_t> which) {
        return quadsOfBatch(*shape, batch, rodRest.planes, rodRest.planeCount(), which);
    };
    const bool bends = rodRest.parts >= runtime::RodParts::bending;
    std::vector<shaders::float4> rest =
        quads(bends ? std::span<const std::size_t>(kTangentAndBend) : kTangent);
    const auto append = [&](const std::vector<shaders::float4>& more) {
        rest.insert(rest.end(), more.begin(), more.end());
    };
    // A chain has the shape that it was authored in.
    append(bends ? quads(kRestRotation)
                 : std::vector<shaders::float4>(rest.size(), shaders::float4{0.0f, 0.0f, 0.0f, 1.0f}));
    if (rodRest.parts >= runtime::RodParts::twist) append(quads(kAxis));
    if (rodRest.parts >= runtime::RodParts::section) append(quads(kNormal));
    std::vector<float> masses;
    for (const shaders::float4& quad : quads(kMass)) masses.push_back(quad.x);
    std::vector<std::uint32_t> curved;
    for (const std::uint32_t block : batch.blocks)
        curved.push_back(rodRest.curved.empty() ? 0 : rodRest.curved[block]);
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
    make(batch.rodRest, "rods at rest", Usage::ShaderRead, rest.size(),
         std::span<const shaders::float4>(rest));
    make(batch.rodMasses, "masses of rods", Usage::ShaderRead, masses.size(), std::span<const float>(masses));
    make(batch.curvedBlocks, "curved blocks", Usage::ShaderRead, curved.size(),
         std::span<const std::uint32_t>(curved));
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

/// The planes of the device are those of motion, strains and loads; 0 where the state has none.
void StrandEngine::Impl::sendRods(gpu::CommandList& list, const StrandBatch& batch,
                                  const runtime::State& state) const {
    const std::size_t plane = std::size_t{batch.shape.points} * batch.slots;
    std::vector<float> rods;
    const auto append = [&](std::size_t own, std::size_t planes) {
        const std::vector<float> values = state.own[own].empty()
                                              ? std::vector<float>(planes * plane)
                                              : planesOfBatch(*shape, batch, state.own[own], planes);
        rods.insert(rods.end(), values.begin(), values.end());
    };
    append(runtime::kOwnMotion, runtime::kRodMotionPlanes);
    append(runtime::kOwnStrains, runtime::kRodStrainPlanes);
    append(runtime::kOwnLoads, 1);
    const std::vector<float> rows =
        rowsOfBatch(batch, state.own[runtime::kOwnLanes].data(), runtime::kRodLaneRows);
    rods.insert(rods.end(), rows.begin(), rows.end());
    list.updateBuffer(batch.rodState, 0, std::as_bytes(std::span(rods)));
}

/// The reverse.
void StrandEngine::Impl::takeRodsOf(const StrandBatch& batch, std::span<const float> rods,
                                    runtime::State& state) const {
    const std::size_t plane = std::size_t{batch.shape.points} * batch.slots;
    const auto take = [&](std::size_t own, std::size_t planes) {
        if (!state.own[own].empty())
            planesOfBlocks(*shape, batch, rods.first(planes * plane), state.own[own], planes);
        rods = rods.subspan(planes * plane);
    };
    take(runtime::kOwnMotion, runtime::kRodMotionPlanes);
    take(runtime::kOwnStrains, runtime::kRodStrainPlanes);
    take(runtime::kOwnLoads, 1);
    rowsToBlocks(batch, rods, runtime::kRodLaneRows, state.own[runtime::kOwnLanes].data());
}

shaders::RodConstants StrandEngine::Impl::rodConstants(const runtime::SubstepContext& context,
                                                       const StrandBatch& batch) const {
    const Float3 g = context.gravity;
    shaders::RodConstants c;
    c.gravity = {g.x, g.y, g.z, context.air == runtime::Air::none ? 0.0f : context.airDrag};
    c.numbers = context.numbers.as<runtime::RodNumbers>();
    c.stepRatio = substep > 0.0f ? context.h / substep : runtime::kFirstStepRatio;
    c.sweeps = context.sweeps ? 1 : 0;
    c.conservative = context.air == runtime::Air::moving ? 0 : context.spheresRest ? 2 : 1;
    c.fresh = rodsFresh ? HAIRLOOM_RODS_FRESH : rodEnergyKnown ? 0 : HAIRLOOM_RODS_OF_OTHER_ENERGY;
    c.points = batch.shape.points;
    for (std::size_t m = 0; m < runtime::kWindModes; ++m) {
        const float turns = run.wind.wind.modes[m].turnsPerSecond * context.h;
        c.windTurns[m] = {turns - std::round(turns), 0.0f, 0.0f, 0.0f};
    }
    return c;
}

}  // namespace hairloom::gpu_simulation
