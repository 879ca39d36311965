// SPDX-License-Identifier: GPL-3.0-or-later
// Operators that stay open: what they make of a base shape, what is kept between runs, and their files.
#include "core/operations/stack.h"

#include <gmock/gmock.h>

#include "core/base/file.h"
#include "core/base/parallel.h"
#include "core/geometry/curve.h"
#include "core/groom/file/operators_json.h"
#include "core/groom/file/project_file.h"
#include "core/groom/groom_hash.h"
#include "core/groom/validate.h"
#include "core/operations/curl.h"
#include "core/operations/flow.h"
#include "core/operations/noise.h"
#include "core/operations/sculpt.h"
#include "core/operations/trim.h"
#include "tests/groom/groom_samples.h"
#include "tests/support/temporary_folder.h"

namespace hairloom {
namespace {

using testing::HasSubstr;

Operator operatorOf(const std::string& json) {
    const nlohmann::json parsed = nlohmann::json::parse(json);
    JsonReader reader(parsed, "o.json");
    Operator one = readOperator(reader);
    EXPECT_TRUE(reader.ok()) << reader.status().error().message();
    return one;
}

/// Flow, curl on one side, trim.
Groom stacked() {
    Groom groom = straightHair(sphereScalp(), 60, 12, 0.1f);
    groom.pointAttributes.set(attribute::kBasePosition,
                              groom.pointAttributes.all().find(attribute::kPosition)->second);
    groom.operators = {operatorOf(R"({"op": "flow", "crown": [0, 1.69, 0], "seed": 7})"),
                       operatorOf(R"({"op": "curl", "region": {"normal": [1, 0, 0]}})"),
                       operatorOf(R"({"op": "trim", "maxLength": 0.08})")};
    return groom;
}

AttributeData evaluate(const Groom& groom, StackCache& cache) {
    auto shape = evaluateStack(groom, cache);
    EXPECT_TRUE(shape) << shape.error().message();
    return *shape;
}
std::span<const Vec3f> points(const AttributeData& shape) {
    return std::get<CowArray<Vec3f>>(shape).view();
}
/// From a cache of its own.
std::vector<Vec3f> evaluated(const Groom& groom) {
    StackCache cache;
    const AttributeData shape = evaluate(groom, cache);
    return {points(shape).begin(), points(shape).end()};
}

TEST(Stack, MakesWhatTheOperationsMakeInTheirOrder) {
    const Groom groom = stacked();
    Groom byHand = straightHair(sphereScalp(), 60, 12, 0.1f);
    FlowSettings laid;
    laid.crown = Vec3f(0, 1.69f, 0);
    laid.seed = 7;
    Region right;
    right.normal = Vec3f(1, 0, 0);
    TrimSettings cut;
    cut.maxLength = 0.08f;
    ASSERT_TRUE(flow(byHand, laid));
    ASSERT_TRUE(curl(byHand, {}, right));
    ASSERT_TRUE(trim(byHand, cut));
    EXPECT_TRUE(std::ranges::equal(evaluated(groom), byHand.positions()));
}

TEST(Stack, SameBitsForAnyNumberOfThreads) {
    const Groom groom = stacked();
    setThreadCount(1);
    const auto one = evaluated(groom);
    setThreadCount(7);
    EXPECT_EQ(evaluated(groom), one);
    setThreadCount(0);
}

TEST(Stack, RunsAgainFromTheFirstOperatorThatChanged) {
    Groom groom = stacked();
    StackCache cache;
    const Version first = versionOf(*evaluateStack(groom, cache, 1));
    const Version second = versionOf(*evaluateStack(groom, cache, 2));
    const Version whole = versionOf(evaluate(groom, cache));
    EXPECT_EQ(versionOf(evaluate(groom, cache)), whole) << "nothing has changed";

    groom.operators[1] = operatorOf(R"({"op": "curl", "radius": 0.002})");
    EXPECT_NE(versionOf(evaluate(groom, cache)), whole);
    EXPECT_EQ(versionOf(*evaluateStack(groom, cache, 1)), first) << "below the change";
    EXPECT_NE(versionOf(*evaluateStack(groom, cache, 2)), second);
    const AttributeData kept = evaluate(groom, cache);
    EXPECT_TRUE(std::ranges::equal(points(kept), evaluated(groom)));

    groom.strandAttributes.edit<std::uint32_t>(attribute::kStrandId)[3] = 999;
    const AttributeData renamed = evaluate(groom, cache);
    EXPECT_TRUE(std::ranges::equal(points(renamed), evaluated(groom))) << "other ids draw other numbers";
}

TEST(Stack, MutedAndWeightlessOperatorsLeaveNoTrace) {
    Groom groom = stacked();
    Groom without = groom;
    without.operators.erase(without.operators.begin() + 1);
    groom.operators[1].enabled = false;
    EXPECT_EQ(evaluated(groom), evaluated(without));
    groom.operators[1].enabled = true;
    groom.operators[1].weight = 0;
    EXPECT_EQ(evaluated(groom), evaluated(without));
    for (Operator& one : groom.operators) one.enabled = false;
    EXPECT_TRUE(std::ranges::equal(evaluated(groom), groom.positions())) << "the base shape";
}

TEST(Stack, WeightLeadsFromNothingToAllAndKeepsLengths) {
    Groom groom = stacked();
    groom.operators = {operatorOf(R"({"op": "curl", "clearance": 0})")};
    const auto whole = evaluated(groom);
    groom.operators[0].weight = 0.5f;
    const auto half = evaluated(groom);
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        const auto strand = std::span(half).subspan(groom.offsets[s], 12);
        EXPECT_NEAR(polylineLength(strand), 0.1f, 1e-5f);
        const float toBase = (strand.back() - groom.strand(s).back()).norm();
        const float toWhole = (strand.back() - whole[groom.offsets[s] + 11]).norm();
        EXPECT_LT(std::abs(toBase - toWhole), 0.7f * (toBase + toWhole)) << "between both";
    }
    groom.operators[0].weight = 1e-6f;
    const auto almostNone = evaluated(groom);
    for (std::size_t i = 0; i < almostNone.size(); ++i)
        EXPECT_LT((almostNone[i] - groom.positions()[i]).norm(), 1e-5f);
}

/// Every second strand is painted.
Groom halfPainted() {
    Groom groom = stacked();
    std::vector<float> mask(groom.strandCount());
    for (std::size_t s = 0; s < mask.size(); ++s) mask[s] = s % 2 == 0 ? 1.0f : 0.0f;
    groom.strandAttributes.set("mask.2", mask);
    std::vector<Vec3f> strokes(groom.pointCount(), Vec3f(0.5f, 0, 0));
    groom.pointAttributes.set(sculptAttribute(0), strokes);
    return groom;
}

TEST(Stack, MasksKeepEveryOperatorToWhatIsPainted) {
    for (const StackOperator& known : stackOperators()) {
        SCOPED_TRACE(known.name);
        Groom groom = halfPainted();
        Operator one = newOperator(known.name);
        groom.operators = {one};
        const auto whole = evaluated(groom);
        const auto base = groom.positions();
        for (const bool invert : {false, true}) {
            Mask mask;
            mask.map = MaskMap::mask2;
            mask.invert = invert;
            setMaskOf(one, mask);
            groom.operators = {one};
            const auto masked = evaluated(groom);
            for (std::size_t s = 0; s < groom.strandCount(); ++s) {
                const std::size_t first = groom.offsets[s];
                for (std::size_t i = first; i < first + 12; ++i) {
                    if ((s % 2 == 0) == invert) {
                        EXPECT_EQ(masked[i], base[i]) << "strand " << s;
                    } else {
                        EXPECT_LT((masked[i] - whole[i]).norm(), 1e-6f) << "strand " << s;
                    }
                }
            }
        }
    }
}

TEST(Stack, ARampLetsTipsFollowAndRootsStay) {
    Groom groom = stacked();
    Operator one = operatorOf(
        R"({"op": "drape", "amount": 1, "rootAmount": 1, "clearance": 0, "mask": {"ramp": [[0, 0], [0.5, 0], [1, 1]]}})");
    groom.operators = {one};
    const auto shape = evaluated(groom);
    std::size_t turned = 0;
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        const auto base = groom.strand(s);
        const std::size_t first = groom.offsets[s];
        for (std::size_t i = 0; i < 12; ++i) {
            if (i > 5) continue;
            EXPECT_EQ(shape[first + i], base[i]) << "strand " << s << ", point " << i;
        }
        EXPECT_NEAR(polylineLength(std::span(shape).subspan(first, 12)), 0.1f, 1e-5f);
        turned += (shape[first + 11] - base[11]).norm() > 0.005f ? 1 : 0;
    }
    EXPECT_GT(turned, groom.strandCount() / 2);
    EXPECT_EQ(maskOf(one).ramp.count, 3u);
}

TEST(Stack, PaintingAMaskRunsTheOperatorsThatHaveIt) {
    Groom groom = halfPainted();
    groom.operators[1] = operatorOf(R"({"op": "curl", "mask": {"map": "mask2"}})");
    EXPECT_TRUE(readsMaps(groom.operators));
    StackCache cache;
    const Version first = versionOf(*evaluateStack(groom, cache, 1));
    const Version second = versionOf(*evaluateStack(groom, cache, 2));
    groom.strandAttributes.edit<float>("mask.2")[1] = 0.5f;
    EXPECT_EQ(versionOf(*evaluateStack(groom, cache, 1)), first);
    EXPECT_NE(versionOf(*evaluateStack(groom, cache, 2)), second);
    const AttributeData kept = evaluate(groom, cache);
    EXPECT_TRUE(std::ranges::equal(points(kept), evaluated(groom)));
}

TEST(Stack, MasksShowTheDensityOfTheScalpAndTheDyeOfPoints) {
    Groom groom = stacked();
    groom.scalpDensity.assign(groom.scalp->positions().size(), 1);
    for (std::size_t v = 0; v < groom.scalpDensity.size(); ++v)
        groom.scalpDensity[v] = groom.scalp->positions()[v].x() > 0 ? 1.0f : 0.0f;
    Mask mask;
    mask.map = MaskMap::density;
    const auto shares = maskShares(groom, mask, groom.positions()).value();
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        const float x = groom.strand(s)[0].x();
        if (std::abs(x) < 0.03f) continue;
        EXPECT_NEAR(shares[groom.offsets[s]], x > 0 ? 1 : 0, 1e-6f);
    }
    std::vector<float> dye(groom.pointCount(), 0.25f);
    groom.pointAttributes.set("dye", dye);
    mask.map = MaskMap::dye;
    mask.invert = true;
    EXPECT_FLOAT_EQ(maskShares(groom, mask, groom.positions()).value()[7], 0.75f);

    Groom bare = makeGroom({0, 2}, {Vec3f(0, 0, 0), Vec3f(0, 0.1f, 0)});
    mask.map = MaskMap::density;
    const auto run = runMasked(bare, mask, [](Groom&) -> Result<std::size_t> { return 1; });
    ASSERT_FALSE(run);
    EXPECT_THAT(run.error().message(), HasSubstr("bound to no scalp"));
}

TEST(Stack, ARegionMayBeAGroupOfTheFile) {
    Groom groom = halfPainted();
    std::vector<std::uint32_t> groups(groom.strandCount());
    for (std::size_t s = 0; s < groups.size(); ++s) groups[s] = s % 2;
    groom.groupNames = {"even", "odd"};
    groom.strandAttributes.set(attribute::kGroup, groups);
    groom.operators = {operatorOf(R"({"op": "drape", "region": {"group": 2}})")};
    const auto shape = evaluated(groom);
    for (std::size_t s = 0; s < groom.strandCount(); ++s)
        EXPECT_EQ(shape[groom.offsets[s] + 11] == groom.strand(s)[11], s % 2 == 0) << "strand " << s;
}

TEST(Stack, ActsOnFrozenAndLockedStrandsToo) {
    Groom groom = stacked();
    const auto free = evaluated(groom);
    groom.strandAttributes.set(attribute::kFrozen, std::vector<std::uint8_t>(groom.strandCount(), 1));
    groom.layers[0].locked = true;
    EXPECT_EQ(evaluated(groom), free);
}

TEST(Stack, RegionThatReachesNothingChangesNothing) {
    Groom groom = stacked();
    for (Operator& one : groom.operators)
        one = operatorOf(R"({"op": "noise", "region": {"point": [0, 900, 0], "normal": [0, 1, 0]}})");
    EXPECT_TRUE(std::ranges::equal(evaluated(groom), groom.positions()));
}

TEST(Stack, EveryOperatorDoesWellOnHairOfAnySize) {
    for (const StackOperator& known : stackOperators()) {
        SCOPED_TRACE(known.name);
        for (const auto& [strands, count] :
             std::initializer_list<std::pair<std::size_t, std::uint32_t>>{{0, 2}, {1, 2}, {1, 16}, {7, 2}}) {
            Groom groom = straightHair(sphereScalp(), strands, count, 0.1f);
            groom.pointAttributes.set(attribute::kBasePosition,
                                      groom.pointAttributes.all().find(attribute::kPosition)->second);
            groom.operators = {newOperator(known.name)};
            if (known.name == kSculpt)
                groom.pointAttributes.set(sculptAttribute(0), std::vector<Vec3f>(groom.pointCount()));
            for (const Vec3f& point : evaluated(groom)) EXPECT_TRUE(point.allFinite());
        }
    }
}

TEST(Stack, NamesTheOperatorThatCannotWork) {
    Groom groom = makeGroom({0, 2}, {Vec3f(0, 0, 0), Vec3f(0, 0.1f, 0)});
    groom.pointAttributes.set(attribute::kBasePosition,
                              groom.pointAttributes.all().find(attribute::kPosition)->second);
    groom.operators = {newOperator("curl"), newOperator("flow")};
    StackCache cache;
    const auto shape = evaluateStack(groom, cache);
    ASSERT_FALSE(shape);
    EXPECT_THAT(shape.error().message(), HasSubstr("operator 1: flow: the groom has no scalp"));
}

std::string readError(const std::string& json) {
    const nlohmann::json parsed = nlohmann::json::parse(json);
    JsonReader reader(parsed, "o.json");
    readOperators(reader);
    reader.finish();
    return reader.ok() ? "it was read" : reader.status().error().message();
}

TEST(Stack, ReadingNamesWhatIsWrongAndWhatIsAllowed) {
    EXPECT_EQ(readError(R"({"operators": [{"op": "curl"}, {"op": "sculpt", "number": 3}]})"), "it was read");
    EXPECT_THAT(readError(R"({"operators": [{"op": "comb"}]})"),
                HasSubstr("/operators/0/op is \"comb\"; expected one of set_length, flow"));
    EXPECT_THAT(readError(R"({"operators": [{"op": "dye"}]})"), HasSubstr("/operators/0/op is \"dye\""));
    EXPECT_THAT(readError(R"({"operators": [{"op": "curl"}, {"op": "curl", "raduis": 1}]})"),
                HasSubstr("/operators/1/raduis is not known"));
    EXPECT_THAT(readError(R"({"operators": [{"op": "curl", "weight": 2}]})"),
                HasSubstr("/operators/0/weight is 2; expected a number from 0 to 1"));
    EXPECT_THAT(readError(R"({"operators": [{"op": "curl", "region": {"fade": -1}}]})"),
                HasSubstr("/operators/0/region/fade is -1"));
    EXPECT_THAT(readError(R"({"operators": [{"op": "curl", "number": 1}]})"),
                HasSubstr("/operators/0/number is not known"));
    std::string many = R"({"op": "curl"})";
    for (std::size_t i = 0; i < kMaxOperators; ++i) many += R"(, {"op": "curl"})";
    EXPECT_THAT(readError(R"({"operators": [)" + many + "]}"), HasSubstr("/operators has 65 entries"));
}

TEST(Stack, IsSavedAndLoadedWithItsBaseShape) {
    const TemporaryFolder folder;
    Groom groom = stacked();
    groom.operators[1].enabled = false;
    groom.operators[2].weight = 0.3f;
    groom.operators.push_back(newOperator(kSculpt));
    groom.operators.back().number = 4;
    groom.pointAttributes.set(sculptAttribute(4), std::vector<Vec3f>(groom.pointCount(), Vec3f(0.1f, 0, 0)));
    ASSERT_TRUE(saveProject(groom, folder / "a.hairloom"));
    auto loaded = readProjectFile(folder / "a.hairloom");
    ASSERT_TRUE(loaded) << loaded.error().message();
    ASSERT_TRUE(completeOperators("a.hairloom", *loaded));
    EXPECT_TRUE(sameContent(*loaded, groom));
    EXPECT_EQ(evaluated(*loaded), evaluated(groom));
    ASSERT_TRUE(saveProject(*loaded, folder / "b.hairloom"));
    EXPECT_EQ(readFile(folder / "a.hairloom").value(), readFile(folder / "b.hairloom").value());
}

TEST(Stack, FilesWithoutItsArraysOrWithOtherSettingsAreRefused) {
    const TemporaryFolder folder;
    Groom groom = stacked();
    Groom bare = groom;
    bare.pointAttributes.erase(attribute::kBasePosition);
    EXPECT_THAT(saveProject(bare, folder / "a.hairloom").error().message(),
                HasSubstr("lacks its base shape"));
    Groom twice = groom;
    twice.operators.assign(2, newOperator(kSculpt));
    twice.pointAttributes.set(sculptAttribute(0), std::vector<Vec3f>(groom.pointCount()));
    EXPECT_THAT(saveProject(twice, folder / "a.hairloom").error().message(), HasSubstr("(operator 1)"));
    groom.operators[1].settings = R"({"radius": 7})";
    ASSERT_TRUE(saveProject(groom, folder / "a.hairloom"));
    auto loaded = readProjectFile(folder / "a.hairloom");
    ASSERT_TRUE(loaded);
    EXPECT_THAT(completeOperators("a.hairloom", *loaded).error().message(),
                HasSubstr("a.hairloom: /operators/1/radius is 7; expected a number from 0 to 0.1 m"));
    loaded->operators[1].settings = R"({"radius": 0.01})";
    ASSERT_TRUE(completeOperators("a.hairloom", *loaded));
    EXPECT_THAT(loaded->operators[1].settings, HasSubstr("frequency")) << "defaults are written out";
}

// ── Sculpt ──

std::vector<Vec3f> wave(std::uint32_t points, float turn) {
    std::vector<Vec3f> strand{Vec3f(0.1f, 1.6f, 0.2f)};
    for (std::uint32_t i = 1; i < points; ++i) {
        const float angle = turn * static_cast<float>(i);
        strand.push_back(strand.back() + 0.01f * Vec3f(std::sin(angle), std::cos(angle), 0.3f));
    }
    return strand;
}

TEST(Sculpt, GivesBackWhatWasMeasured) {
    const auto input = wave(16, 0.3f);
    const auto wanted = wave(16, -0.2f);
    std::vector<Vec3f> offsets(16), output(16);
    measureSculpt(input, wanted, offsets);
    applySculpt(input, offsets, 1, output);
    for (std::size_t i = 0; i < 16; ++i) EXPECT_LT((output[i] - wanted[i]).norm(), 1e-7f) << i;
}

TEST(Sculpt, PointsBeforeTheFirstChangeKeepTheirBits) {
    const auto input = wave(16, 0.3f);
    auto wanted = input;
    for (std::size_t i = 9; i < 16; ++i) wanted[i] += Vec3f(0.01f, 0, 0);
    std::vector<Vec3f> offsets(16), output(16);
    measureSculpt(input, wanted, offsets);
    applySculpt(input, offsets, 1, output);
    EXPECT_TRUE(std::equal(input.begin(), input.begin() + 9, output.begin()));
    measureSculpt(input, input, offsets);
    EXPECT_THAT(offsets, testing::Each(Vec3f(0, 0, 0)));
}

TEST(Sculpt, FollowsAStrandThatIsTurnedAndScaled) {
    const auto input = wave(16, 0.1f);
    const auto wanted = wave(16, 0.25f);
    std::vector<Vec3f> offsets(16), output(16);
    measureSculpt(input, wanted, offsets);
    const auto moved = [&](const Vec3f& point) -> Vec3f {
        return input[0] + 2 * (Eigen::AngleAxisf(0.4f, Vec3f::UnitZ()) * (point - input[0]));
    };
    std::vector<Vec3f> below;
    for (const Vec3f& point : input) below.push_back(moved(point));
    applySculpt(below, offsets, 1, output);
    // The frame is carried from +Y on by the shortest arc, which turns the offsets a little about the strand.
    for (std::size_t i = 0; i < 16; ++i) EXPECT_LT((output[i] - moved(wanted[i])).norm(), 0.05f) << i;
    EXPECT_NEAR(polylineLength(output), 2 * polylineLength(wanted), 1e-5f);
}

TEST(Sculpt, WeightKeepsLengthsBetween) {
    const auto input = wave(16, 0.3f);
    const auto wanted = wave(16, -0.4f);
    std::vector<Vec3f> offsets(16), output(16);
    measureSculpt(input, wanted, offsets);
    applySculpt(input, offsets, 0.5f, output);
    EXPECT_NEAR(polylineLength(output), polylineLength(input), 1e-5f);
    EXPECT_GT((output[15] - input[15]).norm(), 0.01f);
    EXPECT_GT((output[15] - wanted[15]).norm(), 0.01f);
}

TEST(Sculpt, StrandsWithoutLengthAreHeld) {
    const std::vector<Vec3f> input(4, Vec3f(0, 1, 0));
    const std::vector<Vec3f> wanted{Vec3f(0, 1, 0), Vec3f(0.1f, 1, 0), Vec3f(0.1f, 1, 0), Vec3f(0.1f, 2, 0)};
    std::vector<Vec3f> offsets(4), output(4);
    measureSculpt(input, wanted, offsets);
    applySculpt(input, offsets, 1, output);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_LT((output[i] - wanted[i]).norm(), 1e-6f) << i;
}

}  // namespace
}  // namespace hairloom
