// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A ball with a few guides on its upper half and hairs around each, small enough for a software device to
// move and draw.

#include "core/geometry/shapes.h"
#include "core/groom/groom.h"
#include "core/simulation/motion.h"

namespace hairloom {

inline Groom smallHead(std::uint32_t points = 8) {
    const auto ball = std::make_shared<const ScalpMesh>(shapes::meshOf(shapes::icosphere(2, 0.1f)));
    std::vector<std::uint32_t> offsets{0};
    std::vector<Vec3f> positions;
    std::vector<SurfacePoint> roots;
    FaceSet scalp;
    for (std::uint32_t t = 0; t < ball->triangleCount(); ++t) {
        const Triangle& corners = ball->triangles()[t];
        const Vec3f centre =
            (ball->positions()[corners[0]] + ball->positions()[corners[1]] + ball->positions()[corners[2]]) /
            3;
        if (centre.y() < 0.03f) continue;
        scalp.push_back(t);
        roots.push_back({t, Vec3f::Constant(1.0f / 3)});
        const Vec3f out = centre.normalized();
        for (std::uint32_t p = 0; p < points; ++p) {
            const float s = static_cast<float>(p) / static_cast<float>(points - 1);
            positions.push_back(centre + 0.15f * s * out - Vec3f(0, 0.06f * s * s, 0));
        }
        offsets.push_back(static_cast<std::uint32_t>(positions.size()));
    }
    Groom groom = makeGroom(std::move(offsets), std::move(positions));
    groom.scalp = ball;
    groom.scalpSelection = scalp;
    groom.setRootBindings(roots);
    CollisionSphere sphere;
    sphere.radius = 0.098f;
    groom.spheres = {sphere};
    groom.interpolation.followPerGuide = 4;
    groom.interpolation.wispRadiusTip = 0.02f;
    groom.interpolation.blend = 0.3f;
    groom.material.rootRadius = 0.0008f;
    groom.simulation.windSpeed = 2;
    return groom;
}

/// Two bones: the lower half of the ball stays, the upper nods.
class SkinnedNod : public HeadMotion {
  public:
    explicit SkinnedNod(const Groom& groom) : scalp_(groom.scalp) {
        for (const Vec3f& p : scalp_->positions()) {
            const float upper = std::clamp(0.5f + 10 * p.y(), 0.0f, 1.0f);
            skin_.bones.push_back({0, 1, 0, 0});
            skin_.weights.push_back({1 - upper, upper, 0, 0});
        }
    }
    HeadPose poseAt(float time) const override {
        HeadPose pose;
        pose.bones_ws.assign(2, Eigen::Affine3f::Identity());
        pose.bones_ws[1].rotate(Eigen::AngleAxisf(0.5f * std::sin(8 * time), Vec3f::UnitX()));
        pose.scalpPositions_ws.resize(scalp_->vertexCount());
        skinPositions(scalp_->positions(), skin_, pose.bones_ws, pose.scalpPositions_ws);
        return pose;
    }
    const SkinWeights* skin() const override { return &skin_; }

  private:
    std::shared_ptr<const ScalpMesh> scalp_;
    SkinWeights skin_;
};

}  // namespace hairloom
