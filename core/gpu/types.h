// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Plain descriptions of what a Device can make. Names and meanings follow Direct3D 11; nothing here belongs
// to a backend. Sizes are bytes and pixels; a field left alone has the value that is right most often.

#include <array>
#include <bit>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace hairloom::gpu {

enum class Format {
    Unknown,
    R8Unorm,
    Rgba8Unorm,
    Rgba8UnormSrgb,
    Bgra8Unorm,
    Rgba16Unorm,  ///< additive blending into it is exact
    Rgba16Float,
    R32Uint,
    R32Float,
    Rg32Float,
    Rgb32Float,  ///< vertex attributes only
    Rgba32Float,
    D32Float,  ///< depth; read in a shader as one float
};
/// Bytes of one texel; 0 for Unknown.
std::uint32_t bytesPerTexel(Format format);

enum class ShaderStage { Vertex, Hull, Domain, Pixel, Compute };

/// What a resource may be bound as; combine with |. Copying is always allowed.
enum class Usage : std::uint32_t {
    None = 0,
    Constant = 1u << 0u,         ///< cbuffer, register b#
    ShaderRead = 1u << 1u,       ///< StructuredBuffer, Buffer, Texture2D, register t#
    UnorderedAccess = 1u << 2u,  ///< RW…, register u#
    Vertex = 1u << 3u,
    Index = 1u << 4u,
    Indirect = 1u << 5u,
    RenderTarget = 1u << 6u,
    DepthStencil = 1u << 7u,
};
constexpr Usage operator|(Usage a, Usage b) {
    return static_cast<Usage>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}
constexpr bool has(Usage set, Usage flag) {
    return (static_cast<std::uint32_t>(set) & static_cast<std::uint32_t>(flag)) != 0;
}

enum class MemoryKind {
    Device,    ///< fast for the device; filled by copies
    ReadBack,  ///< the target of copies that the CPU reads (Direct3D's staging buffer)
};

struct BufferDesc {
    std::string name;        ///< stands in errors and in captures
    std::uint64_t size = 0;  ///< bytes, > 0, at most DeviceInfo::maxBufferBytes
    Usage usage = Usage::ShaderRead;
    MemoryKind memory = MemoryKind::Device;
    std::uint32_t elementBytes = 0;  ///< of one element of a structured buffer; 0 for all others
    Format typedFormat =
        Format::Unknown;  ///< set for Buffer<T>/RWBuffer<T>; left alone for structured buffers
};

struct TextureDesc {
    std::string name;
    std::uint32_t width = 1;
    std::uint32_t height = 1;
    Format format = Format::Rgba8Unorm;
    std::uint32_t samples = 1;  ///< 1, or one of DeviceInfo::sampleCounts
    Usage usage = Usage::ShaderRead;
};

enum class Filter { Point, Linear };
enum class AddressMode { Clamp, Wrap, Border };

struct SamplerDesc {
    Filter filter = Filter::Linear;
    AddressMode address = AddressMode::Clamp;
    bool borderIsWhite = false;  ///< colour outside for AddressMode::Border: white or transparent black
};

struct ShaderDesc {
    std::string name;
    ShaderStage stage = ShaderStage::Vertex;
    // The same shader in the forms that the backends take; each needs its own. Copied.
    std::span<const std::byte> spirv{};
    std::span<const std::byte> dxbc{};
};

class Buffer;
class Texture;
class Sampler;
class Shader;
class GraphicsPipeline;
class ComputePipeline;
using BufferPtr = std::shared_ptr<Buffer>;
using TexturePtr = std::shared_ptr<Texture>;
using SamplerPtr = std::shared_ptr<Sampler>;
using ShaderPtr = std::shared_ptr<Shader>;
using GraphicsPipelinePtr = std::shared_ptr<GraphicsPipeline>;
using ComputePipelinePtr = std::shared_ptr<ComputePipeline>;

/// Strips restart at index 0xffffffff, as they always do in Direct3D.
enum class Topology { TriangleList, TriangleStrip, LineList, LineStrip, PointList, PatchList };
enum class Cull { None, Front, Back };
enum class Fill { Solid, Wireframe };
enum class Compare { Never, Less, Equal, LessEqual, Greater, NotEqual, GreaterEqual, Always };
enum class BlendFactor {
    Zero,
    One,
    SourceColour,
    OneMinusSourceColour,
    SourceAlpha,
    OneMinusSourceAlpha,
    TargetColour,
    TargetAlpha,
    OneMinusTargetAlpha
};
enum class BlendOp { Add, Subtract, Min, Max };

struct BlendDesc {
    bool enabled = false;
    BlendFactor source = BlendFactor::One;
    BlendFactor target = BlendFactor::Zero;
    BlendOp op = BlendOp::Add;
    BlendFactor sourceAlpha = BlendFactor::One;
    BlendFactor targetAlpha = BlendFactor::Zero;
    BlendOp opAlpha = BlendOp::Add;
    std::uint8_t writeMask = 0xf;  ///< bits R, G, B, A

    static BlendDesc additive() {
        BlendDesc blend;
        blend.enabled = true;
        blend.target = blend.targetAlpha = BlendFactor::One;
        return blend;
    }
};

struct DepthDesc {
    bool test = false;
    bool write = false;
    Compare compare = Compare::Less;
};

struct RasterDesc {
    Cull cull = Cull::None;  ///< clockwise as seen on screen is the front, as in Direct3D
    Fill fill = Fill::Solid;
    float depthBias = 0;       ///< in units of the smallest step of the depth format
    float slopeDepthBias = 0;  ///< times the larger depth slope
    bool depthClip = true;     ///< false clamps to the depth range instead (needs DeviceInfo::depthClamp)
};

struct VertexAttribute {
    std::uint32_t location = 0;  ///< in the order in which the vertex shader declares its inputs
    Format format = Format::Rgb32Float;
    std::uint32_t offset = 0;
};

struct GraphicsPipelineDesc {
    std::string name;
    ShaderPtr vertex;
    ShaderPtr hull;  ///< both hull and domain, or neither
    ShaderPtr domain;
    ShaderPtr pixel;  ///< may be left out for depth-only passes
    Topology topology = Topology::TriangleList;
    std::uint32_t patchControlPoints = 0;  ///< 1…32 with Topology::PatchList
    std::vector<VertexAttribute> attributes;
    std::uint32_t vertexStride = 0;
    RasterDesc raster;
    DepthDesc depth;
    std::vector<BlendDesc> blend;  ///< one per colour target
    std::vector<Format> colourFormats;
    Format depthFormat = Format::Unknown;
    std::uint32_t samples = 1;
};

struct ComputePipelineDesc {
    std::string name;
    ShaderPtr shader;
    /// Not 0: a work group is made of full waves of so many threads, one of DeviceInfo::waves.
    std::uint32_t wave = 0;
};

struct Viewport {
    float x = 0, y = 0, width = 0, height = 0;  ///< pixels from the upper left corner
    float minDepth = 0, maxDepth = 1;
};
struct ScissorRect {
    std::uint32_t x = 0, y = 0, width = 0, height = 0;
};

enum class LoadOp { Clear, Load, Discard };

struct ColourTarget {
    TexturePtr texture;
    LoadOp load = LoadOp::Clear;
    std::array<float, 4> clear{0, 0, 0, 0};
    TexturePtr
        resolve;  ///< with a multisampled texture: receives the average of the samples at the end of the pass
};
struct DepthTarget {
    TexturePtr texture;
    LoadOp load = LoadOp::Clear;
    float clear = 1;
};

/// A graphics pass draws into its targets; a compute pass has none. Each has its own time.
struct PassDesc {
    std::string name;
    std::vector<ColourTarget> colour;
    DepthTarget depth;
};

/// One resource at one HLSL register; the resource says which register class it is (see the makers below).
struct Binding {
    enum class Kind { ConstantBuffer, ShaderResource, Sampler, UnorderedAccess };
    Kind kind = Kind::ConstantBuffer;
    std::uint32_t slot = 0;
    BufferPtr buffer;
    TexturePtr texture;
    SamplerPtr sampler;
    std::uint64_t offset = 0;  ///< bytes into the buffer, a multiple of 256
    std::uint64_t size = 0;    ///< bytes; 0 means up to the end

    static Binding constants(std::uint32_t slot, BufferPtr buffer) {
        return {Kind::ConstantBuffer, slot, std::move(buffer), {}, {}, 0, 0};
    }
    static Binding read(std::uint32_t slot, BufferPtr buffer) {
        return {Kind::ShaderResource, slot, std::move(buffer), {}, {}, 0, 0};
    }
    static Binding read(std::uint32_t slot, TexturePtr texture) {
        return {Kind::ShaderResource, slot, {}, std::move(texture), {}, 0, 0};
    }
    static Binding sample(std::uint32_t slot, SamplerPtr sampler) {
        return {Kind::Sampler, slot, {}, {}, std::move(sampler), 0, 0};
    }
    static Binding write(std::uint32_t slot, BufferPtr buffer) {
        return {Kind::UnorderedAccess, slot, std::move(buffer), {}, {}, 0, 0};
    }
    static Binding write(std::uint32_t slot, TexturePtr texture) {
        return {Kind::UnorderedAccess, slot, {}, std::move(texture), {}, 0, 0};
    }
};

/// A register that a pipeline's shaders use.
struct ShaderRegister {
    Binding::Kind kind = Binding::Kind::ConstantBuffer;
    std::uint32_t slot = 0;
    friend auto operator<=>(const ShaderRegister&, const ShaderRegister&) = default;
};
/// As HLSL writes it: "b0", "t3" …
std::string toString(const ShaderRegister& shaderRegister);

/// A window of the window system that the program runs under, as that system names it.
struct NativeWindow {
    void* connection =
        nullptr;  ///< X11: xcb_connection_t*, which must outlive the swap chain; Windows: nothing
    std::uintptr_t window = 0;  ///< X11: xcb_window_t; Windows: HWND
};

struct SwapChainDesc {
    NativeWindow window;
    std::uint32_t width = 1;  ///< pixels of the back buffer
    std::uint32_t height = 1;
    bool waitForDisplay = true;  ///< present at most once per refresh, without tearing
};

enum class DeviceType { Discrete, Integrated, Virtual, Cpu, Other };
std::string_view toString(DeviceType type);
/// The graphics APIs; Direct3D 11 on Windows only.
enum class Backend { Vulkan, Direct3D11 };
std::string_view toString(Backend backend);

/// Threads that a wave may have where a compute pipeline asks for it; such waves have votes, ballots and
/// shuffles.
struct WaveSizes {
    std::uint32_t minimum = 0, maximum = 0;  ///< 0: none can be asked for

    bool has(std::uint32_t threads) const {
        return std::has_single_bit(threads) && threads >= minimum && threads <= maximum;
    }
};

struct DeviceInfo {
    std::uint32_t index = 0;  ///< place in listDevices()
    std::string name;
    Backend backend = Backend::Vulkan;
    std::string apiVersion;  ///< "1.3.230"
    std::string driver;
    DeviceType type = DeviceType::Other;
    bool usable = false;         ///< has everything createDevice() asks for
    std::string unusableReason;  ///< what is missing otherwise
    bool validates = false;      ///< the API's own checks are installed
    std::vector<std::uint32_t>
        sampleCounts;  ///< that colour and depth targets both support, ascending from 1
    bool tessellation = false;
    bool depthClamp = false;
    bool wireframe = false;
    bool presents = false;             ///< swap chains can be made where there is a display
    double timestampPeriodNs = 0;      ///< 0: no timestamps, pass times are 0
    std::uint64_t maxBufferBytes = 0;  ///< of one storage buffer as a shader sees it
    std::uint32_t maxTextureSize = 0;  ///< pixels along one side
    std::uint64_t memoryBytes = 0;     ///< of the largest device-local heap
    WaveSizes waves;
    bool statistics = false;  ///< counts what passes did, where DeviceOptions::statistics asks for it

    std::uint32_t maxSamples() const { return sampleCounts.empty() ? 1 : sampleCounts.back(); }
};

/// What the stages of a graphics pass did (pipeline statistics of both graphics APIs).
struct PassCounts {
    std::uint64_t vertices = 0;     ///< that the input assembler handed on
    std::uint64_t vertexRuns = 0;   ///< of the vertex shader
    std::uint64_t patches = 0;      ///< that the hull shader worked on
    std::uint64_t evaluations = 0;  ///< runs of the domain shader
    std::uint64_t primitives = 0;   ///< that came to the clipper, from tessellation, too
    std::uint64_t fragments = 0;    ///< runs of the pixel shader

    PassCounts& operator+=(const PassCounts& other) {
        vertices += other.vertices;
        vertexRuns += other.vertexRuns;
        patches += other.patches;
        evaluations += other.evaluations;
        primitives += other.primitives;
        fragments += other.fragments;
        return *this;
    }
};

struct PassTime {
    std::string name;
    double milliseconds = 0;  ///< on the device
    /// Of graphics passes, where they were asked for and the device has them.
    std::optional<PassCounts> counts = {};
};

}  // namespace hairloom::gpu
