// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/look/tress.h"

#include <algorithm>
#include <cmath>

#include "core/base/random.h"

namespace hairloom::editor {
namespace {

constexpr std::uint32_t kStrands = 1100;
constexpr std::uint32_t kPoints = 24;
constexpr float kWidth = 0.06f, kLength = 0.096f;  // metres
constexpr float kRagged = 0.1f;                    // of the length, by which hairs may be shorter

/// Light from around, beside which the lamps only give shape: it shows the colour of all of the lock.
constexpr float kSky = 3;
/// No light passes through fibres of Kajiya and Kay: they need more of it.
constexpr float kKajiyaSky = 9;
/// Others are exposed by up to a stop more where they are dark, as a photographer does it.
constexpr float kLight = 0.63f, kDark = 0.063f;  // linear luminance of the colours
constexpr float kGrey = 0.7f;                    // of white strands

/// Hair that hangs over a rounded edge and sways to one side and back.
Groom tress() {
    Random random(1, 7);
    std::vector<std::uint32_t> offsets{0};
    std::vector<Vec3f> positions;
    for (std::uint32_t s = 0; s < kStrands; ++s) {
        const float across = 2 * random.uniform() - 1;
        const float layer = random.uniform();
        const float phase = 0.5f * across + 0.25f * (random.uniform() - 0.5f);
        const float length = kLength * (1 - kRagged * random.uniform());
        for (std::uint32_t p = 0; p < kPoints; ++p) {
            const float along = static_cast<float>(p) / (kPoints - 1);
            const float narrow = 1 - 0.35f * along;
            const float sway = 0.009f * std::sin(5.5f * along + phase) * along;
            const float round = std::sqrt(std::max(0.0f, 1 - across * across));
            positions.emplace_back(0.5f * kWidth * across * narrow + sway, 0.5f * kLength - length * along,
                                   0.016f * round * (1 - 0.4f * layer) +
                                       0.012f * std::sin(kPi * std::min(1.0f, 1.4f * along)) +
                                       0.002f * std::sin(11 * along + 3 * phase));
        }
        offsets.push_back(static_cast<std::uint32_t>(positions.size()));
    }
    return makeGroom(std::move(offsets), std::move(positions));
}

float luminance(const Vec3f& colour) {
    return colour.dot(Vec3f(0.2126f, 0.7152f, 0.0722f));
}

/// Of what is brightest in it.
float brightness(const HairMaterial& material) {
    const float hair = luminance(0.5f * (material.rootColour + material.tipColour));
    const float dye = material.dyeStrength * luminance(material.dyeColour);
    const float streaks = material.streakShare > 0 ? luminance(material.streakColour) : 0.0f;
    return std::max({hair, dye, streaks, material.greyShare > 0 ? kGrey : 0.0f, 1e-6f});
}

}  // namespace

PictureRequest tressPicture(const HairMaterial& material, std::uint32_t side_px) {
    static const Groom lock = tress();
    Groom groom = lock;
    groom.material = material;
    // Fewer hairs than a head has, and the wider.
    groom.material.rootRadius = std::max(material.rootRadius, 0.00012f);
    groom.material.tipScale = 0.8f;
    PictureRequest request;
    request.groom = std::make_shared<const Groom>(std::move(groom));
    request.camera.target_ws = Vec3f(0.002f, -0.002f, 0.01f);
    request.camera.eye_ws = Vec3f(0.02f, 0.02f, 0.5f);
    request.camera.verticalFov = 11;
    request.width = request.height = side_px;
    request.seeThrough = true;
    request.quality.frames = 4;
    // So few photons as a small picture gets leave stains on it.
    request.quality.scattering = render::Scattering::dual;
    if (material.shadingModel == ShadingModel::kajiya) {
        request.environment = kKajiyaSky;
    } else {
        const float bright = brightness(material);
        const float dark = std::clamp(std::log(kLight / bright) / std::log(kLight / kDark), 0.0f, 1.0f);
        request.environment = kSky;
        request.exposure *= std::exp2(dark);
    }
    return request;
}

}  // namespace hairloom::editor
