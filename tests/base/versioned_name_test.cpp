// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/base/versioned_name.h"

#include <gtest/gtest.h>

namespace hairloom {
namespace {

TEST(VersionedName, TheTokenStandsInPlaceOfTheLastVersion) {
    const auto token = [](const char* path) { return withVersionToken(path).generic_string(); };
    EXPECT_EQ(token("shots/bob_v001.hairloom"), "shots/bob_v###.hairloom");
    EXPECT_EQ(token("bob.hairloom"), "bob_v###.hairloom");
    EXPECT_EQ(token("v2/bob.v0012"), "v2/bob_v###.v0012") << "what looks like an extension is one";
    EXPECT_EQ(token("bob_v1_look_v03_final.hairloom"), "bob_v1_look_v##_final.hairloom");
    EXPECT_EQ(token("rev12.hairloom"), "rev12_v###.hairloom") << "no version: a letter stands before the v";
    EXPECT_EQ(token("v12b.hairloom"), "v12b_v###.hairloom") << "no version: a letter stands behind";
    EXPECT_EQ(token("v1234567890.hairloom"), "v1234567890_v###.hairloom") << "more digits than a version has";
    EXPECT_EQ(token("Zöpfe-v9.hairloom"), "Zöpfe-v#.hairloom");
}

TEST(VersionedName, NamesOfAVersionBeginAlike) {
    EXPECT_EQ(versionBeginning("a_v##/hair.abc", 7).generic_string(), "a_v07");
    EXPECT_EQ(withVersion("a_v##/hair_v###.abc", 7).generic_string(), "a_v07/hair_v007.abc");
    EXPECT_FALSE(hasVersionToken("hair_v.abc"));
    EXPECT_FALSE(hasVersionToken("hairv##.abc"));
}

}  // namespace
}  // namespace hairloom
