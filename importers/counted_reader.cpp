// SPDX-License-Identifier: GPL-3.0-or-later
// Hair as those who reconstruct it keep it: numbers of strands and points, then coordinates, without a header
// that names the format (.data, .bin, also .hair). What a file is follows from its size: only one of the
// layouts uses up exactly all of its bytes.

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include "core/base/file.h"
#include "importers/raw_strands.h"

namespace hairloom {
namespace {

/// Where the counts of points stand. All numbers are 32 bits wide; the number of strands comes first.
enum class Counts : std::uint8_t {
    BeforeEach,         ///< of each strand, before its points
    Together,           ///< of all strands, then all points
    TogetherWithTotal,  ///< the number of all points, the counts of all strands, then all points
    OneForAll,          ///< one count, then all points
};

struct Layout {
    Counts counts;
    std::uint32_t numbers;  ///< of each point, three of them its position
};

constexpr std::array kCounts{Counts::BeforeEach, Counts::Together, Counts::TogetherWithTotal,
                             Counts::OneForAll};
/// Position; position, direction and label; position and a value; position and direction.
constexpr std::array<std::uint32_t, 4> kNumbers{3, 7, 4, 6};

std::uint32_t wordAt(std::span<const std::byte> bytes, std::uint64_t at) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + at, sizeof word);
    return word;
}

/// Calls `strand(first byte of its points, number of points)` for each strand, as far as the bytes go.
/// Returns the byte that all of them end at, or nothing where they go beyond the end.
template <class Call>
std::optional<std::uint64_t> walk(std::span<const std::byte> bytes, const Layout& layout, Call strand) {
    const std::uint64_t size = bytes.size(), point = 4 * std::uint64_t{layout.numbers};
    if (size < 12) return std::nullopt;
    const std::uint64_t strands = wordAt(bytes, 0);
    if (strands == 0 || strands > size / 4) return std::nullopt;
    const bool hasTable = layout.counts == Counts::Together || layout.counts == Counts::TogetherWithTotal;
    const std::uint64_t table = layout.counts == Counts::TogetherWithTotal ? 8 : 4;
    std::uint64_t at = hasTable ? table + 4 * strands : layout.counts == Counts::BeforeEach ? 4 : 8;
    if (at > size) return std::nullopt;
    for (std::uint64_t s = 0; s < strands; ++s) {
        if (layout.counts == Counts::BeforeEach) {
            if (size - at < 4) return std::nullopt;
            at += 4;
        }
        const std::uint32_t count = wordAt(bytes, layout.counts == Counts::BeforeEach ? at - 4
                                                  : hasTable                          ? table + 4 * s
                                                                                      : 4);
        if (count > (size - at) / point) return std::nullopt;
        strand(at, count);
        at += count * point;
    }
    return at;
}

bool isPlausible(std::span<const std::byte> bytes, std::uint64_t at, std::uint32_t numbers,
                 std::uint32_t count) {
    constexpr float kFar = 1e7f;
    for (std::uint32_t i = 0; i < count; ++i) {
        std::array<float, 3> p{};
        std::memcpy(p.data(), bytes.data() + at + 4 * std::uint64_t{numbers} * i, sizeof p);
        if (!(std::abs(p[0]) < kFar && std::abs(p[1]) < kFar && std::abs(p[2]) < kFar)) return false;
    }
    return true;
}

/// The layout that uses up all bytes, and whose points are mostly such.
std::optional<Layout> layoutOf(std::span<const std::byte> bytes) {
    for (const std::uint32_t numbers : kNumbers) {
        for (const Counts counts : kCounts) {
            const Layout layout{counts, numbers};
            std::uint64_t strands = 0, plausible = 0, points = 0;
            const auto end = walk(bytes, layout, [&](std::uint64_t at, std::uint32_t count) {
                ++strands;
                plausible += isPlausible(bytes, at, numbers, count) ? 1 : 0;
                points += count;
            });
            if (end == bytes.size() && points > 0 && 2 * plausible > strands) return layout;
        }
    }
    return std::nullopt;
}

/// The layout that a file was written in which then was cut or added to: its first strands are plain.
std::optional<Layout> damagedLayoutOf(std::span<const std::byte> bytes) {
    constexpr std::uint64_t kEnough = 2;
    constexpr std::uint32_t kMostOfPlain = 4096;
    for (const std::uint32_t numbers : kNumbers) {
        const Layout layout{Counts::BeforeEach, numbers};
        std::uint64_t plain = 0;
        bool isPlain = true;
        walk(bytes, layout, [&](std::uint64_t at, std::uint32_t count) {
            isPlain =
                isPlain && count >= 2 && count <= kMostOfPlain && isPlausible(bytes, at, numbers, count);
            plain += isPlain ? 1 : 0;
        });
        if (plain >= kEnough) return layout;
    }
    return std::nullopt;
}

bool isCounted(std::span<const std::byte> bytes) {
    return layoutOf(bytes) || damagedLayoutOf(bytes);
}

std::string wordsFor(const Layout& layout) {
    switch (layout.numbers) {
        case 7:
            return "position, direction and label";
        case 6:
            return "position and direction";
        case 4:
            return "position and a value";
        default:
            return "position";
    }
}

std::string wordsFor(Counts counts) {
    switch (counts) {
        case Counts::BeforeEach:
            return "counts before each strand";
        case Counts::Together:
        case Counts::TogetherWithTotal:
            return "all counts first";
        case Counts::OneForAll:
            break;
    }
    return "one count for all strands";
}

RawAttribute numbersOfPoints(std::string name, std::uint32_t components, std::size_t points) {
    RawAttribute attribute;
    attribute.name = std::move(name);
    attribute.perPoint = true;
    attribute.components = components;
    attribute.numbers.reserve(points * components);
    return attribute;
}

Result<RawStrands> readCounted(const std::string& file, std::vector<std::byte>&& bytes,
                               const StrandImportOptions&) {
    const auto layout = layoutOf(bytes);
    if (!layout) {
        const auto damaged = damagedLayoutOf(bytes).value_or(Layout{Counts::BeforeEach, 3});
        std::uint64_t strands = 0, end = 4;
        walk(bytes, damaged, [&](std::uint64_t at, std::uint32_t count) {
            ++strands;
            end = at + 4 * std::uint64_t{damaged.numbers} * count;
        });
        return failIn(file, Byte{end},
                      fmt::format("announces {} strands with {} a point; {} of them end here, of {} bytes",
                                  wordAt(bytes, 0), wordsFor(damaged), strands, bytes.size()),
                      "expected as many strands and points as it announces, and nothing behind them");
    }
    std::uint64_t points = 0;
    walk(bytes, *layout, [&](std::uint64_t, std::uint32_t count) { points += count; });
    if (points > std::numeric_limits<std::uint32_t>::max())
        return failIn(file, {}, fmt::format("has {} points", points), "expected at most 4,294,967,295");
    RawStrands raw;
    raw.format = "Counted strands";
    raw.rootFirst = false;
    raw.positions.reserve(points);
    RawAttribute directions = numbersOfPoints("direction", 3, layout->numbers >= 6 ? points : 0);
    RawAttribute values =
        numbersOfPoints(layout->numbers == 7 ? "label" : "value", 1, layout->numbers % 3 == 1 ? points : 0);
    std::vector<float> point(layout->numbers);
    walk(bytes, *layout, [&](std::uint64_t at, std::uint32_t count) {
        for (std::uint32_t i = 0; i < count; ++i, at += 4 * point.size()) {
            std::memcpy(point.data(), bytes.data() + at, 4 * point.size());
            raw.positions.emplace_back(point[0], point[1], point[2]);
            if (point.size() >= 6)
                directions.numbers.insert(directions.numbers.end(), &point[3], &point[3] + 3);
            if (point.size() % 3 == 1) values.numbers.push_back(point.back());
        }
        raw.offsets.push_back(static_cast<std::uint32_t>(raw.positions.size()));
    });
    for (RawAttribute* attribute : {&directions, &values}) {
        if (!attribute->numbers.empty()) raw.attributes.push_back(std::move(*attribute));
    }
    raw.warnings.push_back(fileNote(fmt::format("the file names no format; its size fits {} a point, {}",
                                                wordsFor(*layout), wordsFor(layout->counts)),
                                    "layout"));
    std::vector<std::byte>().swap(bytes);
    return raw;
}

}  // namespace

StrandReader countedReader() {
    return {{"counted strands .data, .bin", {"data", "bin"}}, Recognition::Structure, isCounted, readCounted};
}

}  // namespace hairloom
