// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry/closest_point.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "tests/geometry/test_meshes.h"

namespace hairloom {
namespace {

double distanceToSegment(const Vec3d& p, const Vec3d& a, const Vec3d& b) {
    const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    return (p - a - t * (b - a)).norm();
}

/// Distance to a triangle from its plane and its sides, written apart from the code under test.
double distanceToTriangle(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const Vec3d n = (b - a).cross(c - a).normalized();
    const auto inner = [&](const Vec3d& u, const Vec3d& v) { return (v - u).cross(p - u).dot(n) >= 0; };
    if (inner(a, b) && inner(b, c) && inner(c, a)) return std::abs((p - a).dot(n));
    return std::min({distanceToSegment(p, a, b), distanceToSegment(p, b, c), distanceToSegment(p, c, a)});
}

double bruteForce(const ScalpMesh& mesh, const FaceSet& faces, const Vec3f& point) {
    double best = std::numeric_limits<double>::infinity();
    for (const std::uint32_t face : faces) {
        const Triangle& t = mesh.triangles()[face];
        const auto corner = [&](std::size_t i) -> Vec3d { return mesh.positions()[t[i]].cast<double>(); };
        best = std::min(best, distanceToTriangle(point.cast<double>(), corner(0), corner(1), corner(2)));
    }
    return best;
}

TEST(SurfaceTree, ClosestAgreesWithAllTriangles) {
    const ScalpMesh mesh = test::meshOf(test::torusSoup(24, 12, 1, 0.4f));
    FaceSet some;
    for (std::uint32_t t = 0; t < mesh.triangleCount(); t += 3) some.push_back(t);
    for (const FaceSet& faces : {test::allFaces(mesh), some}) {
        const SurfaceTree tree(mesh, faces);
        Random random(3);
        for (int i = 0; i < 500; ++i) {
            const Vec3f point = test::randomPoint(random, 2);
            const SurfaceTree::Hit hit = tree.closest(point);
            EXPECT_NEAR(hit.distance, bruteForce(mesh, faces, point), 1e-5);
            EXPECT_TRUE(std::binary_search(faces.begin(), faces.end(), hit.surface.triangle));
            EXPECT_NEAR((mesh.pointAt(hit.surface.triangle, hit.surface.barycentric) - hit.position).norm(),
                        0, 1e-5);
            EXPECT_NEAR(hit.surface.barycentric.sum(), 1, 1e-6);
            EXPECT_GE(hit.surface.barycentric.minCoeff(), 0);
        }
    }
}

TEST(SurfaceTree, SignIsCorrectInsideASharpSolid) {
    // A thin wedge: at its sharp edges the sign of one face's normal alone is wrong for many points.
    PolygonSoup soup;
    soup.positions = {{-1, 0, -1}, {1, 0, -1}, {0, 0, 1}, {0, 0.2f, 0}};
    test::addFace(soup, {0, 1, 2});
    test::addFace(soup, {0, 3, 1});
    test::addFace(soup, {1, 3, 2});
    test::addFace(soup, {2, 3, 0});
    const ScalpMesh mesh = test::meshOf(soup);
    const SurfaceTree tree(mesh);
    Random random(4);
    for (int i = 0; i < 3000; ++i) {
        const Vec3f point = test::randomPoint(random, 1.5f);
        bool inside = true;
        for (std::uint32_t t = 0; t < 4; ++t)
            inside =
                inside && (point - mesh.positions()[mesh.triangles()[t][0]]).dot(mesh.triangleNormal(t)) < 0;
        const float distance = tree.signedDistance(point);
        EXPECT_TRUE(std::abs(distance) <= 1e-5f || (distance < 0) == inside) << point.transpose();
    }
}

TEST(SurfaceTree, RaysHitTheNearSideOfASphere) {
    const ScalpMesh mesh = test::meshOf(test::icosphereSoup(4, 1));
    const SurfaceTree tree(mesh);
    Random random(5);
    for (int i = 0; i < 200; ++i) {
        const Vec3f direction = test::randomPoint(random, 1).normalized();
        const auto hit = tree.firstHit(-3 * direction, 7 * direction);
        ASSERT_TRUE(hit);
        EXPECT_NEAR(hit->distance, 2, 5e-3);
        EXPECT_LT(hit->position.dot(direction), -0.99f);
        EXPECT_FALSE(tree.firstHit(3 * direction, direction));
    }
    EXPECT_FALSE(tree.firstHit(Vec3f(0, 0, -3), Vec3f::Zero()));
    EXPECT_FALSE(tree.firstHit(Vec3f(0, 0, -3), Vec3f(0, std::numeric_limits<float>::quiet_NaN(), 1)));
}

TEST(SurfaceTree, EmptyMeshIsInfinitelyFar) {
    const ScalpMesh mesh;
    const SurfaceTree tree(mesh);
    EXPECT_EQ(tree.closest(Vec3f::Zero()).distance, std::numeric_limits<float>::infinity());
    EXPECT_FALSE(tree.firstHit(Vec3f::Zero(), Vec3f::UnitX()));
}

}  // namespace
}  // namespace hairloom
