// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/script.h"

#include <gmock/gmock.h>

#include "core/base/file.h"
#include "core/groom/groom_hash.h"
#include "core/operations/flow.h"
#include "core/operations/noise.h"
#include "tests/groom/groom_samples.h"
#include "tests/support/source_dir.h"

namespace hairloom {
namespace {

using testing::HasSubstr;

std::string parseError(std::string_view text) {
    const auto script = parseScript("s.json", text);
    return script ? "it was parsed" : script.error().message();
}

TEST(Script, RunsWhatItSays) {
    Groom scripted = straightHair(sphereScalp(), 60, 12, 0.1f);
    Groom byHand = scripted;
    const auto script = parseScript("s.json", R"({"hairloom_script": 1, "operations": [
        {"op": "flow", "crown": [0, 1.69, 0], "liftRoot": 0.02, "seed": 7},
        {"op": "noise", "amplitude": 0.002, "region": {"normal": [1, 0, 0]}}]})");
    ASSERT_TRUE(script) << script.error().message();
    const auto report = runScript(*script, scripted);
    ASSERT_TRUE(report) << report.error().message();

    FlowSettings laid;
    laid.crown = Vec3f(0, 1.69f, 0);
    laid.liftRoot = 0.02f;
    laid.seed = 7;
    NoiseSettings bent;
    bent.amplitude = 0.002f;
    Region right;
    right.normal = Vec3f(1, 0, 0);
    const std::size_t first = flow(byHand, laid).value();
    const std::size_t second = noise(byHand, bent, right).value();
    EXPECT_TRUE(sameContent(scripted, byHand));
    EXPECT_EQ(report->strokes, 2u);
    EXPECT_EQ(report->touchedStrands, 60u);
    EXPECT_THAT(report->touchedByStep, testing::ElementsAre(first, second));
    EXPECT_LT(second, first);
}

TEST(Script, NamesWhatIsWrongAndWhatIsAllowed) {
    const auto oneStep = [](std::string_view step) {
        return R"({"hairloom_script": 1, "operations": [)" + std::string(step) + "]}";
    };
    EXPECT_THAT(parseError(oneStep(R"({"op": "comb"})")),
                HasSubstr("/operations/0/op is \"comb\"; expected one of set_length, flow, part"));
    EXPECT_THAT(
        parseError(oneStep(R"({"op": "curl", "raduis": 1})")),
        HasSubstr("/operations/0/raduis is not known to this program; expected only clearance, formulas, "
                  "frequency, mask"));
    EXPECT_THAT(parseError(oneStep(R"({"op": "curl", "radius": 1})")),
                HasSubstr("/operations/0/radius is 1; expected a number from 0 to 0.1 m"));
    EXPECT_THAT(parseError(oneStep(R"({"op": "smooth", "passes": 1.5})")),
                HasSubstr("/operations/0/passes is 1.5"));
    EXPECT_THAT(parseError(oneStep(R"({"op": "flow", "crown": [1, 2]})")), HasSubstr("/operations/0/crown"));
    EXPECT_THAT(parseError(oneStep(R"({"op": "smooth", "region": {"radius": 1}})")),
                HasSubstr("/operations/0/region/radius is not known"));
    EXPECT_THAT(parseError(oneStep("7")), HasSubstr("/operations/0 is 7; expected an object"));
    EXPECT_THAT(parseError(R"({"operations": []})"), HasSubstr("/hairloom_script is missing"));
    EXPECT_THAT(parseError(R"({"hairloom_script": 1})"), HasSubstr("/operations is missing"));
    EXPECT_THAT(parseError(R"({"hairloom_script": 2, "operations": []})"),
                HasSubstr("the script is version 2, but this program reads versions up to 1"));
    EXPECT_THAT(parseError("{"), HasSubstr("s.json@1: JSON is damaged"));
    EXPECT_EQ(parseError(oneStep(R"({"op": "smooth"})")), "it was parsed");
}

TEST(Script, AnErrorLeavesTheGroomAsItWas) {
    Groom groom = makeGroom({0, 3}, {Vec3f(0, 0, 0), Vec3f(0.1f, 0, 0), Vec3f(0.2f, 0, 0)});
    const std::uint64_t before = contentHash(groom);
    const auto script =
        parseScript("s.json", R"({"hairloom_script": 1, "operations": [{"op": "drape"}, {"op": "flow"}]})");
    ASSERT_TRUE(script);
    const auto report = runScript(*script, groom);
    ASSERT_FALSE(report);
    EXPECT_THAT(report.error().message(), HasSubstr("operation 1: flow: the groom has no scalp"));
    EXPECT_EQ(contentHash(groom), before);
}

TEST(Script, OperationsAreListedInTheOrderOfTheirNumbers) {
    int before = -1;
    for (const Operation& operation : operations()) {
        EXPECT_GT(operation.order, before) << operation.name << ": no two have the same place";
        before = operation.order;
    }
    EXPECT_EQ(operations().size(), operationEntries().size());
    EXPECT_EQ(operations().front().name, "set_length");
}

TEST(Script, EachOperationHasItsPlaceInTheFormatsPage) {
    const auto text = readTextFile(sourceDir() / "docs/formats/script.md");
    ASSERT_TRUE(text);
    for (const Operation& operation : operations())
        EXPECT_THAT(*text, HasSubstr("`" + std::string(operation.name) + "`"));
    for (const FieldRow& field : scriptRegionFields())
        EXPECT_THAT(*text, HasSubstr("`" + std::string(field.info.name) + "`"));
}

}  // namespace
}  // namespace hairloom
