// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/base/result.h"

#include <gtest/gtest.h>

namespace hairloom {
namespace {

TEST(Result, MessageNamesFileLineProblemAndExpectation) {
    EXPECT_EQ((Error{"a.obj", Line{3}, "found 2 indices", "expected 3 or more"}).message(),
              "a.obj:3: found 2 indices; expected 3 or more");
    EXPECT_EQ((Error{"a.tfx", Byte{160}, "cut short", ""}).message(), "a.tfx@160: cut short");
    EXPECT_EQ((Error{"", {}, "no GPU", ""}).message(), "no GPU");
}

TEST(Result, InFileKeepsAFileThatIsAlreadyNamed) {
    EXPECT_EQ(inFile(Error{"inner", {}, "x", ""}, "outer").file, "inner");
    EXPECT_EQ(inFile(Error{"", {}, "x", ""}, "outer").file, "outer");
}

}  // namespace
}  // namespace hairloom
