// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/found_vectors.h"

#include <algorithm>
#include <string_view>

#include "core/operations/bun.h"
#include "core/operations/head_places.h"
#include "core/operations/script.h"

namespace hairloom {
namespace {

/// The setting of that name of an operator that has it.
const FieldInfo& fieldNamed(const Operator& one, std::string_view name, SettingsPart part) {
    const auto& rows =
        part == SettingsPart::region ? scriptRegionFields() : findStackOperator(one.op)->fields;
    return std::ranges::find(rows, name, [](const FieldRow& row) { return std::string_view(row.info.name); })
        ->info;
}

Vec3f vectorOf(const Operator& one, const FieldInfo& field, SettingsPart part) {
    Vec3f value;
    for (std::uint32_t c = 0; c < 3; ++c) value[c] = static_cast<float>(settingOf(one, field, c, part));
    return value;
}

/// Of the plane through the origin, the place next to the top of the head. Nothing where it is no plane.
std::optional<Vec3f> onPlane(const Groom& groom, const Operator& one, std::string_view normal,
                             SettingsPart part) {
    const Vec3f across = vectorOf(one, fieldNamed(one, normal, part), part);
    if (across.isZero(0)) return std::nullopt;
    const Vec3f unit = across.normalized(), top = topOfHead(groom);
    return Vec3f(top - unit * unit.dot(top));
}

}  // namespace

std::optional<Vec3f> vectorFound(const Groom& groom, const Operator& one, const FieldInfo& field,
                                 SettingsPart part) {
    if (!groom.scalp || field.kind != FieldKind::Vector || !vectorOf(one, field, part).isZero(0))
        return std::nullopt;
    const std::string_view name = field.name;
    if (part == SettingsPart::region)
        return name == "point" ? onPlane(groom, one, "normal", part) : std::nullopt;
    if (one.op == "mirror")
        return name == "planePoint" ? onPlane(groom, one, "planeNormal", part) : std::nullopt;
    if (one.op == "bun") {
        const auto own = [&](std::string_view setting) { return fieldNamed(one, setting, part); };
        const auto thickness = static_cast<float>(settingOf(one, own("thickness"), 0));
        const BunPlace place =
            bunPlace(groom, vectorOf(one, own("centre"), part), vectorOf(one, own("axis"), part), thickness);
        return name == "centre" ? place.centre : place.axis;
    }
    if (std::string_view(field.unit) != "m") return std::nullopt;
    return name == "crown" ? crownOfHead(groom) : topOfHead(groom);
}

}  // namespace hairloom
