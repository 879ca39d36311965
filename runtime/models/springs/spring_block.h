// SPDX-License-Identifier: MIT
#pragma once
// What the kernels of springs have of a block, and what they keep of it through a frame.

#include <cstddef>
#include <cstdint>

#include "engine/kernels.h"

namespace hairloom::runtime {

struct SpringBlock : BlockView {
    // Of angular and flexion springs, null while they are off. The joint at point j stands at
    // [j · kBlockLanes + lane].
    const float* stiffness = nullptr;  ///< κ·h² of a joint, square metres
    /// What a joint adds to its inner segment's direction, in the frame carried there (x along the segment);
    /// at the tip's slot the normal carried by the root, in the root's frame. Null for straight hair.
    ConstPlanes target;
    /// Of implicit angular springs beside the length constraint, null otherwise: the tension of each segment
    /// in the last substep, times h²; in metres, for masses of mean 1.
    float* tension = nullptr;
    // Where the system of a strand is solved: LDLᵀ of its matrix, rows of points. Null otherwise.
    const float* inverseDiagonal = nullptr;
    const float* lower1 = nullptr;  ///< to the point before
    const float* lower2 = nullptr;  ///< to the one before that
    // Of integrators that evaluate forces elsewhere than at the last position, null otherwise; each is a
    // displacement in one substep but for `start`, a position.
    Planes start, stepDisplacement, kick, sum, stepDisplacementSum;
};

/// Which points of a block a sphere can reach before they have moved by a margin, found once and used for as
/// many substeps as it holds (Verlet 1967). Of blocks of few points and spheres only.
struct NearPoints {
    static constexpr std::uint32_t kMaxPoints = 64;   ///< of a strand
    static constexpr std::uint32_t kMaxPairs = 4096;  ///< where there can be more there is no list

    /// A vector of points, and a sphere that can reach one of them.
    struct Pair {
        std::uint32_t which;  ///< the sphere, and from bit 16 on the index of the first lane
        float reachSquared;   ///< of the sphere's radius and the point's collision radius, square metres

        static std::uint32_t join(std::size_t sphere, std::size_t index) {
            return static_cast<std::uint32_t>(sphere | (index << 16));
        }
        std::size_t sphere() const { return which & 0xffffu; }
        std::size_t index() const { return which >> 16; }
    };

    /// A pair, and which of its lanes are inside.
    struct Touch {
        Pair pair;
        std::uint32_t inside;
    };

    /// At the start of a frame.
    void forget() {
        made = false;
        overlapsKnown = 0;
    }

    bool made = false;
    std::uint32_t substep;  ///< in which the list was made
    std::uint32_t pairCount;
    float margin;               ///< metres that a point can move relative to its root
    float step;                 ///< metres in a substep that a sphere moves relative to a root, at most
    Pair pairs[kMaxPairs + 1];  ///< those of a point in the order of spheres
    /// Where the points were when the list was made, relative to their roots.
    alignas(64) float positions[3 * (kMaxPoints * kBlockLanes + kPlanePadding)];
    Touch touches[kMaxPairs + 1];     ///< of one substep; written before it is known whether it stays
    std::uint64_t overlaps[64];       ///< of each sphere: those that can overlap it in this frame, as bits
    std::uint64_t overlapsKnown = 0;  ///< which of them are filled
};

inline constexpr std::size_t kCopiedRows = 11;
inline constexpr std::size_t kMaxCopied = 64;

/// At LaneFrame::own.
struct alignas(64) SpringLanes {
    float windRoot[2][3][kBlockLanes];  ///< the air's displacement in one substep at start and end of the
                                        ///< frame, at the root
    float windTip[2][3][kBlockLanes];
    NearPoints near;  ///< kept by the stage `collision`
    /// Of strands of at most kMaxCopied points: what the pass of bending and lengths reads of them, in its
    /// own order.
    alignas(64) float copied[kCopiedRows * kMaxCopied * kBlockLanes];
};
inline SpringLanes& springLanes(LaneFrame& lanes) {
    return *reinterpret_cast<SpringLanes*>(lanes.own);
}
inline const SpringLanes& springLanes(const LaneFrame& lanes) {
    return *reinterpret_cast<const SpringLanes*>(lanes.own);
}

}  // namespace hairloom::runtime
