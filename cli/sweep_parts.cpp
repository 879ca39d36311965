// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sweep_parts.h"

#include <fmt/format.h>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <cstdlib>
#include <exception>
#include <span>
#include <system_error>
#include <utility>

#include "cli/error_report.h"
#include "cli/finite_numbers.h"
#include "core/base/file.h"
#include "core/base/hash.h"
#include "core/base/log.h"
#include "core/base/stopwatch.h"
#include "core/groom/file/json_reader.h"
#include "core/groom/file/manifest.h"

namespace hairloom::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxFiles = 100'000;

/// What a file of the folder's own holds; null where it is missing or damaged, as if nothing were there.
Report contentOf(const fs::path& path) {
    std::error_code code;
    if (!fs::is_regular_file(path, code)) return {};
    const auto text = readTextFile(path);
    return text ? Report::parse(*text, nullptr, false) : Report();
}

std::string nodeName() {
    for (const char* name : {"SLURMD_NODENAME", "HOSTNAME", "COMPUTERNAME"}) {
        const char* const value = std::getenv(name);
        if (value != nullptr) return value;
    }
    return {};
}

/// Every file below the folder, in order of name.
Result<std::vector<fs::path>> filesBelow(const fs::path& folder) {
    std::vector<fs::path> files;
    std::error_code code;
    for (fs::recursive_directory_iterator at(folder, code), end; !code && at != end; at.increment(code)) {
        if (at->is_regular_file(code)) files.push_back(at->path());
        if (files.size() > kMaxFiles)
            return failIn(folder.string(), {}, fmt::format("holds more than {} files", kMaxFiles),
                          "expected fewer outputs of one part");
    }
    if (code)
        return failIn(folder.string(), {}, "cannot be read: " + code.message(), "expected a readable folder");
    std::ranges::sort(files);
    return files;
}

Result<std::vector<PartFile>> describedFiles(const fs::path& folder) {
    const auto paths = filesBelow(folder);
    if (!paths) return tl::unexpected(paths.error());
    std::vector<PartFile> files;
    for (const fs::path& path : *paths) {
        std::error_code code;
        PartFile file{path.lexically_relative(folder).generic_string(), fs::file_size(path, code),
                      hashText(path)};
        if (code || file.hash.empty())
            return failIn(path.string(), {}, "cannot be read back",
                          "expected what the part wrote: run it again");
        files.push_back(std::move(file));
    }
    return files;
}

/// Texts with `{out}` in place of the folder, so that it does not matter where it is.
Report withoutFolder(const Report& value, const std::string& folder) {
    if (value.is_structured()) {
        Report all = value;
        for (auto& part : all) part = withoutFolder(part, folder);
        return all;
    }
    if (!value.is_string()) return value;
    auto text = value.get<std::string>();
    for (auto at = text.find(folder); at != std::string::npos; at = text.find(folder, at))
        text.replace(at, folder.size(), "{out}");
    return text;
}

/// Keeps the job's warnings, while it lives.
class KeptWarnings {
  public:
    KeptWarnings() {
        log::setSink([this](log::Level level, std::string_view message) {
            if (level >= log::Level::Warning && texts_.size() < 100) texts_.emplace_back(message);
        });
    }
    KeptWarnings(const KeptWarnings&) = delete;
    KeptWarnings& operator=(const KeptWarnings&) = delete;
    ~KeptWarnings() { log::setSink({}); }
    const std::vector<std::string>& texts() const { return texts_; }

  private:
    std::vector<std::string> texts_;
};

/// Parses and runs the job as main() does, with what it throws as an error.
Result<Report> runWords(const Job& job, std::vector<std::string> words) {
    try {
        CLI::App app("hairloom-cli");
        app.allow_windows_style_options(false);
        const JobRun run = declareJob(job, app);
        refuseNumbersThatAreNone(app);
        const std::string commandLine = fmt::format("hairloom-cli {} {}", job.name, fmt::join(words, " "));
        std::ranges::reverse(words);
        app.parse(words);
        return run(commandLine);
    } catch (const WrongUsage& error) {
        return tl::unexpected(error.error());
    } catch (const CLI::Error& error) {
        return fail(error.what(), fmt::format("see hairloom-cli {} --help", job.name));
    } catch (const std::bad_alloc&) {
        return fail("the job ran out of memory", "expected a smaller input, or more memory");
    } catch (const std::exception& error) {
        return fail(fmt::format("the job stopped with an unexpected error ({})", error.what()),
                    "please report it with the command and its input");
    }
}

Report errorReport(const Error& error) {
    Report report{{"file", error.file}, {"what", error.problem}, {"expected", error.expected}};
    if (const auto* line = std::get_if<Line>(&error.place)) report["line"] = line->number;
    if (const auto* byte = std::get_if<Byte>(&error.place)) report["byte"] = byte->offset;
    return report;
}

Status writeReport(const fs::path& path, const Report& report) {
    const std::string text = report.dump(1, ' ', false, Report::error_handler_t::replace) + "\n";
    return writeFileAtomically(path, std::as_bytes(std::span(text)), Replacing::Anything);
}

}  // namespace

Result<SweepFolder> SweepFolder::open(const Sweep& sweep, fs::path folder) {
    std::error_code code;
    const fs::path mark = folder / "sweep.json";
    if (fs::exists(folder, code) && !fs::is_empty(folder, code) && !contentOf(mark).contains("sweep_of"))
        return failIn(folder.string(), {}, "is no folder of a sweep", "expected a new name after -o");
    fs::create_directories(folder / "parts", code);
    if (!code) fs::create_directories(folder / "state", code);
    if (code)
        return failIn(folder.string(), {}, "the folder cannot be made: " + code.message(),
                      "expected a folder that can be written");
    const Report content{{"sweep_of", sweep.name}, {"job", sweep.job}, {"parts", sweep.parts.size()}};
    // The results of another one would be replaced part by part.
    if (const Report there = contentOf(mark); there.contains("sweep_of")) {
        const auto saysOther = [&](const char* key) { return there.value(key, Report()) != content[key]; };
        if (saysOther("sweep_of") || saysOther("job"))
            return failIn(folder.string(), {},
                          fmt::format("is the folder of the sweep {} ({})", there["sweep_of"].dump(),
                                      there.value("job", Report()).dump()),
                          "expected a new name after -o");
    }
    // Many tasks of an array open it at once.
    if (contentOf(mark) != content) {
        if (auto status = writeReport(mark, content); !status && contentOf(mark) != content) {
            for (const char* const made : {"parts", "state", ""})
                fs::remove(folder / made, code);  // while empty
            return tl::unexpected(status.error());
        }
    }
    return SweepFolder(sweep, std::move(folder));
}

fs::path SweepFolder::doneFile(const SweepPart& part) const {
    return folder_ / "state" / (part.name + ".json");
}
fs::path SweepFolder::failedFile(const SweepPart& part) const {
    return folder_ / "state" / (part.name + ".failed.json");
}

std::string SweepFolder::inputHash(const SweepPart& part, KnownHashes& known) const {
    std::string all = "hairloom " HAIRLOOM_VERSION "\n" + sweep_->job;
    const auto isNoted = [&](const std::string& name) {
        const fs::path path = sweep_->folder / name;
        std::error_code code;
        if (name.empty() || !fs::is_regular_file(path, code)) return false;
        const auto [hash, isNew] = known.try_emplace(path);
        if (isNew) hash->second = hashText(path);
        all += "\n " + hash->second;
        return true;
    };
    for (const std::string& word : part.words) {
        all += '\n' + word;
        const std::string value =
            word.starts_with("--") ? word.substr(std::min(word.find('='), word.size() - 1) + 1) : word;
        // A value may be a file, or several with commas between.
        if (isNoted(value)) continue;
        for (std::size_t at = 0; at <= value.size();) {
            const auto comma = std::min(value.find(',', at), value.size());
            isNoted(value.substr(at, comma - at));
            at = comma + 1;
        }
    }
    return fmt::format("{:016x}", hashBytes(std::as_bytes(std::span(all))));
}

std::optional<DonePart> SweepFolder::done(const SweepPart& part, KnownHashes& known) const {
    const Report state = contentOf(doneFile(part));
    if (!state.is_object()) return std::nullopt;
    try {
        if (state.at("input").get<std::string>() != inputHash(part, known)) return std::nullopt;
        DonePart done;
        done.report = state.at("report");
        done.seconds = state.at("seconds").get<double>();
        done.node = state.at("node").get<std::string>();
        done.warnings = state.at("warnings").get<std::vector<std::string>>();
        for (const Report& row : state.at("files")) {
            PartFile file{row.at("name").get<std::string>(), row.at("bytes").get<std::uint64_t>(),
                          row.at("hash").get<std::string>()};
            std::error_code code;
            const fs::path path = folderOf(part) / file.name;
            if (fs::file_size(path, code) != file.bytes || code || hashText(path) != file.hash)
                return std::nullopt;
            done.files.push_back(std::move(file));
        }
        return done;
    } catch (const Report::exception&) {
        return std::nullopt;
    }
}

std::optional<Error> SweepFolder::failure(const SweepPart& part) const {
    const Report state = contentOf(failedFile(part));
    if (!state.is_object()) return std::nullopt;
    try {
        Error error{state.value("file", ""), {}, state.value("what", ""), state.value("expected", "")};
        if (state.contains("line")) error.place = Line{state.value("line", std::uint64_t{0})};
        if (state.contains("byte")) error.place = Byte{state.value("byte", std::uint64_t{0})};
        return error;
    } catch (const Report::exception&) {
        return std::nullopt;
    }
}

std::optional<Error> SweepFolder::busy(const SweepPart& part) const {
    const auto state = OutputFile::open(doneFile(part), {}, Replacing::Anything);
    return state ? std::nullopt : std::optional(state.error());
}

Result<DonePart> SweepFolder::run(const SweepPart& part) const {
    auto state = OutputFile::open(doneFile(part), {}, Replacing::Anything);
    if (!state) return tl::unexpected(state.error());
    // Another process may have ended it before this one got it.
    KnownHashes known;
    if (auto ready = done(part, known)) return std::move(*ready);
    forget(part);
    // Before the job: what changes meanwhile makes the part due again.
    const std::string input = inputHash(part, known);
    auto done = runJob(part);
    if (!done) {
        if (auto status = this->fail(part, done.error()); !status) return tl::unexpected(status.error());
        return done;
    }
    Report content{{"input", input},          {"values", part.values},      {"seconds", done->seconds},
                   {"node", done->node},      {"warnings", done->warnings}, {"report", done->report},
                   {"files", Report::array()}};
    for (const PartFile& file : done->files)
        content["files"].push_back(manifestRow(file.name, file.bytes, file.hash));
    const std::string text = content.dump(1, ' ', false, Report::error_handler_t::replace) + "\n";
    auto status = state->write(std::as_bytes(std::span(text)));
    if (status) status = state->finish();
    if (!status) return tl::unexpected(status.error());
    return done;
}

Result<DonePart> SweepFolder::runJob(const SweepPart& part) const {
    const fs::path folder = folderOf(part);
    std::error_code code;
    fs::remove_all(folder, code);
    if (!code) fs::create_directories(folder, code);
    // Names in the file start at its folder.
    if (!code) fs::current_path(sweep_->folder, code);
    if (code)
        return failIn(folder.string(), {}, "the folder cannot be replaced: " + code.message(),
                      "expected a folder that can be written");
    const Stopwatch watch;
    const KeptWarnings warnings;
    const auto job = std::ranges::find(jobs(), sweep_->job, &Job::name);
    const auto report = runWords(*job, wordsIn(folder, part));
    if (!report) return tl::unexpected(report.error());
    auto files = describedFiles(folder);
    if (!files) return tl::unexpected(files.error());
    return DonePart{withoutFolder(*report, folder.generic_string()), std::move(*files), warnings.texts(),
                    watch.seconds(), nodeName()};
}

Status SweepFolder::fail(const SweepPart& part, const Error& error) const {
    return writeReport(failedFile(part), errorReport(error));
}

void SweepFolder::forget(const SweepPart& part) const {
    std::error_code code;
    fs::remove(failedFile(part), code);
}

}  // namespace hairloom::cli
