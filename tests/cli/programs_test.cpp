// SPDX-License-Identifier: GPL-3.0-or-later
// What programs are linked with.

#include <gmock/gmock.h>

#include <filesystem>
#include <string>

#include "tests/cli/command.h"

namespace hairloom::test {
namespace {

#ifdef __linux__
/// The name of a shared library, and of assimp's own classes where it is linked statically.
constexpr const char* kShared = "libassimp.so";
constexpr const char* kClasses = "N6Assimp";

TEST(Programs, AssimpIsInTheProcessesThatReadAndWriteMeshesAlone) {
    const auto folder = std::filesystem::path(HAIRLOOM_CLI).parent_path();
    for (const char* name : {"hairloom-mesh-reader", "hairloom-mesh-writer"})
        EXPECT_THAT(readText(folder / name), testing::HasSubstr("Assimp")) << name;
    for (const char* name : {"hairloom-cli", "hairloom"}) {
        if (!std::filesystem::exists(folder / name)) continue;
        const std::string bytes = readText(folder / name);
        EXPECT_EQ(bytes.find(kShared), std::string::npos) << name;
        EXPECT_EQ(bytes.find(kClasses), std::string::npos) << name;
    }
}

TEST(Programs, LibavcodecIsInTheProcessThatWritesVideosAlone) {
    const auto folder = std::filesystem::path(HAIRLOOM_CLI).parent_path();
    if (std::filesystem::exists(folder / "hairloom-video-writer")) {
        EXPECT_THAT(readText(folder / "hairloom-video-writer"), testing::HasSubstr("libavcodec.so"));
    }
    for (const char* name : {"hairloom-cli", "hairloom", "hairloom-mesh-reader"}) {
        if (!std::filesystem::exists(folder / name)) continue;
        EXPECT_EQ(readText(folder / name).find("libavcodec.so"), std::string::npos) << name;
    }
}
#endif

}  // namespace
}  // namespace hairloom::test
