// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>
#include <memory>

#include "cli/job.h"
#include "core/base/output_file.h"

namespace hairloom::cli {
namespace {

struct CleanOptions {
    std::string folder = ".";
    bool remove = false;
    bool alsoWhole = false;
};

Result<Report> clean(const CleanOptions& options) {
    if (!std::filesystem::is_directory(options.folder))
        return failIn(options.folder, {}, "is not a folder", "expected a folder to search");
    Report rows = Report::array();
    std::size_t removed = 0;
    for (const LeftOver& leftOver : findLeftOvers(options.folder)) {
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
    return Report{{"folder", options.folder}, {"left_overs", std::move(rows)}, {"removed", removed}};
}

JobRun declare(CLI::App& job) {
    const auto options = std::make_shared<CleanOptions>();
    job.add_option("folder", options->folder, "Folder to search (default: the current folder)");
    auto* remove =
        job.add_flag("--remove", options->remove, "Remove the files found instead of only listing them");
    job.add_flag("--whole", options->alsoWhole,
                 "Include files with the complete content of a target that may be damaged")
        ->needs(remove);
    return [options](const std::string&) { return clean(*options); };
}

}  // namespace

Job cleanJob() {
    return {"clean", "List or remove temporary files of interrupted runs", "--remove out", declare};
}

}  // namespace hairloom::cli
