// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gpu_simulation/gpu_hair_volume.h"

#include <array>
#include <cmath>

#include "core/gpu_simulation/compiled_kernel.h"
#include "runtime/engine/strand_model.h"
#include "runtime/shaders/volume_types.h"

namespace hairloom::gpu_simulation {
namespace {

using gpu::Binding;
using gpu::Usage;

constexpr std::uint32_t kGroup = 64;  // as in volume_*.comp.hlsl
constexpr std::size_t kNodeWords = 8;
/// As volume.hlsli has it: no place yet, nothing moves.
constexpr std::array<std::uint32_t, 8> kEmptyBox{~0u, ~0u, ~0u, 0, 0, 0, 0, 0};

std::uint32_t groupsFor(std::size_t threads) {
    return static_cast<std::uint32_t>((threads + kGroup - 1) / kGroup);
}

}  // namespace

Result<GpuHairVolume> GpuHairVolume::make(gpu::Device& device, const runtime::HairVolumeSettings& settings) {
    runtime::HairVolumeSettings checked = settings;
    // Its memory is not needed, only its judgement of the rest.
    checked.maxNodes = std::min(settings.maxNodes, 125u);
    const auto made = runtime::HairVolume::make(settings.maxNodes < 125 ? settings : checked);
    if (!made.volume) return fail(made.error);
    GpuHairVolume volume(settings);
    if (auto status = volume.makeBuffers(device); !status) return tl::unexpected(status.error());
    if (auto status = volume.makeKernels(device); !status) return tl::unexpected(status.error());
    return volume;
}

Status GpuHairVolume::makeBuffers(gpu::Device& device) {
    const Usage both = Usage::ShaderRead | Usage::UnorderedAccess;
    const std::size_t nodes = settings_.maxNodes;
    auto box = makeBuffer<std::uint32_t>(device, "box of the hair", both, kEmptyBox.size(), kEmptyBox);
    if (!box) return tl::unexpected(box.error());
    auto sums = makeBuffer<std::uint32_t>(device, "volume nodes", both, nodes * kNodeWords, {});
    if (!sums) return tl::unexpected(sums.error());
    auto fields = makeBuffer<shaders::float4>(device, "volume fields", both, nodes * 2, {});
    if (!fields) return tl::unexpected(fields.error());
    constexpr std::array<float, 2> kNone{};
    for (gpu::BufferPtr& nothing : nothing_) {
        auto made = makeBuffer<float>(device, "nothing", both, kNone.size(), kNone);
        if (!made) return tl::unexpected(made.error());
        nothing = std::move(*made);
    }
    box_ = std::move(*box);
    nodes_ = std::move(*sums);
    fields_ = std::move(*fields);
    return {};
}

Status GpuHairVolume::makeKernels(gpu::Device& device) {
    const std::array<std::pair<const char*, gpu::ComputePipelinePtr*>, 5> kernels{
        {{"volume_measure", &measure_},
         {"volume_clear", &clear_},
         {"volume_add", &add_},
         {"volume_resolve", &resolve_},
         {"volume_push", &push_}}};
    for (const auto& [name, pipeline] : kernels) {
        auto made = compiledKernel(device, name);
        if (!made) return tl::unexpected(made.error());
        *pipeline = std::move(*made);
    }
    return {};
}

void GpuHairVolume::record(gpu::CommandList& list, std::span<const StrandBatch> batches,
                           std::uint32_t clampedPoints, float dt, float h) const {
    shaders::VolumeConstants constants;
    constants.cellSize = settings_.cellSize;
    constants.maxNodes = static_cast<float>(settings_.maxNodes);
    constants.targetDensity = settings_.targetDensity;
    constants.repulsion = settings_.repulsion;
    constants.share = -std::expm1(-settings_.friction * dt);
    constants.dt = dt;
    constants.h = h;
    constants.clampedPoints = clampedPoints;
    constants.unused1 = constants.unused2 = constants.unused3 = 0;
    list.updateBuffer(box_, 0, std::as_bytes(std::span(kEmptyBox)));
    gpu::PassDesc pass;
    pass.name = "hair-hair collision";
    list.beginPass(pass);
    const auto overNodes = [&](const gpu::ComputePipelinePtr& pipeline, std::span<const Binding> bindings) {
        list.setPipeline(pipeline);
        list.bind(bindings);
        list.setConstants(0, gpu::bytesOf(constants));
        list.dispatch(groupsFor(settings_.maxNodes));
    };
    const auto overPoints = [&](const gpu::ComputePipelinePtr& pipeline, std::span<const Binding> bindings,
                                auto&& bindBatch) {
        for (const StrandBatch& batch : batches) {
            constants.slots = batch.slots;
            constants.points = batch.shape.points;
            constants.together = batch.shape.together ? 1 : 0;
            constants.sleeps = batch.rests != nullptr ? 1 : 0;
            constants.rods = runtime::modelOf(batch.key.model).keepsVelocities ? 1 : 0;
            list.setPipeline(pipeline);
            const std::array<Binding, 3> strands{Binding::read(0, batch.blockCounts),
                                                 Binding::read(1, batch.firstPoints),
                                                 Binding::read(2, batch.roots)};
            list.bind(strands);
            list.bind(bindings);
            bindBatch(batch);
            list.setConstants(0, gpu::bytesOf(constants));
            list.dispatch(groupsFor(std::size_t{batch.slots} * batch.shape.points));
        }
    };
    const auto readState = [&](const StrandBatch& batch) {
        const Binding state = Binding::read(3, batch.state);
        list.bind({&state, 1});
    };
    constants.slots = constants.points = constants.together = constants.sleeps = constants.rods = 0;
    const std::array<Binding, 1> measured{Binding::write(0, box_)};
    overPoints(measure_, measured, readState);
    const std::array<Binding, 2> cleared{Binding::read(0, box_), Binding::write(0, nodes_)};
    overNodes(clear_, cleared);
    const std::array<Binding, 2> added{Binding::read(4, box_), Binding::write(0, nodes_)};
    overPoints(add_, added, readState);
    const std::array<Binding, 3> resolved{Binding::read(0, box_), Binding::read(1, nodes_),
                                          Binding::write(0, fields_)};
    overNodes(resolve_, resolved);
    const std::array<Binding, 2> pushed{Binding::read(3, box_), Binding::read(4, fields_)};
    overPoints(push_, pushed, [&](const StrandBatch& batch) {
        const gpu::BufferPtr& own = batch.model.state.buffer;
        const std::array<Binding, 3> written{
            Binding::write(0, batch.state),
            Binding::write(1, batch.rests != nullptr ? batch.rests : nothing_[0]),
            Binding::write(2, own != nullptr ? own : nothing_[1])};
        list.bind(written);
    });
    list.endPass();
}

std::size_t GpuHairVolume::bytes() const {
    std::size_t bytes = 0;
    for (const auto& buffer : {box_, nodes_, fields_, nothing_[0], nothing_[1]})
        bytes += static_cast<std::size_t>(buffer->desc().size);
    return bytes;
}

}  // namespace hairloom::gpu_simulation
