// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/architecture/includes.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>

#include "tests/support/source_dir.h"

namespace hairloom {
namespace {

namespace fs = std::filesystem;

/// As compilers look for it: beside the file, then from the top, then from the folders that runtime/ gives
/// them.
std::string resolve(const std::string& file, const std::string& written) {
    const fs::path top = sourceDir();
    for (const fs::path& folder : {fs::path(file).parent_path(), fs::path(), fs::path("runtime/include"),
                                   fs::path("runtime"), fs::path("runtime/shaders")}) {
        const fs::path candidate = (folder / written).lexically_normal();
        if (fs::is_regular_file(top / candidate)) return candidate.generic_string();
    }
    return {};
}

std::vector<std::string> findSources() {
    static const std::set<std::string> kExtensions{".h", ".hpp", ".cpp", ".hlsl", ".hlsli"};
    const fs::path top = sourceDir();
    std::vector<std::string> found;
    for (const char* folder : {"core", "runtime", "importers", "exporters", "shaders", "editor", "cli",
                               "samples", "benchmarks", "tests", "packaging", "python"}) {
        for (const auto& entry : fs::recursive_directory_iterator(top / folder)) {
            if (kExtensions.contains(entry.path().extension().string()))
                found.push_back(fs::relative(entry.path(), top).generic_string());
        }
    }
    std::sort(found.begin(), found.end());
    return found;
}

std::vector<Include> findIncludes() {
    static const std::regex kPattern(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
    std::vector<Include> found;
    for (const std::string& path : sourceFiles()) {
        std::ifstream file(sourceDir() / path);
        std::smatch match;
        for (std::string line; std::getline(file, line);) {
            if (std::regex_search(line, match, kPattern))
                found.push_back({path, match[1], resolve(path, match[1])});
        }
    }
    return found;
}

}  // namespace

const std::vector<std::string>& sourceFiles() {
    static const std::vector<std::string> kFiles = findSources();
    return kFiles;
}

const std::vector<Include>& allIncludes() {
    static const std::vector<Include> kIncludes = findIncludes();
    return kIncludes;
}

std::string describe(const Include& include) {
    return include.file + " includes " + include.written;
}

std::string licenceOf(const std::string& file) {
    static const std::regex kPattern(R"(SPDX-License-Identifier: ([A-Za-z0-9.-]+))");
    std::ifstream stream(sourceDir() / file);
    std::string first;
    std::getline(stream, first);
    std::smatch match;
    return std::regex_search(first, match, kPattern) ? match[1].str() : std::string();
}

}  // namespace hairloom
