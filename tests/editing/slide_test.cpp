// SPDX-License-Identifier: GPL-3.0-or-later
// The brush that moves roots over the scalp.

#include <gmock/gmock.h>

#include "core/editing/settings_commands.h"
#include "core/editing/stack_commands.h"
#include "core/operations/stack.h"
#include "tests/editing/editing_samples.h"

namespace hairloom::editing {
namespace {

/// Drags over the top of the head by `degrees` from the top, about the z axis.
Stroke slideBy(float degrees, float radius = 0.03f) {
    Stroke stroke;
    stroke.tool = "slide";
    stroke.settings.radius = radius;
    stroke.settings.strength = 1;
    stroke.settings.falloff = BrushCurve::falloff("constant");
    const int steps = 10;
    for (int i = 0; i <= steps; ++i) {
        const float angle = radians(degrees * static_cast<float>(i) / steps);
        stroke.dabs.push_back(
            dabAt(stroke.settings, kHeadCentre + kHeadRadius * Vec3f(std::sin(angle), std::cos(angle), 0)));
    }
    return stroke;
}

float fromScalp(const Groom& groom, std::size_t s) {
    const SurfacePoint root = groom.rootBindings()[s];
    return (groom.strand(s)[0] - groom.scalp->pointAt(root.triangle, root.barycentric)).norm();
}

TEST(Slide, TurnsHairAboutTheHeadAsOnASphere) {
    const TopStrand top;
    Groom before = hairOnHead();
    before.strandAttributes.set(attribute::kRootUv, std::vector<Vec2f>(before.strandCount(), Vec2f::Zero()));
    Document document(before);
    const Vec3f root = before.strand(top.strand)[0];
    ASSERT_TRUE(document.replay(slideBy(40)));
    const Groom& after = document.groom();
    // On a sphere a strand that slides by an angle turns by that about the centre.
    const Eigen::AngleAxisf turn(radians(-40.0f), Vec3f::UnitZ());
    const Vec3f expected = kHeadCentre + turn * (root - kHeadCentre);
    EXPECT_LT((after.strand(top.strand)[0] - expected).norm(), 0.002f);
    std::size_t moved = 0;
    for (std::size_t s = 0; s < before.strandCount(); ++s) {
        EXPECT_LT(fromScalp(after, s), 1e-6f);
        const auto a = before.strand(s), b = after.strand(s);
        if (std::equal(a.begin(), a.end(), b.begin())) continue;
        ++moved;
        // The shape is the same, turned.
        const Vec3f chord = b[15] - b[0];
        EXPECT_NEAR(chord.norm(), (a[15] - a[0]).norm(), 1e-5f);
        const SurfacePoint at = after.rootBindings()[s];
        EXPECT_GT(chord.normalized().dot(after.scalp->normalAt(at.triangle, at.barycentric)), 0.999f);
        const Vec2f uv = after.strandAttributes.view<Vec2f>(attribute::kRootUv)[s];
        EXPECT_LT((uv - after.scalp->uvAt(at.triangle, at.barycentric)).norm(), 1e-6f);
    }
    EXPECT_GT(moved, 5u);
    EXPECT_FALSE(hasErrors(validate(after)));
}

TEST(Slide, TriangulationsBelongToWhereRootsAre) {
    Document document(hairOnHead());
    document.perform(triangulate(document.model()));
    ASSERT_FALSE(document.groom().triangulation.triangles.empty());
    const std::uint64_t before = contentHash(document.groom());
    ASSERT_TRUE(document.replay(slideBy(20)));
    EXPECT_TRUE(document.groom().triangulation.triangles.empty());
    ASSERT_TRUE(document.undo());
    EXPECT_FALSE(document.groom().triangulation.triangles.empty());
    EXPECT_EQ(contentHash(document.groom()), before);
    // Where nothing moves it stays.
    Stroke still = slideBy(20);
    for (Dab& dab : still.dabs) dab.position_ss = still.dabs[0].position_ss;
    ASSERT_TRUE(document.replay(still));
    EXPECT_EQ(document.history().doneCount(), 1u);
    EXPECT_FALSE(document.groom().triangulation.triangles.empty());
}

TEST(Slide, StaysOnTheFacesThatCarryHair) {
    Document document(hairOnHead());
    ASSERT_FALSE(document.groom().scalpSelection.empty());
    ASSERT_TRUE(document.replay(slideBy(160, 0.06f)));  // hair grows down to 90°
    const FaceSet& selection = document.groom().scalpSelection;
    float lowest = 1;
    for (const SurfacePoint& root : document.groom().rootBindings()) {
        EXPECT_TRUE(std::ranges::binary_search(selection, root.triangle));
        lowest = std::min(
            lowest, document.groom().scalp->pointAt(root.triangle, root.barycentric).y() - kHeadCentre.y());
    }
    EXPECT_LT(lowest, 0.01f) << "it comes to the border";
    EXPECT_FALSE(hasErrors(validate(document.groom())));
    EXPECT_GT(nearestToSkin(document.groom()), -1e-5f);
}

TEST(Slide, WeighsByTheFalloff) {
    Document document(hairOnHead());
    const Groom before = document.groom();
    Stroke stroke = slideBy(20, 0.05f);
    stroke.settings.falloff = BrushCurve::falloff("linear");
    ASSERT_TRUE(document.replay(stroke));
    const float whole = kHeadRadius * radians(20.0f);
    for (std::size_t s = 0; s < before.strandCount(); ++s) {
        const Vec3f a = before.strand(s)[0] - kHeadCentre, b = document.groom().strand(s)[0] - kHeadCentre;
        const float went = kHeadRadius * std::acos(std::min(1.0f, a.dot(b) / (a.norm() * b.norm())));
        const float away = (before.strand(s)[0] - stroke.dabs[0].position_ss).norm() / 0.05f;
        EXPECT_NEAR(went, whole * std::max(0.0f, 1 - away), 0.08f * whole) << s;
    }
}

TEST(Slide, OperatorsActOnHairWhereItIsNow) {
    Document document(hairOnHead());
    Operator wave = newOperator("wave");
    auto added = addOperator(document.model(), 0, wave);
    ASSERT_TRUE(added) << added.error().message();
    document.perform(std::move(*added));
    const std::uint64_t before = contentHash(document.groom());
    ASSERT_TRUE(document.replay(slideBy(30)));
    const Groom& after = document.groom();
    ASSERT_EQ(after.operators.size(), 1u) << "it is no sculpt";
    StackCache cache;
    const auto shape = evaluateStack(after, cache);
    ASSERT_TRUE(shape);
    const auto points = std::get<CowArray<Vec3f>>(*shape).view();
    EXPECT_TRUE(std::ranges::equal(points, after.positions()));
    const auto base = after.pointAttributes.view<Vec3f>(attribute::kBasePosition);
    for (std::size_t s = 0; s < after.strandCount(); ++s) {
        EXPECT_LT(fromScalp(after, s), 1e-6f);
        EXPECT_EQ(base[after.offsets[s]], after.strand(s)[0]);
    }
    expectScriptMakesTheSame(document);
    ASSERT_TRUE(document.undo());
    EXPECT_EQ(contentHash(document.groom()), before);
}

TEST(Slide, ThereAndBackIsNearlyWhereItWas) {
    Document document(hairOnHead());
    const Groom before = document.groom();
    Stroke stroke = slideBy(25);
    for (int i = 9; i >= 0; --i) stroke.dabs.push_back(stroke.dabs[static_cast<std::size_t>(i)]);
    ASSERT_TRUE(document.replay(stroke));
    for (std::size_t p = 0; p < before.pointCount(); ++p)
        EXPECT_LT((document.groom().positions()[p] - before.positions()[p]).norm(), 0.003f);
}

TEST(Slide, LeavesHairAloneThatIsBoundToNoScalp) {
    Groom groom = hairOnHead();
    groom.strandAttributes.erase(attribute::kRootTriangle);
    groom.strandAttributes.erase(attribute::kRootBarycentric);
    Document document(groom);
    ASSERT_TRUE(document.replay(slideBy(30)));
    EXPECT_FALSE(document.canUndo());
}

}  // namespace
}  // namespace hairloom::editing
