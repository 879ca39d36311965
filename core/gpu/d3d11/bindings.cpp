// SPDX-License-Identifier: GPL-3.0-or-later
// From bound registers to views at the stages.
#include "core/gpu/d3d11/commands.h"

namespace hairloom::gpu::d3d11 {
namespace {

using SetConstants = void (STDMETHODCALLTYPE ID3D11DeviceContext::*)(UINT, UINT, ID3D11Buffer* const*);
using SetReads = void (STDMETHODCALLTYPE ID3D11DeviceContext::*)(UINT, UINT,
                                                                 ID3D11ShaderResourceView* const*);
using SetSamplers = void (STDMETHODCALLTYPE ID3D11DeviceContext::*)(UINT, UINT, ID3D11SamplerState* const*);

struct StageSetters {
    SetConstants constants;
    SetReads reads;
    SetSamplers samplers;
};

StageSetters settersOf(ShaderStage stage) {
    using C = ID3D11DeviceContext;
    switch (stage) {
        case ShaderStage::Vertex:
            return {&C::VSSetConstantBuffers, &C::VSSetShaderResources, &C::VSSetSamplers};
        case ShaderStage::Hull:
            return {&C::HSSetConstantBuffers, &C::HSSetShaderResources, &C::HSSetSamplers};
        case ShaderStage::Domain:
            return {&C::DSSetConstantBuffers, &C::DSSetShaderResources, &C::DSSetSamplers};
        case ShaderStage::Pixel:
            return {&C::PSSetConstantBuffers, &C::PSSetShaderResources, &C::PSSetSamplers};
        case ShaderStage::Compute:
            break;
    }
    return {&C::CSSetConstantBuffers, &C::CSSetShaderResources, &C::CSSetSamplers};
}

/// Pixel shaders share the slots of their unordered access views with the targets, which stay as they are.
void setWrites(ID3D11DeviceContext& context, const StageViews& views, bool clear) {
    for (const auto& [slot, view] : views.writes) {
        ID3D11UnorderedAccessView* const set = clear ? nullptr : view;
        if (views.stage == ShaderStage::Compute) {
            context.CSSetUnorderedAccessViews(slot, 1, &set, nullptr);
            continue;
        }
        context.OMSetRenderTargetsAndUnorderedAccessViews(D3D11_KEEP_RENDER_TARGETS_AND_DEPTH_STENCIL,
                                                          nullptr, nullptr, slot, 1, &set, nullptr);
    }
}

}  // namespace

void setViews(ID3D11DeviceContext& context, std::span<const StageViews> stages) {
    for (const StageViews& views : stages) {
        const StageSetters set = settersOf(views.stage);
        for (const auto& [slot, buffer] : views.constants) (context.*set.constants)(slot, 1, &buffer);
        for (const auto& [slot, view] : views.reads) (context.*set.reads)(slot, 1, &view);
        for (const auto& [slot, sampler] : views.samplers) (context.*set.samplers)(slot, 1, &sampler);
        setWrites(context, views, false);
    }
}

void clearViews(ID3D11DeviceContext& context, std::span<const StageViews> stages) {
    ID3D11ShaderResourceView* const none = nullptr;
    for (const StageViews& views : stages) {
        const StageSetters set = settersOf(views.stage);
        for (const auto& [slot, view] : views.reads) (context.*set.reads)(slot, 1, &none);
        setWrites(context, views, true);
    }
}

Result<Binding> CommandListImpl::stageConstants(std::uint32_t slot, std::span<const std::byte> bytes) {
    BufferDesc desc;
    desc.name = "constants";
    desc.size = bytes.size();
    desc.usage = Usage::Constant;
    auto buffer = BufferImpl::create(context_, desc, bytes);
    if (!buffer) return tl::unexpected(buffer.error());
    return Binding::constants(slot, std::move(*buffer));
}

// Feature level 11_0 binds whole constant buffers only: a part is copied into one of its own first.
Result<ID3D11Buffer*> CommandListImpl::constantBuffer(const Binding& binding) {
    auto& whole = static_cast<BufferImpl&>(*binding.buffer);
    const std::uint64_t size = binding.size == 0 ? whole.desc().size - binding.offset : binding.size;
    if (binding.offset == 0 && size == whole.desc().size) return whole.handle.Get();
    BufferDesc desc;
    desc.name = "part of " + whole.desc().name;
    desc.size = size;
    desc.usage = Usage::Constant;
    auto part = BufferImpl::create(context_, desc, {});
    if (!part) return tl::unexpected(part.error());
    keep(*part);
    ID3D11Buffer* target = (*part)->handle.Get();
    const D3D11_BOX box{static_cast<UINT>(binding.offset),        0, 0,
                        static_cast<UINT>(binding.offset + size), 1, 1};
    step([source = whole.handle.Get(), target, box](ID3D11DeviceContext& context) {
        context.CopySubresourceRegion(target, 0, 0, 0, 0, source, 0, &box);
    });
    return target;
}

bool CommandListImpl::addView(StageViews& views, const RegisterUse& use) {
    const Binding& binding = bound(use.at);
    const UINT slot = use.at.slot;
    const auto add = [&](auto& list, const auto& view) {
        if (!view) return wrong(view.error().message()), false;
        list.emplace_back(slot, *view);
        return true;
    };
    switch (use.at.kind) {
        case Binding::Kind::ConstantBuffer:
            return add(views.constants, constantBuffer(binding));
        case Binding::Kind::Sampler:
            views.samplers.emplace_back(slot, static_cast<SamplerImpl&>(*binding.sampler).handle.Get());
            return true;
        case Binding::Kind::ShaderResource:
            if (binding.texture) {
                views.reads.emplace_back(slot, static_cast<TextureImpl&>(*binding.texture).readView.Get());
                return true;
            }
            return add(views.reads,
                       static_cast<BufferImpl&>(*binding.buffer).readView(binding.offset, binding.size));
        case Binding::Kind::UnorderedAccess:
            break;
    }
    if (binding.texture) {
        views.writes.emplace_back(slot, static_cast<TextureImpl&>(*binding.texture).writeView.Get());
        return true;
    }
    return add(views.writes,
               static_cast<BufferImpl&>(*binding.buffer).writeView(binding.offset, binding.size));
}

bool CommandListImpl::collectViews(std::span<const std::shared_ptr<const ShaderImpl>> shaders) {
    if (views_) return true;
    std::vector<StageViews> stages;
    for (const auto& shader : shaders) {
        StageViews& views = stages.emplace_back();
        views.stage = shader->stage;
        for (const RegisterUse& use : shader->uses) {
            if (!addView(views, use)) return false;
        }
    }
    views_ = std::make_shared<const std::vector<StageViews>>(std::move(stages));
    return true;
}

}  // namespace hairloom::gpu::d3d11
