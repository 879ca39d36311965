// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gpu_simulation/device_body.h"

#include "core/gpu_simulation/strand_batch.h"
#include "runtime/engine/strand_model.h"

namespace hairloom::gpu_simulation {

bool hasBodyKernels(const gpu::DeviceInfo& info) {
    return info.backend != gpu::Backend::Direct3D11;
}

std::string bodyError(const gpu::DeviceInfo& info, const runtime::SimulationSettings& settings,
                      const runtime::BodyField* body) {
    if (body == nullptr || !runtime::modelOf(settings.strandModel).meetsBody || hasBodyKernels(info))
        return {};
    return "Direct3D 11 does not keep hair out of the skin of a body, which the CPU does. Remove the skin "
           "collider to use the GPU: spheres alone then hold the hair";
}

Result<DeviceBody> DeviceBody::make(gpu::Device& device, std::shared_ptr<const runtime::BodyField> body,
                                    const runtime::RestShape& shape) {
    if (const std::string problem = body->problem(); !problem.empty()) return fail(problem);
    DeviceBody made(device);
    made.cpuTable_ = std::make_unique<runtime::BodyTable>(*body);
    made.carriers_ = runtime::carriersOf(shape, *body);
    runtime::GpuBody words = runtime::gpuBodyOf(*body, *made.cpuTable_);
    made.constants_ = words.constants;
    auto table = makeBuffer<std::uint32_t>(device, "body", gpu::Usage::ShaderRead, words.table.size(),
                                           std::span<const std::uint32_t>(words.table));
    if (!table) return tl::unexpected(table.error());
    made.table_ = std::move(*table);
    made.field_ = std::move(body);
    return made;
}

bool DeviceBody::takeFrame(const runtime::FrameInput& input, float teleportDistance, std::uint32_t substeps) {
    const runtime::BodyWay way = runtime::bodyWay(*field_, input.body_ws, pose_, teleportDistance);
    if (way.to.empty()) return false;
    moving_.take(*field_, *cpuTable_, way.from, way.to, carriers_, substeps);
    runtime::putBodyPoses(moving_, substeps, constants_, rows_);
    if (way.to.data() != pose_.data()) pose_.assign(way.to.begin(), way.to.end());
    return way.moves;
}

void DeviceBody::moveOrigin(runtime::Float3 shift) {
    for (runtime::BonePose& bone : pose_) bone.origin = bone.origin + shift;
}

Status DeviceBody::upload(gpu::CommandList& list) {
    const std::size_t bytes = rows_.size() * sizeof(shaders::float4);
    if (poses_ == nullptr || poses_->desc().size < bytes) {
        const std::vector<shaders::float4> nothing(2 * rows_.size());
        auto made = makeBuffer<shaders::float4>(*device_, "poses of the body", gpu::Usage::ShaderRead,
                                                nothing.size(), nothing);
        if (!made) return tl::unexpected(made.error());
        poses_ = std::move(*made);
    }
    list.updateBuffer(poses_, 0, bytesOfVector(rows_));
    return {};
}

void DeviceBody::bind(std::vector<gpu::Binding>& bindings) const {
    bindings.push_back(gpu::Binding::read(13, table_));
    bindings.push_back(gpu::Binding::read(11, poses_));
}

std::size_t DeviceBody::bytes() const {
    const std::uint64_t poses = poses_ != nullptr ? poses_->desc().size : 0;
    return static_cast<std::size_t>(table_->desc().size + poses);
}

}  // namespace hairloom::gpu_simulation
