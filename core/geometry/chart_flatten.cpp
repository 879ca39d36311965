// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_parameterization/Barycentric_mapping_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/Circular_border_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/LSCM_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/Mean_value_coordinates_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/parameterize.h>

#include <exception>

#include "core/geometry/flat_chart.h"

namespace hairloom {
namespace {

namespace smp = CGAL::Surface_mesh_parameterization;
using Kernel = CGAL::Simple_cartesian<double>;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Border = smp::Circular_border_arc_length_parameterizer_3<Mesh>;

/// Sides of the piece itself, whose cuts are open.
std::vector<std::uint32_t> piecesOpposite(const Mesh& mesh, const ChartPiece& piece) {
    std::vector<std::uint32_t> opposite(piece.triangles.size() * 3, kOpenSide);
    for (std::uint32_t side = 0; side < opposite.size(); ++side) {
        const Triangle& t = piece.triangles[side / 3];
        const std::uint32_t from = t[side % 3], to = t[(side + 1) % 3];
        const auto back = mesh.halfedge(Mesh::Vertex_index(to), Mesh::Vertex_index(from));
        if (mesh.is_border(back)) continue;
        const auto face = static_cast<std::uint32_t>(mesh.face(back).idx());
        const Triangle& other = piece.triangles[face];
        opposite[side] = 3 * face + (other[0] == to ? 0 : other[1] == to ? 1 : 2);
    }
    return opposite;
}

template <class Parameterizer>
std::optional<std::vector<Vec2d>> tryFlatten(Mesh mesh, const ChartPiece& piece,
                                             const std::vector<std::uint32_t>& opposite) {
    using Uv = Kernel::Point_2;
    auto uvOf = mesh.add_property_map<Mesh::Vertex_index, Uv>("v:uv", Uv(0, 0)).first;
    try {
        const auto border = CGAL::Polygon_mesh_processing::longest_border(mesh).first;
        if (smp::parameterize(mesh, Parameterizer(), border, uvOf) != smp::OK) return std::nullopt;
    } catch (const std::exception&) {  // CGAL's own checks of its input
        return std::nullopt;
    }
    std::vector<Vec2d> uvs;
    uvs.reserve(piece.triangles.size() * 3);
    for (const Triangle& t : piece.triangles)
        for (const std::uint32_t v : t)
            uvs.emplace_back(uvOf[Mesh::Vertex_index(v)].x(), uvOf[Mesh::Vertex_index(v)].y());
    if (!isInjective(opposite, uvs)) return std::nullopt;
    return uvs;
}

std::vector<Vec2d> layTriangle(const ChartPiece& piece) {
    const auto position = [&](std::size_t i) { return piece.positions[piece.triangles[0][i]]; };
    const Vec3d ab = position(1) - position(0), ac = position(2) - position(0);
    const double along = ac.dot(ab.normalized());
    return {{0, 0}, {ab.norm(), 0}, {along, ab.cross(ac).norm() / ab.norm()}};
}

}  // namespace

std::optional<std::vector<Vec2d>> flattenDisc(const ChartPiece& piece) {
    if (piece.triangles.size() == 1) return layTriangle(piece);
    Mesh mesh;
    for (const Vec3d& p : piece.positions) mesh.add_vertex({p.x(), p.y(), p.z()});
    for (const Triangle& t : piece.triangles)
        if (mesh.add_face(Mesh::Vertex_index(t[0]), Mesh::Vertex_index(t[1]), Mesh::Vertex_index(t[2])) ==
            Mesh::null_face())
            return std::nullopt;
    const std::vector<std::uint32_t> opposite = piecesOpposite(mesh, piece);
    if (auto uvs = tryFlatten<smp::LSCM_parameterizer_3<Mesh>>(mesh, piece, opposite)) return uvs;
    if (auto uvs =
            tryFlatten<smp::Mean_value_coordinates_parameterizer_3<Mesh, Border>>(mesh, piece, opposite))
        return uvs;
    return tryFlatten<smp::Barycentric_mapping_parameterizer_3<Mesh, Border>>(mesh, piece, opposite);
}

}  // namespace hairloom
