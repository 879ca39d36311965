// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_2_algorithms.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <exception>

#include "core/geometry/mesh_repair.h"

namespace hairloom {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
using FaceBase =
    CGAL::Constrained_triangulation_face_base_2<Kernel,
                                                CGAL::Triangulation_face_base_with_info_2<int, Kernel>>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Constrained =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure, CGAL::No_constraint_intersection_tag>;

/// Newell's normal: twice the area vector, in double.
Vec3d areaVector(std::span<const Vec3f> points) {
    Vec3d sum = Vec3d::Zero();
    const Vec3d origin = points[0].cast<double>();
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3d a = points[i].cast<double>() - origin;
        const Vec3d b = points[(i + 1) % points.size()].cast<double>() - origin;
        sum += a.cross(b);
    }
    return sum;
}

double signedArea(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

std::vector<Vec2d> projectAlong(std::span<const Vec3f> points, const Vec3d& normal) {
    const Vec3d unit = normal.normalized();
    const Vec3d axisX = unit.unitOrthogonal();
    const Vec3d axisY = unit.cross(axisX);
    const Vec3d origin = points[0].cast<double>();
    std::vector<Vec2d> flat;
    flat.reserve(points.size());
    for (const Vec3f& point : points) {
        const Vec3d offset = point.cast<double>() - origin;
        flat.emplace_back(offset.dot(axisX), offset.dot(axisY));
    }
    return flat;
}

std::vector<Triangle> fan(std::size_t count) {
    std::vector<Triangle> triangles;
    triangles.reserve(count - 2);
    for (std::uint32_t i = 1; i + 1 < count; ++i) triangles.push_back({0, i, i + 1});
    return triangles;
}

/// The shorter of the two diagonals that lies inside.
std::vector<Triangle> cutQuad(std::span<const Vec3f> points, const std::vector<Vec2d>& flat, bool& crossing) {
    const bool firstInside =
        signedArea(flat[0], flat[1], flat[2]) > 0 && signedArea(flat[0], flat[2], flat[3]) > 0;
    const bool secondInside =
        signedArea(flat[0], flat[1], flat[3]) > 0 && signedArea(flat[1], flat[2], flat[3]) > 0;
    crossing = !firstInside && !secondInside;
    const bool firstShorter = (points[0] - points[2]).squaredNorm() <= (points[1] - points[3]).squaredNorm();
    if (secondInside && (!firstInside || !firstShorter)) return {{0, 1, 3}, {1, 2, 3}};
    return {{0, 1, 2}, {0, 2, 3}};
}

/// The faces that an odd number of constraints part from the outside, for a triangulation of one simple
/// outline.
void markInside(Constrained& cut) {
    std::vector<Constrained::Face_handle> stack{cut.infinite_face()};
    for (auto face = cut.all_faces_begin(); face != cut.all_faces_end(); ++face) face->info() = -1;
    cut.infinite_face()->info() = 0;
    while (!stack.empty()) {
        const Constrained::Face_handle face = stack.back();
        stack.pop_back();
        for (int side = 0; side < 3; ++side) {
            const Constrained::Face_handle next = face->neighbor(side);
            if (next->info() != -1) continue;
            next->info() = face->is_constrained(side) ? 1 - face->info() : face->info();
            stack.push_back(next);
        }
    }
}

std::vector<Triangle> cutOutline(const std::vector<Vec2d>& flat) {
    Constrained cut;
    std::vector<Constrained::Vertex_handle> handles;
    handles.reserve(flat.size());
    Constrained::Face_handle near;
    for (std::uint32_t i = 0; i < flat.size(); ++i) {
        const auto vertex = cut.insert(Kernel::Point_2(flat[i].x(), flat[i].y()), near);
        vertex->info() = i;
        near = vertex->face();
        handles.push_back(vertex);
    }
    for (std::size_t i = 0; i < handles.size(); ++i)
        cut.insert_constraint(handles[i], handles[(i + 1) % handles.size()]);
    if (cut.dimension() < 2) return {};
    markInside(cut);
    std::vector<Triangle> triangles;
    triangles.reserve(flat.size() - 2);
    for (auto face = cut.finite_faces_begin(); face != cut.finite_faces_end(); ++face)
        if (face->info() == 1)
            triangles.push_back({face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
    return triangles;
}

bool isSimple(const std::vector<Vec2d>& flat) {
    std::vector<Kernel::Point_2> outline;
    outline.reserve(flat.size());
    for (const Vec2d& point : flat) outline.emplace_back(point.x(), point.y());
    return CGAL::is_simple_2(outline.begin(), outline.end(), Kernel());
}

}  // namespace

bool isDegenerate(const Vec3f& a, const Vec3f& b, const Vec3f& c) {
    constexpr double kThinnest = 1e-10;  // height over longest side, squared below
    const Vec3d ab = b.cast<double>() - a.cast<double>();
    const Vec3d ac = c.cast<double>() - a.cast<double>();
    const double longest = std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()});
    return !(ab.cross(ac).norm() > kThinnest * longest);
}

std::vector<Triangle> triangulatePolygon(std::span<const Vec3f> points, bool& crossing) {
    crossing = false;
    if (points.size() == 3) return {{0, 1, 2}};
    const Vec3d normal = areaVector(points);
    if (!(normal.norm() > 0)) {
        crossing = true;
        return fan(points.size());
    }
    const std::vector<Vec2d> flat = projectAlong(points, normal);
    if (points.size() == 4) return cutQuad(points, flat, crossing);
    try {
        if (isSimple(flat)) {
            std::vector<Triangle> triangles = cutOutline(flat);
            if (triangles.size() == points.size() - 2) return triangles;
        }
    } catch (const std::exception&) {  // CGAL reports a constraint crossing this way
    }
    crossing = true;
    return fan(points.size());
}

}  // namespace hairloom
