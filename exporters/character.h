// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The character that a groom's head comes from, with its bones, for files that carry those.

#include <optional>
#include <vector>

#include "core/groom/groom.h"
#include "core/groom/validate.h"
#include "importers/scene.h"

namespace hairloom {

/// Nothing where the groom names no character file or that has no bones; where it cannot be read, or has
/// another mesh than the groom's scalp, nothing and a finding.
std::optional<ImportedScene> characterOf(const Groom& groom, std::vector<Finding>& findings);

}  // namespace hairloom
