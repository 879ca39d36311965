// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What tests of methods with rigid segments share: ProjectiveEquations and RigidChains.

#include "tests/runtime/strand_fixture.h"

namespace hairloom::runtime {

template <class Method>
Method makeMethod(const Strands& strands, const SimulationSettings& settings, Host host = {}) {
    typename Method::Result made = Method::make(strands.view(), settings, std::move(host));
    EXPECT_EQ(made.error, "");
    return std::move(*made.engine);
}

template <class Method>
std::vector<Float3> positionsOf(const Method& method) {
    std::vector<Float3> positions(method.pointCount());
    method.readPositions(positions);
    return positions;
}

template <class Method>
void run(Method& method, const Strands& strands, int frames, float dt = 1.0f / 60.0f,
         std::span<const Sphere> spheres = {}) {
    const std::vector<RootFrame> roots = strands.roots();
    for (int f = 0; f < frames; ++f) method.step({dt, static_cast<double>(dt) * (f + 1), roots, spheres});
}

/// Largest |length / rest length − 1|; NaN where a point is none.
inline double worstStretch(const Strands& strands, const std::vector<Float3>& now) {
    double worst = 0.0;
    for (std::uint32_t s = 0; s < strands.count(); ++s) {
        for (std::uint32_t p = strands.offsets[s] + 1; p < strands.offsets[s + 1]; ++p) {
            const double rest = static_cast<double>(length(strands.points[p] - strands.points[p - 1]));
            const double stretch = std::abs(static_cast<double>(length(now[p] - now[p - 1])) / rest - 1.0);
            if (!(stretch <= worst)) worst = stretch;
        }
    }
    return worst;
}

inline Strands oneSegment(Float3 direction, float l) {
    Strands strands;
    strands.add({}, direction, l, 2);
    return strands;
}

}  // namespace hairloom::runtime
