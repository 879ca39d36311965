// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <system_error>
#include <vector>

#include "cli/error_report.h"
#include "core/base/log.h"
#include "core/base/output_batch.h"
#include "core/base/write_rules.h"

namespace hairloom::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStandardOutput = "-";

struct Streams {
    bool json = false;          ///< the report goes to standard output as JSON
    bool fileIsOutput = false;  ///< a file goes there
};

Streams& streams() {
    static Streams instance;
    return instance;
}

void sayLeftOvers(const fs::path& output) {
    for (const LeftOver& leftOver : findLeftOvers(output.has_parent_path() ? output.parent_path() : ".")) {
        if (leftOver.target != output.filename().string()) continue;
        log::warning(
            "{}: left by a run that was killed while it wrote {}{}. Remove it with `hairloom-cli clean`",
            leftOver.file.string(), leftOver.target,
            leftOver.whole ? ", which may be damaged: this file has the complete content" : "");
    }
}

bool isPipe(const std::string& path) {
    std::error_code code;
    return path == kStandardOutput || fs::is_fifo(path, code);
}

/// Refuses a pipe that cannot hold what the job writes to it.
void takePipe(const std::string& path, std::size_t outputs, ReadBack readBack) {
    if (readBack == ReadBack::Yes)
        throw WrongUsage(fmt::format("{} is a pipe, but this job reads back what it writes", path),
                         "expected the name of a file");
    if (outputs > 1)
        throw WrongUsage(fmt::format("{} is a pipe, but this job writes {} files", path, outputs),
                         "expected the name of a file");
    const bool isOutput =
        path == kStandardOutput || fileVersion(path).identity == fileVersion("/dev/stdout").identity;
    if (isOutput && streams().json)
        throw WrongUsage("--json and the file would both go to standard output", "expected one of them");
    streams().fileIsOutput = isOutput;
    allowPipe(path);
}

/// Makes a folder, and takes what it made away again, where that is still empty, unless it is kept.
class MadeFolders {
  public:
    explicit MadeFolders(const fs::path& folder) {
        std::error_code code;
        for (fs::path at = folder; !at.empty() && !fs::exists(at, code); at = at.parent_path()) {
            made_.push_back(at);
            if (at == at.parent_path()) break;
        }
        fs::create_directories(folder, failed_);
    }
    MadeFolders(const MadeFolders&) = delete;
    MadeFolders& operator=(const MadeFolders&) = delete;
    ~MadeFolders() {
        std::error_code code;
        for (const fs::path& folder : made_) {
            if (!fs::is_empty(folder, code) || code || !fs::remove(folder, code)) return;
        }
    }
    const std::error_code& failed() const { return failed_; }
    void keep() { made_.clear(); }

  private:
    std::vector<fs::path> made_;  ///< the innermost first
    std::error_code failed_;
};

}  // namespace

bool writesToStandardOutput() {
    return streams().fileIsOutput;
}

void reportsAsJson(bool json) {
    streams().json = json;
}

Result<Report> withOutputs(std::initializer_list<Output> outputs, const std::function<Result<Report>()>& run,
                           ReadBack readBack) {
    const auto count = static_cast<std::size_t>(
        std::ranges::count_if(outputs, [](const Output& output) { return !output.path.empty(); }));
    std::vector<OutputFile> kept;
    for (const Output& output : outputs) {
        if (output.path.empty()) continue;
        if (isPipe(output.path)) takePipe(output.path, count, readBack);
        auto file = OutputFile::open(output.path, output.kind);
        if (!file) return tl::unexpected(file.error());
        kept.push_back(std::move(*file));
        if (output.path != kStandardOutput) sayLeftOvers(output.path);
    }
    // Where nothing was asked for, what is written is the job's own and read by it: files of a benchmark,
    // say.
    if (count == 0 || readBack == ReadBack::Yes) return run();
    OutputBatch batch;
    auto report = run();
    if (!report) return report;
    if (auto status = batch.commit(); !status) return tl::unexpected(status.error());
    return report;
}

Result<Report> withOutputFolder(const std::string& folder, const std::function<Result<Report>()>& run,
                                ReadBack readBack) {
    if (folder.empty()) return run();
    MadeFolders made(folder);
    if (made.failed()) return failIn(folder, {}, "the folder cannot be made: " + made.failed().message());
    // Whether it takes a file at all, before anything is computed.
    if (auto trial = OutputFile::open(fs::path(folder) / "trial"); !trial) {
        Error error = trial.error();
        error.file = folder;
        return tl::unexpected(std::move(error));
    }
    std::optional<OutputBatch> batch;
    if (readBack == ReadBack::No) batch.emplace();
    auto report = run();
    if (!report) return report;
    if (batch) {
        if (auto status = batch->commit(); !status) return tl::unexpected(status.error());
    }
    made.keep();
    return report;
}

}  // namespace hairloom::cli
