// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What may be opened for reading.

#include <filesystem>

#include "core/base/result.h"

namespace hairloom {

/// Errors: missing, a folder, a device or a FIFO, opening which would wait for somebody to write to it.
Status checkIsFile(const std::filesystem::path& path);

}  // namespace hairloom
