// SPDX-License-Identifier: MIT
#include "hairloom/alternatives/projective_equations.h"

#include <algorithm>
#include <cmath>

#include "engine/checks.h"
#include "engine/in_parallel.h"
#include "models/alternatives/surroundings.h"

namespace hairloom::runtime {
namespace {

constexpr float kRigid = 1e12f;  // 1/s²; a stiffer joint does not move
constexpr std::size_t kStrandsPerJob = 16;
constexpr float kSameRoot = 1e-5f;    // metres
constexpr float kSameLength = 1e-3f;  // of a stick

}  // namespace

/// What all sticks of a strand share in one substep.
struct ProjectiveEquations::Substep {
    RootFrame root;          ///< at the end of the substep
    Float3 rootVelocity;     ///< m/s
    Float3 pull;             ///< gravity less the acceleration of the root
    Float3 airRoot, airTip;  ///< m/s
    float share;             ///< of the frame, at the end of the substep
    float pushed;            ///< share of what pushes it out of other hair in the frame
    float braked;            ///< likewise of what takes it out of its way
    float h;                 ///< seconds
    float decay;             ///< share of its rate that damping leaves a stick
};

ProjectiveEquations::Result ProjectiveEquations::make(const StrandsView& strands,
                                                      const SimulationSettings& settings, Host host) {
    if (std::string error = validationError(settings); !error.empty())
        return {std::nullopt, std::move(error)};
    if (std::string error = validationError(strands); !error.empty()) return {std::nullopt, std::move(error)};
    ProjectiveEquations made;
    made.host_ = std::move(host);
    made.offsets_.assign(strands.offsets.begin(), strands.offsets.end());
    made.rest_.assign(strands.restPositions_ss.begin(), strands.restPositions_ss.end());
    const std::size_t points = strands.restPositions_ss.size();
    made.sticks_.resize(points);
    made.motions_.resize(points);
    made.positions_.resize(points);
    made.velocities_.resize(points);
    const std::vector<RootFrame> roots = rootsAtRest(strands);
    made.roots_.resize(roots.size());
    for (std::size_t s = 0; s < roots.size(); ++s) {
        made.roots_[s].rest = roots[s];
        if (!strands.stiffness.empty()) made.roots_[s].stiffness = strands.stiffness[s];
        const Quat toRoot = conjugate(roots[s].rotation);
        const Float3 up = rotate(toRoot, {0.0f, 1.0f, 0.0f});
        for (std::uint32_t p = strands.offsets[s] + 1; p < strands.offsets[s + 1]; ++p) {
            made.sticks_[p] =
                makeStick(rotate(toRoot, strands.restPositions_ss[p] - strands.restPositions_ss[p - 1]), up);
        }
    }
    made.setSettings(settings);
    made.reset(roots);
    return {std::move(made), {}};
}

std::string ProjectiveEquations::setSettings(const SimulationSettings& settings) {
    if (std::string error = validationError(settings); !error.empty()) return error;
    const bool met = settings_.hairHair;
    const float reach = settings_.hairHairCell;
    settings_ = settings;
    wind_ = makeWind(settings);
    if (!settings.hairHair) {
        near_ = {};
        starts_ws_ = {};
    } else if (!met || reach != settings.hairHairCell) {
        near_.make({offsets_, rest_}, settings.hairHairCell);
        starts_ws_.resize(rest_.size());
    }
    fillSticks();
    return {};
}

std::string ProjectiveEquations::setStyle(std::span<const Float3> restPositions_ss) {
    if (restPositions_ss.empty()) {
        styles_ = {};
        fillSticks();
        return {};
    }
    if (restPositions_ss.size() != rest_.size())
        return "the style has " + std::to_string(restPositions_ss.size()) + " points; expected " +
               std::to_string(rest_.size());
    for (std::size_t p = 0; p < rest_.size(); ++p) {
        if (!isFinite(restPositions_ss[p]))
            return "point " + std::to_string(p) + " of the style is no number; expected metres";
    }
    for (std::size_t s = 0; s < roots_.size(); ++s) {
        if (length(restPositions_ss[offsets_[s]] - rest_[offsets_[s]]) > kSameRoot)
            return "strand " + std::to_string(s) +
                   " of the style grows elsewhere; expected the roots of the strands";
        for (std::uint32_t p = offsets_[s] + 1; p < offsets_[s + 1]; ++p) {
            const float wanted = length(restPositions_ss[p] - restPositions_ss[p - 1]);
            if (std::abs(wanted - sticks_[p].length) > kSameRoot + kSameLength * sticks_[p].length)
                return "segment " + std::to_string(p - offsets_[s]) + " of strand " + std::to_string(s) +
                       " is " + std::to_string(wanted) + " m long in the style; expected " +
                       std::to_string(sticks_[p].length) + ", as sticks keep their length";
        }
    }
    styles_.resize(rest_.size());
    for (std::size_t s = 0; s < roots_.size(); ++s) {
        const Quat toRoot = conjugate(roots_[s].rest.rotation);
        for (std::uint32_t p = offsets_[s] + 1; p < offsets_[s + 1]; ++p)
            styles_[p] = rotate(toRoot, restPositions_ss[p] - restPositions_ss[p - 1]);
    }
    fillSticks();
    return {};
}

/// The stiffness of docs/engine.md on a stick's moment of inertia: κ/I = 3 B/(l̄ l³); and where the torque has
/// to aim for the authored shape to hang in restGravity.
void ProjectiveEquations::fillSticks() {
    for (std::size_t s = 0; s < roots_.size(); ++s) {
        const Float3 gravity = rotate(conjugate(roots_[s].rest.rotation), settings_.gravity);
        const std::uint32_t root = offsets_[s], segments = offsets_[s + 1] - root - 1;
        Quat frame;  // of the stick's parent in the style, against the root
        for (std::uint32_t j = 0; j < segments; ++j) {
            Stick& stick = sticks_[root + j + 1];
            const float l = stick.length;
            const float along = static_cast<float>(j) / static_cast<float>(segments);
            const float inner = j >= settings_.clampedPoints ? sticks_[root + j].length : 0.0f;
            const double rod = rodStiffness(settings_, along, roots_[s].stiffness);
            const double slope = rod > 0.0 ? 3.0 * rod / (0.5 * (l + inner) * std::pow(l, 3.0)) : 0.0;
            stick.fixed = j + 1 < settings_.clampedPoints || !(slope < static_cast<double>(kRigid));
            stick.bend = stick.fixed ? 0.0f : static_cast<float>(slope);
            const Quat toFrame = conjugate(frame);
            styleStick(stick,
                       stick.fixed || styles_.empty() ? Float3{} : rotate(toFrame, styles_[root + j + 1]));
            aimAgainst(stick, rotate(toFrame, gravity) * settings_.restGravity);
            const StickMotion styled{stick.thetaStyle, stick.phiStyle, 0.0f, 0.0f, {}};
            if (!styles_.empty()) frame = carriedFrame(stick, styled, frame);
        }
    }
}

bool ProjectiveEquations::reset(std::span<const RootFrame> roots_ws) {
    if (roots_ws.size() != strandCount()) return false;
    spheres_.forget();
    for (std::uint32_t s = 0; s < strandCount(); ++s) {
        Root& root = roots_[s];
        root.now = roots_ws[s];
        if (!usableWithin(root.now, kFarthest)) root.now = root.rest;
        root.velocity = {};
        for (std::uint32_t p = offsets_[s]; p < offsets_[s + 1]; ++p) {
            motions_[p] = {};
            motions_[p].frame = root.now.rotation;
            velocities_[p] = {};
            if (p == offsets_[s]) continue;
            positions_[p] =
                positions_[p - 1] + rotate(root.now.rotation, sticks_[p].along) * sticks_[p].length;
        }
    }
    return true;
}

bool ProjectiveEquations::step(const FrameInput& input) {
    if (input.roots_ws.size() != strandCount()) return false;
    if (!(input.dt > 0.0f) || !std::isfinite(input.dt)) return true;
    spheres_.take(input, settings_.teleportDistance);
    const WindyFrame frame(wind_, input);
    if (settings_.hairHair) findNearHair();
    const auto strands = [&](std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) runStrand(static_cast<std::uint32_t>(s), frame);
    };
    inParallel(host_, strandCount(), kStrandsPerJob, strands);
    return true;
}

void ProjectiveEquations::findNearHair() {
    for (std::size_t s = 0; s < roots_.size(); ++s) {
        for (std::uint32_t p = offsets_[s]; p < offsets_[s + 1]; ++p)
            starts_ws_[p] = roots_[s].now.position + positions_[p];
    }
    near_.find(starts_ws_, velocities_, host_);
}

void ProjectiveEquations::runStrand(std::uint32_t strand, const WindyFrame& frame) {
    Root& root = roots_[strand];
    const float dt = std::min(frame.input.dt, kLongestFrame);
    const RootPath path(root.now, root.velocity, frame.input.roots_ws[strand], dt,
                        settings_.teleportDistance);
    if (path.jumps) {
        for (std::uint32_t p = offsets_[strand]; p < offsets_[strand + 1]; ++p) {
            motions_[p].frame = path.turn * motions_[p].frame;
            positions_[p] = rotate(path.turn, positions_[p]);
        }
    }

    const AirPath air(wind_, frame, path, positions_[offsets_[strand + 1] - 1]);
    const std::uint32_t substeps = substepsIn(settings_, dt);
    const float count = static_cast<float>(substeps), h = dt / count;
    const float decay = settings_.dampingTime > 0.0f ? std::exp(-h / settings_.dampingTime) : 1.0f;
    // Where the root jumps, the hair around it was elsewhere.
    const float pushed = settings_.hairHair && !path.jumps ? settings_.hairHairStrength : 0.0f;
    for (std::uint32_t i = 0; i < substeps; ++i) {
        const float share = static_cast<float>(i + 1) / count;
        runSubstep(strand, {between(path.from, path.to, share), root.velocity,
                            settings_.gravity - path.acceleration, air.atRoot(share), air.atTip(share), share,
                            pushed / count, i == 0 ? pushed : 0.0f, h, decay});
    }
}

/// From root to tip; each stick finds its parent's frame already at the end of the substep.
void ProjectiveEquations::runSubstep(std::uint32_t strand, const Substep& substep) {
    const std::uint32_t root = offsets_[strand], end = offsets_[strand + 1];
    velocities_[root] = substep.rootVelocity;
    Quat frame = substep.root.rotation;
    NearSticks::Away carried;
    for (std::uint32_t p = root + 1; p < end; ++p) {
        const Stick& stick = sticks_[p];
        StickMotion& motion = motions_[p];
        const float along = static_cast<float>(p - root) / static_cast<float>(end - root - 1);
        if (stick.fixed || !(stick.length > kShortestStick)) {
            motion = {};
            motion.frame = frame;
        } else {
            turnStick(stick, motion, frame, forcesOn(p, frame, along, substep));
            if (substep.pushed > 0.0f) keepApart(p, frame, substep, carried);
            collide(p, frame, along, substep);
        }
        const Float3 position =
            positions_[p - 1] + rotate(frame, polarOf(stick, motion).direction) * stick.length;
        velocities_[p] =
            substep.rootVelocity + bounded((position - positions_[p]) * (1.0f / substep.h), kFastest);
        positions_[p] = position;
        frame = carriedFrame(stick, motion, frame);
    }
}

/// Air: Rünz 2012, Section 3.3, at the stick's middle. What the stick's own turning adds to the flow is left
/// to turnStick, which takes it implicitly.
StickForces ProjectiveEquations::forcesOn(std::uint32_t point, Quat frame, float along,
                                          const Substep& substep) const {
    const Stick& stick = sticks_[point];
    const StickMotion& motion = motions_[point];
    const Quat toFrame = conjugate(frame);
    StickForces forces{rotate(toFrame, substep.pull), 0.0f, substep.decay, settings_.bendDampingTime,
                       substep.h};
    const Polar polar = polarOf(stick, motion);
    const Float3 flow =
        rotate(toFrame, mixed(substep.airRoot, substep.airTip, along) - velocities_[point - 1]);
    const Float3 turning =
        (polar.acrossMeridian * (motion.thetaRate * std::cos(motion.phi)) + polar.byPhi * motion.phiRate) *
        (0.5f * stick.length);
    const Float3 seen = flow - turning;
    const float speed = length(seen);
    if (!(speed > 1e-12f)) return forces;
    const float sine = std::min(length(cross(seen, polar.direction)) / speed, 1.0f);
    forces.dragRate = settings_.airDrag * sine;
    forces.force = forces.force + flow * forces.dragRate;
    return forces;
}

void ProjectiveEquations::collide(std::uint32_t point, Quat frame, float along, const Substep& substep) {
    const float collisionRadius = settings_.collisionRadiusRoot +
                                  (settings_.collisionRadiusTip - settings_.collisionRadiusRoot) * along;
    const Float3 joint_ws = substep.root.position + positions_[point - 1];
    for (const MovingSpheres::Moving& sphere : spheres_.all()) {
        const Float3 centre_ws = sphere.from_ws + sphere.motion * substep.share;
        pushOut(sticks_[point], motions_[point], rotate(conjugate(frame), centre_ws - joint_ws),
                sphere.radius + collisionRadius);
    }
}

/// What is asked of a tip, less what the sticks before it have moved it by on their way.
void ProjectiveEquations::keepApart(std::uint32_t point, Quat frame, const Substep& substep,
                                    NearSticks::Away& carried) {
    const auto left = [](Float3 asked, Float3 has) {
        const float size = length(asked);
        if (!(size > 0.0f)) return Float3{};
        const Float3 direction = asked * (1.0f / size);
        return direction * std::max(size - dot(has, direction), 0.0f);
    };
    const Stick& stick = sticks_[point];
    StickMotion& motion = motions_[point];
    const NearSticks::Away& away = near_.of(point);
    const Float3 along = rotate(frame, polarOf(stick, motion).direction);
    const auto across = [&](Float3 v) { return v - along * dot(v, along); };
    const Float3 push = across(left(away.push * substep.pushed, carried.push));
    const Float3 brake = across(left(away.brake * substep.braked, carried.brake));
    const Quat toFrame = conjugate(frame);
    nudge(stick, motion, rotate(toFrame, push), rotate(toFrame, brake));
    carried = {carried.push + push, carried.brake + brake};
}

bool ProjectiveEquations::readPositions(std::span<Float3> positions_ws) const {
    if (positions_ws.size() != pointCount()) return false;
    for (std::uint32_t s = 0; s < strandCount(); ++s) {
        for (std::uint32_t p = offsets_[s]; p < offsets_[s + 1]; ++p) {
            positions_ws[p] = roots_[s].now.position + positions_[p];
        }
    }
    return true;
}

bool ProjectiveEquations::readVelocities(std::span<Float3> velocities_ws) const {
    if (velocities_ws.size() != pointCount()) return false;
    std::copy(velocities_.begin(), velocities_.end(), velocities_ws.begin());
    return true;
}

}  // namespace hairloom::runtime
