// SPDX-License-Identifier: MIT
// Where a frame has roots, spheres and skin, at its end and inside.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <tuple>

#include "play/c_words.h"
#include "play/frame_values.h"

namespace hairloom::runtime {

Outcome Instance::placeRoots(const hl_frame& frame) {
    const Matrix34 head = frame.head ? matrixAt(frame.head, 0) : kIdentity34;
    if (frame.roots) {
        if (frame.root_count != roots_.size()) return wrongSize("roots", frame.root_count, roots_.size());
        for (std::size_t s = 0; s < roots_.size(); ++s) {
            const float* root = frame.roots + 7 * s;
            roots_[s] = {{root[0], root[1], root[2]}, {root[3], root[4], root[5], root[6]}};
        }
        return std::nullopt;
    }
    if (frame.scalp) {
        if (frame.scalp_count != poses_.scalpVertexCount())
            return wrongSize("scalp vertices", frame.scalp_count, poses_.scalpVertexCount());
        if (!poses_.hasScalp()) return Refusal{HL_BAD_VALUE, "the asset's roots stand on no scalp"};
        poses_.followScalp({frame.scalp, 3 * frame.scalp_count}, roots_);
        return std::nullopt;
    }
    if (frame.bones) {
        if (frame.bone_count != poses_.boneCount())
            return wrongSize("bones", frame.bone_count, poses_.boneCount());
        if (poses_.hasScalp()) {
            poses_.followBones({frame.bones, 12 * frame.bone_count}, head, roots_);
            return std::nullopt;
        }
    }
    poses_.followHead(head, roots_);
    return std::nullopt;
}

Outcome Instance::placeSpheres(const hl_frame& frame, FrameInput& input) {
    if (frame.spheres) {
        if (frame.sphere_count > kMaxGivenSpheres)
            return wrongSize("spheres", frame.sphere_count, kMaxGivenSpheres);
        if (spheres_.size() < frame.sphere_count) spheres_.resize(frame.sphere_count);
        for (std::size_t s = 0; s < frame.sphere_count; ++s) {
            const float* sphere = frame.spheres + 4 * s;
            spheres_[s] = {{sphere[0], sphere[1], sphere[2]}, sphere[3]};
        }
        input.spheres = std::span(spheres_).first(frame.sphere_count);
        return placeCapsules(frame, input);
    }
    const Matrix34 head = frame.head ? matrixAt(frame.head, 0) : kIdentity34;
    for (std::size_t s = 0; s < restSpheres_.size(); ++s) {
        const asset::Sphere& sphere = restSpheres_[s];
        const bool boned = frame.bones && sphere.bone >= 0;
        const Matrix34 matrix = boned ? matrixAt(frame.bones, static_cast<std::size_t>(sphere.bone)) : head;
        spheres_[s] = {transform(matrix, {sphere.centre[0], sphere.centre[1], sphere.centre[2]}),
                       sphere.radius};
    }
    input.spheres = std::span(spheres_).first(restSpheres_.size());
    input.capsules = restCapsules_;
    return std::nullopt;
}

Outcome Instance::placeCapsules(const hl_frame& frame, FrameInput& input) {
    if (!frame.capsules) return std::nullopt;
    if (frame.capsule_count > kMaxCapsules) return wrongSize("capsules", frame.capsule_count, kMaxCapsules);
    capsules_.clear();
    for (std::size_t c = 0; c < frame.capsule_count; ++c) {
        const Capsule capsule{frame.capsules[2 * c], frame.capsules[2 * c + 1]};
        const std::uint32_t farther = std::max(capsule.first, capsule.second);
        if (farther >= frame.sphere_count)
            return Refusal{HL_BAD_VALUE, "capsule " + std::to_string(c) + " ends at sphere " +
                                             std::to_string(farther) + " of " +
                                             std::to_string(frame.sphere_count)};
        if (capsule.first == capsule.second)
            return Refusal{HL_BAD_VALUE, "capsule " + std::to_string(c) + " joins sphere " +
                                             std::to_string(farther) + " with itself; expected two spheres"};
        capsules_.push_back(capsule);
    }
    input.capsules = capsules_;
    return std::nullopt;
}

/// Roots alone do not say where the skin is: it stays where it was.
void Instance::placeBody(const hl_frame& frame, FrameInput& input) {
    if (!body_) return;
    const auto poseOf = [](const Matrix34& m) {
        return BonePose{{m[0], m[4], m[8]}, {m[1], m[5], m[9]}, {m[2], m[6], m[10]}, {m[3], m[7], m[11]}};
    };
    if (frame.bones && !bodyBones_.empty()) {
        for (std::size_t b = 0; b < bodyBones_.size(); ++b)
            bodyPose_[b] = poseOf(matrixAt(frame.bones, bodyBones_[b]));
        input.body_ws = bodyPose_;
    } else if (frame.head || !(frame.roots || frame.scalp)) {
        bodyPose_[0] = poseOf(frame.head ? matrixAt(frame.head, 0) : kIdentity34);
        input.body_ws = std::span(bodyPose_).first(1);
    }
}

Outcome Instance::place(const hl_frame& frame, FrameInput& input) {
    if (frame.bones && frame.bone_count != poses_.boneCount())
        return wrongSize("bones", frame.bone_count, poses_.boneCount());
    if (Outcome refused = checkInner(frame)) return refused;
    // Last, since it is what read-outs look at: nothing is refused any more once it has begun to write. Poses
    // inside have as many roots as the frame, so the first of them refuses what it would.
    if (Outcome refused = placeSpheres(frame, input)) return refused;
    if (Outcome refused = placeInner(frame, input)) return refused;
    if (Outcome refused = placeRoots(frame)) return refused;
    rootsKnown_ = true;
    placeBody(frame, input);
    input.dt = frame.dt;
    input.time = frame.time;
    input.roots_ws = roots_;
    if (frame.wind) input.wind_ws = float3At(frame.wind, 0);
    input.origin_ws = {frame.origin[0], frame.origin[1], frame.origin[2]};
    input.cut = frame.cut == 1;
    return std::nullopt;
}

namespace {

/// The frame with what the pose has in place of its own.
hl_frame frameAtPose(const hl_frame& frame, const hl_pose& pose) {
    hl_frame at = frame;
    at.head = pose.head;
    at.bones = pose.bones;
    at.scalp = pose.scalp;
    at.roots = pose.roots;
    at.spheres = pose.spheres;
    return at;
}

hl_pose innerPoseAt(const hl_frame& frame, std::size_t index) {
    const std::size_t stride = frame.inner->size;
    hl_pose pose{};
    std::memcpy(&pose, reinterpret_cast<const char*>(frame.inner) + index * stride,
                std::min(stride, sizeof pose));
    return pose;
}

}  // namespace

Outcome Instance::checkInner(const hl_frame& frame) const {
    if (frame.cut > 1)
        return Refusal{HL_BAD_VALUE, "cut is " + std::to_string(frame.cut) + "; expected 0 or 1"};
    if (frame.inner_count == 0) return std::nullopt;
    if (!frame.inner)
        return Refusal{HL_BAD_VALUE, "there are no poses inside the frame; inner_count says " +
                                         std::to_string(frame.inner_count)};
    if (frame.inner_count > kMaxInnerPoses)
        return Refusal{HL_WRONG_SIZE, std::to_string(frame.inner_count) +
                                          " poses inside the frame; expected at most " +
                                          std::to_string(kMaxInnerPoses)};
    if (Outcome refused = checkSize<hl_pose>("hl_pose", frame.inner->size, kFirstPose)) return refused;
    if (frame.inner->size % alignof(hl_pose) != 0)
        return Refusal{HL_WRONG_SIZE, "poses inside the frame that are not at multiples of 8 bytes"};
    const hl_pose own{sizeof(hl_pose), frame.head, frame.bones, frame.scalp, frame.roots, frame.spheres};
    for (std::size_t i = 0; i < frame.inner_count; ++i) {
        // Words are made where they are needed: they take memory.
        const auto name = [&] {
            return "pose " + std::to_string(i + 1) + " of " + std::to_string(frame.inner_count) +
                   " inside the frame";
        };
        const hl_pose pose = innerPoseAt(frame, i);
        if (pose.size != frame.inner->size)
            return Refusal{HL_WRONG_SIZE, name() + " says that it has " + std::to_string(pose.size) +
                                              " bytes; expected " + std::to_string(frame.inner->size) +
                                              ", as the first"};
        const char* const bytes = reinterpret_cast<const char*>(frame.inner) + i * pose.size;
        if (pose.size > sizeof pose &&
            std::any_of(bytes + sizeof pose, bytes + pose.size, [](char byte) { return byte != 0; }))
            return Refusal{HL_NEWER, name() + " asks for what this library does not know"};
        const auto differs = [&](const char* what, const float* given, const float* ofFrame) -> Outcome {
            if ((given != nullptr) == (ofFrame != nullptr)) return std::nullopt;
            return Refusal{HL_BAD_VALUE, name() + (given ? " has " : " has no ") + what +
                                             (given ? ", which the frame has not" : ", which the frame has")};
        };
        for (const auto& [what, given, ofFrame] :
             {std::tuple{"head", pose.head, own.head}, std::tuple{"bones", pose.bones, own.bones},
              std::tuple{"scalp", pose.scalp, own.scalp}, std::tuple{"roots", pose.roots, own.roots},
              std::tuple{"spheres", pose.spheres, own.spheres}}) {
            if (Outcome refused = differs(what, given, ofFrame)) return refused;
        }
        const auto isFinite = [](const float* matrices, std::size_t count) {
            return !matrices ||
                   std::all_of(matrices, matrices + 12 * count, [](float v) { return std::isfinite(v); });
        };
        if (!isFinite(pose.head, 1) || !isFinite(pose.bones, frame.bone_count))
            return Refusal{HL_BAD_VALUE, name() + " has a matrix that is not finite"};
    }
    return std::nullopt;
}

/// Roots, spheres and skin of each pose, next to each other; then the frame's spheres once more.
Outcome Instance::placeInner(const hl_frame& frame, FrameInput& input) {
    inner_.poses.clear();
    inner_.roots.clear();
    inner_.spheres.clear();
    inner_.body.clear();
    if (frame.inner_count == 0) return std::nullopt;
    const std::size_t spheres = input.spheres.size();
    // What may fail comes before anything is written: memory.
    inner_.poses.reserve(frame.inner_count);
    inner_.roots.reserve(frame.inner_count * roots_.size());
    inner_.spheres.reserve(frame.inner_count * spheres);
    inner_.body.reserve(frame.inner_count * bodyPose_.size());
    std::size_t bones = 0;
    for (std::size_t i = 0; i < frame.inner_count; ++i) {
        const hl_frame at = frameAtPose(frame, innerPoseAt(frame, i));
        FrameInput placed;
        if (Outcome refused = placeRoots(at)) return refused;
        if (Outcome refused = placeSpheres(at, placed)) return refused;
        placeBody(at, placed);
        bones = placed.body_ws.size();
        inner_.roots.insert(inner_.roots.end(), roots_.begin(), roots_.end());
        inner_.spheres.insert(inner_.spheres.end(), placed.spheres.begin(), placed.spheres.end());
        inner_.body.insert(inner_.body.end(), placed.body_ws.begin(), placed.body_ws.end());
    }
    for (std::size_t i = 0; i < frame.inner_count; ++i) {
        inner_.poses.push_back(
            {std::span<const RootFrame>(inner_.roots).subspan(i * roots_.size(), roots_.size()),
             std::span<const Sphere>(inner_.spheres).subspan(i * spheres, spheres),
             std::span<const BonePose>(inner_.body).subspan(i * bones, bones)});
    }
    input.inner = inner_.poses;
    return placeSpheres(frame, input);
}

bool Instance::innerAsBefore(const hl_frame& frame) const {
    const auto same = [](const float* given, const auto& known) {
        return std::memcmp(given, known.data(), known.size() * sizeof(float)) == 0;
    };
    for (std::size_t i = 0; i < frame.inner_count; ++i) {
        const hl_pose pose = innerPoseAt(frame, i);
        if (!same(pose.head ? pose.head : kIdentity34.data(), last_.head)) return false;
        if (pose.bones && !same(pose.bones, last_.bones)) return false;
    }
    return true;
}

}  // namespace hairloom::runtime
