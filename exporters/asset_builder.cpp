// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/asset_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

#include "hairloom/strands.h"

namespace hairloom {
namespace {

using Grid = std::array<std::int64_t, 3>;

constexpr std::int64_t kLargestCoordinate = std::int64_t{1} << 30;

/// Rounded to the grid; nothing where a coordinate leaves it.
bool onGrid(std::span<const Vec3f> points, std::uint32_t bits, std::vector<Grid>& grid) {
    grid.resize(points.size());
    for (std::size_t p = 0; p < points.size(); ++p) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double at = std::ldexp(double{points[p][static_cast<int>(axis)]}, static_cast<int>(bits));
            if (!(std::abs(at) < static_cast<double>(kLargestCoordinate))) return false;
            grid[p][axis] = std::llround(at);
        }
    }
    return true;
}

/// How far each point after the second lies from where the segment before it would lead once more.
void toResiduals(std::vector<Grid>& grid) {
    for (std::size_t p = grid.size() - 1; p >= 2; --p) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            grid[p][axis] -= 2 * grid[p - 1][axis] - grid[p - 2][axis];
    }
}

bool fits(const std::vector<Grid>& residuals, std::uint8_t bytes) {
    const std::int64_t most = bytes == 4 ? 511 : bytes == 6 ? 32767 : 2147483647;
    for (std::size_t p = 2; p < residuals.size(); ++p) {
        for (const std::int64_t value : residuals[p]) {
            if (value > most || value < -most) return false;
        }
    }
    return true;
}

template <class T>
void append(std::vector<std::byte>& bytes, const T& value) {
    const auto added = std::as_bytes(std::span(&value, 1));
    bytes.insert(bytes.end(), added.begin(), added.end());
}

void pack(const Grid& residual, std::uint8_t bytes, std::vector<std::byte>& packed) {
    if (bytes == 4) {
        std::uint32_t bits = 0;
        for (std::uint32_t axis = 0; axis < 3; ++axis)
            bits |= (static_cast<std::uint32_t>(residual[axis]) & 1023u) << (10 * axis);
        return append(packed, bits);
    }
    for (const std::int64_t value : residual) {
        if (bytes == 6)
            append(packed, static_cast<std::int16_t>(value));
        else
            append(packed, static_cast<std::int32_t>(value));
    }
}

/// The fewest bytes that the coarsest grid takes, then the finest grid that these bytes have room for.
std::optional<asset::Strand> encode(std::span<const Vec3f> points, std::vector<std::byte>& packed) {
    std::vector<Grid> grid;
    for (const std::uint8_t bytes : {std::uint8_t{4}, std::uint8_t{6}, std::uint8_t{12}}) {
        for (std::uint32_t bits = asset::kMaxGridBits; bits >= asset::kMinGridBits; --bits) {
            if (!onGrid(points, bits, grid)) continue;
            toResiduals(grid);
            if (!fits(grid, bytes)) continue;
            asset::Strand strand{};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                strand.root[axis] = static_cast<std::int32_t>(grid[0][axis]);
                strand.first[axis] = static_cast<std::int32_t>(grid[1][axis] - grid[0][axis]);
            }
            strand.points = static_cast<std::uint16_t>(points.size());
            strand.gridBits = static_cast<std::uint8_t>(bits);
            strand.residualBytes = bytes;
            for (std::size_t p = 2; p < grid.size(); ++p) pack(grid[p], bytes, packed);
            return strand;
        }
    }
    return std::nullopt;
}

}  // namespace

Result<AssetStrands> encodeStrands(std::span<const std::uint32_t> offsets, std::span<const Vec3f> positions) {
    AssetStrands encoded;
    for (std::size_t s = 0; s + 1 < offsets.size(); ++s) {
        const auto strand =
            encode(positions.subspan(offsets[s], offsets[s + 1] - offsets[s]), encoded.residuals);
        if (!strand)
            return fail(fmt::format("strand {} is more than 32 km from the origin", s),
                        "expected hair near a head");
        encoded.strands.push_back(*strand);
    }
    return encoded;
}

asset::Text AssetBuilder::text(std::string_view words) {
    // Names of choices come again and again.
    const auto found = std::search(text_.begin(), text_.end(), words.begin(), words.end());
    const auto at = static_cast<std::uint32_t>(found - text_.begin());
    if (found == text_.end()) text_.insert(text_.end(), words.begin(), words.end());
    return {at, static_cast<std::uint32_t>(words.size())};
}

asset::Setting AssetBuilder::startSetting(std::string_view group, const runtime::FieldInfo& field) {
    const std::string full = fmt::format("{}.{}", group, field.name);
    const asset::Text name = text(full);
    asset::Setting setting{};
    setting.name = name.at;
    setting.nameBytes = static_cast<std::uint16_t>(name.bytes);
    setting.kind = field.kind == runtime::FieldKind::Ramp     ? asset::ValueKind::ramp
                   : field.kind == runtime::FieldKind::Seed   ? asset::ValueKind::seed
                   : field.kind == runtime::FieldKind::Choice ? asset::ValueKind::choice
                                                              : asset::ValueKind::numbers;
    setting.firstValue = static_cast<std::uint32_t>(values_.size());
    return setting;
}

void AssetBuilder::finishSetting(asset::Setting setting) {
    setting.count = static_cast<std::uint8_t>(values_.size() - setting.firstValue);
    settings_.push_back(setting);
}

void AssetBuilder::addBytes(std::string_view kind, std::span<const std::byte> bytes, std::size_t recordBytes,
                            std::size_t count, std::uint16_t flags) {
    Part part;
    std::copy_n(kind.begin(), 4, part.section.kind.begin());
    part.section.recordBytes = static_cast<std::uint16_t>(recordBytes);
    part.section.flags = flags;
    part.section.bytes = bytes.size();
    part.section.count = static_cast<std::uint32_t>(count);
    part.section.checksum = asset::checksum(bytes);
    part.bytes.assign(bytes.begin(), bytes.end());
    parts_.push_back(std::move(part));
}

std::vector<std::byte> AssetBuilder::finish(const Box3f& bounds, std::uint32_t points) {
    add<asset::Setting>(asset::kSettings, settings_);
    add<double>(asset::kValues, values_);
    add<char>(asset::kText, text_);
    asset::Header header{};
    header.magic = asset::kMagic;
    header.major = asset::kMajor;
    const auto has = [&](std::string_view kind) {
        return std::ranges::any_of(parts_, [&](const Part& part) {
            return std::string_view(part.section.kind.data(), part.section.kind.size()) == kind;
        });
    };
    header.minor = has(asset::kPoses)       ? asset::kMinorOfPoses
                   : has(asset::kMaterials) ? asset::kMinorOfMaterials
                   : has(asset::kClip)      ? asset::kMinorOfClips
                                            : asset::kMinor;
    header.minor = std::max(header.minor, needed_);
    header.headerBytes = sizeof header;
    header.sections = static_cast<std::uint32_t>(parts_.size());
    for (std::size_t axis = 0; axis < 3; ++axis) {
        header.boundsMin[axis] = bounds.min()[static_cast<int>(axis)];
        header.boundsMax[axis] = bounds.max()[static_cast<int>(axis)];
    }
    header.points = points;
    std::vector<asset::Section> table;
    std::uint64_t at = sizeof header + parts_.size() * sizeof(asset::Section);
    const auto align = [](std::uint64_t place) {
        return (place + asset::kAlignment - 1) / asset::kAlignment * asset::kAlignment;
    };
    for (Part& part : parts_) {
        part.section.offset = align(at);
        at = part.section.offset + part.section.bytes;
        table.push_back(part.section);
    }
    header.fileBytes = at;
    header.tableChecksum = asset::checksum(std::as_bytes(std::span(table)));
    header.checksum = asset::checksum(std::as_bytes(std::span(&header, 1)).first(sizeof header - 4));
    std::vector<std::byte> bytes(static_cast<std::size_t>(at));
    std::memcpy(bytes.data(), &header, sizeof header);
    std::memcpy(bytes.data() + sizeof header, table.data(), table.size() * sizeof(asset::Section));
    for (const Part& part : parts_)
        std::ranges::copy(part.bytes, bytes.begin() + static_cast<std::ptrdiff_t>(part.section.offset));
    return bytes;
}

}  // namespace hairloom
