// SPDX-License-Identifier: MIT
#pragma once
// What the inner loops of all models share (engine/strand_model.h has the models). A kernel is a stage over
// one block: kBlockLanes strands of equal point count, stored so that neighbouring lanes are neighbouring
// strands (index = point · kBlockLanes
// + lane). The block keeps this shape for every instruction set, and kernels use only exactly rounded
// operations. Where a product and a sum may be rounded once, kernels say so (MulAdd), and compilers fuse
// nothing on their own: all instruction sets that have fused multiply-add (AVX2, AVX-512, NEON) give the same
// bits, and so do all that have not (SSE4 and before, plain C++).
//
// Forces add a·h² to a point's displacement by taking it from `previous`; integrators that evaluate forces
// elsewhere put that position into `position` and the displacement that counts as velocity there into
// `previous` first.
//
// Positions are relative to the strand's own root, which keeps single precision where hair needs it;
// `previous` is the position one substep ago relative to the root of now, so position − previous is the world
// displacement.

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

#include "hairloom/memory.h"
#include "hairloom/plan.h"
#include "hairloom/wind.h"
#include "shaders/simulation_types.h"

namespace hairloom::runtime {

inline constexpr std::uint32_t kBlockLanes = 32;
inline constexpr std::uint32_t kWidestVector = 16;  ///< lanes
/// Floats behind each plane: a cache line that keeps planes off each other's 4 KiB aliases.
inline constexpr std::uint32_t kPlanePadding = 16;

/// x, y and z of one quantity: three arrays, `pitch` floats apart.
template <class Float>
struct PlanesOf {
    Float* x = nullptr;
    std::size_t pitch = 0;

    Float* y() const { return x + pitch; }
    Float* z() const { return x + 2 * pitch; }
};
using Planes = PlanesOf<float>;
using ConstPlanes = PlanesOf<const float>;

/// SubstepContext::stepRatio where there is no step before.
inline constexpr float kFirstStepRatio = 1e9f;

/// What every model has of a block; each adds what is its own.
struct BlockView {
    std::uint32_t lanes;      ///< from the first on; those with strands, in whole vectors of any width
    std::uint32_t points;     ///< per strand
    std::uint32_t firstFree;  ///< points before it are clamped
    std::size_t pitch;        ///< of all planes below
    Planes position;
    Planes previous;
    ConstPlanes rest;            ///< vector of segment s, from point s to s + 1, in the root's frame, at
                                 ///< [s · kBlockLanes + lane]; metres
    const float* length;         ///< of each segment, likewise
    const float* inverseLength;  ///< 0 for a segment without length
    const float* inverseMass;    ///< of each point; the masses of a strand have the mean 1
    /// Of each point, metres from the body at rest; null without one, and where the model meets none.
    const float* clearance = nullptr;
    float* bodySeen = nullptr;  ///< kBodyPlanes of what is known of the body, likewise
    /// Of each point, in this frame, by the hair around it: an acceleration, m/s², and the rate at which it
    /// resists motion, 1/s, kHairPlanes in all; null without.
    ConstPlanes hairPush;
    const float* hairRate = nullptr;
};

struct MovingSphere {
    Float3 from_ws;  ///< centre at the start of the frame
    Float3 step;     ///< the centre's displacement in one substep
    float radius;
    float stepLength = length(step);  ///< metres in one substep
};

/// The hull of two moving spheres.
struct MovingCapsule {
    MovingSphere ends[2];
    MovingSphere around;  ///< holds it all through the frame
};

class MovingBody;  // engine/moving_body.h

/// What the strands move through.
enum class Air : std::uint32_t { none, still, moving };
inline constexpr std::size_t kAirCount = 3;

/// What the strands of a block go through in one frame; one of an engine's Scratch (engine/scratch.h).
struct alignas(64) LaneFrame {
    float root[3][kBlockLanes];              ///< at the start of the frame, world
    float rootDisplacement[3][kBlockLanes];  ///< the root's displacement in one substep
    float rotationFrom[4][kBlockLanes];      ///< x, y, z, w
    float rotationTo[4][kBlockLanes];        ///< by the first substep on the side of rotationFrom
    float rotation[4][kBlockLanes];          ///< of now; kept by the stage `roots`
    std::uint32_t guarded = 0;       ///< a bit for each lane whose speeds the model took back in this frame
    Vector<MovingSphere> touchable;  ///< spheres that can reach the block, where its model lists them
    Vector<MovingCapsule> touchableCapsules;  ///< likewise
    /// What the model keeps for a block through a frame: Model::laneFloats of them, on a cache line.
    float* own = nullptr;
    /// What the solvers along a strand work in: for each point what Model::solverFloats says of the stages,
    /// and kSolverPadding more. On a cache line.
    float* solver = nullptr;
};
inline constexpr std::size_t kSolverPadding = 3 * kPlanePadding;

/// Numbers of a substep that one model alone reads, as it likes.
class ModelNumbers {
  public:
    template <class Numbers>
    void set(const Numbers& numbers) {
        static_assert(std::is_trivially_copyable_v<Numbers> && sizeof(Numbers) <= sizeof(bytes_));
        std::memcpy(bytes_, &numbers, sizeof(Numbers));
    }
    template <class Numbers>
    Numbers as() const {
        Numbers numbers;
        std::memcpy(&numbers, bytes_, sizeof(Numbers));
        return numbers;
    }

  private:
    alignas(16) std::byte bytes_[64] = {};
};

/// What all blocks share in one substep.
struct SubstepContext : shaders::SubstepNumbers {
    SubstepContext() : SubstepNumbers{} { velocityShare = 1.0f; }

    std::uint32_t index = 0;  ///< substep of the frame, from 0
    std::uint32_t count = 1;
    float h = 0.0f;      ///< seconds
    Float3 gravity;      ///< m/s²
    Float3 gravityStep;  ///< g·h²
    Air air = Air::none;
    float airDrag = 0.0f;  ///< 1/s
    std::uint32_t lengthIterations = 0;
    std::span<const MovingSphere> spheres;
    std::span<const MovingCapsule> capsules;
    std::span<const MovingSphere> shelters;  ///< spheres that air goes around: none of those along capsules
    float stepRatio = 1.0f;                  ///< h over that of the substep before, or kFirstStepRatio
    bool sweeps = false;                     ///< spheres are met where fast points come in
    bool conservative = false;               ///< nothing but motion of roots and spheres adds energy
    bool spheresRest = false;                ///< nor do spheres and body
    const MovingBody* body = nullptr;
    const Wind* wind = nullptr;
    float windShelter = 0.0f;           ///< 0…1, of spheres
    bool segmentsTouch = false;         ///< springs: spheres are met between points, too
    const float* windPhases = nullptr;  ///< of the substep's end
    ModelNumbers numbers;
};

inline constexpr auto kUnsweptShare = static_cast<float>(HAIRLOOM_UNSWEPT_SHARE);

using Stage = void (*)(const BlockView& block, LaneFrame& lanes, const SubstepContext& context);

inline constexpr std::size_t kRootRows = 7;  ///< of a block's roots: position x, y, z, rotation x, y, z, w

/// Box and longest displacement of many roots, lane by lane.
struct alignas(64) RootBounds {
    float low[3][kBlockLanes], high[3][kBlockLanes];  ///< world
    float longest[kBlockLanes];                       ///< square metres, of those that are no cuts
    bool anyTeleported = false;                       ///< set by a displacement that is one
};

/// What the kernels of all models share.
struct Kernels {
    Stage roots;
    /// Greatest squared displacement of a free point in the last substep, square metres; infinite where a
    /// point is no number or has left the range of sound positions.
    float (*fastest)(const BlockView& block);
    /// Makes the rotations in a block's rows of roots `next` unit length, and adds the roots to `bounds`;
    /// `before` are those of the last frame. False, and nothing else, where a root is no position: not
    /// finite, or too far away. A displacement whose square is above `cut` is none. With `sound` roots it
    /// neither looks nor changes.
    bool (*takeRoots)(const float* before, float* next, bool sound, float cut, RootBounds& bounds);
    const char* target;  ///< name of the instruction set
    bool fuses;          ///< MulAdd rounds once
};
/// Those for the best instruction set of this machine.
const Kernels& kernels();

/// What a model makes of a plan: calls over a block, one after the other in each substep.
struct Passes {
    std::array<Stage, kMaxStages> calls;
    std::size_t count = 0;
    /// Runs once, behind so many calls of the first substep after rest; null: nothing does.
    Stage afterStart = nullptr;
    std::size_t startCalls = 0;
};

}  // namespace hairloom::runtime
