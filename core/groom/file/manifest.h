// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What was written, from what, and how: for pipelines that check and publish files.

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/groom/groom.h"

namespace hairloom {

/// What made the files.
struct ManifestSource {
    std::string program;                        ///< with its version
    std::string command;                        ///< the command line, or what was chosen in the window
    std::vector<std::filesystem::path> inputs;  ///< that were read
    const Groom* groom = nullptr;               ///< the hair, where no input need be it
    std::string whatToDo;                       ///< said where an input has changed
};

/// The members that each manifest begins with.
nlohmann::ordered_json manifestHead(const std::string& program);
/// A file in a manifest; `hash` as hashText().
nlohmann::ordered_json manifestRow(const std::string& name, std::uint64_t bytes, const std::string& hash);
/// XXH3 of a file's bytes in 16 digits; empty where it cannot be read.
std::string hashText(const std::filesystem::path& path);

/// "F.manifest.json" for the output "F".
std::filesystem::path manifestName(const std::filesystem::path& output);
/// The manifest of `outputs` (which may wait for their batch) and of the source's inputs, and of projects
/// among these what they hold. Names start at the manifest's folder. Errors: a file that cannot be read, an
/// input that has changed.
Result<nlohmann::ordered_json> manifestOf(const std::filesystem::path& manifest, const ManifestSource& source,
                                          const std::vector<std::filesystem::path>& outputs);
/// Writes the manifest of what waits for this thread's batch into that batch. Errors: manifestOf()'s, and
/// those of writing.
Status addManifest(const std::filesystem::path& manifest, const ManifestSource& source);

}  // namespace hairloom
