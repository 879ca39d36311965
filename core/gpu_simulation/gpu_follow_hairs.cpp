// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gpu_simulation/gpu_follow_hairs.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <vector>

#include "core/gpu_simulation/compiled_kernel.h"
#include "core/gpu_simulation/strand_batch.h"
#include "follow/follow_gpu.h"

namespace hairloom::gpu_simulation {
namespace {

using gpu::Usage;

constexpr std::uint32_t kGuidesPerGroup = 32;  // as in follow_wisps.comp.hlsl
constexpr std::uint32_t kPointsPerGroup = 64;  // as in follow_hairs.comp.hlsl
constexpr std::uint32_t kMaxGroups = 65535;    // of one dimension, on every device
constexpr std::size_t kRows = 4;

}  // namespace

struct GpuFollowHairs::Impl {
    shaders::FollowConstants constants;
    std::vector<shaders::FollowPlane> planes;
    std::vector<shaders::float4> frames;  // of the last frame: two a guide, the second its turn
    gpu::BufferPtr samples, radii, bindings, planeBuffer, frameBuffer, rows, hairs;
    gpu::ComputePipelinePtr wisps, sums;

    Status makeBuffers(gpu::Device& device, const runtime::FollowView& view);
};

Status GpuFollowHairs::Impl::makeBuffers(gpu::Device& device, const runtime::FollowView& view) {
    Status status;
    const auto keep = [&](gpu::BufferPtr& buffer, Result<gpu::BufferPtr> made) {
        if (!status) return;
        if (made) {
            buffer = std::move(*made);
        } else {
            status = tl::unexpected(made.error());
        }
    };
    std::vector<shaders::FollowBinding> all;
    for (std::size_t hair = 0; hair < view.guides.size(); ++hair)
        all.push_back(runtime::followBinding(view, hair));
    const auto samplesAll = runtime::followSamples(view);
    const std::size_t points = constants.points;
    keep(samples, makeBuffer<std::array<float, 2>>(device, "guide samples", Usage::ShaderRead,
                                                   samplesAll.size(), samplesAll));
    keep(radii, makeBuffer<float>(device, "wisp radii", Usage::ShaderRead, points, view.radii));
    keep(bindings,
         makeBuffer<shaders::FollowBinding>(device, "hair bindings", Usage::ShaderRead, all.size(), all));
    keep(planeBuffer,
         makeBuffer<shaders::FollowPlane>(device, "root planes", Usage::ShaderRead, planes.size(), planes));
    keep(frameBuffer,
         makeBuffer<shaders::float4>(device, "turns of guides", Usage::ShaderRead, frames.size(), frames));
    const Usage both = Usage::ShaderRead | Usage::UnorderedAccess;
    keep(rows, makeBuffer<shaders::float4>(device, "wisps", both, planes.size() * kRows * points, {}));
    keep(hairs, makeBuffer<shaders::float4>(device, "follow hairs", both, all.size() * points, {}));
    return status;
}

Result<GpuFollowHairs> GpuFollowHairs::make(gpu::Device& device, const runtime::FollowView& view) {
    if (const auto checked = runtime::FollowHairs::make(view); !checked.hairs) return fail(checked.error);
    if (view.guides.empty()) return fail("there are no hairs to follow", "expected bindings");
    auto impl = std::make_unique<Impl>();
    impl->constants.guides = static_cast<std::uint32_t>(view.rootPlanes_ss.size());
    impl->constants.hairs = static_cast<std::uint32_t>(view.guides.size());
    impl->constants.points = view.pointsPerHair;
    impl->constants.wispSpread = view.wisps.spread;
    impl->constants.wispLimit = view.wisps.limit;
    for (const runtime::RootPlane& plane : view.rootPlanes_ss)
        impl->planes.push_back(runtime::followPlane(plane));
    for (std::size_t g = 0; g < impl->planes.size(); ++g)
        impl->frames.insert(impl->frames.end(), {{}, {0, 0, 0, 1}});
    if (auto made = impl->makeBuffers(device, view); !made) return tl::unexpected(made.error());
    auto wisps = compiledKernel(device, "follow_wisps");
    if (!wisps) return tl::unexpected(wisps.error());
    auto sums = compiledKernel(device, "follow_hairs");
    if (!sums) return tl::unexpected(sums.error());
    impl->wisps = std::move(*wisps);
    impl->sums = std::move(*sums);
    return GpuFollowHairs(std::move(impl));
}

GpuFollowHairs::GpuFollowHairs(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
GpuFollowHairs::GpuFollowHairs(GpuFollowHairs&&) noexcept = default;
GpuFollowHairs& GpuFollowHairs::operator=(GpuFollowHairs&&) noexcept = default;
GpuFollowHairs::~GpuFollowHairs() = default;

std::uint32_t GpuFollowHairs::hairCount() const {
    return impl_->constants.hairs;
}
std::uint32_t GpuFollowHairs::pointsPerHair() const {
    return impl_->constants.points;
}
gpu::BufferPtr GpuFollowHairs::positions_ws() const {
    return impl_->hairs;
}

void GpuFollowHairs::record(gpu::CommandList& list, const FollowInput& input) {
    Impl& impl = *impl_;
    assert(input.rootRotations_ws.empty() || input.rootRotations_ws.size() == impl.planes.size());
    bool turned = false;
    for (std::size_t g = 0; input.roots_ws == nullptr && g < impl.planes.size(); ++g) {
        runtime::Quat turn = input.rootRotations_ws.empty() ? runtime::Quat{} : input.rootRotations_ws[g];
        if (!runtime::normalize(turn)) turn = {};
        shaders::float4& kept = impl.frames[2 * g + 1];
        turned = turned || kept.x != turn.x || kept.y != turn.y || kept.z != turn.z || kept.w != turn.w;
        kept = {turn.x, turn.y, turn.z, turn.w};
    }
    if (turned) list.updateBuffer(impl.frameBuffer, 0, std::as_bytes(std::span(impl.frames)));
    const gpu::BufferPtr& frames = input.roots_ws != nullptr ? input.roots_ws : impl.frameBuffer;
    shaders::FollowConstants constants = impl.constants;
    constants.hasVelocities = input.velocities_ws != nullptr ? 1 : 0;
    const gpu::BufferPtr& velocities =
        input.velocities_ws != nullptr ? input.velocities_ws : input.positions_ws;
    const auto run = [&](const gpu::ComputePipelinePtr& pipeline, const char* name,
                         std::span<const gpu::Binding> bound, std::uint32_t x, std::uint32_t y) {
        gpu::PassDesc pass;
        pass.name = name;
        list.beginPass(pass);
        list.setPipeline(pipeline);
        list.bind(bound);
        list.setConstants(0, gpu::bytesOf(constants));
        list.dispatch(x, y);
        list.endPass();
    };
    using gpu::Binding;
    const std::array<Binding, 7> ofWisps{Binding::read(0, input.positions_ws), Binding::read(1, velocities),
                                         Binding::read(2, impl.planeBuffer),   Binding::read(3, impl.samples),
                                         Binding::read(4, impl.radii),         Binding::read(5, frames),
                                         Binding::write(0, impl.rows)};
    run(impl.wisps, "wisps", ofWisps, (constants.guides + kGuidesPerGroup - 1) / kGuidesPerGroup, 1);
    const std::array<Binding, 5> ofHairs{Binding::read(0, impl.rows), Binding::read(1, impl.planeBuffer),
                                         Binding::read(2, impl.bindings), Binding::read(3, frames),
                                         Binding::write(0, impl.hairs)};
    const std::uint32_t groups = (constants.hairs * constants.points + kPointsPerGroup - 1) / kPointsPerGroup;
    run(impl.sums, "follow hairs", ofHairs, std::min(groups, kMaxGroups),
        (groups + kMaxGroups - 1) / kMaxGroups);
}

}  // namespace hairloom::gpu_simulation
