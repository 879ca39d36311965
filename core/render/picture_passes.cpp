// SPDX-License-Identifier: GPL-3.0-or-later
// Pipelines and targets.
#include <algorithm>

#include "core/render/picture_internal.h"
#include "shaders/shaders.h"

namespace hairloom::render {
namespace {

using gpu::Format;

Result<gpu::ShaderPtr> load(gpu::Device& device, const char* name, gpu::ShaderStage stage) {
    const shaders::Shader* shader = shaders::find(name);
    if (shader == nullptr) return fail(std::string("no shader '") + name + "' in this program");
    return device.createShader({name, stage, std::as_bytes(shader->spirv)});
}

Result<gpu::ComputePipelinePtr> compute(gpu::Device& device, const char* name) {
    auto shader = load(device, name, gpu::ShaderStage::Compute);
    if (!shader) return tl::unexpected(shader.error());
    return device.createComputePipeline({name, std::move(*shader)});
}

struct GraphicsNeeds {
    const char* name;
    const char* vertex;
    const char* pixel = nullptr;
    gpu::Topology topology = gpu::Topology::TriangleList;
    Format colour = Format::Unknown;
    bool depth = false;
    bool additive = false;
    std::uint32_t samples = 1;
};

Result<gpu::GraphicsPipelinePtr> graphics(gpu::Device& device, const GraphicsNeeds& needs) {
    gpu::GraphicsPipelineDesc desc;
    desc.name = needs.name;
    auto vertex = load(device, needs.vertex, gpu::ShaderStage::Vertex);
    if (!vertex) return tl::unexpected(vertex.error());
    desc.vertex = std::move(*vertex);
    if (needs.pixel != nullptr) {
        auto pixel = load(device, needs.pixel, gpu::ShaderStage::Pixel);
        if (!pixel) return tl::unexpected(pixel.error());
        desc.pixel = std::move(*pixel);
    }
    desc.topology = needs.topology;
    desc.samples = needs.samples;
    if (needs.colour != Format::Unknown) {
        desc.colourFormats = {needs.colour};
        desc.blend = {needs.additive ? gpu::BlendDesc::additive() : gpu::BlendDesc{}};
    }
    if (needs.depth) {
        desc.depthFormat = Format::D32Float;
        desc.depth = {true, true, gpu::Compare::LessEqual};
    }
    return device.createGraphicsPipeline(desc);
}

Result<gpu::TexturePtr> target(gpu::Device& device, const char* name, std::uint32_t width,
                               std::uint32_t height, Format format, std::uint32_t samples) {
    gpu::TextureDesc desc;
    desc.name = name;
    desc.width = width;
    desc.height = height;
    desc.format = format;
    desc.samples = samples;
    desc.usage = format == Format::D32Float ? gpu::Usage::DepthStencil : gpu::Usage::RenderTarget;
    if (samples == 1) desc.usage = desc.usage | gpu::Usage::ShaderRead;
    return device.createTexture(desc);
}

template <class T>
void take(T& place, Result<T> result, Status& status) {
    if (result) {
        place = std::move(*result);
    } else if (status) {
        status = tl::unexpected(result.error());
    }
}

}  // namespace

Result<Pipelines> createPipelines(gpu::Device& device, std::uint32_t samples) {
    constexpr auto kStrip = gpu::Topology::TriangleStrip;
    constexpr auto kList = gpu::Topology::TriangleList;
    Pipelines p;
    Status status;
    take(p.curve, compute(device, "curve.comp"), status);
    take(p.shade, compute(device, "shade.comp"), status);
    take(p.meshDepth,
         graphics(device, {"mesh depth", "mesh_depth.vert", nullptr, kList, Format::Unknown, true}), status);
    take(p.strandDepth,
         graphics(device, {"strand depth", "strand_depth.vert", nullptr, kStrip, Format::Unknown, true}),
         status);
    take(p.strandOpacity,
         graphics(device, {"strand opacity", "strand_opacity.vert", "opacity.frag", kStrip,
                           Format::Rgba16Unorm, false, true}),
         status);
    take(p.mesh,
         graphics(device, {"mesh", "mesh.vert", "mesh.frag", kList, kColourFormat, true, false, samples}),
         status);
    take(p.strand,
         graphics(device,
                  {"strand", "strand.vert", "strand.frag", kStrip, kColourFormat, true, false, samples}),
         status);
    take(p.accumulate,
         graphics(device, {"accumulate", "fullscreen.vert", "accumulate.frag", kList, Format::Rgba32Float,
                           false, true}),
         status);
    if (!status) return tl::unexpected(status.error());
    return p;
}

Result<Targets> createTargets(gpu::Device& device, const RenderOptions& options, std::uint32_t samples) {
    const std::uint32_t atlasHeight = options.shadowResolution;
    const std::uint32_t atlasWidth = atlasHeight * static_cast<std::uint32_t>(kMaxLights);
    Targets t;
    Status status;
    take(t.headDepth, target(device, "head depth", atlasWidth, atlasHeight, Format::D32Float, 1), status);
    take(t.firstHair, target(device, "first hair", atlasWidth, atlasHeight, Format::D32Float, 1), status);
    take(t.opacity, target(device, "opacity layers", atlasWidth, atlasHeight, Format::Rgba16Unorm, 1),
         status);
    take(t.colour, target(device, "colour", options.width, options.height, kColourFormat, samples), status);
    if (samples > 1) {
        take(t.resolved, target(device, "resolved", options.width, options.height, kColourFormat, 1), status);
    }
    take(t.depth, target(device, "depth", options.width, options.height, Format::D32Float, samples), status);
    take(t.sum, target(device, "sum", options.width, options.height, Format::Rgba32Float, 1), status);
    if (!status) return tl::unexpected(status.error());
    return t;
}

}  // namespace hairloom::render
