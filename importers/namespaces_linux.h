// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A process in which other processes have no number and only one folder is there.

#include <filesystem>
#include <vector>

#include "importers/confinement.h"

namespace hairloom {

/// The layers "processes" and "paths". Where the kernel gives the first, this returns in a child, and the
/// process that called it ends as the child does.
std::vector<ConfinementLayer> enterNamespaces(const std::filesystem::path& folder);

}  // namespace hairloom
