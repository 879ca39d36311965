// SPDX-License-Identifier: GPL-3.0-or-later
// Operators in files of their own: presets.
#include "core/operations/stack_file.h"

#include <gmock/gmock.h>

#include "tests/groom/groom_samples.h"
#include "tests/support/temporary_folder.h"

namespace hairloom {
namespace {

using testing::HasSubstr;

class StackFile : public testing::Test {
  protected:
    const TemporaryFolder folder_;
};

TEST_F(StackFile, ComesBackWithMasksAndCurvesAndWithoutSculpts) {
    Operator part = newOperator("part");
    setCurveOf(part, {{Vec3f(0, 1.7f, 0.05f), Vec3f(0, 1.72f, 0), Vec3f(0, 1.7f, -0.05f)}});
    Operator curl = newOperator("curl");
    curl.weight = 0.5f;
    curl.enabled = false;
    Mask mask;
    mask.map = MaskMap::mask2;
    mask.ramp = runtime::Ramp::straight(0, 1);
    setMaskOf(curl, mask);
    const std::vector<Operator> stack{part, newOperator(kSculpt), curl};
    const auto file = stackPresetFile(folder_.path(), "parted curls");
    ASSERT_TRUE(file);
    ASSERT_TRUE(saveOperators(*file, stack));
    const auto loaded = loadOperators(*file);
    ASSERT_TRUE(loaded) << loaded.error().message();
    EXPECT_EQ(*loaded, (std::vector<Operator>{part, curl}));
    EXPECT_EQ(curveOf((*loaded)[0]).points.size(), 3u);
    EXPECT_EQ(maskOf((*loaded)[1]).map, MaskMap::mask2);
    EXPECT_EQ(stackPresets(folder_.path()), std::vector<std::string>{"parted curls"});
}

TEST_F(StackFile, NamesWhatIsWrong) {
    EXPECT_FALSE(stackPresetFile(folder_.path(), "../up"));
    EXPECT_FALSE(stackPresetFile(folder_.path(), ""));
    const auto none = saveOperators(folder_ / "a.stack.json", std::vector<Operator>{newOperator(kSculpt)});
    ASSERT_FALSE(none);
    EXPECT_THAT(none.error().message(), HasSubstr("a.stack.json: there is no operator to save"));
    EXPECT_TRUE(stackPresets(folder_ / "nowhere").empty());
    const auto unknown = parseOperators("clipboard", R"({"operators": [{"op": "perm"}]})");
    ASSERT_FALSE(unknown);
    EXPECT_THAT(unknown.error().message(), HasSubstr("clipboard: /operators/0/op is \"perm\""));
    EXPECT_FALSE(parseOperators("clipboard", "hello"));
}

}  // namespace
}  // namespace hairloom
