// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Hair that benchmarks of editing work on: 100,000 strands of 16 points, 20 cm long, combed over a head.

#include <cmath>

#include "core/geometry/placement.h"
#include "core/geometry/selection.h"
#include "core/geometry/shapes.h"
#include "core/operations/flow.h"

namespace hairloom::benchmarks {

inline constexpr float kBenchHeadRadius = 0.09f;  ///< metres; its middle is the origin
inline constexpr std::uint32_t kBenchStrands = 100'000;

inline Groom combedHair() {
    const auto head =
        std::make_shared<const ScalpMesh>(shapes::meshOf(shapes::icosphere(5, kBenchHeadRadius)));
    FaceSet faces = selectFaces(*head, "cap:80").value();
    PlacementRequest request;
    request.count = kBenchStrands;
    Groom groom = growStraight(head, faces, placeRandom(*head, faces, request)->roots, 0.2f, 16).value();
    FlowSettings settings;
    settings.crown = Vec3f(0, kBenchHeadRadius, -0.02f);
    flow(groom, settings).value();
    return groom;
}

/// Where a stroke over the crown is, from one ear (−90 degrees) to the other (90).
inline Vec3f onCombedHair(float degrees) {
    const float angle = radians(degrees);
    return Vec3f(std::sin(angle), std::cos(angle), 0.2f).normalized() * (kBenchHeadRadius + 0.012f);
}

}  // namespace hairloom::benchmarks
