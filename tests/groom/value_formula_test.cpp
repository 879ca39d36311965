// SPDX-License-Identifier: GPL-3.0-or-later
// Settings of operators as formulas: one value for each strand, what is refused, files, and what is run
// again.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <array>

#include "core/base/parallel.h"
#include "core/geometry/curve.h"
#include "core/groom/file/project_file.h"
#include "core/groom/groom_hash.h"
#include "core/operations/script.h"
#include "core/operations/stack.h"
#include "tests/groom/groom_samples.h"
#include "tests/support/temporary_folder.h"

namespace hairloom {
namespace {

using testing::HasSubstr;

constexpr std::size_t kStrands = 80;

Groom hair() {
    Groom groom = straightHair(sphereScalp(0.09f, 3), kStrands, 12, 0.1f);
    std::vector<Vec2f> uvs(kStrands);
    for (std::size_t s = 0; s < kStrands; ++s) uvs[s] = Vec2f(static_cast<float>(s) / kStrands, 0.5f);
    groom.strandAttributes.set(attribute::kRootUv, std::move(uvs));
    groom.pointAttributes.set(attribute::kBasePosition,
                              std::vector<Vec3f>(groom.positions().begin(), groom.positions().end()));
    return groom;
}

Groom withFormula(const char* op, const char* field, const std::string& formula) {
    Groom groom = hair();
    Operator one = newOperator(op);
    const Status status = setFormulaOf(one, field, formula);
    EXPECT_TRUE(status) << status.error().message();
    groom.operators = {one};
    return groom;
}

Result<Groom> evaluated(Groom groom) {
    StackCache cache;
    auto made = evaluateStack(groom, cache);
    if (!made) return tl::unexpected(made.error());
    groom.pointAttributes.set(attribute::kPosition, std::move(*made));
    return groom;
}

std::string errorOf(const char* op, const char* field, const std::string& formula) {
    const auto made = evaluated(withFormula(op, field, formula));
    return made ? "it works" : made.error().message();
}

TEST(ValueFormula, GivesEachStrandItsOwnValue) {
    Groom groom = withFormula("set_length", "length", "0.05 + 0.1*u");
    const auto made = evaluated(groom);
    ASSERT_TRUE(made) << made.error().message();
    for (std::size_t s = 0; s < kStrands; ++s)
        EXPECT_NEAR(polylineLength(made->strand(s)), 0.05f + 0.1f * static_cast<float>(s) / kStrands, 2e-6f);
    // `length` is that of the strand before the operator.
    const auto halved = evaluated(withFormula("trim", "maxLength", "0.5*length"));
    ASSERT_TRUE(halved);
    for (std::size_t s = 0; s < kStrands; ++s)
        EXPECT_NEAR(polylineLength(halved->strand(s)), 0.05f, 1e-6f) << s;
}

/// Every field that takes a formula takes its own number as one, and hears another.
TEST(ValueFormula, IsTheNumberWhereItSaysTheNumber) {
    std::size_t fields = 0;
    for (const StackOperator& known : stackOperators()) {
        if (known.hasCurve) continue;
        for (const char* name : known.formulaFields) {
            ++fields;
            const auto row = std::ranges::find_if(
                known.fields, [&](const FieldRow& one) { return std::string_view(one.info.name) == name; });
            ASSERT_NE(row, known.fields.end()) << known.name << ' ' << name;
            ASSERT_EQ(row->info.kind, FieldKind::Float) << name;
            Groom groom = hair();
            Operator plain = newOperator(known.name);
            for (const FieldRow& one : known.fields) {
                if (std::string_view(one.info.name) == "levels") setSettingOf(plain, one.info, 3, 0);
            }
            const double value = 0.25 * row->info.min + 0.75 * std::min(row->info.max, row->info.min + 1);
            Operator number = plain, formula = plain;
            ASSERT_TRUE(setSettingOf(number, row->info, value, 0));
            ASSERT_TRUE(setFormulaOf(formula, name, fmt::format("{}", settingOf(number, row->info, 0))));
            groom.operators = {number};
            const auto one = evaluated(groom);
            groom.operators = {formula};
            const auto other = evaluated(groom);
            ASSERT_TRUE(one) << one.error().message();
            ASSERT_TRUE(other) << other.error().message();
            EXPECT_TRUE(std::ranges::equal(one->positions(), other->positions()))
                << known.name << ' ' << name;
        }
    }
    EXPECT_GT(fields, 40u);
}

TEST(ValueFormula, WhatGivesNoValueIsSaidWithFieldStrandAndPlace) {
    EXPECT_THAT(errorOf("noise", "amplitude", "1/(u - u)"),
                HasSubstr("operator 0: amplitude: the formula gives no number at strand 0"));
    EXPECT_THAT(errorOf("noise", "amplitude", "if(u > 0.5, 0.2, 0)"),
                HasSubstr("amplitude: the formula gives 0.2 at strand 41; expected 0 to 0.1 m; clamp("));
    Groom bare = withFormula("noise", "amplitude", "0.01*u");
    bare.strandAttributes.erase(attribute::kRootUv);
    const auto made = evaluated(bare);
    ASSERT_FALSE(made);
    EXPECT_THAT(made.error().message(), HasSubstr("names u or v, and the hair has no UVs"));

    Operator one = newOperator("noise");
    const Operator before = one;
    for (const auto& [field, text, said] : std::initializer_list<std::array<const char*, 3>>{
             {"amplitude", "0.01*t", "t is the place along the strand"},
             {"amplitude", "amplitude + 1", "'amplitude' is not known"},
             {"amplitude", "0.01*(", "the formula ends"},
             {"seed", "3", "'seed' of 'noise' takes no formula"},
             {"clearance", "0.01", "takes no formula"},
             {"nothing", "0.01", "takes no formula"}}) {
        const Status status = setFormulaOf(one, field, text);
        ASSERT_FALSE(status) << text;
        EXPECT_THAT(status.error().message(), HasSubstr(said));
        EXPECT_EQ(one.settings, before.settings) << "nothing has changed";
    }
}

TEST(ValueFormula, ScriptsHaveThemAndNameThePlaceOfWhatIsWrong) {
    const auto parsed = [](const std::string& formulas) {
        return parseScript("s.json", R"({"hairloom_script": 1, "operations": [{"op": "curl", "formulas": )" +
                                         formulas + "}]}");
    };
    Groom groom = hair();
    groom.pointAttributes.erase(attribute::kBasePosition);
    const auto script = parsed(R"({"radius": "0.002 + 0.004*u", "frequency": "40"})");
    ASSERT_TRUE(script) << script.error().message();
    EXPECT_TRUE(runScript(*script, groom));
    for (const auto& [formulas, place] : std::initializer_list<std::pair<const char*, const char*>>{
             {R"({"radius": "0.002 +"})", "/operations/0/formulas/radius"},
             {R"({"radius": 3})", "/operations/0/formulas/radius"},
             {R"({"radius": ""})", "/operations/0/formulas/radius"},
             {R"({"seed": "3"})", "/operations/0/formulas/seed"},
             {R"(["radius"])", "/operations/0/formulas"},
             {R"("0.1")", "/operations/0/formulas"}}) {
        const auto wrong = parsed(formulas);
        ASSERT_FALSE(wrong) << formulas;
        EXPECT_THAT(wrong.error().message(), HasSubstr(place));
    }
    EXPECT_FALSE(parseScript("s.json", R"({"hairloom_script": 1, "operations": [
        {"op": "collide", "formulas": {"distance": "0.1"}}]})"))
        << "collide takes none";
}

TEST(ValueFormula, IsKeptInProjectsAndRunAgainWhereItsMapChanges) {
    const TemporaryFolder folder;
    Groom groom = withFormula("noise", "amplitude", "0.01*mask2");
    ASSERT_TRUE(readsMaps(groom.operators));
    EXPECT_TRUE(readsMap(groom.operators[0], MaskMap::mask2));
    EXPECT_FALSE(readsMap(groom.operators[0], MaskMap::mask1));
    groom = *evaluated(groom);
    ASSERT_TRUE(saveProject(groom, folder / "a.hairloom"));
    const auto again = openProject(folder / "a.hairloom");
    ASSERT_TRUE(again) << again.error().message();
    EXPECT_EQ(formulaOf(again->operators[0], "amplitude"), "0.01*mask2");
    EXPECT_EQ(formulaOf(again->operators[0], "frequency"), "");

    StackCache cache;
    const auto unpainted = evaluateStack(groom, cache);
    groom.strandAttributes.set(maskAttribute(2), std::vector<float>(kStrands, 1.0f));
    const auto painted = evaluateStack(groom, cache);
    ASSERT_TRUE(unpainted && painted);
    EXPECT_FALSE(std::ranges::equal(std::get<CowArray<Vec3f>>(*unpainted).view(),
                                    std::get<CowArray<Vec3f>>(*painted).view()));
}

TEST(ValueFormula, GivesTheSameBitsForAnyNumberOfThreads) {
    std::vector<std::uint64_t> hashes;
    for (const std::size_t threads : {1u, 3u}) {
        setThreadCount(threads);
        hashes.push_back(contentHash(
            *evaluated(withFormula("curl", "radius", "0.005 + 0.004*noise(x*40, y*40) * random"))));
    }
    setThreadCount(0);
    EXPECT_EQ(hashes[0], hashes[1]);
}

}  // namespace
}  // namespace hairloom
