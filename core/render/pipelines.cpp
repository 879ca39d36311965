// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/pipelines.h"

#include <string>

#include "shaders/shaders.h"
#include "shaders/shared/render_types.h"

namespace hairloom::render {
namespace {

gpu::BlendDesc blendOf(Blend blend) {
    if (blend == Blend::weighedAndRest) return gpu::BlendDesc::additive();
    gpu::BlendDesc desc;
    if (blend == Blend::replace) return desc;
    desc.enabled = true;
    desc.source = gpu::BlendFactor::SourceAlpha;
    desc.target = gpu::BlendFactor::OneMinusSourceAlpha;
    desc.targetAlpha = gpu::BlendFactor::OneMinusSourceAlpha;
    return desc;
}

gpu::BlendDesc restBlend() {
    gpu::BlendDesc desc;
    desc.enabled = true;
    desc.source = desc.sourceAlpha = gpu::BlendFactor::Zero;
    desc.target = gpu::BlendFactor::OneMinusSourceColour;
    desc.targetAlpha = gpu::BlendFactor::OneMinusSourceAlpha;
    return desc;
}

}  // namespace

gpu::ShaderPtr Pipelines::shader(std::string_view name, gpu::ShaderStage stage) {
    if (name.empty() || !status_) return nullptr;
    const auto found = shaders_.find(name);
    if (found != shaders_.end()) return found->second;
    const shaders::Shader* code = shaders::find(name);
    if (code == nullptr) {
        status_ = fail("no shader '" + std::string(name) + "' in this program");
        return nullptr;
    }
    auto made = device_.createShader({std::string(name), stage, std::as_bytes(code->spirv), code->dxbc});
    if (!made) {
        status_ = tl::unexpected(made.error());
        return nullptr;
    }
    return shaders_.emplace(code->name, std::move(*made)).first->second;
}

gpu::ComputePipelinePtr Pipelines::compute(std::string_view name) {
    const auto found = compute_.find(name);
    if (found != compute_.end()) return found->second;
    gpu::ShaderPtr code = shader(name, gpu::ShaderStage::Compute);
    if (code == nullptr) return nullptr;
    auto made = device_.createComputePipeline({std::string(name), std::move(code)});
    if (!made) {
        status_ = tl::unexpected(made.error());
        return nullptr;
    }
    return compute_.emplace(shaders::find(name)->name, std::move(*made)).first->second;
}

gpu::GraphicsPipelinePtr Pipelines::graphics(const GraphicsNeeds& needs) {
    const auto found = graphics_.find(needs);
    if (found != graphics_.end()) return found->second;
    gpu::GraphicsPipelineDesc desc;
    desc.name = std::string(needs.vertex) + (needs.pixel.empty() ? "" : " and ") + std::string(needs.pixel);
    desc.vertex = shader(needs.vertex, gpu::ShaderStage::Vertex);
    desc.pixel = shader(needs.pixel, gpu::ShaderStage::Pixel);
    desc.hull = shader(needs.hull, gpu::ShaderStage::Hull);
    desc.domain = shader(needs.domain, gpu::ShaderStage::Domain);
    desc.topology = needs.topology;
    if (needs.topology == gpu::Topology::PatchList) desc.patchControlPoints = 1;
    desc.samples = needs.samples;
    if (needs.colour != gpu::Format::Unknown) {
        desc.colourFormats = {needs.colour};
        desc.blend = {blendOf(needs.blend)};
        if (needs.secondColour != gpu::Format::Unknown) {
            desc.colourFormats.push_back(needs.secondColour);
            desc.blend.push_back(restBlend());
        }
    }
    if (needs.depthTest || needs.depthWrite) {
        desc.depthFormat = gpu::Format::D32Float;
        desc.depth = {needs.depthTest, needs.depthWrite, gpu::Compare::LessEqual};
    }
    if (!status_) return nullptr;
    auto made = device_.createGraphicsPipeline(desc);
    if (!made) {
        status_ = tl::unexpected(made.error());
        return nullptr;
    }
    return graphics_.emplace(needs, std::move(*made)).first->second;
}

}  // namespace hairloom::render
