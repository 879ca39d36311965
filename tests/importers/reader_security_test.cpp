// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/reader_security.h"

#include <gtest/gtest.h>

#include <map>

namespace hairloom {
namespace {

TEST(ReaderSecurity, WhatTheKernelTakesIsRefused) {
    const auto found = readerSecurity();
    ASSERT_TRUE(found) << found.error().message();
    std::map<std::string, std::string> rows(found->begin(), found->end());
    ASSERT_EQ(rows.size(), 7u);
    EXPECT_EQ(rows["refuses_network"], rows["seccomp"]);
    EXPECT_EQ(rows["refuses_programs"], rows["seccomp"]);
    EXPECT_EQ(rows["refuses_other_files"], rows["landlock"]);
    const bool neither = rows["seccomp"] == "false" && rows["landlock"] == "false";
    EXPECT_EQ(rows["refuses_write"], neither ? "false" : "true");
    if (neither) GTEST_SKIP() << "this system has neither seccomp nor Landlock";
}

}  // namespace
}  // namespace hairloom
