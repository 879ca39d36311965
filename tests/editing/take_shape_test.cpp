// SPDX-License-Identifier: GPL-3.0-or-later
// Hair that has moved becomes the authored shape.
#include "core/editing/take_shape.h"

#include <gmock/gmock.h>

#include "core/editing/replay.h"
#include "core/editing/stack_commands.h"
#include "core/geometry/curve.h"
#include "core/groom/groom_hash.h"
#include "core/operations/script.h"
#include "core/operations/stack.h"
#include "tests/editing/editing_samples.h"

namespace hairloom::editing {
namespace {

/// Blown aside, and stretched by a hundredth, as simulated hair may be.
std::vector<Vec3f> blown(const Groom& groom) {
    std::vector<Vec3f> shape(groom.positions().begin(), groom.positions().end());
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        const Vec3f root = groom.strand(s)[0];
        for (std::size_t i = groom.offsets[s] + 1; i < groom.offsets[s + 1]; ++i)
            shape[i] = root + 1.01f * (Eigen::AngleAxisf(0.3f, Vec3f::UnitX()) * (shape[i] - root));
    }
    return shape;
}

void take(Document& document, const std::vector<Vec3f>& shape) {
    auto command = takeShape(document.model(), shape, true);
    ASSERT_TRUE(command) << command.error().message();
    document.perform(std::move(*command));
}

TEST(TakeShape, IsOneStepThatKeepsRootsAndLengthsAndCarriesItsWeight) {
    Document document(hairOnHead());
    const Groom before = document.groom();
    const auto hash = contentHash(before);
    const std::vector<Vec3f> shape = blown(before);
    take(document, shape);
    EXPECT_EQ(document.history().doneCount(), 1u);
    const Groom& after = document.groom();
    for (std::size_t s = 0; s < before.strandCount(); ++s) {
        EXPECT_EQ(after.strand(s)[0], before.strand(s)[0]);
        EXPECT_NEAR(polylineLength(after.strand(s)), polylineLength(before.strand(s)), 1e-5f);
        EXPECT_LT((after.strand(s).back() - shape[before.offsets[s + 1] - 1]).norm(),
                  0.02f * polylineLength(before.strand(s)));
    }
    EXPECT_EQ(after.simulation.restGravity, 1);
    EXPECT_EQ(after.simulation.strandModel, runtime::StrandModel::rods);
    const auto script = document.script();
    ASSERT_TRUE(script) << script.error().message();
    const auto taken = contentHash(after);
    Groom replayed = before;
    const auto parsed = parseScript("s.json", *script, scriptExtensions());
    ASSERT_TRUE(parsed) << parsed.error().message();
    ASSERT_TRUE(runScript(*parsed, replayed));
    EXPECT_EQ(contentHash(replayed), taken);
    ASSERT_TRUE(document.undo());
    EXPECT_EQ(contentHash(document.groom()), hash);
}

TEST(TakeShape, OperatorsStayAndASculptHoldsTheDifference) {
    Document document(hairOnHead());
    auto added = addOperator(document.model(), 0, newOperator("curl"));
    ASSERT_TRUE(added);
    document.perform(std::move(*added));
    take(document, blown(document.groom()));
    const Groom& after = document.groom();
    ASSERT_EQ(after.operators.size(), 2u);
    EXPECT_EQ(after.operators[1].op, kSculpt);
    StackCache cache;
    const auto shape = evaluateStack(after, cache);
    ASSERT_TRUE(shape);
    EXPECT_TRUE(std::ranges::equal(std::get<CowArray<Vec3f>>(*shape).view(), after.positions()));
}

TEST(TakeShape, RefusesShapesOfOtherHairAndBrokenOnes) {
    Document document(hairOnHead());
    std::vector<Vec3f> shape = blown(document.groom());
    shape[5].x() = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(takeShape(document.model(), shape, true));
    shape.pop_back();
    const auto refused = takeShape(document.model(), shape, true);
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message(), testing::HasSubstr("the hair has"));
}

}  // namespace
}  // namespace hairloom::editing
