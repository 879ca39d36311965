// SPDX-License-Identifier: MIT
// Plays a runtime asset with Vulkan 1.3: the CPU steps guides, or with --gpu a kernel does. The kernels of
// share/hairloom-runtime/shaders make all hairs of them and draw them as ribbons, and nothing is read back
// but the last image, which is written as PPM.
//   vulkan_hair ASSET SHADERS [-o IMAGE] [--frames N] [--gpu] [--shade] [--share S] [--compare]
// --frames 0 draws the hair at rest. --shade draws it as its material says, with shadows of hair on hair.
// --share makes and draws that share of the hairs, above 0 to 1, as a character far off has them.
// --compare reads the hairs of each frame back and says how far they are from hl_instance_read_hairs().

#include <hairloom/gpu.h>
#include <hairloom/hairloom.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "device.h"

namespace {

void check(hl_code code, const hl_error& error) {
    if (code != HL_OK) fail(error.words);
}

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

/// Looks at the hair from the front; Vulkan's clip space has y downwards and depth from 0. A lamp shines from
/// where that of `view` does.
void look(const hl_asset_info& asset, hl_gpu_view& view, hl_gpu_lamp& lamp) {
    std::array<float, 3> centre{};
    float size = 0, squares = 0;
    for (std::size_t c = 0; c < 3; ++c) {
        centre[c] = 0.5f * (asset.bounds_min[c] + asset.bounds_max[c]);
        const float side = asset.bounds_max[c] - asset.bounds_min[c];
        size = std::max(size, side);
        squares += side * side;
    }
    const float away = 2 * size, f = 2.2f, nearest = 0.05f, farthest = 2 * away + 1;
    const float z = farthest / (nearest - farthest);
    const std::array<float, 3> eye{centre[0], centre[1], centre[2] + away};
    const float matrix[16] = {
        f, 0, 0, 0, 0, -f, 0, 0, 0, 0, z, -1, -f * eye[0], f * eye[1], z * nearest - z * eye[2], eye[2]};
    std::copy_n(matrix, 16, view.clip_from_world);
    std::copy_n(eye.begin(), 3, view.eye);
    view.pixel_size = 2 / (f * kHeight);
    hl_error error{};
    check(hl_gpu_lamp_init(view.to_light, centre.data(), 0.55f * std::sqrt(squares), &lamp, &error), error);
    std::fill_n(lamp.light, 3, 2.0f);
    std::printf("seen from %.6f %.6f %.6f towards %.6f %.6f %.6f\n", eye[0], eye[1], eye[2], centre[0],
                centre[1], centre[2]);
}

/// Metres: how far hairs in the device's buffer lie from those of the CPU at most, and in the mean of
/// squares. `slots`: where the device has each of the CPU's hairs.
void compare(const Buffer& made, const std::vector<std::uint32_t>& slots, const std::vector<float>& expected,
             double& farthest, double& squares) {
    const auto* const at = static_cast<const float*>(made.mapped);
    double sum = 0;
    const std::size_t points = expected.size() / 3, ofHair = points / slots.size();
    for (std::size_t p = 0; p < points; ++p) {
        const std::size_t there = slots[p / ofHair] * ofHair + p % ofHair;
        double squared = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            const double apart =
                static_cast<double>(at[4 * there + c]) - static_cast<double>(expected[3 * p + c]);
            squared += apart * apart;
        }
        farthest = std::max(farthest, std::sqrt(squared));
        sum += squared;
    }
    squares = std::max(squares, std::sqrt(sum / static_cast<double>(points)));
}

/// Where the device has each of the hairs that the CPU reads: it makes those first that are left longest.
std::vector<std::uint32_t> slotsOf(const hl_instance* onCpu, const Buffer& numbers, std::uint32_t hairs) {
    std::vector<std::uint32_t> read(hairs), slots(hairs), slotOf(numbers.bytes / sizeof(std::uint32_t), ~0u);
    hl_error error{};
    check(hl_instance_hair_numbers(onCpu, read.data(), read.size(), &error), error);
    const auto* const known = static_cast<const std::uint32_t*>(numbers.mapped);
    for (std::uint32_t slot = 0; slot < hairs; ++slot) slotOf[known[slot]] = slot;
    for (std::uint32_t hair = 0; hair < hairs; ++hair) {
        slots[hair] = slotOf[read[hair]];
        if (slots[hair] == ~0u) fail("the device makes other hairs than the CPU reads");
    }
    return slots;
}

void writeImage(const char* name, const Buffer& pixels) {
    std::ofstream file(name, std::ios::binary);
    file << "P6\n" << kWidth << ' ' << kHeight << "\n255\n";
    const auto* const at = static_cast<const char*>(pixels.mapped);
    for (std::size_t p = 0; p < std::size_t{kWidth} * kHeight; ++p) file.write(at + 4 * p, 3);
    if (!file.flush()) fail(std::string(name) + ": cannot be written");
}

}  // namespace

int main(int count, char** words) {
    if (count < 3)
        fail("vulkan_hair ASSET SHADERS [-o IMAGE] [--frames N] [--gpu] [--shade] [--share S] [--compare]");
    const char* image = nullptr;
    int frames = 60;
    float share = 1;
    bool comparing = false, onGpu = false, shading = false;
    for (int i = 3; i < count; ++i) {
        const std::string word = words[i];
        if (word == "--compare")
            comparing = true;
        else if (word == "--gpu")
            onGpu = true;
        else if (word == "--shade")
            shading = true;
        else if (word == "-o" && i + 1 < count)
            image = words[++i];
        else if (word == "--share" && i + 1 < count)
            share = std::strtof(words[++i], nullptr);
        else if (word == "--frames" && i + 1 < count)
            frames = std::max(0, std::atoi(words[++i]));
        else
            fail(word + ": not known");
    }

    if (onGpu && frames == 0) fail("--frames 0 is for guides on the CPU");
    hl_error error{};
    std::size_t size = 0;
    const std::vector<Piece> bytes = readFile(words[1], size);
    hairloom::game::Asset asset;
    hairloom::game::Instance hair, onCpu;
    if (!asset.open(bytes.data(), size, &error)) fail(error.words);
    if (!hair.make(asset, HL_GUIDES | HL_LEVELS, nullptr, &error)) fail(error.words);
    if (!hair.setLevel(HL_LEVEL_FINEST, share, &error)) fail(error.words);
    // There to compare with, and for nothing else.
    if (comparing && (!onCpu.make(asset, HL_HAIRS | HL_LEVELS, nullptr, &error) ||
                      !onCpu.setLevel(HL_LEVEL_FINEST, share, &error)))
        fail(error.words);

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
        if (p == HL_GPU_PASS_GUIDES && !onGpu) continue;
        if (p >= HL_GPU_PASS_RIBBONS && (p != HL_GPU_PASS_RIBBONS) != shading) continue;
        Pass& pass = passes.emplace_back();
        pass.info.size = sizeof pass.info;
        check(hl_gpu_frame_pass(hair.get(), p, &pass.info, &error), error);
        bindBuffers(gpu, buffers, p, pass);
        makePipeline(gpu, words[2], pass);
    }
    hl_gpu_view view;
    hl_gpu_lamp lamp;
    check(hl_gpu_view_init(asset.get(), &view, &error), error);
    check(hl_gpu_frame_view(hair.get(), &view, &error), error);
    look(asset.describe(), view, lamp);
    std::memcpy(buffers[HL_GPU_BUFFER_VIEW].mapped, &view, sizeof view);
    std::memcpy(buffers[HL_GPU_BUFFER_LAMP].mapped, &lamp, sizeof lamp);

    const auto fill = [&](std::uint32_t kind) {
        for (std::uint32_t b = 0; b < HL_GPU_BUFFER_COUNT; ++b) {
            if (infos[b].fill == kind)
                check(hl_gpu_fill_frame(hair.get(), b, buffers[b].mapped, buffers[b].bytes, &error), error);
        }
    };
    if (onGpu) {
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
    std::vector<float> expected;
    const std::vector<std::uint32_t> slots =
        comparing ? slotsOf(onCpu.get(), buffers[HL_GPU_BUFFER_NUMBERS], view.hairs)
                  : std::vector<std::uint32_t>();
    double farthest = 0, squares = 0;
    const float wind[3] = {2, 0, 1};
    for (int f = std::min(1, frames); f <= frames; ++f) {
        hairloom::game::Frame frame;
        const float turn = 0.3f * std::sin(0.1f * static_cast<float>(f)), c = std::cos(turn),
                    s = std::sin(turn);
        const float head[12] = {c, 0, s, 0, 0, 1, 0, 0, -s, 0, c, 0};
        frame.time = f / 60.0;
        frame.head = head;
        frame.wind = wind;
        if (f == 0) frame.dt = 0;
        check(onGpu ? hl_gpu_step(hair.get(), &frame, &error) : hl_instance_step(hair.get(), &frame, &error),
              error);
        fill(HL_GPU_FRAME);
        fill(onGpu ? HL_GPU_STEP : HL_GPU_GUIDES);
        draw(gpu, passes, colour, depth, pixels, shading ? 0 : 0.5f);
        if (!comparing) continue;
        if (!onCpu.step(frame, &error) || !onCpu.readHairs(expected, &error)) fail(error.words);
        compare(buffers[HL_GPU_BUFFER_POINTS], slots, expected, farthest, squares);
    }
    if (image) writeImage(image, pixels);
    std::size_t uploaded = 0;
    for (const hl_gpu_buffer_info& info : infos) {
        if (info.fill == HL_GPU_FRAME || info.fill == (onGpu ? HL_GPU_STEP : HL_GPU_GUIDES))
            uploaded += info.bytes;
    }
    std::printf("%u hairs, %d frames, %zu bytes uploaded in each\n", view.hairs, frames, uploaded);
    if (comparing)
        std::printf("apart from the CPU's: %.3g m at most, %.3g m root mean square\n", farthest, squares);
    return 0;
}
