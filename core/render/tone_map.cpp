// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/tone_map.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"

namespace hairloom::render {
namespace {

// Hable 2010, "Uncharted 2: HDR Lighting", the published constants.
float hable(float x) {
    constexpr float a = 0.15f, b = 0.50f, c = 0.10f, d = 0.20f, e = 0.02f, f = 0.30f;
    return (x * (a * x + c * b) + d * e) / (x * (a * x + b) + d * f) - e / f;
}

}  // namespace

std::uint8_t toByte(float value) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * 255));
}

float encodeSrgb(float linear) {
    const float x = std::clamp(linear, 0.0f, 1.0f);
    return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
}

float decodeSrgb(float encoded) {
    const float x = std::clamp(encoded, 0.0f, 1.0f);
    return x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f);
}

float filmic(float linear) {
    return hable(std::max(linear, 0.0f)) / hable(kFilmicWhite);
}

Image toneMap(const LinearImage& linear, float exposure) {
    Image image{linear.width, linear.height, std::vector<std::uint8_t>(linear.rgba.size())};
    parallelFor(linear.rgba.size() / 4, 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const float* in = &linear.rgba[4 * i];
            const float luminance = exposure * (0.2126f * in[0] + 0.7152f * in[1] + 0.0722f * in[2]);
            const float scale = luminance > 1e-6f ? filmic(luminance) / luminance : 0;
            for (std::size_t c = 0; c < 3; ++c) {
                // Channel by channel the curve bleaches colours, on luminance alone it keeps all of them:
                // halfway.
                const float value = exposure * in[c];
                image.rgba[4 * i + c] = toByte(encodeSrgb(0.5f * (filmic(value) + scale * value)));
            }
            image.rgba[4 * i + 3] = toByte(linear.rgba[4 * i + 3]);
        }
    });
    return image;
}

}  // namespace hairloom::render
