// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The one interface to a GPU, shaped like Direct3D 11. createDevice() picks a backend; nothing of it shows
// here.
//
// Lifetime: everything is held by std::shared_ptr. A command list keeps what it uses alive, and so does a
// submission until the device has finished it, so a resource may be let go at any time. Resources and command
// lists may outlive the Device; they can then only be destroyed.
//
// Order: one command list is open at a time, and lists run in the order of submission. What one pass or
// dispatch writes the next one sees: barriers and layouts are the backend's business. Inside one graphics
// pass, draws must not read what the pass writes.
//
// Threads: a Device and everything made by it are used from one thread at a time, but for createShader() and
// createComputePipeline(), which may run on another.

#include <functional>
#include <optional>

#include "core/base/result.h"
#include "core/gpu/types.h"

namespace hairloom::gpu {

class Buffer {
  public:
    virtual ~Buffer() = default;
    const BufferDesc& desc() const { return desc_; }

  protected:
    explicit Buffer(BufferDesc desc) : desc_(std::move(desc)) {}

  private:
    BufferDesc desc_;
};

class Texture {
  public:
    virtual ~Texture() = default;
    const TextureDesc& desc() const { return desc_; }

  protected:
    explicit Texture(TextureDesc desc) : desc_(std::move(desc)) {}

  private:
    TextureDesc desc_;
};

class Sampler {
  public:
    virtual ~Sampler() = default;
};
class Shader {
  public:
    virtual ~Shader() = default;
};
class Pipeline {
  public:
    virtual ~Pipeline() = default;
    virtual const std::string& name() const = 0;
    /// What its shaders use, each once.
    virtual std::span<const ShaderRegister> registers() const = 0;
};
class GraphicsPipeline : public Pipeline {};
class ComputePipeline : public Pipeline {};

/// Records work. Wrong use (unbound register, copy out of range, draw outside a pass) does not return an
/// error at once: the first one is kept and Device::submit() returns it, naming the pass and the resource.
class CommandList {
  public:
    virtual ~CommandList() = default;

    /// Begins a graphics pass (with targets) or a compute pass (without). Passes do not nest. The viewport
    /// and the scissor start as the whole target; pipeline and bindings start empty.
    virtual void beginPass(const PassDesc& desc) = 0;
    virtual void endPass() = 0;

    virtual void setPipeline(const GraphicsPipelinePtr& pipeline) = 0;
    virtual void setPipeline(const ComputePipelinePtr& pipeline) = 0;
    /// Adds to or replaces what is bound; stays until the pass ends. Registers that the pipeline does not use
    /// may be bound.
    virtual void bind(std::span<const Binding> bindings) = 0;
    /// A constant buffer (register b`slot`) with this content, copied now; at most 64 KiB.
    virtual void setConstants(std::uint32_t slot, std::span<const std::byte> bytes) = 0;
    virtual void setVertexBuffer(const BufferPtr& buffer, std::uint64_t offset = 0) = 0;
    virtual void setIndexBuffer(const BufferPtr& buffer, std::uint64_t offset = 0) = 0;  ///< 32-bit indices
    virtual void setViewport(const Viewport& viewport) = 0;
    virtual void setScissor(const ScissorRect& scissor) = 0;

    virtual void draw(std::uint32_t vertices, std::uint32_t instances = 1, std::uint32_t firstVertex = 0,
                      std::uint32_t firstInstance = 0) = 0;
    virtual void drawIndexed(std::uint32_t indices, std::uint32_t instances = 1, std::uint32_t firstIndex = 0,
                             std::int32_t vertexOffset = 0, std::uint32_t firstInstance = 0) = 0;
    /// Arguments: u32 vertices, instances, first vertex, first instance, at `offset` (a multiple of 4).
    virtual void drawIndirect(const BufferPtr& arguments, std::uint64_t offset = 0) = 0;
    virtual void dispatch(std::uint32_t x, std::uint32_t y = 1, std::uint32_t z = 1) = 0;
    /// Arguments: u32 x, y, z at `offset` (a multiple of 4).
    virtual void dispatchIndirect(const BufferPtr& arguments, std::uint64_t offset = 0) = 0;

    /// Outside a pass. Offsets and sizes are multiples of 4.
    virtual void updateBuffer(const BufferPtr& target, std::uint64_t offset,
                              std::span<const std::byte> bytes) = 0;
    virtual void copyBuffer(const BufferPtr& source, std::uint64_t sourceOffset, const BufferPtr& target,
                            std::uint64_t targetOffset, std::uint64_t size) = 0;
    /// Rows are written without gaps, the uppermost first. `source` has one sample.
    virtual void copyTextureToBuffer(const TexturePtr& source, const BufferPtr& target,
                                     std::uint64_t targetOffset = 0) = 0;
};

/// Work handed to the device.
class Submission {
  public:
    virtual ~Submission() = default;
    virtual bool isDone() = 0;
    /// Errors: the device is lost, or did not finish within DeviceOptions::timeoutSeconds.
    virtual Status wait() = 0;
    /// In order of recording; waits first.
    virtual Result<std::vector<PassTime>> passTimes() = 0;
};
using SubmissionPtr = std::shared_ptr<Submission>;

/// Shows pictures in a window. What is drawn into the back buffer stays there until it is drawn over, so it
/// can also be read back. Destroy the swap chain before its window.
class SwapChain {
  public:
    virtual ~SwapChain() = default;
    /// One texture of Format::Bgra8Unorm (values are shown as sRGB) for as long as the size stays: a render
    /// target, to be drawn into by submitted lists.
    virtual const TexturePtr& backBuffer() const = 0;
    /// Makes a new back buffer with undefined content. Errors: as for textures.
    virtual Status resize(std::uint32_t width, std::uint32_t height) = 0;
    /// Shows the back buffer, unscaled from the upper left corner, as far as it and the window overlap;
    /// nothing while the window has no area. Waits while two pictures are still on their way. Errors: the
    /// device or the window is lost.
    virtual Status present() = 0;
};

/// Bytes that have crossed between program and device since the device was made: content of resources,
/// updates and constants one way, what was read the other.
struct Traffic {
    std::uint64_t toDevice = 0, fromDevice = 0;
};

class Device {
  public:
    virtual ~Device() = default;
    virtual const DeviceInfo& info() const = 0;
    virtual Traffic traffic() const = 0;

    /// Errors of all create functions: a description outside the device's limits (named), out of memory,
    /// device lost. `content` is empty or covers the whole resource; without it the content is undefined.
    virtual Result<BufferPtr> createBuffer(const BufferDesc& desc,
                                           std::span<const std::byte> content = {}) = 0;
    virtual Result<TexturePtr> createTexture(const TextureDesc& desc,
                                             std::span<const std::byte> content = {}) = 0;
    virtual Result<SamplerPtr> createSampler(const SamplerDesc& desc) = 0;
    virtual Result<ShaderPtr> createShader(const ShaderDesc& desc) = 0;
    virtual Result<GraphicsPipelinePtr> createGraphicsPipeline(const GraphicsPipelineDesc& desc) = 0;
    virtual Result<ComputePipelinePtr> createComputePipeline(const ComputePipelineDesc& desc) = 0;

    /// Errors besides: DeviceInfo::presents is false, or the device cannot draw to this window.
    virtual Result<std::unique_ptr<SwapChain>> createSwapChain(const SwapChainDesc& desc) = 0;

    /// Fails while another list is open: submit or destroy that one first.
    virtual Result<std::unique_ptr<CommandList>> createCommandList() = 0;
    virtual Result<SubmissionPtr> submit(std::unique_ptr<CommandList> list) = 0;

    /// Content of a MemoryKind::ReadBack buffer once the submission that filled it is done.
    virtual Status readMapped(const BufferPtr& buffer, std::uint64_t offset, std::span<std::byte> target) = 0;
    /// Copies, submits and waits: for tests, tools and pictures, not for every frame.
    virtual Status readBuffer(const BufferPtr& buffer, std::uint64_t offset, std::span<std::byte> target) = 0;
    virtual Status readTexture(const TexturePtr& texture, std::span<std::byte> target) = 0;

    /// What the validation layers said since the device was made; empty unless DeviceOptions::validation is
    /// set.
    virtual std::vector<std::string> validationMessages() const = 0;
};

struct DeviceOptions {
    std::optional<std::uint32_t> index;  ///< place in listDevices(); else the best one is taken
    std::string name;                    ///< part of the name, any case; empty: any
    std::optional<Backend> backend;      ///< else any; on Windows Direct3D 11 comes first
    /// With the checks of core/gpu/validation.h and those of the graphics API; with Vulkan an error where the
    /// latter are not installed, with Direct3D 11 as far as DeviceInfo::validates says.
    bool validation = false;
    /// Passes say what their stages did (PassTime::counts), as far as DeviceInfo::statistics says.
    bool statistics = false;
    double timeoutSeconds = 300;  ///< after which waiting for the device is an error
};

/// All devices of this machine, usable or not, backend after backend. Errors: no loader or no driver.
Result<std::vector<DeviceInfo>> listDevices();

/// Takes the usable device that fits the options; a GPU before a software rasteriser, then list order.
/// Errors: no loader, no driver, no fitting device, or what the chosen one lacks.
Result<std::unique_ptr<Device>> createDevice(const DeviceOptions& options = {});

/// Views of plain values as bytes, for constants and buffer content.
template <class T>
std::span<const std::byte> bytesOf(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    return std::as_bytes(std::span<const T, 1>(&value, 1));
}

}  // namespace hairloom::gpu
