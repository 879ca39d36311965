// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a device does alike on every backend: a lost device refuses all, descriptions are checked, one list is
// open at a time, work under way is kept until it is done, and reading back copies, submits and waits.

#include <deque>
#include <functional>

#include "core/gpu/checked_list.h"

namespace hairloom::gpu {

class BackendDevice : public Device {
  public:
    Traffic traffic() const final { return traffic_; }
    Result<BufferPtr> createBuffer(const BufferDesc& desc, std::span<const std::byte> content) final;
    Result<TexturePtr> createTexture(const TextureDesc& desc, std::span<const std::byte> content) final;
    Result<std::unique_ptr<SwapChain>> createSwapChain(const SwapChainDesc& desc) final;
    Result<std::unique_ptr<CommandList>> createCommandList() final;
    Result<SubmissionPtr> submit(std::unique_ptr<CommandList> list) final;
    Status readMapped(const BufferPtr& buffer, std::uint64_t offset, std::span<std::byte> target) final;
    Status readBuffer(const BufferPtr& buffer, std::uint64_t offset, std::span<std::byte> target) final;
    Status readTexture(const TexturePtr& texture, std::span<std::byte> target) final;

  protected:
    /// Descriptions have been checked.
    virtual Result<BufferPtr> makeBuffer(const BufferDesc& desc, std::span<const std::byte> content) = 0;
    virtual Result<TexturePtr> makeTexture(const TextureDesc& desc, std::span<const std::byte> content) = 0;
    virtual Result<std::unique_ptr<SwapChain>> makeSwapChain(const SwapChainDesc& desc) = 0;
    /// The list calls `whenClosed` once, when it is submitted or destroyed.
    virtual Result<std::unique_ptr<CommandList>> makeCommandList(std::function<void()> whenClosed) = 0;
    /// Ends the list, which derives from CheckedList, and starts its work, which goes to keep().
    virtual Result<SubmissionPtr> start(CommandList& list) = 0;
    virtual Status copyMapped(const Buffer& buffer, std::uint64_t offset, std::span<std::byte> target) = 0;
    virtual Status checkAlive() const = 0;

    /// Work that is under way keeps what it uses.
    SubmissionPtr keep(SubmissionPtr submission);
    /// For destructors, before what the work uses goes.
    void waitForAll();

  private:
    Status runAndRead(const std::function<void(CommandList&, const BufferPtr&)>& record,
                      std::span<std::byte> target);

    std::shared_ptr<bool> listOpen_ = std::make_shared<bool>(false);
    std::deque<SubmissionPtr> running_;
    Traffic traffic_;
};

}  // namespace hairloom::gpu
