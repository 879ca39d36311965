// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstring>

#include "core/gpu/d3d11/resources.h"

namespace hairloom::gpu::d3d11 {
namespace {

bool isShaderBuffer(const BufferDesc& desc) {
    return has(desc.usage, Usage::ShaderRead | Usage::UnorderedAccess);
}

bool isStructured(const BufferDesc& desc) {
    return isShaderBuffer(desc) && desc.typedFormat == Format::Unknown && desc.elementBytes > 0;
}

bool isRaw(const BufferDesc& desc) {
    return isShaderBuffer(desc) && desc.typedFormat == Format::Unknown && desc.elementBytes == 0;
}

UINT bindFlags(const BufferDesc& desc) {
    UINT flags = 0;
    if (has(desc.usage, Usage::Constant)) flags |= D3D11_BIND_CONSTANT_BUFFER;
    if (has(desc.usage, Usage::ShaderRead)) flags |= D3D11_BIND_SHADER_RESOURCE;
    if (has(desc.usage, Usage::UnorderedAccess)) flags |= D3D11_BIND_UNORDERED_ACCESS;
    if (has(desc.usage, Usage::Vertex)) flags |= D3D11_BIND_VERTEX_BUFFER;
    if (has(desc.usage, Usage::Index)) flags |= D3D11_BIND_INDEX_BUFFER;
    // Direct3D knows no default buffer that is bound as nothing.
    return flags == 0 ? UINT{D3D11_BIND_SHADER_RESOURCE} : flags;
}

D3D11_BUFFER_DESC toD3d11(const BufferDesc& desc) {
    D3D11_BUFFER_DESC result{};
    // Constant buffers come in steps of 16 bytes; raw views see words.
    const std::uint64_t step = has(desc.usage, Usage::Constant) ? 16 : 4;
    result.ByteWidth = static_cast<UINT>((desc.size + step - 1) / step * step);
    if (desc.memory == MemoryKind::ReadBack) {
        result.Usage = D3D11_USAGE_STAGING;
        result.CPUAccessFlags = D3D11_CPU_ACCESS_READ | D3D11_CPU_ACCESS_WRITE;
        return result;
    }
    result.Usage = D3D11_USAGE_DEFAULT;
    result.BindFlags = bindFlags(desc);
    if (has(desc.usage, Usage::Indirect)) result.MiscFlags |= D3D11_RESOURCE_MISC_DRAWINDIRECT_ARGS;
    if (isRaw(desc)) result.MiscFlags |= D3D11_RESOURCE_MISC_BUFFER_ALLOW_RAW_VIEWS;
    if (isStructured(desc)) {
        result.MiscFlags |= D3D11_RESOURCE_MISC_BUFFER_STRUCTURED;
        result.StructureByteStride = desc.elementBytes;
    }
    return result;
}

}  // namespace

Result<std::shared_ptr<BufferImpl>> BufferImpl::create(const ContextPtr& context, const BufferDesc& desc,
                                                       std::span<const std::byte> content) {
    const std::string what = "creating buffer '" + desc.name + "' of " + std::to_string(desc.size) + " bytes";
    if (desc.size > (std::uint64_t{1} << 31u)) return fail(what + ": more than 2 GiB");
    std::shared_ptr<BufferImpl> result(new BufferImpl(context, desc));
    const D3D11_BUFFER_DESC info = toD3d11(desc);
    std::vector<std::byte> padded;
    if (!content.empty() && content.size() < info.ByteWidth) {
        padded.assign(content.begin(), content.end());
        padded.resize(info.ByteWidth);
        content = padded;
    }
    const D3D11_SUBRESOURCE_DATA data{content.data(), 0, 0};
    const HRESULT r =
        context->device->CreateBuffer(&info, content.empty() ? nullptr : &data, &result->handle);
    if (FAILED(r)) return context->failed(r, what);
    return result;
}

DXGI_FORMAT BufferImpl::viewFormat() const {
    if (desc().typedFormat != Format::Unknown) return toDxgi(desc().typedFormat);
    return isRaw(desc()) ? DXGI_FORMAT_R32_TYPELESS : DXGI_FORMAT_UNKNOWN;
}

Result<BufferImpl::Part> BufferImpl::part(std::uint64_t offset, std::uint64_t size) const {
    const std::uint64_t element = desc().typedFormat != Format::Unknown ? bytesPerTexel(desc().typedFormat)
                                  : isStructured(desc())                ? desc().elementBytes
                                                                        : 4;
    if (offset % element != 0) {
        return fail("a part of buffer '" + desc().name + "' begins inside an element of " +
                    std::to_string(element) + " bytes");
    }
    const std::uint64_t bytes = size == 0 ? desc().size - offset : size;
    return Part{static_cast<UINT>(offset / element), static_cast<UINT>(bytes / element)};
}

Result<ID3D11ShaderResourceView*> BufferImpl::readView(std::uint64_t offset, std::uint64_t size) {
    ComPtr<ID3D11ShaderResourceView>& view = readViews_[{offset, size}];
    if (view) return view.Get();
    const auto elements = part(offset, size);
    if (!elements) return tl::unexpected(elements.error());
    D3D11_SHADER_RESOURCE_VIEW_DESC info{};
    info.Format = viewFormat();
    info.ViewDimension = D3D11_SRV_DIMENSION_BUFFEREX;
    info.BufferEx = {elements->first, elements->count,
                     isRaw(desc()) ? UINT{D3D11_BUFFEREX_SRV_FLAG_RAW} : 0u};
    const HRESULT r = context_->device->CreateShaderResourceView(handle.Get(), &info, &view);
    if (FAILED(r)) return context_->failed(r, "reading buffer '" + desc().name + "' in a shader");
    return view.Get();
}

Result<ID3D11UnorderedAccessView*> BufferImpl::writeView(std::uint64_t offset, std::uint64_t size) {
    ComPtr<ID3D11UnorderedAccessView>& view = writeViews_[{offset, size}];
    if (view) return view.Get();
    const auto elements = part(offset, size);
    if (!elements) return tl::unexpected(elements.error());
    D3D11_UNORDERED_ACCESS_VIEW_DESC info{};
    info.Format = viewFormat();
    info.ViewDimension = D3D11_UAV_DIMENSION_BUFFER;
    info.Buffer = {elements->first, elements->count, isRaw(desc()) ? UINT{D3D11_BUFFER_UAV_FLAG_RAW} : 0u};
    const HRESULT r = context_->device->CreateUnorderedAccessView(handle.Get(), &info, &view);
    if (FAILED(r)) return context_->failed(r, "writing buffer '" + desc().name + "' in a shader");
    return view.Get();
}

}  // namespace hairloom::gpu::d3d11
