// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gpu_simulation/device_body.h"

#include <algorithm>

#include "core/gpu_simulation/strand_batch.h"

namespace hairloom::gpu_simulation {
namespace {

using runtime::BonePose;
using runtime::Float3;

bool isFinitePose(const BonePose& bone) {
    return isFinite(bone.x) && isFinite(bone.y) && isFinite(bone.z) && isFinite(bone.origin);
}

}  // namespace

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
    std::span<const BonePose> to = input.body_ws;
    const bool fits = !to.empty() && (to.size() == 1 || to.size() == field_->bones.size()) &&
                      std::ranges::all_of(to, isFinitePose);
    if (!fits) to = pose_;
    if (to.empty()) return false;
    std::span<const BonePose> from = pose_.size() == to.size() ? std::span<const BonePose>(pose_) : to;
    bool moves = false;
    for (std::size_t b = 0; b < to.size(); ++b) {
        // A cut carries it along.
        if (length(to[b].origin - from[b].origin) > teleportDistance) from = to;
        moves = moves || !(to[b] == from[b]);
    }
    moving_.take(*field_, *cpuTable_, from, to, carriers_, substeps);
    runtime::putBodyPoses(moving_, substeps, constants_, rows_);
    if (to.data() != pose_.data()) pose_.assign(to.begin(), to.end());
    return moves;
}

void DeviceBody::moveOrigin(Float3 shift) {
    for (BonePose& bone : pose_) bone.origin = bone.origin + shift;
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
