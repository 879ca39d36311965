// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/base/random.h"
#include "core/geometry/closest_point.h"
#include "core/geometry/parameterization.h"
#include "core/geometry/placement.h"
#include "core/geometry/root_triangulation.h"
#include "core/geometry/selection.h"
#include "tests/geometry/test_meshes.h"

namespace hairloom {
namespace {

double cross(const Vec2d& a, const Vec2d& b) {
    return a.x() * b.y() - a.y() * b.x();
}

bool contains(const std::array<Vec2d, 3>& t, const Vec2d& p, double slack) {
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec2d side = t[(i + 1) % 3] - t[i];
        if (cross(side, p - t[i]) < -slack * side.norm()) return false;
    }
    return true;
}

std::array<Vec2d, 3> flatFace(const Chart& chart, std::size_t face) {
    return {chart.cornerUvs[3 * face], chart.cornerUvs[3 * face + 1], chart.cornerUvs[3 * face + 2]};
}

/// Every face of the selection lies in one chart, turned the right way; random points of the flat image lie
/// in one face only.
void expectGoodCharts(const ScalpMesh& mesh, const FaceSet& faces, const Parameterization& flat) {
    FaceSet seen;
    Random random(1);
    double area = 0;
    for (const Chart& chart : flat.charts) {
        ASSERT_EQ(chart.cornerUvs.size(), 3 * chart.faces.size());
        seen.insert(seen.end(), chart.faces.begin(), chart.faces.end());
        double chartArea = 0;
        for (std::size_t f = 0; f < chart.faces.size(); ++f) {
            const auto t = flatFace(chart, f);
            EXPECT_GT(cross(t[1] - t[0], t[2] - t[0]), 0);
            chartArea += cross(t[1] - t[0], t[2] - t[0]) / 2;
        }
        EXPECT_NEAR(chartArea / selectionArea(mesh, chart.faces), 1, 1e-3);
        area += chartArea;
        for (int i = 0; i < 300; ++i) {
            const auto own = random.below(static_cast<std::uint32_t>(chart.faces.size()));
            const auto t = flatFace(chart, own);
            const Vec2d middle = (t[0] + t[1] + t[2]) / 3;
            for (std::size_t f = 0; f < chart.faces.size(); ++f)
                EXPECT_TRUE(f == own || !contains(flatFace(chart, f), middle, -1e-12)) << "faces overlap";
        }
    }
    std::sort(seen.begin(), seen.end());
    EXPECT_EQ(seen, faces);
}

struct Flattened {
    std::uint32_t chart;
    Vec2d uv;
};

std::vector<Flattened> flatten(const Parameterization& flat, const std::vector<SurfacePoint>& roots) {
    std::vector<Flattened> result;
    for (const SurfacePoint& root : roots)
        for (std::uint32_t c = 0; c < flat.charts.size(); ++c) {
            const FaceSet& faces = flat.charts[c].faces;
            const auto place = std::lower_bound(faces.begin(), faces.end(), root.triangle);
            if (place == faces.end() || *place != root.triangle) continue;
            const auto t = flatFace(flat.charts[c], static_cast<std::size_t>(place - faces.begin()));
            const Vec3d w = root.barycentric.cast<double>();
            result.push_back({c, w[0] * t[0] + w[1] * t[1] + w[2] * t[2]});
        }
    return result;
}

/// Positive when p lies inside the circle through the counter-clockwise a, b, c; relative to their size.
double inCircle(const Vec2d& a, const Vec2d& b, const Vec2d& c, const Vec2d& p) {
    Eigen::Matrix3d m;
    const double scale = std::max({(a - b).norm(), (b - c).norm(), (c - a).norm()});
    int row = 0;
    for (const Vec2d& q : {a, b, c}) {
        const Vec2d d = (q - p) / scale;
        m.row(row++) << d.x(), d.y(), d.squaredNorm();
    }
    return m.determinant();
}

/// The flat image of one chart and its border, the sides that no other face has.
class FlatImage {
  public:
    explicit FlatImage(const Chart& chart) : chart_(chart) {
        const auto key = [](const Vec2d& a, const Vec2d& b) {
            return std::array<double, 4>{a.x(), a.y(), b.x(), b.y()};
        };
        std::set<std::array<double, 4>> sides;
        for (std::size_t f = 0; f < chart.faces.size(); ++f) {
            const auto t = flatFace(chart, f);
            for (std::size_t i = 0; i < 3; ++i) sides.insert(key(t[i], t[(i + 1) % 3]));
        }
        for (const auto& [ax, ay, bx, by] : sides)
            if (!sides.contains({bx, by, ax, ay})) border_.push_back({Vec2d(ax, ay), Vec2d(bx, by)});
    }
    bool holds(const Vec2d& p) const {
        for (std::size_t f = 0; f < chart_.faces.size(); ++f)
            if (contains(flatFace(chart_, f), p, 1e-6)) return true;
        return false;
    }
    /// Whether no part of the border lies between two points of the chart.
    bool sees(const Vec2d& a, const Vec2d& b) const {
        return std::none_of(border_.begin(), border_.end(), [&](const std::array<Vec2d, 2>& s) {
            const double here = cross(b - a, s[0] - a), there = cross(b - a, s[1] - a);
            const double from = cross(s[1] - s[0], a - s[0]), to = cross(s[1] - s[0], b - s[0]);
            return here * there <= 0 && from * to < 0;
        });
    }

  private:
    const Chart& chart_;
    std::vector<std::array<Vec2d, 2>> border_;
};

double lineDistance(const Vec2d& a, const Vec2d& b, const Vec2d& p) {
    return std::abs(cross((b - a).normalized(), p - a));
}

/// Each root is a corner of a triangle. Triangles lie inside their chart; one may cut off a bend of the
/// border where a corner has no other. Their circles hold no root that all corners see.
void expectGoodTriangles(const ScalpMesh& mesh, const FaceSet& faces,
                         const std::vector<SurfacePoint>& roots) {
    const Result<Parameterization> flat = parameterize(mesh, faces);
    ASSERT_TRUE(flat);
    expectGoodCharts(mesh, faces, *flat);
    const Result<RootTriangulation> result = triangulateRoots(mesh, faces, roots);
    ASSERT_TRUE(result);
    const std::vector<Flattened> places = flatten(*flat, roots);
    ASSERT_EQ(places.size(), roots.size());
    EXPECT_TRUE(result->alone.empty()) << result->alone.size() << " of " << roots.size();
    std::vector<bool> used(roots.size(), false), inner(roots.size(), false);
    for (const auto& c : result->coincident) used[c.root] = true;
    std::vector<Triangle> cutting;
    std::vector<FlatImage> images(flat->charts.begin(), flat->charts.end());
    Random random(2);
    for (const Triangle& t : result->triangles) {
        const std::uint32_t chart = places[t[0]].chart;
        ASSERT_TRUE(places[t[1]].chart == chart && places[t[2]].chart == chart) << "joins two charts";
        const FlatImage& image = images[chart];
        const Vec2d a = places[t[0]].uv, b = places[t[1]].uv, c = places[t[2]].uv;
        EXPECT_GT(cross(b - a, c - a), 0);
        for (std::size_t r = 0; r < places.size(); ++r) {
            const bool corner = r == t[0] || r == t[1] || r == t[2];
            if (corner || places[r].chart != chart || inCircle(a, b, c, places[r].uv) < 1e-9) continue;
            const Vec2d& other = places[r].uv;
            EXPECT_FALSE(image.sees(a, other) && image.sees(b, other) && image.sees(c, other));
        }
        // Points of the sides and of the inside.
        bool inside = true;
        for (int i = 0; i < 8; ++i) {
            Vec3d w(random.uniformDouble(), random.uniformDouble(), random.uniformDouble());
            if (i < 6) w[i % 3] = 0;
            w /= w.sum();
            const Vec2d p = w[0] * a + w[1] * b + w[2] * c;
            if (image.holds(p)) continue;
            inside = false;
            const double longest = std::max({(a - b).norm(), (b - c).norm(), (c - a).norm()});
            EXPECT_LT(std::min({lineDistance(a, b, p), lineDistance(b, c, p), lineDistance(c, a, p)}),
                      0.5 * longest);
        }
        for (const std::uint32_t root : t) {
            used[root] = true;
            if (inside) inner[root] = true;
        }
        if (!inside) cutting.push_back(t);
    }
    for (const Triangle& t : cutting)
        EXPECT_FALSE(inner[t[0]] && inner[t[1]] && inner[t[2]]) << "leaves the selection for no root";
    EXPECT_EQ(std::count(used.begin(), used.end(), false), 0);
}

std::vector<SurfacePoint> darts(const ScalpMesh& mesh, const FaceSet& faces, std::size_t count) {
    PlacementRequest request;
    request.count = count;
    request.seed = 4;
    const Result<Placement> placement = placeDarts(mesh, faces, request);
    EXPECT_TRUE(placement);
    return placement ? placement->roots : std::vector<SurfacePoint>{};
}

PolygonSoup withoutUvs(PolygonSoup soup) {
    soup.uvs.clear();
    return soup;
}

TEST(Triangulation, FlatGridKeepsItsShape) {
    const ScalpMesh mesh = test::meshOf(withoutUvs(test::gridSoup(8, 1)));
    const FaceSet faces = test::allFaces(mesh);
    const Result<Parameterization> flat = parameterize(mesh, faces);
    ASSERT_TRUE(flat);
    ASSERT_EQ(flat->charts.size(), 1u);
    EXPECT_NEAR(flat->charts[0].stretch, 1, 1e-4);
    expectGoodTriangles(mesh, faces, darts(mesh, faces, 300));
}

TEST(Triangulation, GoodUvsServeAndFoldedOnesDoNot) {
    PolygonSoup soup = test::gridSoup(6, 1);
    for (Vec2f& uv : soup.uvs) uv.y() *= 1.5f;
    const ScalpMesh good = test::meshOf(soup);
    EXPECT_NEAR(parameterize(good, test::allFaces(good))->charts[0].stretch, 1.5, 1e-3);
    for (Vec2f& uv : soup.uvs) uv.x() = -uv.x();  // mirrored UVs are as good
    const ScalpMesh mirrored = test::meshOf(soup);
    EXPECT_NEAR(parameterize(mirrored, test::allFaces(mirrored))->charts[0].stretch, 1.5, 1e-3);
    expectGoodTriangles(mirrored, test::allFaces(mirrored), darts(mirrored, test::allFaces(mirrored), 200));
    for (Vec2f& uv : soup.uvs) uv.x() = std::abs(uv.x() + 0.5f);
    const ScalpMesh folded = test::meshOf(soup);
    EXPECT_NEAR(parameterize(folded, test::allFaces(folded))->charts[0].stretch, 1, 1e-3);
    for (std::size_t i = 0; i < soup.uvs.size(); ++i) soup.uvs[i] = Vec2f(0.1f, 0.2f);
    const ScalpMesh collapsed = test::meshOf(soup);
    expectGoodCharts(collapsed, test::allFaces(collapsed),
                     *parameterize(collapsed, test::allFaces(collapsed)));
}

TEST(Triangulation, OverlappingUvsAreNotTaken) {
    // A band that winds one and a half times round in its UVs: every face is turned the right way, but it
    // overlaps.
    PolygonSoup soup;
    constexpr std::uint32_t kSteps = 30;
    const auto uvAt = [](std::uint32_t i, float r) {
        const float angle = 3 * kPi * static_cast<float>(i) / kSteps;
        return Vec2f(r * std::cos(angle), r * std::sin(angle));
    };
    for (std::uint32_t i = 0; i <= kSteps; ++i)
        for (const float r : {0.0f, 1.0f}) soup.positions.emplace_back(r, 0, 0.47f * static_cast<float>(i));
    for (std::uint32_t i = 0; i < kSteps; ++i) {
        test::addFace(soup, {2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1});
        for (const Vec2f& uv : {uvAt(i, 4), uvAt(i + 1, 4), uvAt(i + 1, 5), uvAt(i, 5)})
            soup.uvs.push_back(uv);
    }
    const ScalpMesh mesh = test::meshOf(soup);
    expectGoodCharts(mesh, test::allFaces(mesh), *parameterize(mesh, test::allFaces(mesh)));
}

TEST(Triangulation, HoleIsNotBridged) {
    const auto aroundHole = [](std::uint32_t x, std::uint32_t y) { return x < 3 || x > 6 || y < 3 || y > 6; };
    const PolygonSoup soup = test::gridSoup(10, 1, aroundHole);
    for (const PolygonSoup& variant : {soup, withoutUvs(soup)}) {
        const ScalpMesh mesh = test::meshOf(variant);
        expectGoodTriangles(mesh, test::allFaces(mesh), darts(mesh, test::allFaces(mesh), 400));
    }
}

TEST(Triangulation, RingsPiecesAndClosedSurfaces) {
    PolygonSoup two = test::icosphereSoup(2, 0.3f);
    test::append(two, test::gridSoup(4, 0.5f), {0, 1, 0});
    for (const PolygonSoup& soup : {test::ringSoup(40, 0.5f, 1), test::ringSoup(40, 0.5f, 1, 7), two,
                                    test::icosphereSoup(3, 1), test::torusSoup(24, 12, 1, 0.4f)}) {
        const ScalpMesh mesh = test::meshOf(soup);
        const FaceSet faces = test::allFaces(mesh);
        expectGoodTriangles(mesh, faces, darts(mesh, faces, 500));
        PlacementRequest request;
        request.count = 500;
        request.seed = 4;
        expectGoodTriangles(mesh, faces, placeRandom(mesh, faces, request)->roots);
    }
}

TEST(Triangulation, OneBendOfTheBorderMayBeCutOffAndNoGapBridged) {
    // A square without its middle third of the lower half: an arch.
    const auto arch = [](std::uint32_t x, std::uint32_t y) { return x < 2 || x > 3 || y > 2; };
    const ScalpMesh mesh = test::meshOf(test::gridSoup(6, 6, arch));
    const FaceSet faces = test::allFaces(mesh);
    const SurfaceTree tree(mesh, faces);
    const auto rootsAt = [&](std::initializer_list<Vec2f> places) {
        std::vector<SurfacePoint> roots;
        for (const Vec2f& p : places) roots.push_back(tree.closest(Vec3f(p.x(), 0, p.y())).surface);
        return roots;
    };
    // The corner of the gap at (−1, 0) reaches between the first two.
    const std::vector<SurfacePoint> corner = rootsAt({{-1.1f, -0.6f}, {-0.4f, 0.1f}, {-1.6f, 0.6f}});
    expectGoodTriangles(mesh, faces, corner);
    EXPECT_EQ(triangulateRoots(mesh, faces, corner)->triangles.size(), 1u);
    // Two at the ends of the legs have the gap between them whatever their third.
    const std::vector<SurfacePoint> legs = rootsAt({{-1.5f, -2.5f}, {1.5f, -2.5f}, {0, 2.5f}});
    EXPECT_EQ(triangulateRoots(mesh, faces, legs)->alone, (std::vector<std::uint32_t>{0, 1, 2}));
    const std::vector<SurfacePoint> more =
        rootsAt({{-1.5f, -2.5f}, {1.5f, -2.5f}, {-2, 2.5f}, {2, 2.5f}, {-2.5f, 2}, {2.5f, 2.2f}});
    const Result<RootTriangulation> result = triangulateRoots(mesh, faces, more);
    ASSERT_TRUE(result);
    for (const Triangle& t : result->triangles) EXPECT_FALSE(t[0] == 0 && t[1] == 1);
}

TEST(Triangulation, CapOfASphereIsNearlyConformal) {
    const ScalpMesh mesh = test::meshOf(test::icosphereSoup(4, 0.1f));
    const FaceSet faces = *selectFaces(mesh, "cap:85");
    const Result<Parameterization> flat = parameterize(mesh, faces);
    ASSERT_EQ(flat->charts.size(), 1u);
    EXPECT_LT(flat->charts[0].stretch, 1.1);
    expectGoodTriangles(mesh, faces, darts(mesh, faces, 400));
}

TEST(Triangulation, SpikyTerrainStaysFreeOfFolds) {
    PolygonSoup soup = withoutUvs(test::gridSoup(12, 1));
    Random random(8);
    for (Vec3f& p : soup.positions) p.y() = random.uniform(0, 0.6f);
    const ScalpMesh mesh = test::meshOf(soup);
    expectGoodCharts(mesh, test::allFaces(mesh), *parameterize(mesh, test::allFaces(mesh)));
}

TEST(Triangulation, RootsThatMakeNoTriangleStandAlone) {
    const ScalpMesh mesh = test::meshOf(test::gridSoup(2, 1));
    const FaceSet faces = test::allFaces(mesh);
    std::vector<SurfacePoint> line;
    for (const float along : {0.1f, 0.4f, 0.8f}) line.push_back({0, Vec3f(1 - along, along, 0)});
    for (const std::size_t count : {0u, 1u, 2u, 3u}) {
        const Result<RootTriangulation> result = triangulateRoots(mesh, faces, std::span(line).first(count));
        ASSERT_TRUE(result) << result.error().message();
        EXPECT_TRUE(result->triangles.empty());
        EXPECT_EQ(result->alone.size(), count);
    }
}

TEST(Triangulation, CoincidentRootsAreListedAndStrangersRefused) {
    const ScalpMesh mesh = test::meshOf(test::gridSoup(2, 1));
    FaceSet faces = test::allFaces(mesh);
    std::vector<SurfacePoint> roots;
    for (const std::uint32_t f : {0u, 3u, 6u, 7u}) roots.push_back({f, Vec3f(0.2f, 0.3f, 0.5f)});
    roots.push_back(roots[1]);
    const Result<RootTriangulation> result = triangulateRoots(mesh, faces, roots);
    ASSERT_TRUE(result);
    ASSERT_EQ(result->coincident.size(), 1u);
    EXPECT_EQ(result->coincident[0].root, 4u);
    EXPECT_EQ(result->coincident[0].sameAs, 1u);
    EXPECT_EQ(result->triangles.size(), 2u);
    EXPECT_FALSE(triangulateRoots(mesh, {}, roots));
    faces.pop_back();
    EXPECT_FALSE(triangulateRoots(mesh, faces, roots));
    roots[0].triangle = 99;
    EXPECT_FALSE(triangulateRoots(mesh, faces, roots));
}

}  // namespace
}  // namespace hairloom
