// SPDX-License-Identifier: MIT
// Rods at rest, compiled once for each instruction set.
#include "engine/in_parallel.h"
#include "models/rods/rods.h"

// Vector types stand in structs, which scalable vectors cannot.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "models/rods/rod_rest.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "hwy/highway.h"
#include "models/rods/rod_rest-inl.h"

#if HWY_ONCE
namespace hairloom::runtime {

HWY_EXPORT(layRods);

RodSectionRatios rodSectionRatios(const SimulationSettings& settings) {
    // Of an ellipse with the diameters b ≤ a: I₁ = π a³b/64, I₂ = π a b³/64, and J = π a³b³/(16 (a² + b²)).
    const double ratio = static_cast<double>(settings.sectionRatio);
    const double torsion =
        static_cast<double>(settings.torsionRatio) * 2.0 * ratio * ratio / (1.0 + ratio * ratio);
    return {1.0 / ratio, torsion - 1.0, ratio * ratio - 1.0};
}

bool haveEqualRodEnergy(const SimulationSettings& a, const SimulationSettings& b) {
    return a.gravity == b.gravity && a.restGravity == b.restGravity && a.clampedPoints == b.clampedPoints &&
           a.angularStiffness == b.angularStiffness && a.angularCurve == b.angularCurve &&
           a.torsionRatio == b.torsionRatio && a.sectionRatio == b.sectionRatio;
}

RodParts rodPartsOf(const SimulationSettings& settings, bool straight) {
    if (!(greatestStiffness(settings) > 0.0f)) return RodParts::chain;
    if (rodSectionRatios(settings).flat != 0.0) return RodParts::section;
    const bool held = length(settings.gravity) > 0.0f && settings.restGravity > 0.0f;
    return straight && !held ? RodParts::bending : RodParts::twist;
}

RodParts rodPartsOf(const RestShape& shape, const SimulationSettings& settings) {
    return shape.longestPointCount > settings.clampedPoints ? rodPartsOf(settings, shape.straight)
                                                            : RodParts::chain;
}

RodRest makeRodRest(const RestShape& shape, const SimulationSettings& settings, const Host& host) {
    RodRest rest;
    rest.parts = rodPartsOf(shape, settings);
    rest.planes = zeroFloats(shape.planeFloats * rest.planeCount(), host);
    if (rest.parts >= RodParts::twist) rest.curved.assign(shape.blocks.size(), 0);
    const auto lay = HWY_DYNAMIC_DISPATCH(layRods);
    const auto fill = [&](std::size_t begin, std::size_t end) { lay(shape, settings, begin, end, rest); };
    constexpr std::size_t kBlocksPerPiece = 4;
    inParallel(host, shape.blocks.size(), kBlocksPerPiece, fill);
    return rest;
}

}  // namespace hairloom::runtime
#endif
