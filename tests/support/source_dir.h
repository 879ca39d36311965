// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <filesystem>

namespace hairloom {

/// The top of the repository that this was built from.
std::filesystem::path sourceDir();

}  // namespace hairloom
