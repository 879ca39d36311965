// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/card_files.h"

#include "core/base/output_batch.h"
#include "core/base/output_file.h"

namespace hairloom {

HairWriter cardWriter(const char* name, const char* label, const char* carries, ExportTarget target,
                      const char* suffix, WriteCards write) {
    target.note =
        "Cards and a shell for far away, each measured against the strands. This takes about a minute. The "
        "Levels panel shows them before you export." +
        target.note;
    return {name, label, carries, "holds cards and a shell, not strands", {std::move(target)}, write, suffix};
}

LeftBehind springsLeftBehind() {
    return {"springs, and the distances of levels", "export them as gltf"};
}

LeftBehind jointsLeftBehind() {
    return {"joints and weights", "export them as fbx"};
}

Result<std::vector<std::string>> writeTogether(const CardFiles& files) {
    OutputBatch batch;
    std::vector<std::string> names;
    for (const auto& [to, bytes] : files) {
        if (auto status = writeFileAtomically(to, bytes); !status) return tl::unexpected(status.error());
        if (&to != &files.front().first) names.push_back(to.filename().string());
    }
    if (auto status = batch.commit(); !status) return tl::unexpected(status.error());
    return names;
}

}  // namespace hairloom
