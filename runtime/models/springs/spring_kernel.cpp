// SPDX-License-Identifier: MIT
// The stages of springs, compiled once for each instruction set. Each stage walks a block from root to tip
// and, at every point, over the block's lanes: neighbouring vectors are independent and hide each other's
// latency.
#include "models/springs/spring_kernels.h"

// Vector types stand in structs below, which scalable vectors cannot.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "models/springs/spring_kernel.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "hwy/highway.h"
#include "models/springs/air-inl.h"
#include "models/springs/bend-inl.h"
#include "models/springs/collide-inl.h"
#include "models/springs/continuous_collision-inl.h"
#include "models/springs/implicit-inl.h"
#include "models/springs/integrate-inl.h"
#include "models/springs/length-inl.h"
#include "models/springs/motion-inl.h"
#include "models/springs/spring_block-inl.h"
#include "models/springs/springs-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

/// A kernel of springs as a stage.
template <auto kKernel>
void ofSprings(const BlockView& block, LaneFrame& lanes, const SubstepContext& context) {
    kKernel(static_cast<const SpringBlock&>(block), lanes, context);
}

/// One of the stages that SpringKernels::moves makes one pass of.
template <StageId kPart, Motion kFrom, Motion kTo>
constexpr Stage partOfMove() {
    constexpr Air kAir = kPart == StageId::drag   ? Air::still
                         : kPart == StageId::wind ? Air::moving
                                                  : Air::none;
    return ofSprings<moveFree<kPart == StageId::damping, kAir, kPart == StageId::gravity, kFrom, kTo>>;
}

Stage stageOf(StageId id) {
    switch (id) {
        case StageId::roots:
            return kernels().roots;
        case StageId::rod:
            return nullptr;
        case StageId::damping:
            return partOfMove<StageId::damping, Motion::position, Motion::position>();
        case StageId::drag:
            return partOfMove<StageId::drag, Motion::position, Motion::position>();
        case StageId::wind:
            return partOfMove<StageId::wind, Motion::position, Motion::position>();
        case StageId::gravity:
            return partOfMove<StageId::gravity, Motion::position, Motion::position>();
        case StageId::springs:
            return ofSprings<applySprings>;
        case StageId::angularSmallAngle:
            return ofSprings<applyAngular<Shape::curved, false>>;
        case StageId::angularExact:
            return ofSprings<applyAngular<Shape::curved, true>>;
        case StageId::straightSmallAngle:
            return ofSprings<applyAngular<Shape::straight, false>>;
        case StageId::straightExact:
            return ofSprings<applyAngular<Shape::straight, true>>;
        case StageId::flexion:
            return ofSprings<applyFlexion>;
        case StageId::penalty:
            return ofSprings<applyPenalty>;
        case StageId::verlet:
            return partOfMove<StageId::verlet, Motion::position, Motion::integrated>();
        case StageId::open:
            return ofSprings<openStep<0>>;
        case StageId::openHalfway:
            return ofSprings<openStep<1>>;
        case StageId::explicitEuler:
            return ofSprings<advanceEuler>;
        case StageId::leapfrog:
            return ofSprings<advanceLeapfrog>;
        case StageId::verletDrift:
            return ofSprings<driftVerlet>;
        case StageId::verletEvaluationState:
            return ofSprings<setVerletEvaluationState>;
        case StageId::verletKick:
            return ofSprings<kickVerlet>;
        case StageId::rungeKutta1:
            return ofSprings<rk4Stage<1>>;
        case StageId::rungeKutta2:
            return ofSprings<rk4Stage<2>>;
        case StageId::rungeKutta3:
            return ofSprings<rk4Stage<3>>;
        case StageId::rungeKutta4:
            return ofSprings<rk4Stage<4>>;
        case StageId::implicitFree:
            return ofSprings<advanceFree>;
        case StageId::implicitBend:
            return ofSprings<advanceImplicitBend>;
        case StageId::implicitSpring:
            return ofSprings<advanceImplicitSpring<false>>;
        case StageId::implicitSpringBend:
            return ofSprings<advanceImplicitSpring<true>>;
        case StageId::angular:
            return ofSprings<bendBack<Shape::curved>>;
        case StageId::angularStraight:
            return ofSprings<bendBack<Shape::straight>>;
        case StageId::length:
            return ofSprings<projectLength<LengthProjection::positions>>;
        case StageId::lengthNow:
            return ofSprings<projectLength<LengthProjection::positionsWithCurrentGradient>>;
        case StageId::springLimit:
            return ofSprings<limitBySpeed>;
        case StageId::collision:
            return ofSprings<collide<false>>;
        case StageId::collisionBack:
            return ofSprings<collide<true>>;
        case StageId::continuousCollision:
            return ofSprings<continuousCollision>;
        case StageId::extension:
            return ofSprings<limitExtension>;
        case StageId::lengthRate:
            return ofSprings<projectDisplacements>;
    }
    return nullptr;
}

/// Of LaneFrame::solver, for a point.
constexpr std::size_t solverFloats(StageId id) {
    constexpr std::size_t kStrip = sizeof(Strip::Point) / sizeof(float);
    constexpr std::size_t kSystem = sizeof(StrandSystem::Point) / sizeof(float);
    switch (id) {
        case StageId::angularSmallAngle:
        case StageId::angularExact:
        case StageId::straightSmallAngle:
        case StageId::straightExact:
            return 3 * kBlockLanes;
        case StageId::implicitBend:
        case StageId::angular:
        case StageId::angularStraight:
        case StageId::length:
        case StageId::lengthNow:
        case StageId::lengthRate:
            return kStrip;
        case StageId::implicitSpring:
        case StageId::implicitSpringBend:
            return kSystem;
        default:
            return 0;
    }
}

template <bool kDamped, Air kAir>
void fillMoves(SpringKernels& table) {
    auto& moves = table.moves[kDamped ? 1 : 0][static_cast<std::size_t>(kAir)];
    moves[0] = ofSprings<moveFree<kDamped, kAir, false, Motion::position, Motion::integrated>>;
    moves[1] = ofSprings<moveFree<kDamped, kAir, true, Motion::position, Motion::integrated>>;
}

template <StageId kPart>
void fillPart(SpringKernels& table) {
    constexpr Motion kTo = kPart == StageId::verlet ? Motion::integrated : Motion::displacement;
    table.partsOfMove[0][static_cast<std::size_t>(kPart)] = partOfMove<kPart, Motion::position, kTo>();
    table.partsOfMove[1][static_cast<std::size_t>(kPart)] = partOfMove<kPart, Motion::displacement, kTo>();
}

SpringKernels makeTable() {
    SpringKernels table{};
    for (std::uint32_t id = 0; id < kStageCount; ++id) {
        table.stages[id] = stageOf(static_cast<StageId>(id));
        table.solverFloats[id] = solverFloats(static_cast<StageId>(id));
    }
    fillMoves<false, Air::none>(table);
    fillMoves<false, Air::still>(table);
    fillMoves<false, Air::moving>(table);
    fillMoves<true, Air::none>(table);
    fillMoves<true, Air::still>(table);
    fillMoves<true, Air::moving>(table);
    fillPart<StageId::damping>(table);
    fillPart<StageId::drag>(table);
    fillPart<StageId::wind>(table);
    fillPart<StageId::gravity>(table);
    fillPart<StageId::verlet>(table);
    table.bendAndProject[0] = ofSprings<bendAndProject<Shape::straight>>;
    table.bendAndProject[1] = ofSprings<bendAndProject<Shape::curved>>;
    table.bothCollisions[0] = ofSprings<bothCollisions<false>>;
    table.bothCollisions[1] = ofSprings<bothCollisions<true>>;
    table.rescale = rescale;
    table.startHalfway = ofSprings<startHalfway>;
    table.sampleWind = sampleWind;
    return table;
}

const SpringKernels& springKernelsOfTarget() {
    static const SpringKernels kTable = makeTable();
    return kTable;
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hairloom::runtime {

HWY_EXPORT(springKernelsOfTarget);

const SpringKernels& springKernels() {
    return HWY_DYNAMIC_DISPATCH(springKernelsOfTarget)();
}

}  // namespace hairloom::runtime
#endif
