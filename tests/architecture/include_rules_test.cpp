// SPDX-License-Identifier: GPL-3.0-or-later
// Reads the includes of every source file and holds the rooms to what docs/architecture.md lets them use.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/support/source_dir.h"

namespace {

namespace fs = std::filesystem;
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
            {"shaders", {}},
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

struct Include {
    std::string file;    ///< from the top of the repository
    std::string target;  ///< as written
};

std::vector<Include> includesOf(const fs::path& top) {
    static const std::regex pattern(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
    static const std::set<std::string> extensions{".h", ".hpp", ".cpp", ".hlsl", ".hlsli"};
    std::vector<Include> found;
    for (const char* folder : {"core", "runtime", "importers", "exporters", "shaders", "editor", "cli",
                               "samples", "benchmarks", "tests"}) {
        if (!fs::exists(top / folder)) continue;
        for (const auto& entry : fs::recursive_directory_iterator(top / folder)) {
            if (!extensions.contains(entry.path().extension().string())) continue;
            std::ifstream file(entry.path());
            std::string line;
            std::smatch match;
            while (std::getline(file, line)) {
                if (!std::regex_search(line, match, pattern)) continue;
                found.push_back({fs::relative(entry.path(), top).generic_string(), match[1]});
            }
        }
    }
    return found;
}

const std::vector<Include>& allIncludes() {
    static const std::vector<Include> includes = includesOf(hairloom::sourceDir());
    return includes;
}

std::string told(const Include& include) {
    return include.file + " includes " + include.target;
}

TEST(IncludeRules, EveryRoomUsesOnlyWhatItMay) {
    ASSERT_GT(allIncludes().size(), 50u);
    std::vector<std::string> broken;
    for (const Include& include : allIncludes()) {
        const std::string from = roomOf(include.file);
        const std::string to = roomOf(include.target);
        ASSERT_FALSE(from.empty()) << include.file << " is in no room";
        if (to.empty() || to == from || allowed().at(from).contains(to)) continue;
        broken.push_back(told(include));
    }
    EXPECT_THAT(broken, IsEmpty());
}

TEST(IncludeRules, QtStaysInTheEditor) {
    static const std::regex qt("^(Q[A-Z][A-Za-z]*(/.*)?|Qt[A-Z].*|qt?[a-z]*vulkan.*)$");
    std::vector<std::string> broken;
    for (const Include& include : allIncludes()) {
        if (include.file.rfind("editor/", 0) == 0 || include.file.rfind("tests/editor/", 0) == 0) continue;
        if (include.file == "benchmarks/window_benchmark.cpp") continue;  // times the editor's window
        if (std::regex_match(include.target, qt)) broken.push_back(told(include));
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
        if (std::regex_match(include.target, vulkan) && include.file.rfind("core/gpu/vulkan/", 0) != 0) {
            broken.push_back(told(include));
        }
        if (std::regex_match(include.target, direct3d) && include.file.rfind("core/gpu/d3d11/", 0) != 0 &&
            !compilers.contains(told(include))) {
            broken.push_back(told(include));
        }
    }
    EXPECT_THAT(broken, IsEmpty());
}

TEST(IncludeRules, RuntimeTakesNothingButTheStandardLibraryAndHighway) {
    std::vector<std::string> broken;
    for (const Include& include : allIncludes()) {
        if (roomOf(include.file) != "runtime") continue;
        const bool own = include.target.rfind("runtime/", 0) == 0;
        const bool standard = include.target.find_first_of("./") == std::string::npos;
        const bool highway = include.target.rfind("hwy/", 0) == 0;
        if (!own && !standard && !highway) broken.push_back(told(include));
    }
    EXPECT_THAT(broken, IsEmpty());
}

TEST(IncludeRules, GplLibrariesAreNotInTheMitRooms) {
    std::vector<std::string> broken;
    for (const Include& include : allIncludes()) {
        if (roomOf(include.file) == "runtime" && include.target.rfind("CGAL/", 0) == 0)
            broken.push_back(told(include));
    }
    EXPECT_THAT(broken, IsEmpty());
}

TEST(Licences, EverySourceFileNamesItsLicence) {
    std::vector<std::string> broken;
    std::set<std::string> seen;
    for (const Include& include : allIncludes()) {
        if (!seen.insert(include.file).second) continue;
        std::ifstream file(hairloom::sourceDir() / include.file);
        std::string first;
        std::getline(file, first);
        const bool mit = roomOf(include.file) == "runtime";
        const std::string licence = mit ? "SPDX-License-Identifier: MIT" : "SPDX-License-Identifier: ";
        if (first.find(licence) == std::string::npos) broken.push_back(include.file);
    }
    EXPECT_THAT(broken, IsEmpty());
}

}  // namespace
