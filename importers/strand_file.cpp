// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/strand_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <system_error>

#include "core/base/file.h"

namespace hairloom {
namespace {

constexpr std::uint64_t kLargestCompanion = std::uint64_t{1} << 28u;  // 256 MiB

/// Those with a signature first.
std::vector<const StrandReader*> readersInOrder() {
    std::vector<const StrandReader*> readers;
    for (const Recognition recognition :
         {Recognition::Signature, Recognition::Structure, Recognition::Guess}) {
        for (const StrandReader& reader : strandReaders()) {
            if (reader.recognition == recognition) readers.push_back(&reader);
        }
    }
    return readers;
}

/// Strands are of use without it: what is wrong with it is said, no more.
void takeCompanion(const StrandReader& reader, const Companions& companions, RawStrands& raw) {
    const auto found = companions.find(reader.companion);
    if (found == companions.end()) return;
    const auto& [name, bytes] = found->second;
    const Status taken =
        bytes ? reader.readCompanion(name, *bytes, raw) : Status(tl::unexpected(bytes.error()));
    if (!taken)
        raw.warnings.push_back({Severity::Error, taken.error().message(),
                                std::filesystem::path(name).filename().string(),
                                "it was left out. Write it again, or remove it"});
}

template <class T>
bool parse(std::string_view text, T& value) {
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    return code == std::errc() && end == text.data() + text.size();
}

template <class E>
bool parseChoice(std::string_view text, E& value, E last) {
    unsigned number = 0;
    if (!parse(text, number) || number > static_cast<unsigned>(last)) return false;
    value = static_cast<E>(number);
    return true;
}

}  // namespace

std::vector<FileFormat> strandFormats() {
    std::vector<FileFormat> formats;
    for (const StrandReader* reader : readersInOrder()) formats.push_back(reader->format);
    return formats;
}

bool looksLikeStrandFile(std::span<const std::byte> bytes) {
    return std::ranges::any_of(strandReaders(), [&](const StrandReader& reader) {
        return reader.recognition == Recognition::Signature && reader.recognise(bytes);
    });
}

Companions readCompanions(const std::filesystem::path& path, const std::filesystem::path& named,
                          const CompanionPaths& elsewhere) {
    Companions companions;
    for (const StrandReader& reader : strandReaders()) {
        if (reader.companion.empty()) continue;
        auto beside = path, called = named;
        beside.replace_extension(reader.companion);
        called.replace_extension(reader.companion);
        if (const auto found = elsewhere.find(reader.companion); found != elsewhere.end())
            beside = found->second;
        std::error_code code;
        if (!std::filesystem::is_regular_file(beside, code)) continue;
        auto bytes = readFile(beside, kLargestCompanion);
        if (!bytes && bytes.error().file == beside.string())
            bytes =
                failIn(called.string(), bytes.error().place, bytes.error().problem, bytes.error().expected);
        companions.emplace(std::string(reader.companion), Companion{called.string(), std::move(bytes)});
    }
    return companions;
}

Result<RawStrands> readStrandFile(const std::string& file, std::vector<std::byte> bytes,
                                  const StrandImportOptions& options, const Companions& companions) {
    if (bytes.empty()) return failIn(file, {}, "is empty", "expected a strand file");
    for (const StrandReader* reader : readersInOrder()) {
        if (!reader->recognise(bytes)) continue;
        auto raw = reader->read(file, std::move(bytes), options);
        if (raw && !reader->companion.empty()) takeCompanion(*reader, companions, *raw);
        return raw;
    }
    return failIn(file, Byte{0}, "is not in a supported strand format",
                  "expected " + labelsOf(strandFormats()));
}

std::vector<std::string> wordsOf(const StrandImportOptions& options) {
    std::vector<std::string> words{
        fmt::format("--unit={}", options.metresPerUnit),
        fmt::format("--fps={}", options.framesPerSecond),
        fmt::format("--order={}", static_cast<unsigned>(options.ribbonOrder)),
        fmt::format("--particle={}", static_cast<unsigned>(options.ribbonParticle)),
        fmt::format("--segments={}", options.ribbonSegments),
        fmt::format("--points={}", options.pointsPerStrand)};
    if (options.isUnitAsked) words.emplace_back("--unit-asked");
    if (options.frames) words.emplace_back("--frames");
    if (options.everySample) words.emplace_back("--every-sample");
    return words;
}

bool takeWord(std::string_view word, StrandImportOptions& options) {
    const std::size_t sign = std::min(word.find('='), word.size());
    const std::string_view key = word.substr(0, sign), value = word.substr(std::min(sign + 1, word.size()));
    if (key == "--unit-asked") return options.isUnitAsked = true;
    if (key == "--frames") return options.frames = true;
    if (key == "--every-sample") return options.everySample = true;
    if (key == "--unit") return parse(value, options.metresPerUnit);
    if (key == "--fps") return parse(value, options.framesPerSecond);
    if (key == "--order") return parseChoice(value, options.ribbonOrder, RibbonOrder::Around);
    if (key == "--particle") return parseChoice(value, options.ribbonParticle, RibbonParticle::Centre);
    if (key == "--segments") return parse(value, options.ribbonSegments);
    if (key == "--points") return parse(value, options.pointsPerStrand);
    return false;
}

}  // namespace hairloom
