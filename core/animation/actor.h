// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A character with hair: the mesh, the skeleton that moves it, the clip being played, and what hair needs of
// them each frame.

#include <memory>
#include <span>
#include <vector>

#include "core/animation/clip.h"
#include "core/animation/skinning.h"
#include "core/geometry/scalp_mesh.h"
#include "core/groom/groom.h"

namespace hairloom {

/// Where a character stands at one time; metres, world space.
struct ActorPose {
    /// The mesh as morph targets have it before bones move it, per vertex; rest space. Empty: at rest.
    std::vector<Vec3f> morphed_ss;
    std::vector<Vec3f> positions_ws;               ///< per vertex of the mesh
    std::vector<Vec3f> normals_ws;                 ///< per vertex, unit length
    std::vector<Eigen::Affine3f> boneMatrices_ws;  ///< per bone, from the mesh's rest space
};

class Actor {
  public:
    /// Errors: weights or morph targets that do not fit the mesh, weights or clips that do not fit the
    /// skeleton, clips that do not fit the targets. Empty weights make a character that no bone moves.
    static Result<Actor> make(std::shared_ptr<const ScalpMesh> mesh, Skeleton skeleton,
                              std::vector<Clip> clips, SkinWeights skin,
                              std::vector<MorphTarget> morphs = {});

    const ScalpMesh& mesh() const { return *mesh_; }
    const Skeleton& skeleton() const { return skeleton_; }
    const std::vector<Clip>& clips() const { return clips_; }
    const SkinWeights& skin() const { return skin_; }
    const std::vector<MorphTarget>& morphs() const { return morphs_; }
    /// Error: no clip of that name, listing those there are.
    Result<std::uint32_t> findClip(std::string_view name) const;

    /// Places the whole character in the world; a rigid motion on top of the clip.
    void setPlacement(const Eigen::Isometry3f& toWorld) { placement_ = toWorld; }

    /// Const and safe on any number of threads. `clip` is an index into clips().
    ActorPose poseAt(std::uint32_t clip, float time, Wrap wrap) const;
    /// From the pose of `from` to that of `to`, bone by bone and weight by weight: `share` 0 … 1 of the way.
    struct At {
        std::uint32_t clip;
        float time;
        Wrap wrap;
    };
    ActorPose poseBetween(const At& from, const At& to, float share) const;
    /// Without animation.
    ActorPose restPose() const;

    /// From the mesh's rest space to the world for each sphere, by the bone of its name. A sphere without a
    /// bone, or with one that the skeleton lacks, goes with the character's placement.
    std::vector<Eigen::Affine3f> sphereTransforms(std::span<const CollisionSphere> spheres,
                                                  const ActorPose& pose) const;

    /// The rigid motion of each root from rest: the posed triangle's frame against the resting one's, about
    /// the root's point. A triangle that is flat at rest or posed gives the motion without rotation.
    std::vector<Eigen::Isometry3f> rootTransforms(std::span<const SurfacePoint> roots,
                                                  const ActorPose& pose) const;

  private:
    /// `weights`: one a morph target, or none for those of rest.
    ActorPose posedBy(std::span<const Eigen::Affine3f> local, std::span<const float> weights) const;

    std::shared_ptr<const ScalpMesh> mesh_;
    Skeleton skeleton_;
    std::vector<Clip> clips_;
    SkinWeights skin_;
    std::vector<MorphTarget> morphs_;
    Eigen::Isometry3f placement_ = Eigen::Isometry3f::Identity();
};

}  // namespace hairloom
