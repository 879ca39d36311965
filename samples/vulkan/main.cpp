// SPDX-License-Identifier: MIT
// Plays a runtime asset with Vulkan 1.3: the CPU steps guides, or with --gpu a kernel does. The kernels of
// share/hairloom-runtime/shaders make all hairs of them and draw them as ribbons, and nothing is read back
// but the last image, which is written as PPM.
//   vulkan_hair ASSET SHADERS [-o IMAGE] [--frames N] [--gpu] [--shade] [--share S] [--compare] [--check]
// --frames 0 draws the hair at rest. --shade draws it as its material says, with shadows of hair on hair.
// --share makes and draws that share of the hairs, above 0 to 1, as a character far off has them.
// --compare reads the hairs of each frame back and says how far they are from hl_instance_read_hairs();
// --check fails where that is more than docs/gpu-simulation.md says.

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>

#include "device.h"

namespace {

/// A row of HL_GPU_BINDINGS.
struct Row {
    std::uint32_t pass, binding, buffer;
    bool constants;
};
#define ROW(pass, kind, number, buffer) \
    {HL_GPU_PASS_##pass, HL_GPU_VULKAN_##kind + number, HL_GPU_BUFFER_##buffer, #kind[0] == 'B'},
constexpr Row kRows[] = {HL_GPU_BINDINGS(ROW)};
#undef ROW

struct Pass {
    hl_gpu_pass_info info{};
    VkPipelineLayout layout{};
    VkPipeline pipeline{};
    VkDescriptorSet set{};
};

/// The layout of a pass, and what is bound by it.
void bindBuffers(const Gpu& gpu, const std::vector<Buffer>& buffers, std::uint32_t number, Pass& pass) {
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    for (const Row& row : kRows) {
        if (row.pass == number)
            bindings.push_back(
                {row.binding,
                 row.constants ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1,
                 VK_SHADER_STAGE_ALL, nullptr});
    }
    VkDescriptorSetLayoutCreateInfo sets{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    sets.bindingCount = static_cast<std::uint32_t>(bindings.size());
    sets.pBindings = bindings.data();
    VkDescriptorSetLayout layout;
    check(vkCreateDescriptorSetLayout(gpu.device, &sets, nullptr, &layout), "vkCreateDescriptorSetLayout");
    VkPipelineLayoutCreateInfo whole{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    whole.setLayoutCount = 1;
    whole.pSetLayouts = &layout;
    check(vkCreatePipelineLayout(gpu.device, &whole, nullptr, &pass.layout), "vkCreatePipelineLayout");
    const std::array<VkDescriptorPoolSize, 2> sizes{
        {{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 4}, {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 16}}};
    VkDescriptorPoolCreateInfo pools{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    pools.maxSets = 1;
    pools.poolSizeCount = 2;
    pools.pPoolSizes = sizes.data();
    VkDescriptorPool pool;
    check(vkCreateDescriptorPool(gpu.device, &pools, nullptr, &pool), "vkCreateDescriptorPool");
    VkDescriptorSetAllocateInfo wanted{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
    wanted.descriptorPool = pool;
    wanted.descriptorSetCount = 1;
    wanted.pSetLayouts = &layout;
    check(vkAllocateDescriptorSets(gpu.device, &wanted, &pass.set), "vkAllocateDescriptorSets");
    for (const Row& row : kRows) {
        if (row.pass != number) continue;
        const VkDescriptorBufferInfo bound{buffers[row.buffer].handle, 0, VK_WHOLE_SIZE};
        VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
        write.dstSet = pass.set;
        write.dstBinding = row.binding;
        write.descriptorCount = 1;
        write.descriptorType =
            row.constants ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
        write.pBufferInfo = &bound;
        vkUpdateDescriptorSets(gpu.device, 1, &write, 0, nullptr);
    }
}

void makePipeline(const Gpu& gpu, const std::string& shaders, Pass& pass) {
    const std::string file = shaders + "/" + pass.info.file;
    if (pass.info.kind == HL_GPU_COMPUTE) {
        VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
        info.stage = gpu.stage(file + ".comp.spv", VK_SHADER_STAGE_COMPUTE_BIT);
        info.layout = pass.layout;
        check(vkCreateComputePipelines(gpu.device, {}, 1, &info, nullptr, &pass.pipeline), file.c_str());
        return;
    }
    const std::array<VkPipelineShaderStageCreateInfo, 2> stages{
        gpu.stage(file + ".vert.spv", VK_SHADER_STAGE_VERTEX_BIT),
        gpu.stage(file + ".frag.spv", VK_SHADER_STAGE_FRAGMENT_BIT)};
    const VkPipelineVertexInputStateCreateInfo none{
        VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    VkPipelineInputAssemblyStateCreateInfo strips{
        VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
    strips.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP;
    const VkViewport view{0, 0, kWidth, kHeight, 0, 1};
    const VkRect2D all{{0, 0}, {kWidth, kHeight}};
    VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
    viewport.viewportCount = viewport.scissorCount = 1;
    viewport.pViewports = &view;
    viewport.pScissors = &all;
    VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
    raster.lineWidth = 1;
    VkPipelineMultisampleStateCreateInfo samples{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
    samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    VkPipelineDepthStencilStateCreateInfo depth{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
    depth.depthTestEnable = depth.depthWriteEnable = VK_TRUE;
    depth.depthCompareOp = VK_COMPARE_OP_LESS;
    VkPipelineColorBlendAttachmentState plain{};
    plain.colorWriteMask = 0xf;
    VkPipelineColorBlendStateCreateInfo blend{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
    blend.attachmentCount = 1;
    blend.pAttachments = &plain;
    VkPipelineRenderingCreateInfo targets{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
    targets.colorAttachmentCount = 1;
    targets.pColorAttachmentFormats = &kColour;
    targets.depthAttachmentFormat = kDepth;
    VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO};
    info.pNext = &targets;
    info.stageCount = 2;
    info.pStages = stages.data();
    info.pVertexInputState = &none;
    info.pInputAssemblyState = &strips;
    info.pViewportState = &viewport;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &samples;
    info.pDepthStencilState = &depth;
    info.pColorBlendState = &blend;
    info.layout = pass.layout;
    check(vkCreateGraphicsPipelines(gpu.device, {}, 1, &info, nullptr, &pass.pipeline), file.c_str());
}

/// One frame: the passes in their order, then the image into `pixels`. `grey`: linear, behind the hair.
void draw(const Gpu& gpu, const std::vector<Pass>& passes, const Image& colour, const Image& depth,
          const Buffer& pixels, float grey) {
    VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    check(vkBeginCommandBuffer(gpu.commands, &begin), "vkBeginCommandBuffer");
    turnInto(gpu.commands, colour.handle, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
             VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    turnInto(gpu.commands, depth.handle, VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
             VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
    VkRenderingAttachmentInfo colours{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO}, depths = colours;
    colours.imageView = colour.view;
    colours.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    colours.loadOp = depths.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    colours.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    colours.clearValue.color = {{grey, grey, grey, 1}};
    depths.imageView = depth.view;
    depths.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
    depths.clearValue.depthStencil = {1, 0};
    VkRenderingInfo targets{VK_STRUCTURE_TYPE_RENDERING_INFO};
    targets.renderArea = {{0, 0}, {kWidth, kHeight}};
    targets.layerCount = 1;
    targets.colorAttachmentCount = 1;
    targets.pColorAttachments = &colours;
    targets.pDepthAttachment = &depths;
    for (const Pass& pass : passes) {
        const bool compute = pass.info.kind == HL_GPU_COMPUTE;
        const auto point = compute ? VK_PIPELINE_BIND_POINT_COMPUTE : VK_PIPELINE_BIND_POINT_GRAPHICS;
        vkCmdBindPipeline(gpu.commands, point, pass.pipeline);
        vkCmdBindDescriptorSets(gpu.commands, point, pass.layout, 0, 1, &pass.set, 0, nullptr);
        if (compute) {
            vkCmdDispatch(gpu.commands, pass.info.groups[0], pass.info.groups[1], pass.info.groups[2]);
            barrier(gpu.commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT);
        } else {
            vkCmdBeginRendering(gpu.commands, &targets);
            vkCmdDraw(gpu.commands, pass.info.vertices, pass.info.instances, 0, 0);
            vkCmdEndRendering(gpu.commands);
        }
    }
    turnInto(gpu.commands, colour.handle, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
             VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    VkBufferImageCopy copy{};
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.imageExtent = {kWidth, kHeight, 1};
    vkCmdCopyImageToBuffer(gpu.commands, colour.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, pixels.handle,
                           1, &copy);
    barrier(gpu.commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_HOST_BIT);
    check(vkEndCommandBuffer(gpu.commands), "vkEndCommandBuffer");
    VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &gpu.commands;
    check(vkQueueSubmit(gpu.queue, 1, &submit, {}), "vkQueueSubmit");
    check(vkQueueWaitIdle(gpu.queue), "vkQueueWaitIdle");
}

}  // namespace

int main(int count, char** words) {
    const Options options = optionsOf(count, words);
    hl_error error{};
    std::size_t size = 0;
    const std::vector<Piece> bytes = readFile(options.asset, size);
    hairloom::game::Asset asset;
    hairloom::game::Instance hair;
    if (!asset.open(bytes.data(), size, &error)) fail(error.words);
    if (!hair.make(asset, HL_GUIDES | HL_LEVELS, nullptr, &error)) fail(error.words);
    if (!hair.setLevel(HL_LEVEL_FINEST, options.share, &error)) fail(error.words);

    const Gpu gpu;
    std::vector<Buffer> buffers;
    std::vector<hl_gpu_buffer_info> infos(HL_GPU_BUFFER_COUNT);
    for (std::uint32_t b = 0; b < HL_GPU_BUFFER_COUNT; ++b) {
        infos[b].size = sizeof infos[b];
        check(hl_gpu_buffer(asset.get(), b, &infos[b], &error), error);
        buffers.push_back(gpu.buffer(
            infos[b].bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT));
        if (infos[b].fill == HL_GPU_ONCE)
            check(hl_gpu_fill(asset.get(), b, buffers[b].mapped, buffers[b].bytes, &error), error);
    }
    std::vector<Pass> passes;
    for (std::uint32_t p = 0; p < HL_GPU_PASS_COUNT; ++p) {
        if (!runs(p, options)) continue;
        Pass& pass = passes.emplace_back();
        pass.info.size = sizeof pass.info;
        check(hl_gpu_frame_pass(hair.get(), p, &pass.info, &error), error);
        bindBuffers(gpu, buffers, p, pass);
        makePipeline(gpu, options.shaders, pass);
    }
    hl_gpu_view view;
    hl_gpu_lamp lamp;
    check(hl_gpu_view_init(asset.get(), &view, &error), error);
    check(hl_gpu_frame_view(hair.get(), &view, &error), error);
    look(asset.describe(), -1, view, lamp);
    std::memcpy(buffers[HL_GPU_BUFFER_VIEW].mapped, &view, sizeof view);
    std::memcpy(buffers[HL_GPU_BUFFER_LAMP].mapped, &lamp, sizeof lamp);

    const auto fill = [&](std::uint32_t kind) {
        for (std::uint32_t b = 0; b < HL_GPU_BUFFER_COUNT; ++b) {
            if (infos[b].fill == kind)
                check(hl_gpu_fill_frame(hair.get(), b, buffers[b].mapped, buffers[b].bytes, &error), error);
        }
    };
    if (options.onGpu) {
        check(hl_gpu_begin(hair.get(), &error), error);
        fill(HL_GPU_BEGIN);
        fill(HL_GPU_GUIDES);
    }

    const Image colour =
        gpu.image(kColour, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                  VK_IMAGE_ASPECT_COLOR_BIT);
    const Image depth =
        gpu.image(kDepth, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, VK_IMAGE_ASPECT_DEPTH_BIT);
    const Buffer pixels = gpu.buffer(std::size_t{4} * kWidth * kHeight, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    std::optional<Comparison> comparison;
    if (options.comparing) {
        const Buffer& numbers = buffers[HL_GPU_BUFFER_NUMBERS];
        comparison.emplace(asset, options.share, static_cast<const std::uint32_t*>(numbers.mapped),
                           numbers.bytes / sizeof(std::uint32_t), view.hairs);
    }
    for (int f = std::min(1, options.frames); f <= options.frames; ++f) {
        const Turning turning(f);
        check(options.onGpu ? hl_gpu_step(hair.get(), &turning.frame, &error)
                            : hl_instance_step(hair.get(), &turning.frame, &error),
              error);
        fill(HL_GPU_FRAME);
        fill(options.onGpu ? HL_GPU_STEP : HL_GPU_GUIDES);
        draw(gpu, passes, colour, depth, pixels, options.shading ? 0 : 0.5f);
        if (comparison)
            comparison->step(turning.frame, static_cast<const float*>(buffers[HL_GPU_BUFFER_POINTS].mapped));
    }
    if (options.image) writeImage(options.image, pixels.mapped, std::size_t{4} * kWidth);
    std::size_t uploaded = 0;
    for (const hl_gpu_buffer_info& info : infos) {
        if (info.fill == HL_GPU_FRAME || info.fill == (options.onGpu ? HL_GPU_STEP : HL_GPU_GUIDES))
            uploaded += info.bytes;
    }
    std::printf("%u hairs, %d frames, %zu bytes uploaded in each\n", view.hairs, options.frames, uploaded);
    return comparison ? comparison->say(options) : 0;
}
