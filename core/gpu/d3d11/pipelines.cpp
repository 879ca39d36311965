// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <cmath>

#include "core/gpu/checks.h"
#include "core/gpu/d3d11/resources.h"

namespace hairloom::gpu::d3d11 {
namespace {

D3D11_PRIMITIVE_TOPOLOGY toD3d11(Topology topology, std::uint32_t controlPoints) {
    switch (topology) {
        case Topology::TriangleList:
            return D3D11_PRIMITIVE_TOPOLOGY_TRIANGLELIST;
        case Topology::TriangleStrip:
            return D3D11_PRIMITIVE_TOPOLOGY_TRIANGLESTRIP;
        case Topology::LineList:
            return D3D11_PRIMITIVE_TOPOLOGY_LINELIST;
        case Topology::LineStrip:
            return D3D11_PRIMITIVE_TOPOLOGY_LINESTRIP;
        case Topology::PointList:
            return D3D11_PRIMITIVE_TOPOLOGY_POINTLIST;
        case Topology::PatchList:
            break;
    }
    return static_cast<D3D11_PRIMITIVE_TOPOLOGY>(D3D11_PRIMITIVE_TOPOLOGY_1_CONTROL_POINT_PATCHLIST +
                                                 static_cast<int>(controlPoints) - 1);
}

/// `alpha`: the factor stands for the alpha channel, where Direct3D takes no colour factors; both mean the
/// same there.
D3D11_BLEND toD3d11(BlendFactor factor, bool alpha) {
    switch (factor) {
        case BlendFactor::Zero:
            return D3D11_BLEND_ZERO;
        case BlendFactor::One:
            return D3D11_BLEND_ONE;
        case BlendFactor::SourceColour:
            return alpha ? D3D11_BLEND_SRC_ALPHA : D3D11_BLEND_SRC_COLOR;
        case BlendFactor::OneMinusSourceColour:
            return alpha ? D3D11_BLEND_INV_SRC_ALPHA : D3D11_BLEND_INV_SRC_COLOR;
        case BlendFactor::SourceAlpha:
            return D3D11_BLEND_SRC_ALPHA;
        case BlendFactor::OneMinusSourceAlpha:
            return D3D11_BLEND_INV_SRC_ALPHA;
        case BlendFactor::TargetColour:
            return alpha ? D3D11_BLEND_DEST_ALPHA : D3D11_BLEND_DEST_COLOR;
        case BlendFactor::TargetAlpha:
            return D3D11_BLEND_DEST_ALPHA;
        case BlendFactor::OneMinusTargetAlpha:
            break;
    }
    return D3D11_BLEND_INV_DEST_ALPHA;
}

D3D11_BLEND_OP toD3d11(BlendOp op) {
    switch (op) {
        case BlendOp::Add:
            return D3D11_BLEND_OP_ADD;
        case BlendOp::Subtract:
            return D3D11_BLEND_OP_SUBTRACT;
        case BlendOp::Min:
            return D3D11_BLEND_OP_MIN;
        case BlendOp::Max:
            break;
    }
    return D3D11_BLEND_OP_MAX;
}

// Compare lists its values in Direct3D's order, which begins with 1.
D3D11_COMPARISON_FUNC toD3d11(Compare compare) {
    return static_cast<D3D11_COMPARISON_FUNC>(static_cast<int>(compare) + 1);
}

HRESULT createHandle(ID3D11Device* device, ShaderStage stage, std::span<const std::byte> code,
                     ComPtr<ID3D11DeviceChild>& handle) {
    const auto create = [&]<class T>(ComPtr<T> shader, auto method) {
        const HRESULT r = (device->*method)(code.data(), code.size(), nullptr, &shader);
        handle = shader;
        return r;
    };
    switch (stage) {
        case ShaderStage::Vertex:
            return create(ComPtr<ID3D11VertexShader>(), &ID3D11Device::CreateVertexShader);
        case ShaderStage::Hull:
            return create(ComPtr<ID3D11HullShader>(), &ID3D11Device::CreateHullShader);
        case ShaderStage::Domain:
            return create(ComPtr<ID3D11DomainShader>(), &ID3D11Device::CreateDomainShader);
        case ShaderStage::Pixel:
            return create(ComPtr<ID3D11PixelShader>(), &ID3D11Device::CreatePixelShader);
        case ShaderStage::Compute:
            break;
    }
    return create(ComPtr<ID3D11ComputeShader>(), &ID3D11Device::CreateComputeShader);
}

Status createLayout(Context& context, GraphicsPipelineImpl& pipeline) {
    const GraphicsPipelineDesc& desc = pipeline.desc;
    if (desc.attributes.empty()) return {};
    const auto& shader = static_cast<const ShaderImpl&>(*desc.vertex);
    std::vector<D3D11_INPUT_ELEMENT_DESC> elements;
    for (const VertexAttribute& attribute : desc.attributes) {
        if (attribute.location >= shader.inputs.size()) {
            return fail("pipeline '" + desc.name + "': its vertex shader has no input " +
                        std::to_string(attribute.location));
        }
        const VertexInput& input = shader.inputs[attribute.location];
        elements.push_back({input.semantic.c_str(), input.semanticIndex, toDxgi(attribute.format), 0,
                            attribute.offset, D3D11_INPUT_PER_VERTEX_DATA, 0});
    }
    const HRESULT r =
        context.device->CreateInputLayout(elements.data(), static_cast<UINT>(elements.size()),
                                          shader.code.data(), shader.code.size(), &pipeline.layout);
    if (FAILED(r)) return context.failed(r, "creating pipeline '" + desc.name + "'");
    return {};
}

D3D11_RASTERIZER_DESC rasterDesc(const GraphicsPipelineDesc& desc) {
    D3D11_RASTERIZER_DESC info{};
    info.FillMode = desc.raster.fill == Fill::Solid ? D3D11_FILL_SOLID : D3D11_FILL_WIREFRAME;
    info.CullMode = desc.raster.cull == Cull::None   ? D3D11_CULL_NONE
                    : desc.raster.cull == Cull::Back ? D3D11_CULL_BACK
                                                     : D3D11_CULL_FRONT;
    info.DepthBias = static_cast<INT>(std::lround(desc.raster.depthBias));
    info.SlopeScaledDepthBias = desc.raster.slopeDepthBias;
    info.DepthClipEnable = desc.raster.depthClip ? TRUE : FALSE;
    info.ScissorEnable = TRUE;
    info.MultisampleEnable = desc.samples > 1 ? TRUE : FALSE;
    return info;
}

D3D11_DEPTH_STENCIL_DESC depthDesc(const DepthDesc& depth) {
    D3D11_DEPTH_STENCIL_DESC info{};
    info.DepthEnable = depth.test ? TRUE : FALSE;
    info.DepthWriteMask = depth.write ? D3D11_DEPTH_WRITE_MASK_ALL : D3D11_DEPTH_WRITE_MASK_ZERO;
    info.DepthFunc = toD3d11(depth.compare);
    constexpr D3D11_DEPTH_STENCILOP_DESC kKeep{D3D11_STENCIL_OP_KEEP, D3D11_STENCIL_OP_KEEP,
                                               D3D11_STENCIL_OP_KEEP, D3D11_COMPARISON_ALWAYS};
    info.FrontFace = info.BackFace = kKeep;
    return info;
}

D3D11_BLEND_DESC blendDesc(const GraphicsPipelineDesc& desc) {
    D3D11_BLEND_DESC info{};
    info.IndependentBlendEnable = TRUE;
    for (std::size_t i = 0; i < std::size(info.RenderTarget); ++i) {
        const BlendDesc blend = i < desc.blend.size() ? desc.blend[i] : BlendDesc{};
        info.RenderTarget[i] = {blend.enabled ? TRUE : FALSE,     toD3d11(blend.source, false),
                                toD3d11(blend.target, false),     toD3d11(blend.op),
                                toD3d11(blend.sourceAlpha, true), toD3d11(blend.targetAlpha, true),
                                toD3d11(blend.opAlpha),           blend.writeMask};
    }
    return info;
}

}  // namespace

Result<std::shared_ptr<ShaderImpl>> ShaderImpl::create(const ContextPtr& context, const ShaderDesc& desc) {
    auto reflection = reflect(desc.dxbc);
    if (!reflection) return fail("shader '" + desc.name + "': " + reflection.error().message());
    auto result = std::make_shared<ShaderImpl>();
    result->stage = desc.stage;
    result->name = desc.name;
    result->uses = std::move(reflection->registers);
    result->inputs = std::move(reflection->inputs);
    result->code.assign(desc.dxbc.begin(), desc.dxbc.end());
    const HRESULT r = createHandle(context->device.Get(), desc.stage, result->code, result->handle);
    if (FAILED(r)) return context->failed(r, "creating shader '" + desc.name + "'");
    return result;
}

Result<ComputePipelinePtr> createPipeline(const ContextPtr& context, const ComputePipelineDesc& desc) {
    if (auto status = checkDesc(context->info, desc); !status) return tl::unexpected(status.error());
    auto result = std::make_shared<ComputePipelineImpl>();
    result->desc = desc;
    result->shader = std::static_pointer_cast<const ShaderImpl>(desc.shader);
    if (auto status = result->uses.add(result->shader->uses, desc.name); !status)
        return tl::unexpected(status.error());
    return ComputePipelinePtr(std::move(result));
}

Result<GraphicsPipelinePtr> createPipeline(const ContextPtr& context, const GraphicsPipelineDesc& desc) {
    if (auto status = checkDesc(context->info, desc); !status) return tl::unexpected(status.error());
    auto result = std::make_shared<GraphicsPipelineImpl>();
    result->desc = desc;
    result->topology = toD3d11(desc.topology, desc.patchControlPoints);
    for (const ShaderPtr& shader : {desc.vertex, desc.hull, desc.domain, desc.pixel}) {
        if (shader == nullptr) continue;
        result->shaders.push_back(std::static_pointer_cast<const ShaderImpl>(shader));
        auto status = result->uses.add(result->shaders.back()->uses, desc.name);
        if (!status) return tl::unexpected(status.error());
    }
    if (auto status = createLayout(*context, *result); !status) return tl::unexpected(status.error());
    const D3D11_RASTERIZER_DESC raster = rasterDesc(desc);
    const D3D11_DEPTH_STENCIL_DESC depth = depthDesc(desc.depth);
    const D3D11_BLEND_DESC blend = blendDesc(desc);
    HRESULT r = context->device->CreateRasterizerState(&raster, &result->raster);
    if (SUCCEEDED(r)) r = context->device->CreateDepthStencilState(&depth, &result->depth);
    if (SUCCEEDED(r)) r = context->device->CreateBlendState(&blend, &result->blend);
    if (FAILED(r)) return context->failed(r, "creating pipeline '" + desc.name + "'");
    return GraphicsPipelinePtr(std::move(result));
}

}  // namespace hairloom::gpu::d3d11
