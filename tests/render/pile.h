// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Hair behind hair in the same pixels, for what is blended in its order.

#include <cmath>
#include <functional>
#include <vector>

#include "tests/render/render_fixture.h"

namespace hairloom::render {

/// Hairs across the view behind each other, each of its own colour, `cover` of a pixel wide, through pixels'
/// middles.
struct Pile {
    static constexpr std::uint32_t kSize = 33;
    TestStrands strands;
    std::vector<Vec3f> colours;
    RenderScene scene;

    Pile(std::size_t count, float cover, bool backwards = false) {
        scene.camera.eye_ws = {0, 0, 1};
        scene.camera.target_ws = Vec3f::Zero();
        const float pixel = 2 * std::tan(radians(scene.camera.verticalFov) / 2) / kSize;
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t k = backwards ? count - 1 - i : i;
            const float z = -0.002f * static_cast<float>(k);
            strands.add({Vec3f(-0.2f, 0, z), Vec3f(0, 0, z), Vec3f(0.2f, 0, z)},
                        0.5f * cover * pixel * (1 - z));
            colours.push_back({k % 3 == 0 ? 1.0f : 0.1f, k % 3 == 1 ? 1.0f : 0.1f, k % 3 == 2 ? 1.0f : 0.1f});
        }
        RenderStrands view = strands.view();
        view.colours = colours;
        view.material.variation = view.material.tipScale = 0;
        scene.strands = {view};
        scene.background = Vec3f(0.2f, 0.2f, 0.2f);
    }
};

inline float luminanceAt(const LinearImage& image, std::size_t x, std::size_t y, std::size_t channel) {
    return image.rgba[4 * (y * Pile::kSize + x) + channel];
}

/// Of 60 hairs of that cover, whose brightness falls with depth, the pixel in the middle has the light of
/// their sum.
inline void expectDeepHairIsAsDark(
    RenderOptions how, float cover,
    const std::function<LinearImage(const RenderScene&, const RenderOptions&)>& draw) {
    constexpr std::size_t kCount = 60;
    how.shadows = Shadows::none;
    how.transparentBackground = true;
    const auto lightOf = [&](std::size_t count, const std::function<float(std::size_t)>& brightness) {
        Pile pile(count, cover);
        for (std::size_t k = 0; k < count; ++k) pile.colours[k] = Vec3f::Constant(brightness(k));
        pile.scene.strands[0].colours = pile.colours;
        return luminanceAt(draw(pile.scene, how), 16, 16, 0);
    };
    const float none = lightOf(1, [](std::size_t) { return 0.0f; }) / cover;
    const float whole = lightOf(1, [](std::size_t) { return 1.0f; }) / cover;
    for (const float perDepth : {0.0f, 0.25f, 0.65f}) {  // of optical depth
        const float fall = -perDepth * std::log(1 - cover);
        const auto brightness = [&](std::size_t k) { return std::exp(-fall * static_cast<float>(k)); };
        float expected = 0, through = 1;
        for (std::size_t k = 0; k < kCount; ++k) {
            expected += through * cover * (none + (whole - none) * brightness(k));
            through *= 1 - cover;
        }
        EXPECT_NEAR(lightOf(kCount, brightness) / expected, 1, 0.02) << perDepth;
    }
}

}  // namespace hairloom::render
