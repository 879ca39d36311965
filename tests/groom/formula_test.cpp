// SPDX-License-Identifier: GPL-3.0-or-later
// The formulas of masks: what they mean, what they refuse, and that they end.

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/geometry/curve.h"
#include "core/groom/groom_hash.h"
#include "core/operations/formula.h"
#include "core/operations/mask.h"
#include "core/operations/stack.h"
#include "tests/groom/groom_samples.h"

namespace hairloom {
namespace {

using testing::HasSubstr;

float valueOf(std::string_view text, FormulaValues values = {}) {
    const auto formula = Formula::read(text);
    EXPECT_TRUE(formula) << text << ": " << formula.error().message();
    return formula ? formula->at(values) : -99;
}

TEST(Formula, ReckonsAsSchoolDoes) {
    EXPECT_FLOAT_EQ(valueOf("1 + 2*3 - 4/8"), 6.5f);
    EXPECT_FLOAT_EQ(valueOf("(1+2)*3"), 9);
    EXPECT_FLOAT_EQ(valueOf("2^3^2"), 512) << "powers bind to the right";
    EXPECT_FLOAT_EQ(valueOf("-2^2"), -4);
    EXPECT_FLOAT_EQ(valueOf("--3"), 3);
    EXPECT_FLOAT_EQ(valueOf("10 - 4 - 3"), 3) << "the same signs to the left";
    EXPECT_FLOAT_EQ(valueOf("7 % 4"), 3);
    EXPECT_FLOAT_EQ(valueOf("-1 % 4"), 3) << "patterns go on below 0";
    EXPECT_FLOAT_EQ(valueOf("1e-2 + .5"), 0.51f);
    EXPECT_FLOAT_EQ(valueOf("1 < 2"), 1);
    EXPECT_FLOAT_EQ(valueOf("1 + 1 == 2"), 1);
    EXPECT_FLOAT_EQ(valueOf("3 <= 2"), 0);
    EXPECT_FLOAT_EQ(valueOf("if(2 > 1, 5, 7)"), 5);
    EXPECT_FLOAT_EQ(valueOf("if(0, 5, 7)"), 7);
    EXPECT_FLOAT_EQ(valueOf("min(1,2) + max(1,2) + abs(-4) + floor(2.9) + fract(2.25)"), 9.25f);
    EXPECT_FLOAT_EQ(valueOf("clamp(7, 0, 1) + mix(0, 10, 0.25) + smoothstep(0, 1, 0.5)"), 4);
    EXPECT_NEAR(valueOf("sin(0) + cos(0) + sqrt(16) + pow(2, 5)"), 37, 1e-5f);
    FormulaValues values{};
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i + 1);
    for (std::size_t i = 0; i < kFormulaNames.size(); ++i) {
        EXPECT_EQ(valueOf(kFormulaNames[i], values), static_cast<float>(i + 1)) << kFormulaNames[i];
        EXPECT_TRUE(Formula::read(kFormulaNames[i])->names(static_cast<FormulaName>(i)));
    }
    EXPECT_FALSE(Formula::read("u + t")->names(FormulaName::v));
}

TEST(Formula, NoiseIsSmoothWithinBoundsAndTheSameEachTime) {
    double sum = 0;
    for (int i = -2000; i < 2000; ++i) {
        const float x = static_cast<float>(i) * 0.037f;
        FormulaValues values{};
        values[0] = x;
        const float here = valueOf("noise(u, 2, -3)", values);
        values[0] = x + 0.001f;
        EXPECT_LT(std::abs(valueOf("noise(u, 2, -3)", values) - here), 0.01f) << x;
        EXPECT_LE(std::abs(here), 1);
        sum += static_cast<double>(here);
    }
    EXPECT_LT(std::abs(sum / 4000), 0.1);
    EXPECT_NE(valueOf("noise(0.5)"), valueOf("noise(1.5)"));
    EXPECT_EQ(valueOf("noise(0.5)"), valueOf("noise(0.5, 0, 0)"));
}

TEST(Formula, WhatDoesNotReadSaysWhereAndWhatWas) {
    for (const auto& [text, problem] : std::vector<std::pair<std::string, std::string>>{
             {"", "column 1: the formula ends"},
             {"  ", "the formula ends"},
             {"1 +", "column 4: the formula ends"},
             {"1 2", "column 3: what follows belongs to nothing"},
             {"(1", "a parenthesis is open"},
             {"1)", "column 2: what follows"},
             {"foo + 1", "column 1: 'foo' is not known"},
             {"u.x", "column 2"},
             {"sin", "sin is a function"},
             {"sin()", "means nothing here"},
             {"sin(1, 2)", "sin is not closed"},
             {"clamp(1, 2)", "clamp has 2 arguments"},
             {"system(1)", "'system' is not known"},
             {"1 < 2 < 3", "what follows belongs to nothing"},
             {"t = 1", "what follows belongs to nothing"},
             {"1e999", "no number that can be used"},
             {"0,4", "column 2: what follows"},
             {"u; v", "column 2"},
             {"2 + ×", "column 5: '×' means nothing here"},
             {"\xff", "'?' means nothing here"}}) {
        const auto read = Formula::read(text);
        ASSERT_FALSE(read) << text;
        EXPECT_THAT(read.error().message(), HasSubstr(problem)) << text;
    }
}

TEST(Formula, LengthDepthAndStepsAreBounded) {
    EXPECT_FALSE(Formula::read(std::string(501, '1')));
    EXPECT_FALSE(Formula::read(std::string(400, '(')));
    EXPECT_FALSE(Formula::read(std::string(499, '-') + "1"));
    std::string deep = "1", longer = "1";
    for (int i = 0; i < 40; ++i) deep = "abs(" + deep + ")";
    EXPECT_THAT(Formula::read(deep).error().message(), HasSubstr("within each other"));
    while (longer.size() + 2 <= Formula::kMostCharacters) longer += "+1";
    const auto all = Formula::read(longer);
    EXPECT_TRUE(all.has_value() || all.error().message().find("too long") != std::string::npos);
    std::string nested = "1";
    while (nested.size() + 6 <= Formula::kMostCharacters && nested.size() < 90) nested = "(1+" + nested + ")";
    EXPECT_NEAR(valueOf(nested), static_cast<float>(1 + (nested.size() - 1) / 4), 1e-3f);
}

/// Any text at all ends, with a number or a complaint.
TEST(Formula, AnyTextEnds) {
    const std::string_view pieces[] = {"u", "t",  "1", ".5",     "(",    ")",      "+",   "-",
                                       "*", "/",  "^", "%",      ",",    "noise(", "if(", "min(",
                                       "<", "==", " ", "random", "\x80", "0x",     "e"};
    Random random(4);
    std::size_t read = 0;
    for (int i = 0; i < 20000; ++i) {
        std::string text;
        const auto count = random.below(24);
        for (std::uint32_t k = 0; k < count; ++k) text += pieces[random.below(std::size(pieces))];
        if (const auto formula = Formula::read(text)) {
            ++read;
            static_cast<void>(formula->at({}));
        } else {
            EXPECT_FALSE(formula.error().problem.empty());
        }
    }
    EXPECT_GT(read, 20u);
}

Groom combed(const std::string& formula, Result<AttributeData>* out = nullptr) {
    Groom groom = straightHair(sphereScalp(0.09f, 3), 60, 12, 0.1f);
    groom.strandAttributes.set(attribute::kRootUv, std::vector<Vec2f>(60, Vec2f(0.25f, 0.5f)));
    groom.pointAttributes.set(attribute::kBasePosition,
                              std::vector<Vec3f>(groom.positions().begin(), groom.positions().end()));
    Operator drape = newOperator("drape");
    Mask mask;
    mask.formula = formula;
    setMaskOf(drape, mask);
    groom.operators = {drape};
    StackCache cache;
    auto made = evaluateStack(groom, cache);
    if (out) *out = made;
    if (made) groom.pointAttributes.set(attribute::kPosition, std::move(*made));
    return groom;
}

std::size_t movedStrands(const Groom& groom) {
    const auto base = groom.pointAttributes.view<Vec3f>(attribute::kBasePosition);
    std::size_t moved = 0;
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        const auto strand = groom.strand(s);
        moved += !std::equal(strand.begin(), strand.end(),
                             base.begin() + static_cast<std::ptrdiff_t>(groom.offsets[s]));
    }
    return moved;
}

TEST(MaskFormula, SaysWhereAnOperatorActs) {
    EXPECT_EQ(movedStrands(combed("0")), 0u);
    EXPECT_GT(movedStrands(combed("1")), 50u);
    const Groom right = combed("x > 0");
    for (std::size_t s = 0; s < right.strandCount(); ++s) {
        const bool moved = right.strand(s)[11] !=
                           right.pointAttributes.view<Vec3f>(attribute::kBasePosition)[right.offsets[s] + 11];
        EXPECT_EQ(moved, right.strand(s)[0].x() > 0) << s;
    }
    const std::size_t some = movedStrands(combed("random < 0.5"));
    EXPECT_GT(some, 15u);
    EXPECT_LT(some, 45u);
    const Groom over = combed("u + 0.95"), whole = combed("1");
    EXPECT_TRUE(std::ranges::equal(over.positions(), whole.positions())) << "held to 0 … 1";
}

TEST(MaskFormula, GivesTheSameBitsForAnyNumberOfThreads) {
    std::vector<std::uint64_t> hashes;
    for (const std::size_t threads : {1u, 3u}) {
        setThreadCount(threads);
        hashes.push_back(contentHash(combed("0.5 + 0.5*noise(x*40, y*40, t*3) * random")));
    }
    setThreadCount(0);
    EXPECT_EQ(hashes[0], hashes[1]);
}

TEST(MaskFormula, ADivisionByZeroOrANameThatIsNotThereIsAnErrorWithItsPlace) {
    Result<AttributeData> made;
    combed("1/(u - 0.25)", &made);
    ASSERT_FALSE(made);
    EXPECT_THAT(made.error().message(), HasSubstr("operator 0: the formula gives no number at strand 0"));
    combed("sqrt(-1)", &made);
    EXPECT_FALSE(made);
    combed("if(u == 0.25, 0.5, 1/(u - 0.25))", &made);
    EXPECT_TRUE(made) << "what is not chosen does no harm";
    combed("mask9", &made);
    ASSERT_FALSE(made);
    EXPECT_THAT(made.error().message(), HasSubstr("'mask9' is not known"));
}

TEST(MaskFormula, IsKeptInFilesAndReadsWhatIsPainted) {
    const Groom groom = combed("mask2 * t");
    EXPECT_EQ(movedStrands(groom), 0u) << "nothing is painted";
    EXPECT_TRUE(readsMaps(groom.operators));
    EXPECT_TRUE(readsMap(maskOf(groom.operators[0]), MaskMap::mask2));
    EXPECT_FALSE(readsMap(maskOf(groom.operators[0]), MaskMap::mask1));
    EXPECT_EQ(maskOf(groom.operators[0]).formula, "mask2 * t");
    EXPECT_THAT(groom.operators[0].settings, HasSubstr(R"("formula":"mask2 * t")"));
}

}  // namespace
}  // namespace hairloom
