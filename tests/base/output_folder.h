// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A folder of a test's own, and files in it.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include "core/base/file.h"
#include "core/base/write_rules.h"
#include "tests/support/temporary_folder.h"

namespace hairloom {

class OutputFileTest : public testing::Test {
  protected:
    void TearDown() override { setWriteRules({}); }
    std::size_t filesInFolder() const {
        return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder),
                                                      std::filesystem::directory_iterator()));
    }
    void put(const std::string& name, std::string_view text) const {
        std::ofstream(folder / name, std::ios::binary) << text;
    }
    std::string get(const std::string& name) const {
        std::ifstream file(folder / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    /// The error of writing text over a file, or nothing.
    std::string writeError(const std::string& name, std::string_view text) const {
        const auto status = writeFileAtomically(folder / name, text);
        return status ? std::string() : status.error().message();
    }
    const TemporaryFolder own_;
    const std::filesystem::path& folder = own_.path();
};

}  // namespace hairloom
