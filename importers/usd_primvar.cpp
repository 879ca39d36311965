// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/usd_primvar.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace hairloom {

std::optional<CornerValues> readPrimvar(const UsdPrim& mesh, std::string_view name, std::uint32_t components,
                                        double time, const MeshCounts& counts, std::string& problem) {
    const UsdAttribute* const attribute = mesh.find(name);
    if (attribute == nullptr || !attribute->hasValue()) return std::nullopt;
    UsdValue value = valueAt(*attribute, time);
    if (value.numbers.empty() || value.components != components) return std::nullopt;
    std::vector<std::int64_t> places;
    if (const UsdAttribute* const indices = mesh.find(std::string(name) + ":indices")) {
        const UsdValue given = valueAt(*indices, time);
        for (std::size_t i = 0; i < given.numbers.size(); ++i) places.push_back(given.numbers.whole(i));
    }
    using Scope = CornerValues::Scope;
    const std::string& said = attribute->interpolation;
    std::optional<Scope> scope;
    if (said == "faceVarying") scope = Scope::Corner;
    if (said == "vertex" || said == "varying") scope = Scope::Point;
    if (said == "uniform") scope = Scope::Face;
    if (said == "constant") scope = Scope::Constant;
    auto values = CornerValues::make(std::move(value.numbers).floats(), components, std::move(places), scope,
                                     counts, problem);
    if (!problem.empty()) problem = fmt::format("{} ({}): {}", name, said.empty() ? "-" : said, problem);
    return values;
}

std::string uvNameOf(const UsdPrim& mesh) {
    const auto isThere = [](const UsdAttribute& attribute) {
        return attribute.hasValue() && attribute.name.starts_with("primvars:");
    };
    if (const UsdAttribute* const st = mesh.find("primvars:st"); st != nullptr && isThere(*st))
        return st->name;
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
