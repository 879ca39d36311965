// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/animation/actor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "core/base/parallel.h"

namespace hairloom {
namespace {

constexpr std::size_t kRootsPerPiece = 4096;

/// A right-handed frame that turns with the triangle: along its first edge, its normal, and across. Zero when
/// flat.
Mat3f triangleFrame(const Vec3f& a, const Vec3f& b, const Vec3f& c) {
    const Vec3f along = b - a;
    const Vec3f normal = along.cross(c - a);
    if (!(normal.norm() > 0) || !(along.norm() > 0)) return Mat3f::Zero();
    Mat3f frame;
    frame.col(0) = along.normalized();
    frame.col(1) = normal.normalized();
    frame.col(2) = frame.col(0).cross(frame.col(1));
    return frame;
}

Mat3f frameOf(const Triangle& triangle, std::span<const Vec3f> positions) {
    return triangleFrame(positions[triangle[0]], positions[triangle[1]], positions[triangle[2]]);
}

Vec3f pointOf(const Triangle& triangle, const Vec3f& barycentric, std::span<const Vec3f> positions) {
    return barycentric.x() * positions[triangle[0]] + barycentric.y() * positions[triangle[1]] +
           barycentric.z() * positions[triangle[2]];
}

}  // namespace

Result<Actor> Actor::make(std::shared_ptr<const ScalpMesh> mesh, Skeleton skeleton, std::vector<Clip> clips,
                          SkinWeights skin) {
    assert(mesh);
    if (skin.vertexCount() == 0) {
        skin.bones.resize(mesh->vertexCount());
        skin.weights.resize(mesh->vertexCount());
    }
    if (skin.vertexCount() != mesh->vertexCount()) {
        return fail(fmt::format("there are skin weights for {} vertices", skin.vertexCount()),
                    fmt::format("the mesh has {}", mesh->vertexCount()));
    }
    if (auto status = validate(skin, skeleton.bones().size()); !status) return tl::unexpected(status.error());
    for (const Clip& clip : clips) {
        if (auto status = validate(clip, skeleton); !status) return tl::unexpected(status.error());
    }
    Actor actor;
    actor.mesh_ = std::move(mesh);
    actor.skeleton_ = std::move(skeleton);
    actor.clips_ = std::move(clips);
    actor.skin_ = std::move(skin);
    return actor;
}

Result<std::uint32_t> Actor::findClip(std::string_view name) const {
    const auto found = std::ranges::find(clips_, name, &Clip::name);
    if (found != clips_.end()) return static_cast<std::uint32_t>(found - clips_.begin());
    std::string names;
    for (const Clip& clip : clips_) names += (names.empty() ? "'" : ", '") + clip.name + "'";
    return fail(fmt::format("the character has no clip '{}'", name),
                names.empty() ? "it has no clips" : "expected one of " + names);
}

ActorPose Actor::posedBy(std::span<const Eigen::Affine3f> local) const {
    ActorPose pose;
    pose.boneMatrices_ws = skinMatrices(skeleton_, local);
    pose.positions_ws.resize(mesh_->vertexCount());
    pose.normals_ws.resize(mesh_->vertexCount());
    skinPositions(mesh_->positions(), skin_, pose.boneMatrices_ws, pose.positions_ws);
    skinNormals(mesh_->normals(), skin_, pose.boneMatrices_ws, pose.normals_ws);
    if (placement_.matrix().isIdentity(0.0f)) return pose;
    for (Vec3f& position : pose.positions_ws) position = placement_ * position;
    for (Vec3f& normal : pose.normals_ws) normal = placement_.linear() * normal;
    for (Eigen::Affine3f& matrix : pose.boneMatrices_ws) matrix = placement_ * matrix;
    return pose;
}

ActorPose Actor::poseAt(std::uint32_t clip, float time, Wrap wrap) const {
    assert(clip < clips_.size());
    return posedBy(localMatrices(skeleton_, clips_[clip], time, wrap));
}

ActorPose Actor::restPose() const {
    return posedBy(localMatrices(skeleton_));
}

std::vector<Eigen::Affine3f> Actor::sphereTransforms(std::span<const CollisionSphere> spheres,
                                                     const ActorPose& pose) const {
    std::vector<Eigen::Affine3f> transforms;
    transforms.reserve(spheres.size());
    for (const CollisionSphere& sphere : spheres) {
        const auto bone = sphere.bone.empty() ? std::nullopt : skeleton_.find(sphere.bone);
        transforms.push_back(bone ? pose.boneMatrices_ws[*bone] : Eigen::Affine3f(placement_));
    }
    return transforms;
}

std::vector<Eigen::Isometry3f> Actor::rootTransforms(std::span<const SurfacePoint> roots,
                                                     const ActorPose& pose) const {
    std::vector<Eigen::Isometry3f> transforms(roots.size(), Eigen::Isometry3f::Identity());
    parallelFor(roots.size(), kRootsPerPiece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t root = begin; root < end; ++root) {
            const Triangle& triangle = mesh_->triangles()[roots[root].triangle];
            const Mat3f rotation =
                frameOf(triangle, pose.positions_ws) * frameOf(triangle, mesh_->positions()).transpose();
            if (!rotation.isZero(0.0f)) transforms[root].linear() = rotation;
            const Vec3f& barycentric = roots[root].barycentric;
            transforms[root].translation() =
                pointOf(triangle, barycentric, pose.positions_ws) -
                transforms[root].linear() * pointOf(triangle, barycentric, mesh_->positions());
        }
    });
    return transforms;
}

}  // namespace hairloom
