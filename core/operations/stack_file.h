// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Operators in files of their own, to be taken to other hairstyles: presets.

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/operations/stack.h"

namespace hairloom {

/// As the job `stack` prints them with --json.
std::string operatorsText(std::span<const Operator> operators);
/// Errors name `file`: those of readOperators().
Result<std::vector<Operator>> parseOperators(const std::string& file, std::string_view text);

Result<std::vector<Operator>> loadOperators(const std::filesystem::path& path);
/// Without sculpts, whose strokes are of this hair alone. Errors: nothing else is there; the file's.
Status saveOperators(const std::filesystem::path& path, std::span<const Operator> operators);

/// Names of the presets of a folder, in order; files NAME.stack.json.
std::vector<std::string> stackPresets(const std::filesystem::path& folder);
/// The file of a preset. Error: no such name is possible.
Result<std::filesystem::path> stackPresetFile(const std::filesystem::path& folder, const std::string& name);

}  // namespace hairloom
