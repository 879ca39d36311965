// SPDX-License-Identifier: GPL-3.0-or-later
// Curves of Mitsuba: text with a point a line, its width's half behind it where there is one, and an empty
// line between strands; or "BINARY_HAIR", where an infinite number stands before the first point of each
// strand.

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "core/base/file.h"
#include "importers/obj_text.h"
#include "importers/points_per_strand.h"
#include "importers/raw_strands.h"

namespace hairloom {
namespace {

constexpr std::string_view kBinary = "BINARY_HAIR";
constexpr std::size_t kMaxPoints = std::numeric_limits<std::uint32_t>::max();

std::string_view textOf(std::span<const std::byte> bytes) {
    const void* const characters = bytes.data();
    return {static_cast<const char*>(characters), bytes.size()};
}

/// Takes a line without its end off the text.
std::string_view takeLine(std::string_view& text) {
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    const std::string_view line = text.substr(0, end);
    const bool isPair = end + 1 < text.size() && text[end] == '\r' && text[end + 1] == '\n';
    text.remove_prefix(std::min(text.size(), end + (isPair ? 2 : 1)));
    return line;
}

/// Three or four numbers: 3 or 4. 0 for an empty line, −1 for any other.
int numbersIn(std::string_view line, std::array<double, 4>& numbers) {
    int count = 0;
    for (std::string_view word = takeWord(line); !word.empty(); word = takeWord(line), ++count) {
        const auto number = count < 4 ? parseNumber(word) : std::nullopt;
        if (!number) return -1;
        numbers[static_cast<std::size_t>(count)] = *number;
    }
    return count == 0 || count == 3 || count == 4 ? count : -1;
}

/// Lines of numbers alone, as far as the file's beginning shows.
bool isMitsuba(std::span<const std::byte> bytes) {
    std::string_view text = textOf(bytes);
    if (text.starts_with(kBinary)) return true;
    constexpr std::size_t kBeginning = 65536;
    const bool isWhole = text.size() <= kBeginning;
    text = text.substr(0, kBeginning);
    std::size_t points = 0;
    std::array<double, 4> numbers{};
    while (!text.empty()) {
        const std::string_view line = takeLine(text);
        if (text.empty() && !isWhole) break;
        if (trimmed(line).starts_with('#')) continue;
        const int count = numbersIn(line, numbers);
        if (count < 0) return false;
        points += count > 0 ? 1 : 0;
    }
    return points >= 2;
}

Result<RawStrands> readText(const std::string& file, std::string_view text, std::uint32_t asked) {
    RawStrands raw;
    raw.format = "Mitsuba hair";
    std::vector<float> widths;
    std::array<double, 4> numbers{};
    bool hasGaps = false;
    const bool hasOpenEnd = !text.empty() && text.back() != '\n' && text.back() != '\r';
    for (std::uint64_t line = 1; !text.empty(); ++line) {
        const std::string_view words = takeLine(text);
        if (trimmed(words).starts_with('#')) continue;
        const int count = numbersIn(words, numbers);
        if (count < 0)
            return failIn(file, Line{line}, fmt::format("'{}' is no point", shortened(words)),
                          "expected three or four numbers, or an empty line between strands");
        if (count == 0) {
            hasGaps = hasGaps || !raw.positions.empty();
            if (raw.positions.size() > raw.offsets.back())
                raw.offsets.push_back(static_cast<std::uint32_t>(raw.positions.size()));
            continue;
        }
        if (raw.positions.size() == kMaxPoints)
            return failIn(file, Line{line}, "more than 4,294,967,295 points", "expected fewer");
        raw.positions.emplace_back(static_cast<float>(numbers[0]), static_cast<float>(numbers[1]),
                                   static_cast<float>(numbers[2]));
        if (count == 4) widths.push_back(static_cast<float>(2 * numbers[3]));
        if (!widths.empty() && widths.size() != raw.positions.size())
            return failIn(file, Line{line}, fmt::format("a point of {} numbers", count),
                          "expected as many in all lines: three, or four with a radius");
    }
    if (raw.positions.size() > raw.offsets.back())
        raw.offsets.push_back(static_cast<std::uint32_t>(raw.positions.size()));
    raw.thickness = std::move(widths);
    if (hasOpenEnd)
        raw.warnings.push_back(fileNote("the last line has no end", "end of file",
                                        "if the file was cut, its last strands are missing or too short"));
    const bool isOneRun = !hasGaps || raw.offsets.size() == 2;
    if (!isOneRun || (asked == 0 && guessPointsPerStrand(raw.positions) == 0)) return raw;
    auto runs = cutIntoStrands(file, raw.positions, asked);
    if (!runs) return tl::unexpected(runs.error());
    noteRuns(*runs, raw);
    return raw;
}

Result<RawStrands> readBinary(const std::string& file, std::span<const std::byte> bytes) {
    ByteReader reader(file, bytes);
    if (auto status = reader.seek(kBinary.size(), "the header"); !status)
        return tl::unexpected(status.error());
    const auto count = reader.read<std::uint32_t>("the number of points");
    if (!count) return tl::unexpected(count.error());
    if (*count > reader.remaining() / 12)
        return failIn(file, Byte{kBinary.size()}, fmt::format("announces {} points", *count),
                      fmt::format("only {} bytes follow", reader.remaining()));
    RawStrands raw;
    raw.format = "Mitsuba hair";
    raw.positions.reserve(*count);
    for (std::uint32_t i = 0; i < *count; ++i) {
        auto x = reader.read<float>("a point");
        if (x && std::isinf(*x)) {
            if (i > raw.offsets.back()) raw.offsets.push_back(i);
            x = reader.read<float>("a point");
        }
        if (!x) return tl::unexpected(x.error());
        const auto rest = reader.readArray<float>(2, "a point");
        if (!rest) return tl::unexpected(rest.error());
        raw.positions.emplace_back(*x, (*rest)[0], (*rest)[1]);
    }
    if (*count > raw.offsets.back()) raw.offsets.push_back(*count);
    if (reader.remaining() > 0)
        raw.warnings.push_back(
            {Severity::Error, fmt::format("{} bytes follow the last point", reader.remaining()),
             "end of file", "they were left out; write the file again with counts that agree"});
    return raw;
}

Result<RawStrands> readMitsuba(const std::string& file, std::vector<std::byte>&& bytes,
                               const StrandImportOptions& options) {
    const std::string_view text = textOf(bytes);
    return text.starts_with(kBinary) ? readBinary(file, bytes)
                                     : readText(file, text, options.pointsPerStrand);
}

}  // namespace

StrandReader mitsubaReader() {
    return {{"Mitsuba curves", {"txt", "hair"}}, Recognition::Structure, isMitsuba, readMitsuba};
}

}  // namespace hairloom
