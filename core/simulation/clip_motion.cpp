// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/simulation/clip_motion.h"

#include <fmt/format.h>

#include <algorithm>

#include "hairloom/body_field.h"

namespace hairloom {
namespace {

class ClipMotion : public HeadMotion {
  public:
    ClipMotion(CharacterPoser character, std::uint32_t clip)
        : character_(std::move(character)), clip_(clip) {}

    HeadPose poseAt(float time) const override {
        return character_.pose(character_.actor().poseAt(clip_, time, Wrap::Loop));
    }
    const SkinWeights* skin() const override { return &character_.actor().skin(); }

  private:
    CharacterPoser character_;
    std::uint32_t clip_;
};

bool sameMesh(const ScalpMesh& a, const ScalpMesh& b) {
    return a.vertexCount() == b.vertexCount() && std::ranges::equal(a.triangles(), b.triangles());
}

}  // namespace

Result<CharacterPoser> CharacterPoser::make(std::shared_ptr<const Actor> actor, const Groom& groom) {
    if (!groom.scalp || !sameMesh(actor->mesh(), *groom.scalp)) {
        return fail(
            fmt::format("the character's mesh has {} vertices and {} triangles and is not the groom's scalp",
                        actor->mesh().vertexCount(), actor->mesh().triangleCount()),
            "expected the file that the groom was created with");
    }
    return CharacterPoser(std::move(actor), groom);
}

CharacterPoser::CharacterPoser(std::shared_ptr<const Actor> actor, const Groom& groom)
    : actor_(std::move(actor)), spheres_(groom.spheres) {
    if (!groom.body) return;
    for (const runtime::String& own : groom.body->bones) {
        const std::string bone(own);
        bodyBones_.push_back({bone, Vec3f::Zero(), 0, bone});
    }
}

HeadPose CharacterPoser::pose(ActorPose posed) const {
    HeadPose pose;
    const auto transforms = actor_->sphereTransforms(spheres_, posed);
    for (std::size_t s = 0; s < spheres_.size(); ++s)
        pose.sphereCentres_ws.push_back(transforms[s] * spheres_[s].centre);
    pose.body_ws = actor_->sphereTransforms(bodyBones_, posed);
    pose.scalpPositions_ws = std::move(posed.positions_ws);
    pose.morphed_ss = std::move(posed.morphed_ss);
    pose.bones_ws = std::move(posed.boneMatrices_ws);
    return pose;
}

Result<std::unique_ptr<HeadMotion>> makeClipMotion(std::shared_ptr<const Actor> actor, std::string_view clip,
                                                   const Groom& groom) {
    const auto index = actor->findClip(clip);
    if (!index) return tl::unexpected(index.error());
    auto character = CharacterPoser::make(std::move(actor), groom);
    if (!character) return tl::unexpected(character.error());
    return std::make_unique<ClipMotion>(std::move(*character), *index);
}

}  // namespace hairloom
