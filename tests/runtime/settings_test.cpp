// SPDX-License-Identifier: GPL-3.0-or-later
#include "runtime/settings.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <string>

namespace hairloom::runtime {
namespace {

TEST(Settings, DefaultsAreInRangeAndEachFieldIsTold) {
    EXPECT_TRUE(validate({}).empty());
    std::set<std::string> names;
    for (const FieldInfo& field : fields()) {
        EXPECT_TRUE(names.insert(field.name).second) << field.name;
        EXPECT_GT(std::string(field.meaning).size(), 8u) << field.name;
        EXPECT_EQ(findField(field.name), &field);
    }
    EXPECT_EQ(findField("nonsense"), nullptr);
}

TEST(Settings, TheTableCoversEveryByteOfTheStruct) {
    std::size_t bytes = 0;
    for (const FieldInfo& field : fields()) bytes += 4 * componentCount(field);
    EXPECT_EQ(bytes, sizeof(SimulationSettings));
}

TEST(Settings, EachFieldTakesItsBordersAndRefusesWhatLiesBeyond) {
    for (const FieldInfo& field : fields()) {
        SimulationSettings s;
        const std::uint32_t last = componentCount(field) - 1;
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
    EXPECT_EQ(problems[0].message, "gravity.y is inf m/s²; expected -1000 to 1000");
    EXPECT_EQ(problems[1].message, "airDrag is -1 1/s; expected 0 to 1000");
    EXPECT_FALSE(setFieldValue(s, *findField("substeps"), 2.5));
}

}  // namespace
}  // namespace hairloom::runtime
