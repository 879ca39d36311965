// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <filesystem>

namespace hairloom {

/// The top of the repository that this was built from.
std::filesystem::path sourceDir();

/// Where models, strands and clips from elsewhere lie: beside the repository, since they are no part of it.
/// Tests that read them skip where they are missing.
std::filesystem::path outsideData();

}  // namespace hairloom
