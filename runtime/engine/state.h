// SPDX-License-Identifier: MIT
#pragma once
// The arrays of one engine: the rest shape, made once, and the state, which every step changes.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <optional>
#include <utility>
#include <vector>

#include "engine/kernels.h"
#include "hairloom/body_field.h"
#include "hairloom/host.h"
#include "hairloom/memory.h"
#include "hairloom/settings.h"

namespace hairloom::runtime {

/// Storage that starts on a cache line, so that every register load is aligned.
template <class T>
struct CacheLineAllocator {
    using value_type = T;
    static constexpr std::size_t kCacheLine = 64;
    CacheLineAllocator() = default;
    template <class U>
    CacheLineAllocator(const CacheLineAllocator<U>&) {}
    T* allocate(std::size_t n) { return static_cast<T*>(takeMemory(n * sizeof(T), kCacheLine)); }
    void deallocate(T* p, std::size_t n) noexcept { returnMemory(p, n * sizeof(T), kCacheLine); }
    /// What is given no value has none: a vector that is resized does not touch its memory.
    template <class U>
    void construct(U* p) {
        ::new (static_cast<void*>(p)) U;
    }
    template <class U, class V>
    void construct(U* p, V&& value) {
        ::new (static_cast<void*>(p)) U(std::forward<V>(value));
    }
    friend bool operator==(CacheLineAllocator, CacheLineAllocator) { return true; }
};
using Floats = std::vector<float, CacheLineAllocator<float>>;
/// So many zeros, written on the host's threads.
Floats zeroFloats(std::size_t count, const Host& host);

/// Lanes of a block.
struct LaneRange {
    LaneRange(std::uint32_t lane) : begin(lane), end(lane + 1) {}  // NOLINT(google-explicit-constructor)
    LaneRange(std::uint32_t first, std::uint32_t last) : begin(first), end(last) {}
    std::uint32_t begin, end;
};
inline const LaneRange kAllLanes{0, kBlockLanes};

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
    Vector<std::uint32_t> offsets;
    Vector<Block> blocks;
    std::size_t planeFloats = 0;  ///< sum of the blocks' plane sizes
    Floats planes;                ///< per block: rest x, y, z, length, inverse length, inverse mass
    Vector<RootFrame> restRoots;
    Vector<float> stiffness;  ///< StrandsView::stiffness; empty where all are 1
    std::uint32_t longestPointCount = 0;
    float longestStrand = 0.0f;  ///< metres
    bool straight = true;        ///< no strand bends at rest

    std::size_t bytes() const;
    float stiffnessOf(std::uint32_t strand) const { return stiffness.empty() ? 1.0f : stiffness[strand]; }
};

/// A plane holds one float per point and lane.
inline std::size_t planeSize(const Block& block) {
    return std::size_t{block.points} * kBlockLanes + kPlanePadding;
}

/// `strands` must be sound (Engine::make checks it).
std::shared_ptr<const RestShape> makeRestShape(const StrandsView& strands, const Host& host = {});

/// How long a block has been at rest.
struct Rest {
    /// Points of a strand that say whether it stays: at each quarter of them, the tip last.
    static constexpr std::uint32_t kAnchors = HAIRLOOM_REST_ANCHORS;

    float time = 0.0f;  ///< seconds for which all points were slow
    bool asleep = false;
    float stayed = 0.0f;  ///< seconds for which no strand has left its anchors
    std::array<float, kAnchors * 3 * kBlockLanes> anchors{};  ///< metres: x, y, z of each in all lanes

    friend bool operator==(const Rest&, const Rest&) = default;
};

/// Of a model's own arrays in a State, at most.
inline constexpr std::size_t kOwnArrays = 5;

/// What changes from step to step. A copy is a snapshot: running on from it gives the same bits.
struct State {
    Floats planes;  ///< per block: position x, y, z, previous x, y, z
    Floats roots;   ///< per block: position x, y, z, rotation x, y, z, w of each lane at the last frame's end
    StrandModel model = StrandModel::rods;  ///< that `own` is of
    std::array<Floats, kOwnArrays> own;     ///< what the model remembers besides, per block (Model::own)
    Vector<Rest> rests;                     ///< per block
    Vector<Sphere> spheres;                 ///< of the last frame
    Vector<Capsule> capsules;               ///< likewise, between these
    Vector<BonePose> body;                  ///< likewise; empty where none was given
    Float3 rootsMin_ws, rootsMax_ws;        ///< box of the last frame's roots
    float substep = 0.0f;                   ///< seconds of the last substep; 0 before the first
    float fastest = 0.0f;                   ///< m/s, greatest speed of a point at the end of the last frame
    std::optional<std::array<double, 3>> origin_ws;  ///< of the last frame; none before the first

    std::uint64_t hash() const;
};

inline constexpr std::size_t kRestPlanes = 6;
inline constexpr std::size_t kStatePlanes = 6;

/// The block's points and rest shape, for `view` of any model.
void fillView(const RestShape& shape, State& state, std::size_t block, std::uint32_t clampedPoints,
              BlockView& view);

/// Places the points of lanes of block `b` at rest on their rows of state.roots, without speed.
void placeAtRest(const RestShape& shape, State& state, std::size_t block, LaneRange lanes);

}  // namespace hairloom::runtime
