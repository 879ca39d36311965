// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What TressFX reads beside a .tfx: bones and weights of each strand (.tfxbone), and the skinned head that
// hair collides with (.tfxmesh). Layouts in docs/formats/strands.md.

#include <string>
#include <vector>

#include "exporters/prepared_strands.h"

namespace hairloom {

/// Writes those that the groom has the means for, and returns their names: both where its character has
/// bones; the bones alone where strands carry weights (`bone_weight_NAME`). What keeps one from being written
/// is a finding of `strands`. Errors: files that cannot be written.
Result<std::vector<std::string>> writeTfxCompanions(const Groom& groom, PreparedStrands& strands,
                                                    const StrandExportOptions& options,
                                                    const std::filesystem::path& path);

}  // namespace hairloom
