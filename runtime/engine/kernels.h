// SPDX-License-Identifier: MIT
#pragma once
// The seam between the engine and its inner loops. A kernel is a stage over one block: kBlockLanes strands of
// equal point count, stored so that neighbouring lanes are neighbouring strands (index = point · kBlockLanes
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
#include <span>
#include <vector>

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

/// Strands as elastic rods (docs/engine.md, "Rods"); all null for springs. Of segment or vertex j at [j ·
/// kBlockLanes + lane]; a vertex stands at its outer segment, world space unless said otherwise, all with the
/// block's pitch.
struct RodView {
    ConstPlanes tangent;          ///< of a segment in the shape without load, in the root's frame
    ConstPlanes axis;             ///< that a vertex twists about there
    ConstPlanes normal;           ///< long diameter of the section there; null of a round one
    const float* bend = nullptr;  ///< B/l̄ of a vertex, m³/s²
    const float* mass = nullptr;  ///< of each point, metres of hair
    const float* restRotation =
        nullptr;                ///< x, y, z, w of a segment: from the shape without load to the authored one
    float* rotation = nullptr;  ///< x, y, z, w: from the shape without load to the world
    Planes increment;           ///< rotation of each segment in the last substep
    Planes displacement;        ///< of each point in the last substep, metres
    Planes velocity, velocityBefore;  ///< m/s, at the end of the last substep and of the one before
    Planes strain, strainBefore;      ///< likewise
    float* load = nullptr;  ///< force of each point's contacts in the last substep, m²/s²; negative: it slid
    float* turn =
        nullptr;  ///< of each lane: most that a segment turned in the last substep, radians, or kRodNoStep
    float* energy = nullptr;  ///< of each lane, of motion, shape and weight, m³/s², or kRodNoEnergy
    const float* clearance = nullptr;  ///< of each point, metres from the body at rest; null without one
    /// kBodyPlanes of what is known of the body; null without one.
    float* seen = nullptr;
    bool curved = false;  ///< twist matters
};
/// There is no substep before that a second order scheme could build on.
inline constexpr float kRodNoStep = 1e9f;
/// SubstepContext::stepRatio where there is no step before.
inline constexpr float kRodFirstRatio = 1e9f;
/// Nothing is known of the energy before.
inline constexpr float kRodNoEnergy = 1e30f;

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
    RodView rod;
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

struct MovingSphere {
    Float3 from_ws;  ///< centre at the start of the frame
    Float3 step;     ///< the centre's displacement in one substep
    float radius;
    float stepLength = length(step);  ///< metres in one substep
};

class MovingBody;  // engine/moving_body.h

/// What the strands move through.
enum class Air : std::uint32_t { none, still, moving };
inline constexpr std::size_t kAirCount = 3;

inline constexpr std::size_t kCopiedRows = 11;
inline constexpr std::size_t kMaxCopied = 64;

/// What the strands of a block go through in one frame; one of an engine's Scratch (src/scratch.h).
struct alignas(64) LaneFrame {
    float root[3][kBlockLanes];              ///< at the start of the frame, world
    float rootDisplacement[3][kBlockLanes];  ///< the root's displacement in one substep
    float rotationFrom[4][kBlockLanes];      ///< x, y, z, w
    float rotationTo[4][kBlockLanes];        ///< by the first substep on the side of rotationFrom
    float rotation[4][kBlockLanes];          ///< of now; kept by the stage `roots`
    float windRoot[2][3][kBlockLanes];  ///< the air's displacement in one substep at start and end of the
                                        ///< frame, at the root
    float windTip[2][3][kBlockLanes];
    NearPoints near;            ///< kept by the stage `collision`
    std::uint32_t guarded = 0;  ///< of rods: a bit for each lane whose speeds were taken back in this frame
    std::vector<MovingSphere> touchable;  ///< of rods: spheres that can reach the block in this frame
    /// Of strands of at most kMaxCopied points: what the pass of bending and lengths reads of them, in its
    /// own order.
    alignas(64) float copied[kCopiedRows * kMaxCopied * kBlockLanes];
    /// What the solvers along a strand work in: for each point what Kernels::solverFloats says of the stage,
    /// and kSolverPadding more. On a cache line.
    float* solver = nullptr;
};
inline constexpr std::size_t kSolverPadding = 3 * kPlanePadding;

/// What all blocks share in one substep.
struct SubstepContext : shaders::SubstepNumbers {
    SubstepContext() : SubstepNumbers{} { velocityShare = 1.0f; }

    std::uint32_t index = 0;  ///< substep of the frame, from 0
    std::uint32_t count = 1;
    float h = 0.0f;      ///< seconds
    Float3 gravityStep;  ///< g·h²
    std::uint32_t lengthIterations = 0;
    std::span<const MovingSphere> spheres;
    // Of rods.
    Air air = Air::none;
    Float3 gravity;                ///< m/s²
    float airDrag = 0.0f;          ///< 1/s
    float rootDamping = 0.0f;      ///< 1/s
    float bendDampingTime = 0.0f;  ///< seconds
    float twist = 0.0f;            ///< of the section, as RodSectionRatios has them
    float flat = 0.0f;
    float stepRatio = 1.0f;     ///< h over that of the substep before
    bool sweeps = false;        ///< spheres are met where fast points come in
    bool conservative = false;  ///< nothing but motion of roots and spheres adds energy
    bool spheresRest = false;   ///< nor do spheres and body
    const MovingBody* body = nullptr;
    const Wind* wind = nullptr;
    const float* windPhases = nullptr;  ///< of the substep's end
};

/// Share of a sphere's radius that a point may move in one substep without the test for continuous collision
/// looking at it: it can then cut no deeper than 0.8 % of the radius into it unseen.
inline constexpr float kUnsweptShare = 0.25f;

using Stage = void (*)(const BlockView& block, LaneFrame& lanes, const SubstepContext& context);

inline constexpr std::size_t kRootRows = 7;  ///< of a block's roots: position x, y, z, rotation x, y, z, w

/// Box and longest displacement of many roots, lane by lane.
struct alignas(64) RootBounds {
    float low[3][kBlockLanes], high[3][kBlockLanes];  ///< world
    float longest[kBlockLanes];                       ///< square metres, of those that are no cuts
    bool anyTeleported = false;                       ///< set by a displacement that is one
};

struct Kernels {
    Stage stages[kStageCount];              ///< by StageId
    std::size_t solverFloats[kStageCount];  ///< of LaneFrame::solver that a stage needs for a point
    /// Stages that follow each other, in one pass and with the same bits: damping or none, by 0 and 1, then
    /// the air's stage, by Air, then gravity or none, then `verlet`.
    Stage moves[2][kAirCount][2];
    /// The stages of such a pass one by one, with the same bits: between them `previous` holds the way of the
    /// substep. First what opens it, then what follows another one, by StageId; null for other stages.
    Stage partsOfMove[2][kStageCount];
    /// As `moves`: `angularStraight` or `angular`, then `length`, where tension is kept.
    Stage bendAndProject[2];
    /// As `moves`: `continuousCollision`, then `collision` or `collisionBack`.
    Stage bothCollisions[2];
    /// Multiplies every displacement by `factor`: the speed stays when the length of the substep changes.
    void (*rescale)(const BlockView& block, float factor);
    /// Halves the ways that position Verlet has found: from rest the first step is x₁ = x₀ + ½ a h², and the
    /// velocity that it keeps is that of the half step.
    void (*startHalfway)(const BlockView& block);
    /// Fills windRoot and windTip, for substeps of h seconds, for the frame that begins at the phases `from`
    /// and ends at `to`.
    void (*sampleWind)(const BlockView& block, LaneFrame& lanes, float h, const Wind& wind, const float* from,
                       const float* to);
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

/// The rods' stage, and the floats of LaneFrame::solver that it needs for a point.
struct RodKernel {
    Stage stage;
    std::size_t solverFloats;
};
RodKernel rodKernel();

/// What a plan makes of a block in a substep, call after call.
struct Passes {
    std::array<Stage, kMaxStages> calls;
    std::size_t count = 0;
    std::size_t moved = 0;  ///< calls up to position Verlet's, with it; 0 for other integrators
};
/// As few passes over the block as there are kernels for.
Passes passesOf(std::span<const StageId> stages, const Kernels& kernels);
/// A call for each stage, with the same bits.
Passes singlePassesOf(std::span<const StageId> stages, const Kernels& kernels);

/// The kernels for the best instruction set of this machine.
const Kernels& kernels();

}  // namespace hairloom::runtime
