// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What this process has read and written, where WriteRules keep inputs.

#include <cstdint>
#include <filesystem>

#include "core/base/temporary_file.h"

namespace hairloom {

enum class InputState : std::uint8_t { NotRead, AsRead, ChangedSince };
/// What noteInput() knows of the file.
InputState inputState(const FileState& state);

/// The process wrote this file: reading it back makes it no input.
void noteWritten(const std::filesystem::path& path);

}  // namespace hairloom
