// SPDX-License-Identifier: MIT
// Memory ahead of time: an instance is taken through what its frames may do, and put back.

#include <algorithm>

#include "engine/state.h"
#include "play/instance.h"

namespace hairloom::runtime {
namespace {

constexpr float kRehearsedRadius = 0.01f;  ///< m, of spheres at the roots: within reach of every strand
constexpr float kRehearsedWind = 1;        ///< m/s

/// Frames in still air and in wind, without spheres and among as many as there may be, in poses where they
/// will be followed.
void rehearse(Engine& engine, std::span<const RootFrame> roots, std::span<const Sphere> spheres,
              bool followsPoses) {
    const std::shared_ptr<const State> before = engine.state();
    const Vector<float> amounts(engine.poseAmounts().begin(), engine.poseAmounts().end());
    // With as many capsules as spheres.
    Vector<Capsule> capsules;
    for (std::uint32_t s = 1; s < spheres.size() && capsules.size() < kMaxCapsules; ++s)
        capsules.push_back({s - 1, s});
    engine.keepMemory();
    if (followsPoses) engine.setPoseAmounts(Vector<float>(amounts.size(), 1.0f));
    engine.reset(roots);
    for (const float wind : {0.0f, kRehearsedWind}) {
        for (const std::size_t count : {std::size_t{0}, spheres.size()}) {
            FrameInput input;
            input.roots_ws = roots;
            input.wind_ws = Float3{wind, 0, 0};
            input.spheres = spheres.first(count);
            engine.step(input);
            input.capsules = std::span(capsules).first(count > 0 ? capsules.size() : 0);
            if (!input.capsules.empty()) engine.step(input);
            const InnerPose inside{roots, input.spheres};
            input.inner = {&inside, 1};
            engine.step(input);
        }
    }
    engine.setPoseAmounts(amounts);
    engine.setState(*before);
}

}  // namespace

Outcome Instance::reserve(const hl_reserve& wanted) {
    if (wanted.spheres > kMaxGivenSpheres)
        return Refusal{HL_BAD_VALUE, "reserve.spheres is " + std::to_string(wanted.spheres) +
                                         "; expected 0 to " + std::to_string(kMaxGivenSpheres)};
    if (wanted.previous_guides > 1 || wanted.previous_hairs > 1)
        return Refusal{HL_BAD_VALUE, "reserve.previous_guides and previous_hairs are 0 or 1"};
    if (wanted.poses > 1) return Refusal{HL_BAD_VALUE, "reserve.poses is 0 or 1"};
    if (wanted.inner > kMaxInnerPoses)
        return Refusal{HL_BAD_VALUE, "reserve.inner is " + std::to_string(wanted.inner) + "; expected 0 to " +
                                         std::to_string(kMaxInnerPoses)};
    // In a copy: where memory ends in the middle, this one is as it was.
    Instance grown(*this);
    grown.grow(wanted);
    *this = std::move(grown);
    return std::nullopt;
}

void Instance::grow(const hl_reserve& wanted) {
    Vector<RootFrame> roots(roots_.size()), fewer;
    poses_.followHead(kIdentity34, roots);
    const std::size_t count = std::max<std::size_t>(wanted.spheres, restSpheres_.size());
    if (spheres_.size() < count) spheres_.resize(count);
    capsules_.reserve(kMaxCapsules);
    Vector<Sphere> spheres(count);
    for (std::size_t s = 0; s < count; ++s)
        spheres[s] = {roots.empty() ? Float3{} : roots[s % roots.size()].position, kRehearsedRadius};
    rehearse(engine_, roots, spheres, wanted.poses > 0);
    for (std::size_t i = 0; levels_ && i < levels_->engines.size(); ++i) {
        fewer.clear();
        for (const std::uint32_t guide : levels_->set->coarser[i].guides) fewer.push_back(roots[guide]);
        rehearse(levels_->engines[i], fewer, spheres, wanted.poses > 0);
    }
    engine_.setSkinSpheres(skinSpheres_);
    for (std::size_t i = 0; levels_ && i < levels_->engines.size(); ++i)
        levels_->engines[i].setSkinSpheres(skinSpheres_);
    hairPoses_.isReserved = hairPoses_.isReserved || wanted.poses > 0;
    last_.bones.reserve(12 * poses_.boneCount());
    if (wanted.inner > 0) {
        const std::size_t poses = wanted.inner;
        inner_.poses.reserve(poses);
        inner_.roots.reserve(poses * roots_.size());
        if (levels_) inner_.simulatedRoots.reserve(poses * levels_->simulatedRoots.size());
        inner_.spheres.reserve(poses * count);
        inner_.body.reserve(poses * bodyPose_.size());
    }
    if (wanted.previous_guides > 0) shown_[0].positions.reserve(positions_.size());
    if (wanted.previous_hairs > 0 && hairs_)
        shown_[1].positions.reserve(std::size_t{hairs_->hairCount()} * hairs_->pointsPerHair());
}

}  // namespace hairloom::runtime
