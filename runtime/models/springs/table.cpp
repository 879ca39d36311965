// SPDX-License-Identifier: MIT
// The table of stages, compiled once for each instruction set. Each stage walks a block from root to tip and,
// at every point, over the block's lanes: neighbouring vectors are independent and hide each other's latency.
#include "engine/kernels.h"

// Vector types stand in structs below, which scalable vectors cannot.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "models/springs/table.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "engine/roots-inl.h"
#include "hwy/highway.h"
#include "models/springs/air-inl.h"
#include "models/springs/bend-inl.h"
#include "models/springs/collide-inl.h"
#include "models/springs/continuous_collision-inl.h"
#include "models/springs/implicit-inl.h"
#include "models/springs/integrate-inl.h"
#include "models/springs/length-inl.h"
#include "models/springs/motion-inl.h"
#include "models/springs/springs-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

/// One of the stages that Kernels::moves makes one pass of.
template <StageId kPart, Motion kFrom, Motion kTo>
constexpr Stage partOfMove() {
    constexpr Air kAir = kPart == StageId::drag   ? Air::still
                         : kPart == StageId::wind ? Air::moving
                                                  : Air::none;
    return moveFree<kPart == StageId::damping, kAir, kPart == StageId::gravity, kFrom, kTo>;
}

Stage stageOf(StageId id) {
    switch (id) {
        case StageId::roots:
            return moveRoots;
        case StageId::rod:
            return rodKernel().stage;
        case StageId::damping:
            return partOfMove<StageId::damping, Motion::position, Motion::position>();
        case StageId::drag:
            return partOfMove<StageId::drag, Motion::position, Motion::position>();
        case StageId::wind:
            return partOfMove<StageId::wind, Motion::position, Motion::position>();
        case StageId::gravity:
            return partOfMove<StageId::gravity, Motion::position, Motion::position>();
        case StageId::springs:
            return applySprings;
        case StageId::angularSmallAngle:
            return applyAngular<Shape::curved, false>;
        case StageId::angularExact:
            return applyAngular<Shape::curved, true>;
        case StageId::straightSmallAngle:
            return applyAngular<Shape::straight, false>;
        case StageId::straightExact:
            return applyAngular<Shape::straight, true>;
        case StageId::flexion:
            return applyFlexion;
        case StageId::penalty:
            return applyPenalty;
        case StageId::verlet:
            return partOfMove<StageId::verlet, Motion::position, Motion::integrated>();
        case StageId::open:
            return openStep<0>;
        case StageId::openHalfway:
            return openStep<1>;
        case StageId::explicitEuler:
            return advanceEuler;
        case StageId::leapfrog:
            return advanceLeapfrog;
        case StageId::verletDrift:
            return driftVerlet;
        case StageId::verletEvaluationState:
            return setVerletEvaluationState;
        case StageId::verletKick:
            return kickVerlet;
        case StageId::rungeKutta1:
            return rk4Stage<1>;
        case StageId::rungeKutta2:
            return rk4Stage<2>;
        case StageId::rungeKutta3:
            return rk4Stage<3>;
        case StageId::rungeKutta4:
            return rk4Stage<4>;
        case StageId::implicitFree:
            return advanceFree;
        case StageId::implicitBend:
            return advanceImplicitBend;
        case StageId::implicitSpring:
            return advanceImplicitSpring<false>;
        case StageId::implicitSpringBend:
            return advanceImplicitSpring<true>;
        case StageId::angular:
            return bendBack<Shape::curved>;
        case StageId::angularStraight:
            return bendBack<Shape::straight>;
        case StageId::length:
            return projectLength<LengthProjection::positions>;
        case StageId::lengthNow:
            return projectLength<LengthProjection::positionsWithCurrentGradient>;
        case StageId::springLimit:
            return limitBySpeed;
        case StageId::collision:
            return collide<false>;
        case StageId::collisionBack:
            return collide<true>;
        case StageId::continuousCollision:
            return continuousCollision;
        case StageId::extension:
            return limitExtension;
        case StageId::lengthRate:
            return projectDisplacements;
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
void fillMoves(Kernels& table) {
    auto& moves = table.moves[kDamped ? 1 : 0][static_cast<std::size_t>(kAir)];
    moves[0] = moveFree<kDamped, kAir, false, Motion::position, Motion::integrated>;
    moves[1] = moveFree<kDamped, kAir, true, Motion::position, Motion::integrated>;
}

template <StageId kPart>
void fillPart(Kernels& table) {
    constexpr Motion kTo = kPart == StageId::verlet ? Motion::integrated : Motion::displacement;
    table.partsOfMove[0][static_cast<std::size_t>(kPart)] = partOfMove<kPart, Motion::position, kTo>();
    table.partsOfMove[1][static_cast<std::size_t>(kPart)] = partOfMove<kPart, Motion::displacement, kTo>();
}

Kernels makeTable() {
    Kernels table{};
    for (std::uint32_t id = 0; id < kStageCount; ++id) {
        table.stages[id] = stageOf(static_cast<StageId>(id));
        table.solverFloats[id] = solverFloats(static_cast<StageId>(id));
    }
    table.solverFloats[static_cast<std::size_t>(StageId::rod)] = rodKernel().solverFloats;
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
    table.bendAndProject[0] = bendAndProject<Shape::straight>;
    table.bendAndProject[1] = bendAndProject<Shape::curved>;
    table.bothCollisions[0] = bothCollisions<false>;
    table.bothCollisions[1] = bothCollisions<true>;
    table.rescale = rescale;
    table.startHalfway = startHalfway;
    table.takeRoots = takeRoots;
    table.sampleWind = sampleWind;
    table.fastest = fastestOf;
    table.target = hwy::TargetName(HWY_TARGET);
    table.fuses = HWY_NATIVE_FMA != 0;
    return table;
}

const Kernels& kernelsOfTarget() {
    static const Kernels kTable = makeTable();
    return kTable;
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hairloom::runtime {

HWY_EXPORT(kernelsOfTarget);

const Kernels& kernels() {
    return HWY_DYNAMIC_DISPATCH(kernelsOfTarget)();
}

}  // namespace hairloom::runtime
#endif
