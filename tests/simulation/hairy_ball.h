// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Hair on a ball, whose equations tell how deep it comes.

#include <cmath>
#include <memory>
#include <stdexcept>
#include <vector>

#include "core/base/random.h"
#include "core/simulation/bake_body.h"
#include "tests/geometry/test_meshes.h"

namespace hairloom::test {

inline constexpr std::uint32_t kBallHairPoints = 12;

/// Hair of 12 cm that stands out from the upper half of a ball of 10 cm, which no sphere protects.
inline Groom hairyBall() {
    const auto ball = std::make_shared<const ScalpMesh>(meshOf(icosphereSoup(4, 0.1f)));
    std::vector<std::uint32_t> offsets{0};
    std::vector<Vec3f> positions;
    Random random(2);
    while (offsets.size() <= 60) {
        Vec3f out = randomPoint(random, 1).normalized();
        out.y() = std::abs(out.y());
        for (std::uint32_t p = 0; p < kBallHairPoints; ++p)
            positions.push_back((0.1f + 0.12f * static_cast<float>(p) / (kBallHairPoints - 1)) * out);
        offsets.push_back(static_cast<std::uint32_t>(positions.size()));
    }
    Groom groom = makeGroom(std::move(offsets), std::move(positions));
    groom.scalp = ball;
    groom.simulation.angularStiffness = 0.05f;  // falls on the ball
    groom.simulation.restGravity = 0;
    return groom;
}

inline Groom withBody(Groom groom) {
    auto baked = bakeBodyOf(groom, nullptr);
    if (!baked) throw std::runtime_error(baked.error().message());
    groom.body = baked->field;
    return groom;
}

/// hairyBall() with its skin, measured once.
inline const Groom& hairyBody() {
    static const Groom kGroom = withBody(hairyBall());
    return kGroom;
}

}  // namespace hairloom::test
