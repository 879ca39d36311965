// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/documents/dye_mask.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/documents/mask_image.h"
#include "core/groom/point_dye.h"

namespace hairloom {
namespace {

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
    const auto image = MaskImage::read(path);
    if (!image) return tl::unexpected(image.error());
    auto mask = valuesAtRoots(*image, groom);
    if (!mask) return tl::unexpected(mask.error());
    setMask(groom, std::move(*mask));
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
