// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which passes and targets a picture calls for, and why. Derived from the scene and the options; what is off
// is not recorded and has no memory.

#include <array>
#include <string>
#include <vector>

#include "core/gpu/types.h"
#include "core/render/options.h"

namespace hairloom::render {

inline constexpr gpu::Format kColourFormat = gpu::Format::Rgba16Float;
/// Texels along a side of each map of the sky.
inline constexpr std::uint32_t kSkyResolution = 256;

/// In the order of a frame.
enum class Pass {
    curves,
    headDepth,
    firstHair,
    opacity,
    skyHead,  ///< the same three for light from around
    skyFirst,
    skyLayers,
    skySeen,    ///< from each curve point
    lightGrid,  ///< light between hairs, where it falls
    shade,
    across,   ///< light from one side of a hair to the other
    surface,  ///< of what is nearest in each pixel: depth, strand, velocity, albedo
    nearest,  ///< where kernels rasterise: what is in front, before its light is drawn
    draw,
    blend,      ///< hair over head, in any order
    composite,  ///< of the blended hair
    accumulate,
    temporal,    ///< frames before join, where their surfaces were
    shadowBlur,  ///< on the screen
    toneMap,
    filter,
    overlayDepth,
    overlay,
    overlayOnTop,
};
inline constexpr std::size_t kPassCount = static_cast<std::size_t>(Pass::overlayOnTop) + 1;
/// As pass times name it.
const char* passName(Pass pass);

enum class TargetId {
    headDepth,  ///< shadow atlas: a square for each light that casts shadows, then close maps, side by side
    skyHead,    ///< the same for each side that the sky is seen from
    colour,
    resolved,
    depth,
    blendSum,
    blendRest,
    blendSumResolved,
    blendRestResolved,
    shown,
    overlayDepth,
};
inline constexpr std::size_t kTargetCount = static_cast<std::size_t>(TargetId::overlayDepth) + 1;
const char* targetName(TargetId target);

/// What passes keep in buffers.
enum class BufferId {
    firstHair,       ///< depths as bits; an atlas as TargetId::headDepth
    layerCounts,     ///< one light's fibres, before they become shares
    opacity,         ///< an atlas: four 16-bit shares of 1 a texel
    fragmentCounts,  ///< two a light that has an adaptive map: of all in its texels, and of those in lists
    lightFragments,  ///< HAIRLOOM_LISTED_WORDS each, of one light's lists, which begin where counts are
    skyFirst,        ///< the same three for light from around
    skyCounts,
    skyLayers,
    lightCells,      ///< HAIRLOOM_GRID_CELL_WORDS of what each cell of the light's grid holds
    lightSums,       ///< HAIRLOOM_GRID_LIGHT_WORDS of light that goes through each
    lightGrid,       ///< HAIRLOOM_GRID_FLOATS each, of the same for shading
    nearest,         ///< depths of all samples as bits
    light,           ///< of all samples
    fragmentDepths,  ///< of each pixel's nearest fragments of hair as bits, in their order
    fragmentLight,   ///< theirs
    fragmentCover,   ///< HAIRLOOM_COVER_WORDS a pixel
    sum,             ///< of frames
    litSum,          ///< the same without shadows, where these are blurred
    blurHalfway,     ///< both, blurred along rows
    blurred,         ///< in place of the sum
    surfaceNearest,  ///< depths in the middle of pixels, as bits
    surfaceItem,     ///< of all points and triangles the number of what is there
    surface,         ///< SurfacePixels
    history,         ///< what temporal shows, in turns with the other
    otherHistory,
    historyPixels,  ///< TemporalPixels, likewise
    otherHistoryPixels,
};
inline constexpr std::size_t kBufferCount = static_cast<std::size_t>(BufferId::otherHistoryPixels) + 1;
const char* bufferName(BufferId buffer);

/// What the plan looks at.
struct SceneFacts {
    bool meshes = false;
    bool hair = false;
    std::uint32_t lights = 0;
    std::uint32_t shadowLights = 0;  ///< of them
    std::uint32_t closeMaps = 0;     ///< that hair near the camera calls for: closeMapsThatFit()
    bool environment = false;        ///< light from around
    bool overlay = false;            ///< marks that meshes hide
    bool overlayOnTop = false;
    bool volume = false;            ///< light between hairs is followed
    bool across = false;            ///< hair near the camera has light that changes over its width
    bool look = false;              ///< some hair does not look the same everywhere
    std::uint32_t askedLayers = 0;  ///< of opacity, where the options have fewer; else no matter
    std::uint32_t fragments = 0;    ///< that lists of adaptive maps hold: fragmentsThatFit()
    bool presents = true;           ///< there is a target to show the picture in
    std::uint64_t tableBytes = 0;   ///< of the materials' look-up tables on the device

    bool operator==(const SceneFacts&) const = default;
};

struct PlannedPass {
    bool on = false;
    std::string why;
};

struct PlannedTarget {
    std::uint32_t width = 0;  ///< pixels; 0: not there
    std::uint32_t height = 0;
    gpu::Format format = gpu::Format::Unknown;
    std::uint32_t samples = 1;
    std::string why;

    std::uint64_t bytes() const {
        return std::uint64_t{width} * height * samples * gpu::bytesPerTexel(format);
    }
};

struct PlannedBuffer {
    std::uint64_t elements = 0;  ///< 0: not there
    std::uint32_t elementBytes = 4;
    std::string why;

    std::uint64_t bytes() const { return elements * elementBytes; }
};

/// Look-up tables of the hair's materials; they are kept with the scene.
struct PlannedTables {
    std::uint64_t bytes = 0;
    std::string why;
};

struct RenderPlan {
    std::array<PlannedPass, kPassCount> passes;
    std::array<PlannedTarget, kTargetCount> targets;
    std::array<PlannedBuffer, kBufferCount> buffers;
    PlannedTables tables;
    std::uint32_t closeMaps = 0;  ///< squares of the lights' atlas after those of whole lights

    bool runs(Pass pass) const { return passes[static_cast<std::size_t>(pass)].on; }
    const PlannedTarget& target(TargetId id) const { return targets[static_cast<std::size_t>(id)]; }
    bool has(TargetId id) const { return target(id).width > 0; }
    const PlannedBuffer& buffer(BufferId id) const { return buffers[static_cast<std::size_t>(id)]; }
    bool has(BufferId id) const { return buffer(id).elements > 0; }
    std::uint64_t bytes() const;  ///< of all targets, buffers and tables
};

/// `samples` and `options` as chooseSamples() and chooseWays() give them.
RenderPlan planRender(const SceneFacts& facts, const RenderOptions& options, std::uint32_t samples);

}  // namespace hairloom::render
