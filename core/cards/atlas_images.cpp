// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cards/atlas_images.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/render/tone_map.h"

namespace hairloom::cards {
namespace {

constexpr float kDepthRange = 0.04f;  // metres

std::uint8_t byteOf(float value) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(value, 0.0f, 1.0f)));
}

template <class Colour>
render::Image imageOf(const Picture& picture, const Colour& colour) {
    render::Image image{picture.width, picture.height, {}};
    image.rgba.reserve(4 * picture.texels.size());
    for (const Texel& t : picture.texels) {
        const Vec4f c = colour(t);
        for (int i = 0; i < 4; ++i) image.rgba.push_back(byteOf(c[i]));
    }
    return image;
}

float centred(float value) {
    return 0.5f + 0.5f * value;
}

}  // namespace

render::Image colourImage(const Picture& picture, float scale) {
    return imageOf(picture, [&](const Texel& t) {
        return Vec4f(render::encodeSrgb(t.albedo.x()), render::encodeSrgb(t.albedo.y()),
                     render::encodeSrgb(t.albedo.z()), scale * t.coverage);
    });
}

render::Image normalImage(const Picture& picture) {
    return imageOf(picture, [](const Texel& t) {
        return Vec4f(centred(t.normal.x()), centred(t.normal.y()), centred(t.normal.z()), 1);
    });
}

render::Image occlusionImage(const Picture& picture) {
    return imageOf(picture, [](const Texel& t) { return Vec4f(t.open, t.open, t.open, 1); });
}

std::vector<AtlasImage> imagesOf(const Atlas& atlas) {
    std::vector<AtlasImage> images;
    for (std::size_t level = 0; level < atlas.levels.size(); ++level) {
        const std::string name = level == 0 ? "colour" : fmt::format("colour.{}", level);
        images.push_back(
            {name, colourImage(atlas.levels[level], level == 0 ? 1.0f : keepingScale(atlas, level))});
    }
    const Picture& whole = atlas.levels[0];
    images.push_back({"shape", imageOf(whole, [](const Texel& t) {
                          return Vec4f(centred(t.flow.x()), centred(t.flow.y()), 0.5f + t.depth / kDepthRange,
                                       t.open);
                      })});
    images.push_back({"normal", normalImage(whole)});
    images.push_back(
        {"strand", imageOf(whole, [](const Texel& t) { return Vec4f(t.along, t.id, t.coverage, 1); })});
    return images;
}

}  // namespace hairloom::cards
