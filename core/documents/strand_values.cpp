// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/documents/strand_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/documents/mask_image.h"
#include "core/groom/mask_names.h"
#include "core/groom/point_dye.h"
#include "core/groom/white_strands.h"
#include "hairloom/strands.h"

namespace hairloom {
namespace {

template <class T>
bool take(const AttributeSet& attributes, const std::string& name, float most, std::vector<float>& mask) {
    const auto values = attributes.view<T>(name);
    if (values.empty()) return false;
    mask.resize(values.size());
    std::ranges::transform(values, mask.begin(),
                           [most](T value) { return std::clamp(static_cast<float>(value), 0.0f, most); });
    return true;
}

/// In place of what was painted too.
void setMask(Groom& groom, std::vector<float> mask) {
    groom.strandAttributes.set(attribute::kDye, std::move(mask));
    groom.pointAttributes.erase(attribute::kPointDye);
}

Result<std::vector<float>> fromImage(const std::string& path, const Groom& groom) {
    const auto image = MaskImage::read(path);
    if (!image) return tl::unexpected(image.error());
    return valuesAtRoots(*image, groom);
}

Result<std::vector<float>> fromAttribute(const std::string& name, float most, const Groom& groom) {
    std::vector<float> mask;
    const AttributeSet& attributes = groom.strandAttributes;
    if (!take<float>(attributes, name, most, mask) && !take<std::uint8_t>(attributes, name, most, mask) &&
        !take<std::uint32_t>(attributes, name, most, mask) &&
        !take<std::int32_t>(attributes, name, most, mask)) {
        return fail(fmt::format("there is no strand attribute '{}' of numbers", name),
                    "expected one that `info` lists as float");
    }
    if (std::ranges::any_of(mask, [](float value) { return std::isnan(value); }))
        return fail(fmt::format("strand attribute '{}' has a value that is no number", name),
                    "expected finite numbers");
    return mask;
}

}  // namespace

Status dyeFromImage(const std::string& path, Groom& groom) {
    auto mask = fromImage(path, groom);
    if (!mask) return tl::unexpected(mask.error());
    setMask(groom, std::move(*mask));
    return {};
}

Status dyeFromAttribute(const std::string& name, Groom& groom) {
    auto mask = fromAttribute(name, 1, groom);
    if (!mask) return tl::unexpected(mask.error());
    setMask(groom, std::move(*mask));
    return {};
}

Status melaninFromImage(const std::string& path, Groom& groom) {
    auto shares = fromImage(path, groom);
    if (!shares) return tl::unexpected(shares.error());
    groom.strandAttributes.set(attribute::kMelanin, std::move(*shares));
    return {};
}

Status melaninFromAttribute(const std::string& name, Groom& groom) {
    auto values = fromAttribute(name, kMostMelanin, groom);
    if (!values) return tl::unexpected(values.error());
    groom.strandAttributes.set(attribute::kMelanin, std::move(*values));
    return {};
}

std::vector<float> stiffnessOfShares(std::span<const float> shares, const StiffnessRange& range) {
    std::vector<float> values(shares.size());
    std::ranges::transform(shares, values.begin(),
                           [&range](float share) { return range.black * (1 - share) + range.white * share; });
    return values;
}

Status stiffnessFromImage(const std::string& path, const StiffnessRange& range, Groom& groom) {
    const auto shares = fromImage(path, groom);
    if (!shares) return tl::unexpected(shares.error());
    groom.strandAttributes.set(attribute::kStiffness, stiffnessOfShares(*shares, range));
    return {};
}

Status stiffnessFromMask(const std::string& name, const StiffnessRange& range, Groom& groom) {
    const auto number = findMask(groom, name);
    if (!number) return tl::unexpected(number.error());
    const auto shares = groom.strandAttributes.view<float>(maskAttribute(*number));
    if (shares.empty())
        return fail(fmt::format("nothing is painted in mask '{}'", maskName(groom, *number)),
                    "expected a mask that was painted, or filled by an image");
    groom.strandAttributes.set(attribute::kStiffness, stiffnessOfShares(shares, range));
    return {};
}

Status stiffnessFromAttribute(const std::string& name, Groom& groom) {
    auto values = fromAttribute(name, runtime::kMostStiffness, groom);
    if (!values) return tl::unexpected(values.error());
    groom.strandAttributes.set(attribute::kStiffness, std::move(*values));
    return {};
}

}  // namespace hairloom
