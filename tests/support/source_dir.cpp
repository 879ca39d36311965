// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/source_dir.h"

namespace hairloom {

std::filesystem::path sourceDir() {
    return HAIRLOOM_SOURCE_DIR;
}

}  // namespace hairloom
