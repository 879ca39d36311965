// SPDX-License-Identifier: GPL-3.0-or-later
#include "hairloom/field.h"

#include <gtest/gtest.h>

#include <limits>

#include "hairloom/math.h"

namespace hairloom::runtime {
namespace {

enum class Shape : std::uint32_t { round, flat };

struct Example {
    float length = 0.25f;
    std::uint32_t points = 16;
    bool straight = true;
    Shape shape = Shape::flat;
    Float3 direction{0, -1, 0};
    Float3 colour{0.1f, 0.2f, 0.3f};
    std::uint64_t seed = 1;
    Ramp width = Ramp::straight(1, 0);
};

constexpr const char* kShapes[] = {"round", "flat"};
constexpr Field<Example> kFields[] = {
    field<&Example::length>("length", "m", 0, 0.48, "of a strand"),
    field<&Example::points>("points", "", 2, 512, "of a strand"),
    boolField<&Example::straight>("straight", "without bends"),
    choiceField<&Example::shape>("shape", "of the cross-section", kShapes),
    field<&Example::direction>("direction", "", -1, 1, "of growth"),
    colourField<&Example::colour>("colour", "of the hair"),
    seedField<&Example::seed>("seed", "another seed gives other strands"),
    rampField<&Example::width>("width", "from root to tip"),
};
std::span<const Field<Example>> fieldsOf(const Example&) {
    return kFields;
}

const Field<Example>& named(const char* name) {
    return *findField<Example>(name);
}

TEST(Field, KindAndComponentsFollowFromTheMember) {
    EXPECT_EQ(named("length").kind, FieldKind::Float);
    EXPECT_EQ(named("points").kind, FieldKind::Int);
    EXPECT_EQ(named("direction").kind, FieldKind::Vector);
    EXPECT_EQ(named("direction").components(), 3u);
    EXPECT_EQ(named("colour").components(), 3u);
    EXPECT_EQ(named("width").components(), 0u);
    EXPECT_EQ(named("shape").max, 1);
    EXPECT_EQ(findField<Example>("weight"), nullptr);
}

TEST(Field, DefaultsAreThoseOfTheMembers) {
    EXPECT_EQ(defaultValue(named("length")), 0.25);
    EXPECT_EQ(defaultValue(named("straight")), 1);
    EXPECT_EQ(defaultValue(named("shape")), 1);
    EXPECT_EQ(defaultValue(named("direction"), 1), -1);
}

TEST(Field, TakesValuesOfItsKindAndRangeOnly) {
    Example example;
    EXPECT_TRUE(setFieldValue(example, named("length"), static_cast<double>(0.48f)))
        << "the border as a float has it";
    EXPECT_EQ(example.length, 0.48f);
    EXPECT_FALSE(setFieldValue(example, named("length"), 0.49));
    EXPECT_FALSE(setFieldValue(example, named("length"), std::numeric_limits<double>::quiet_NaN()));
    EXPECT_FALSE(setFieldValue(example, named("points"), 2.5));
    EXPECT_TRUE(setFieldValue(example, named("points"), 3));
    EXPECT_EQ(example.points, 3u);
    EXPECT_TRUE(setFieldValue(example, named("shape"), 0));
    EXPECT_EQ(example.shape, Shape::round);
    EXPECT_FALSE(setFieldValue(example, named("shape"), 2));
    EXPECT_TRUE(setFieldValue(example, named("straight"), 0));
    EXPECT_FALSE(example.straight);
    EXPECT_TRUE(setFieldValue(example, named("colour"), 0.75, 2));
    EXPECT_EQ(example.colour, (Float3{0.1f, 0.2f, 0.75f}));
    EXPECT_FALSE(setFieldValue(example, named("colour"), 0.5, 3)) << "there are three components";
    EXPECT_FALSE(setFieldValue(example, named("width"), 1)) << "a ramp is no number";
}

TEST(Field, SeedsKeepAllTheirBits) {
    Example example;
    constexpr std::uint64_t kSeed = 0xfedcba9876543211u;
    member<std::uint64_t>(example, named("seed")) = kSeed;
    EXPECT_EQ(example.seed, kSeed);
    EXPECT_TRUE(problemsIn(example).empty());
    EXPECT_TRUE(setFieldValue(example, named("seed"), kMaxSeed));
    EXPECT_EQ(example.seed, ~std::uint64_t{0});
}

TEST(Field, ProblemsNameTheComponentAndWhatARampLacks) {
    Example example;
    example.direction.z = 2;
    example.width.count = 1;
    const auto problems = problemsIn(example);
    ASSERT_EQ(problems.size(), 2u);
    EXPECT_EQ(problems[0].where(), "direction.z");
    EXPECT_EQ(problems[0].value, 2);
    EXPECT_EQ(problems[1].where(), "width");
    EXPECT_EQ(problems[1].ramp.rfind("has 1 keys", 0), 0u) << problems[1].ramp;
}

}  // namespace
}  // namespace hairloom::runtime
