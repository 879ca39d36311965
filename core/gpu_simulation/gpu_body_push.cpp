// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gpu_simulation/gpu_body_push.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/gpu_simulation/compiled_kernel.h"
#include "core/gpu_simulation/strand_batch.h"
#include "runtime/shaders/push_types.h"

namespace hairloom::gpu_simulation {

Result<GpuBodyPush> GpuBodyPush::make(gpu::Device& device, const runtime::BodyPush& push) {
    using gpu::Usage;
    GpuBodyPush made;
    Status status;
    const auto keep = [&](gpu::BufferPtr& buffer, Result<gpu::BufferPtr> result) {
        if (status && result) buffer = std::move(*result);
        if (status && !result) status = tl::unexpected(result.error());
    };
    keep(made.offsets_, makeBuffer<std::uint32_t>(device, "hairs beside the body", Usage::ShaderRead,
                                                  push.offsets().size(), push.offsets()));
    keep(made.least_, makeBuffer<float>(device, "points' clearances", Usage::ShaderRead, push.least().size(),
                                        push.least()));
    keep(made.leastBetween_, makeBuffer<float>(device, "curves' clearances", Usage::ShaderRead,
                                               push.leastBetween().size(), push.leastBetween()));
    std::vector<std::uint32_t> hairs;
    for (std::size_t h = 0; h + 1 < push.offsets().size(); ++h)
        hairs.resize(push.offsets()[h + 1], static_cast<std::uint32_t>(h));
    keep(made.hairOfPoint_, makeBuffer<std::uint32_t>(device, "hairs of points", Usage::ShaderRead,
                                                      hairs.size(), std::span<const std::uint32_t>(hairs)));
    const Usage both = Usage::ShaderRead | Usage::UnorderedAccess;
    keep(made.marks_, makeBuffer<std::uint32_t>(device, "points to lead out", both, hairs.size(), {}));
    const std::vector<std::uint32_t> none(push.offsets().size(), 0);
    keep(made.flags_, makeBuffer<std::uint32_t>(device, "hairs to lead out", both, none.size(),
                                                std::span<const std::uint32_t>(none)));
    if (!status) return tl::unexpected(status.error());
    for (const auto& [kernel, name] :
         {std::pair{&made.pointsOut_, "push_points"}, std::pair{&made.look_, "push_look"},
          std::pair{&made.curvesOut_, "push_hairs"}}) {
        auto compiled = compiledKernel(device, name);
        if (!compiled) return tl::unexpected(compiled.error());
        *kernel = std::move(*compiled);
    }
    made.hairs_ = static_cast<std::uint32_t>(push.offsets().size() - 1);
    made.points_ = static_cast<std::uint32_t>(hairs.size());
    return made;
}

void GpuBodyPush::record(gpu::CommandList& list, const DeviceBody& body,
                         const gpu::BufferPtr& points_ws) const {
    using gpu::Binding;
    constexpr std::uint32_t kMaxGroups = 65535;  // of one dimension, on every device
    std::vector<Binding> bindings{Binding::read(0, offsets_),      Binding::read(1, least_),
                                  Binding::read(2, leastBetween_), Binding::write(0, points_ws),
                                  Binding::write(1, marks_),       Binding::write(2, flags_)};
    body.bind(bindings);
    const auto run = [&](const gpu::ComputePipelinePtr& kernel, std::uint32_t threads) {
        gpu::PassDesc pass;
        pass.name = "hair out of the body";
        list.beginPass(pass);
        list.setPipeline(kernel);
        list.bind(bindings);
        list.setConstants(0, gpu::bytesOf(shaders::PushConstants{hairs_, points_, 0, 0}));
        body.setConstants(list);
        const std::uint32_t groups = (threads + HAIRLOOM_PUSH_GROUP - 1) / HAIRLOOM_PUSH_GROUP;
        list.dispatch(std::min(groups, kMaxGroups), (groups + kMaxGroups - 1) / kMaxGroups);
        list.endPass();
    };
    bindings.push_back(Binding::read(3, hairOfPoint_));
    run(pointsOut_, points_);
    run(look_, points_);
    bindings.pop_back();
    run(curvesOut_, hairs_);
}

}  // namespace hairloom::gpu_simulation
