// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What foreign files are read in, and what that process cannot do.

#include <string>
#include <utility>
#include <vector>

#include "core/base/result.h"

namespace hairloom {

/// As the mesh reader finds them by trying: "seccomp", "landlock", "landlock_version", and whether "network",
/// "write", "other_files" and "programs" are refused. Errors: the reader cannot be run.
Result<std::vector<std::pair<std::string, std::string>>> readerSecurity();

}  // namespace hairloom
