// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include "core/editing/place.h"
#include "core/editing/selection_commands.h"
#include "core/editing/surface_disc.h"
#include "core/geometry/placement.h"
#include "core/geometry/selection.h"
#include "tests/editing/editing_samples.h"
#include "tests/geometry/test_meshes.h"

namespace hairloom::editing {
namespace {

TEST(FaceDisc, HoldsConnectedFacesWithinTheRadius) {
    const auto head = sphereScalp(kHeadRadius, 4, kHeadCentre);
    const SurfaceTree tree(*head);
    const Vec3f top = kHeadCentre + Vec3f(0, kHeadRadius, 0);
    const FaceSet disc = faceDisc(*head, tree, top, 0.03f);
    for (std::uint32_t face = 0; face < head->triangleCount(); ++face) {
        const bool isNear = (head->pointAt(face, Vec3f::Constant(1.0f / 3)) - top).norm() <= 0.03f;
        EXPECT_EQ(std::binary_search(disc.begin(), disc.end(), face), isNear);
    }
    EXPECT_TRUE(faceDisc(*head, tree, top + Vec3f(0, 0.1f, 0), 0.03f).empty());
    // A brush smaller than a face still paints the one under it.
    EXPECT_EQ(faceDisc(*head, tree, head->pointAt(7, Vec3f(0.9f, 0.05f, 0.05f)), 0.0005f), FaceSet{7});
}

TEST(FaceDisc, DoesNotReachASheetBehind) {
    PolygonSoup soup = test::gridSoup(20, 0.2f);
    const std::size_t facesOfOne = 2 * 20 * 20;
    test::append(soup, test::gridSoup(20, 0.2f), Vec3f(0, 0.005f, 0));
    const ScalpMesh mesh = test::meshOf(soup);
    const SurfaceTree tree(mesh);
    const FaceSet disc = faceDisc(mesh, tree, Vec3f(0, -0.001f, 0), 0.04f);
    ASSERT_GT(disc.size(), 10u);
    EXPECT_LT(disc.back(), facesOfOne);
    const VertexDisc vertices = vertexDisc(mesh, tree, Vec3f(0, 0.006f, 0), 0.04f);
    ASSERT_GT(vertices.vertices.size(), 10u);
    for (const std::uint32_t v : vertices.vertices) EXPECT_NEAR(mesh.positions()[v].y(), 0.005f, 1e-6f);
}

TEST(SymmetricFaces, AddsTheMirrorImages) {
    const auto head = sphereScalp(kHeadRadius, 4, kHeadCentre);
    const SurfaceTree tree(*head);
    const Vec3f side = kHeadCentre + Vec3f(kHeadRadius, 0, 0);
    const FaceSet one = faceDisc(*head, tree, side, 0.03f);
    const FaceSet both = symmetricFaces(*head, tree, one);
    EXPECT_EQ(both.size(), 2 * one.size());
    EXPECT_EQ(symmetricFaces(*head, tree, both), both);
}

TEST(ScalpPaint, AddsAndTakesAndMirrors) {
    Groom groom;
    groom.scalp = sphereScalp(kHeadRadius, 4, kHeadCentre);
    groom.scalpExpression = "faces:none";
    Document document(groom);
    Stroke paint;
    paint.tool = "scalp_paint";
    paint.settings.radius = 0.03f;
    paint.settings.symmetric = true;
    paint.dabs = {dabAt(paint.settings, kHeadCentre + Vec3f(0.07f, 0.05f, 0))};
    ASSERT_TRUE(document.replay(paint));
    const FaceSet painted = document.groom().scalpSelection;
    EXPECT_GT(painted.size(), 50u);
    EXPECT_TRUE(document.groom().scalpExpression.empty());
    const SurfaceTree tree(*groom.scalp);
    EXPECT_EQ(symmetricFaces(*groom.scalp, tree, painted), painted);
    paint.settings.invert = true;
    ASSERT_TRUE(document.replay(paint));
    EXPECT_TRUE(document.groom().scalpSelection.empty());
    document.undo();
    document.undo();
    EXPECT_EQ(document.groom().scalpExpression, "faces:none");
    EXPECT_TRUE(sameContent(document.groom(), groom));
}

TEST(DensityPaint, BringsTheDensityNearerToItsValue) {
    Document document(hairOnHead());
    Stroke paint;
    paint.tool = "density_paint";
    paint.settings.radius = 0.03f;
    paint.settings.strength = 0.5f;
    const Vec3f top = kHeadCentre + Vec3f(0, kHeadRadius, 0);
    paint.dabs = {dabAt(paint.settings, top), dabAt(paint.settings, top)};
    ASSERT_TRUE(document.replay(paint));
    const auto& density = document.groom().scalpDensity;
    ASSERT_EQ(density.size(), document.groom().scalp->vertexCount());
    for (std::size_t v = 0; v < density.size(); ++v) {
        const float distance = (document.groom().scalp->positions()[v] - top).norm();
        if (distance >= 0.03f) {
            EXPECT_EQ(density[v], 1);
        } else if (distance < 1e-6f) {
            EXPECT_NEAR(density[v], 0.25f, 1e-6f);
        } else {
            EXPECT_LT(density[v], 1);
        }
    }
    paint.settings.invert = true;  // back to 1
    paint.settings.strength = 1;
    for (Dab& dab : paint.dabs) dab.strength = 1;
    ASSERT_TRUE(document.replay(paint));
    EXPECT_GT(*std::min_element(density.begin(), density.end()), 0.5f);
}

TEST(Place, FillsTheSelectionOfAnEmptyDocument) {
    Groom empty;
    empty.scalp = sphereScalp(kHeadRadius, 4, kHeadCentre);
    empty.scalpSelection = selectFaces(*empty.scalp, "cap:60").value();
    for (const auto method : {PlacementMethod::poissonDisk, PlacementMethod::random}) {
        empty.placement = {method, 500, 0, 0.1f, 8, 3};
        Document document(empty);
        auto command = place(document.groom(), {}, {});
        ASSERT_TRUE(command) << command.error().message();
        document.perform(std::move(*command));
        const Groom& groom = document.groom();
        EXPECT_EQ(groom.strandCount(), 500u);
        EXPECT_EQ(groom.pointCount(), 4000u);
        EXPECT_TRUE(validate(groom).empty()) << validate(groom).front().what;
        EXPECT_FALSE(groom.triangulation.triangles.empty());
        const std::uint64_t placed = contentHash(groom);
        document.undo();
        EXPECT_TRUE(sameContent(document.groom(), empty));
        document.redo();
        EXPECT_EQ(contentHash(document.groom()), placed);
    }
}

TEST(Place, NewHairHasMelaninAndStiffnessOfItsNeighboursOrAsSet) {
    Groom groom;
    groom.scalp = sphereScalp(kHeadRadius, 4, kHeadCentre);
    groom.scalpSelection = selectFaces(*groom.scalp, "cap:80").value();
    groom.placement = {PlacementMethod::poissonDisk, 200, 0, 0.1f, 8, 3};
    Document document(groom);
    document.perform(place(document.groom(), {}, {}).value());
    for (const auto& [reach, expected] : {std::pair(0.0f, 1.0f), std::pair(0.2f, 0.25f)}) {
        document.perform(setMelanin(document.model(), std::vector<float>(200, 0.25f)));
        document.perform(setStiffness(document.model(), std::vector<float>(200, 0.25f)));
        PlaceRequest request;
        request.reach = reach;
        document.perform(place(document.groom(), request, {}).value());
        for (const std::string_view name : {attribute::kMelanin, attribute::kStiffness}) {
            const auto values = document.groom().strandAttributes.view<float>(name);
            ASSERT_EQ(values.size(), document.groom().strandCount());
            for (const float value : values) ASSERT_EQ(value, expected) << name;
        }
        document.undo();
        document.undo();
    }
}

TEST(Place, ReplacesOnlyTheRegionAndKeepsItsDistance) {
    Groom groom;
    groom.scalp = sphereScalp(kHeadRadius, 4, kHeadCentre);
    groom.scalpSelection = selectFaces(*groom.scalp, "cap:80").value();
    groom.placement = {PlacementMethod::poissonDisk, 1, 4.0f, 0.1f, 8, 3};
    Document document(groom);
    document.perform(place(document.groom(), {}, {}).value());
    const Groom before = document.groom();
    const SurfaceTree tree(*groom.scalp);
    PlaceRequest request;
    request.region = faceDisc(*groom.scalp, tree, kHeadCentre + Vec3f(0, kHeadRadius, 0), 0.04f);
    request.reach = 0.02f;
    PlacementSettings denser = groom.placement;
    denser.densityPerCm2 = 12;
    Groom asked = before;
    asked.placement = denser;
    Document second(asked);
    second.perform(place(second.groom(), request, {}).value());
    const Groom& after = second.groom();
    const auto triangles = after.strandAttributes.view<std::uint32_t>(attribute::kRootTriangle);
    const auto ids = after.strandAttributes.view<std::uint32_t>(attribute::kStrandId);
    std::size_t kept = 0;
    std::size_t fresh = 0;
    for (std::size_t s = 0; s < after.strandCount(); ++s) {
        const bool inside = std::binary_search(request.region.begin(), request.region.end(), triangles[s]);
        const bool isOld = ids[s] < before.strandCount();
        EXPECT_NE(inside, isOld);
        kept += isOld ? 1 : 0;
        fresh += inside ? 1 : 0;
    }
    const double cm2 = 1e4 * selectionArea(*groom.scalp, request.region);
    EXPECT_GT(static_cast<double>(fresh), 9 * cm2);
    EXPECT_LT(static_cast<double>(fresh), 12.5 * cm2);
    EXPECT_GT(kept, before.strandCount() / 2);
    EXPECT_FALSE(hasErrors(validate(after)));
    second.undo();
    EXPECT_TRUE(sameContent(second.groom(), asked));
}

TEST(Place, GivesShareOfTheCountAndFollowsTheDensityMap) {
    Groom groom;
    groom.scalp = sphereScalp(kHeadRadius, 4, kHeadCentre);
    groom.scalpSelection = selectFaces(*groom.scalp, "cap:90").value();
    groom.placement = {PlacementMethod::random, 4000, 0, 0.1f, 2, 3};
    groom.scalpDensity.assign(groom.scalp->vertexCount(), 1);
    for (std::size_t v = 0; v < groom.scalpDensity.size(); ++v) {
        if (groom.scalp->positions()[v].x() < 0) groom.scalpDensity[v] = 0.25f;
    }
    PlaceRequest half;
    double leftArea = 0;
    double area = 0;
    for (const std::uint32_t face : groom.scalpSelection) {
        double masked = 0;
        for (const std::uint32_t v : groom.scalp->triangles()[face])
            masked += static_cast<double>(groom.scalpDensity[v] * groom.scalp->triangleArea(face)) / 3;
        area += masked;
        if (groom.scalp->pointAt(face, Vec3f::Constant(1.0f / 3)).x() >= 0) continue;
        leftArea += masked;
        half.region.push_back(face);
    }
    const auto roots = placeRoots(groom, {});
    ASSERT_TRUE(roots);
    const auto left = std::count_if(roots->begin(), roots->end(), [&](const SurfacePoint& root) {
        return std::binary_search(half.region.begin(), half.region.end(), root.triangle);
    });
    const double expected = 4000 * leftArea / area;
    EXPECT_LT(expected, 1000);
    EXPECT_NEAR(static_cast<double>(left), expected, 90);  // about three standard deviations
    EXPECT_NEAR(static_cast<double>(placeRoots(groom, half)->size()), expected, 1);
}

TEST(Place, SaysWhatIsMissing) {
    Groom groom;
    EXPECT_THAT(place(groom, {}, {}).error().message(), testing::HasSubstr("no head"));
    groom.scalp = sphereScalp();
    EXPECT_THAT(place(groom, {}, {}).error().message(),
                testing::HasSubstr("no face of the head is selected"));
    groom.scalpSelection = {1, 2};
    EXPECT_THAT(place(groom, {{5}, 0}, {}).error().message(),
                testing::HasSubstr("beyond the scalp selection"));
}

TEST(Add, FillsGapsToItsDensityWithHairLikeItsNeighbours) {
    Groom groom = hairOnHead(40);
    for (std::size_t s = 0; s < 40; ++s)
        groom.strandAttributes.edit<std::uint32_t>(attribute::kGroup).push_back(s % 2);
    groom.groupNames = {"a", "b"};
    Document document(groom);
    Stroke stroke;
    stroke.tool = "add";
    stroke.settings.radius = 0.05f;
    stroke.settings.strength = 1;
    stroke.settings.parameters = {{"density", 6}, {"reach", 0.2f}};
    const Vec3f top = kHeadCentre + Vec3f(0, kHeadRadius, 0);
    for (int i = 0; i < 6; ++i) stroke.dabs.push_back(dabAt(stroke.settings, top));
    ASSERT_TRUE(document.replay(stroke));
    const Groom& after = document.groom();
    EXPECT_TRUE(validate(after).empty()) << validate(after).front().what;
    const double cm2 = 1e4 * 3.14159 * 0.05 * 0.05;
    const auto added = static_cast<double>(after.strandCount() - 40);
    EXPECT_GT(added, 0.6 * 6 * cm2);
    EXPECT_LT(added, 1.1 * 6 * cm2);
    const auto roots = after.rootBindings();
    EXPECT_GE(minimumRootDistance(*after.scalp, std::span(roots).subspan(40)),
              std::sqrt(0.7f / 6e4f) - 1e-6f);
    for (std::size_t s = 40; s < after.strandCount(); ++s)
        EXPECT_NEAR((after.strand(s).back() - after.strand(s).front()).norm(), 0.12f, 1e-3f);
}

TEST(Add, GrowsStraightHairOnAnEmptyHead) {
    Groom groom;
    groom.scalp = sphereScalp(kHeadRadius, 4, kHeadCentre);
    groom.placement.length = 0.07f;
    groom.placement.points = 5;
    Document document(groom);
    Stroke stroke = strokeFor("add");
    ASSERT_TRUE(document.replay(stroke));
    EXPECT_GT(document.groom().strandCount(), 20u);
    EXPECT_TRUE(validate(document.groom()).empty());
    document.undo();
    EXPECT_TRUE(sameContent(document.groom(), groom));
}

}  // namespace
}  // namespace hairloom::editing
