// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/software/device.h"

#include "core/base/parallel.h"
#include "core/gpu/backend_device.h"
#include "core/gpu/checks.h"
#include "core/software/command_list.h"
#include "core/software/memory.h"

namespace hairloom::software {
namespace {

class HostSampler : public gpu::Sampler {};

gpu::DeviceInfo infoOfHost() {
    gpu::DeviceInfo info;
    info.name = kDeviceName;
    info.apiVersion = "none";
    info.driver = "none";
    // Neither a GPU nor a driver that imitates one: passes are chosen as for a GPU.
    info.type = gpu::DeviceType::Other;
    info.usable = true;
    info.sampleCounts = {1, 2, 4, 8};
    info.timestampPeriodNs = 1;
    info.maxBufferBytes = std::uint64_t{1} << 30u;
    info.maxTextureSize = 1u << 16u;
    info.memoryBytes = std::uint64_t{4} << 30u;
    return info;
}

/// What the kernel's source declares, used or not.
std::vector<gpu::ShaderRegister> registersOf(const KernelEntry& kernel) {
    std::vector<gpu::ShaderRegister> registers;
    const RegisterNames names = kernel.names();
    const auto add = [&](const std::vector<std::uint32_t>& slots, gpu::Binding::Kind kind) {
        for (const std::uint32_t slot : slots) registers.push_back({kind, slot});
    };
    add(names.constants, gpu::Binding::Kind::ConstantBuffer);
    add(names.read, gpu::Binding::Kind::ShaderResource);
    add(names.textures, gpu::Binding::Kind::ShaderResource);
    add(names.written, gpu::Binding::Kind::UnorderedAccess);
    return registers;
}

class HostDevice : public gpu::BackendDevice {
  public:
    explicit HostDevice(Stop stop) : info_(infoOfHost()), state_(std::move(stop)) {}

    const gpu::DeviceInfo& info() const override { return info_; }

    Result<gpu::SamplerPtr> createSampler(const gpu::SamplerDesc& desc) override {
        if (desc.filter != gpu::Filter::Linear || desc.address != gpu::AddressMode::Clamp)
            return fail("the software renderer filters linearly, held at the edges");
        return std::make_shared<HostSampler>();
    }

    Result<gpu::ShaderPtr> createShader(const gpu::ShaderDesc& desc) override {
        auto shader = std::make_shared<HostShader>();
        shader->stage = desc.stage;
        shader->name = desc.name;
        shader->kernel = findKernel(desc.name);
        return shader;
    }

    Result<gpu::GraphicsPipelinePtr> createGraphicsPipeline(const gpu::GraphicsPipelineDesc& desc) override {
        if (auto status = checkDesc(info_, desc); !status) return tl::unexpected(status.error());
        auto pipeline = std::make_shared<HostGraphicsPipeline>();
        pipeline->desc = desc;
        const auto& vertex = static_cast<const HostShader&>(*desc.vertex);
        const auto* pixel = static_cast<const HostShader*>(desc.pixel.get());
        if (vertex.name == "mesh_depth.vert" && pixel == nullptr) {
            pipeline->draw = HostDraw::meshDepth;
            using gpu::Binding;
            const gpu::RegisterUse uses[] = {
                {{Binding::Kind::ConstantBuffer, 1}, gpu::RegisterShape::Constants, 0},
                {{Binding::Kind::ShaderResource, 0}, gpu::RegisterShape::Buffer, 0},
                {{Binding::Kind::ShaderResource, 2}, gpu::RegisterShape::Buffer, 0}};
            if (auto status = pipeline->uses.add(uses, desc.name); !status)
                return tl::unexpected(status.error());
            return pipeline;
        }
        if (vertex.name == "overlay.vert" && desc.blend.size() == 1 && desc.blend.front().enabled) {
            pipeline->draw = HostDraw::marks;
            using gpu::Binding;
            const gpu::RegisterUse uses[] = {
                {{Binding::Kind::ConstantBuffer, 0}, gpu::RegisterShape::Constants, 0},
                {{Binding::Kind::ShaderResource, 0}, gpu::RegisterShape::Buffer, 0}};
            if (auto status = pipeline->uses.add(uses, desc.name); !status)
                return tl::unexpected(status.error());
            return pipeline;
        }
        if (vertex.name == "fullscreen.vert" && pixel != nullptr && pixel->kernel != nullptr) {
            pipeline->kernel = pixel->kernel;
            pipeline->declared = registersOf(*pixel->kernel);
            return pipeline;
        }
        return fail("the software renderer does not draw '" + desc.name + "'", "hair that kernels rasterise");
    }

    Result<gpu::ComputePipelinePtr> createComputePipeline(const gpu::ComputePipelineDesc& desc) override {
        if (auto status = checkDesc(info_, desc); !status) return tl::unexpected(status.error());
        const auto& shader = static_cast<const HostShader&>(*desc.shader);
        if (shader.kernel == nullptr || shader.kernel->run == nullptr)
            return fail("the software renderer does not run '" + desc.name + "'");
        auto pipeline = std::make_shared<HostComputePipeline>();
        pipeline->desc = desc;
        pipeline->kernel = shader.kernel;
        pipeline->declared = registersOf(*shader.kernel);
        return pipeline;
    }

    std::vector<std::string> validationMessages() const override { return {}; }

  protected:
    Result<gpu::BufferPtr> makeBuffer(const gpu::BufferDesc& desc,
                                      std::span<const std::byte> content) override {
        return HostBuffer::make(desc, content);
    }
    Result<gpu::TexturePtr> makeTexture(const gpu::TextureDesc& desc,
                                        std::span<const std::byte> content) override {
        return HostTexture::make(desc, content);
    }
    Result<std::unique_ptr<gpu::SwapChain>> makeSwapChain(const gpu::SwapChainDesc& /*desc*/) override {
        return fail("the software renderer has no swap chain", "images that are read back");
    }
    Result<std::unique_ptr<gpu::CommandList>> makeCommandList(std::function<void()> whenClosed) override {
        return std::make_unique<HostCommandList>(state_, std::move(whenClosed));
    }
    Result<gpu::SubmissionPtr> start(gpu::CommandList& list) override {
        return static_cast<HostCommandList&>(list).finish();
    }
    Status copyMapped(const gpu::Buffer& buffer, std::uint64_t offset, std::span<std::byte> target) override {
        const auto bytes = static_cast<const HostBuffer&>(buffer).bytes();
        std::ranges::copy(bytes.subspan(static_cast<std::size_t>(offset), target.size()), target.begin());
        return {};
    }
    Status checkAlive() const override { return {}; }

  private:
    gpu::DeviceInfo info_;
    HostState state_;
};

}  // namespace

std::unique_ptr<gpu::Device> makeDevice(Stop stop) {
    return std::make_unique<HostDevice>(std::move(stop));
}

DeviceChoice chooseDevice() {
    auto found = gpu::createDevice();
    if (found && (*found)->info().type != gpu::DeviceType::Cpu) return {std::move(*found), {}};
    const std::string lacks =
        found ? "there is no GPU, only " + (*found)->info().name : found.error().message();
    return {makeDevice(), "the software renderer draws: " + lacks};
}

bool isSoftware(const gpu::Device& device) {
    return dynamic_cast<const HostDevice*>(&device) != nullptr;
}

}  // namespace hairloom::software
