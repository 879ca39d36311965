// SPDX-License-Identifier: GPL-3.0-or-later
// Reads the includes of every source file and holds rooms and the editor's folders to what the tables of
// docs/architecture.md let them use.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/architecture/includes.h"
#include "tests/support/source_dir.h"

namespace hairloom {
namespace {

using testing::IsEmpty;

using Rooms = std::set<std::string>;

std::vector<std::string> split(const std::string& text, char at) {
    std::vector<std::string> parts;
    std::istringstream stream(text);
    for (std::string part; std::getline(stream, part, at);) {
        const auto first = part.find_first_not_of(' '), last = part.find_last_not_of(' ');
        parts.push_back(first == std::string::npos ? std::string() : part.substr(first, last - first + 1));
    }
    return parts;
}

/// "core/base" for "base", "editor/style" for "style": as the row's own folder, core's, or as it stands.
std::string fullName(const std::string& name, const std::string& row,
                     const std::map<std::string, Rooms>& above) {
    for (const std::string& candidate : {row.substr(0, row.find('/') + 1) + name, "core/" + name, name}) {
        if (above.contains(candidate)) return candidate;
    }
    ADD_FAILURE() << row << " may use '" << name << "', which is in no row above it";
    return name;
}

Rooms readUses(std::string column, const std::string& row, const std::map<std::string, Rooms>& above) {
    column = std::regex_replace(column, std::regex("\\(.*\\)"), "");
    Rooms uses;
    const std::string everything = "all above", except = " but ";
    if (column.rfind(everything, 0) != 0) {
        for (const std::string& name : split(column, ',')) {
            if (!name.empty()) uses.insert(fullName(name, row, above));
        }
        return uses;
    }
    for (const auto& [room, its] : above) uses.insert(room);
    if (const auto at = column.find(except); at != std::string::npos) {
        for (const std::string& name : split(column.substr(at + except.size()), ','))
            uses.erase(fullName(name, row, above));
    }
    return uses;
}

/// The tables of docs/architecture.md: what each room may include besides itself, directly; the first is that
/// of the rooms, the second that of the editor's folders. What is not listed may not exist.
std::vector<std::map<std::string, Rooms>> readTables() {
    std::ifstream file(sourceDir() / "docs/architecture.md");
    std::vector<std::map<std::string, Rooms>> tables;
    bool inside = false;
    for (std::string line; std::getline(file, line);) {
        const auto columns = split(line, '|');
        if (columns.size() < 4) {
            inside = false;
        } else if (columns[1] == "module" || columns[1] == "folder") {
            tables.emplace_back();
            inside = true;
        } else if (inside && columns[1].rfind("---", 0) != 0) {
            const Rooms uses = readUses(columns[3], columns[1], tables.back());
            tables.back()[columns[1]] = uses;
        }
    }
    return tables;
}

const std::vector<std::map<std::string, Rooms>>& tables() {
    static const auto read = readTables();
    return read;
}

std::string roomOf(const std::string& path, const std::map<std::string, Rooms>& table) {
    for (const auto& [room, uses] : table) {
        if (path.rfind(room + "/", 0) == 0) return room;
    }
    return {};
}

/// Includes from one room of the table into another that its row does not have.
std::vector<std::string> brokenBy(const std::map<std::string, Rooms>& table) {
    std::vector<std::string> broken;
    for (const Include& include : allIncludes()) {
        const std::string from = roomOf(include.file, table);
        const std::string to = roomOf(include.target, table);
        if (from.empty() || to.empty() || to == from || table.at(from).contains(to)) continue;
        broken.push_back(describe(include));
    }
    return broken;
}

/// Of `top`, the folders that hold sources and have no row.
Rooms foldersWithoutRow(const std::string& top, const std::map<std::string, Rooms>& table) {
    Rooms missing;
    for (const std::string& file : sourceFiles()) {
        const auto end = file.find('/', top.size());
        if (file.rfind(top, 0) == 0 && end != std::string::npos && roomOf(file, table).empty())
            missing.insert(file.substr(0, end));
    }
    return missing;
}

TEST(IncludeRules, EveryRoomUsesOnlyWhatItMay) {
    ASSERT_GT(allIncludes().size(), 50u);
    ASSERT_EQ(tables().size(), 2u);
    EXPECT_GT(tables()[0].size(), 20u);
    EXPECT_THAT(brokenBy(tables()[0]), IsEmpty());
    Rooms missing = foldersWithoutRow("", tables()[0]);
    missing.erase("packaging");
    EXPECT_THAT(missing, IsEmpty());
}

TEST(IncludeRules, EveryFolderOfTheEditorUsesOnlyWhatItMay) {
    ASSERT_EQ(tables().size(), 2u);
    EXPECT_GT(tables()[1].size(), 8u);
    EXPECT_THAT(brokenBy(tables()[1]), IsEmpty());
    EXPECT_THAT(foldersWithoutRow("editor/", tables()[1]), IsEmpty());
}

/// Its seam to them is engine/strand_model.h, and nothing of a model is known before it.
TEST(IncludeRules, TheEngineKnowsNoModelOfStrands) {
    std::vector<std::string> broken;
    std::size_t seen = 0;
    for (const Include& include : allIncludes()) {
        if (include.file.rfind("runtime/engine/", 0) != 0) continue;
        ++seen;
        if (include.target.rfind("runtime/models/", 0) == 0) broken.push_back(describe(include));
    }
    EXPECT_GT(seen, 50u);
    EXPECT_THAT(broken, IsEmpty());
}

/// Its seam is core/gpu_simulation/strand_model.h; the file of a model is in models/.
TEST(IncludeRules, TheEngineOfAGpuKnowsNoModelOfStrands) {
    std::vector<std::string> broken;
    std::size_t seen = 0;
    for (const Include& include : allIncludes()) {
        if (include.file.rfind("core/gpu_simulation/", 0) != 0) continue;
        const bool isModel = include.file.rfind("core/gpu_simulation/models/", 0) == 0;
        seen += isModel ? 0 : 1;
        const bool namesOne = include.target.rfind("runtime/models/", 0) == 0 ||
                              include.target.rfind("core/gpu_simulation/models/", 0) == 0;
        if (!isModel && namesOne) broken.push_back(describe(include));
    }
    EXPECT_GT(seen, 50u);
    EXPECT_THAT(broken, IsEmpty());
}

TEST(IncludeRules, QtStaysInTheEditor) {
    static const std::regex qt("^(Q[A-Z][A-Za-z]*(/.*)?|Qt[A-Z].*|qt?[a-z]*vulkan.*)$");
    std::vector<std::string> broken;
    for (const Include& include : allIncludes()) {
        if (include.file.rfind("editor/", 0) == 0 || include.file.rfind("tests/editor/", 0) == 0) continue;
        if (include.file == "benchmarks/window/main.cpp") continue;  // times the editor's window
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
        // A game's own programs.
        if (include.file.rfind("samples/vulkan/", 0) == 0 || include.file.rfind("samples/direct3d/", 0) == 0)
            continue;
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
