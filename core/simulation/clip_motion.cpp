// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/simulation/clip_motion.h"

#include <fmt/format.h>

#include <algorithm>

#include "hairloom/body_field.h"

namespace hairloom {
namespace {

class ClipMotion : public HeadMotion {
  public:
    ClipMotion(std::shared_ptr<const Actor> actor, std::uint32_t clip, const Groom& groom)
        : actor_(std::move(actor)), clip_(clip), spheres_(groom.spheres) {
        if (!groom.body) return;
        for (const std::string& bone : groom.body->bones)
            bodyBones_.push_back({bone, Vec3f::Zero(), 0, bone});
    }

    HeadPose poseAt(float time) const override {
        ActorPose posed = actor_->poseAt(clip_, time, Wrap::Loop);
        HeadPose pose;
        const auto transforms = actor_->sphereTransforms(spheres_, posed);
        for (std::size_t s = 0; s < spheres_.size(); ++s) {
            pose.sphereCentres_ws.push_back(transforms[s] * spheres_[s].centre);
        }
        pose.body_ws = actor_->sphereTransforms(bodyBones_, posed);
        pose.scalpPositions_ws = std::move(posed.positions_ws);
        pose.bones_ws = std::move(posed.boneMatrices_ws);
        return pose;
    }
    const SkinWeights* skin() const override { return &actor_->skin(); }

  private:
    std::shared_ptr<const Actor> actor_;
    std::uint32_t clip_;
    std::vector<CollisionSphere> spheres_;
    std::vector<CollisionSphere> bodyBones_;  ///< stand for the bones of the groom's body
};

bool sameMesh(const ScalpMesh& a, const ScalpMesh& b) {
    return a.vertexCount() == b.vertexCount() && std::ranges::equal(a.triangles(), b.triangles());
}

}  // namespace

Result<std::unique_ptr<HeadMotion>> makeClipMotion(std::shared_ptr<const Actor> actor, std::string_view clip,
                                                   const Groom& groom) {
    const auto index = actor->findClip(clip);
    if (!index) return tl::unexpected(index.error());
    if (!groom.scalp || !sameMesh(actor->mesh(), *groom.scalp)) {
        return fail(
            fmt::format("the character's mesh has {} vertices and {} triangles and is not the groom's scalp",
                        actor->mesh().vertexCount(), actor->mesh().triangleCount()),
            "expected the file that the groom was created with");
    }
    return std::make_unique<ClipMotion>(std::move(actor), *index, groom);
}

}  // namespace hairloom
