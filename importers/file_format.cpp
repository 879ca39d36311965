// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/file_format.h"

namespace hairloom {

std::string labelsOf(std::span<const FileFormat> formats) {
    std::string text;
    for (std::size_t i = 0; i < formats.size(); ++i) {
        if (i > 0) text += i + 1 < formats.size() ? ", " : " or ";
        text += formats[i].label;
    }
    return text;
}

}  // namespace hairloom
