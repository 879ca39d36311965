// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Named, typed values per strand or per point.

#include <map>
#include <string>
#include <string_view>
#include <variant>

#include "core/base/math.h"
#include "core/base/result.h"
#include "core/groom/cow_array.h"

namespace hairloom {

/// The types an attribute may have. The order is part of the project file format: append only.
using AttributeData = std::variant<CowArray<float>, CowArray<Vec2f>, CowArray<Vec3f>, CowArray<Vec4f>,
                                   CowArray<std::int32_t>, CowArray<std::uint32_t>, CowArray<std::uint8_t>>;

/// "float", "float2", "float3", "float4", "int32", "uint32", "uint8"; the same names stand in project files.
std::string_view typeName(const AttributeData& data);
/// An empty array of the type of that name. Error: unknown name, listing those there are.
Result<AttributeData> emptyOfType(std::string_view name);
std::size_t sizeOf(const AttributeData& data);
Version versionOf(const AttributeData& data);

/// The names that Hairloom itself gives meaning to. Others are kept, saved and passed through.
namespace attribute {
// Per point
inline constexpr std::string_view kPosition = "position";   ///< float3, metres, in the scalp's rest space
inline constexpr std::string_view kRadius = "radius";       ///< float, metres, half the fibre's diameter
inline constexpr std::string_view kPointColour = "colour";  ///< float3, linear RGB in [0, 1]
inline constexpr std::string_view kBasePosition = "base_position";  ///< position below all operators
inline constexpr std::string_view kTransparency = "transparency";   ///< float in [0, 1], 0 is opaque
// Per strand
inline constexpr std::string_view kRootTriangle = "root_triangle";  ///< uint32, triangle of the scalp mesh
inline constexpr std::string_view kRootBarycentric = "root_barycentric";  ///< float3, ≥ 0, sum 1
inline constexpr std::string_view kRootUv = "root_uv";                    ///< float2
inline constexpr std::string_view kGroup = "group";          ///< uint32, index into Groom::groupNames
inline constexpr std::string_view kGuide = "guide";          ///< uint8, 1 for strands that are simulated
inline constexpr std::string_view kFrozen = "frozen";        ///< uint8, 1 where brushes must not touch
inline constexpr std::string_view kSelected = "selected";    ///< uint8, 1 where tools work, if any is
inline constexpr std::string_view kHidden = "hidden";        ///< uint8, 1 where nothing is shown or touched
inline constexpr std::string_view kLayer = "layer";          ///< uint32, index into Groom::layers
inline constexpr std::string_view kStrandColour = "colour";  ///< float3, linear RGB in [0, 1]
inline constexpr std::string_view kDye = "dye";          ///< float in [0, 1], how much of the material's dye
inline constexpr std::string_view kMelanin = "melanin";  ///< float in [0, 8], times the material's melanin
/// float in [0, runtime::kMostStiffness], times the bending and torsional stiffness of the settings
inline constexpr std::string_view kStiffness = "stiffness";
/// float, of strands: how much the bone of the name behind it moves the root.
inline constexpr std::string_view kBoneWeightPrefix = "bone_weight_";
inline constexpr std::string_view kStrandId = "id";  ///< uint32, kept while strands come and go
}  // namespace attribute

inline constexpr std::uint32_t kPaintedMasks = 4;  ///< of operators and poses
/// "mask.1": float per strand in [0, 1]; 0 where nothing was painted. `number` counts from 1.
std::string maskAttribute(std::uint32_t number);

/// Attributes of one domain; every array has the domain's element count (validate() checks).
class AttributeSet {
  public:
    bool has(std::string_view name) const { return arrays_.find(name) != arrays_.end(); }
    bool empty() const { return arrays_.empty(); }

    /// The values, or an empty span when the name is absent or of another type.
    template <class T>
    std::span<const T> view(std::string_view name) const {
        const auto found = arrays_.find(name);
        if (found == arrays_.end()) return {};
        const auto* array = std::get_if<CowArray<T>>(&found->second);
        return array ? array->view() : std::span<const T>();
    }

    /// The values for writing; an absent attribute, or one of another type, is made anew and empty.
    template <class T>
    std::vector<T>& edit(std::string_view name) {
        auto found = arrays_.find(name);
        if (found == arrays_.end()) found = arrays_.emplace(std::string(name), CowArray<T>()).first;
        if (!std::holds_alternative<CowArray<T>>(found->second)) found->second = CowArray<T>();
        return std::get<CowArray<T>>(found->second).edit();
    }

    template <class T>
    void set(std::string_view name, std::vector<T> values) {
        arrays_.insert_or_assign(std::string(name), AttributeData(CowArray<T>(std::move(values))));
    }
    void set(std::string_view name, AttributeData data) {
        arrays_.insert_or_assign(std::string(name), std::move(data));
    }
    void erase(std::string_view name) {
        if (const auto found = arrays_.find(name); found != arrays_.end()) arrays_.erase(found);
    }

    Version version(std::string_view name) const {
        const auto found = arrays_.find(name);
        return found == arrays_.end() ? 0 : versionOf(found->second);
    }

    /// In order of name.
    const std::map<std::string, AttributeData, std::less<>>& all() const { return arrays_; }

  private:
    std::map<std::string, AttributeData, std::less<>> arrays_;
};

}  // namespace hairloom
