// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstring>

#include "core/gpu/checks.h"
#include "core/gpu/vulkan/resources.h"

namespace hairloom::gpu::vulkan {
namespace {

VkShaderStageFlagBits toVulkan(ShaderStage stage) {
    switch (stage) {
        case ShaderStage::Vertex:
            return VK_SHADER_STAGE_VERTEX_BIT;
        case ShaderStage::Hull:
            return VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT;
        case ShaderStage::Domain:
            return VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT;
        case ShaderStage::Pixel:
            return VK_SHADER_STAGE_FRAGMENT_BIT;
        case ShaderStage::Compute:
            break;
    }
    return VK_SHADER_STAGE_COMPUTE_BIT;
}

VkPrimitiveTopology toVulkan(Topology topology) {
    switch (topology) {
        case Topology::TriangleList:
            return VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
        case Topology::TriangleStrip:
            return VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP;
        case Topology::LineList:
            return VK_PRIMITIVE_TOPOLOGY_LINE_LIST;
        case Topology::LineStrip:
            return VK_PRIMITIVE_TOPOLOGY_LINE_STRIP;
        case Topology::PointList:
            return VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
        case Topology::PatchList:
            break;
    }
    return VK_PRIMITIVE_TOPOLOGY_PATCH_LIST;
}

VkBlendFactor toVulkan(BlendFactor factor) {
    switch (factor) {
        case BlendFactor::Zero:
            return VK_BLEND_FACTOR_ZERO;
        case BlendFactor::One:
            return VK_BLEND_FACTOR_ONE;
        case BlendFactor::SourceColour:
            return VK_BLEND_FACTOR_SRC_COLOR;
        case BlendFactor::OneMinusSourceColour:
            return VK_BLEND_FACTOR_ONE_MINUS_SRC_COLOR;
        case BlendFactor::SourceAlpha:
            return VK_BLEND_FACTOR_SRC_ALPHA;
        case BlendFactor::OneMinusSourceAlpha:
            return VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
        case BlendFactor::TargetColour:
            return VK_BLEND_FACTOR_DST_COLOR;
        case BlendFactor::TargetAlpha:
            return VK_BLEND_FACTOR_DST_ALPHA;
        case BlendFactor::OneMinusTargetAlpha:
            break;
    }
    return VK_BLEND_FACTOR_ONE_MINUS_DST_ALPHA;
}

VkBlendOp toVulkan(BlendOp op) {
    switch (op) {
        case BlendOp::Add:
            return VK_BLEND_OP_ADD;
        case BlendOp::Subtract:
            return VK_BLEND_OP_SUBTRACT;
        case BlendOp::Min:
            return VK_BLEND_OP_MIN;
        case BlendOp::Max:
            break;
    }
    return VK_BLEND_OP_MAX;
}

// Compare lists its values in Vulkan's order.
VkCompareOp toVulkan(Compare compare) {
    return static_cast<VkCompareOp>(compare);
}

RegisterShape shapeOf(VkDescriptorType type) {
    switch (type) {
        case VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER:
            return RegisterShape::Constants;
        case VK_DESCRIPTOR_TYPE_SAMPLER:
            return RegisterShape::Sampler;
        case VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE:
        case VK_DESCRIPTOR_TYPE_STORAGE_IMAGE:
            return RegisterShape::Texture;
        case VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER:
        case VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER:
            return RegisterShape::TypedBuffer;
        default:
            return RegisterShape::Buffer;
    }
}

VkPipelineShaderStageCreateInfo stageInfo(const ShaderImpl& shader) {
    auto info = make<VkPipelineShaderStageCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO);
    info.stage = toVulkan(shader.stage);
    info.module = shader.handle;
    info.pName = "main";
    return info;
}

VkPipelineColorBlendAttachmentState blendState(const BlendDesc& blend) {
    VkPipelineColorBlendAttachmentState state{};
    state.blendEnable = blend.enabled ? VK_TRUE : VK_FALSE;
    state.srcColorBlendFactor = toVulkan(blend.source);
    state.dstColorBlendFactor = toVulkan(blend.target);
    state.colorBlendOp = toVulkan(blend.op);
    state.srcAlphaBlendFactor = toVulkan(blend.sourceAlpha);
    state.dstAlphaBlendFactor = toVulkan(blend.targetAlpha);
    state.alphaBlendOp = toVulkan(blend.opAlpha);
    state.colorWriteMask = blend.writeMask;
    return state;
}

}  // namespace

Result<std::shared_ptr<ShaderImpl>> ShaderImpl::create(const ContextPtr& context, const ShaderDesc& desc) {
    if (desc.spirv.size() % 4 != 0)
        return fail("shader '" + desc.name + "': not SPIR-V", "a multiple of 4 bytes");
    std::vector<std::uint32_t> words(desc.spirv.size() / 4);
    std::memcpy(words.data(), desc.spirv.data(), desc.spirv.size());
    std::shared_ptr<ShaderImpl> result(new ShaderImpl(context));
    result->stage = desc.stage;
    result->name = desc.name;
    auto bindings = reflect(words, toVulkan(desc.stage));
    if (!bindings) return fail("shader '" + desc.name + "': " + bindings.error().message());
    result->bindings = std::move(*bindings);
    for (const ReflectedBinding& b : result->bindings) {
        result->uses.push_back({toRegister(b.binding), shapeOf(b.type), 0});
    }
    if (context->info.type == DeviceType::Cpu) {
        words = withConstantsInStorage(words);
        for (ReflectedBinding& b : result->bindings) {
            if (b.type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER) b.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
        }
    }
    auto info = make<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO);
    info.codeSize = words.size() * sizeof(std::uint32_t);
    info.pCode = words.data();
    const VkResult r = vkCreateShaderModule(context->device, &info, nullptr, &result->handle);
    if (r != VK_SUCCESS) return context->failed(r, "creating shader '" + desc.name + "'");
    return result;
}

ShaderImpl::~ShaderImpl() {
    vkDestroyShaderModule(context_->device, handle, nullptr);
}

PipelineCore::~PipelineCore() {
    vkDestroyPipeline(context->device, handle, nullptr);
    vkDestroyPipelineLayout(context->device, layout, nullptr);
    vkDestroyDescriptorSetLayout(context->device, setLayout, nullptr);
}

Status PipelineCore::createLayout(std::span<const ShaderImpl* const> shaders) {
    for (const ShaderImpl* shader : shaders) {
        for (const ReflectedBinding& b : shader->bindings) {
            const auto same = std::ranges::find(bindings, b.binding, &ReflectedBinding::binding);
            if (same == bindings.end()) {
                bindings.push_back(b);
            } else {
                same->stages |= b.stages;
            }
        }
    }
    std::ranges::sort(bindings, {}, &ReflectedBinding::binding);
    std::vector<VkDescriptorSetLayoutBinding> entries;
    for (const ReflectedBinding& b : bindings) entries.push_back({b.binding, b.type, 1, b.stages, nullptr});
    auto set = make<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
    set.bindingCount = static_cast<std::uint32_t>(entries.size());
    set.pBindings = entries.data();
    VkResult r = vkCreateDescriptorSetLayout(context->device, &set, nullptr, &setLayout);
    if (r != VK_SUCCESS) return context->failed(r, "creating pipeline '" + name + "'");
    auto info = make<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO);
    info.setLayoutCount = 1;
    info.pSetLayouts = &setLayout;
    r = vkCreatePipelineLayout(context->device, &info, nullptr, &layout);
    if (r != VK_SUCCESS) return context->failed(r, "creating pipeline '" + name + "'");
    return {};
}

Result<ComputePipelinePtr> createPipeline(const ContextPtr& context, const ComputePipelineDesc& desc) {
    if (auto status = checkDesc(context->info, desc); !status) return tl::unexpected(status.error());
    const auto* shader = static_cast<const ShaderImpl*>(desc.shader.get());
    auto result = std::make_shared<ComputePipelineImpl>(context);
    result->core.name = desc.name;
    result->desc = desc;
    if (auto status = result->uses.add(shader->uses, desc.name); !status)
        return tl::unexpected(status.error());
    result->core.bindPoint = VK_PIPELINE_BIND_POINT_COMPUTE;
    if (auto status = result->core.createLayout({&shader, 1}); !status) return tl::unexpected(status.error());
    auto info = make<VkComputePipelineCreateInfo>(VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO);
    info.layout = result->core.layout;
    info.stage = stageInfo(*shader);
    auto wave = make<VkPipelineShaderStageRequiredSubgroupSizeCreateInfo>(
        VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_REQUIRED_SUBGROUP_SIZE_CREATE_INFO);
    wave.requiredSubgroupSize = desc.wave;
    if (desc.wave != 0) {
        info.stage.pNext = &wave;
        info.stage.flags = VK_PIPELINE_SHADER_STAGE_CREATE_REQUIRE_FULL_SUBGROUPS_BIT;
    }
    const VkResult r =
        vkCreateComputePipelines(context->device, VK_NULL_HANDLE, 1, &info, nullptr, &result->core.handle);
    if (r != VK_SUCCESS) return context->failed(r, "creating pipeline '" + desc.name + "'");
    return ComputePipelinePtr(std::move(result));
}

Result<GraphicsPipelinePtr> createPipeline(const ContextPtr& context, const GraphicsPipelineDesc& desc) {
    if (auto status = checkDesc(context->info, desc); !status) return tl::unexpected(status.error());
    auto result = std::make_shared<GraphicsPipelineImpl>(context);
    result->core.name = desc.name;
    result->desc = desc;
    std::vector<const ShaderImpl*> shaders;
    for (const ShaderPtr& shader : {desc.vertex, desc.hull, desc.domain, desc.pixel}) {
        if (shader == nullptr) continue;
        shaders.push_back(static_cast<const ShaderImpl*>(shader.get()));
        auto status = result->uses.add(shaders.back()->uses, desc.name);
        if (!status) return tl::unexpected(status.error());
    }
    if (auto status = result->core.createLayout(shaders); !status) return tl::unexpected(status.error());
    std::vector<VkPipelineShaderStageCreateInfo> stages;
    for (const ShaderImpl* shader : shaders) stages.push_back(stageInfo(*shader));

    const VkVertexInputBindingDescription stream{0, desc.vertexStride, VK_VERTEX_INPUT_RATE_VERTEX};
    std::vector<VkVertexInputAttributeDescription> attributes;
    for (const VertexAttribute& a : desc.attributes) {
        attributes.push_back({a.location, 0, vulkan::toVulkan(a.format), a.offset});
    }
    auto input =
        make<VkPipelineVertexInputStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO);
    input.vertexBindingDescriptionCount = attributes.empty() ? 0 : 1;
    input.pVertexBindingDescriptions = &stream;
    input.vertexAttributeDescriptionCount = static_cast<std::uint32_t>(attributes.size());
    input.pVertexAttributeDescriptions = attributes.data();

    auto assembly = make<VkPipelineInputAssemblyStateCreateInfo>(
        VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO);
    assembly.topology = toVulkan(desc.topology);
    const bool strip = desc.topology == Topology::TriangleStrip || desc.topology == Topology::LineStrip;
    assembly.primitiveRestartEnable = strip ? VK_TRUE : VK_FALSE;
    auto tessellation = make<VkPipelineTessellationStateCreateInfo>(
        VK_STRUCTURE_TYPE_PIPELINE_TESSELLATION_STATE_CREATE_INFO);
    tessellation.patchControlPoints = desc.patchControlPoints;
    auto viewport =
        make<VkPipelineViewportStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO);
    viewport.viewportCount = viewport.scissorCount = 1;

    auto raster = make<VkPipelineRasterizationStateCreateInfo>(
        VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO);
    raster.depthClampEnable = desc.raster.depthClip ? VK_FALSE : VK_TRUE;
    raster.polygonMode = desc.raster.fill == Fill::Solid ? VK_POLYGON_MODE_FILL : VK_POLYGON_MODE_LINE;
    raster.cullMode = desc.raster.cull == Cull::None   ? VK_CULL_MODE_NONE
                      : desc.raster.cull == Cull::Back ? VK_CULL_MODE_BACK_BIT
                                                       : VK_CULL_MODE_FRONT_BIT;
    raster.frontFace = VK_FRONT_FACE_CLOCKWISE;
    raster.depthBiasEnable =
        desc.raster.depthBias != 0 || desc.raster.slopeDepthBias != 0 ? VK_TRUE : VK_FALSE;
    raster.depthBiasConstantFactor = desc.raster.depthBias;
    raster.depthBiasSlopeFactor = desc.raster.slopeDepthBias;
    raster.lineWidth = 1;

    auto samples =
        make<VkPipelineMultisampleStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO);
    samples.rasterizationSamples = static_cast<VkSampleCountFlagBits>(desc.samples);
    auto depth = make<VkPipelineDepthStencilStateCreateInfo>(
        VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO);
    depth.depthTestEnable = desc.depth.test ? VK_TRUE : VK_FALSE;
    depth.depthWriteEnable = desc.depth.write ? VK_TRUE : VK_FALSE;
    depth.depthCompareOp = toVulkan(desc.depth.compare);
    std::vector<VkPipelineColorBlendAttachmentState> targets;
    for (const BlendDesc& blend : desc.blend) targets.push_back(blendState(blend));
    auto blend =
        make<VkPipelineColorBlendStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO);
    blend.attachmentCount = static_cast<std::uint32_t>(targets.size());
    blend.pAttachments = targets.data();
    constexpr VkDynamicState kDynamic[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    auto dynamic =
        make<VkPipelineDynamicStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO);
    dynamic.dynamicStateCount = 2;
    dynamic.pDynamicStates = kDynamic;
    std::vector<VkFormat> formats;
    for (const Format format : desc.colourFormats) formats.push_back(vulkan::toVulkan(format));
    auto rendering = make<VkPipelineRenderingCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO);
    rendering.colorAttachmentCount = static_cast<std::uint32_t>(formats.size());
    rendering.pColorAttachmentFormats = formats.data();
    rendering.depthAttachmentFormat = vulkan::toVulkan(desc.depthFormat);

    auto info = make<VkGraphicsPipelineCreateInfo>(VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO);
    info.pNext = &rendering;
    info.stageCount = static_cast<std::uint32_t>(stages.size());
    info.pStages = stages.data();
    info.pVertexInputState = &input;
    info.pInputAssemblyState = &assembly;
    info.pTessellationState = desc.hull != nullptr ? &tessellation : nullptr;
    info.pViewportState = &viewport;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &samples;
    info.pDepthStencilState = &depth;
    info.pColorBlendState = &blend;
    info.pDynamicState = &dynamic;
    info.layout = result->core.layout;
    const VkResult r =
        vkCreateGraphicsPipelines(context->device, VK_NULL_HANDLE, 1, &info, nullptr, &result->core.handle);
    if (r != VK_SUCCESS) return context->failed(r, "creating pipeline '" + desc.name + "'");
    return GraphicsPipelinePtr(std::move(result));
}

}  // namespace hairloom::gpu::vulkan
