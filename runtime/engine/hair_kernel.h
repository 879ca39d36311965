// SPDX-License-Identifier: MIT
#pragma once
// The inner loops of hair-hair collision (engine/hair_grid.h), compiled once for each instruction set.

#include <cstddef>
#include <cstdint>

#include "engine/kernels.h"

namespace hairloom::runtime {

/// Of a node: its share of the density that it keeps, and with its velocity. Whole numbers, so that their
/// order does not matter.
inline constexpr std::size_t kHairSums = 4;
/// Of a node, for points: push x, y, z, m/s²; density, 1 as authored; velocity x, y, z, m/s; the rate at
/// which compression slows, 1/s.
inline constexpr std::size_t kHairFields = 8, kFieldDensity = 3, kFieldVelocity = 4, kFieldSlows = 7;
/// Velocities are whole numbers of so many m/s, up to so many m/s.
inline constexpr float kHairVelocityUnit = 1.0f / 4096.0f, kMostHairVelocity = 32.0f;

/// Nodes of a grid, in cells from the middle of the head.
struct HairBox {
    std::int32_t low[3] = {}, size[3] = {};
    std::size_t nodes() const {
        return static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) *
               static_cast<std::size_t>(size[2]);
    }
    friend bool operator==(const HairBox&, const HairBox&) = default;
};
/// Box of a block's points, cells.
struct HairBounds {
    float low[3], high[3];
};

/// A block of strands. Planes are `pitch` floats apart.
struct HairBlock {
    std::uint32_t points, strands;
    std::size_t pitch;
    const float* moving;  ///< position x, y, z, previous x, y, z
    const float* roots;   ///< rows of State::roots
    float* places;        ///< x, y, z in cells
    const float* share;   ///< of each point, of a full node
    float* felt;          ///< push x, y, z and rate
};

/// What all blocks share in one frame.
struct HairFrame {
    Float3 axes[3];       ///< from the world to the grid at the end of the frame: rows, 1/m
    Float3 head, center;  ///< world, metres; grid, cells: the same point
    HairBox box;
    float ahead;                           ///< last substeps that the frame is as long as
    float rate;                            ///< 1/s, of the last substep
    Float3 reference;                      ///< m/s, that velocities are counted from
    float friction, stickSpeed, cohesion;  ///< m/s², m/s, 1/s
};

/// One step of `relax`: next += speed (bias + gain · (sum of the six around) − next), of nodes `first` to
/// `end`.
struct HairRelaxation {
    const float *bias, *gain, *now;
    float* next;
    std::size_t first, end, row, slice;
    float speed;
};

struct HairKernels {
    /// Fills in `places`: where points will be at the end of the frame as they move. What is no number is in
    /// no bounds.
    void (*locate)(const HairBlock& block, const HairFrame& frame, HairBounds& bounds);
    /// Adds the block to kHairSums of each node.
    void (*deposit)(const HairBlock& block, const HairFrame& frame, double* sums);
    /// Fills in `felt` from kHairFields of each node.
    void (*press)(const HairBlock& block, const HairFrame& frame, const float* fields);
    void (*relax)(const HairRelaxation& relaxation);
};
/// Those for the best instruction set of this machine.
const HairKernels& hairKernels();

}  // namespace hairloom::runtime
