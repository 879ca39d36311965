// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/reader_security.h"

#include <gtest/gtest.h>

#include <map>

namespace hairloom {
namespace {

/// What each layer takes, with none of the others.
#ifdef _WIN32
const std::multimap<std::string, std::string> kTakes{{"memory", "memory"},
                                                     {"programs", "programs"},
                                                     {"integrity", "write"},
                                                     {"integrity", "signals"},
                                                     {"integrity", "limits"}};
constexpr const char* kLayers[] = {"memory", "programs", "integrity"};
#else
const std::multimap<std::string, std::string> kTakes{
    {"system_calls", "network"}, {"system_calls", "write"},  {"system_calls", "programs"},
    {"system_calls", "signals"}, {"system_calls", "limits"}, {"system_calls", "code"},
    {"files", "write"},          {"files", "other_files"},   {"paths", "other_files"},
    {"paths", "stat"},           {"processes", "signals"},   {"processes", "limits"},
    {"memory", "memory"}};
constexpr const char* kLayers[] = {"memory", "processes", "paths", "files", "system_calls"};
#endif

TEST(ReaderSecurity, EveryLayerThatIsSetRefusesWhatItIsFor) {
    const auto found = readerSecurity();
    ASSERT_TRUE(found) << found.error().message();
    std::map<std::string, std::string> rows(found->begin(), found->end());
    std::size_t set = 0;
    for (const char* layer : kLayers) {
        const std::string state = rows[std::string("layer_") + layer];
        EXPECT_TRUE(state == "set" || state == "missing") << layer << " is '" << state << "'";
        set += state == "set" ? 1 : 0;
    }
    for (const auto& [layer, what] : kTakes) {
        if (rows["layer_" + layer] != "set") continue;
        EXPECT_EQ(rows["refuses_" + what], "true") << layer << " is set";
    }
#ifndef _WIN32
    EXPECT_EQ(rows["seccomp"], rows["layer_system_calls"] == "set" ? "true" : "false");
    EXPECT_EQ(rows["landlock"], rows["layer_files"] == "set" ? "true" : "false");
#endif
    if (set == 0) GTEST_SKIP() << "this system has none of the layers";
}

}  // namespace
}  // namespace hairloom
