// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Hair on a ball, whose equations tell how deep it comes.

#include <algorithm>
#include <array>
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

/// The ball with two bones, the upper of which moves its upper half and most roots.
inline std::shared_ptr<const runtime::BodyField> bentBall() {
    constexpr unsigned kSteps = 16;
    auto field = std::make_shared<runtime::BodyField>(*hairyBody().body);
    field->bones = {"base", "top"};
    field->palette.clear();
    for (unsigned step = 0; step < kSteps; ++step) {
        const auto upper = static_cast<std::uint8_t>(255 * step / (kSteps - 1));
        field->palette.push_back({{0, 1, 0, 0}, {static_cast<std::uint8_t>(255 - upper), upper, 0, 0}});
    }
    const std::size_t row = field->size[0] + 1, layer = row * (field->size[1] + 1);
    std::array<Box3f, 2> boxes;
    for (std::size_t i = 0; i < field->skins.size(); ++i) {
        const Vec3f at = Vec3f(field->low_ss.x, field->low_ss.y, field->low_ss.z) +
                         field->cell * Vec3f(static_cast<float>(i % row), static_cast<float>(i % layer / row),
                                             static_cast<float>(i / layer));
        const float upper = std::clamp((at.y() + 0.05f) / 0.06f, 0.0f, 1.0f);
        field->skins[i] = static_cast<std::uint16_t>(std::lround(upper * (kSteps - 1)));
        for (std::size_t b = 0; b < boxes.size(); ++b) {
            if (field->palette[field->skins[i]].weights[b] > 0) boxes[b].extend(at);
        }
    }
    for (const Box3f& box : boxes) {
        const Vec3f low = box.min() - Vec3f::Constant(field->cell),
                    high = box.max() + Vec3f::Constant(field->cell);
        field->boxes.push_back({{low.x(), low.y(), low.z()}, {high.x(), high.y(), high.z()}});
    }
    return field;
}

}  // namespace hairloom::test
