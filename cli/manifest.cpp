// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/manifest.h"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "core/base/file_hash.h"
#include "core/base/output_batch.h"
#include "core/base/write_rules.h"
#include "core/groom/file/project_content.h"
#include "core/groom/file/project_file.h"
#include "core/groom/groom_hash.h"

namespace hairloom::cli {
namespace {

namespace fs = std::filesystem;

/// From the folder, where there is a way that both could be moved by; else absolute.
std::string nameFrom(const fs::path& folder, const fs::path& file) {
    std::error_code code;
    const fs::path way = fs::weakly_canonical(fs::absolute(file, code), code)
                             .lexically_relative(fs::weakly_canonical(fs::absolute(folder, code), code));
    return (way.empty() || *way.begin() == ".." ? fs::absolute(file, code) : way).generic_string();
}

/// `content`: where the file's bytes are by now.
Result<Report> rowOf(const fs::path& folder, const fs::path& file, const fs::path& content) {
    std::error_code code;
    const std::uint64_t bytes = fs::file_size(content, code);
    const std::string hash = hashText(content);
    if (code || hash.empty()) return failIn(file.string(), {}, "cannot be read for the manifest");
    return manifestRow(nameFrom(folder, file), bytes, hash);
}

/// What a project holds, without its lists.
Report heldBy(const fs::path& file) {
    const auto groom = readProjectFile(file);
    if (!groom) return nullptr;
    Report content{{"content_hash", fmt::format("{:016x}", contentHash(*groom))}};
    const Report head = projectHead(*groom, file);
    for (const char* member : {"strands", "points", "simulation", "material", "interpolation"})
        content[member] = head.at(member);
    return content;
}

}  // namespace

Report manifestHead() {
    return {{"program", "hairloom-cli " HAIRLOOM_VERSION}, {"hash", "XXH3, 64 bits"}};
}

Report manifestRow(const std::string& name, std::uint64_t bytes, const std::string& hash) {
    return {{"name", name}, {"bytes", bytes}, {"hash", hash}};
}

std::string hashText(const fs::path& path) {
    const auto hash = hashFile(path);
    return hash ? fmt::format("{:016x}", *hash) : std::string();
}

Result<Report> manifestOf(const fs::path& manifest, const std::vector<fs::path>& outputs,
                          const std::string& commandLine) {
    const fs::path folder = manifest.has_parent_path() ? manifest.parent_path() : ".";
    Report content = manifestHead();
    content["command"] = commandLine;
    content["files"] = Report::array();
    for (const fs::path& output : outputs) {
        auto row = rowOf(folder, output, whereWritten(output));
        if (!row) return row;
        content["files"].push_back(std::move(*row));
    }
    content["inputs"] = Report::array();
    std::error_code code;
    for (const fs::path& input : notedInputs()) {
        // What came through a pipe is gone.
        if (!fs::is_regular_file(input, code)) continue;
        if (isChangedByOthers(input))
            return failIn(input.string(), {},
                          "was changed after it was read: the manifest would name another file",
                          "run the job again");
        auto row = rowOf(folder, input, input);
        if (!row) return row;
        if (looksLikeProject(input)) (*row)["groom"] = heldBy(input);
        content["inputs"].push_back(std::move(*row));
    }
    return content;
}

}  // namespace hairloom::cli
