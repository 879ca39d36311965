// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry/closest_point.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "core/geometry/shapes.h"
#include "core/geometry/triangle_tree.h"
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

/// A ray between the triangles of a closed surface must not slip through; rays along axes and through corners
/// and edges are those that might.
TEST(SurfaceTree, RaysThroughCornersAndEdgesDoNotSlipThrough) {
    const ScalpMesh mesh = test::meshOf(shapes::icosphere(3, 0.1f));
    const SurfaceTree tree(mesh);
    for (const Triangle& t : mesh.triangles()) {
        const Vec3f a = mesh.positions()[t[0]], b = mesh.positions()[t[1]];
        for (const Vec3f& target : {a, Vec3f((a + b) / 2)}) {
            const Vec3f aside = target + Vec3f(0.05f, -0.02f, 0.03f);
            for (const Vec3f& from : {Vec3f(Vec3f::Zero()), Vec3f(2 * target), Vec3f(1.7f * aside)}) {
                const float slant = (from - target).normalized().dot(target.normalized());
                if (std::abs(slant) < 0.3f) continue;  // past the rim one may miss
                const auto hit = tree.firstHit(from, target - from);
                ASSERT_TRUE(hit) << target.transpose() << " from " << from.transpose();
                EXPECT_LE(hit->distance, (target - from).norm() + 1e-6f);
                EXPECT_NEAR(
                    (mesh.pointAt(hit->surface.triangle, hit->surface.barycentric) - hit->position).norm(), 0,
                    1e-6);
            }
        }
    }
}

/// Against all triangles: an independent intersection by the volumes of tetrahedra.
TEST(SurfaceTree, RaysAgreeWithAllTriangles) {
    const ScalpMesh mesh = test::meshOf(test::torusSoup(24, 12, 1, 0.4f));
    const SurfaceTree tree(mesh);
    Random random(11);
    int hits = 0;
    for (int i = 0; i < 1000; ++i) {
        const Vec3f from = test::randomPoint(random, 2), direction = test::randomPoint(random, 1);
        const Vec3d o = from.cast<double>(), far = o + 100 * direction.cast<double>().normalized();
        double nearest = std::numeric_limits<double>::infinity();
        for (const Triangle& t : mesh.triangles()) {
            const auto corner = [&](std::size_t k) -> Vec3d { return mesh.positions()[t[k]].cast<double>(); };
            const Vec3d a = corner(0), b = corner(1), c = corner(2);
            const auto volume = [](const Vec3d& p, const Vec3d& q, const Vec3d& r, const Vec3d& s) {
                return (q - p).cross(r - p).dot(s - p);
            };
            const double u = volume(o, far, a, b), v = volume(o, far, b, c), w = volume(o, far, c, a);
            const double start = volume(a, b, c, o), end = volume(a, b, c, far);
            if ((u > 0) != (v > 0) || (u > 0) != (w > 0) || start * end > 0) continue;
            nearest = std::min(nearest, 100 * start / (start - end));
        }
        const auto hit = tree.firstHit(from, 3 * direction);
        ASSERT_EQ(hit.has_value(), std::isfinite(nearest)) << i;
        if (!hit) continue;
        ++hits;
        EXPECT_NEAR(hit->distance, nearest, 1e-5);
    }
    EXPECT_GT(hits, 100);
}

TEST(SurfaceTree, ManyTrianglesInOnePlaceAreAnswered) {
    // Equal centres: the tree cannot part them by place.
    PolygonSoup soup;
    soup.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    std::vector<TriangleTree::Corners> same(1000, {soup.positions[0], soup.positions[1], soup.positions[2]});
    same.push_back({Vec3f(0, 0, 2), Vec3f(0, 0, 2), Vec3f(0, 0, 2)});  // a point
    same.push_back({Vec3f(0, 0, 3), Vec3f(1, 0, 3), Vec3f(2, 0, 3)});  // a line
    const TriangleTree tree(same);
    EXPECT_EQ(tree.closest(Vec3f(0.2f, 0.2f, 0.5f))->triangle, 0u) << "the least index";
    EXPECT_NEAR(tree.closest(Vec3f(0.2f, 0.2f, 0.5f))->distance, 0.5, 1e-7);
    EXPECT_EQ(tree.closest(Vec3f(0, 0, 1.9f))->triangle, 1000u);
    EXPECT_EQ(tree.closest(Vec3f(1.2f, 0.1f, 3))->triangle, 1001u);
    EXPECT_NEAR(tree.closest(Vec3f(1.2f, 0.1f, 3))->distance, 0.1, 1e-6);
    EXPECT_EQ(tree.firstHit(Vec3f(0.2f, 0.2f, 5), Vec3f(0, 0, -1))->triangle, 0u);
}

TEST(SurfaceTree, EmptyMeshIsInfinitelyFar) {
    const ScalpMesh mesh;
    const SurfaceTree tree(mesh);
    EXPECT_EQ(tree.closest(Vec3f::Zero()).distance, std::numeric_limits<float>::infinity());
    EXPECT_FALSE(tree.firstHit(Vec3f::Zero(), Vec3f::UnitX()));
}

}  // namespace
}  // namespace hairloom
