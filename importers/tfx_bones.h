// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// TressFX's .tfxbone: which bones move the root of each strand.

#include "importers/raw_strands.h"

namespace hairloom {

/// Adds an attribute `bone_weight_NAME` for each bone that moves a strand. Strands behind those that it has
/// take the last one's weights, as in TressFX. Errors: damage, with its byte; more strands than there are;
/// more than 256 bones in use.
Status readTfxBones(const std::string& file, std::span<const std::byte> bytes, RawStrands& strands);

}  // namespace hairloom
