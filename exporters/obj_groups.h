// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Layers as groups of a Wavefront OBJ.

#include <string>

#include "exporters/exported_parts.h"

namespace hairloom {

/// What a group's name may have: no blanks, which stand between groups, no comment and no continued line.
bool isLegalInObj(char c, bool isFirst);

/// The statements before a part's lines or faces: `g` with its legal name and, where that is another, `o`
/// with the layer's own before it.
std::string objGroup(const ExportedPart& part);

}  // namespace hairloom
