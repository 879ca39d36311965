// SPDX-License-Identifier: MIT
#pragma once
// The seam between FollowHairs and its inner loops. A row is one quantity along a strand, x y z x y z …,
// which starts on a cache line and is padded to whole ones: a hair is a weighted sum of rows, and the sum
// needs no shuffles. Like the engine's kernels, these use only exactly rounded operations, and
// fused multiply-add where the instruction set has it and they say so.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "hairloom/follow.h"
#include "hairloom/math.h"

namespace hairloom::runtime {

inline constexpr std::size_t kRowFloats = 16;    ///< rows are a multiple of it
inline constexpr std::size_t kWispRows = 3;      ///< centre, x axis, y axis
inline constexpr std::size_t kFrameFloats = 16;  ///< x, y, normal as x y z 0 each, and four unused

/// All that is one hair's, a cache line.
struct alignas(64) HairBinding {
    std::array<std::uint32_t, 3> guides;
    float single;                      ///< share of the wisp, 1 − blend
    std::array<float, 2> wispOffset;   ///< times `single`
    std::array<float, 3> weights;      ///< times the blend
    std::array<float, 3> rootWeights;  ///< (root weights − weights) times the blend
    std::array<float, 3> rootShift;
};
static_assert(sizeof(HairBinding) == 64);

struct GuideRows {
    std::uint32_t points;    ///< of every guide and hair, at most 2²⁰
    std::size_t rowFloats;   ///< from row to row
    const float* radii;      ///< per point
    WispMotion motion;       ///< how their radii grow with speed
    const float* positions;  ///< one row per guide
    float* wisps;            ///< kWispRows rows per guide
    const float* frames;     ///< kFrameFloats per guide: the root plane of now
};

struct FollowKernels {
    std::size_t width;  ///< floats of a vector
    bool fused;         ///< multiplies and adds in one
    /// For guides [begin, end): takes their velocities from the first wisp row and fills the wisp rows: the
    /// centre, and the axes of the cross-section scaled by its radius.
    void (*fillWisps)(const GuideRows& guides, std::size_t begin, std::size_t end);
    /// Writes hairs.size() hairs to `positions`.
    void (*sumRows)(const GuideRows& guides, std::span<const HairBinding> hairs, float* positions);
    /// Directions of unit length of the points of strands that follow each other, `perStrand` ≥ 2 points
    /// each: from the point before to the point after. Upwards where these coincide.
    void (*tangents)(const float* positions, std::size_t points, std::size_t perStrand, float* directions);
    /// IEEE halves, to the nearest even, of `points` positions less `from`.
    void (*toHalves)(const float* positions, std::size_t points, Float3 from, std::uint16_t* halves);
    /// (value − from) scale, from 0 to 65,535, to the nearest; how many components were beyond.
    std::uint32_t (*toNorms)(const float* positions, std::size_t points, Float3 from, Float3 scale,
                             std::uint16_t* norms);
    /// −1 … 1 to −32,767 … 32,767.
    void (*toSignedNorms)(const float* values, std::size_t count, std::int16_t* norms);
    /// Lowers and raises six values, a box, to the points that are finite.
    void (*grow)(const float* positions, std::size_t points, float* low, float* high);
};

/// The kernels for the best instruction set of this machine.
const FollowKernels& followKernels();

}  // namespace hairloom::runtime
