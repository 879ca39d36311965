// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry/surface_walk.h"

#include <algorithm>
#include <array>
#include <optional>

namespace hairloom {
namespace {

constexpr int kNoCorner = -1;

/// The triangle on the other side of the edge that lies opposite a corner.
std::optional<std::uint32_t> triangleAcross(const ScalpMesh& mesh, std::uint32_t triangle, int corner) {
    const Triangle& corners = mesh.triangles()[triangle];
    const auto vertex = [&](int i) {
        return OpenMesh::VertexHandle(static_cast<int>(corners[static_cast<std::size_t>(i % 3)]));
    };
    const ScalpMesh::Connectivity& connectivity = mesh.connectivity();
    const auto edge = connectivity.find_halfedge(vertex(corner + 1), vertex(corner + 2));
    if (!edge.is_valid()) return std::nullopt;
    const auto face = connectivity.face_handle(connectivity.opposite_halfedge_handle(edge));
    if (!face.is_valid()) return std::nullopt;
    return static_cast<std::uint32_t>(face.idx());
}

/// A walk in one triangle after the other.
class Walk {
  public:
    Walk(const ScalpMesh& mesh, const SurfacePoint& from, const Vec3f& offset,
         std::span<const std::uint8_t> open)
        : mesh_(mesh), open_(open), triangle_(from.triangle), place_(from.barycentric.cast<double>()) {
        measure();
        const Vec3d wanted = offset.cast<double>();
        const Vec3d along = wanted - normal_ * normal_.dot(wanted);
        const double length = along.norm();
        left_ = length > 0 ? Vec3d(along * (wanted.norm() / length)) : along;
    }

    SurfacePoint run() {
        // More than a walk across a fine mesh meets; it ends where a corner sends it to and fro.
        constexpr int kMostSteps = 4096;
        for (int step = 0; step < kMostSteps && goOn(); ++step) {
        }
        const Vec3d place = place_ / place_.sum();
        return {triangle_, place.cast<float>()};
    }

  private:
    void measure() {
        const Triangle& corners = mesh_.triangles()[triangle_];
        for (std::size_t i = 0; i < 3; ++i) corners_[i] = mesh_.positions()[corners[i]].cast<double>();
        area_ = (corners_[1] - corners_[0]).cross(corners_[2] - corners_[0]);
        const double length = area_.norm();
        normal_ = length > 0 ? Vec3d(area_ / length) : Vec3d(Vec3d::Zero());
    }

    /// To the end, or to the next edge and over it. False where it is at its end.
    bool goOn() {
        const double square = area_.squaredNorm();
        if (!(square > 0) || !(left_.norm() > kArrived)) return false;
        Vec3d change;
        change[1] = left_.cross(corners_[2] - corners_[0]).dot(area_) / square;
        change[2] = (corners_[1] - corners_[0]).cross(left_).dot(area_) / square;
        change[0] = -change[1] - change[2];
        // Rounding must not lead back over the edge that it came over or goes along.
        if (held_ != kNoCorner) change[held_] = std::max(change[held_], 0.0);
        double share = 1;
        int leaves = kNoCorner;
        for (int i = 0; i < 3; ++i) {
            if (!(change[i] < 0) || !(place_[i] < -change[i] * share)) continue;
            share = place_[i] / -change[i];
            leaves = i;
        }
        place_ = (place_ + share * change).cwiseMax(0.0);
        if (leaves == kNoCorner) return false;
        place_[leaves] = 0;
        left_ *= 1 - share;
        const auto across = triangleAcross(mesh_, triangle_, leaves);
        if (across && (open_.empty() || open_[*across] != 0)) {
            cross(*across, leaves);
        } else {
            goAlong(leaves);
        }
        return true;
    }

    void cross(std::uint32_t to, int leaves) {
        const Triangle& before = mesh_.triangles()[triangle_];
        const Triangle& now = mesh_.triangles()[to];
        const Vec3d edge = edgeOpposite(leaves), oldNormal = normal_;
        Vec3d place = Vec3d::Zero();
        held_ = kNoCorner;
        for (int i = 0; i < 3; ++i) {
            const auto same = std::ranges::find(before, now[static_cast<std::size_t>(i)]);
            const auto corner = static_cast<int>(same - before.begin());
            if (same == before.end() || corner == leaves) {
                held_ = i;
            } else {
                place[i] = place_[corner];
            }
        }
        triangle_ = to;
        place_ = place;
        measure();
        // Laid flat: the part along the edge stays, that away from it is so in the new plane.
        const Vec3d away = oldNormal.cross(edge), nowAway = normal_.cross(edge);
        left_ = edge * edge.dot(left_) + nowAway * away.dot(left_);
    }

    void goAlong(int leaves) {
        const Vec3d edge = edgeOpposite(leaves);
        left_ = edge * edge.dot(left_);
        held_ = leaves;
    }

    /// Of length 1.
    Vec3d edgeOpposite(int corner) const {
        const auto at = [&](int i) { return corners_[static_cast<std::size_t>(i % 3)]; };
        return (at(corner + 2) - at(corner + 1)).normalized();
    }

    static constexpr double kArrived = 1e-9;  // metres

    const ScalpMesh& mesh_;
    std::span<const std::uint8_t> open_;
    std::uint32_t triangle_;
    Vec3d place_;  ///< barycentric
    std::array<Vec3d, 3> corners_;
    Vec3d area_, normal_, left_;
    int held_ = kNoCorner;  ///< whose opposite edge it came over or goes along
};

}  // namespace

SurfacePoint walkOnSurface(const ScalpMesh& mesh, const SurfacePoint& from, const Vec3f& offset,
                           std::span<const std::uint8_t> open) {
    return Walk(mesh, from, offset, open).run();
}

}  // namespace hairloom
