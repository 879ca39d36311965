// SPDX-License-Identifier: GPL-3.0-or-later
// Walks over surfaces, against plane geometry, great circles and a sheet that is folded.

#include "core/geometry/surface_walk.h"

#include <gtest/gtest.h>

#include "core/geometry/closest_point.h"
#include "tests/geometry/test_meshes.h"

namespace hairloom {
namespace {

Vec3f placeOf(const ScalpMesh& mesh, const SurfacePoint& at) {
    EXPECT_GE(at.barycentric.minCoeff(), 0);
    EXPECT_NEAR(at.barycentric.sum(), 1, 1e-6f);
    return mesh.pointAt(at.triangle, at.barycentric);
}

TEST(SurfaceWalk, GoesStraightOnAPlane) {
    const auto mesh = ScalpMesh::make(test::gridSoup(12, 1));
    ASSERT_TRUE(mesh);
    const SurfaceTree tree(*mesh);
    const Vec3f middle = mesh->bounds().center();
    Random random(3);
    for (int i = 0; i < 200; ++i) {
        const auto from = tree.closest(middle + test::randomPoint(random, 0.2f)).surface;
        const Vec3f normal = mesh->triangleNormal(from.triangle);
        Vec3f offset = test::randomPoint(random, 0.2f);
        offset -= normal * normal.dot(offset);
        const Vec3f to = placeOf(*mesh, walkOnSurface(*mesh, from, offset));
        EXPECT_LT((to - placeOf(*mesh, from) - offset).norm(), 1e-6f);
    }
}

TEST(SurfaceWalk, FollowsGreatCirclesByTheLengthOfTheOffset) {
    constexpr float kRadius = 0.1f;
    const auto mesh = ScalpMesh::make(test::icosphereSoup(5, kRadius));
    ASSERT_TRUE(mesh);
    const SurfaceTree tree(*mesh);
    Random random(4);
    for (int i = 0; i < 100; ++i) {
        const Vec3f out = test::randomPoint(random, 1).normalized();
        const auto from = tree.closest(out * kRadius).surface;
        const Vec3f start = placeOf(*mesh, from).normalized();
        const Vec3f along = start.cross(test::randomPoint(random, 1)).normalized();
        const float length = 0.25f * random.uniform();  // metres, up to 143°
        const float angle = length / kRadius;
        const Vec3f expected = kRadius * (std::cos(angle) * start + std::sin(angle) * along);
        const Vec3f to = placeOf(*mesh, walkOnSurface(*mesh, from, length * along));
        EXPECT_LT((to - expected).norm(), 0.02f * length + 1e-4f) << "length " << length;
    }
}

TEST(SurfaceWalk, GoesOverAFoldAsOverASheetLaidFlat) {
    for (const float degrees : {-120.0f, -30.0f, 45.0f, 90.0f, 170.0f}) {
        // A strip in the plane y = 0 for x < 0, bent about the z axis.
        PolygonSoup soup;
        const float bend = radians(degrees);
        const auto place = [&](float x, float z) {
            return x <= 0 ? Vec3f(x, 0, z) : Vec3f(x * std::cos(bend), x * std::sin(bend), z);
        };
        for (const float x : {-1.0f, 0.0f, 1.0f})
            for (const float z : {0.0f, 1.0f}) soup.positions.push_back(place(x, z));
        test::addFace(soup, {0, 1, 3, 2});
        test::addFace(soup, {2, 3, 5, 4});
        const auto mesh = ScalpMesh::make(soup);
        ASSERT_TRUE(mesh);
        const SurfaceTree tree(*mesh);
        const auto from = tree.closest(place(-0.3f, 0.2f)).surface;
        const Vec3f to = placeOf(*mesh, walkOnSurface(*mesh, from, Vec3f(0.8f, 0, 0.4f)));
        EXPECT_LT((to - place(0.5f, 0.6f)).norm(), 1e-5f) << degrees;
    }
}

TEST(SurfaceWalk, KeepsToOpenTrianglesAndGoesAlongTheirBorder) {
    const auto mesh = ScalpMesh::make(test::gridSoup(10, 1));
    ASSERT_TRUE(mesh);
    const SurfaceTree tree(*mesh);
    const Vec3f low = mesh->bounds().min(), size = mesh->bounds().sizes();
    const Eigen::Index flat = size.x() < 1e-6f ? 0 : size.y() < 1e-6f ? 1 : 2;
    const Eigen::Index u = (flat + 1) % 3, v = (flat + 2) % 3;
    std::vector<std::uint8_t> open(mesh->triangleCount());
    for (std::uint32_t t = 0; t < open.size(); ++t) {
        const Vec3f middle = mesh->pointAt(t, Vec3f::Constant(1.0f / 3));
        open[t] = middle[u] - low[u] < 0.5f ? 1 : 0;
    }
    Vec3f at = low + 0.25f * size;
    const auto from = tree.closest(at).surface;
    Vec3f offset = Vec3f::Zero();
    offset[u] = 0.6f;
    offset[v] = 0.6f;
    // To u = 0.5, then on beside it by what is left along it.
    const SurfacePoint end = walkOnSurface(*mesh, from, offset, open);
    EXPECT_EQ(open[end.triangle], 1);
    Vec3f expected = at;
    expected[u] = low[u] + 0.5f;
    expected[v] += 0.6f;
    EXPECT_LT((placeOf(*mesh, end) - expected).norm(), 1e-4f);
    // The whole mesh ends, too; in its corner a walk stops.
    offset = Vec3f::Constant(5);
    offset[flat] = 0;
    const Vec3f corner = placeOf(*mesh, walkOnSurface(*mesh, from, offset));
    EXPECT_LT((corner - (low + size)).norm(), 1e-4f);
}

TEST(SurfaceWalk, EndsWhateverItIsGiven) {
    const auto mesh = ScalpMesh::make(test::torusSoup(24, 12, 0.1f, 0.04f));
    ASSERT_TRUE(mesh);
    Random random(9);
    for (int i = 0; i < 300; ++i) {
        SurfacePoint from{random.below(static_cast<std::uint32_t>(mesh->triangleCount())), Vec3f::Zero()};
        from.barycentric[i % 3] = 1;  // at a corner of the mesh, where many triangles meet
        std::vector<std::uint8_t> open(mesh->triangleCount());
        for (std::uint8_t& one : open) one = random.uniform() < 0.6f ? 1 : 0;
        const SurfacePoint to = walkOnSurface(*mesh, from, test::randomPoint(random, 0.3f), open);
        EXPECT_TRUE(to.triangle == from.triangle || open[to.triangle] == 1);
        placeOf(*mesh, to);
    }
    const SurfacePoint still = walkOnSurface(*mesh, {5, Vec3f(0.2f, 0.3f, 0.5f)}, Vec3f::Zero());
    EXPECT_EQ(still.triangle, 5u);
    EXPECT_LT((still.barycentric - Vec3f(0.2f, 0.3f, 0.5f)).norm(), 1e-6f);
}

}  // namespace
}  // namespace hairloom
