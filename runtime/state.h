// SPDX-License-Identifier: MIT
#pragma once
// The arrays of one engine: the rest shape, made once, and the state, which every step changes.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <vector>

#include "runtime/kernels.h"

namespace hairloom::runtime {

/// Storage that starts on a cache line, so that every register load is aligned.
template <class T>
struct CacheLineAllocator {
    using value_type = T;
    CacheLineAllocator() = default;
    template <class U>
    CacheLineAllocator(const CacheLineAllocator<U>&) {}
    T* allocate(std::size_t n) {
        return static_cast<T*>(::operator new (n * sizeof(T), std::align_val_t{64}));
    }
    void deallocate(T* p, std::size_t) { ::operator delete (p, std::align_val_t{64}); }
    friend bool operator==(CacheLineAllocator, CacheLineAllocator) { return true; }
};
using Floats = std::vector<float, CacheLineAllocator<float>>;

/// Up to kBlockLanes strands of one point count. Lanes past `strands` repeat the last strand and are never
/// read.
struct Block {
    std::uint32_t points;
    std::uint32_t strands;
    std::size_t firstPlane;  ///< start of its first plane, in units of one plane's floats over all blocks
    std::uint32_t strandOfLane[kBlockLanes];
};

/// Rest shape and grouping of the strands; immutable, shared by copies of an engine.
struct RestShape {
    std::vector<std::uint32_t> offsets;
    std::vector<Block> blocks;
    std::size_t planeFloats = 0;  ///< sum of the blocks' plane sizes
    Floats planes;                ///< per block: rest x, y, z, length, inverse length
    std::vector<RootFrame> restRoots;
    std::uint32_t longestPointCount = 0;
    float longestStrand = 0.0f;  ///< metres

    std::size_t bytes() const;
};

/// A plane holds one float per point and lane, and a cache line that keeps planes off each other's 4 KiB
/// aliases.
inline std::size_t planeSize(const Block& block) {
    return std::size_t{block.points} * kBlockLanes + 16;
}

/// `strands` must be sound (Engine::make checks it).
std::shared_ptr<const RestShape> makeRestShape(const StrandsView& strands);

/// What changes from step to step. A copy is a snapshot: running on from it gives the same bits.
struct State {
    Floats planes;  ///< per block: position x, y, z, previous x, y, z
    Floats roots;   ///< per block: position x, y, z, rotation x, y, z, w of each lane at the last frame's end
    Floats pull;    ///< per block, planes `pull` and `settle`; empty unless angular springs are on
    std::vector<Sphere> spheres;      ///< of the last frame
    Float3 rootsMin_ws, rootsMax_ws;  ///< box of the last frame's roots
    float substep = 0.0f;             ///< seconds of the last substep; 0 before the first
    float pullSubstep = 0.0f;         ///< substep that `pull` was made for

    std::uint64_t hash() const;
};

inline constexpr std::size_t kRestPlanes = 5;
inline constexpr std::size_t kStatePlanes = 6;
inline constexpr std::size_t kPullPlanes = 2;
inline constexpr std::size_t kRootRows = 7;

BlockView viewOf(const RestShape& shape, State& state, std::size_t block, std::uint32_t clampedPoints);

/// Places block `b` at rest on its rows of state.roots, without speed.
void placeAtRest(const RestShape& shape, State& state, std::size_t block);

/// Shares of the way back for substeps of h seconds: the implicit step of a spring towards the rest place,
/// pull = (x² + 2ζx) / (1 + x² + 2ζx) with x = ω·h, ω² = (100 rad/s)² · s/(1 − s) · (1 cm / segment length)²
/// and s the stiffness at the segment. The part 2ζx of the move, `settle`, damps: it does not become speed.
/// No stiffness or substep overshoots, and for ever smaller substeps it tends to the spring of frequency ω
/// damped by ζ.
void fillPull(const RestShape& shape, const SimulationSettings& settings, float h, std::size_t block,
              State& state);

}  // namespace hairloom::runtime
