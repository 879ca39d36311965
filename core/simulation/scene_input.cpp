// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/simulation/scene_input.h"

#include <fmt/format.h>

#include "core/animation/root_motion.h"
#include "core/groom/spheres.h"
#include "core/groom/validate.h"
#include "hairloom/body_spheres.h"

namespace hairloom {
namespace {

runtime::Float3 toFloat3(const Vec3f& v) {
    return {v.x(), v.y(), v.z()};
}

runtime::Quat toQuat(const Quatf& q) {
    return {q.x(), q.y(), q.z(), q.w()};
}

}  // namespace

std::vector<runtime::Sphere> spheresAt(std::span<const CollisionSphere> spheres, const HeadPose& pose) {
    // A pose of other spheres carries none of these by their bones.
    const bool byBone = pose.sphereCentres_ws.size() == spheres.size();
    std::vector<runtime::Sphere> placed(spheres.size());
    for (std::size_t s = 0; s < placed.size(); ++s) {
        const Vec3f centre_ws = byBone ? pose.sphereCentres_ws[s] : Vec3f(pose.head_ws * spheres[s].centre);
        placed[s] = toSphere(centre_ws, spheres[s].radius);
    }
    return placed;
}

runtime::Vector<std::uint8_t> skinSpheresOf(const Groom& groom) {
    if (!groom.body) return {};
    return runtime::spheresOfSkin(*groom.body, spheresAt(groom.spheres, {}), capsulesOf(groom.spheres));
}

runtime::StrandsView strandsAtRest(const Groom& groom) {
    static_assert(sizeof(Vec3f) == sizeof(runtime::Float3));
    const auto positions = groom.positions();
    runtime::StrandsView strands;
    strands.offsets = groom.offsets.view();
    strands.restPositions_ss = {reinterpret_cast<const runtime::Float3*>(positions.data()), positions.size()};
    strands.stiffness = groom.strandAttributes.view<float>(attribute::kStiffness);
    return strands;
}

runtime::BonePose toBonePose(const Eigen::Affine3f& m) {
    const Mat3f linear = m.linear();
    return {toFloat3(linear.col(0)), toFloat3(linear.col(1)), toFloat3(linear.col(2)),
            toFloat3(m.translation())};
}

std::vector<runtime::BonePose> bodyAt(const Groom& groom, const HeadPose& pose) {
    if (!groom.body) return {};
    if (!pose.body_ws.empty() && pose.body_ws.size() == std::max<std::size_t>(groom.body->bones.size(), 1)) {
        std::vector<runtime::BonePose> poses;
        for (const Eigen::Affine3f& bone : pose.body_ws) poses.push_back(toBonePose(bone));
        return poses;
    }
    if (!pose.scalpPositions_ws.empty()) return {};
    return {toBonePose(Eigen::Affine3f(pose.head_ws.matrix()))};
}

Result<SceneInput> SceneInput::make(const Groom& groom) {
    if (groom.strandCount() == 0) return fail("the groom has no strands", "expected strands to simulate");
    for (const Finding& finding : validate(groom)) {
        if (finding.severity != Severity::Error) continue;
        return fail(fmt::format("{} ({})", finding.what, finding.where),
                    finding.fix.empty() ? "expected a groom that validates" : finding.fix);
    }
    return SceneInput(groom);
}

SceneInput::SceneInput(const Groom& groom)
    : groom_(groom), bindings_(groom.rootBindings()), skinSpheres_(skinSpheresOf(groom)) {}

void SceneInput::setSpheres(std::vector<CollisionSphere> spheres, bool atRest) {
    groom_.spheres = std::move(spheres);
    skinSpheres_ = atRest ? skinSpheresOf(groom_) : runtime::Vector<std::uint8_t>();
}

runtime::StrandsView SceneInput::strands() const {
    return strandsAtRest(groom_);
}

std::vector<Eigen::Isometry3f> SceneInput::rootTransforms(const HeadPose& pose) const {
    if (bindings_.empty() || pose.scalpPositions_ws.empty())
        return std::vector<Eigen::Isometry3f>(groom_.strandCount(), pose.head_ws);
    return hairloom::rootTransforms(*groom_.scalp, pose.scalpPositions_ws, bindings_);
}

std::vector<runtime::RootFrame> SceneInput::rootsAt(const HeadPose& pose) const {
    const std::vector<Eigen::Isometry3f> transforms = rootTransforms(pose);
    std::vector<runtime::RootFrame> roots(transforms.size());
    for (std::size_t s = 0; s < roots.size(); ++s) {
        roots[s].position = toFloat3(transforms[s] * groom_.strand(s).front());
        roots[s].rotation = toQuat(Quatf(transforms[s].linear()));
    }
    return roots;
}

std::vector<runtime::Sphere> SceneInput::spheresAt(const HeadPose& pose) const {
    return hairloom::spheresAt(groom_.spheres, pose);
}

runtime::RootFrame SceneInput::headAt(const HeadPose& pose) const {
    const std::vector<Eigen::Isometry3f> transforms = rootTransforms(pose);
    // The chordal mean of rotations (Markley et al. 2007) for rotations that differ little: q and −q are one.
    const Quatf first(transforms.front().linear());
    Eigen::Vector4f sum = Eigen::Vector4f::Zero();
    Vec3f rest = Vec3f::Zero(), now = Vec3f::Zero();
    for (std::size_t s = 0; s < transforms.size(); ++s) {
        const Quatf q(transforms[s].linear());
        sum += q.dot(first) < 0 ? Eigen::Vector4f(-q.coeffs()) : q.coeffs();
        const Vec3f& root = groom_.strand(s).front();
        rest += root;
        now += transforms[s] * root;
    }
    const Quatf rotation = Quatf(sum).normalized();
    const float count = static_cast<float>(transforms.size());
    return {toFloat3(now / count - rotation * (rest / count)), toQuat(rotation)};
}

}  // namespace hairloom
