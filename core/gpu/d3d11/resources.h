// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What stands behind the interface's objects. Each keeps the context, and with it the device, alive; Direct3D
// itself keeps what unfinished work uses.

#include <atomic>
#include <map>
#include <utility>

#include "core/gpu/checked_list.h"
#include "core/gpu/d3d11/api.h"
#include "core/gpu/d3d11/reflection.h"

namespace hairloom::gpu::d3d11 {

struct Context {
    ComPtr<ID3D11Device> device;
    ComPtr<ID3D11DeviceContext> immediate;
    ComPtr<ID3D11InfoQueue> messages;  ///< of the debug layer, where it was asked for
    DeviceInfo info;
    double timeoutSeconds = 0;
    bool countsWork = false;         ///< DeviceOptions::statistics
    std::atomic<bool> lost = false;  ///< may be noted by the thread that makes shaders

    /// Notes a lost device; every later call fails at once.
    tl::unexpected<Error> failed(HRESULT result, const std::string& what);
    Status checkAlive() const;
};
using ContextPtr = std::shared_ptr<Context>;

class BufferImpl final : public Buffer {
  public:
    /// The description has been checked.
    static Result<std::shared_ptr<BufferImpl>> create(const ContextPtr& context, const BufferDesc& desc,
                                                      std::span<const std::byte> content);

    /// Views of a part, made on first use. Errors: the part does not begin at an element.
    Result<ID3D11ShaderResourceView*> readView(std::uint64_t offset, std::uint64_t size);
    Result<ID3D11UnorderedAccessView*> writeView(std::uint64_t offset, std::uint64_t size);

    ComPtr<ID3D11Buffer> handle;

  private:
    struct Part {
        UINT first = 0, count = 0;
    };
    BufferImpl(ContextPtr context, const BufferDesc& desc) : Buffer(desc), context_(std::move(context)) {}
    DXGI_FORMAT viewFormat() const;
    Result<Part> part(std::uint64_t offset, std::uint64_t size) const;

    using PartKey = std::pair<std::uint64_t, std::uint64_t>;
    ContextPtr context_;
    std::map<PartKey, ComPtr<ID3D11ShaderResourceView>> readViews_;
    std::map<PartKey, ComPtr<ID3D11UnorderedAccessView>> writeViews_;
};

class TextureImpl final : public Texture {
  public:
    static Result<std::shared_ptr<TextureImpl>> create(const ContextPtr& context, const TextureDesc& desc,
                                                       std::span<const std::byte> content);
    /// A texture of the same size and format that the CPU can read.
    Result<ComPtr<ID3D11Texture2D>> createStaging(Context& context) const;

    ComPtr<ID3D11Texture2D> handle;
    ComPtr<ID3D11ShaderResourceView> readView;
    ComPtr<ID3D11UnorderedAccessView> writeView;
    ComPtr<ID3D11RenderTargetView> targetView;
    ComPtr<ID3D11DepthStencilView> depthView;

  private:
    explicit TextureImpl(const TextureDesc& desc) : Texture(desc) {}
    HRESULT createViews(ID3D11Device* device);
};

class SamplerImpl final : public Sampler {
  public:
    static Result<std::shared_ptr<SamplerImpl>> create(const ContextPtr& context, const SamplerDesc& desc);
    ComPtr<ID3D11SamplerState> handle;
};

class ShaderImpl final : public CheckedShader {
  public:
    static Result<std::shared_ptr<ShaderImpl>> create(const ContextPtr& context, const ShaderDesc& desc);
    ComPtr<ID3D11DeviceChild> handle;  ///< of the stage's own type
    std::vector<VertexInput> inputs;
    std::vector<std::byte> code;
};

/// The state objects of a description.
class GraphicsPipelineImpl final : public CheckedGraphicsPipeline {
  public:
    std::vector<std::shared_ptr<const ShaderImpl>> shaders;
    ComPtr<ID3D11InputLayout> layout;
    ComPtr<ID3D11RasterizerState> raster;
    ComPtr<ID3D11DepthStencilState> depth;
    ComPtr<ID3D11BlendState> blend;
    D3D11_PRIMITIVE_TOPOLOGY topology = D3D11_PRIMITIVE_TOPOLOGY_UNDEFINED;
};

class ComputePipelineImpl final : public CheckedComputePipeline {
  public:
    std::shared_ptr<const ShaderImpl> shader;
};

Result<ComputePipelinePtr> createPipeline(const ContextPtr& context, const ComputePipelineDesc& desc);
Result<GraphicsPipelinePtr> createPipeline(const ContextPtr& context, const GraphicsPipelineDesc& desc);

}  // namespace hairloom::gpu::d3d11
