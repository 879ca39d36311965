// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What TressFX reads beside a .tfx: bones and weights of each strand (.tfxbone), and the skinned head that
// hair collides with (.tfxmesh). Layouts in docs/formats/strands.md.

#include <cstddef>
#include <filesystem>
#include <vector>

#include "exporters/prepared_strands.h"

namespace hairloom {

struct TfxCompanion {
    std::filesystem::path path;
    std::vector<std::byte> bytes;
};

/// Those that the groom has the means for, beside `path`: both where its character has bones; the bones alone
/// where strands carry weights (`bone_weight_NAME`). What keeps one from being made is a finding of
/// `strands`.
std::vector<TfxCompanion> tfxCompanions(const Groom& groom, PreparedStrands& strands,
                                        const StrandExportOptions& options,
                                        const std::filesystem::path& path);

}  // namespace hairloom
