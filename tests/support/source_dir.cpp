// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/source_dir.h"

namespace hairloom {

std::filesystem::path sourceDir() {
    return HAIRLOOM_SOURCE_DIR;
}

std::filesystem::path outsideData() {
    return sourceDir() / "../shared/data";
}

}  // namespace hairloom
