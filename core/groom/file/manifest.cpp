// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/file/manifest.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/base/file_hash.h"
#include "core/base/output_batch.h"
#include "core/base/write_rules.h"
#include "core/groom/file/project_content.h"
#include "core/groom/file/project_file.h"
#include "core/groom/groom_hash.h"

namespace hairloom {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// From the folder, where there is a way that both could be moved by; else absolute.
std::string nameFrom(const fs::path& folder, const fs::path& file) {
    std::error_code code;
    const fs::path way = fs::weakly_canonical(fs::absolute(file, code), code)
                             .lexically_relative(fs::weakly_canonical(fs::absolute(folder, code), code));
    return (way.empty() || *way.begin() == ".." ? fs::absolute(file, code) : way).generic_string();
}

/// `content`: where the file's bytes are by now.
Result<Json> rowOf(const fs::path& folder, const fs::path& file, const fs::path& content) {
    std::error_code code;
    const std::uint64_t bytes = fs::file_size(content, code);
    const std::string hash = hashText(content);
    if (code || hash.empty())
        return failIn(file.string(), {}, "cannot be read for the manifest", "expected a readable file");
    return manifestRow(nameFrom(folder, file), bytes, hash);
}

Json rowOfGroom(const Groom& groom, const fs::path& project) {
    Json content{{"content_hash", fmt::format("{:016x}", contentHash(groom))}};
    const Json head = projectHead(groom, project);
    for (const char* member : {"strands", "points", "simulation", "material", "shadows", "interpolation"})
        content[member] = head.at(member);
    return content;
}

}  // namespace

Json manifestHead(const std::string& program) {
    return {{"program", program}, {"hash", "XXH3, 64 bits"}};
}

Json manifestRow(const std::string& name, std::uint64_t bytes, const std::string& hash) {
    return {{"name", name}, {"bytes", bytes}, {"hash", hash}};
}

std::string hashText(const fs::path& path) {
    const auto hash = hashFile(path);
    return hash ? fmt::format("{:016x}", *hash) : std::string();
}

Result<Json> manifestOf(const fs::path& manifest, const ManifestSource& source,
                        const std::vector<fs::path>& outputs) {
    const fs::path folder = manifest.has_parent_path() ? manifest.parent_path() : ".";
    Json content = manifestHead(source.program);
    content["command"] = source.command;
    if (source.groom) content["groom"] = rowOfGroom(*source.groom, manifest);
    content["files"] = Json::array();
    for (const fs::path& output : outputs) {
        auto row = rowOf(folder, output, whereWritten(output));
        if (!row) return row;
        content["files"].push_back(std::move(*row));
    }
    content["inputs"] = Json::array();
    std::error_code code;
    for (const fs::path& input : source.inputs) {
        // What came through a pipe is gone.
        if (!fs::is_regular_file(input, code)) continue;
        if (isChangedByOthers(input))
            return failIn(input.string(), {},
                          "was changed after it was read: the manifest would name another file",
                          source.whatToDo);
        auto row = rowOf(folder, input, input);
        if (!row) return row;
        if (looksLikeProject(input)) {
            if (const auto groom = readProjectFile(input)) (*row)["groom"] = rowOfGroom(*groom, input);
        }
        content["inputs"].push_back(std::move(*row));
    }
    return content;
}

Status addManifest(const fs::path& manifest, const ManifestSource& source) {
    const auto content = manifestOf(manifest, source, waitingFiles());
    if (!content) return tl::unexpected(content.error());
    const std::string text = content->dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
    return writeFileAtomically(manifest, std::string_view(text));
}

fs::path manifestName(const fs::path& output) {
    return output.string() + ".manifest.json";
}

}  // namespace hairloom
