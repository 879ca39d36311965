// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The parts of renderPicture(): scene on the device, pipelines, and the frame graph that both feed.

#include <map>

#include "core/render/picture.h"
#include "shaders/shared/render_types.h"

namespace hairloom::render {

/// A part of the strands that fits the device's buffers.
struct StrandBatch {
    std::uint32_t strandCount = 0;
    std::uint32_t curvePoints = 0;
    std::uint32_t indexCount = 0;
    std::size_t group = 0;  ///< of RenderScene::strands
    gpu::BufferPtr headers, points, curve, colour, indices;
};

struct MeshOnDevice {
    std::uint32_t corners = 0;
    gpu::BufferPtr positions, normals, indices, albedo;
};

struct SceneOnDevice {
    std::vector<MeshOnDevice> meshes;
    std::vector<StrandBatch> batches;
    Box3f bounds_ws;
    Box3f hairBounds_ws;
    std::uint64_t triangles = 0, strands = 0, curvePoints = 0;
};

Status checkScene(const RenderScene& scene);
Result<SceneOnDevice> uploadScene(gpu::Device& device, const RenderScene& scene, std::uint32_t subdivisions);

struct Pipelines {
    gpu::ComputePipelinePtr curve, shade;
    gpu::GraphicsPipelinePtr meshDepth, strandDepth, strandOpacity, mesh, strand, accumulate;
};
Result<Pipelines> createPipelines(gpu::Device& device, std::uint32_t samples);

struct Targets {
    gpu::TexturePtr headDepth, firstHair, opacity;  ///< shadow atlas: one square a light, side by side
    gpu::TexturePtr colour, resolved, depth, sum;
};
Result<Targets> createTargets(gpu::Device& device, const RenderOptions& options, std::uint32_t samples);

/// Everything that the passes read.
struct Frame {
    gpu::Device& device;
    const RenderScene& scene;
    const RenderOptions& options;
    std::uint32_t samples;
    SceneOnDevice data;
    Pipelines pipelines;
    Targets targets;
    std::vector<LightView> lightViews;
    shaders::ShadeConstants shade;  ///< all but the material
};

inline constexpr gpu::Format kColourFormat = gpu::Format::Rgba16Float;

void setUpLights(Frame& frame);
shaders::ShadeConstants shadeConstants(const Frame& frame, const HairMaterial& material);
/// Curves, shadow maps and shading: once for all frames.
void recordPreparation(gpu::CommandList& list, const Frame& frame);
/// One frame, moved by a part of a pixel, added to the sum.
void recordFrame(gpu::CommandList& list, const Frame& frame, std::uint32_t number);

}  // namespace hairloom::render
