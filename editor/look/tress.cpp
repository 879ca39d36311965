// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/look/tress.h"

#include <cmath>

#include "core/base/random.h"

namespace hairloom::editor {
namespace {

constexpr std::uint32_t kStrands = 700;
constexpr std::uint32_t kPoints = 24;
constexpr float kWidth = 0.05f, kLength = 0.09f;  // metres

/// Hair that hangs over a rounded edge and sways to one side and back.
Groom tress() {
    Random random(1, 7);
    std::vector<std::uint32_t> offsets{0};
    std::vector<Vec3f> positions;
    for (std::uint32_t s = 0; s < kStrands; ++s) {
        const float across = 2 * random.uniform() - 1;
        const float layer = random.uniform();
        const float phase = 0.5f * across + 0.25f * (random.uniform() - 0.5f);
        for (std::uint32_t p = 0; p < kPoints; ++p) {
            const float along = static_cast<float>(p) / (kPoints - 1);
            const float narrow = 1 - 0.35f * along;
            const float sway = 0.009f * std::sin(5.5f * along + phase) * along;
            const float round = std::sqrt(std::max(0.0f, 1 - across * across));
            positions.emplace_back(0.5f * kWidth * across * narrow + sway, kLength * (0.5f - along),
                                   0.016f * round * (1 - 0.4f * layer) +
                                       0.012f * std::sin(kPi * std::min(1.0f, 1.4f * along)) +
                                       0.002f * std::sin(11 * along + 3 * phase));
        }
        offsets.push_back(static_cast<std::uint32_t>(positions.size()));
    }
    return makeGroom(std::move(offsets), std::move(positions));
}

}  // namespace

PictureRequest tressPicture(const HairMaterial& material, std::uint32_t side_px, const Vec3f& background) {
    static const Groom lock = tress();
    Groom groom = lock;
    groom.material = material;
    // Fewer hairs than a head has, and the wider.
    groom.material.rootRadius = std::max(material.rootRadius, 0.00012f);
    groom.material.tipScale = 0.8f;
    PictureRequest request;
    request.groom = std::make_shared<const Groom>(std::move(groom));
    request.camera.target_ws = Vec3f(0, -0.004f, 0.01f);
    request.camera.eye_ws = Vec3f(0.02f, 0.02f, 0.5f);
    request.camera.verticalFov = 8.5f;
    request.width = request.height = side_px;
    request.background = background;
    request.quality.frames = 4;
    return request;
}

}  // namespace hairloom::editor
