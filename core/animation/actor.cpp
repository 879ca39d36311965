// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/animation/actor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "core/animation/root_motion.h"

namespace hairloom {
Result<Actor> Actor::make(std::shared_ptr<const ScalpMesh> mesh, Skeleton skeleton, std::vector<Clip> clips,
                          SkinWeights skin, std::vector<MorphTarget> morphs) {
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
    if (auto status = validate(morphs, mesh->vertexCount()); !status) return tl::unexpected(status.error());
    for (const Clip& clip : clips) {
        if (auto status = validate(clip, skeleton, morphs.size()); !status)
            return tl::unexpected(status.error());
    }
    Actor actor;
    actor.mesh_ = std::move(mesh);
    actor.skeleton_ = std::move(skeleton);
    actor.clips_ = std::move(clips);
    actor.skin_ = std::move(skin);
    actor.morphs_ = std::move(morphs);
    return actor;
}

Result<std::uint32_t> Actor::findClip(std::string_view name) const {
    const auto found = std::ranges::find(clips_, name, &Clip::name);
    if (found != clips_.end()) return static_cast<std::uint32_t>(found - clips_.begin());
    std::string names;
    for (const Clip& clip : clips_) names += (names.empty() ? "'" : ", '") + clip.name + "'";
    return fail(
        fmt::format("the character has no clip '{}'", name),
        names.empty() ? "expected a character with clips, and it has none" : "expected one of " + names);
}

ActorPose Actor::posedBy(std::span<const Eigen::Affine3f> local, std::span<const float> weights) const {
    ActorPose pose;
    if (!weights.empty()) pose.morphed_ss = morphedPositions(mesh_->positions(), morphs_, weights);
    const bool isMorphed = !pose.morphed_ss.empty();
    const std::vector<Vec3f> normals =
        isMorphed ? morphedNormals(*mesh_, pose.morphed_ss) : std::vector<Vec3f>();
    pose.boneMatrices_ws = skinMatrices(skeleton_, local);
    pose.positions_ws.resize(mesh_->vertexCount());
    pose.normals_ws.resize(mesh_->vertexCount());
    skinPositions(isMorphed ? std::span<const Vec3f>(pose.morphed_ss) : mesh_->positions(), skin_,
                  pose.boneMatrices_ws, pose.positions_ws);
    skinNormals(isMorphed ? std::span<const Vec3f>(normals) : mesh_->normals(), skin_, pose.boneMatrices_ws,
                pose.normals_ws);
    if (placement_.matrix().isIdentity(0.0f)) return pose;
    for (Vec3f& position : pose.positions_ws) position = placement_ * position;
    for (Vec3f& normal : pose.normals_ws) normal = placement_.linear() * normal;
    for (Eigen::Affine3f& matrix : pose.boneMatrices_ws) matrix = placement_ * matrix;
    return pose;
}

ActorPose Actor::poseAt(std::uint32_t clip, float time, Wrap wrap) const {
    assert(clip < clips_.size());
    return posedBy(localMatrices(skeleton_, clips_[clip], time, wrap),
                   morphWeights(morphs_, clips_[clip], time, wrap));
}

ActorPose Actor::poseBetween(const At& from, const At& to, float share) const {
    const auto local = [this](const At& at) {
        assert(at.clip < clips_.size());
        return localMatrices(skeleton_, clips_[at.clip], at.time, at.wrap);
    };
    const auto weights = [this](const At& at) {
        return morphWeights(morphs_, clips_[at.clip], at.time, at.wrap);
    };
    return posedBy(blended(local(from), local(to), share),
                   blended(morphs_, weights(from), weights(to), share));
}

ActorPose Actor::restPose() const {
    return posedBy(localMatrices(skeleton_), {});
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
    return hairloom::rootTransforms(*mesh_, pose.positions_ws, roots);
}

}  // namespace hairloom
