// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <system_error>
#include <vector>

#include "cli/error_report.h"
#include "cli/versions.h"
#include "core/base/content_kind.h"
#include "core/base/log.h"
#include "core/base/output_batch.h"
#include "core/base/write_rules.h"
#include "core/groom/file/manifest.h"

namespace hairloom::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStandardOutput = "-";

struct Streams {
    bool json = false;          ///< the report goes to standard output as JSON
    bool fileIsOutput = false;  ///< a file goes there
};

struct Manifest {
    bool isWanted = false;
    std::string commandLine;
};

Manifest& manifest() {
    static Manifest instance;
    return instance;
}

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

/// Makes folders, and takes what it made away again, where that is still empty, unless it is kept.
class MadeFolders {
  public:
    explicit MadeFolders(const std::vector<fs::path>& folders) {
        std::error_code code;
        for (const fs::path& folder : folders) {
            std::vector<fs::path> missing;
            for (fs::path at = folder; !at.empty() && !fs::exists(at, code); at = at.parent_path()) {
                missing.push_back(at);
                if (at == at.parent_path()) break;
            }
            made_.insert(made_.begin(), missing.begin(), missing.end());
            if (!made_.empty()) removeFoldersWhenEnded(made_);
            fs::create_directories(folder, code);
            if (!code || !failed_.empty()) continue;
            failed_ = folder.string();
            why_ = code.message();
        }
    }
    MadeFolders(const MadeFolders&) = delete;
    MadeFolders& operator=(const MadeFolders&) = delete;
    ~MadeFolders() {
        if (made_.empty()) return;
        removeFoldersWhenEnded({});
        std::error_code code;
        for (const fs::path& folder : made_)
            if (!isKept_ && fs::is_empty(folder, code) && !code) fs::remove(folder, code);
    }
    Status status() const {
        if (failed_.empty()) return {};
        return failIn(failed_, {}, "the folder cannot be made: " + why_,
                      "expected a folder that can be written");
    }
    void keep() { isKept_ = true; }

  private:
    std::vector<fs::path> made_;  ///< the innermost first
    bool isKept_ = false;
    std::string failed_, why_;  ///< a folder that cannot be made
};

/// All that can be known before the work: by the rules, and by writing a byte that goes again.
Result<OutputFile> tried(const fs::path& path, std::string_view kind) {
    auto file = OutputFile::open(path, kind);
    if (!file) return file;
    if (auto status = file->tryOut(); !status) return tl::unexpected(status.error());
    return file;
}

/// What was printed would go to the file that was replaced.
void refuseOwnOutput(const std::string& path) {
    const FileVersion file = fileVersion(path), printed = fileVersion("/dev/stdout");
    std::error_code code;
    if (file.exists && printed.exists && file.identity == printed.identity && fs::is_regular_file(path, code))
        throw WrongUsage(fmt::format("standard output goes to {}", path),
                         "expected another name, or - for standard output");
}

void refuseOneNameForTwo(const std::vector<Output>& outputs) {
    std::set<fs::path> names;
    for (const Output& output : outputs) {
        if (output.path.empty()) continue;
        std::error_code code;
        if (!names.insert(fs::weakly_canonical(fs::absolute(output.path, code), code)).second)
            throw WrongUsage(fmt::format("{} is named for two outputs", output.path),
                             "expected a name for each");
    }
}

/// Of a sequence: none of its names is kept, as there may be thousands.
Status trySequence(const Output& output) {
    if (isPipe(output.path))
        throw WrongUsage(fmt::format("{} is a pipe, but this job writes {} files", output.path, output.files),
                         "expected the name of a file");
    for (std::size_t i = 0; i < output.files; ++i) {
        if (auto status = OutputFile::check(numbered(output.path, output.first + i), output.kind); !status)
            return status;
    }
    const auto file = tried(numbered(output.path, output.first), output.kind);
    return file ? Status() : tl::unexpected(file.error());
}

/// Where nothing fails all files are in place at once, with `run`'s report, and the manifest, if there is to
/// be one.
Result<Report> inBatch(const fs::path& manifestPath, const std::function<Result<Report>()>& run) {
    OutputBatch batch;
    auto report = run();
    if (!report) return report;
    if (!manifestPath.empty()) {
        const ManifestSource source{"hairloom-cli " HAIRLOOM_VERSION, manifest().commandLine, notedInputs(),
                                    nullptr, "run the job again"};
        if (auto status = addManifest(manifestPath, source); !status) return tl::unexpected(status.error());
        (*report)["manifest"] = manifestPath.string();
    }
    if (auto status = batch.commit(); !status) return tl::unexpected(status.error());
    return report;
}

}  // namespace

void writeManifest(const std::string& commandLine) {
    manifest() = {true, commandLine};
}

bool writesToStandardOutput() {
    return streams().fileIsOutput;
}

void reportsAsJson(bool json) {
    streams().json = json;
}

bool isReportJson() {
    return streams().json;
}

Result<Report> withOutputs(const std::vector<Output>& outputs, const std::function<Result<Report>()>& run,
                           ReadBack readBack) {
    const auto count = static_cast<std::size_t>(
        std::ranges::count_if(outputs, [](const Output& output) { return !output.path.empty(); }));
    fs::path manifestPath;
    std::vector<Output> all = outputs;
    if (const auto first =
            std::ranges::find_if(outputs, [](const Output& output) { return !output.path.empty(); });
        manifest().isWanted && first != outputs.end()) {
        if (isPipe(first->path))
            throw WrongUsage(fmt::format("{} is a pipe, which has no manifest", first->path),
                             "expected the name of a file");
        manifestPath = manifestName(first->path);
        all.push_back({manifestPath.string(), content::kJson});
    }
    refuseOneNameForTwo(all);
    // A folder of a new version is not there yet.
    std::vector<fs::path> folders;
    for (const Output& output : all)
        if (isVersioned(output.path) && fs::path(output.path).has_parent_path())
            folders.push_back(fs::path(output.path).parent_path());
    MadeFolders made(folders);
    if (auto status = made.status(); !status) return tl::unexpected(status.error());
    std::vector<OutputFile> kept;
    for (const Output& output : all) {
        if (output.path.empty()) continue;
        refuseOwnOutput(output.path);
        if (output.files > 0) {
            if (auto status = trySequence(output); !status) return tl::unexpected(status.error());
            continue;
        }
        if (isPipe(output.path)) takePipe(output.path, count, readBack);
        auto file = tried(output.path, output.kind);
        if (!file) return tl::unexpected(file.error());
        kept.push_back(std::move(*file));
        if (output.path != kStandardOutput) sayLeftOvers(output.path);
    }
    // Where nothing was asked for, what is written is the job's own and read by it: files of a benchmark,
    // say.
    auto report = count == 0 ? run() : inBatch(manifestPath, run);
    if (report) made.keep();
    return report;
}

void refusePipeForFolder(const std::string& folder) {
    if (folder == kStandardOutput)
        throw WrongUsage("- is a pipe, but this job writes several files", "expected the name of a folder");
}

Result<Report> withOutputFolder(const std::string& folder, const std::vector<std::string>& files,
                                const std::function<Result<Report>()>& run) {
    if (folder.empty()) return run();
    refusePipeForFolder(folder);
    MadeFolders made({folder});
    if (auto status = made.status(); !status) return tl::unexpected(status.error());
    const fs::path manifestPath = manifest().isWanted ? fs::path(folder) / "manifest.json" : fs::path();
    std::vector<std::string> names = files;
    if (!manifestPath.empty()) names.emplace_back("manifest.json");
    for (const std::string& name : names) {
        if (auto status = OutputFile::check(fs::path(folder) / name); !status)
            return tl::unexpected(status.error());
    }
    // Whether it takes a file at all, before anything is computed.
    if (auto trial = tried(fs::path(folder) / "trial", {}); !trial) {
        Error error = trial.error();
        error.file = folder;
        return tl::unexpected(std::move(error));
    }
    auto report = inBatch(manifestPath, run);
    if (report) made.keep();
    return report;
}

}  // namespace hairloom::cli
