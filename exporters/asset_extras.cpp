// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/asset_extras.h"

#include <algorithm>
#include <array>
#include <type_traits>

#include "hairloom/strands.h"

namespace hairloom {
namespace {

static_assert(attribute::kStiffness == asset::kStiffnessName);

bool isCarriedOtherwise(std::string_view name) {
    constexpr std::array kOthers{attribute::kRootTriangle, attribute::kRootBarycentric, attribute::kSelected,
                                 attribute::kHidden,       attribute::kFrozen,          attribute::kLayer,
                                 attribute::kRootUv,       attribute::kStrandId};
    return std::ranges::find(kOthers, name) != kOthers.end() ||
           name.starts_with(attribute::kBoneWeightPrefix);
}

template <class T>
struct Kind;
template <>
struct Kind<float> {
    static constexpr auto type = asset::AttributeType::float32;
    static constexpr std::uint8_t components = 1;
};
template <int N>
struct Kind<Eigen::Matrix<float, N, 1>> {
    static constexpr auto type = asset::AttributeType::float32;
    static constexpr std::uint8_t components = N;
};
template <>
struct Kind<std::int32_t> {
    static constexpr auto type = asset::AttributeType::int32;
    static constexpr std::uint8_t components = 1;
};
template <>
struct Kind<std::uint32_t> {
    static constexpr auto type = asset::AttributeType::uint32;
    static constexpr std::uint8_t components = 1;
};
template <>
struct Kind<std::uint8_t> {
    static constexpr auto type = asset::AttributeType::uint8;
    static constexpr std::uint8_t components = 1;
};

struct Sections {
    std::vector<asset::Attribute> records;
    std::vector<std::byte> values;

    template <class T>
    void add(AssetBuilder& builder, std::string_view name, std::span<const T> all) {
        values.resize((values.size() + 3) / 4 * 4);
        asset::Attribute record{};
        record.name = builder.text(name);
        record.type = Kind<T>::type;
        record.components = Kind<T>::components;
        record.firstByte = static_cast<std::uint32_t>(values.size());
        records.push_back(record);
        const auto bytes = std::as_bytes(all);
        values.insert(values.end(), bytes.begin(), bytes.end());
    }
};

}  // namespace

void addAttributes(const Groom& groom, const PreparedStrands& strands, AssetBuilder& builder) {
    Sections sections;
    if (const std::vector<Vec2f> uvs = rootUvs(groom, strands); uvs.size() == strands.strandCount())
        sections.add<Vec2f>(builder, attribute::kRootUv, uvs);
    for (const auto& [name, data] : groom.strandAttributes.all()) {
        if (isCarriedOtherwise(name)) continue;
        std::visit(
            [&](const auto& array) {
                const auto given = array.view();
                using T = std::remove_cvref_t<decltype(given[0])>;
                if (given.size() != groom.strandCount()) return;
                std::vector<T> values;
                values.reserve(strands.strandCount());
                for (const std::uint32_t source : strands.sources) values.push_back(given[source]);
                sections.add<T>(builder, name, values);
            },
            data);
    }
    const auto stiffness = groom.strandAttributes.view<float>(attribute::kStiffness);
    const auto isFactor = [](float value) { return value >= 0 && value <= runtime::kMostStiffness; };
    if (!stiffness.empty() && std::ranges::all_of(stiffness, isFactor))
        builder.needMinor(asset::kMinorOfStiffness);
    builder.add<asset::Attribute>(asset::kAttributes, sections.records);
    builder.add<std::byte>(asset::kAttributeValues, sections.values);
}

}  // namespace hairloom
