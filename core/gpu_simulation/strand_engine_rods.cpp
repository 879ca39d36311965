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
constexpr std::array<std::size_t, 4> kTangentAndBend{0, 1, 2, 6}, kRestRotation{8, 9, 10, 11};
constexpr std::array<std::size_t, 3> kAxis{3, 4, 5}, kNormal{12, 13, 14};
constexpr std::array<std::size_t, 1> kMass{7};

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
        return quadsOfBatch(*shape, batch, rodRest.planes, rodRest.planeCount, which);
    };
    std::vector<shaders::float4> rest = quads(kTangentAndBend);
    std::vector<std::span<const std::size_t>> others{kRestRotation, kAxis};
    if (rodRest.planeCount > runtime::kRodRestPlanes) others.emplace_back(kNormal);
    for (const std::span<const std::size_t> which : others) {
        const std::vector<shaders::float4> more = quads(which);
        rest.insert(rest.end(), more.begin(), more.end());
    }
    std::vector<float> masses;
    for (const shaders::float4& quad : quads(kMass)) masses.push_back(quad.x);
    std::vector<std::uint32_t> curved;
    for (const std::uint32_t block : batch.blocks) curved.push_back(rodRest.curved[block]);
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

/// Makes a state of points one of rods through them.
void StrandEngine::Impl::placeRods(runtime::State& state) const {
    state.rods.assign(shape->planeFloats * runtime::kRodStatePlanes, 0.0f);
    state.rodLanes.assign(shape->blocks.size() * runtime::kRodLaneRows * kBlockLanes, 0.0f);
    for (std::size_t b = 0; b < shape->blocks.size(); ++b) {
        for (std::uint32_t lane = 0; lane < kBlockLanes; ++lane)
            runtime::placeRodOnPoints(*shape, rodRest, state, b, lane);
    }
}

void StrandEngine::Impl::sendRods(gpu::CommandList& list, const StrandBatch& batch,
                                  const runtime::State& state) const {
    std::vector<float> rods = planesOfBatch(*shape, batch, state.rods, runtime::kRodStatePlanes);
    const std::vector<float> rows = rowsOfBatch(batch, state.rodLanes.data(), runtime::kRodLaneRows);
    rods.insert(rods.end(), rows.begin(), rows.end());
    list.updateBuffer(batch.rodState, 0, std::as_bytes(std::span(rods)));
}

shaders::RodConstants StrandEngine::Impl::rodConstants(const runtime::SubstepContext& context,
                                                       const StrandBatch& batch) const {
    const Float3 g = context.gravity;
    shaders::RodConstants c;
    c.gravity = {g.x, g.y, g.z, context.air == runtime::Air::none ? 0.0f : context.airDrag};
    c.rootDamping = context.rootDamping;
    c.bendDampingTime = context.bendDampingTime;
    c.twist = context.twist;
    c.flat = context.flat;
    c.stepRatio = substep > 0.0f ? context.h / substep : runtime::kRodFirstRatio;
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
