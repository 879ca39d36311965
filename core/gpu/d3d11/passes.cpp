// SPDX-License-Identifier: GPL-3.0-or-later
// Graphics and compute passes.
#include "core/gpu/d3d11/commands.h"

namespace hairloom::gpu::d3d11 {
namespace {

void setShader(ID3D11DeviceContext& context, const ShaderImpl& shader) {
    ID3D11DeviceChild* handle = shader.handle.Get();
    switch (shader.stage) {
        case ShaderStage::Vertex:
            return context.VSSetShader(static_cast<ID3D11VertexShader*>(handle), nullptr, 0);
        case ShaderStage::Hull:
            return context.HSSetShader(static_cast<ID3D11HullShader*>(handle), nullptr, 0);
        case ShaderStage::Domain:
            return context.DSSetShader(static_cast<ID3D11DomainShader*>(handle), nullptr, 0);
        case ShaderStage::Pixel:
            return context.PSSetShader(static_cast<ID3D11PixelShader*>(handle), nullptr, 0);
        case ShaderStage::Compute:
            break;
    }
    context.CSSetShader(static_cast<ID3D11ComputeShader*>(handle), nullptr, 0);
}

void setPipelineState(ID3D11DeviceContext& context, const GraphicsPipelineImpl& pipeline) {
    // A stage that this pipeline lacks must not stay from the one before.
    context.HSSetShader(nullptr, nullptr, 0);
    context.DSSetShader(nullptr, nullptr, 0);
    context.PSSetShader(nullptr, nullptr, 0);
    for (const auto& shader : pipeline.shaders) setShader(context, *shader);
    context.IASetInputLayout(pipeline.layout.Get());
    context.IASetPrimitiveTopology(pipeline.topology);
    context.RSSetState(pipeline.raster.Get());
    context.OMSetDepthStencilState(pipeline.depth.Get(), 0);
    context.OMSetBlendState(pipeline.blend.Get(), nullptr, ~0u);
}

ID3D11Buffer* handleOf(const BufferPlace& place) {
    return place.buffer ? static_cast<const BufferImpl&>(*place.buffer).handle.Get() : nullptr;
}

/// Everything that one draw needs besides its targets; what it points to is kept by the recording.
struct DrawCall {
    const GraphicsPipelineImpl* pipeline;
    std::shared_ptr<const std::vector<StageViews>> views;
    BufferPlace vertices, indices;
    D3D11_VIEWPORT viewport;
    D3D11_RECT scissor;
    DrawArguments arguments;

    void operator()(ID3D11DeviceContext& context) const {
        setPipelineState(context, *pipeline);
        setViews(context, *views);
        context.RSSetViewports(1, &viewport);
        context.RSSetScissorRects(1, &scissor);
        ID3D11Buffer* const vertexBuffer = handleOf(vertices);
        const UINT stride = pipeline->desc.vertexStride;
        const auto vertexOffset = static_cast<UINT>(vertices.offset);
        context.IASetVertexBuffers(0, 1, &vertexBuffer, &stride, &vertexOffset);
        context.IASetIndexBuffer(handleOf(indices), DXGI_FORMAT_R32_UINT, static_cast<UINT>(indices.offset));
        if (const auto* direct = std::get_if<DirectDraw>(&arguments)) {
            context.DrawInstanced(direct->vertices, direct->instances, direct->firstVertex,
                                  direct->firstInstance);
        } else if (const auto* indexed = std::get_if<IndexedDraw>(&arguments)) {
            context.DrawIndexedInstanced(indexed->indices, indexed->instances, indexed->firstIndex,
                                         indexed->vertexOffset, indexed->firstInstance);
        } else if (const auto* indirect = std::get_if<BufferPlace>(&arguments)) {
            context.DrawInstancedIndirect(handleOf(*indirect), static_cast<UINT>(indirect->offset));
        }
    }
};

}  // namespace

void CommandListImpl::recordPassBegin() {
    PassQueries queries;
    queries.name = passDesc().name;
    setTimestamp(queries.begin);
    recording_.passes.push_back(std::move(queries));
    if (passKind() != PassKind::Graphics) return;
    setTargets();
    beginStatistics(recording_.passes.back().statistics);
}

void CommandListImpl::setTargets() {
    struct Clear {
        ID3D11RenderTargetView* view;
        std::array<float, 4> colour;
    };
    std::vector<ID3D11RenderTargetView*> colour;
    std::vector<Clear> clears;
    for (const ColourTarget& target : passDesc().colour) {
        colour.push_back(static_cast<TextureImpl&>(*target.texture).targetView.Get());
        if (target.load == LoadOp::Clear) clears.push_back({colour.back(), target.clear});
    }
    const DepthTarget& depth = passDesc().depth;
    ID3D11DepthStencilView* const view =
        depth.texture ? static_cast<TextureImpl&>(*depth.texture).depthView.Get() : nullptr;
    const bool clearDepth = view != nullptr && depth.load == LoadOp::Clear;
    step([colour, clears, view, clearDepth, value = depth.clear](ID3D11DeviceContext& context) {
        for (const Clear& clear : clears) context.ClearRenderTargetView(clear.view, clear.colour.data());
        if (clearDepth) context.ClearDepthStencilView(view, D3D11_CLEAR_DEPTH, value, 0);
        context.OMSetRenderTargets(static_cast<UINT>(colour.size()), colour.data(), view);
    });
}

void CommandListImpl::recordPassEnd() {
    if (ID3D11Query* const statistics = recording_.passes.back().statistics.Get())
        step([statistics](ID3D11DeviceContext& context) { context.End(statistics); });
    step([](ID3D11DeviceContext& context) { context.ClearState(); });
    for (const ColourTarget& target : passDesc().colour) {
        if (target.resolve == nullptr) continue;
        step([from = static_cast<TextureImpl&>(*target.texture).handle.Get(),
              to = static_cast<TextureImpl&>(*target.resolve).handle.Get(),
              format = toDxgi(target.resolve->desc().format)](ID3D11DeviceContext& context) {
            context.ResolveSubresource(to, 0, from, 0, format);
        });
    }
    setTimestamp(recording_.passes.back().end);
}

void CommandListImpl::recordDraw(const DrawArguments& arguments) {
    const auto& pipeline = static_cast<const GraphicsPipelineImpl&>(graphics());
    if (!collectViews(pipeline.shaders)) return;
    const Viewport& v = viewport();
    const ScissorRect& s = scissor();
    const D3D11_RECT rectangle{static_cast<LONG>(s.x), static_cast<LONG>(s.y),
                               static_cast<LONG>(s.x + s.width), static_cast<LONG>(s.y + s.height)};
    step(DrawCall{&pipeline,
                  views_,
                  vertices(),
                  indices(),
                  {v.x, v.y, v.width, v.height, v.minDepth, v.maxDepth},
                  rectangle,
                  arguments});
}

void CommandListImpl::recordDispatch(const DispatchArguments& arguments) {
    const auto& pipeline = static_cast<const ComputePipelineImpl&>(compute());
    if (!collectViews({&pipeline.shader, 1})) return;
    step([shader = pipeline.shader.get(), views = views_, arguments](ID3D11DeviceContext& context) {
        setShader(context, *shader);
        setViews(context, *views);
        if (const auto* groups = std::get_if<GroupCounts>(&arguments)) {
            context.Dispatch(groups->x, groups->y, groups->z);
        } else if (const auto* indirect = std::get_if<BufferPlace>(&arguments)) {
            context.DispatchIndirect(handleOf(*indirect), static_cast<UINT>(indirect->offset));
        }
        clearViews(context, *views);
    });
}

}  // namespace hairloom::gpu::d3d11
