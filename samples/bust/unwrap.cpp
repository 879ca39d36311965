// SPDX-License-Identifier: GPL-3.0-or-later
#include "samples/bust/unwrap.h"

#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_parameterization/ARAP_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/parameterize.h>

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>

namespace hairloom::bust {
namespace {

namespace parameterization = CGAL::Surface_mesh_parameterization;
using Kernel = CGAL::Simple_cartesian<double>;
using Chart = CGAL::Surface_mesh<Kernel::Point_3>;

constexpr double kGap = 0.004;  ///< between charts, in metres on the surface

/// Number of the connected piece of one patch, for each triangle.
std::vector<int> pieces(const PatchMesh& mesh, int& count) {
    std::vector<int> parent(mesh.triangles.size());
    std::iota(parent.begin(), parent.end(), 0);
    const auto find = [&](int t) {
        while (parent[t] != t) t = parent[t] = parent[parent[t]];
        return t;
    };
    std::map<std::pair<int, int>, int> firstAtEdge;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (int k = 0; k < 3; ++k) {
            const auto ends = std::minmax(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]);
            const auto [entry, fresh] =
                firstAtEdge.try_emplace({ends.first, ends.second}, static_cast<int>(t));
            if (fresh || mesh.patches[entry->second] != mesh.patches[t]) continue;
            parent[find(static_cast<int>(t))] = find(entry->second);
        }
    }
    std::map<int, int> numbers;
    std::vector<int> result(parent.size());
    for (std::size_t t = 0; t < parent.size(); ++t) {
        result[t] =
            numbers.try_emplace(find(static_cast<int>(t)), static_cast<int>(numbers.size())).first->second;
    }
    count = static_cast<int>(numbers.size());
    return result;
}

double twiceArea(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
    const Vec2d u = b - a;
    const Vec2d v = c - a;
    return u.x() * v.y() - u.y() * v.x();
}

/// Flattens a disc; metres in the plane, as large as on the surface.
Result<std::vector<Vec2d>> flatten(const std::vector<Vec3d>& positions,
                                   const std::vector<std::array<int, 3>>& triangles) {
    Chart chart;
    for (const Vec3d& p : positions) chart.add_vertex({p.x(), p.y(), p.z()});
    using Index = Chart::Vertex_index;
    for (const auto& t : triangles) {
        chart.add_face(Index(static_cast<unsigned>(t[0])), Index(static_cast<unsigned>(t[1])),
                       Index(static_cast<unsigned>(t[2])));
    }
    if (CGAL::vertices(chart).size() + CGAL::faces(chart).size() != CGAL::edges(chart).size() + 1) {
        return fail("a chart is no disc", "pieces without holes");
    }
    const auto border = CGAL::Polygon_mesh_processing::longest_border(chart).first;
    const auto uv = chart.add_property_map<Index, Kernel::Point_2>("v:uv").first;
    using Parameterizer = parameterization::ARAP_parameterizer_3<Chart>;
    const auto error = parameterization::parameterize(chart, Parameterizer(), border, uv);
    if (error != parameterization::OK) {
        return fail(
            fmt::format("a chart cannot be flattened: {}", parameterization::get_error_message(error)));
    }
    std::vector<Vec2d> flat;
    for (const auto v : chart.vertices()) flat.emplace_back(uv[v].x(), uv[v].y());
    double solid = 0.0;
    double plane = 0.0;
    for (const auto& t : triangles) {
        const double area = twiceArea(flat[t[0]], flat[t[1]], flat[t[2]]);
        if (area <= 0.0) return fail("a chart folds over");
        plane += area;
        solid += (positions[t[1]] - positions[t[0]]).cross(positions[t[2]] - positions[t[0]]).norm();
    }
    for (Vec2d& q : flat) q *= std::sqrt(solid / plane);
    return flat;
}

/// Turns a chart so that its box is lowest, and moves it to the origin. Returns the size of the box.
Vec2d settle(std::vector<Vec2d>& flat) {
    const auto boxAt = [&](double angle) {
        Eigen::AlignedBox2d box;
        for (const Vec2d& q : flat) box.extend(Eigen::Rotation2Dd(angle) * q);
        return box;
    };
    double best = 0.0;
    for (int step = 1; step < 90; ++step) {
        const double angle = step * 3.14159265358979 / 90.0;
        if (boxAt(angle).sizes().y() < boxAt(best).sizes().y()) best = angle;
    }
    const auto box = boxAt(best);
    for (Vec2d& q : flat) q = Eigen::Rotation2Dd(best) * q - box.min();
    return box.sizes();
}

/// Shelves of charts, the tallest first, in a strip of the given width. Returns the height.
double shelve(const std::vector<Vec2d>& sizes, double width, std::vector<Vec2d>& places) {
    std::vector<int> order(sizes.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return sizes[a].y() > sizes[b].y(); });
    places.resize(sizes.size());
    Vec2d pen(kGap, kGap);
    double top = 0.0;
    for (const int i : order) {
        if (pen.x() + sizes[i].x() + kGap > width && pen.x() > kGap) pen = {kGap, top};
        places[i] = pen;
        pen.x() += sizes[i].x() + kGap;
        top = std::max(top, pen.y() + sizes[i].y() + kGap);
    }
    return top;
}

void pack(std::vector<std::vector<Vec2d>>& charts) {
    std::vector<Vec2d> sizes;
    double widest = 0.0;
    for (auto& chart : charts) {
        sizes.push_back(settle(chart));
        widest = std::max(widest, sizes.back().x() + 2 * kGap);
    }
    std::vector<Vec2d> places;
    double side = 1e9;
    double bestWidth = widest;
    for (int step = 0; step <= 200; ++step) {
        const double width = widest * (1.0 + 0.01 * step);
        const double needed = std::max(width, shelve(sizes, width, places));
        if (needed < side) {
            side = needed;
            bestWidth = width;
        }
    }
    shelve(sizes, bestWidth, places);
    for (std::size_t i = 0; i < charts.size(); ++i) {
        for (Vec2d& q : charts[i]) q = (q + places[i]) / side;
    }
}

}  // namespace

Result<UnwrappedMesh> unwrap(const PatchMesh& mesh) {
    UnwrappedMesh result;
    const std::vector<int> piece = pieces(mesh, result.charts);
    std::vector<std::vector<Vec2d>> charts;
    for (int chart = 0; chart < result.charts; ++chart) {
        const int first = static_cast<int>(result.original.size());
        std::map<int, int> local;
        std::vector<std::array<int, 3>> triangles;
        std::vector<Vec3d> positions;
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            if (piece[t] != chart) continue;
            std::array<int, 3> corners{};
            for (int k = 0; k < 3; ++k) {
                const int v = mesh.triangles[t][k];
                const auto [entry, fresh] = local.try_emplace(v, static_cast<int>(positions.size()));
                corners[k] = entry->second;
                if (!fresh) continue;
                positions.push_back(mesh.positions[v]);
                result.original.push_back(v);
            }
            triangles.push_back(corners);
            result.mesh.triangles.push_back({first + corners[0], first + corners[1], first + corners[2]});
            result.mesh.patches.push_back(mesh.patches[t]);
        }
        auto flat = flatten(positions, triangles);
        if (!flat) return tl::unexpected(flat.error());
        result.mesh.positions.insert(result.mesh.positions.end(), positions.begin(), positions.end());
        charts.push_back(std::move(*flat));
    }
    pack(charts);
    for (const auto& chart : charts) result.uv.insert(result.uv.end(), chart.begin(), chart.end());
    return result;
}

}  // namespace hairloom::bust
