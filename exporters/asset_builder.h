// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Puts a runtime asset together (hairloom/asset_format.h).

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "core/base/math.h"
#include "core/base/result.h"
#include "hairloom/asset_format.h"
#include "hairloom/field.h"

namespace hairloom {

namespace asset = runtime::asset;

/// The strands of an asset, each on the finest grid that its points fit in few bytes.
struct AssetStrands {
    std::vector<asset::Strand> strands;
    std::vector<std::byte> residuals;
};
/// `offsets` as in Groom, strands of 2 to runtime::kMaxPoints finite points. Error: a coordinate of more than
/// 32 km.
Result<AssetStrands> encodeStrands(std::span<const std::uint32_t> offsets, std::span<const Vec3f> positions);

class AssetBuilder {
  public:
    /// A section of these records; none where there are no records. `flags`: 0, or asset::kRequired.
    template <class Record>
    void add(std::string_view kind, std::span<const Record> records, std::uint16_t flags = 0) {
        if (!records.empty()) addBytes(kind, std::as_bytes(records), sizeof(Record), records.size(), flags);
    }
    asset::Text text(std::string_view words);
    /// The file states at least this minor version, which its sections alone do not tell.
    void needMinor(std::uint16_t minor) { needed_ = std::max(needed_, minor); }

    /// "GROUP.NAME" of each of the fields.
    template <class S>
    void addSettings(std::string_view group, const S& settings) {
        for (const runtime::Field<S>& field : fieldsOf(settings)) {
            const asset::Setting setting = startSetting(group, field);
            if (field.kind == runtime::FieldKind::Ramp) {
                for (const runtime::Ramp::Key& key : runtime::member<runtime::Ramp>(settings, field).inUse())
                    values_.insert(values_.end(), {double{key.at}, double{key.value}});
            } else if (field.kind == runtime::FieldKind::Seed) {
                const auto seed = runtime::member<std::uint64_t>(settings, field);
                values_.insert(values_.end(),
                               {static_cast<double>(seed & 0xffffffffu), static_cast<double>(seed >> 32u)});
            } else if (field.kind == runtime::FieldKind::Choice) {
                const asset::Text name =
                    text(field.choices[static_cast<std::size_t>(field.get(settings, 0))]);
                values_.insert(values_.end(),
                               {static_cast<double>(name.at), static_cast<double>(name.bytes)});
            } else {
                for (std::uint32_t c = 0; c < field.components(); ++c)
                    values_.push_back(field.get(settings, c));
            }
            finishSetting(setting);
        }
    }

    /// The whole file. `bounds` are those of `points` points.
    std::vector<std::byte> finish(const Box3f& bounds, std::uint32_t points);

  private:
    void addBytes(std::string_view kind, std::span<const std::byte> bytes, std::size_t recordBytes,
                  std::size_t count, std::uint16_t flags);
    asset::Setting startSetting(std::string_view group, const runtime::FieldInfo& field);
    void finishSetting(asset::Setting setting);

    struct Part {
        asset::Section section;
        std::vector<std::byte> bytes;
    };
    std::vector<Part> parts_;
    std::vector<char> text_;
    std::vector<asset::Setting> settings_;
    std::vector<double> values_;
    std::uint16_t needed_ = asset::kMinor;
};

}  // namespace hairloom
