// SPDX-License-Identifier: MIT
#include "hairloom/alternatives/stick.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "models/alternatives/surroundings.h"

namespace hairloom::runtime {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

float wrapped(float angle) {
    return std::abs(angle) <= kPi ? angle : std::remainder(angle, 2.0f * kPi);
}

/// Turn of `angle` about an axis of unit length.
Quat turnAbout(Float3 axis, float angle) {
    const Float3 v = axis * std::sin(0.5f * angle);
    return {v.x, v.y, v.z, std::cos(0.5f * angle)};
}

/// Across v and the axis of the world that lies least along it.
Float3 anyAcross(Float3 v) {
    return cross(v, std::abs(v.x) < 0.7f ? Float3{1.0f, 0.0f, 0.0f} : Float3{0.0f, 1.0f, 0.0f});
}

/// (l/2) / (l²/3): angular acceleration per force, for a force at the middle of a stick.
float leverOf(const Stick& stick) {
    return 1.5f / stick.length;
}

/// Where θ moves the direction, per cosφ.
Float3 acrossMeridian(const Stick& stick, float theta) {
    return stick.side * std::cos(theta) - stick.along * std::sin(theta);
}

}  // namespace

Polar polarOf(const Stick& stick, const StickMotion& motion) {
    const float cosine = std::cos(motion.phi), sine = std::sin(motion.phi);
    const Float3 meridian = stick.along * std::cos(motion.theta) + stick.side * std::sin(motion.theta);
    return {meridian * cosine + stick.pole * sine, stick.pole * cosine - meridian * sine,
            stick.side * std::cos(motion.theta) - stick.along * std::sin(motion.theta)};
}

Stick makeStick(Float3 segment, Float3 up) {
    Stick stick;
    stick.length = length(segment);
    if (!(stick.length > kShortestStick)) return stick;
    stick.along = segment * (1.0f / stick.length);
    Float3 level = cross(stick.along, up);
    if (length(level) < 1e-3f) level = anyAcross(stick.along);
    stick.pole = level * (1.0f / length(level));
    stick.side = cross(stick.pole, stick.along);
    return stick;
}

void styleStick(Stick& stick, Float3 segment) {
    stick.thetaStyle = stick.phiStyle = 0.0f;
    const float size = length(segment);
    if (!(size > kShortestStick) || !(stick.length > kShortestStick)) return;
    stick.thetaStyle = std::clamp(std::atan2(dot(segment, stick.side), dot(segment, stick.along)),
                                  -kMostStyled, kMostStyled);
    stick.phiStyle = std::asin(std::clamp(dot(segment, stick.pole) / size, -1.0f, 1.0f));
}

void aimAgainst(Stick& stick, Float3 gravity) {
    stick.thetaAim = stick.thetaStyle;
    stick.phiAim = stick.phiStyle;
    if (!(stick.bend > 0.0f)) return;
    const StickMotion styled{stick.thetaStyle, stick.phiStyle, 0.0f, 0.0f, {}};
    const float lift = -leverOf(stick) / stick.bend;
    const float theta =
        lift * std::cos(stick.phiStyle) * dot(gravity, acrossMeridian(stick, stick.thetaStyle));
    const float phi = lift * dot(gravity, polarOf(stick, styled).byPhi);
    const float size = std::max(std::hypot(theta, phi), 1.0f);
    if (!std::isfinite(size)) return;
    stick.thetaAim += theta / size;
    stick.phiAim += phi / size;
}

/// Rünz 2012, Eq. 1, on a stick of inertia m l²/3: u_i = cosφ · l/2 is the lever's projection on the equator,
/// v_i = l/2.
void turnStick(const Stick& stick, StickMotion& motion, Quat frame, const StickForces& forces) {
    const float lever = leverOf(stick), h = forces.h;
    const float rateLimit = 0.5f * kPi / h;
    const float rub = stick.bend * forces.bendDampingTime;
    const float divisor =
        1.0f + h * (forces.dragRate + rub) + h * h * (stick.bend + lever * length(forces.force));
    const auto advance = [&](float& angle, float& rate, float aim, float torque, float frameTurn) {
        const float sum = rate * forces.decay + h * (torque - stick.bend * (angle - aim)) + rub * frameTurn;
        rate = std::clamp(sum / divisor, -rateLimit, rateLimit);
        angle = wrapped(angle + h * rate);
    };

    const Float3 turned = rotate(conjugate(frame), rotationVector(frame * conjugate(motion.frame)));
    const float thetaTurn = dot(turned, stick.pole);
    const float phiTurn = -dot(turned, acrossMeridian(stick, motion.theta));
    motion.theta = wrapped(motion.theta - thetaTurn);
    motion.phi = wrapped(motion.phi - phiTurn);
    motion.frame = frame;

    advance(motion.theta, motion.thetaRate, stick.thetaAim,
            lever * std::cos(motion.phi) * dot(forces.force, acrossMeridian(stick, motion.theta)), thetaTurn);
    const Float3 byPhi = polarOf(stick, motion).byPhi;
    advance(motion.phi, motion.phiRate, stick.phiAim, lever * dot(forces.force, byPhi), phiTurn);
}

std::optional<Float3> directionOut(Float3 direction, float l, Float3 centre, float reach) {
    const float distance = length(centre);
    if (!(distance < reach + l) || distance < kShortestStick) return std::nullopt;
    if (!(length(direction * l - centre) < reach)) return std::nullopt;
    const Float3 axis = centre * (1.0f / distance);
    Float3 sideways = direction - axis * dot(direction, axis);
    if (length(sideways) < 1e-6f) sideways = anyAcross(axis);
    sideways = sideways * (1.0f / length(sideways));
    const float cosine =
        std::clamp((distance * distance + l * l - reach * reach) / (2.0f * distance * l), -1.0f, 1.0f);
    return axis * cosine + sideways * std::sqrt(1.0f - cosine * cosine);
}

void pushOut(const Stick& stick, StickMotion& motion, Float3 centre, float reach) {
    const auto turned = directionOut(polarOf(stick, motion).direction, stick.length, centre, reach);
    if (!turned) return;
    const Float3 out = *turned;

    // Two pairs of angles name a direction; the nearer one is the way the stick turns.
    const float sine = std::clamp(dot(out, stick.pole), -1.0f, 1.0f);
    const bool atPole = 1.0f - std::abs(sine) < 1e-6f;
    float theta = atPole ? motion.theta : std::atan2(dot(out, stick.side), dot(out, stick.along));
    float phi = std::asin(sine);
    const auto away = [&](float t, float f) {
        return std::abs(wrapped(t - motion.theta)) + std::abs(wrapped(f - motion.phi));
    };
    if (!atPole && away(theta + kPi, kPi - phi) < away(theta, phi)) {
        theta = wrapped(theta + kPi);
        phi = wrapped(kPi - phi);
    }
    const float byTheta = wrapped(theta - motion.theta), byPhi = wrapped(phi - motion.phi);
    const float against = motion.thetaRate * byTheta + motion.phiRate * byPhi;
    const float squared = byTheta * byTheta + byPhi * byPhi;
    if (against < 0.0f && squared > 0.0f) {
        motion.thetaRate -= byTheta * against / squared;
        motion.phiRate -= byPhi * against / squared;
    }
    motion.theta = theta;
    motion.phi = phi;
}

void nudge(const Stick& stick, StickMotion& motion, Float3 shift, Float3 speed) {
    const Polar polar = polarOf(stick, motion);
    // Near a pole θ moves nothing, and takes no part.
    const float cosine = std::cos(motion.phi);
    const float byTheta = cosine / (std::max(cosine * cosine, 0.01f) * stick.length),
                byPhi = 1.0f / stick.length;
    const auto turn = [](float angle) { return std::clamp(angle, -0.5f, 0.5f); };
    motion.theta = wrapped(motion.theta + turn(dot(shift, polar.acrossMeridian) * byTheta));
    motion.phi = wrapped(motion.phi + turn(dot(shift, polar.byPhi) * byPhi));
    motion.thetaRate += dot(speed, polar.acrossMeridian) * byTheta;
    motion.phiRate += dot(speed, polar.byPhi) * byPhi;
}

Quat carriedFrame(const Stick& stick, const StickMotion& motion, Quat frame) {
    if (!(stick.length > kShortestStick)) return frame;
    frame = frame * turnAbout(stick.pole, motion.theta) * turnAbout(stick.side, -motion.phi);
    normalize(frame);
    return frame;
}

}  // namespace hairloom::runtime
