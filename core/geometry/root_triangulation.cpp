// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry/root_triangulation.h"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "core/geometry/chart_border.h"

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

/// A triangle that cuts off a bend of the border may reach over it by this share of the side that cuts it.
constexpr double kDeepestBend = 0.5;

/// Roots at hand round one that is to be joined.
constexpr std::size_t kNeighbourhood = 128;

/// Smallest index first, so that the result does not depend on CGAL's order.
Triangle rotated(Triangle t) {
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    return t;
}

/// The triangles of one chart, added to those of the others.
class ChartTriangulation {
  public:
    ChartTriangulation(const ScalpMesh& mesh, const Chart& chart, std::vector<bool>& used,
                       RootTriangulation& result)
        : border_(mesh, chart), used_(used), result_(result) {}

    void run(std::vector<FlatRoot> roots) {
        insert(std::move(roots));
        keepInner();
        keepBends();
        keepBehindGaps();
    }

  private:
    void insert(std::vector<FlatRoot> roots) {
        std::sort(roots.begin(), roots.end());
        Delaunay::Face_handle near;
        const FlatRoot* last = nullptr;
        for (const FlatRoot& root : roots) {
            if (last && last->u == root.u && last->v == root.v) {
                result_.coincident.push_back({root.root, last->root});
                continue;
            }
            const auto vertex = delaunay_.insert(Kernel::Point_2(root.u, root.v), near);
            vertex->info() = root.root;
            near = vertex->face();
            last = &root;
        }
    }

    /// Triangles inside the chart.
    void keepInner() {
        for (const Delaunay::Face_handle face : delaunay_.finite_face_handles()) {
            const double overhang = border_.overhang(cornersOf(face));
            if (overhang == 0) {
                keep(triangleOf(face));
            } else if (overhang <= kDeepestBend) {
                overhanging_.emplace_back(overhang, triangleOf(face));
            }
        }
    }

    /// Triangles that cut off a bend, where a root has no other.
    void keepBends() {
        std::sort(overhanging_.begin(), overhanging_.end());
        for (const auto& [overhang, triangle] : overhanging_)
            if (std::any_of(triangle.begin(), triangle.end(), [&](std::uint32_t r) { return !used_[r]; }))
                keep(triangle);
    }

    /// Where all Delaunay triangles of a root bridge a gap, it gets the smallest of those between it and the
    /// roots that it sees.
    void keepBehindGaps() {
        for (const Delaunay::Vertex_handle vertex : delaunay_.finite_vertex_handles()) {
            if (used_[vertex->info()]) continue;
            Delaunay seen;
            for (const Delaunay::Vertex_handle other : neighbourhood(vertex)) {
                if (other == vertex || border_.sees(placeOf(vertex), placeOf(other)))
                    seen.insert(other->point())->info() = other->info();
            }
            std::optional<std::pair<double, Triangle>> smallest;
            for (const Delaunay::Face_handle face : seen.finite_face_handles()) {
                const std::pair candidate(longestSide(cornersOf(face)), triangleOf(face));
                if (!has(candidate.second, vertex->info()) || (smallest && *smallest <= candidate)) continue;
                if (border_.overhang(cornersOf(face)) == 0) smallest = candidate;
            }
            if (smallest) keep(smallest->second);
        }
    }

    std::vector<Delaunay::Vertex_handle> neighbourhood(Delaunay::Vertex_handle vertex) const {
        std::vector<Delaunay::Vertex_handle> found{vertex};
        for (std::size_t next = 0; next < found.size() && found.size() < kNeighbourhood; ++next) {
            const auto around = delaunay_.incident_vertices(found[next]);
            if (around == nullptr) continue;  // the only root
            auto other = around;
            do {
                const bool known = std::find(found.begin(), found.end(), other) != found.end();
                if (!known && !delaunay_.is_infinite(other)) found.push_back(other);
            } while (++other != around);
        }
        return found;
    }

    static double longestSide(const ChartBorder::Corners& c) {
        return std::max({(c[1] - c[0]).norm(), (c[2] - c[1]).norm(), (c[0] - c[2]).norm()});
    }

    static bool has(const Triangle& triangle, std::uint32_t root) {
        return std::find(triangle.begin(), triangle.end(), root) != triangle.end();
    }

    void keep(const Triangle& triangle) {
        result_.triangles.push_back(triangle);
        for (const std::uint32_t root : triangle) used_[root] = true;
    }

    static Vec2d placeOf(Delaunay::Vertex_handle vertex) {
        return {vertex->point().x(), vertex->point().y()};
    }

    static ChartBorder::Corners cornersOf(Delaunay::Face_handle face) {
        return {placeOf(face->vertex(0)), placeOf(face->vertex(1)), placeOf(face->vertex(2))};
    }

    static Triangle triangleOf(Delaunay::Face_handle face) {
        return rotated({face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
    }

    ChartBorder border_;
    Delaunay delaunay_;
    std::vector<std::pair<double, Triangle>> overhanging_;
    std::vector<bool>& used_;
    RootTriangulation& result_;
};

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
            return fail(fmt::format("root {} has no finite position", r), "finite barycentrics");
        perChart[chart].push_back({uv.x(), uv.y(), r});
    }
    RootTriangulation result;
    std::vector<bool> used(roots.size(), false);
    for (std::size_t c = 0; c < perChart.size(); ++c)
        ChartTriangulation(mesh, flat->charts[c], used, result).run(std::move(perChart[c]));
    std::sort(result.triangles.begin(), result.triangles.end());
    for (const RootTriangulation::Coincident& c : result.coincident) used[c.root] = true;
    for (std::uint32_t r = 0; r < used.size(); ++r)
        if (!used[r]) result.alone.push_back(r);
    return result;
}

}  // namespace hairloom
