// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry/mesh_solid.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/base/parallel.h"
#include "tests/geometry/test_meshes.h"

namespace hairloom {
namespace {

MeshSolid solidOf(const PolygonSoup& soup) {
    const ScalpMesh mesh = test::meshOf(soup);
    return {mesh.positions(), mesh.triangles()};
}

/// The sum over all triangles, from the angles of their spherical images (Girard), apart from the code under
/// test.
double windingByAngles(const ScalpMesh& mesh, const Vec3f& point) {
    double sum = 0;
    for (const Triangle& t : mesh.triangles()) {
        Vec3d u[3];
        for (std::size_t i = 0; i < 3; ++i)
            u[i] = (mesh.positions()[t[i]] - point).cast<double>().normalized();
        double excess = -std::numbers::pi;
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3d a = u[i].cross(u[(i + 1) % 3]), b = u[i].cross(u[(i + 2) % 3]);
            excess += std::atan2(a.cross(b).norm(), a.dot(b));
        }
        sum += u[0].dot(u[1].cross(u[2])) < 0 ? -excess : excess;
    }
    return sum / (4 * std::numbers::pi);
}

TEST(WindingNumber, AgreesWithAllTriangles) {
    // Half of a torus: open at both ends.
    PolygonSoup soup = test::torusSoup(40, 16, 1, 0.4f);
    soup.corners.resize(soup.corners.size() / 2);
    soup.offsets.resize(soup.offsets.size() / 2 + 1);
    const ScalpMesh mesh = test::meshOf(soup);
    const MeshSolid solid(mesh.positions(), mesh.triangles());
    Random random(5);
    for (int i = 0; i < 500; ++i) {
        const Vec3f point = test::randomPoint(random, 1.5f);
        EXPECT_NEAR(solid.tree().windingNumber(point), windingByAngles(mesh, point), 0.01);
    }
}

TEST(MeshSolid, KnowsInsideFromOutside) {
    const MeshSolid ball = solidOf(test::icosphereSoup(4, 0.1f));
    Random random(1);
    for (int i = 0; i < 500; ++i) {
        const Vec3f point = test::randomPoint(random, 0.15f);
        EXPECT_NEAR(ball.signedDistance(point), point.norm() - 0.1f, 3e-4f);
    }
    EXPECT_TRUE(ball.enclosesAnything());
}

TEST(MeshSolid, AnOpenHeadHasAnInside) {
    // A ball without its lowest seventh, as heads are open at the neck.
    PolygonSoup soup = test::icosphereSoup(4, 0.1f), open = soup;
    open.corners.clear();
    open.offsets = {0};
    for (std::size_t f = 0; f + 1 < soup.offsets.size(); ++f) {
        const auto corner = [&](std::size_t i) { return soup.corners[soup.offsets[f] + i]; };
        if (soup.positions[corner(0)].y() < -0.07f) continue;
        for (std::size_t i = 0; i < 3; ++i) open.corners.push_back(corner(i));
        open.offsets.push_back(static_cast<std::uint32_t>(open.corners.size()));
    }
    const MeshSolid head = solidOf(open);
    EXPECT_TRUE(head.enclosesAnything());
    EXPECT_NEAR(head.signedDistance({0, 0.08f, 0}), -0.02f, 3e-4f);
    EXPECT_NEAR(head.signedDistance({0, 0.12f, 0}), 0.02f, 3e-4f);
    EXPECT_TRUE(head.contains({0, 0, 0}));
    EXPECT_FALSE(head.contains({0, -0.12f, 0})) << "below the neck";
}

TEST(MeshSolid, PartsMayBeNestedAndMirrored) {
    PolygonSoup soup = test::icosphereSoup(3, 0.1f);
    test::append(soup, test::icosphereSoup(3, 0.02f), Vec3f(0.05f, 0, 0));  // an eye in its socket
    PolygonSoup mirrored = test::icosphereSoup(3, 0.05f);
    for (std::size_t f = 0; f + 1 < mirrored.offsets.size(); ++f)
        std::swap(mirrored.corners[mirrored.offsets[f]], mirrored.corners[mirrored.offsets[f] + 1]);
    test::append(soup, mirrored, Vec3f(0, 0.3f, 0));
    const MeshSolid solid = solidOf(soup);
    EXPECT_TRUE(solid.contains({0.05f, 0, 0}));
    EXPECT_TRUE(solid.contains({-0.05f, 0, 0}));
    EXPECT_TRUE(solid.contains({0, 0.3f, 0})) << "inside out";
    EXPECT_FALSE(solid.contains({0, 0.2f, 0}));
}

TEST(MeshSolid, ASheetEnclosesNothing) {
    const MeshSolid sheet = solidOf(test::gridSoup(8, 1));
    EXPECT_FALSE(sheet.enclosesAnything());
    EXPECT_FALSE(sheet.contains({0, 0.01f, 0}));
    EXPECT_FALSE(sheet.contains({0, -0.01f, 0}));
    const MeshSolid none({}, {});
    EXPECT_FALSE(none.enclosesAnything());
    EXPECT_FALSE(none.contains({0, 0, 0}));
    EXPECT_TRUE(std::isinf(none.distance({0, 0, 0})));
}

TEST(SolidGrid, BoundsTheDistance) {
    const MeshSolid torus = solidOf(test::torusSoup(40, 16, 0.1f, 0.04f));
    const SolidGrid grid(torus);
    Random random(2);
    std::vector<Vec3f> points(2000);
    for (Vec3f& point : points) point = test::randomPoint(random, 0.16f);
    std::vector<float> wrong(points.size());
    parallelFor(points.size(), 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const SolidGrid::Bound bound = grid.at(points[i]);
            if (std::isinf(bound.distance)) {
                wrong[i] = torus.contains(points[i]) ? 1.0f : 0.0f;
                continue;
            }
            wrong[i] = std::abs(torus.signedDistance(points[i]) - bound.distance) - bound.away;
        }
    });
    for (const float by : wrong) EXPECT_LE(by, 1e-6f);
    // What is far larger than heads has larger cells, not more of them.
    const MeshSolid large = solidOf(test::icosphereSoup(2, 100));
    EXPECT_GT(SolidGrid(large).at({1, 2, 3}).away, 0.01f);
    EXPECT_LT(SolidGrid(large).at({1, 2, 3}).distance, -90);
}

}  // namespace
}  // namespace hairloom
