// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// File formats as people choose among them: in help texts, messages and the filters of file dialogs.

#include <span>
#include <string>
#include <vector>

namespace hairloom {

struct FileFormat {
    std::string label;                  ///< "TressFX .tfx"
    std::vector<std::string> suffixes;  ///< of its files, without the dot
};

/// Their labels: "OBJ, PLY or STL".
std::string labelsOf(std::span<const FileFormat> formats);

}  // namespace hairloom
