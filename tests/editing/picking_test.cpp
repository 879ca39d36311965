// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/picking.h"

#include <gmock/gmock.h>

#include "core/editing/region_select.h"
#include "tests/editing/editing_samples.h"

namespace hairloom::editing {
namespace {

using testing::ElementsAre;

/// Looks along −Z from a distance; right-handed, depth 0 … 1.
View frontView(bool perspective = true) {
    const Vec3f eye(0, 1.6f, 1);
    Mat4f view = Mat4f::Identity();
    view.topRightCorner<3, 1>() = -eye;
    constexpr float kNear = 0.1f;
    constexpr float kFar = 10;
    Mat4f projection = Mat4f::Zero();
    if (perspective) {
        const float scale = 1 / std::tan(radians(20.0f));
        projection(0, 0) = scale * 600 / 800;
        projection(1, 1) = scale;
        projection(2, 2) = kFar / (kNear - kFar);
        projection(2, 3) = kNear * kFar / (kNear - kFar);
        projection(3, 2) = -1;
    } else {
        projection(0, 0) = 1 / 0.4f;
        projection(1, 1) = 1 / 0.3f;
        projection(2, 2) = 1 / (kNear - kFar);
        projection(2, 3) = kNear / (kNear - kFar);
        projection(3, 3) = 1;
    }
    return View(view, projection, Vec2f(800, 600));
}

TEST(View, RaysGoThroughWhatIsSeenThere) {
    Random random(4);
    for (const bool perspective : {true, false}) {
        const View view = frontView(perspective);
        for (int i = 0; i < 200; ++i) {
            const Vec3f point(random.uniform(-0.2f, 0.2f), random.uniform(1.4f, 1.8f),
                              random.uniform(-0.3f, 0.5f));
            const auto seen = view.project(point);
            ASSERT_TRUE(seen);
            EXPECT_NEAR(seen->depth, 1 - point.z(), 1e-5f);
            const Ray ray = view.rayAt(seen->px);
            const Vec3f away = point - ray.origin_ss;
            EXPECT_LT((away - away.dot(ray.direction_ss) * ray.direction_ss).norm(), 2e-5f);
            // A pixel aside is as wide as it says.
            const Vec3f aside = point + Vec3f(view.metresPerPixel(seen->depth), 0, 0);
            EXPECT_NEAR((view.project(aside)->px - seen->px).norm(), 1, 0.02f);
        }
    }
    EXPECT_FALSE(frontView().project(Vec3f(0, 1.6f, 2)));
}

TEST(View, PutsTheTopOfThePictureAtPixelZero) {
    EXPECT_LT(frontView().project(Vec3f(0, 1.7f, 0))->px.y(), 300);
    EXPECT_GT(frontView().project(Vec3f(0.1f, 1.6f, 0))->px.x(), 400);
}

/// Compares with a search over all segments cut into small pieces.
TEST(PickStrand, FindsTheStrandThatIsNearestOnTheScreen) {
    const Groom groom = hairOnHead(400);
    StrandBounds bounds;
    bounds.rebuild(groom);
    const SurfaceTree tree(*groom.scalp);
    Random random(9);
    int hits = 0;
    for (const bool perspective : {true, false}) {
        const View view = frontView(perspective);
        for (int i = 0; i < 60; ++i) {
            const Vec2f px(random.uniform(200, 600), random.uniform(50, 350));
            PickOptions options;
            options.throughHead = true;
            const auto pick = pickStrand(groom, bounds, &tree, view, px, options);
            float nearest = 1e9f;
            for (std::size_t s = 0; s < groom.strandCount(); ++s) {
                const auto points = groom.strand(s);
                for (std::size_t p = 0; p + 1 < points.size(); ++p) {
                    for (int k = 0; k <= 20; ++k) {
                        const Vec3f at = points[p] + static_cast<float>(k) / 20 * (points[p + 1] - points[p]);
                        nearest = std::min(nearest, (view.project(at)->px - px).norm());
                    }
                }
            }
            ASSERT_EQ(pick.has_value(), nearest <= options.radius_px) << nearest;
            if (!pick) continue;
            ++hits;
            EXPECT_LE(std::floor(pick->distance_px), nearest + 0.1f);
            EXPECT_NEAR((view.project(pick->position_ss)->px - px).norm(), pick->distance_px, 1e-2f);
            const auto points = groom.strand(pick->strand);
            const Vec3f on =
                points[pick->segment] + pick->along * (points[pick->segment + 1] - points[pick->segment]);
            EXPECT_LT((on - pick->position_ss).norm(), 1e-5f);
        }
    }
    EXPECT_GT(hits, 30);
}

TEST(PickStrand, LeavesOutWhatTheHeadCoversAndWhatIsHidden) {
    // One strand behind the head, one before it.
    std::vector<Vec3f> points;
    for (const float z : {-0.2f, 0.2f})
        for (int p = 0; p < 4; ++p) points.emplace_back(0, 1.58f + 0.01f * static_cast<float>(p), z);
    Groom groom = makeGroom({0, 4, 8}, points);
    groom.scalp = sphereScalp(kHeadRadius, 3, kHeadCentre);
    StrandBounds bounds;
    bounds.rebuild(groom);
    const SurfaceTree tree(*groom.scalp);
    const View view = frontView();
    const Vec2f middle(400, 300);
    const auto front = pickStrand(groom, bounds, &tree, view, middle);
    ASSERT_TRUE(front);
    EXPECT_EQ(front->strand, 1u);
    groom.strandAttributes.set(attribute::kHidden, std::vector<std::uint8_t>{0, 1});
    EXPECT_FALSE(pickStrand(groom, bounds, &tree, view, middle));
    PickOptions through;
    through.throughHead = true;
    const auto behind = pickStrand(groom, bounds, &tree, view, middle, through);
    ASSERT_TRUE(behind);
    EXPECT_EQ(behind->strand, 0u);
    // By its tip alone.
    through.part = StrandPart::Tip;
    EXPECT_FALSE(pickStrand(groom, bounds, &tree, view, middle, through));
    const auto tip = view.project(points[3]);
    EXPECT_TRUE(pickStrand(groom, bounds, &tree, view, tip->px, through));
    EXPECT_TRUE(pickHead(&tree, view, middle));
    EXPECT_FALSE(pickHead(nullptr, view, middle));
}

TEST(ScreenRegion, HoldsWhatIsInsideItsOutline) {
    const ScreenRegion box = ScreenRegion::box(Vec2f(10, 40), Vec2f(30, 20));
    EXPECT_TRUE(box.contains(Vec2f(11, 21)));
    EXPECT_FALSE(box.contains(Vec2f(9, 30)));
    const ScreenRegion hook = ScreenRegion::lasso(
        {Vec2f(0, 0), Vec2f(30, 0), Vec2f(30, 30), Vec2f(20, 30), Vec2f(20, 10), Vec2f(0, 10)});
    EXPECT_TRUE(hook.contains(Vec2f(5, 5)));
    EXPECT_TRUE(hook.contains(Vec2f(25, 25)));
    EXPECT_FALSE(hook.contains(Vec2f(5, 25)));
    EXPECT_FALSE(ScreenRegion::lasso({}).contains(Vec2f(0, 0)));
    EXPECT_FALSE(ScreenRegion::lasso({Vec2f(0, 0), Vec2f(9, 9)}).contains(Vec2f(4, 5)));
}

TEST(ScreenRegion, FindsStrandsByTheirParts) {
    Groom groom = hairOnHead(300);
    const SurfaceTree tree(*groom.scalp);
    const View view = frontView();
    const ScreenRegion right = ScreenRegion::box(Vec2f(400, 0), Vec2f(800, 600));
    RegionOptions options;
    options.throughHead = true;
    for (const StrandPart part : {StrandPart::Any, StrandPart::Root, StrandPart::Tip}) {
        options.part = part;
        const auto found = strandsIn(right, groom, &tree, view, options);
        EXPECT_GT(found.size(), 100u);
        for (std::size_t s = 0; s < groom.strandCount(); ++s) {
            // The hair stands straight out, so that all its points are on one side.
            const bool isRight = groom.strand(s).back().x() > 0;
            EXPECT_EQ(std::binary_search(found.begin(), found.end(), static_cast<std::uint32_t>(s)), isRight);
        }
    }
    options.throughHead = false;
    options.part = StrandPart::Root;
    const auto seen = strandsIn(right, groom, &tree, view, options);
    EXPECT_GT(seen.size(), 30u);
    for (const std::uint32_t s : seen) EXPECT_GT(groom.strand(s)[0].z(), -0.01f);
}

TEST(ScreenRegion, FindsFacesThatCanBeSeen) {
    const auto head = sphereScalp(kHeadRadius, 3, kHeadCentre);
    const SurfaceTree tree(*head);
    const View view = frontView();
    const ScreenRegion all = ScreenRegion::box(Vec2f(0, 0), Vec2f(800, 600));
    EXPECT_EQ(facesIn(all, *head, tree, view, true).size(), head->triangleCount());
    const FaceSet seen = facesIn(all, *head, tree, view);
    EXPECT_NEAR(static_cast<double>(seen.size()), 0.45 * static_cast<double>(head->triangleCount()),
                0.06 * static_cast<double>(head->triangleCount()));
    for (const std::uint32_t face : seen) EXPECT_GT(head->triangleNormal(face).z(), 0);
}

}  // namespace
}  // namespace hairloom::editing
