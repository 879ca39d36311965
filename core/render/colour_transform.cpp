// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/colour_transform.h"

#include <cmath>

#include "core/base/parallel.h"
#include "core/render/display_table.h"
#include "core/render/tone_map.h"

namespace hairloom::render {

const DisplayTable& ColourTransform::displayTable() const {
    std::call_once(baked_, [this] { table_ = std::make_shared<DisplayTable>(bakeDisplayTable(*this)); });
    return *table_;
}

void convert(std::span<float> rgba, const ColourTransform& transform) {
    constexpr std::size_t kPixelsAtOnce = 4096;
    parallelFor(rgba.size() / 4, kPixelsAtOnce, [&](std::size_t begin, std::size_t end) {
        transform.apply(rgba.subspan(4 * begin, 4 * (end - begin)));
    });
}

Image showBy(const ColourTransform& toDisplay, const LinearImage& linear, float exposure) {
    std::vector<float> pixels = linear.rgba;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        if (i % 4 != 3) pixels[i] *= exposure;
    }
    convert(pixels, toDisplay);
    Image image{linear.width, linear.height, {}};
    image.rgba.reserve(pixels.size());
    for (const float value : pixels) image.rgba.push_back(std::isnan(value) ? 0 : toByte(value));
    return image;
}

}  // namespace hairloom::render
