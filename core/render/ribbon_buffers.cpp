// SPDX-License-Identifier: GPL-3.0-or-later
// What ribbons of some fineness need on the device: room for their curves, indices of strips, patches.
#include <algorithm>

#include "core/render/device_buffers.h"
#include "core/render/device_scene.h"

namespace hairloom::render {
namespace {

constexpr std::uint32_t kRestart = 0xffffffffu;

Result<gpu::BufferPtr> written(gpu::Device& device, const char* name, std::uint64_t count,
                               std::uint32_t element) {
    gpu::BufferDesc desc;
    desc.name = name;
    desc.size = count * element;
    desc.elementBytes = element;
    desc.usage = gpu::Usage::ShaderRead | gpu::Usage::UnorderedAccess;
    return device.createBuffer(desc);
}

std::vector<std::uint32_t> ribbonIndices(const DrawBatch& batch, std::uint32_t subdivisions) {
    std::vector<std::uint32_t> indices;
    indices.reserve(batch.indexCount(batch.strandCount(), subdivisions));
    std::uint32_t next = 0;
    for (std::uint32_t strand = 0; strand < batch.strandCount(); ++strand) {
        const std::uint32_t segments = batch.segmentsBefore[strand + 1] - batch.segmentsBefore[strand];
        for (std::uint32_t i = 0; i < 2 * (segments * subdivisions + 1); ++i) indices.push_back(next++);
        indices.push_back(kRestart);
    }
    return indices;
}

std::vector<shaders::StrandPatch> strandPatches(DrawBatch& batch) {
    std::vector<shaders::StrandPatch> patches;
    batch.patchesBefore = {0};
    for (std::uint32_t strand = 0; strand < batch.strandCount(); ++strand) {
        const std::uint32_t segments = batch.segmentsBefore[strand + 1] - batch.segmentsBefore[strand];
        const std::uint32_t count = (segments + HAIRLOOM_PATCH_SEGMENTS - 1) / HAIRLOOM_PATCH_SEGMENTS;
        for (std::uint32_t i = 0; i < count; ++i) {
            const std::uint32_t first = i * segments / count, end = (i + 1) * segments / count;
            patches.push_back({strand, first, end - first, segments + 1});
        }
        batch.patchesBefore.push_back(static_cast<std::uint32_t>(patches.size()));
    }
    return patches;
}

}  // namespace

Status DeviceScene::prepareCurves(gpu::Device& device, std::uint32_t subdivisions, bool twice, bool sky) {
    Gather gather;
    for (DrawBatch& batch : batches) {
        const std::uint32_t count = batch.curvePoints(batch.strandCount(), subdivisions);
        if (subdivisions > batch.curveSubdivisions) {
            gather(batch.curve, written(device, "curve points", count, sizeof(shaders::CurvePoint)));
            gather(batch.colour, written(device, "curve colours", count, sizeof(shaders::float4)));
            batch.curveSubdivisions = subdivisions;
            batch.litColour = batch.across = batch.albedo = batch.past = nullptr;
            batch.pastSubdivisions = 0;
        }
        const std::uint32_t maximum = batch.curvePoints(batch.strandCount(), batch.curveSubdivisions);
        if (!twice) {
            batch.litColour = nullptr;
        } else if (batch.litColour == nullptr) {
            gather(batch.litColour,
                   written(device, "curve colours without shadows", maximum, sizeof(shaders::float4)));
        }
        if (!sky) {
            batch.seen = nullptr;
        } else if (batch.seen == nullptr) {
            const std::uint32_t given = batch.curvePoints(batch.strandCount(), 1);
            gather(batch.seen, written(device, "sky seen", given, sizeof(shaders::SkyPoint)));
        }
        gpu::BufferPtr& indices = batch.indices[subdivisions];
        if (indices != nullptr) continue;
        const auto content = ribbonIndices(batch, subdivisions);
        gpu::BufferDesc desc;
        desc.name = "ribbon indices";
        desc.size = content.size() * sizeof(std::uint32_t);
        desc.usage = gpu::Usage::Index;
        gather(indices, device.createBuffer(desc, bytes(content)));
    }
    return gather.status();
}

Result<bool> DeviceScene::prepareAcross(gpu::Device& device, bool wanted) {
    Gather gather;
    bool isNew = false;
    for (DrawBatch& batch : batches) {
        if (!wanted) batch.across = nullptr;
        if (!wanted || batch.across != nullptr) continue;
        const std::uint32_t count = batch.curvePoints(batch.strandCount(), batch.curveSubdivisions);
        gather(batch.across,
               written(device, "light across hair", HAIRLOOM_ACROSS_CELLS * count, sizeof(std::uint32_t)));
        isNew = true;
    }
    if (auto status = gather.status(); !status) return tl::unexpected(status.error());
    return isNew;
}

Status DeviceScene::prepareSurface(gpu::Device& device) {
    Gather gather;
    for (DrawBatch& batch : batches) {
        const std::uint32_t count = batch.curvePoints(batch.strandCount(), batch.curveSubdivisions);
        if (batch.albedo == nullptr)
            gather(batch.albedo, written(device, "curve albedo", count, sizeof(shaders::float4)));
        if (batch.past == nullptr)
            gather(batch.past,
                   written(device, "curve points a frame ago", count, sizeof(shaders::CurvePoint)));
    }
    for (MeshOnDevice& mesh : meshes) {
        if (mesh.past != nullptr || mesh.indices.empty()) continue;
        gather(mesh.past, written(device, "mesh positions a frame ago", 3 * mesh.vertexCount, sizeof(float)));
    }
    return gather.status();
}

Status DeviceScene::preparePatches(gpu::Device& device) {
    Gather gather;
    for (DrawBatch& batch : batches) {
        if (batch.patches != nullptr) continue;
        const auto patches = strandPatches(batch);
        gather(batch.patches,
               structured(device, "strand patches", sizeof(shaders::StrandPatch), bytes(patches)));
    }
    return gather.status();
}

}  // namespace hairloom::render
