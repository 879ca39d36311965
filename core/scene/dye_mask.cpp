// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/dye_mask.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/groom/point_dye.h"
#include "core/render/png.h"
#include "core/render/tone_map.h"

namespace hairloom {
namespace {

float paintedValue(const render::LinearImage& image, const Vec2f& uv) {
    const auto wrapped = [](float x) { return x - std::floor(x); };
    const auto texel = [](float x, std::uint32_t size) {
        return std::min(static_cast<std::uint32_t>(x * static_cast<float>(size)), size - 1);
    };
    const std::uint32_t x = texel(wrapped(uv.x()), image.width);
    const std::uint32_t y = texel(1 - wrapped(uv.y()), image.height);
    const float* rgba = &image.rgba[4 * (std::size_t{y} * image.width + x)];
    // What people paint as half is half.
    return 0.2126f * render::encodeSrgb(rgba[0]) + 0.7152f * render::encodeSrgb(rgba[1]) +
           0.0722f * render::encodeSrgb(rgba[2]);
}

template <class T>
bool take(const AttributeSet& attributes, const std::string& name, std::vector<float>& mask) {
    const auto values = attributes.view<T>(name);
    if (values.empty()) return false;
    mask.resize(values.size());
    std::ranges::transform(values, mask.begin(),
                           [](T value) { return std::clamp(static_cast<float>(value), 0.0f, 1.0f); });
    return true;
}

/// In place of what was painted too.
void setMask(Groom& groom, std::vector<float> mask) {
    groom.strandAttributes.set(attribute::kDye, std::move(mask));
    groom.pointAttributes.erase(attribute::kPointDye);
}

}  // namespace

Status dyeFromImage(const std::string& path, Groom& groom) {
    const auto image = render::readPng(path);
    if (!image) return tl::unexpected(image.error());
    const auto uvs = groom.strandAttributes.view<Vec2f>(attribute::kRootUv);
    if (uvs.size() != groom.strandCount()) {
        return fail("the strands have no root UVs to read an image at", "bind them to a scalp that has UVs");
    }
    std::vector<float> mask(uvs.size());
    for (std::size_t s = 0; s < uvs.size(); ++s) {
        if (!uvs[s].allFinite()) return fail(fmt::format("the root UV of strand {} is not finite", s));
        mask[s] = std::clamp(paintedValue(*image, uvs[s]), 0.0f, 1.0f);
    }
    setMask(groom, std::move(mask));
    return {};
}

Status dyeFromAttribute(const std::string& name, Groom& groom) {
    std::vector<float> mask;
    const AttributeSet& attributes = groom.strandAttributes;
    if (!take<float>(attributes, name, mask) && !take<std::uint8_t>(attributes, name, mask) &&
        !take<std::uint32_t>(attributes, name, mask) && !take<std::int32_t>(attributes, name, mask)) {
        return fail(fmt::format("there is no strand attribute '{}' of numbers", name));
    }
    if (std::ranges::any_of(mask, [](float value) { return std::isnan(value); }))
        return fail(fmt::format("strand attribute '{}' has a value that is no number", name));
    setMask(groom, std::move(mask));
    return {};
}

}  // namespace hairloom
