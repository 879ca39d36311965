// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry/root_triangulation.h"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <fmt/format.h>

#include <algorithm>

#include "core/geometry/flat_chart.h"

namespace hairloom {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
using Delaunay = CGAL::Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase>>;

struct FlatRoot {
    double u, v;
    std::uint32_t root;
    auto operator<=>(const FlatRoot&) const = default;
};

/// Whether a triangle of roots crosses the chart's border. Drawn in by a millionth, so that roots on the
/// border count as inside.
bool leavesChart(const SegmentGrid& border, const std::array<Vec2d, 3>& corners,
                 std::vector<std::uint32_t>& found) {
    const Vec2d middle = (corners[0] + corners[1] + corners[2]) / 3;
    std::array<Vec2d, 3> inner;
    constexpr double kDrawnIn = 1e-6;
    for (std::size_t i = 0; i < 3; ++i) inner[i] = corners[i] + kDrawnIn * (middle - corners[i]);
    const auto point = [](const Vec2d& p) { return Kernel::Point_2(p.x(), p.y()); };
    const Kernel::Triangle_2 triangle(point(inner[0]), point(inner[1]), point(inner[2]));
    if (triangle.is_degenerate()) return true;
    border.near(inner[0].cwiseMin(inner[1]).cwiseMin(inner[2]),
                inner[0].cwiseMax(inner[1]).cwiseMax(inner[2]), found);
    return std::any_of(found.begin(), found.end(), [&](std::uint32_t s) {
        const SegmentGrid::Segment& segment = border.segments()[s];
        return CGAL::do_intersect(triangle, Kernel::Segment_2(point(segment[0]), point(segment[1])));
    });
}

/// Smallest index first, so that the result does not depend on CGAL's order.
Triangle rotated(Triangle t) {
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    return t;
}

void triangulateChart(const ScalpMesh& mesh, const Chart& chart, std::vector<FlatRoot> roots,
                      RootTriangulation& result) {
    std::sort(roots.begin(), roots.end());
    Delaunay delaunay;
    Delaunay::Face_handle near;
    const FlatRoot* last = nullptr;
    for (const FlatRoot& root : roots) {
        if (last && last->u == root.u && last->v == root.v) {
            result.coincident.push_back({root.root, last->root});
            continue;
        }
        const auto vertex = delaunay.insert(Kernel::Point_2(root.u, root.v), near);
        vertex->info() = root.root;
        near = vertex->face();
        last = &root;
    }
    const SegmentGrid border(flatBorder(oppositeSides(mesh, chart.faces), chart.cornerUvs));
    std::vector<std::uint32_t> found;
    for (auto face = delaunay.finite_faces_begin(); face != delaunay.finite_faces_end(); ++face) {
        std::array<Vec2d, 3> corners;
        Triangle triangle{};
        for (std::size_t i = 0; i < 3; ++i) {
            const auto vertex = face->vertex(static_cast<int>(i));
            corners[i] = {vertex->point().x(), vertex->point().y()};
            triangle[i] = vertex->info();
        }
        if (!leavesChart(border, corners, found)) result.triangles.push_back(rotated(triangle));
    }
}

}  // namespace

Result<RootTriangulation> triangulateRoots(const ScalpMesh& mesh, const FaceSet& faces,
                                           std::span<const SurfacePoint> roots) {
    const Result<Parameterization> flat = parameterize(mesh, faces);
    if (!flat) return tl::unexpected(flat.error());
    struct FlatFace {
        std::uint32_t chart = ~0u, place = 0;
    };
    std::vector<FlatFace> flatFaces(mesh.triangleCount());
    for (std::uint32_t c = 0; c < flat->charts.size(); ++c)
        for (std::uint32_t f = 0; f < flat->charts[c].faces.size(); ++f)
            flatFaces[flat->charts[c].faces[f]] = {c, f};
    std::vector<std::vector<FlatRoot>> perChart(flat->charts.size());
    for (std::uint32_t r = 0; r < roots.size(); ++r) {
        const std::uint32_t triangle = roots[r].triangle;
        if (triangle >= flatFaces.size() || flatFaces[triangle].chart == ~0u)
            return fail(fmt::format("root {} lies on face {}", r, triangle), "a face of the scalp selection");
        const auto [chart, place] = flatFaces[triangle];
        const Vec3d weights = roots[r].barycentric.cast<double>();
        Vec2d uv = Vec2d::Zero();
        for (std::size_t i = 0; i < 3; ++i)
            uv += weights[static_cast<int>(i)] * flat->charts[chart].cornerUvs[3 * std::size_t{place} + i];
        if (!uv.allFinite())
            return fail(fmt::format("root {} has no finite place", r), "finite barycentrics");
        perChart[chart].push_back({uv.x(), uv.y(), r});
    }
    RootTriangulation result;
    for (std::size_t c = 0; c < perChart.size(); ++c)
        triangulateChart(mesh, flat->charts[c], std::move(perChart[c]), result);
    if (result.triangles.empty())
        return fail("no three roots of one part of the scalp make a triangle",
                    "more roots, or roots not on a line");
    std::sort(result.triangles.begin(), result.triangles.end());
    std::vector<bool> used(roots.size(), false);
    for (const Triangle& t : result.triangles)
        for (const std::uint32_t root : t) used[root] = true;
    for (const RootTriangulation::Coincident& c : result.coincident) used[c.root] = true;
    for (std::uint32_t r = 0; r < used.size(); ++r)
        if (!used[r]) result.alone.push_back(r);
    return result;
}

}  // namespace hairloom
