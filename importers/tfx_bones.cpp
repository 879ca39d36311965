// SPDX-License-Identifier: GPL-3.0-or-later
// After TressFXAsset::LoadBoneData of AMD's TressFX 4.1: bones (index, length of the name with its NUL,
// name), then strands (index, four times bone and weight), all of them 32 bits, little-endian.
#include "importers/tfx_bones.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "core/base/file.h"
#include "core/base/utf8.h"

namespace hairloom {
namespace {

constexpr std::int32_t kMaxNameBytes = 128;  ///< of the loader, NUL included
constexpr std::size_t kMaxBonesInUse = 256;  ///< so that a small file makes no large groom

struct Influence {
    std::int32_t bone;
    float weight;
};
struct StrandRecord {
    std::int32_t strand;
    std::array<Influence, 4> influences;
};
static_assert(sizeof(StrandRecord) == 36);

Result<std::int32_t> readCount(ByteReader& reader, std::string_view what, std::uint64_t bytesEach,
                               const std::string& file) {
    const Byte place{reader.position()};
    auto count = reader.read<std::int32_t>(what);
    if (!count) return count;
    const std::uint64_t most = reader.remaining() / bytesEach;
    if (*count < 1 || static_cast<std::uint64_t>(*count) > most)
        return failIn(
            file, place, fmt::format("has {} {}", *count, what),
            most > 0 ? fmt::format("expected 1 to {}, as the file's {} bytes can hold", most, reader.size())
                     : fmt::format("the file has {} bytes and holds none", reader.size()));
    return count;
}

Result<std::vector<std::string>> readNames(ByteReader& reader, const std::string& file) {
    const auto count = readCount(reader, "bones", 9, file);
    if (!count) return tl::unexpected(count.error());
    std::vector<std::string> names;
    for (std::int32_t bone = 0; bone < *count; ++bone) {
        const auto index = reader.read<std::int32_t>("a bone's index");
        if (!index) return tl::unexpected(index.error());
        const Byte place{reader.position()};
        const auto length = reader.read<std::int32_t>("the length of a bone's name");
        if (!length) return tl::unexpected(length.error());
        if (*length < 1 || *length > kMaxNameBytes)
            return failIn(file, place, fmt::format("the name of bone {} has {} bytes", bone, *length),
                          fmt::format("expected 1 to {}, its NUL included", kMaxNameBytes));
        const auto letters = reader.readArray<char>(static_cast<std::uint64_t>(*length), "a bone's name");
        if (!letters) return tl::unexpected(letters.error());
        const auto end = std::ranges::find(*letters, '\0');
        names.push_back(cleanUtf8(std::string(letters->begin(), end)));
    }
    return names;
}

Status checkInfluence(const Influence& influence, std::size_t bones, Byte place, const std::string& file) {
    // Exporters fill unused places with any number, and loaders read names by it.
    if (influence.bone < 0 || static_cast<std::size_t>(influence.bone) >= bones)
        return failIn(file, place, fmt::format("refers to bone {}", influence.bone),
                      fmt::format("expected 0 to {}", bones - 1));
    if (!std::isfinite(influence.weight) || influence.weight < 0)
        return failIn(file, place, fmt::format("has the weight {}", influence.weight), "expected 0 or more");
    return {};
}

}  // namespace

Status readTfxBones(const std::string& file, std::span<const std::byte> bytes, RawStrands& strands) {
    ByteReader reader(file, bytes);
    const auto names = readNames(reader, file);
    if (!names) return tl::unexpected(names.error());
    const std::uint64_t counted = reader.position();
    const auto count = readCount(reader, "strands", sizeof(StrandRecord), file);
    if (!count) return tl::unexpected(count.error());
    const std::size_t all = strands.offsets.size() - 1;
    if (static_cast<std::size_t>(*count) > all)
        return failIn(file, Byte{counted}, fmt::format("has bones of {} strands", *count),
                      fmt::format("the strands beside it are {}", all));
    const std::uint64_t first = reader.position();
    const auto records = reader.readArray<StrandRecord>(static_cast<std::uint64_t>(*count), "strands");
    if (!records) return tl::unexpected(records.error());
    std::vector<bool> isUsed(names->size());
    for (std::size_t s = 0; s < records->size(); ++s) {
        for (const Influence& influence : (*records)[s].influences) {
            const Byte place{first + s * sizeof(StrandRecord)};
            if (auto status = checkInfluence(influence, names->size(), place, file); !status) return status;
            if (influence.weight > 0) isUsed[static_cast<std::size_t>(influence.bone)] = true;
        }
    }
    const auto used = static_cast<std::size_t>(std::ranges::count(isUsed, true));
    if (used > kMaxBonesInUse)
        return failIn(file, Byte{0}, fmt::format("{} bones move strands", used),
                      fmt::format("expected at most {}", kMaxBonesInUse));
    std::vector<RawAttribute> attributes;
    for (std::size_t bone = 0; bone < names->size(); ++bone) {
        if (!isUsed[bone]) continue;
        RawAttribute weights;
        weights.name = std::string(attribute::kBoneWeightPrefix) + (*names)[bone];
        weights.numbers.resize(all);
        for (std::size_t s = 0; s < all; ++s) {
            for (const Influence& influence : (*records)[std::min(s, records->size() - 1)].influences) {
                if (static_cast<std::size_t>(influence.bone) == bone) weights.numbers[s] += influence.weight;
            }
        }
        if (std::ranges::find(attributes, weights.name, &RawAttribute::name) != attributes.end())
            return failIn(file, {}, fmt::format("two bones are called '{}'", (*names)[bone]),
                          "expected names that differ");
        attributes.push_back(std::move(weights));
    }
    std::ranges::move(attributes, std::back_inserter(strands.attributes));
    return {};
}

}  // namespace hairloom
