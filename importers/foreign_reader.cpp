// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/foreign_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <system_error>

#include "core/base/log.h"
#include "core/base/output_batch.h"
#include "core/base/regular_file.h"
#include "core/base/utf8.h"
#include "core/base/write_rules.h"
#include "importers/mesh_reader_program.h"
#include "importers/picture_stream.h"
#include "importers/raw_strands_stream.h"
#include "importers/reader_limits.h"
#include "importers/reader_security.h"
#include "importers/strand_file.h"

namespace hairloom {
namespace {

constexpr std::uint64_t kLargestStrandFile = std::uint64_t{4} << 30u;

/// The size of a regular file, which counts as read from here on. Errors: no such file, one too large.
Result<std::uint64_t> sizeOfInput(const std::filesystem::path& file, std::uint64_t most) {
    const std::filesystem::path place = whereWritten(file);
    if (auto status = checkIsFile(place); !status)
        return tl::unexpected(inFile(status.error(), file.string()));
    std::error_code code;
    const std::uint64_t size = std::filesystem::file_size(place, code);
    if (code) return failIn(file.string(), {}, "cannot be read: " + code.message());
    if (size > most) {
        return failIn(file.string(), {}, "is " + std::to_string(size) + " bytes long",
                      "expected at most " + std::to_string(most));
    }
    if (place == file) noteInput(file);
    return size;
}

/// Words about what lies beside a file under its name and has not been put in place yet.
void addWaitingCompanions(const std::filesystem::path& file, std::vector<std::string>& words) {
    for (const StrandReader& reader : strandReaders()) {
        if (reader.companion.empty()) continue;
        auto beside = file;
        beside.replace_extension(reader.companion);
        const auto place = whereWritten(beside);
        if (place != beside)
            words.push_back(fmt::format("--companion={}={}", reader.companion,
                                        std::filesystem::absolute(place).string()));
    }
}

/// What the file says in its own words is text, whatever it is.
void cleanNames(RawStrands& strands) {
    const auto clean = [](std::string& text) { text = cleanUtf8(text); };
    for (auto* names : {&strands.groupNames, &strands.layerNames}) std::ranges::for_each(*names, clean);
    for (RawAttribute& attribute : strands.attributes) clean(attribute.name);
    for (StrandPart& part : strands.parts) clean(part.path), clean(part.name);
    for (Finding& finding : strands.warnings) clean(finding.what), clean(finding.where), clean(finding.fix);
}

}  // namespace

Result<std::vector<std::byte>> readInChild(const std::string& kind, const std::filesystem::path& file,
                                           std::vector<std::string> words, const ChildLimits& limits) {
    // What this process writes and has not put in place yet is read where it lies.
    words.insert(words.begin(), {kind, std::filesystem::absolute(whereWritten(file)).string()});
    words.push_back("--memory=" + std::to_string(limits.residentBytes));
    words.push_back("--name=" + file.string());
    if (areUnconfinedReadersAllowed()) words.emplace_back("--allow-unconfined");
    auto output = runChild("the reader", meshReaderProgram(), words, limits);
    if (!output) return tl::unexpected(inFile(output.error(), file.string()));
    return output;
}

void sayWhatTheGuardLacks(const std::string& lacking) {
    static std::once_flag said;
    if (lacking.empty()) return;
    std::call_once(said, [&] {
        log::warning(
            "the process that reads foreign files runs without {}; `hairloom-cli devices --security` "
            "says what holds",
            lacking);
    });
}

Result<RawStrands> readStrandsInChild(const std::filesystem::path& file, const StrandImportOptions& options) {
    const auto size = sizeOfInput(file, kLargestStrandFile);
    if (!size) return tl::unexpected(size.error());
    std::string lacking;
    auto strands = [&]() -> Result<RawStrands> {
        auto words = wordsOf(options);
        addWaitingCompanions(file, words);
        const auto answer = readInChild("strands", file, std::move(words), limitsOfFile(*size));
        if (!answer) return tl::unexpected(answer.error());
        return readRawStrands(file.string(), *answer, lacking);
    }();
    sayWhatTheGuardLacks(lacking);
    if (strands) cleanNames(*strands);
    return strands;
}

Result<render::LinearImage> readPicture(const std::filesystem::path& file,
                                        std::initializer_list<PictureKind> kinds) {
    if (const auto size = sizeOfInput(file, kMaxPictureFile); !size) return tl::unexpected(size.error());
    std::vector<std::string> words;
    for (const PictureKind kind : kinds) words.emplace_back(name(kind));
    const auto answer = readInChild("picture", file, words, pictureLimits());
    if (!answer) return tl::unexpected(answer.error());
    std::string lacking;
    auto picture = readPictureAnswer(file.string(), *answer, lacking);
    sayWhatTheGuardLacks(lacking);
    return picture;
}

}  // namespace hairloom
