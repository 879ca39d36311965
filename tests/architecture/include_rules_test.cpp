// SPDX-License-Identifier: GPL-3.0-or-later
// Reads the includes of every source file and holds the rooms to what docs/architecture.md lets them use.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/architecture/includes.h"

namespace hairloom {
namespace {

using testing::IsEmpty;

using Rooms = std::set<std::string>;

/// What each room may include besides itself, directly. A room that is not listed may not exist.
const std::map<std::string, Rooms>& allowed() {
    static const std::map<std::string, Rooms> rules = [] {
        const Rooms base{"core/base"};
        const Rooms geometry{"core/base", "core/geometry"};
        const Rooms groom{"core/base", "core/geometry", "core/groom", "runtime"};
        const auto with = [](Rooms rooms, const Rooms& more) {
            rooms.insert(more.begin(), more.end());
            return rooms;
        };
        const Rooms simulation = with(groom, {"core/animation"});
        const Rooms gpu{"core/base", "core/gpu"};
        const Rooms all =
            with(simulation, {"core/editing", "core/interpolation", "core/simulation", "core/shading",
                              "core/gpu", "core/gpu_simulation", "core/render", "core/accuracy",
                              "core/operations", "importers", "exporters", "shaders"});
        return std::map<std::string, Rooms>{
            {"runtime", {}},
            {"core/base", {}},
            {"core/geometry", base},
            {"core/groom", with(geometry, {"runtime"})},
            {"core/interpolation", groom},
            {"core/operations", groom},
            {"core/editing", with(groom, {"core/operations"})},
            {"core/animation", groom},
            {"core/simulation", simulation},
            {"core/shading", base},
            {"core/accuracy",
             with(groom, {"core/simulation", "core/shading", "core/gpu_simulation", "core/render"})},
            {"core/gpu", base},
            {"core/gpu_simulation", with(gpu, {"core/simulation", "core/groom", "runtime", "shaders"})},
            {"core/render", with(gpu, {"core/gpu_simulation", "core/shading", "shaders"})},
            {"importers", with(groom, {"core/animation"})},
            {"exporters", with(groom, {"core/animation", "importers"})},
            {"shaders", {"runtime"}},
            {"core/scene", all},
            {"cli", with(all, {"core/scene"})},
            {"editor", with(all, {"core/scene"})},
            {"samples", with(all, {"core/scene"})},
            {"benchmarks", with(all, {"core/scene", "editor", "tests"})},  // scenes are shared with the tests
            {"tests", with(all, {"core/scene", "cli", "editor", "samples", "tests"})},
        };
    }();
    return rules;
}

std::string roomOf(const std::string& path) {
    for (const auto& [room, uses] : allowed()) {
        if (path.rfind(room + "/", 0) == 0) return room;
    }
    return {};
}

TEST(IncludeRules, EveryRoomUsesOnlyWhatItMay) {
    ASSERT_GT(allIncludes().size(), 50u);
    std::vector<std::string> broken;
    for (const Include& include : allIncludes()) {
        const std::string from = roomOf(include.file);
        const std::string to = roomOf(include.target);
        if (from.empty() && include.file.rfind("packaging/", 0) == 0) continue;
        ASSERT_FALSE(from.empty()) << include.file << " is in no room";
        if (to.empty() || to == from || allowed().at(from).contains(to)) continue;
        broken.push_back(describe(include));
    }
    EXPECT_THAT(broken, IsEmpty());
}

TEST(IncludeRules, QtStaysInTheEditor) {
    static const std::regex qt("^(Q[A-Z][A-Za-z]*(/.*)?|Qt[A-Z].*|qt?[a-z]*vulkan.*)$");
    std::vector<std::string> broken;
    for (const Include& include : allIncludes()) {
        if (include.file.rfind("editor/", 0) == 0 || include.file.rfind("tests/editor/", 0) == 0) continue;
        if (include.file == "benchmarks/window_benchmark.cpp") continue;  // times the editor's window
        if (std::regex_match(include.written, qt)) broken.push_back(describe(include));
    }
    EXPECT_THAT(broken, IsEmpty());
}

TEST(IncludeRules, GraphicsApisStayInTheirBackends) {
    static const std::regex vulkan("^(vulkan/.*|volk\\.h|vk_.*)$");
    static const std::regex direct3d("^(d3d.*|dxgi.*|wrl/.*)$");
    // From text to bytes, without a device, as glslang does it for Vulkan.
    static const std::set<std::string> compilers{
        "core/gpu_simulation/hlsl_to_dxbc.cpp includes d3dcompiler.h",
        "packaging/windows/hlslc.cpp includes d3dcompiler.h"};
    std::vector<std::string> broken;
    for (const Include& include : allIncludes()) {
        if (std::regex_match(include.written, vulkan) && include.file.rfind("core/gpu/vulkan/", 0) != 0) {
            broken.push_back(describe(include));
        }
        if (std::regex_match(include.written, direct3d) && include.file.rfind("core/gpu/d3d11/", 0) != 0 &&
            !compilers.contains(describe(include))) {
            broken.push_back(describe(include));
        }
    }
    EXPECT_THAT(broken, IsEmpty());
}

}  // namespace
}  // namespace hairloom
