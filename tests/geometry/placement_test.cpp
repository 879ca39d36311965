// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry/placement.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/random.h"
#include "core/geometry/selection.h"
#include "tests/geometry/test_meshes.h"

namespace hairloom {
namespace {

using testing::HasSubstr;

std::vector<Vec3f> positionsOf(const ScalpMesh& mesh, const std::vector<SurfacePoint>& roots) {
    std::vector<Vec3f> positions;
    for (const SurfacePoint& root : roots) positions.push_back(mesh.pointAt(root.triangle, root.barycentric));
    return positions;
}

float bruteForceMinimum(const std::vector<Vec3f>& positions) {
    float nearest = std::numeric_limits<float>::infinity();
    for (std::size_t i = 0; i < positions.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) nearest = std::min(nearest, (positions[i] - positions[j]).norm());
    return nearest;
}

/// The largest distance from dense samples of the faces (corners too) to their nearest root.
float widestGap(const ScalpMesh& mesh, const FaceSet& faces, const std::vector<Vec3f>& roots, int samples) {
    Random random(77);
    float widest = 0;
    for (const std::uint32_t face : faces)
        for (int s = 0; s < samples + 3; ++s) {
            Vec3f weights = Vec3f::Unit(s % 3);
            if (s >= 3) {
                weights =
                    Vec3f(random.uniform(), random.uniform(), random.uniform()) + Vec3f::Constant(1e-3f);
                weights /= weights.sum();
            }
            const Vec3f point = mesh.pointAt(face, weights);
            float nearest = std::numeric_limits<float>::infinity();
            for (const Vec3f& root : roots) nearest = std::min(nearest, (root - point).squaredNorm());
            widest = std::max(widest, nearest);
        }
    return std::sqrt(widest);
}

void expectOnFaces(const FaceSet& faces, const std::vector<SurfacePoint>& roots) {
    for (const SurfacePoint& root : roots) {
        EXPECT_TRUE(std::binary_search(faces.begin(), faces.end(), root.triangle));
        EXPECT_GE(root.barycentric.minCoeff(), 0);
        EXPECT_NEAR(root.barycentric.sum(), 1, 1e-6);
    }
}

bool same(const std::vector<SurfacePoint>& a, const std::vector<SurfacePoint>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const SurfacePoint& x, const SurfacePoint& y) {
                          return x.triangle == y.triangle && x.barycentric == y.barycentric;
                      });
}

TEST(PlaceRandom, NumbersOnFacesFollowTheirAreas) {
    // A stretched sphere: faces of many sizes.
    PolygonSoup soup = test::icosphereSoup(2, 1);
    for (Vec3f& p : soup.positions) p = p.cwiseProduct(Vec3f(1, 3, 0.3f));
    const ScalpMesh mesh = test::meshOf(soup);
    const FaceSet faces = test::allFaces(mesh);
    PlacementRequest request;
    request.count = 100'000;
    request.seed = 5;
    const Result<Placement> placement = placeRandom(mesh, faces, request);
    ASSERT_TRUE(placement);
    ASSERT_EQ(placement->roots.size(), request.count);
    expectOnFaces(faces, placement->roots);
    std::vector<double> counts(mesh.triangleCount(), 0);
    Vec3d mean = Vec3d::Zero();
    for (const SurfacePoint& root : placement->roots) {
        counts[root.triangle] += 1;
        mean += root.barycentric.cast<double>();
    }
    const double area = selectionArea(mesh, faces);
    double chiSquare = 0;
    for (const std::uint32_t face : faces) {
        const double expected = 1e5 * mesh.triangleArea(face) / area;
        ASSERT_GT(expected, 5);
        chiSquare += (counts[face] - expected) * (counts[face] - expected) / expected;
    }
    const auto freedom = static_cast<double>(faces.size() - 1);
    EXPECT_LT(chiSquare, freedom + 4 * std::sqrt(2 * freedom));
    EXPECT_GT(chiSquare, freedom - 4 * std::sqrt(2 * freedom));
    // Uniform barycentrics have mean 1/3 and variance 1/18 each.
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(mean[i] / 1e5, 1.0 / 3, 4 * std::sqrt(1.0 / 18 / 1e5));
    const Result<Placement> again = placeRandom(mesh, faces, request);
    EXPECT_TRUE(same(placement->roots, again->roots));
    request.seed = 6;
    EXPECT_FALSE(same(placement->roots, placeRandom(mesh, faces, request)->roots));
}

TEST(PlaceRandom, MaskThinsInProportion) {
    const ScalpMesh mesh = test::meshOf(test::gridSoup(8, 1));
    std::vector<float> mask;
    for (const Vec3f& p : mesh.positions()) mask.push_back(p.x() + 0.5f);
    PlacementRequest request;
    request.count = 40'000;
    request.mask = mask;
    const Result<Placement> placement = placeRandom(mesh, test::allFaces(mesh), request);
    ASSERT_TRUE(placement);
    // Density x on [0, 1]: a quarter of the roots lie left of the middle, and the mean of x is 2/3.
    double left = 0, sum = 0;
    for (const Vec3f& p : positionsOf(mesh, placement->roots)) {
        left += p.x() < 0;
        sum += p.x() + 0.5;
    }
    EXPECT_NEAR(left / 40'000, 0.25, 4 * std::sqrt(0.25 * 0.75 / 40'000));
    EXPECT_NEAR(sum / 40'000, 2.0 / 3, 4 * std::sqrt(1.0 / 18 / 40'000));
}

void expectMaximal(const ScalpMesh& mesh, const FaceSet& faces, const Placement& placement, int samples) {
    expectOnFaces(faces, placement.roots);
    const std::vector<Vec3f> positions = positionsOf(mesh, placement.roots);
    EXPECT_GT(placement.radius, 0);
    EXPECT_GE(bruteForceMinimum(positions), placement.radius);
    EXPECT_EQ(bruteForceMinimum(positions), minimumRootDistance(mesh, placement.roots));
    EXPECT_LE(widestGap(mesh, faces, positions, samples), placement.radius * 1.001f);
}

TEST(PlaceDarts, TheSetIsMaximalOnFacesOfAnySize) {
    struct Case {
        PolygonSoup soup;
        const char* selection;
        std::size_t count;
    };
    PolygonSoup pieces = test::icosphereSoup(2, 0.2f);
    test::append(pieces, test::gridSoup(3, 0.5f), {1, 0, 0});
    const std::vector<Case> cases = {
        {test::icosphereSoup(3, 1), "cap:70", 800},
        {test::icosphereSoup(5, 1), "all", 220},          // faces much smaller than the distance
        {test::gridSoup(1, 1), "all", 850},               // and much larger
        {test::torusSoup(30, 12, 1, 0.05f), "all", 210},  // thinner than the distance
        {pieces, "all", 600}};
    for (const Case& c : cases) {
        const ScalpMesh mesh = test::meshOf(c.soup);
        const FaceSet faces = *selectFaces(mesh, c.selection);
        PlacementRequest request;
        request.count = c.count;
        request.seed = 3;
        const Result<Placement> placement = placeDarts(mesh, faces, request);
        ASSERT_TRUE(placement);
        EXPECT_EQ(placement->roots.size(), c.count);
        expectMaximal(mesh, faces, *placement, static_cast<int>(60'000 / faces.size()) + 4);
        EXPECT_TRUE(same(placement->roots, placeDarts(mesh, faces, request)->roots));
        request.seed = 4;
        EXPECT_FALSE(same(placement->roots, placeDarts(mesh, faces, request)->roots));
    }
}

TEST(PlaceDarts, AnyCountIsMetByAMaximalSet) {
    const ScalpMesh mesh = test::meshOf(test::icosphereSoup(3, 0.1f));
    const FaceSet faces = *selectFaces(mesh, "cap:80");
    for (const std::size_t count : {1u, 2u, 3u, 10u, 137u, 3000u}) {
        PlacementRequest request;
        request.count = count;
        request.seed = count;
        const Result<Placement> placement = placeDarts(mesh, faces, request);
        ASSERT_TRUE(placement) << count;
        EXPECT_EQ(placement->roots.size(), count);
        expectMaximal(mesh, faces, *placement, 60);
        if (count < 100) continue;
        const double even =
            relativeRadius(minimumRootDistance(mesh, placement->roots), count, selectionArea(mesh, faces));
        EXPECT_GT(even, 0.7) << count;
        EXPECT_LT(even, 0.85) << count;
    }
}

TEST(PlaceRandom, IsFarLessEvenThanDarts) {
    const ScalpMesh mesh = test::meshOf(test::gridSoup(4, 1));
    PlacementRequest request;
    request.count = 2000;
    const Result<Placement> placement = placeRandom(mesh, test::allFaces(mesh), request);
    ASSERT_TRUE(placement);
    EXPECT_LT(relativeRadius(minimumRootDistance(mesh, placement->roots), 2000, 1.0), 0.1);
    // As many in a lattice of triangles of side d cover √3/2 d² each.
    EXPECT_NEAR(relativeRadius(0.25, 100, 100 * std::sqrt(3.0) / 2 * 0.25 * 0.25), 1, 1e-12);
    EXPECT_EQ(relativeRadius(0.25, 1, 1), 0);
}

TEST(PlaceDarts, DensityIsMetAndAskingForTooMuchSaysWhatFits) {
    const ScalpMesh mesh = test::meshOf(test::icosphereSoup(3, 0.02f));
    const FaceSet faces = test::allFaces(mesh);
    PlacementRequest request;
    request.densityPerCm2 = 50;
    const Result<Placement> placement = placeDarts(mesh, faces, request);
    ASSERT_TRUE(placement);
    const double perCm2 = static_cast<double>(placement->roots.size()) / (selectionArea(mesh, faces) * 1e4);
    EXPECT_NEAR(perCm2, 50, 0.03 * 50);
    request.densityPerCm2 = 20'000;
    const Result<Placement> refused = placeDarts(mesh, faces, request);
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message(), HasSubstr("at most 1e+04 per cm²"));
    request.densityPerCm2 = 0;
    request.count = 0;
    EXPECT_FALSE(placeDarts(mesh, faces, request));
    request.densityPerCm2 = -3;
    EXPECT_FALSE(placeDarts(mesh, faces, request));
    request.densityPerCm2 = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(placeDarts(mesh, faces, request));
    // A millimetre of scalp a kilometre from the origin: coordinates are 0.06 mm apart.
    PolygonSoup far = test::gridSoup(2, 0.01f);
    for (Vec3f& p : far.positions) p.x() += 1000;
    const ScalpMesh farMesh = test::meshOf(far);
    request.densityPerCm2 = 200;
    const Result<Placement> blurred = placeDarts(farMesh, test::allFaces(farMesh), request);
    ASSERT_FALSE(blurred);
    EXPECT_THAT(blurred.error().message(), HasSubstr("precision"));
}

TEST(PlaceDarts, MaskWidensTheSpacing) {
    const ScalpMesh mesh = test::meshOf(test::gridSoup(10, 1));
    std::vector<float> mask;
    for (const Vec3f& p : mesh.positions())
        mask.push_back(p.x() < -0.15f ? 1.0f : p.x() > 0.15f ? 0.25f : 0.5f);
    PlacementRequest request;
    request.count = 1000;
    request.mask = mask;
    request.seed = 1;
    const Result<Placement> placement = placeDarts(mesh, test::allFaces(mesh), request);
    ASSERT_TRUE(placement);
    EXPECT_EQ(placement->roots.size(), 1000u);
    std::vector<Vec3f> dense, sparse;
    for (const Vec3f& p : positionsOf(mesh, placement->roots)) {
        if (p.x() < -0.25f) dense.push_back(p);
        if (p.x() > 0.25f) sparse.push_back(p);
    }
    EXPECT_GE(bruteForceMinimum(dense), placement->radius);
    EXPECT_GE(bruteForceMinimum(sparse), 2 * placement->radius);
    EXPECT_NEAR(static_cast<double>(dense.size()) / static_cast<double>(sparse.size()), 4, 0.6);
    // Nothing grows where the mask is 0.
    for (std::size_t v = 0; v < mask.size(); ++v) mask[v] = mesh.positions()[v].x() > 0.05f ? 0.0f : 1.0f;
    for (const Vec3f& p : positionsOf(mesh, placeDarts(mesh, test::allFaces(mesh), request)->roots))
        EXPECT_LE(p.x(), 0.1f);
    mask.assign(mask.size(), 0.0f);
    EXPECT_FALSE(placeDarts(mesh, test::allFaces(mesh), request));
    mask.pop_back();
    request.mask = mask;
    EXPECT_FALSE(placeDarts(mesh, test::allFaces(mesh), request));
    request.mask = {};
    EXPECT_FALSE(placeDarts(mesh, {}, request));
}

}  // namespace
}  // namespace hairloom
