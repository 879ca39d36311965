// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include "core/editing/penetration.h"
#include "core/editing/settings_commands.h"
#include "core/editing/sphere_commands.h"
#include "core/editing/sphere_fit.h"
#include "core/groom/spheres.h"
#include "tests/editing/editing_samples.h"
#include "tests/geometry/test_meshes.h"

namespace hairloom::editing {
namespace {

TEST(SphereFit, FitsASphericalHead) {
    const auto head = sphereScalp(kHeadRadius, 4, kHeadCentre);
    SphereFitOptions options;
    options.count = 1;
    const auto fit = fitSpheres(*head, options);
    ASSERT_TRUE(fit) << fit.error().message();
    ASSERT_EQ(fit->spheres.size(), 1u);
    EXPECT_LT((fit->spheres[0].centre - kHeadCentre).norm(), 3e-4f);
    EXPECT_NEAR(fit->spheres[0].radius, kHeadRadius, 3e-4f);
    EXPECT_LT(fit->worstGap, 5e-4f);
    EXPECT_LT(fit->worstBulge, 5e-4f);
}

TEST(SphereFit, FitsHeadsOfAnySize) {
    // Robots and ogres: 1.2 m across.
    const ScalpMesh ogre = test::meshOf(test::icosphereSoup(4, 0.6f));
    SphereFitOptions options;
    options.count = 1;
    const auto fit = fitSpheres(ogre, options);
    ASSERT_TRUE(fit) << fit.error().message();
    EXPECT_NEAR(fit->spheres[0].radius, 0.6f, 3e-3f);
    EXPECT_LT(fit->worstGap, 4e-3f);
    options.largestRadius = 0.3f;  // as asked for
    EXPECT_LE(fitSpheres(ogre, options)->spheres[0].radius, 0.3f);
    options.largestRadius = 20;
    EXPECT_FALSE(fitSpheres(ogre, options));
}

/// A head on a neck on shoulders, as three spheres that meet.
ScalpMesh threeBalls() {
    PolygonSoup soup = test::icosphereSoup(4, 0.1f);
    test::append(soup, test::icosphereSoup(4, 0.05f), Vec3f(0, -0.16f, 0));
    test::append(soup, test::icosphereSoup(4, 0.08f), Vec3f(0.05f, -0.30f, 0));
    return test::meshOf(soup);
}

TEST(SphereFit, FindsSeveralSpheres) {
    const ScalpMesh mesh = threeBalls();
    SphereFitOptions options;
    options.count = 3;
    const auto fit = fitSpheres(mesh, options);
    ASSERT_TRUE(fit);
    EXPECT_LT(fit->worstGap, 1e-3f);
    std::vector<float> radii;
    for (const CollisionSphere& sphere : fit->spheres) radii.push_back(sphere.radius);
    std::sort(radii.begin(), radii.end());
    EXPECT_NEAR(radii[0], 0.05f, 1e-3f);
    EXPECT_NEAR(radii[1], 0.08f, 1e-3f);
    EXPECT_NEAR(radii[2], 0.1f, 1e-3f);
}

TEST(SphereFit, NoSphereLiesBeforeAHollow) {
    // A bowl pressed into each side of a head.
    PolygonSoup soup = test::icosphereSoup(5, 0.1f);
    for (Vec3f& p : soup.positions) {
        const float across = Vec2f(p.y(), p.z()).norm();
        if (across < 0.06f) p.x() *= 0.75f + 4 * across * across / 0.06f;
    }
    const ScalpMesh mesh = test::meshOf(soup);
    SphereFitOptions options;
    for (const std::uint32_t count : {6u, 12u, 24u}) {
        options.count = count;
        const auto fit = fitSpheres(mesh, options);
        ASSERT_TRUE(fit);
        for (const CollisionSphere& sphere : fit->spheres)
            EXPECT_LT(sphere.centre.norm(), 0.1f) << count << ": " << sphere.name;
    }
}

TEST(SphereFit, MoreSpheresLeaveSmallerGaps) {
    // An ellipsoid, which no number of spheres covers exactly.
    PolygonSoup soup = test::icosphereSoup(4, 0.09f);
    for (Vec3f& p : soup.positions) p.z() *= 1.5f;
    const ScalpMesh mesh = test::meshOf(soup);
    float before = 1;
    for (const std::uint32_t count : {1u, 4u, 16u}) {
        SphereFitOptions options;
        options.count = count;
        const auto fit = fitSpheres(mesh, options);
        ASSERT_TRUE(fit);
        EXPECT_LT(fit->worstGap, 0.8f * before) << count;
        before = fit->worstGap;
        const SphereFit again = measureSpheres(mesh, {}, fit->spheres);
        EXPECT_EQ(again.worstGap, fit->worstGap);
    }
    EXPECT_LT(before, 0.006f);
}

TEST(SphereFit, MeasuresTheGapThatItSays) {
    const auto head = sphereScalp(kHeadRadius, 3, kHeadCentre);
    const SphereFit fit =
        measureSpheres(*head, {}, {{"a", kHeadCentre + Vec3f(0, 0.01f, 0), kHeadRadius, ""}});
    EXPECT_NEAR(fit.worstGap, 0.01f, 1e-6f);
    EXPECT_NEAR(fit.worstBulge, 0.01f, 1e-6f);
    EXPECT_NEAR(fit.worstGapAt_ss.y(), kHeadCentre.y() - kHeadRadius, 1e-6f);
}

TEST(SphereFit, RefusesInvalidInput) {
    const auto head = sphereScalp();
    SphereFitOptions options;
    options.count = 0;
    EXPECT_FALSE(fitSpheres(*head, options));
    options.count = 65;
    EXPECT_FALSE(fitSpheres(*head, options));
    EXPECT_FALSE(fitSpheres(ScalpMesh(), {}));
}

TEST(FacesNearHair, AreThoseWithinTheDistance) {
    const Groom groom = hairOnHead(200);
    const FaceSet faces = facesNearHair(groom, 0.02f);
    EXPECT_GT(faces.size(), groom.scalp->triangleCount() / 3);
    EXPECT_LT(faces.size(), groom.scalp->triangleCount());
    for (const std::uint32_t face : faces) {
        const Vec3f middle = groom.scalp->pointAt(face, Vec3f::Constant(1.0f / 3));
        EXPECT_GT(middle.y(), kHeadCentre.y() - 0.021f);
    }
}

TEST(Penetration, IsTheDeeperOfSkinAndSpheres) {
    const auto head = sphereScalp(kHeadRadius, 4, kHeadCentre);
    const Skin skin(head);
    const std::vector<Vec3f> points{kHeadCentre, kHeadCentre + Vec3f(0, 0.08f, 0),
                                    kHeadCentre + Vec3f(0, 0.2f, 0)};
    const std::vector<std::uint32_t> offsets{0, 3};
    const Penetration inHead = penetrationOf(offsets, points, {}, &skin);
    EXPECT_EQ(inHead.perPoint[0], 0);  // a root
    EXPECT_NEAR(inHead.perPoint[1], 0.01f, 3e-4f);
    EXPECT_EQ(inHead.perPoint[2], 0);
    EXPECT_EQ(inHead.points, 1u);
    const std::vector<CollisionSphere> spheres{{"far", kHeadCentre + Vec3f(0, 0.2f, 0.01f), 0.03f, ""}};
    const Penetration both = penetrationOf(offsets, points, spheres, &skin);
    EXPECT_NEAR(both.perPoint[2], 0.02f, 1e-6f);
    EXPECT_EQ(both.worst, both.perPoint[2]);
    EXPECT_EQ(both.points, 2u);
    EXPECT_EQ(penetrationOf(offsets, points, {}, nullptr).points, 0u);
}

TEST(SphereCommands, PlaceMoveResizeAttachMirrorRenameRemove) {
    Document document(hairOnHead(20));
    const auto spheres = [&]() -> const std::vector<CollisionSphere>& { return document.groom().spheres; };
    const SurfaceTree tree(*document.groom().scalp);
    const SurfacePoint side = tree.closest(kHeadCentre + Vec3f(0.2f, 0, 0)).surface;
    document.perform(placeSphere(document.model(), side, 0.02f));
    ASSERT_EQ(spheres().size(), 1u);
    EXPECT_NEAR(spheres()[0].centre.x(), kHeadRadius - 0.02f, 1e-3f);
    document.perform(moveSphere(document.model(), 0, Vec3f(0.05f, 1.5f, 0)));
    document.perform(resizeSphere(document.model(), 0, 100));
    EXPECT_EQ(spheres()[0].radius, kLargestSphere);
    document.perform(resizeSphere(document.model(), 0, 0.03f));
    document.perform(attachSphere(document.model(), 0, "clavicle_L"));
    document.perform(renameSphere(document.model(), 0, "Shoulder.L"));
    document.perform(mirrorSphere(document.model(), 0));
    ASSERT_EQ(spheres().size(), 2u);
    EXPECT_EQ(spheres()[1].centre, Vec3f(-0.05f, 1.5f, 0));
    EXPECT_EQ(spheres()[1].bone, "clavicle_R");
    EXPECT_EQ(spheres()[1].name, "Shoulder.R");
    document.perform(removeSphere(document.model(), 0));
    EXPECT_EQ(spheres().size(), 1u);
    EXPECT_EQ(document.history().size(), 8u);
    EXPECT_EQ(moveSphere(document.model(), 0, spheres()[0].centre), nullptr);
    EXPECT_EQ(moveSphere(document.model(), 0, Vec3f::Constant(std::numeric_limits<float>::infinity())),
              nullptr);
    EXPECT_FALSE(hasErrors(validate(document.groom())));
}

TEST(SphereCommands, JoinSpheresInCapsules) {
    Document document(hairOnHead(20));
    const auto spheres = [&]() -> const std::vector<CollisionSphere>& { return document.groom().spheres; };
    const std::vector<CollisionSphere> three{{"A", Vec3f(0, 0, 0), 0.1f, ""},
                                             {"Arm.L", Vec3f(0.3f, 0, 0), 0.05f, "arm_L"},
                                             {"Hand.L", Vec3f(0.5f, 0, 0), 0.03f, "hand_L"}};
    document.perform(setSpheres(document.model(), three, "Three"));
    EXPECT_TRUE(capsulesOf(spheres()).empty());
    document.perform(joinSphere(document.model(), 1, 2));
    ASSERT_EQ(capsulesOf(spheres()).size(), 1u);
    EXPECT_EQ(joinSphere(document.model(), 1, 2), nullptr) << "nothing would change";
    // The other way round it is the same capsule, not a second one.
    document.perform(joinSphere(document.model(), 2, 1));
    EXPECT_EQ(capsulesOf(spheres()).size(), 1u);
    document.perform(joinSphere(document.model(), 1, 2));
    document.perform(mirrorSphere(document.model(), 1));
    ASSERT_EQ(spheres().size(), 5u) << "both ends";
    EXPECT_EQ(spheres()[3].name, "Arm.R");
    EXPECT_EQ(spheres()[4].name, "Hand.R");
    EXPECT_EQ(spheres()[3].joined, 4);
    EXPECT_EQ(spheres()[1].joined, 2);
    // What is behind one that goes keeps its partner.
    document.perform(removeSphere(document.model(), 0));
    EXPECT_EQ(spheres()[0].joined, 1);
    EXPECT_EQ(spheres()[2].joined, 3);
    document.perform(removeSphere(document.model(), 1));
    EXPECT_EQ(spheres()[0].joined, -1) << "its partner has gone";
    EXPECT_EQ(capsulesOf(spheres()).size(), 1u);
    document.perform(joinSphere(document.model(), 1, -1));
    EXPECT_TRUE(capsulesOf(spheres()).empty());
    document.perform(joinSphere(document.model(), 1, 99));
    EXPECT_TRUE(capsulesOf(spheres()).empty());
    EXPECT_FALSE(hasErrors(validate(document.groom())));
    document.undo();
    Groom wrong = document.groom();
    wrong.spheres[0].joined = 7;
    EXPECT_TRUE(hasErrors(validate(wrong)));
    wrong.spheres[0].joined = 0;
    EXPECT_TRUE(hasErrors(validate(wrong)));
}

TEST(CapsuleFit, ClosesAGapBetweenSpheresAndBulgesNoFarther) {
    // A bar with round ends, 40 cm long: two spheres cover its ends alone.
    PolygonSoup soup = test::icosphereSoup(5, 0.05f);
    for (Vec3f& at : soup.positions) at.x() += at.x() > 0 ? 0.15f : -0.15f;
    const ScalpMesh bar = test::meshOf(soup);
    std::vector<CollisionSphere> ends{{"a", Vec3f(-0.15f, 0, 0), 0.05f, ""},
                                      {"b", Vec3f(0.15f, 0, 0), 0.05f, ""}};
    // The rows of faces between the halves are long: the vertices alone lie on the ends' own spheres.
    FaceSet all;
    for (std::uint32_t face = 0; face < bar.triangleCount(); ++face) all.push_back(face);
    std::vector<CollisionSphere> apart = ends;
    joinSpheres(bar, all, 0.001f, apart);
    EXPECT_TRUE(capsulesOf(apart).empty()) << "no vertex lies outside, so that nothing is gained";

    const ScalpMesh three = threeBalls();
    SphereFitOptions options;
    options.count = 8;
    // A stretched ball: spheres leave scallops that capsules fill.
    PolygonSoup egg = test::icosphereSoup(5, 0.05f);
    for (Vec3f& at : egg.positions) at.x() *= 4;
    const ScalpMesh stretched = test::meshOf(egg);
    for (const ScalpMesh* mesh : {&three, &stretched}) {
        auto fit = fitSpheres(*mesh, options);
        ASSERT_TRUE(fit);
        std::vector<CollisionSphere> joined = fit->spheres;
        joinSpheres(*mesh, {}, 0.001f, joined);
        const SphereFit after = measureSpheres(*mesh, {}, joined);
        EXPECT_LE(after.worstGap, fit->worstGap);
        EXPECT_LE(after.meanGap, fit->meanGap);
        EXPECT_LE(after.worstBulge, std::max(fit->worstBulge, 0.001f) + 1e-4f);
        if (mesh == &stretched) {
            EXPECT_LT(after.meanGap, 0.7f * fit->meanGap);
            EXPECT_GE(capsulesOf(joined).size(), 3u);
        }
        // Those on different bones stay apart: a capsule would stretch with the pose.
        std::vector<CollisionSphere> boned = fit->spheres;
        for (std::size_t s = 0; s < boned.size(); ++s) boned[s].bone = std::to_string(s);
        joinSpheres(*mesh, {}, 0.001f, boned);
        EXPECT_TRUE(capsulesOf(boned).empty());
    }
}

TEST(CapsuleFit, BridgesNoHollow) {
    // Two balls that stand apart on a third, as chin and chest on a neck: between them is air.
    PolygonSoup soup = test::icosphereSoup(4, 0.06f);
    for (const float x : {-0.09f, 0.09f})
        test::append(soup, test::icosphereSoup(4, 0.05f), Vec3f(x, 0.08f, 0));
    const ScalpMesh mesh = test::meshOf(soup);
    std::vector<CollisionSphere> balls{{"a", Vec3f(-0.09f, 0.08f, 0), 0.045f, ""},
                                       {"b", Vec3f(0.09f, 0.08f, 0), 0.045f, ""}};
    joinSpheres(mesh, {}, 0.001f, balls);
    EXPECT_TRUE(capsulesOf(balls).empty());
}

TEST(ColliderDistance, IsThatOfTheDeepestSphereOfAHull) {
    const std::vector<CollisionSphere> pair{{"a", Vec3f(0, 0, 0), 0.1f, "", 1},
                                            {"b", Vec3f(0.5f, 0, 0), 0.02f, ""}};
    const ColliderDistance distance(pair);
    for (int i = 0; i < 50; ++i) {
        const float f = static_cast<float>(i);
        const Vec3f at(0.3f + 0.3f * std::sin(f), 0.15f * std::cos(1.3f * f), 0.1f * std::sin(2.1f * f));
        float nearest = 1e9f;
        for (int k = 0; k <= 4000; ++k) {
            const float share = static_cast<float>(k) / 4000;
            nearest = std::min(nearest, (at - Vec3f(0.5f * share, 0, 0)).norm() - (0.1f - 0.08f * share));
        }
        EXPECT_NEAR(distance(at), nearest, 2e-6f);
    }
    const std::vector<Vec3f> moved{Vec3f(0, 1, 0), Vec3f(0.5f, 1, 0)};
    EXPECT_NEAR(ColliderDistance(pair, moved)(Vec3f(0.25f, 1.2f, 0)), distance(Vec3f(0.25f, 0.2f, 0)), 1e-6f);
    EXPECT_TRUE(std::isinf(ColliderDistance({})(Vec3f::Zero())));
}

TEST(SphereCommands, KnowOtherSides) {
    EXPECT_EQ(otherSide("arm_L"), "arm_R");
    EXPECT_EQ(otherSide("LeftArm"), "RightArm");
    EXPECT_EQ(otherSide("shoulder.r"), "shoulder.l");
    EXPECT_EQ(otherSide("Head"), "Head");
}

}  // namespace
}  // namespace hairloom::editing
