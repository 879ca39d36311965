// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gpu/backend_device.h"

#include "core/gpu/checks.h"

namespace hairloom::gpu {

Result<BufferPtr> BackendDevice::createBuffer(const BufferDesc& desc, std::span<const std::byte> content) {
    if (auto status = checkAlive(); !status) return tl::unexpected(status.error());
    if (auto status = checkDesc(info(), desc, content.size()); !status) return tl::unexpected(status.error());
    traffic_.toDevice += content.size();
    return makeBuffer(desc, content);
}

Result<TexturePtr> BackendDevice::createTexture(const TextureDesc& desc, std::span<const std::byte> content) {
    if (auto status = checkAlive(); !status) return tl::unexpected(status.error());
    if (auto status = checkDesc(info(), desc, content.size()); !status) return tl::unexpected(status.error());
    traffic_.toDevice += content.size();
    return makeTexture(desc, content);
}

Result<std::unique_ptr<SwapChain>> BackendDevice::createSwapChain(const SwapChainDesc& desc) {
    if (auto status = checkAlive(); !status) return tl::unexpected(status.error());
    return makeSwapChain(desc);
}

Result<std::unique_ptr<CommandList>> BackendDevice::createCommandList() {
    if (auto status = checkAlive(); !status) return tl::unexpected(status.error());
    if (*listOpen_) return fail("another command list is open", "submit or destroy it first");
    while (!running_.empty() && running_.front()->isDone()) running_.pop_front();
    auto list = makeCommandList([open = listOpen_] { *open = false; });
    if (list) *listOpen_ = true;
    return list;
}

Result<SubmissionPtr> BackendDevice::submit(std::unique_ptr<CommandList> list) {
    if (auto status = checkAlive(); !status) return tl::unexpected(status.error());
    if (list == nullptr) return fail("no command list to submit");
    traffic_.toDevice += static_cast<const CheckedList&>(*list).uploadedBytes();
    return start(*list);
}

SubmissionPtr BackendDevice::keep(SubmissionPtr submission) {
    running_.push_back(submission);
    return submission;
}

void BackendDevice::waitForAll() {
    for (const auto& submission : running_) static_cast<void>(submission->wait());
}

Status BackendDevice::readMapped(const BufferPtr& buffer, std::uint64_t offset, std::span<std::byte> target) {
    if (auto status = checkReadMapped(buffer, offset, target.size()); !status) return status;
    traffic_.fromDevice += target.size();
    return copyMapped(*buffer, offset, target);
}

Status BackendDevice::runAndRead(const std::function<void(CommandList&, const BufferPtr&)>& record,
                                 std::span<std::byte> target) {
    // Only copies touch it, so the limit on what shaders see does not apply.
    const auto readBack = makeBuffer(readBackDesc(target.size()), {});
    if (!readBack) return tl::unexpected(readBack.error());
    auto list = createCommandList();
    if (!list) return tl::unexpected(list.error());
    record(**list, *readBack);
    const auto submission = submit(std::move(*list));
    if (!submission) return tl::unexpected(submission.error());
    if (auto status = (*submission)->wait(); !status) return status;
    return readMapped(*readBack, 0, target);
}

Status BackendDevice::readBuffer(const BufferPtr& buffer, std::uint64_t offset, std::span<std::byte> target) {
    if (target.empty()) return {};
    return runAndRead(
        [&](CommandList& list, const BufferPtr& readBack) {
            list.copyBuffer(buffer, offset, readBack, 0, target.size());
        },
        target);
}

Status BackendDevice::readTexture(const TexturePtr& texture, std::span<std::byte> target) {
    if (auto status = checkReadTexture(texture, target.size()); !status) return status;
    return runAndRead(
        [&](CommandList& list, const BufferPtr& readBack) { list.copyTextureToBuffer(texture, readBack, 0); },
        target);
}

}  // namespace hairloom::gpu
