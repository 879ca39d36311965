// SPDX-License-Identifier: MIT
#pragma once
// Strands as kernels of a GPU want them. A slot is a strand's place among those of a dispatch. 32 of them are
// a block of RestShape and a work group. Slots past the strands of a block repeat its last.

#include <array>
#include <cstdint>
#include <span>
#include <tuple>

#include "engine/state.h"
#include "hairloom/memory.h"
#include "shaders/types.h"

namespace hairloom::runtime {

struct Slots {
    std::span<const std::uint32_t> blocks;  ///< of the rest shape; their slots come one after the other
    std::uint32_t points = 0;               ///< that a strand may have
    std::uint32_t count = 0;                ///< slots, as many as those of the blocks or more
    bool together = false;  ///< the points of a strand stand side by side, not those of neighbouring strands

    std::size_t planeSize() const { return std::size_t{points} * count; }
    /// By so much an index grows from lane to lane.
    std::size_t laneStride() const { return together ? points : 1; }
};

/// Planes of blocks as those of slots, plane after plane. `planes` holds `count` of them per block.
Vector<float> planesOfSlots(const RestShape& shape, const Slots& slots, const Floats& planes,
                            std::size_t count);
/// The reverse.
void planesOfBlocks(const RestShape& shape, const Slots& slots, std::span<const float> values, Floats& planes,
                    std::size_t count);
/// Rows of one value per slot in the order of blocks: `rows` of them a block.
void rowsToBlocks(const Slots& slots, std::span<const float> values, std::size_t rows, float* blocks);
/// The reverse.
Vector<float> rowsOfSlots(const Slots& slots, const float* blocks, std::size_t rows);
/// How blocks rest, as HAIRLOOM_REST_NUMBERS has it: kRestFloats for each.
Vector<float> restsOfSlots(const Slots& slots, std::span<const Rest> rests);
/// The reverse.
void restsToBlocks(const Slots& slots, std::span<const float> values, std::span<Rest> rests);
inline constexpr std::size_t kRestFloats = HAIRLOOM_REST_NUMBERS + std::tuple_size_v<decltype(Rest::anchors)>;

/// Up to four of the planes of each block, as the components of a float4 for each point.
Vector<shaders::float4> quadsOfSlots(const RestShape& shape, const Slots& slots, const Floats& planes,
                                     std::size_t count, std::span<const std::size_t> which);

/// The rest shape, as storage.hlsli has it.
struct RestSlots {
    Vector<shaders::float4> rest;
    Vector<std::array<float, 2>> segments;
    Vector<std::array<std::uint32_t, 2>> blocks;
    Vector<std::uint32_t> firstPoints;
};
RestSlots restOfSlots(const RestShape& shape, const Slots& slots);

/// Where the frame's roots are, into 2 · slots.count rows; `moved` may be empty: none has.
void putRootsOfSlots(const RestShape& shape, const Slots& slots, std::span<const RootFrame> roots,
                     const Vector<bool>& moved, std::span<shaders::float4> rows);

}  // namespace hairloom::runtime
