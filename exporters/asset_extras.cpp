// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/asset_extras.h"

#include <algorithm>
#include <array>
#include <memory>
#include <type_traits>

#include "core/base/parallel.h"
#include "hairloom/hairloom.h"

namespace hairloom {
namespace {

/// Measuring them takes 13 µs a point on one core.
constexpr std::size_t kMostMeasuredPoints = 500'000;

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

void runPieces(void*, std::size_t count, std::size_t grain, void (*body)(void*, std::size_t, std::size_t),
               void* context) {
    parallelFor(count, grain, [&](std::size_t begin, std::size_t end) { body(context, begin, end); });
}

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
    builder.add<asset::Attribute>(asset::kAttributes, sections.records);
    builder.add<std::byte>(asset::kAttributeValues, sections.values);
}

std::vector<asset::MeasuredLevel> measureLevels(std::span<const std::byte> file) {
    hl_asset opened;
    hl_asset_info info;
    hl_instance* made = nullptr;
    const hl_jobs jobs{nullptr, runPieces};
    if (hl_asset_open(&opened, file.data(), file.size(), nullptr) != HL_OK ||
        hl_asset_describe(&opened, &info, nullptr) != HL_OK || info.guide_points > kMostMeasuredPoints ||
        hl_instance_make(&opened, HL_LEVELS, &jobs, &made, nullptr) != HL_OK)
        return {};
    const std::unique_ptr<hl_instance, void (*)(hl_instance*)> hair(made, hl_instance_free);
    std::vector<asset::MeasuredLevel> levels;
    for (std::uint32_t number = 0; number < HL_LEVEL_COUNT; ++number) {
        hl_level level;
        if (hl_instance_level(hair.get(), number, &level, nullptr) != HL_OK) return {};
        levels.push_back({level.error_still, level.error_head, level.error_wind, 0});
    }
    return levels;
}

}  // namespace hairloom
