// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>

#include "core/base/result.h"
#include "core/gpu/types.h"
#include "core/render/colour_transform.h"

namespace hairloom::render {

/// How hair stands between a point and a light. The head is a depth map in all of them.
enum class Shadows {
    none,
    deepOpacity,  ///< Yuksel and Keyser 2008: layers that follow the first hair, and its depth
    absorption,   ///< depth behind the first hair alone, hair taken to be spread evenly
    opacityMaps,  ///< Kim and Neumann 2001: layers at fixed depths
    adaptive,     ///< Salvi et al. 2010: nodes of each texel's transmittance, where it changes most
};

/// Over how many texels of a shadow map finished comparisons are averaged (percentage-closer filtering:
/// Reeves et al. 1987), with the weights of a B-spline, which moves smoothly from texel to texel.
enum class ShadowFilter {
    off,    ///< the nearest texel alone
    three,  ///< 3 × 3
    five,   ///< 5 × 5
};

/// Where deep opacity layers end, as parts of the depth that hair takes up.
enum class LayerEnds {
    early,    ///< three at 0.04, 0.14 and 1; more cut each of these into parts of one width
    linear,   ///< all are as wide
    growing,  ///< each is RenderOptions::layerGrowth times as wide as the one before
};

/// How ribbons come about. All draw the same curve.
enum class Ribbons {
    automatic,    ///< compute on a GPU where it can, else strip: chooseWays()
    strip,        ///< a vertex shader pulls the points of the curve
    tessellated,  ///< hull and domain shaders, finer near the eye; needs DeviceInfo::tessellation
    compute,      ///< kernels rasterise hair and head; no weighted transparency
};

/// How hair that covers part of a sample shows what lies behind it.
enum class Transparency {
    automatic,   ///< stochastic for averages; single frames: sorted on a GPU, else weighted
    sorted,      ///< the nearest fragments of a pixel, blended in their order; by kernels
    stochastic,  ///< a random part of the samples (Enderton et al. 2010); averaging frames removes its noise
    weighted,    ///< blended in any order with weights of depth (McGuire and Bavoil 2013)
};

enum class PostFilter {
    none,
    fxaa,      ///< after Lottes 2011: edges of the finished picture, short search
    fxaaHigh,  ///< the same with a long search
};

/// Size and quality of a picture; any of it may change from frame to frame.
struct RenderOptions {
    std::uint32_t width = 1280;  ///< pixels; width × height at most kMaxPixels
    std::uint32_t height = 720;
    std::uint32_t samples = 0;       ///< a pixel and frame: 1, 2, 4, 8; 0: the most the device has, up to 8
    std::uint32_t frames = 8;        ///< averaged, each moved by part of a pixel; 1…1024
    std::uint32_t subdivisions = 2;  ///< curve segments per segment of a strand, 1…64
    std::uint32_t shadowResolution = 1024;  ///< pixels of a light's square shadow map, 64…4096
    Shadows shadows = Shadows::deepOpacity;
    ShadowFilter shadowFilter = ShadowFilter::three;
    /// Of deep opacity maps, 3…11, four to a texture of four channels, one of which holds the first hair's
    /// depth. Fewer where the device has no room for them: chooseWays().
    std::uint32_t shadowLayers = 3;
    LayerEnds layerEnds = LayerEnds::early;
    float layerGrowth = 2;           ///< 1…8, for LayerEnds::growing
    std::uint32_t shadowSlices = 4;  ///< of opacity maps, 1…16, evenly spaced; fewer as layers are
    /// Of a texel's transmittance in adaptive maps, 4…16; fewer as layers are.
    std::uint32_t shadowNodes = 8;
    /// Most pieces of hair in texels that the lists of one light's adaptive map hold, 2^16…2^25; fewer where
    /// the map is small or a buffer of the device is. Where hair has more, a random part of them counts as
    /// all.
    std::uint32_t shadowFragments = 1u << 25u;
    /// Most lights with shadow maps, parts of areas and of images among them, 1…16; fewer where the device
    /// has no room for as many maps.
    std::uint32_t shadowLights = 8;
    std::uint32_t skyStrands =
        8192;  ///< most strands that maps of the sky count, as so many more; at least 64
    /// Cells that Scattering::volume follows light in, at most, 2^12…2^20.
    std::uint32_t lightCells = 1u << 18u;
    /// Photons that it follows, 2^12…2^24: noise falls with the square root of their number. Half as many for
    /// `temporal`.
    std::uint32_t lightPhotons = 1u << 18u;
    /// Hair behind the head's first surface gets exp(−this · metres) of the light (thesis, 6.3), 1/m,
    /// 0…10,000; 0: a test of depth, all or nothing.
    float headAbsorption = 0;
    /// Pixels, standard deviation, 0…32, by which shadows are blurred on the screen (thesis, 6.3); 0: not.
    /// Everything is then drawn twice, with shadows and without.
    float shadowBlur = 0;
    Ribbons ribbons = Ribbons::automatic;
    Transparency transparency = Transparency::stochastic;
    PostFilter filter = PostFilter::none;
    /// Hairs are left out and curves made coarser where a hair of mean width is thinner than this part of a
    /// pixel; those that stay are the wider. 0: all are drawn.
    float detail = 0;
    /// Look-up tables of a material that has changed are baked on another thread, and frames show the old
    /// ones until then: for pictures that must come in time. Renderer::isSettled() says when they are there.
    bool bakeBehind = false;
    /// What is nearest in each pixel is told as well: Renderer::surface().
    bool surface = false;
    /// For pictures in which things move: each frame joins those before it, each pixel where its surface was.
    /// One frame (`frames`), no blurred shadows.
    bool temporal = false;
    float exposure = 2;  ///< factor before the tone curve
    /// Instead of the tone curve and sRGB, from linear light in the primaries of Rec. 709; null: not.
    std::shared_ptr<const ColourTransform> toDisplay;
    bool transparentBackground = false;  ///< alpha is coverage; else 1 everywhere

    bool operator==(const RenderOptions&) const = default;
};
inline constexpr std::uint32_t kMaxSubdivisions = 64;
inline constexpr std::uint32_t kMinShadowResolution = 64, kMaxShadowResolution = 4096;  ///< pixels
inline constexpr std::uint32_t kMinShadowLayers = 3, kMaxShadowLayers = 11;
inline constexpr std::uint32_t kMaxShadowSlices = 16;
inline constexpr std::uint32_t kMinShadowNodes = 4, kMaxShadowNodes = 16;
inline constexpr std::uint32_t kMinShadowFragments = 1u << 16u, kMaxShadowFragments = 1u << 25u;
inline constexpr std::uint32_t kMinLightCells = 1u << 12u, kMaxLightCells = 1u << 20u;
inline constexpr std::uint32_t kMinLightPhotons = 1u << 12u, kMaxLightPhotons = 1u << 24u;
inline constexpr float kMaxLayerGrowth = 8;
inline constexpr float kMaxHeadAbsorption = 10'000;  ///< 1/m
inline constexpr float kMaxShadowBlur = 32;          ///< pixels
inline constexpr std::uint64_t kMaxPixels = std::uint64_t{64} << 20u;

/// Shadow maps of this resolution that the device has room for, at least one.
std::uint32_t mapsThatFit(const RenderOptions& options, const gpu::DeviceInfo& device);

/// Lights that have some of them, at most `shadowLights` of the options.
std::uint32_t shadowLightsOf(const RenderOptions& options, const gpu::DeviceInfo& device);

/// Errors: a size or number out of its range, or something that this device lacks.
Status check(const RenderOptions& options, const gpu::DeviceInfo& device);

/// `samples` of the options, with 0 resolved. Errors: the device has no such number of samples.
Result<std::uint32_t> chooseSamples(const RenderOptions& options, const gpu::DeviceInfo& device);

/// `ribbons` and `transparency`, with automatic resolved for a picture of so many samples a pixel, and as
/// many layers of shadows as the device has room for. `kernels`: what is drawn can be rasterised by kernels.
RenderOptions chooseWays(const RenderOptions& options, std::uint32_t samples, bool kernels,
                         const gpu::DeviceInfo& device);

}  // namespace hairloom::render
