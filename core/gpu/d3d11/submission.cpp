// SPDX-License-Identifier: GPL-3.0-or-later
// Submitting, waiting, timestamps and reading back.
#include <chrono>
#include <cstring>

#include "core/gpu/d3d11/device.h"

namespace hairloom::gpu::d3d11 {

Status SubmissionImpl::createQuery(D3D11_QUERY kind, ComPtr<ID3D11Query>& query) {
    const D3D11_QUERY_DESC desc{kind, 0};
    const HRESULT r = context_->device->CreateQuery(&desc, &query);
    if (FAILED(r)) return context_->failed(r, "submitting work");
    return {};
}

Status SubmissionImpl::start(Recording recording) {
    ID3D11DeviceContext& context = *context_->immediate.Get();
    if (auto status = createQuery(D3D11_QUERY_EVENT, finished_); !status) return status;
    const bool timed = context_->info.timestampPeriodNs > 0 && !recording.passes.empty();
    if (timed) {
        if (auto status = createQuery(D3D11_QUERY_TIMESTAMP_DISJOINT, clock_); !status) return status;
        context.Begin(clock_.Get());
    }
    for (const Recording::Step& step : recording.steps) step(context);
    if (timed) context.End(clock_.Get());
    context.End(finished_.Get());
    context.Flush();
    passes_ = std::move(recording.passes);
    rowCopies_ = std::move(recording.rowCopies);
    // Direct3D tells of a lost device at the next call that can fail.
    const HRESULT r = context_->device->GetDeviceRemovedReason();
    if (FAILED(r)) return context_->failed(r, "submitting work");
    return {};
}

bool SubmissionImpl::isDone() {
    if (done_) return true;
    BOOL over = FALSE;
    if (context_->immediate->GetData(finished_.Get(), &over, sizeof(over), 0) != S_OK) return false;
    return finish().has_value();
}

Status SubmissionImpl::wait() {
    using Clock = std::chrono::steady_clock;
    if (done_) return {};
    const auto start = Clock::now();
    for (;;) {
        BOOL over = FALSE;
        const HRESULT r = context_->immediate->GetData(finished_.Get(), &over, sizeof(over), 0);
        if (r == S_OK) return finish();
        if (FAILED(r)) return context_->failed(r, "waiting for the GPU");
        const std::chrono::duration<double> waited = Clock::now() - start;
        if (waited.count() > context_->timeoutSeconds) {
            return fail("waiting for the GPU: it did not finish in time",
                        "expected a device that finishes its work: try another device, or the CPU");
        }
        // Most work is done within milliseconds, which is what the shortest sleep takes.
        if (waited.count() < 0.002) {
            SwitchToThread();
        } else {
            Sleep(1);
        }
    }
}

Status SubmissionImpl::moveRows(const RowCopy& copy) {
    ID3D11DeviceContext& context = *context_->immediate.Get();
    const TextureDesc& desc = copy.source->desc();
    const std::string what = "reading texture '" + desc.name + "' back";
    D3D11_MAPPED_SUBRESOURCE from{}, to{};
    HRESULT r = context.Map(copy.staging.Get(), 0, D3D11_MAP_READ, 0, &from);
    if (FAILED(r)) return context_->failed(r, what);
    r = context.Map(copy.target->handle.Get(), 0, D3D11_MAP_READ_WRITE, 0, &to);
    if (FAILED(r)) {
        context.Unmap(copy.staging.Get(), 0);
        return context_->failed(r, what);
    }
    const std::size_t rowBytes = std::size_t{desc.width} * bytesPerTexel(desc.format);
    auto* target = static_cast<std::byte*>(to.pData) + copy.offset;
    for (std::size_t y = 0; y < desc.height; ++y) {
        std::memcpy(target + y * rowBytes, static_cast<const std::byte*>(from.pData) + y * from.RowPitch,
                    rowBytes);
    }
    context.Unmap(copy.target->handle.Get(), 0);
    context.Unmap(copy.staging.Get(), 0);
    return {};
}

Status SubmissionImpl::finish() {
    for (const RowCopy& copy : rowCopies_) {
        if (auto status = moveRows(copy); !status) return status;
    }
    rowCopies_.clear();
    for (const PassQueries& pass : passes_) {
        // Both have passed: the event came after them.
        UINT64 begin = 0, end = 0;
        bool known = pass.begin && pass.end;
        for (const auto& [query, tick] :
             {std::pair(pass.begin.Get(), &begin), std::pair(pass.end.Get(), &end)}) {
            known = known && context_->immediate->GetData(query, tick, sizeof(*tick), 0) == S_OK;
        }
        const double ticks = known && end > begin ? static_cast<double>(end - begin) : 0;
        times_.push_back({pass.name, ticks * context_->info.timestampPeriodNs * 1e-6});
        D3D11_QUERY_DATA_PIPELINE_STATISTICS counts{};
        if (pass.statistics &&
            context_->immediate->GetData(pass.statistics.Get(), &counts, sizeof(counts), 0) == S_OK) {
            times_.back().counts =
                PassCounts{counts.IAVertices,    counts.VSInvocations, counts.HSInvocations,
                           counts.DSInvocations, counts.CInvocations,  counts.PSInvocations};
        }
    }
    passes_.clear();
    done_ = true;
    return {};
}

Result<std::vector<PassTime>> SubmissionImpl::passTimes() {
    if (auto status = wait(); !status) return tl::unexpected(status.error());
    return times_;
}

Status DeviceImpl::copyMapped(const Buffer& buffer, std::uint64_t offset, std::span<std::byte> target) {
    ID3D11Buffer* handle = static_cast<const BufferImpl&>(buffer).handle.Get();
    D3D11_MAPPED_SUBRESOURCE mapped{};
    const HRESULT r = context_->immediate->Map(handle, 0, D3D11_MAP_READ, 0, &mapped);
    if (FAILED(r)) return context_->failed(r, "reading buffer '" + buffer.desc().name + "' back");
    std::memcpy(target.data(), static_cast<const std::byte*>(mapped.pData) + offset, target.size());
    context_->immediate->Unmap(handle, 0);
    return {};
}

}  // namespace hairloom::gpu::d3d11
