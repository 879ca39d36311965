// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>
#include <memory>
#include <vector>

#include "cli/job.h"
#include "core/base/output_file.h"
#include "core/documents/recovery.h"

namespace hairloom::cli {
namespace {

struct CleanOptions {
    std::string folder = ".";
    bool remove = false;
    bool alsoWhole = false;
    bool copies = false;
};

/// Copies of unsaved work of windows that no longer run.
Result<Report> cleanCopies(const CleanOptions& options, std::size_t& removed) {
    Report rows = Report::array();
    for (const RecoveryCopy& copy : recoveryCopies()) {
        if (options.copies) {
            if (auto status = removeRecoveryCopy(copy); !status) return tl::unexpected(status.error());
            ++removed;
        }
        rows.push_back(
            Report{{"file", copy.file.string()},
                   {"project", copy.of.project.empty() ? Report() : Report(copy.of.project.string())},
                   {"name", copy.of.name},
                   {"bytes", copy.bytes},
                   {"older", copy.isOlder},
                   {"removed", options.copies}});
    }
    return rows;
}

Result<Report> clean(const CleanOptions& options) {
    if (!std::filesystem::is_directory(options.folder))
        return failIn(options.folder, {}, "is not a folder", "expected a folder to search");
    Report rows = Report::array();
    std::size_t removed = 0;
    auto copies = cleanCopies(options, removed);
    if (!copies) return copies;
    std::vector<LeftOver> leftOvers = findLeftOvers(options.folder);
    const std::filesystem::path recovery = recoveryFolder();
    std::error_code code;
    if (!recovery.empty() && !std::filesystem::equivalent(recovery, options.folder, code)) {
        for (LeftOver& leftOver : findLeftOvers(recovery)) leftOvers.push_back(std::move(leftOver));
    }
    for (const LeftOver& leftOver : leftOvers) {
        const bool remove = options.remove && (!leftOver.whole || options.alsoWhole);
        if (remove) {
            if (auto status = removeLeftOver(leftOver); !status) return tl::unexpected(status.error());
            ++removed;
        }
        rows.push_back(Report{{"file", leftOver.file.string()},
                              {"target", leftOver.target},
                              {"bytes", leftOver.bytes},
                              {"whole", leftOver.whole},
                              {"removed", remove}});
    }
    return Report{{"folder", options.folder},
                  {"recovery_folder", recovery.string()},
                  {"left_overs", std::move(rows)},
                  {"copies", std::move(*copies)},
                  {"removed", removed}};
}

JobRun declare(CLI::App& job) {
    const auto options = std::make_shared<CleanOptions>();
    job.add_option("folder", options->folder, "Folder to search (default: the current folder)");
    auto* remove =
        job.add_flag("--remove", options->remove, "Remove the files found instead of only listing them");
    job.add_flag("--whole", options->alsoWhole,
                 "Include files with the complete content of a target that may be damaged")
        ->needs(remove);
    job.add_flag("--copies", options->copies, "Include copies of unsaved work of windows that no longer run")
        ->needs(remove);
    return [options](const std::string&) { return clean(*options); };
}

}  // namespace

Job cleanJob() {
    return {"clean", "List or remove leftovers of interrupted runs and unsaved copies", "--remove out",
            declare};
}

}  // namespace hairloom::cli
