// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/temporary_folder.h"

#include <random>
#include <string>
#include <system_error>

namespace hairloom {

TemporaryFolder::TemporaryFolder() {
    std::random_device random;
    // Only who makes a folder has it.
    do {
        path_ = std::filesystem::temp_directory_path() / ("hairloom-test-" + std::to_string(random()));
    } while (!std::filesystem::create_directory(path_));
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

}  // namespace hairloom
