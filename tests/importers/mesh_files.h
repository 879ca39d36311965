// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Small files written for one test.

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "core/base/file.h"
#include "importers/scene.h"
#include "tests/support/temporary_folder.h"

namespace hairloom::test {

class MeshFiles : public testing::Test {
  protected:
    std::filesystem::path write(const std::string& name, std::string_view content) const {
        auto path = folder / name;
        EXPECT_TRUE(writeFileAtomically(path, content));
        return path;
    }
    Result<ImportedScene> import(const std::string& name, std::string_view content) const {
        return importScene(write(name, content));
    }
    /// Fails the test when the file is refused.
    ImportedScene imported(const std::string& name, std::string_view content) const {
        auto scene = import(name, content);
        EXPECT_TRUE(scene) << scene.error().message();
        return scene ? std::move(*scene) : ImportedScene();
    }
    static std::string warningsOf(const ImportedScene& scene) {
        std::string all;
        for (const std::string& warning : scene.warnings) all += warning + "\n";
        return all;
    }
    /// The message of the refusal; fails the test when the file is loaded.
    std::string refusal(const std::string& name, std::string_view content) const {
        const auto scene = import(name, content);
        EXPECT_FALSE(scene) << name << " is loaded";
        return scene ? std::string() : scene.error().message();
    }

    const TemporaryFolder own_;
    const std::filesystem::path& folder = own_.path();
};

}  // namespace hairloom::test
