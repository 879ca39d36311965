// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/base/utf8.h"

#include <gtest/gtest.h>

namespace hairloom {
namespace {

TEST(CleanUtf8, LeavesTextAndReplacesEachByteThatIsNone) {
    for (const char* text :
         {"", "brows", "Häärchen", "毛", "\xf0\x9f\x92\x87", "\xc2\xa0", "\xf4\x8f\xbf\xbf"})
        EXPECT_EQ(cleanUtf8(text), text);
    EXPECT_EQ(cleanUtf8("a\x80z"), "a?z");
    EXPECT_EQ(cleanUtf8("\xc3"), "?");
    EXPECT_EQ(cleanUtf8("\xe6\xaf"), "??");
    EXPECT_EQ(cleanUtf8("\xc0\xaf"), "??");            // overlong
    EXPECT_EQ(cleanUtf8("\xed\xa0\x80"), "???");       // half of a pair
    EXPECT_EQ(cleanUtf8("\xf4\x90\x80\x80"), "????");  // beyond the last
}

TEST(CleanUtf8, ReplacesWhatTerminalsObey) {
    EXPECT_EQ(cleanUtf8("a\x1b[31m"), "a?[31m");
    EXPECT_EQ(cleanUtf8("a\nb\tc\x7f"), "a?b?c?");
    EXPECT_EQ(cleanUtf8("\xc2\x9b"
                        "31m"),
              "??31m");
    EXPECT_EQ(cleanUtf8(std::string_view("\0", 1)), "?");
}

}  // namespace
}  // namespace hairloom
