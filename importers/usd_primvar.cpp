// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/usd_primvar.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace hairloom {

std::optional<UsdPrimvar> UsdPrimvar::read(const UsdPrim& mesh, std::string_view name,
                                           std::uint32_t components, std::string_view otherwise, double time,
                                           const UsdMeshSize& size, std::string& problem) {
    const UsdAttribute* const attribute = mesh.find(name);
    if (attribute == nullptr || !attribute->hasValue()) return std::nullopt;
    UsdValue value = valueAt(*attribute, time);
    if (value.numbers.empty() || value.components != components) return std::nullopt;
    UsdPrimvar primvar;
    primvar.components_ = components;
    primvar.numbers_ = std::move(value.numbers).floats();
    if (const UsdAttribute* const indices = mesh.find(std::string(name) + ":indices")) {
        const UsdValue places = valueAt(*indices, time);
        for (std::size_t i = 0; i < places.numbers.size(); ++i)
            primvar.places_.push_back(places.numbers.whole(i));
    }
    const std::size_t count =
        primvar.places_.empty() ? primvar.numbers_.size() / components : primvar.places_.size();
    struct Row {
        Scope scope;
        std::string_view name;
        std::size_t count;
    };
    const std::array<Row, 5> rows{{{Scope::Corner, "faceVarying", size.corners},
                                   {Scope::Point, "vertex", size.points},
                                   {Scope::Point, "varying", size.points},
                                   {Scope::Face, "uniform", size.faces},
                                   {Scope::Constant, "constant", 1}}};
    const std::string_view said =
        attribute->interpolation.empty() ? otherwise : std::string_view(attribute->interpolation);
    const auto isIt = [&](const Row& row) { return row.name == said && row.count == count; };
    auto row = std::ranges::find_if(rows, isIt);
    // What does not say where it stands, or says it wrongly, stands where its number of values fits.
    if (row == rows.end() && attribute->interpolation.empty())
        row = std::ranges::find(rows, count, &Row::count);
    if (row == rows.end()) {
        problem = fmt::format("{} has {} values of interpolation \"{}\" for {} corners, {} points and {} faces",
                              name, count, said, size.corners, size.points, size.faces);
        return std::nullopt;
    }
    primvar.scope_ = row->scope;
    return primvar;
}

const float* UsdPrimvar::at(std::size_t corner, std::size_t point, std::size_t face) const {
    std::size_t place = scope_ == Scope::Corner  ? corner
                        : scope_ == Scope::Point ? point
                        : scope_ == Scope::Face  ? face
                                                 : 0;
    if (!places_.empty()) {
        const std::int64_t named = places_[place];
        if (named < 0) return nullptr;
        place = static_cast<std::size_t>(named);
    }
    return place < numbers_.size() / components_ ? &numbers_[place * components_] : nullptr;
}

std::string uvNameOf(const UsdPrim& mesh) {
    const auto isThere = [](const UsdAttribute& attribute) {
        return attribute.hasValue() && attribute.name.starts_with("primvars:");
    };
    if (const UsdAttribute* const st = mesh.find("primvars:st"); st != nullptr && isThere(*st)) return st->name;
    for (const UsdAttribute& attribute : mesh.attributes) {
        if (isThere(attribute) && attribute.type.starts_with("texCoord2")) return attribute.name;
    }
    // Exporters from before the type of texture coordinates.
    for (const UsdAttribute& attribute : mesh.attributes) {
        constexpr std::array<std::string_view, 5> kNames{"primvars:UVMap", "primvars:uv", "primvars:uvs",
                                                         "primvars:map1", "primvars:st_0"};
        if (isThere(attribute) && std::ranges::find(kNames, attribute.name) != kNames.end())
            return attribute.name;
    }
    return {};
}

}  // namespace hairloom
