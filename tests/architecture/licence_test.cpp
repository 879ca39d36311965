// SPDX-License-Identifier: GPL-3.0-or-later
// What games link is MIT, and so is everything of ours that it includes, however far down.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>
#include <vector>

#include "tests/architecture/includes.h"

namespace hairloom {
namespace {

using testing::IsEmpty;

bool inRuntime(const std::string& file) {
    return file.rfind("runtime/", 0) == 0;
}

/// What games are told to copy (docs/integrate.md).
bool isForGames(const std::string& file) {
    return file == "samples/player/main.cpp" || file == "samples/gpu_host.h" ||
           file.rfind("samples/vulkan/", 0) == 0 || file.rfind("samples/direct3d/", 0) == 0 ||
           file == "tests/runtime/installed/step_strands.cpp";
}

TEST(Licences, EverySourceFileNamesItsLicence) {
    std::vector<std::string> broken;
    for (const std::string& file : sourceFiles()) {
        const std::string licence = licenceOf(file);
        if (licence != (inRuntime(file) || isForGames(file) ? "MIT" : "GPL-3.0-or-later"))
            broken.push_back(file + ": " + licence);
    }
    EXPECT_THAT(broken, IsEmpty());
}

TEST(Licences, MitFilesReachOnlyMitFiles) {
    std::map<std::string, std::set<std::string>> uses;
    for (const Include& include : allIncludes()) {
        if (!include.target.empty()) uses[include.file].insert(include.target);
    }
    std::vector<std::string> broken;
    std::size_t followed = 0;
    for (const std::string& file : sourceFiles()) {
        if (licenceOf(file) != "MIT") continue;
        std::set<std::string> reached{file};
        std::vector<std::string> open{file};
        while (!open.empty()) {
            const std::string from = open.back();
            open.pop_back();
            for (const std::string& target : uses[from]) {
                if (!reached.insert(target).second) continue;
                ++followed;
                if (licenceOf(target) != "MIT") broken.push_back(file + " reaches " + target + " by " + from);
                open.push_back(target);
            }
        }
    }
    EXPECT_GT(followed, 200u);
    EXPECT_THAT(broken, IsEmpty());
}

TEST(Licences, RuntimeTakesNothingButItselfTheStandardLibraryAndHighway) {
    std::vector<std::string> broken;
    for (const Include& include : allIncludes()) {
        if (!inRuntime(include.file)) continue;
        const bool ofC = include.written == "stddef.h" || include.written == "stdint.h";
        const bool standard = ofC || include.written.find_first_of("./") == std::string::npos;
        const bool highway = include.written.rfind("hwy/", 0) == 0;
        const bool ours = inRuntime(include.target);
        // Written as a copy of runtime/ alone finds it.
        const bool alone = include.written.rfind("runtime/", 0) != 0;
        if (!(ours && alone) && !standard && !highway) broken.push_back(describe(include));
    }
    EXPECT_THAT(broken, IsEmpty());
}

TEST(Licences, PublicHeadersOfTheRuntimeIncludeNoneOfItsInside) {
    std::vector<std::string> broken;
    for (const Include& include : allIncludes()) {
        if (include.file.rfind("runtime/include/", 0) != 0 || include.target.empty()) continue;
        if (include.target.rfind("runtime/include/", 0) != 0) broken.push_back(describe(include));
    }
    EXPECT_THAT(broken, IsEmpty());
}

}  // namespace
}  // namespace hairloom
