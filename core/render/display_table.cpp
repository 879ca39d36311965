// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/display_table.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/parallel.h"
#include "core/base/random.h"
#include "core/render/tone_map.h"

namespace hairloom::render {
namespace {

constexpr std::size_t kProbes = 16384;
constexpr float kDarkest = -12, kBrightest = 10;  // stops around 1

/// Light of all amounts: greys, hues from pale to pure, and what lies near black.
std::vector<float> probes() {
    Random random(1);
    const auto share = [&] { return random.uniform(); };
    std::vector<float> light;
    light.reserve(4 * kProbes);
    for (std::size_t i = 0; i < kProbes; ++i) {
        const float amount = std::exp2(kDarkest + (kBrightest - kDarkest) * share());
        const float colour = i % 4 == 0 ? 0.0f : i % 4 == 1 ? 1.0f : share();
        for (int c = 0; c < 3; ++c) light.push_back(amount * (1 - colour * share()));
        light.push_back(1);
    }
    return light;
}

float finite(float code) {
    constexpr float kFar = 1000;
    return std::isnan(code) ? 0 : std::clamp(code, -kFar, kFar);
}

/// Beyond which no probe's code values change.
float topOf(const ColourTransform& toDisplay) {
    constexpr std::array<std::array<float, 3>, 8> kHues{
        {{1, 1, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {0, 1, 1}, {1, 0, 1}, {1, 0.5f, 0.25f}}};
    float top = 1;
    for (int stop = 0; stop < static_cast<int>(kBrightest); ++stop) {
        std::vector<float> light;
        for (const auto& hue : kHues) {
            for (const int more : {stop, stop + 1}) {
                for (const float channel : hue)
                    light.push_back(channel * std::exp2(static_cast<float>(more)));
                light.push_back(1);
            }
        }
        toDisplay.apply(light);
        bool same = true;
        for (std::size_t h = 0; h < kHues.size(); ++h) {
            for (std::size_t c = 0; c < 3; ++c) {
                const float here = std::clamp(finite(light[8 * h + c]), 0.0f, 1.0f);
                const float beyond = std::clamp(finite(light[8 * h + 4 + c]), 0.0f, 1.0f);
                constexpr float kUnseen = 0.5f / 255;
                same = same && std::abs(here - beyond) < kUnseen;
            }
        }
        if (!same) top = std::exp2(static_cast<float>(stop + 1));
    }
    return top;
}

void fill(DisplayTable& table, const ColourTransform& toDisplay) {
    const std::size_t side = table.side;
    const float stretch = std::log2(1 + table.toe * table.top) / static_cast<float>(side - 1);
    std::vector<float> amounts;
    for (std::size_t i = 0; i < side; ++i)
        amounts.push_back((std::exp2(static_cast<float>(i) * stretch) - 1) / table.toe);
    table.codes.resize(side * side * side);
    parallelFor(side, 1, [&](std::size_t begin, std::size_t end) {
        std::vector<float> light(4 * side * side);
        for (std::size_t b = begin; b < end; ++b) {
            for (std::size_t i = 0; i < side * side; ++i) {
                const std::array<float, 4> pixel{amounts[i % side], amounts[i / side], amounts[b], 1};
                std::ranges::copy(pixel, &light[4 * i]);
            }
            toDisplay.apply(light);
            for (std::size_t i = 0; i < side * side; ++i) {
                for (std::size_t c = 0; c < 4; ++c)
                    table.codes[b * side * side + i][c] = finite(light[4 * i + c]);
            }
        }
    });
}

/// In 255ths, before code values are rounded and after.
std::pair<float, int> errorOf(const DisplayTable& table, const std::vector<float>& light,
                              const std::vector<float>& codes) {
    std::pair<float, int> worst{0, 0};
    for (std::size_t i = 0; i < light.size(); i += 4) {
        const Vec3f found = table.lookUp({light[i], light[i + 1], light[i + 2]});
        for (std::size_t c = 0; c < 3; ++c) {
            const float exact = std::clamp(finite(codes[i + c]), 0.0f, 1.0f);
            const float shown = found[static_cast<int>(c)];
            worst.first = std::max(worst.first, 255 * std::abs(shown - exact));
            worst.second = std::max(worst.second, std::abs(int{toByte(shown)} - int{toByte(exact)}));
        }
    }
    return worst;
}

}  // namespace

Vec3f DisplayTable::lookUp(const Vec3f& light) const {
    const float stretch = static_cast<float>(side - 1) / std::log2(1 + toe * top);
    std::array<std::pair<float, std::size_t>, 3> steps;  // part of the cell, and where the next node lies
    std::size_t at = 0, along = 1;
    for (std::size_t c = 0; c < 3; ++c) {
        const float place = std::log2(1 + toe * std::clamp(light[static_cast<int>(c)], 0.0f, top)) * stretch;
        const float cell = std::min(std::floor(place), static_cast<float>(side - 2));
        at += along * static_cast<std::size_t>(cell);
        steps[c] = {place - cell, along};
        along *= side;
    }
    std::ranges::stable_sort(steps, std::greater<>(), &std::pair<float, std::size_t>::first);
    const auto node = [&](std::size_t i) { return Vec3f(codes[i][0], codes[i][1], codes[i][2]); };
    Vec3f sum = node(at) * (1 - steps[0].first);
    for (std::size_t c = 0; c < 3; ++c) {
        at += steps[c].second;
        sum += node(at) * (steps[c].first - (c < 2 ? steps[c + 1].first : 0));
    }
    return sum.cwiseMax(0.0f).cwiseMin(1.0f);
}

DisplayTable bakeDisplayTable(const ColourTransform& toDisplay) {
    const std::vector<float> light = probes();
    std::vector<float> codes = light;
    convert(codes, toDisplay);
    DisplayTable table;
    table.top = topOf(toDisplay);
    // For each size the toe that suits the view.
    for (const std::uint32_t side : {33u, 65u, 129u}) {
        float best = std::numeric_limits<float>::infinity();
        for (const float toe : {4.0f, 16.0f, 64.0f, 128.0f, 256.0f, 1024.0f}) {
            DisplayTable tried;
            tried.side = side;
            tried.toe = toe;
            tried.top = table.top;
            fill(tried, toDisplay);
            const auto [off, worst] = errorOf(tried, light, codes);
            if (off >= best) continue;
            best = off;
            table = std::move(tried);
            table.worst = worst;
        }
        if (table.worst <= 1) break;
    }
    return table;
}

int displayTableError(const DisplayTable& table, const ColourTransform& toDisplay) {
    const std::vector<float> light = probes();
    std::vector<float> codes = light;
    convert(codes, toDisplay);
    return errorOf(table, light, codes).second;
}

}  // namespace hairloom::render
