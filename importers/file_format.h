// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// File formats as people choose among them: in help texts, messages and the filters of file dialogs.

#include <cstddef>
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

/// Whether a file that starts so is USD: text, binary, or a package of either.
bool startsLikeUsd(std::span<const std::byte> head);
/// Likewise of Alembic, in either of its containers.
bool startsLikeAlembic(std::span<const std::byte> head);

}  // namespace hairloom
