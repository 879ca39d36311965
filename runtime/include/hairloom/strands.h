// SPDX-License-Identifier: MIT
#pragma once
// What the engine is given: strands at rest once, poses of their roots and spheres each frame. Views only;
// the caller owns the arrays and the engine keeps none of them.

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "hairloom/body_field.h"
#include "hairloom/math.h"

namespace hairloom::runtime {

/// A position and an orientation.
struct RootFrame {
    Float3 position;
    Quat rotation;  ///< need not be exactly of unit length
};

/// The most of StrandsView::stiffness.
inline constexpr float kMostStiffness = 1000.0f;

/// Strands as authored, root to tip. Strand s owns points offsets[s] up to offsets[s + 1], 2 to kMaxPoints of
/// them.
struct StrandsView {
    std::span<const std::uint32_t>
        offsets;  ///< strand count + 1, ascending, from 0 to restPositions_ss.size()
    std::span<const Float3> restPositions_ss;  ///< metres, in the scalp's rest space
    /// Orientation of the scalp at each root in the rest pose; empty stands for the identity. A frame's root
    /// rotation divided by it is what turns the rest shape.
    std::span<const Quat> rootRotations_ss{};
    /// Mass of each point, above 0, in any unit: only the ratios within a strand count. Empty: even rods.
    std::span<const float> masses{};
    /// Of each strand, 0 … kMostStiffness: times the bending and torsional stiffness that settings say. 0 is
    /// limp. Hair that holds its shape against its weight (restGravity) stays as stiff as that takes. Empty:
    /// 1 everywhere.
    std::span<const float> stiffness{};
};

/// Another shape of the strands, for them to follow (Engine::setPoses()).
struct PoseView {
    /// Of each point; metres, in the scalp's rest space, as StrandsView::restPositions_ss. Only the
    /// directions of segments count: a pose has the roots and the lengths of the strands.
    std::span<const Float3> positions_ss;
    /// Of each point, 0 … 1: its share of the amount. Empty: 1 everywhere.
    std::span<const float> weights{};
};
inline constexpr std::size_t kMaxPoses = 16;

inline constexpr std::uint32_t kMaxPoints = 512;
inline constexpr std::size_t kMaxCapsules = 256;
inline constexpr std::size_t kMaxInnerPoses = 15;

/// A collision sphere. A radius that is not above 0, or anything not finite, takes it out of the frame.
struct Sphere {
    Float3 center_ws;
    float radius = 0.0f;  ///< metres
};

/// A tapered capsule: the hull of two spheres of a frame, by their numbers. One whose sphere is left out, or
/// that joins a sphere with itself, is left out.
struct Capsule {
    std::uint32_t first, second;
};

/// Where roots and colliders are at a time within a frame; metres, from the frame's origin.
struct InnerPose {
    std::span<const RootFrame> roots_ws;  ///< one per strand
    /// As many as the frame has. If a pose has another number, all spheres go straight through the frame.
    std::span<const Sphere> spheres = {};
    std::span<const BonePose> body_ws = {};  ///< likewise
};

/// Everything that changes from frame to frame.
struct FrameInput {
    float dt = 1.0f / 60.0f;              ///< frame time in seconds, above 0
    double time = 0.0;                    ///< seconds at the end of the frame; drives gusts only
    std::span<const RootFrame> roots_ws;  ///< one per strand, at the end of the frame
    /// At the end of the frame; sphere i is the sphere i of the frame before, and its speed follows from
    /// that.
    std::span<const Sphere> spheres = {};
    std::span<const Capsule> capsules = {};  ///< between spheres of this frame; at most kMaxCapsules count
    std::optional<Float3> wind_ws = {};      ///< m/s, a script's mean wind of this frame, in place of the
                                             ///< authored one; ignored unless finite and within 1000 m/s
    /// m/s, of an actor that the caller does not move in world space; WindKind::vehicle blows against it.
    /// Ignored unless finite and within 1000 m/s.
    Float3 actorVelocity_ws{};
    /// Metres, in the world: where roots, spheres and what is read are measured from, so that hair moves
    /// alike wherever a character stands. Another origin than in the frame before changes the numbers and
    /// moves nothing; one that is not finite is that of the frame before. Roots of reset() are measured from
    /// the origin of the frame that follows.
    std::array<double, 3> origin_ws{};
    /// Of the engine's body at the end of the frame, one per bone of its field or one alone for all; its
    /// speed follows from the frame before. Empty, of another size or not finite: the body stays where it
    /// was, and is nowhere before the first.
    std::span<const BonePose> body_ws = {};
    /// Poses on the way, at equal shares of dt: three are those at the quarters of the frame. At most
    /// kMaxInnerPoses. Substeps see the motion through them; without, everything goes straight to the end of
    /// the frame. teleportDistance then counts from pose to pose, and hair beside a body may take more
    /// substeps where a part of the frame is fast. Not seen by alternatives/, nor by an engine on a GPU whose
    /// roots are found there.
    std::span<const InnerPose> inner = {};
    /// Of each of the engine's poses from this frame on, 0 … 1: how far strands follow it. At 0 they are
    /// simulated alone, at 1 they stand in the pose but for what they collide with. Empty or of another size:
    /// they stay; so does one that is not finite, and others are cut to the range.
    std::span<const float> poseAmounts = {};
    /// The frame does not continue from the one before: roots, spheres and body jump to its first pose, or to
    /// that at the first substep's end if it is later, however near, and take the hair along rigidly with its
    /// velocities turned. Engine::reset() instead puts hair at rest.
    bool cut = false;
};

}  // namespace hairloom::runtime
