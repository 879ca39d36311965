// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/outputs.h"

#include <vector>

#include "core/base/log.h"
#include "core/base/output_file.h"

namespace hairloom::cli {
namespace {

void sayLeftOvers(const std::filesystem::path& output) {
    for (const LeftOver& leftOver : findLeftOvers(output.has_parent_path() ? output.parent_path() : ".")) {
        if (leftOver.target != output.filename().string()) continue;
        log::warning(
            "{}: left by a run that was killed while it wrote {}{}. Remove it with `hairloom-cli clean`",
            leftOver.file.string(), leftOver.target,
            leftOver.whole ? ", which may be damaged: this file has the complete content" : "");
    }
}

}  // namespace

Result<Report> withOutputs(std::initializer_list<Output> outputs,
                           const std::function<Result<Report>()>& run) {
    std::vector<OutputFile> kept;
    for (const Output& output : outputs) {
        if (output.path.empty()) continue;
        auto file = OutputFile::open(output.path, output.kind);
        if (!file) return tl::unexpected(file.error());
        kept.push_back(std::move(*file));
        sayLeftOvers(output.path);
    }
    return run();
}

}  // namespace hairloom::cli
