// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry/scalp_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "core/base/random.h"
#include "tests/geometry/test_meshes.h"

namespace hairloom {
namespace {

using test::addFace;
using test::meshOf;

std::size_t repairsOf(const ScalpMesh& mesh, const std::string& what) {
    for (const MeshRepair& repair : mesh.repairs())
        if (repair.what == what) return repair.count;
    return 0;
}

double totalArea(const ScalpMesh& mesh) {
    double area = 0;
    for (std::uint32_t t = 0; t < mesh.triangleCount(); ++t) area += mesh.triangleArea(t);
    return area;
}

/// What the class promises, checked from the triangle list alone and against the halfedges.
void expectManifold(const ScalpMesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> directed;
    std::vector<std::size_t> degree(mesh.vertexCount(), 0);
    for (const Triangle& t : mesh.triangles())
        for (std::size_t i = 0; i < 3; ++i) {
            ASSERT_LT(t[i], mesh.vertexCount());
            const std::pair side(t[i], t[(i + 1) % 3]);
            EXPECT_EQ(++directed[side], 1);
            ++degree[t[i]];
        }
    ASSERT_EQ(mesh.connectivity().n_faces(), mesh.triangleCount());
    ASSERT_EQ(mesh.connectivity().n_vertices(), mesh.vertexCount());
    for (std::uint32_t v = 0; v < mesh.vertexCount(); ++v) {
        EXPECT_NEAR(mesh.normals()[v].norm(), 1, 1e-5);
        std::size_t fan = 0;
        for (const auto face : mesh.connectivity().vf_range(OpenMesh::VertexHandle(static_cast<int>(v))))
            fan += face.is_valid();
        EXPECT_EQ(fan, degree[v]) << "vertex " << v << " has several fans";
    }
    for (std::uint32_t t = 0; t < mesh.triangleCount(); ++t) {
        EXPECT_GT(mesh.triangleArea(t), 0);
        const auto corners = mesh.connectivity().fv_range(OpenMesh::FaceHandle(static_cast<int>(t)));
        std::vector<std::uint32_t> found;
        for (const auto v : corners) found.push_back(static_cast<std::uint32_t>(v.idx()));
        std::sort(found.begin(), found.end());
        Triangle wanted = mesh.triangles()[t];
        std::sort(wanted.begin(), wanted.end());
        EXPECT_TRUE(std::equal(found.begin(), found.end(), wanted.begin(), wanted.end()));
    }
}

TEST(ScalpMesh, SphereHasRadialNormalsAndTheAreaOfASphere) {
    const ScalpMesh mesh = meshOf(test::icosphereSoup(4, 0.1f));
    expectManifold(mesh);
    EXPECT_EQ(mesh.vertexCount(), 2562u);
    for (std::uint32_t v = 0; v < mesh.vertexCount(); ++v)
        EXPECT_GT(mesh.normals()[v].dot(mesh.positions()[v].normalized()), 0.9999f);
    EXPECT_NEAR(totalArea(mesh), 4 * kPi * 0.01, 0.005 * 4 * kPi * 0.01);
    EXPECT_EQ(repairsOf(mesh, "missing normals computed"), 2562u);
}

TEST(ScalpMesh, WeldsEqualPositionsAndBothZeros) {
    PolygonSoup soup;
    soup.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, -0.0f}, {1, 1, 0}, {-0.0f, 1, 0}};
    addFace(soup, {0, 1, 2});
    addFace(soup, {3, 4, 5});
    const ScalpMesh mesh = meshOf(soup);
    expectManifold(mesh);
    EXPECT_EQ(mesh.vertexCount(), 4u);
    EXPECT_EQ(repairsOf(mesh, "duplicate vertices welded"), 2u);
    EXPECT_EQ(mesh.connectivity().n_edges(), 5u);
    EXPECT_EQ(std::vector<std::uint32_t>(mesh.sourceVertices().begin(), mesh.sourceVertices().end()),
              (std::vector<std::uint32_t>{0, 1, 2, 4}));
}

TEST(ScalpMesh, ConcavePolygonsKeepTheirAreaAndNormal) {
    // A comb: a base and 40 teeth; a fan from any corner would leave it.
    PolygonSoup soup;
    std::vector<std::uint32_t> outline;
    double area = 0;
    constexpr int kTeeth = 40;
    const auto corner = [&](float x, float y) {
        outline.push_back(static_cast<std::uint32_t>(soup.positions.size()));
        soup.positions.emplace_back(x, y, 0.3f * x);  // in a tilted plane
    };
    corner(0, -1);
    corner(2 * kTeeth, -1);
    for (int i = kTeeth - 1; i >= 0; --i) {
        corner(static_cast<float>(2 * i + 2), 0);
        corner(static_cast<float>(2 * i + 1), 5);
        corner(static_cast<float>(2 * i), 0);
        area += 5;
    }
    area += 2 * kTeeth;
    soup.corners = outline;
    soup.offsets = {0, static_cast<std::uint32_t>(outline.size())};
    const ScalpMesh mesh = meshOf(soup);
    expectManifold(mesh);
    EXPECT_NEAR(totalArea(mesh), area * std::sqrt(1.09), 1e-3);
    for (std::uint32_t t = 0; t < mesh.triangleCount(); ++t) EXPECT_GT(mesh.triangleNormal(t).z(), 0.9f);
}

TEST(ScalpMesh, ConcaveQuadIsCutInside) {
    for (std::uint32_t start = 0; start < 4; ++start) {
        PolygonSoup soup;
        soup.positions = {{0, 0, 0}, {2, -1, 0}, {0.5f, 0, 0}, {2, 1, 0}};
        soup.positions[0].x() = -1;
        soup.positions[2].x() = 0.5f;
        addFace(soup, {start, (start + 1) % 4, (start + 2) % 4, (start + 3) % 4});
        const ScalpMesh mesh = meshOf(soup);
        ASSERT_EQ(mesh.triangleCount(), 2u);
        EXPECT_NEAR(totalArea(mesh), 1.5, 1e-6);
        EXPECT_EQ(mesh.sourceFaces()[1], 0u);
    }
}

TEST(ScalpMesh, EdgeOfThreeFacesIsOpened) {
    PolygonSoup soup;
    soup.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}};
    addFace(soup, {0, 1, 2});
    addFace(soup, {1, 0, 3});
    addFace(soup, {0, 1, 4});
    const ScalpMesh mesh = meshOf(soup);
    expectManifold(mesh);
    EXPECT_EQ(mesh.triangleCount(), 3u);
    EXPECT_EQ(repairsOf(mesh, "edges with more than two faces, or faces that disagree, opened"), 1u);
}

TEST(ScalpMesh, BowTieVertexIsSplit) {
    PolygonSoup soup;
    soup.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
    addFace(soup, {0, 1, 2});
    addFace(soup, {0, 3, 4});
    const ScalpMesh mesh = meshOf(soup);
    expectManifold(mesh);
    EXPECT_EQ(mesh.vertexCount(), 6u);
    EXPECT_EQ(repairsOf(mesh, "vertices split where parts only touch"), 1u);
}

TEST(ScalpMesh, TurnedFacesAreTurnedBack) {
    PolygonSoup soup = test::icosphereSoup(2, 1);
    for (std::size_t f = 0; f < 100; f += 7) std::swap(soup.corners[3 * f], soup.corners[3 * f + 1]);
    const ScalpMesh mesh = meshOf(soup);
    expectManifold(mesh);
    EXPECT_EQ(repairsOf(mesh, "faces turned to agree with their neighbours"), 15u);
    for (std::uint32_t t = 0; t < mesh.triangleCount(); ++t)
        EXPECT_GT(mesh.triangleNormal(t).dot(mesh.pointAt(t, Vec3f::Constant(1.0f / 3))), 0);
}

TEST(ScalpMesh, MoebiusBandIsOpened) {
    PolygonSoup soup;
    constexpr std::uint32_t kSteps = 24;
    for (std::uint32_t i = 0; i < kSteps; ++i) {
        const float a = 2 * kPi * static_cast<float>(i) / kSteps;
        for (const float s : {-0.3f, 0.3f})
            soup.positions.emplace_back((1 + s * std::cos(a / 2)) * std::cos(a), s * std::sin(a / 2),
                                        (1 + s * std::cos(a / 2)) * std::sin(a));
    }
    for (std::uint32_t i = 0; i + 1 < kSteps; ++i) addFace(soup, {2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2});
    addFace(soup, {2 * kSteps - 2, 2 * kSteps - 1, 0, 1});
    const ScalpMesh mesh = meshOf(soup);
    expectManifold(mesh);
    EXPECT_EQ(mesh.triangleCount(), 2 * kSteps);
}

TEST(ScalpMesh, DegenerateAndRepeatedFacesAreDropped) {
    PolygonSoup soup;
    soup.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}};
    addFace(soup, {0, 1, 2});
    addFace(soup, {1, 2, 0});
    addFace(soup, {0, 2, 1});
    addFace(soup, {0, 1, 3});
    addFace(soup, {0, 0, 1, 1});
    addFace(soup, {0});
    addFace(soup, {});
    addFace(soup, {2, 2});
    const ScalpMesh mesh = meshOf(soup);
    expectManifold(mesh);
    EXPECT_EQ(mesh.triangleCount(), 1u);
    EXPECT_EQ(repairsOf(mesh, "repeated faces dropped"), 2u);
    EXPECT_EQ(repairsOf(mesh, "degenerate faces dropped"), 5u);
}

TEST(ScalpMesh, CornersKeepTheirUvsAndFacesTheirGroups) {
    PolygonSoup soup = test::gridSoup(4, 1);
    soup.groupNames = {"left", "right"};
    for (std::uint32_t f = 0; f < 16; ++f) soup.faceGroups.push_back(f % 4 < 2 ? 0 : 1);
    const ScalpMesh mesh = meshOf(soup);
    ASSERT_EQ(mesh.cornerUvs().size(), 3 * mesh.triangleCount());
    for (std::uint32_t t = 0; t < mesh.triangleCount(); ++t) {
        const Vec3f weights(0.2f, 0.3f, 0.5f);
        const Vec3f p = mesh.pointAt(t, weights);
        EXPECT_NEAR(mesh.uvAt(t, weights).x(), p.x() + 0.5f, 1e-6);
        EXPECT_NEAR(mesh.uvAt(t, weights).y(), 0.5f - p.z(), 1e-6);
        EXPECT_EQ(mesh.triangleGroups()[t], p.x() < 0 ? 0u : 1u);
        EXPECT_GT(mesh.triangleNormal(t).y(), 0.99f);
    }
}

TEST(ScalpMesh, RefusesWhatNamesNothing) {
    const float kNan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(ScalpMesh::make({}));
    PolygonSoup soup = test::gridSoup(2, 1);
    soup.corners[5] = 0xffffffffu;
    const auto badIndex = ScalpMesh::make(soup);
    ASSERT_FALSE(badIndex);
    EXPECT_NE(badIndex.error().message().find("4294967295"), std::string::npos);
    soup = test::gridSoup(2, 1);
    soup.positions[3].y() = kNan;
    EXPECT_FALSE(ScalpMesh::make(soup));
    soup = test::gridSoup(2, 1);
    soup.positions[3].y() = 3e38f;
    EXPECT_FALSE(ScalpMesh::make(soup));
    soup = test::gridSoup(2, 1);
    soup.offsets[1] = 100;
    EXPECT_FALSE(ScalpMesh::make(soup));
    soup = test::gridSoup(2, 1);
    soup.uvs.pop_back();
    EXPECT_FALSE(ScalpMesh::make(soup));
    soup = test::gridSoup(2, 1);
    soup.faceGroups.assign(4, 9);
    EXPECT_FALSE(ScalpMesh::make(soup));
    soup = test::gridSoup(2, 1);
    soup.uvs[0].x() = kNan;
    soup.normals.assign(soup.corners.size(), Vec3f(kNan, 0, 0));
    const auto repaired = ScalpMesh::make(soup);
    ASSERT_TRUE(repaired);
    EXPECT_EQ(repairsOf(*repaired, "UVs that are not finite set to zero"), 2u);  // in both halves of the quad
    EXPECT_EQ(repairsOf(*repaired, "missing normals computed"), 9u);
}

TEST(ScalpMesh, AnyTangleOfIndicesBecomesManifoldOrIsRefused) {
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
        Random random(seed);
        PolygonSoup soup;
        const std::uint32_t vertices = 3 + random.below(12);
        for (std::uint32_t v = 0; v < vertices; ++v)
            soup.positions.emplace_back(std::floor(random.uniform(-2, 3)), std::floor(random.uniform(-2, 3)),
                                        std::floor(random.uniform(-2, 3)));
        const std::uint32_t faces = 1 + random.below(60);
        for (std::uint32_t f = 0; f < faces; ++f) {
            const std::uint32_t size = random.below(9);
            for (std::uint32_t c = 0; c < size; ++c) soup.corners.push_back(random.below(vertices));
            soup.offsets.push_back(static_cast<std::uint32_t>(soup.corners.size()));
        }
        const Result<ScalpMesh> mesh = ScalpMesh::make(soup);
        if (mesh) expectManifold(*mesh);
        if (HasFailure()) FAIL() << "seed " << seed;
    }
}

TEST(ScalpMesh, FaceOfAHundredThousandCorners) {
    PolygonSoup soup;
    constexpr std::uint32_t kCorners = 100'000;
    for (std::uint32_t i = 0; i < kCorners; ++i) {
        const float angle = 2 * kPi * static_cast<float>(i) / kCorners;
        const float r = i % 2 == 0 ? 100.0f : 60.0f;
        soup.positions.emplace_back(r * std::cos(angle), r * std::sin(angle), 0);
        soup.corners.push_back(i);
    }
    soup.offsets.push_back(kCorners);
    const ScalpMesh star = meshOf(soup);
    // Half the corners on each circle: the area of a star polygon, ½ n r R sin(2π/n).
    EXPECT_NEAR(totalArea(star), 100 * 60 * kPi, 0.001 * 100 * 60 * kPi);
    for (std::uint32_t& corner : soup.corners) corner = corner * 7919u % kCorners;
    EXPECT_TRUE(ScalpMesh::make(soup));  // crosses itself everywhere
}

}  // namespace
}  // namespace hairloom
