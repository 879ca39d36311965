// SPDX-License-Identifier: GPL-3.0-or-later
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <algorithm>
#include <set>

#include "samples/bust/mesher.h"

namespace hairloom::bust {
namespace {

struct Traits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
    using Normal = OpenMesh::Vec3d;
    VertexAttributes(OpenMesh::Attributes::Status);
    EdgeAttributes(OpenMesh::Attributes::Status);
    FaceAttributes(OpenMesh::Attributes::Status);
    HalfedgeAttributes(OpenMesh::Attributes::Status);
};
using Mesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;
using VertexHandle = Mesh::VertexHandle;
using EdgeHandle = Mesh::EdgeHandle;
using HalfedgeHandle = Mesh::HalfedgeHandle;
using FaceHandle = Mesh::FaceHandle;

Vec3d toEigen(const OpenMesh::Vec3d& p) {
    return {p[0], p[1], p[2]};
}
OpenMesh::Vec3d toOpenMesh(const Vec3d& p) {
    return {p.x(), p.y(), p.z()};
}

class Remesher {
  public:
    explicit Remesher(const PatchMesh& half) {
        std::vector<VertexHandle> handles;
        for (const Vec3d& p : half.positions) handles.push_back(mesh_.add_vertex(toOpenMesh(p)));
        for (std::size_t t = 0; t < half.triangles.size(); ++t) {
            const auto& v = half.triangles[t];
            patch(mesh_.add_face(handles[v[0]], handles[v[1]], handles[v[2]])) = half.patches[t];
        }
    }

    void round() {
        splitLong();
        collapseShort();
        flipToDelaunay();
        for (int pass = 0; pass < 3; ++pass) smooth();
        flipToDelaunay();
    }

    PatchMesh result() {
        mesh_.garbage_collection();
        PatchMesh out;
        for (const auto v : mesh_.vertices()) {
            Vec3d p = constrain(v, position(v));
            if (v.is_boundary()) p.x() = 0.0;
            out.positions.push_back(p);
        }
        for (const auto f : mesh_.faces()) {
            std::array<int, 3> corners{};
            int k = 0;
            for (const auto v : f.vertices()) corners[k++] = v.idx();
            out.triangles.push_back(corners);
            out.patches.push_back(patch(f));
        }
        return out;
    }

  private:
    Patch& patch(FaceHandle f) { return mesh_.property(patch_, f); }
    Vec3d position(VertexHandle v) const { return toEigen(mesh_.point(v)); }
    double length(EdgeHandle e) const { return mesh_.calc_edge_length(e); }
    double wanted(EdgeHandle e) const {
        const auto h = mesh_.halfedge_handle(e, 0);
        return edgeLength(0.5 *
                          (position(mesh_.from_vertex_handle(h)) + position(mesh_.to_vertex_handle(h))));
    }
    bool isFeature(EdgeHandle e) {
        if (mesh_.is_boundary(e)) return true;
        const FaceHandle a = mesh_.face_handle(mesh_.halfedge_handle(e, 0));
        const FaceHandle b = mesh_.face_handle(mesh_.halfedge_handle(e, 1));
        return patch(a) != patch(b);
    }
    int featureCount(VertexHandle v) {
        int count = 0;
        for (const auto e : mesh_.ve_range(v)) count += isFeature(e);
        return count;
    }

    /// Newton steps of least length onto the surface and the curves that the vertex lies on.
    Vec3d constrain(VertexHandle v, Vec3d p) {
        std::set<Border> curves;
        for (const auto e : mesh_.ve_range(v)) {
            if (mesh_.is_boundary(e) || !isFeature(e)) continue;
            curves.insert(borderBetween(patch(mesh_.face_handle(mesh_.halfedge_handle(e, 0))),
                                        patch(mesh_.face_handle(mesh_.halfedge_handle(e, 1)))));
        }
        const bool middle = mesh_.is_boundary(v);
        if (middle) p.x() = 0.0;
        if (curves.empty() && !middle) return project(p);
        for (int step = 0; step < 12; ++step) {
            Eigen::Matrix3d jacobian = Eigen::Matrix3d::Zero();
            Vec3d value = Vec3d::Zero();
            int rows = 0;
            const auto require = [&](double d, const Vec3d& slope) {
                if (rows == 3) return;
                value[rows] = d;
                jacobian.row(rows++) = slope;
            };
            require(surface(p), gradient(p));
            if (middle) require(p.x(), Vec3d::UnitX());
            for (const Border which : curves) {
                Vec3d slope;
                for (int axis = 0; axis < 3; ++axis) {
                    const Vec3d h = 1e-5 * Vec3d::Unit(axis);
                    slope[axis] = (border(which, p + h) - border(which, p - h)) / 2e-5;
                }
                require(border(which, p), slope);
            }
            if (value.cwiseAbs().maxCoeff() < 1e-9) break;
            Vec3d move = -jacobian.completeOrthogonalDecomposition().solve(value);
            if (move.norm() > 0.002) move *= 0.002 / move.norm();
            p += move;
        }
        return p;
    }

    void splitLong() {
        const std::size_t before = mesh_.n_edges();
        for (std::size_t i = 0; i < before; ++i) {
            const EdgeHandle e(static_cast<int>(i));
            if (mesh_.status(e).deleted() || length(e) <= 4.0 / 3.0 * wanted(e)) continue;
            splitEdge(e);
        }
    }

    void splitEdge(EdgeHandle e) {
        std::array<VertexHandle, 2> opposite;
        std::array<Patch, 2> patches{};
        for (unsigned side = 0; side < 2; ++side) {
            const auto h = mesh_.halfedge_handle(e, side);
            if (mesh_.is_boundary(h)) continue;
            opposite[side] = mesh_.to_vertex_handle(mesh_.next_halfedge_handle(h));
            patches[side] = patch(mesh_.face_handle(h));
        }
        const auto h = mesh_.halfedge_handle(e, 0);
        const Vec3d middle =
            0.5 * (position(mesh_.from_vertex_handle(h)) + position(mesh_.to_vertex_handle(h)));
        const VertexHandle v = mesh_.add_vertex(toOpenMesh(middle));
        mesh_.split_edge(e, v);
        for (const auto f : mesh_.vf_range(v)) {
            for (const auto corner : mesh_.fv_range(f)) {
                for (unsigned side = 0; side < 2; ++side) {
                    if (corner == opposite[side]) patch(f) = patches[side];
                }
            }
        }
        mesh_.set_point(v, toOpenMesh(constrain(v, middle)));
    }

    void collapseShort() {
        for (std::size_t i = 0; i < mesh_.n_edges(); ++i) {
            const EdgeHandle e(static_cast<int>(i));
            if (mesh_.status(e).deleted() || length(e) >= 0.8 * wanted(e)) continue;
            for (unsigned side = 0; side < 2; ++side) {
                const auto h = mesh_.halfedge_handle(e, side);
                if (!mayCollapse(h)) continue;
                mesh_.collapse(h);
                break;
            }
        }
        mesh_.garbage_collection();
    }

    /// Whether the start of the half-edge may move into its end: not off its curve, no inverted or overlong
    /// triangles.
    bool mayCollapse(HalfedgeHandle h) {
        const VertexHandle from = mesh_.from_vertex_handle(h);
        const VertexHandle to = mesh_.to_vertex_handle(h);
        const int features = featureCount(from);
        if (features > 2 || (features > 0 && !isFeature(mesh_.edge_handle(h)))) return false;
        if (!mesh_.is_collapse_ok(h)) return false;
        for (const auto v : mesh_.vv_range(from)) {
            const Vec3d middle = 0.5 * (position(v) + position(to));
            if ((position(v) - position(to)).norm() > 1.6 * edgeLength(middle)) return false;
        }
        return keepsShape(from, position(to), to);
    }

    /// Whether no triangle round `v` becomes folded or a sliver when it moves, unless it was worse before;
    /// those that hold `gone` vanish.
    bool keepsShape(VertexHandle v, const Vec3d& target, VertexHandle gone = VertexHandle()) const {
        double before = kGoodShape;
        double after = kGoodShape;
        for (const auto h : mesh_.voh_range(v)) {
            if (mesh_.is_boundary(h)) continue;
            const VertexHandle a = mesh_.to_vertex_handle(h);
            const VertexHandle b = mesh_.to_vertex_handle(mesh_.next_halfedge_handle(h));
            before = std::min(before, shape(position(v), position(a), position(b)));
            if (a != gone && b != gone) after = std::min(after, shape(target, position(a), position(b)));
        }
        return after >= before;
    }

    static constexpr double kGoodShape = 0.25;
    /// Twice the area over the longest edge squared (0.87 at best), or below zero where it does not look the
    /// way the surface does.
    static double shape(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
        const Vec3d normal = (b - a).cross(c - a);
        const double longest =
            std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
        const double facing = normal.normalized().dot(gradient((a + b + c) / 3.0).normalized());
        return facing > 0.45 ? normal.norm() / longest : facing - 1.0;
    }

    double cornerAngle(HalfedgeHandle h) const {
        const Vec3d tip = position(mesh_.to_vertex_handle(mesh_.next_halfedge_handle(h)));
        const Vec3d a = position(mesh_.from_vertex_handle(h)) - tip;
        const Vec3d b = position(mesh_.to_vertex_handle(h)) - tip;
        return std::atan2(a.cross(b).norm(), a.dot(b));
    }

    void flipToDelaunay() {
        for (int pass = 0; pass < 4; ++pass) {
            bool changed = false;
            for (const auto e : mesh_.edges()) {
                if (isFeature(e) || !mesh_.is_flip_ok(e)) continue;
                const auto h = mesh_.halfedge_handle(e, 0);
                const auto o = mesh_.halfedge_handle(e, 1);
                if (cornerAngle(h) + cornerAngle(o) < 3.1416 + 1e-3) continue;
                const Vec3d a = position(mesh_.from_vertex_handle(h));
                const Vec3d b = position(mesh_.to_vertex_handle(h));
                const Vec3d c = position(mesh_.to_vertex_handle(mesh_.next_halfedge_handle(h)));
                const Vec3d d = position(mesh_.to_vertex_handle(mesh_.next_halfedge_handle(o)));
                if (std::min(shape(c, d, b), shape(d, c, a)) < std::min(shape(a, b, c), shape(b, a, d)))
                    continue;
                mesh_.flip(e);
                changed = true;
            }
            if (!changed) break;
        }
    }

    void smooth() {
        for (const auto v : mesh_.vertices()) {
            const int features = featureCount(v);
            const Vec3d here = position(v);
            Vec3d sum = Vec3d::Zero();
            double weights = 0.0;
            if (features > 2) {
                sum = here;
                weights = 1.0;
            } else {
                for (const auto e : mesh_.ve_range(v)) {
                    if (features == 2 && !isFeature(e)) continue;
                    const auto h = mesh_.halfedge_handle(e, 0);
                    const Vec3d other =
                        position(mesh_.from_vertex_handle(h) == v ? mesh_.to_vertex_handle(h)
                                                                  : mesh_.from_vertex_handle(h));
                    const double weight = (other - here).norm() / edgeLength(0.5 * (other + here));
                    sum += weight * other;
                    weights += weight;
                }
            }
            const Vec3d target = constrain(v, 0.4 * here + 0.6 * sum / weights);
            if (keepsShape(v, target)) mesh_.set_point(v, toOpenMesh(target));
        }
    }

    Mesh mesh_;
    OpenMesh::FPropHandleT<Patch> patch_ = [this] {
        OpenMesh::FPropHandleT<Patch> handle;
        mesh_.add_property(handle);
        return handle;
    }();
};

}  // namespace

PatchMesh remeshHalf(const PatchMesh& half, int rounds) {
    Remesher remesher(half);
    for (int i = 0; i < rounds; ++i) remesher.round();
    return remesher.result();
}

}  // namespace hairloom::bust
