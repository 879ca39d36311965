// SPDX-License-Identifier: MIT
// Header and table of an asset: where its sections are.
#include "hairloom/asset.h"

#include <algorithm>
#include <cstring>

#include "asset/asset_error.h"

namespace hairloom::runtime {

using namespace asset;

namespace {

constexpr std::array<std::array<std::uint32_t, 256>, 8> makeTables() {
    std::array<std::array<std::uint32_t, 256>, 8> tables{};
    for (std::uint32_t byte = 0; byte < 256; ++byte) {
        std::uint32_t value = byte;
        for (int bit = 0; bit < 8; ++bit) value = (value >> 1u) ^ ((value & 1u) != 0 ? 0xedb88320u : 0u);
        tables[0][byte] = value;
    }
    for (std::size_t t = 1; t < 8; ++t) {
        for (std::size_t byte = 0; byte < 256; ++byte) {
            const std::uint32_t before = tables[t - 1][byte];
            tables[t][byte] = (before >> 8u) ^ tables[0][before & 255u];
        }
    }
    return tables;
}

std::string kindOf(const Section& section) {
    std::string kind(section.kind.data(), section.kind.size());
    for (char& c : kind) c = c >= ' ' && c <= '~' ? c : '?';
    return kind;
}

}  // namespace

/// Eight bytes at a time, by eight tables (Kounavis and Berry 2005).
std::uint32_t asset::checksum(std::span<const std::byte> bytes) {
    static constexpr auto kTables = makeTables();
    std::uint32_t crc = 0xffffffffu;
    const auto* at = reinterpret_cast<const std::uint8_t*>(bytes.data());
    std::size_t left = bytes.size();
    for (; left >= 8; left -= 8, at += 8) {
        std::uint32_t low = 0, high = 0;
        std::memcpy(&low, at, 4);
        std::memcpy(&high, at + 4, 4);
        low ^= crc;
        crc = kTables[7][low & 255u] ^ kTables[6][(low >> 8u) & 255u] ^ kTables[5][(low >> 16u) & 255u] ^
              kTables[4][low >> 24u] ^ kTables[3][high & 255u] ^ kTables[2][(high >> 8u) & 255u] ^
              kTables[1][(high >> 16u) & 255u] ^ kTables[0][high >> 24u];
    }
    for (; left > 0; --left, ++at) crc = (crc >> 8u) ^ kTables[0][(crc ^ *at) & 255u];
    return ~crc;
}

std::span<const Section> Asset::table() const {
    return {reinterpret_cast<const Section*>(bytes_.data() + sizeof(Header)), header().sections};
}

std::uint64_t Asset::placeOf(const void* record) const {
    return static_cast<std::uint64_t>(static_cast<const std::byte*>(record) - bytes_.data());
}

Asset::Result Asset::open(std::span<const std::byte> bytes) {
    const auto refuse = [](AssetError error) { return Result{std::nullopt, std::move(error)}; };
    if (reinterpret_cast<std::uintptr_t>(bytes.data()) % kAlignment != 0)
        return refuse({AssetError::Kind::misaligned, 0,
                       "the file is not at a multiple of " + number(kAlignment) + " bytes in memory"});
    if (bytes.size() < sizeof(Header))
        return refuse(
            damaged(bytes.size(), "ends after " + number(bytes.size()) + " bytes; a header has 64"));
    Asset asset;
    asset.bytes_ = bytes;
    const Header& header = asset.header();
    if (header.magic != kMagic) return refuse(damaged(0, "does not begin as a runtime asset does"));
    if (header.major != kMajor)
        return refuse(
            {header.major > kMajor ? AssetError::Kind::newer : AssetError::Kind::damaged, 8,
             "is of version " + number(header.major) + "; this library reads version " + number(kMajor)});
    if (header.checksum != checksum(bytes.first(sizeof(Header) - sizeof(std::uint32_t))))
        return refuse(damaged(60, "the header's checksum does not match"));
    if (header.headerBytes != sizeof(Header))
        return refuse(damaged(12, "has a header of " + number(header.headerBytes) + " bytes; expected 64"));
    if (header.fileBytes != bytes.size())
        return refuse(damaged(
            16, "has " + number(bytes.size()) + " bytes; its header says " + number(header.fileBytes)));
    if (header.sections > kMaxSections ||
        std::uint64_t{header.sections} * sizeof(Section) > bytes.size() - sizeof(Header))
        return refuse(damaged(24, "has no space for " + number(header.sections) + " sections"));
    if (header.tableChecksum != checksum(std::as_bytes(asset.table())))
        return refuse(damaged(sizeof(Header), "the checksum of the table of sections does not match"));
    for (const Section& section : asset.table()) {
        if (auto error = asset.takeSection(section)) return refuse(std::move(*error));
    }
    if (asset.strands.empty()) return refuse(damaged(sizeof(Header), "has no strands"));
    return {asset, {}};
}

const Section* Asset::findSection(std::string_view kind) const {
    const auto sections = table();
    const auto found = std::find_if(sections.begin(), sections.end(), [&](const Section& section) {
        return std::string_view(section.kind.data(), section.kind.size()) == kind;
    });
    return found == sections.end() ? nullptr : &*found;
}

template <class Record>
bool Asset::isSound(const Section& section, std::string_view kind, std::string& problem) const {
    if (std::string_view(section.kind.data(), section.kind.size()) != kind) return false;
    if (findSection(kind) != &section)
        problem = "appears twice";
    else if (section.recordBytes != sizeof(Record) ||
             section.bytes != std::uint64_t{section.count} * sizeof(Record))
        problem = "has " + number(section.bytes) + " bytes for " + number(section.count) + " records of " +
                  number(sizeof(Record));
    return true;
}

template <class Record>
bool Asset::take(const Section& section, std::string_view kind, std::span<const Record>& records,
                 std::string& problem) {
    if (std::string_view(section.kind.data(), section.kind.size()) != kind) return false;
    if (!records.empty())
        problem = "appears twice";
    else if (section.recordBytes != sizeof(Record) ||
             section.bytes != std::uint64_t{section.count} * sizeof(Record))
        problem = "has " + number(section.bytes) + " bytes for " + number(section.count) + " records of " +
                  number(sizeof(Record));
    else
        records = {reinterpret_cast<const Record*>(bytes_.data() + section.offset), section.count};
    return true;
}

std::optional<AssetError> Asset::takeSection(const Section& section) {
    const std::uint64_t place = placeOf(&section);
    const auto wrong = [&](const std::string& words) {
        return damaged(place, "section " + kindOf(section) + " " + words);
    };
    if (section.offset % kAlignment != 0 || section.offset > bytes_.size() ||
        section.bytes > bytes_.size() - section.offset)
        return wrong("does not lie in the file");
    std::string problem;
    const bool known =
        take(section, kStrands, strands, problem) || take(section, kResiduals, residuals, problem) ||
        take(section, kRoots, roots, problem) || take(section, kScalpVertices, scalpVertices, problem) ||
        take(section, kScalpTriangles, scalpTriangles, problem) || take(section, kBones, bones, problem) ||
        take(section, kSpheres, spheres, problem) || take(section, kRecipe, recipe, problem) ||
        take(section, kGuides, guides, problem) || take(section, kGuideHairs, guideHairs, problem) ||
        take(section, kGuideTriangles, guideTriangles, problem) ||
        take(section, kRootShifts, rootShifts, problem) ||
        take(section, kFarRootShifts, farRootShifts, problem) || take(section, kRadii, radii, problem) ||
        take(section, kLayers, layers, problem) || take(section, kStrandLayers, strandLayers, problem) ||
        take(section, kSettings, settings, problem) || take(section, kValues, values, problem) ||
        take(section, kText, texts, problem) || isSound<Attribute>(section, kAttributes, problem) ||
        isSound<std::byte>(section, kAttributeValues, problem) ||
        isSound<MeasuredLevel>(section, kLevelErrors, problem) ||
        isSound<MeasuredLevel>(section, kSeenErrors, problem) ||
        isSound<std::byte>(section, kBody, problem) || isSound<Clip>(section, kClip, problem) ||
        isSound<std::uint32_t>(section, kClipPlaces, problem) ||
        isSound<std::byte>(section, kClipFrames, problem) ||
        isSound<Material>(section, kMaterials, problem) ||
        isSound<std::uint16_t>(section, kFibreTables, problem) ||
        isSound<HairLook>(section, kHairLooks, problem) || isSound<Pose>(section, kPoses, problem) ||
        isSound<PoseDirection>(section, kPoseDirections, problem) ||
        isSound<std::uint8_t>(section, kPoseWeights, problem);
    if (!problem.empty()) return wrong(problem);
    if (!known && (section.flags & kRequired) != 0) {
        AssetError error = wrong("is needed and not known to this library");
        error.kind = AssetError::Kind::newer;
        return error;
    }
    return std::nullopt;
}

std::vector<AssetSection> Asset::sections() const {
    std::vector<AssetSection> found;
    for (const Section& section : table())
        found.push_back(
            {{section.kind.data(), section.kind.size()}, section.offset, section.bytes, section.count});
    return found;
}

std::optional<AssetError> Asset::check() const {
    for (const Section& section : table()) {
        const auto content =
            bytes_.subspan(static_cast<std::size_t>(section.offset), static_cast<std::size_t>(section.bytes));
        if (section.checksum != checksum(content))
            return damaged(section.offset, "the checksum of section " + kindOf(section) + " does not match");
    }
    if (auto problem = checkContent()) return problem;
    return checkClipFrames();
}

std::array<std::uint64_t, 3> Asset::identity() const {
    return {reinterpret_cast<std::uintptr_t>(bytes_.data()), bytes_.size(),
            std::uint64_t{header().checksum} << 32u | header().tableChecksum};
}

}  // namespace hairloom::runtime
