// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gpu/d3d11/commands.h"

#include <cstring>

namespace hairloom::gpu::d3d11 {
namespace {

D3D11_BOX bytesBox(std::uint64_t offset, std::uint64_t size) {
    return {static_cast<UINT>(offset), 0, 0, static_cast<UINT>(offset + size), 1, 1};
}

BufferImpl& impl(const BufferPlace& place) {
    return static_cast<BufferImpl&>(*place.buffer);
}

}  // namespace

CommandListImpl::~CommandListImpl() {
    if (onClose_) onClose_();
}

void CommandListImpl::setTimestamp(ComPtr<ID3D11Query>& query) {
    if (context_->info.timestampPeriodNs == 0) return;
    constexpr D3D11_QUERY_DESC kTimestamp{D3D11_QUERY_TIMESTAMP, 0};
    const HRESULT r = context_->device->CreateQuery(&kTimestamp, &query);
    if (FAILED(r)) return wrong(context_->failed(r, "timing a pass").value());
    // Without the flush some drivers take the time when the work is handed over, not when it is done.
    step([handle = query.Get()](ID3D11DeviceContext& context) {
        context.End(handle);
        context.Flush();
    });
}

void CommandListImpl::beginStatistics(ComPtr<ID3D11Query>& query) {
    if (!context_->countsWork) return;
    constexpr D3D11_QUERY_DESC kStatistics{D3D11_QUERY_PIPELINE_STATISTICS, 0};
    const HRESULT r = context_->device->CreateQuery(&kStatistics, &query);
    if (FAILED(r)) return wrong(context_->failed(r, "counting what a pass does").value());
    step([handle = query.Get()](ID3D11DeviceContext& context) { context.Begin(handle); });
}

void CommandListImpl::recordUpdate(const BufferPtr& target, std::uint64_t offset,
                                   std::span<const std::byte> bytes) {
    auto& buffer = static_cast<BufferImpl&>(*target);
    if (!has(target->desc().usage, Usage::Constant)) {
        const D3D11_BOX box = bytesBox(offset, bytes.size());
        step([handle = buffer.handle.Get(), box,
              content = std::vector<std::byte>(bytes.begin(), bytes.end())](ID3D11DeviceContext& context) {
            context.UpdateSubresource(handle, 0, &box, content.data(), 0, 0);
        });
        return;
    }
    // Feature level 11_0 updates whole constant buffers only, but copies parts of them.
    BufferDesc desc;
    desc.name = "upload";
    desc.size = bytes.size();
    auto upload = BufferImpl::create(context_, desc, bytes);
    if (!upload) return wrong(upload.error());
    keep(*upload);
    recordCopy({*upload, 0}, {target, offset}, bytes.size());
}

void CommandListImpl::recordCopy(const BufferPlace& source, const BufferPlace& target, std::uint64_t size) {
    recording_.fillsReadBack |= target.buffer->desc().memory == MemoryKind::ReadBack;
    const D3D11_BOX box = bytesBox(source.offset, size);
    step([from = impl(source).handle.Get(), to = impl(target).handle.Get(),
          at = static_cast<UINT>(target.offset), box](ID3D11DeviceContext& context) {
        context.CopySubresourceRegion(to, 0, at, 0, 0, from, 0, &box);
    });
}

// Direct3D copies no texture into a buffer. The rows go through a staging texture; into a read-back buffer
// the CPU moves them when the submission is waited for, into a device buffer at once, which waits for the
// device.
void CommandListImpl::recordTextureCopy(const TexturePtr& source, const BufferPlace& target) {
    const auto texture = std::static_pointer_cast<const TextureImpl>(source);
    const auto staging = texture->createStaging(*context_);
    if (!staging) return wrong(staging.error());
    step([from = texture->handle.Get(), to = staging->Get()](ID3D11DeviceContext& context) {
        context.CopySubresourceRegion(to, 0, 0, 0, 0, from, 0, nullptr);
    });
    RowCopy copy{*staging, texture, std::static_pointer_cast<BufferImpl>(target.buffer), target.offset};
    if (target.buffer->desc().memory == MemoryKind::ReadBack) {
        recording_.fillsReadBack = true;
        recording_.rowCopies.push_back(std::move(copy));
        return;
    }
    step([copy = std::move(copy)](ID3D11DeviceContext& context) {
        const TextureDesc& desc = copy.source->desc();
        D3D11_MAPPED_SUBRESOURCE rows{};
        if (FAILED(context.Map(copy.staging.Get(), 0, D3D11_MAP_READ, 0, &rows))) return;
        const std::uint64_t rowBytes = std::uint64_t{desc.width} * bytesPerTexel(desc.format);
        for (std::uint32_t y = 0; y < desc.height; ++y) {
            const D3D11_BOX box = bytesBox(copy.offset + y * rowBytes, rowBytes);
            const auto* row = static_cast<const std::byte*>(rows.pData) + std::size_t{y} * rows.RowPitch;
            context.UpdateSubresource(copy.target->handle.Get(), 0, &box, row, 0, 0);
        }
        context.Unmap(copy.staging.Get(), 0);
    });
}

Result<Recording> CommandListImpl::finish() {
    if (auto status = checkFinished(); !status) return tl::unexpected(status.error());
    return std::move(recording_);
}

}  // namespace hairloom::gpu::d3d11
