// SPDX-License-Identifier: MIT
#pragma once
// One stiff stick in polar coordinates about the frame that its parent carries, as ProjectiveEquations uses
// it.

#include <optional>

#include "hairloom/math.h"

namespace hairloom::runtime {

inline constexpr float kShortestStick = 1e-9f;  ///< metres; what is shorter has no direction

/// A segment as authored, in the rest frame of its strand's root.
struct Stick {
    Float3 along, side, pole;  ///< right-handed: rest direction, θ towards side, φ towards pole
    float length = 0.0f;       ///< metres
    float bend = 0.0f;         ///< restoring angular acceleration per angle, 1/s²
    float thetaStyle = 0.0f, phiStyle = 0.0f;  ///< angles of the shape that it is to have; 0: as authored
    float thetaAim = 0.0f, phiAim = 0.0f;      ///< angles to which the restoring torque alone would take it
    bool fixed = false;                        ///< keeps its rest direction in its parent's frame
};

struct StickMotion {
    float theta = 0.0f, phi = 0.0f;          ///< radians, −π…π
    float thetaRate = 0.0f, phiRate = 0.0f;  ///< radians per second, against directions of the world
    Quat frame;                              ///< of the parent, in the world, at the last substep's end
};

/// What the polar angles mean in the parent's frame: the direction, its derivative by φ, and its derivative
/// by θ over cosφ. Unit vectors.
struct Polar {
    Float3 direction, byPhi, acrossMeridian;
};
Polar polarOf(const Stick& stick, const StickMotion& motion);

/// A stick along `segment`, its pole across both the segment and `up`; all in the root's rest frame. The pole
/// of upright hair is any direction across it.
Stick makeStick(Float3 segment, Float3 up);

/// The angles of `segment`, in the parent's frame, as thetaStyle and phiStyle; of at most kMostStyled.
void styleStick(Stick& stick, Float3 segment);
inline constexpr float kMostStyled = 2.0f;  ///< radians from the authored shape

/// Aims beyond the angles of the style, by at most one radian, so that it hangs in `gravity` (m/s², in the
/// parent's frame in that shape).
void aimAgainst(Stick& stick, Float3 gravity);

/// What acts on a stick within one substep.
struct StickForces {
    Float3 force;           ///< m/s², in the parent's frame, at the stick's middle
    float dragRate = 0.0f;  ///< 1/s, at which the air takes up the stick's own turning
    float decay = 1.0f;     ///< share of its rate that damping leaves
    float bendDampingTime = 0.0f;
    float h = 0.0f;  ///< seconds
};
/// Follows the parent's frame from motion.frame to `frame` without turning in the world, then turns by
/// torque.
void turnStick(const Stick& stick, StickMotion& motion, Quat frame, const StickForces& forces);

/// Where a stick of that direction (of unit length) and length has to point for its tip to be at `reach` from
/// `centre`, which is measured from its joint: in the plane of joint, centre and tip. Nothing where the tip
/// is as far already. A stick whose whole reach lies inside points away from the centre.
std::optional<Float3> directionOut(Float3 direction, float length, Float3 centre, float reach);

/// Turns a stick whose tip is nearer than `reach` to `centre` (from the joint, in the parent's frame) about
/// its joint, in the plane of joint, centre and tip, until the tip is at that distance.
void pushOut(const Stick& stick, StickMotion& motion, Float3 centre, float reach);

/// Turns a stick so that its tip moves by the part of `shift` (metres) across the stick, by at most half a
/// radian in each angle, and by as much of `speed` (m/s) from then on; both in the parent's frame.
void nudge(const Stick& stick, StickMotion& motion, Float3 shift, Float3 speed);

/// The frame that the stick hands to its child.
Quat carriedFrame(const Stick& stick, const StickMotion& motion, Quat frame);

}  // namespace hairloom::runtime
