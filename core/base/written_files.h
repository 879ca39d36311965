// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What this process has read and written, where WriteRules keep inputs.

#include <cstdint>
#include <filesystem>

#include "core/base/file_version.h"

namespace hairloom {

enum class InputState : std::uint8_t {
    NotRead,
    AsRead,
    ChangedSince,         ///< read, and changed or replaced by somebody else since
    ChangedSinceWritten,  ///< written by this process, and changed by somebody else since
};
/// What is known of the file at `path`, a name without links, whose version now is `version`.
InputState inputState(const std::filesystem::path& path, const FileVersion& version);

/// Whether keepNew() holds for `path`, a name without links, and this process has not written it.
bool isKeptNew(const std::filesystem::path& path);

/// The process wrote this file: reading it back makes it no input.
void noteWritten(const std::filesystem::path& path);

}  // namespace hairloom
