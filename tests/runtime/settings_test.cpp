// SPDX-License-Identifier: GPL-3.0-or-later
#include "hairloom/settings.h"

#include <gtest/gtest.h>

#include <cctype>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>
#include <string>

#include "tests/support/source_dir.h"

namespace hairloom::runtime {
namespace {

std::span<const Field<SimulationSettings>> fields() {
    return fieldsOf(SimulationSettings());
}
const Field<SimulationSettings>* named(const char* name) {
    return findField<SimulationSettings>(name);
}

TEST(Settings, DefaultsAreInRangeAndEveryFieldIsDescribed) {
    EXPECT_TRUE(validate({}).empty());
    std::set<std::string> names;
    for (const auto& field : fields()) {
        EXPECT_TRUE(names.insert(field.name).second) << field.name;
        EXPECT_GT(std::string(field.meaning).size(), 8u) << field.name;
        EXPECT_EQ(named(field.name), &field);
    }
    EXPECT_EQ(named("nonsense"), nullptr);
}

TEST(Settings, TheTableCoversEveryByteOfTheStruct) {
    std::size_t bytes = 0;
    const auto padTo = [&](std::size_t alignment) {
        bytes = (bytes + alignment - 1) / alignment * alignment;
    };
    for (const auto& field : fields()) {
        const bool isFlag = field.kind == FieldKind::Bool;
        padTo(isFlag ? 1 : 4);
        bytes += field.kind == FieldKind::Ramp ? sizeof(Ramp) : (isFlag ? 1 : 4) * field.components();
    }
    padTo(alignof(SimulationSettings));
    EXPECT_EQ(bytes, sizeof(SimulationSettings));
}

TEST(Settings, EachFieldTakesItsBordersAndRefusesWhatLiesBeyond) {
    for (const auto& field : fields()) {
        if (field.kind == FieldKind::Ramp) continue;
        SimulationSettings s;
        const std::uint32_t last = field.components() - 1;
        for (const double border : {field.min, field.max}) {
            EXPECT_TRUE(setFieldValue(s, field, border, last)) << field.name;
            EXPECT_NEAR(fieldValue(s, field, last), border, 1e-6 * (1 + std::abs(border))) << field.name;
            EXPECT_TRUE(validate(s).empty()) << field.name;
        }
        for (const double beyond : {field.min - 1, field.max + 1, std::numeric_limits<double>::quiet_NaN()}) {
            EXPECT_FALSE(setFieldValue(s, field, beyond, last)) << field.name;
        }
    }
}

TEST(Settings, ProblemsNameFieldValueAndRange) {
    SimulationSettings s;
    s.airDrag = -1.0f;
    s.gravity.y = std::numeric_limits<float>::infinity();
    const auto problems = validate(s);
    ASSERT_EQ(problems.size(), 2u);
    EXPECT_EQ(problems[0], "gravity.y is inf m/s²; expected -1000 to 1000");
    EXPECT_EQ(problems[1], "airDrag is -1 1/s; expected 0 to 1000");
    EXPECT_FALSE(setFieldValue(s, *named("substeps"), 2.5));
    EXPECT_FALSE(setFieldValue(s, *named("angularCurve"), 0.5)) << "is no single number";
}

Ramp rampOf(std::initializer_list<Ramp::Key> keys) {
    return Ramp::of({keys.begin(), keys.size()});
}

TEST(Ramps, AreStraightBetweenTheirKeys) {
    const Ramp ramp = rampOf({{0, 0.5f}, {0.25f, 1}, {0.75f, 0.2f}, {1, 0.4f}});
    EXPECT_EQ(ramp.at(0.0), 0.5);
    EXPECT_EQ(ramp.at(0.25), 1.0);
    EXPECT_EQ(ramp.at(1.0f), 0.4f);
    EXPECT_DOUBLE_EQ(ramp.at(0.125), 0.75);
    EXPECT_NEAR(ramp.at(0.5), 0.6, 1e-7);
    EXPECT_NEAR(ramp.at(0.875), 0.3, 1e-7);
    EXPECT_EQ(ramp.greatest(), 1.0f);
    EXPECT_EQ(Ramp(), Ramp::straight(1, 1));
    EXPECT_FALSE(ramp == Ramp());
    EXPECT_EQ(ramp, rampOf({{0, 0.5f}, {0.25f, 1}, {0.75f, 0.2f}, {1, 0.4f}}));
}

TEST(Ramps, OfTwoKeysHaveTheBitsOfALine) {
    for (const float tip : {0.0f, 0.1f, 0.35f, 0.9f, 1.0f}) {
        const Ramp ramp = Ramp::straight(1.0f, tip);
        for (int i = 0; i <= 31; ++i) {
            const double along = i / 31.0;
            EXPECT_EQ(ramp.at(along), 1.0 + (static_cast<double>(tip) - 1.0) * along);
            const auto coarse = static_cast<float>(along);
            EXPECT_EQ(ramp.at(coarse), 1.0f + (tip - 1.0f) * coarse);
        }
    }
}

TEST(Ramps, ThatAreNotSoundAreRefused) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    Ramp none, many;
    none.count = 1;
    many.count = 4'000'000'000u;
    for (const Ramp& bad :
         {rampOf({{0.1f, 1}, {1, 1}}), rampOf({{0, 1}, {0.9f, 1}}), rampOf({{0, 1}, {0, 1}, {1, 1}}),
          rampOf({{0, 1}, {0.6f, 1}, {0.5f, 1}, {1, 1}}), rampOf({{0, 1}, {1, 1}, {1, 1}}),
          rampOf({{0, 1}, {nan, 1}, {1, 1}}), rampOf({{0, nan}, {1, 1}}), rampOf({{0, 1}, {1, -0.1f}}),
          rampOf({{0, 1.1f}, {1, 1}}), none, many}) {
        SimulationSettings s;
        s.angularCurve = bad;
        const auto problems = problemsIn(s);
        ASSERT_EQ(problems.size(), 1u);
        EXPECT_EQ(problems[0].field, named("angularCurve"));
        ASSERT_EQ(validate(s).size(), 1u);
        EXPECT_EQ(validate(s)[0].find("angularCurve has "), 0u) << validate(s)[0];
    }
}

TEST(Settings, SubstepsKeepTheStepWhateverTheFrame) {
    SimulationSettings s;
    s.substeps = 2;
    EXPECT_EQ(substepsIn(s, 1.0f / 60.0f), 2u);
    EXPECT_EQ(substepsIn(s, 1.0f / 59.9f), 2u) << "clocks jitter";
    EXPECT_EQ(substepsIn(s, 1.0f / 30.0f), 4u);
    EXPECT_EQ(substepsIn(s, 1.0f / 24.0f), 5u);
    EXPECT_EQ(substepsIn(s, 1.0f / 240.0f), 1u);
    EXPECT_EQ(substepsIn(s, 1.0f), 120u);
    EXPECT_EQ(substepsIn(s, 1e9f), kMaxSubsteps);
    EXPECT_EQ(substepsIn(s, 1e-9f), 1u);
}

/// The comment above a member of SimulationSettings in the public header, in one line. Empty: it has none.
std::string commentAbove(const std::string& member) {
    std::ifstream header(hairloom::sourceDir() / "runtime/include/hairloom/settings.h");
    std::string comment;
    bool isInside = false;
    for (std::string line; std::getline(header, line);) {
        isInside = isInside || line.starts_with("struct SimulationSettings");
        if (!isInside) continue;
        const auto begin = line.find_first_not_of(' ');
        if (begin != std::string::npos && line.compare(begin, 4, "/// ") == 0) {
            comment += (comment.empty() ? "" : " ") + line.substr(begin + 4);
            continue;
        }
        if (line.find(' ' + member + " =") != std::string::npos ||
            line.find(' ' + member + '{') != std::string::npos)
            return comment;
        comment.clear();
    }
    return {};
}

TEST(Settings, ThePublicHeaderSaysWhatTheDescriptionSays) {
    for (const auto& field : fields()) {
        std::ostringstream described;
        described.precision(10);
        if (*field.unit) described << field.unit << ", ";
        if (field.kind != FieldKind::Choice && field.kind != FieldKind::Ramp && field.kind != FieldKind::Bool)
            described << field.min << " … " << field.max << ". ";
        std::string meaning = field.meaning;
        meaning[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(meaning[0])));
        described << meaning << '.';
        const std::string comment = commentAbove(field.name);
        EXPECT_TRUE(comment.starts_with(described.str()))
            << field.name << "\nheader:      " << comment << "\ndescription: " << described.str();
    }
    EXPECT_EQ(commentAbove("noSuchMember"), "");
}

}  // namespace
}  // namespace hairloom::runtime
