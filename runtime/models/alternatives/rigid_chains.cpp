// SPDX-License-Identifier: MIT
#include "hairloom/alternatives/rigid_chains.h"

#include <algorithm>
#include <cmath>

#include "engine/checks.h"
#include "engine/in_parallel.h"
#include "hairloom/alternatives/stick.h"
#include "models/alternatives/matrix3.h"
#include "models/alternatives/surroundings.h"

namespace hairloom::runtime {
namespace {

constexpr double kAxialInertia = 1e-3;  // of m l², about a segment's axis
constexpr float kLargestAim = 2.5f;     // radians; the spring's law ends at half a turn
constexpr float kChainStiffest = 1e6f;  // m³/s², far beyond any hair
constexpr std::size_t kChainsPerJob = 16;

Quat turnOf(Float3 vector) {
    const float angle = length(vector);
    const Float3 v = vector * (angle > 1e-6f ? std::sin(0.5f * angle) / angle : 0.5f);
    return {v.x, v.y, v.z, std::cos(0.5f * angle)};
}

}  // namespace

/// What all segments of a strand share in one substep.
struct RigidChains::Substep {
    RootFrame root;          ///< at the end of the substep
    Quat rootBefore;         ///< its rotation at the start
    Float3 rootVelocity;     ///< m/s
    Float3 rootTurning;      ///< 1/s, world axes
    Float3 turningChange;    ///< 1/s², of rootTurning
    Float3 pull;             ///< gravity less the acceleration of the root
    Float3 airRoot, airTip;  ///< m/s
    float share;             ///< of the frame, at the end of the substep
    float h;                 ///< seconds
    float perSecond;         ///< frames
    float decay;             ///< share of its turning against the root that damping leaves a segment
};

/// A segment with all that hangs on it, about its inner joint, world axes: moment = A α + B a + moment₀ and
/// force = Bᵀ α + C a + force₀ at an angular acceleration α and an acceleration a of the joint.
struct RigidChains::Body {
    Matrix3 A, B, C;
    Double3 moment, force;
    Double3 lever;       ///< from the inner to the outer joint
    Double3 spin;        ///< acceleration of the outer joint against the inner one that the turn of the last
                         ///< substep leaves at α = 0
    Matrix3 compliance;  ///< angular acceleration of the joint per moment
    Double3 joint;       ///< moment of spring and damper at the joint's acceleration 0
};

RigidChains::Result RigidChains::make(const StrandsView& strands, const SimulationSettings& settings,
                                      Host host) {
    if (std::string error = validationError(settings); !error.empty())
        return {std::nullopt, std::move(error)};
    if (std::string error = validationError(strands); !error.empty()) return {std::nullopt, std::move(error)};
    RigidChains made;
    made.host_ = std::move(host);
    made.offsets_.assign(strands.offsets.begin(), strands.offsets.end());
    const std::size_t points = strands.restPositions_ss.size();
    made.segments_.resize(points);
    made.motions_.resize(points);
    made.positions_.resize(points);
    made.velocities_.resize(points);
    const std::vector<RootFrame> roots = rootsAtRest(strands);
    made.roots_.resize(roots.size());
    for (std::size_t s = 0; s < roots.size(); ++s) {
        made.roots_[s].rest = roots[s];
        if (!strands.stiffness.empty()) made.roots_[s].stiffness = strands.stiffness[s];
        for (std::uint32_t p = strands.offsets[s] + 1; p < strands.offsets[s + 1]; ++p) {
            Segment& segment = made.segments_[p];
            const Float3 edge = rotate(conjugate(roots[s].rotation),
                                       strands.restPositions_ss[p] - strands.restPositions_ss[p - 1]);
            segment.length = length(edge);
            if (segment.length > kShortestStick) segment.along = edge * (1.0f / segment.length);
        }
    }
    made.setSettings(settings);
    made.reset(roots);
    return {std::move(made), {}};
}

std::string RigidChains::setSettings(const SimulationSettings& settings) {
    if (std::string error = validationError(settings); !error.empty()) return error;
    settings_ = settings;
    wind_ = makeWind(settings);
    fillSegments();
    return {};
}

/// A joint is as stiff as the rod from the middle of one segment to that of the next: B/l̄. Fixed segments do
/// not bend.
void RigidChains::fillSegments() {
    for (std::uint32_t s = 0; s < strandCount(); ++s) {
        const std::uint32_t root = offsets_[s], count = offsets_[s + 1] - root - 1;
        for (std::uint32_t j = 0; j < count; ++j) {
            Segment& segment = segments_[root + j + 1];
            segment.fixed = j + 1 < settings_.clampedPoints || !(segment.length > kShortestStick);
            const float along = static_cast<float>(j) / static_cast<float>(count);
            const float inner = j >= settings_.clampedPoints ? segments_[root + j].length : 0.0f;
            const double between = 0.5 * (static_cast<double>(segment.length) + static_cast<double>(inner));
            const double held = std::min(rodStiffness(settings_, along, roots_[s].stiffness) / between,
                                         static_cast<double>(kChainStiffest));
            segment.stiffness = segment.fixed ? 0.0f : static_cast<float>(held);
        }
        aimAgainst(s, rotate(conjugate(roots_[s].rest.rotation), settings_.gravity) * settings_.restGravity);
    }
}

/// Turns the springs' rest so that the authored shape hangs in `gravity` (root's rest frame): at each joint
/// they hold the weight of all that lies beyond.
void RigidChains::aimAgainst(std::uint32_t strand, Float3 gravity) {
    Double3 moment, force;
    for (std::uint32_t p = offsets_[strand + 1]; p-- > offsets_[strand] + 1;) {
        Segment& segment = segments_[p];
        const Double3 lever = wide(segment.along * segment.length);
        const Double3 weight = wide(gravity * segment.length);
        moment = moment + crossOf(lever, force + weight * 0.5);
        force = force + weight;
        segment.aim = {};
        if (!(segment.stiffness > 0.0f)) continue;
        const Float3 turn = narrow(moment * (-1.0 / static_cast<double>(segment.stiffness)));
        segment.aim = turnOf(bounded(turn, kLargestAim));
    }
}

bool RigidChains::reset(std::span<const RootFrame> roots_ws) {
    if (roots_ws.size() != strandCount()) return false;
    spheres_.forget();
    for (std::uint32_t s = 0; s < strandCount(); ++s) {
        Root& root = roots_[s];
        root.now = roots_ws[s];
        if (!usableWithin(root.now, kFarthest)) root.now = root.rest;
        root.velocity = root.turning = {};
        for (std::uint32_t p = offsets_[s]; p < offsets_[s + 1]; ++p) {
            motions_[p] = {root.now.rotation, {}, rotate(root.now.rotation, segments_[p].along)};
            velocities_[p] = {};
            positions_[p] = {};
            if (p == offsets_[s]) continue;
            positions_[p] =
                positions_[p - 1] + rotate(root.now.rotation, segments_[p].along) * segments_[p].length;
        }
    }
    return true;
}

bool RigidChains::step(const FrameInput& input) {
    if (input.roots_ws.size() != strandCount()) return false;
    if (!(input.dt > 0.0f) || !std::isfinite(input.dt)) return true;
    spheres_.take(input, settings_.teleportDistance);
    const WindyFrame frame(wind_, input);
    const auto strands = [&](std::size_t begin, std::size_t end) {
        thread_local std::vector<Body> bodies;
        for (std::size_t s = begin; s < end; ++s) runStrand(static_cast<std::uint32_t>(s), frame, bodies);
    };
    inParallel(host_, strandCount(), kChainsPerJob, strands);
    return true;
}

void RigidChains::runStrand(std::uint32_t strand, const WindyFrame& frame, std::vector<Body>& bodies) {
    Root& root = roots_[strand];
    const float dt = std::clamp(frame.input.dt, 1e-6f, kLongestFrame);
    const std::uint32_t first = offsets_[strand], end = offsets_[strand + 1];
    if (bodies.size() < end - first) bodies.resize(end - first);
    const RootPath path(root.now, root.velocity, frame.input.roots_ws[strand], dt,
                        settings_.teleportDistance);
    if (path.jumps) {
        for (std::uint32_t p = first; p < end; ++p) {
            motions_[p] = {path.turn * motions_[p].rotation, rotate(path.turn, motions_[p].turning),
                           rotate(path.turn, motions_[p].axisBefore)};
            positions_[p] = rotate(path.turn, positions_[p]);
            velocities_[p] = rotate(path.turn, velocities_[p]);
        }
        root.turning = rotate(path.turn, root.turning);
    }

    const AirPath air(wind_, frame, path, positions_[end - 1]);
    const std::uint32_t substeps = substepsIn(settings_, dt);
    const float count = static_cast<float>(substeps), h = dt / count;
    const float decay = settings_.dampingTime > 0.0f ? std::exp(-h / settings_.dampingTime) : 1.0f;
    RootFrame before = path.from;
    for (std::uint32_t i = 0; i < substeps; ++i) {
        const float share = static_cast<float>(i + 1) / count;
        const RootFrame now = between(path.from, path.to, share);
        const Float3 turning = rotationVector(now.rotation * conjugate(before.rotation)) * (1.0f / h);
        const Float3 change = (turning - root.turning) * (1.0f / h);
        root.turning = turning;
        runSubstep(
            strand,
            {now, before.rotation, root.velocity, turning, change, settings_.gravity - path.acceleration,
             air.atRoot(share), air.atTip(share), share, h, 1.0f / dt, decay},
            bodies);
        before = now;
    }
}

void RigidChains::runSubstep(std::uint32_t strand, const Substep& substep, std::span<Body> bodies) {
    gatherForces(strand, substep, bodies);
    eliminate(strand, substep, bodies);
    accelerate(strand, substep, bodies);
    move(strand, substep);
}

/// Root to tip: what each segment does alone, and the moments of springs and dampers.
void RigidChains::gatherForces(std::uint32_t strand, const Substep& substep, std::span<Body> bodies) const {
    const std::uint32_t root = offsets_[strand], end = offsets_[strand + 1];
    const double h = static_cast<double>(substep.h);
    const Double3 pull = wide(substep.pull);
    Double3 velocity;  // of the inner joint, at the start of the last substep
    for (std::uint32_t p = root + 1; p < end; ++p) {
        const Segment& segment = segments_[p];
        Body& body = bodies[p - root];
        const double l = static_cast<double>(segment.length), m = l;
        const Double3 axis = wide(rotate(motions_[p].rotation, segment.along));
        const Double3 turning = wide(motions_[p].turning), half = axis * (0.5 * l);
        body.lever = axis * l;
        const Double3 turned = crossOf(turning, axis - wide(motions_[p].axisBefore)) * (1.0 / h);
        body.spin = turned * l;

        // Air: Rünz 2012, Section 3.3, at the segment's middle.
        const float along = static_cast<float>(p - root) / static_cast<float>(end - root - 1);
        const Double3 swing = crossOf(turning, wide(motions_[p].axisBefore));
        const Double3 before = swing * l;
        const Double3 middle = velocity + before * 0.5;
        const Double3 flow =
            wide(mixed(substep.airRoot, substep.airTip, along) - substep.rootVelocity) - middle;
        const double speed = std::sqrt(dotOf(flow, flow));
        const Double3 across = crossOf(flow, axis);
        const double sine = speed > 1e-12 ? std::sqrt(dotOf(across, across)) / speed : 0.0;
        const double drag = static_cast<double>(settings_.airDrag) * std::min(sine, 1.0);
        const double implicit = 1.0 + h * drag;

        const double thin = m * l * l / 12.0, thick = kAxialInertia * m * l * l;
        const Double3 momentum = crossOf(axis, swing) * (thin - thick) + turning * thick;
        const Double3 force = (pull + flow * drag) * m;
        body.A = aboutAxis(axis, implicit * m * l * l / 3.0, implicit * thick);
        body.B = crossMatrix(half * (m * implicit));
        body.C = diagonal(m * implicit);
        body.force = body.spin * (0.5 * m * implicit) - force;
        body.moment =
            crossOf(half, body.force) + crossOf(axis, turned) * ((thin - thick) * implicit) + momentum * drag;
        body.joint.x = m * (std::sqrt(dotOf(pull, pull)) + drag * speed);  // until eliminate() sums it

        velocity = velocity + before;
    }
}

/// Tip to root: each segment takes up what hangs on it.
void RigidChains::eliminate(std::uint32_t strand, const Substep& substep, std::span<Body> bodies) const {
    const std::uint32_t root = offsets_[strand], end = offsets_[strand + 1];
    const double h = static_cast<double>(substep.h);
    const double damper = static_cast<double>(settings_.bendDampingTime);
    double pulledBeyond = 0.0;
    for (std::uint32_t p = end; p-- > root + 1;) {
        const Segment& segment = segments_[p];
        Body& body = bodies[p - root];
        const Double3 turning = wide(motions_[p].turning);
        const Double3 axis = wide(rotate(motions_[p].rotation, segment.along));
        const double pulled = body.joint.x;
        const double righting = static_cast<double>(segment.length) * (pulledBeyond + 0.5 * pulled);
        pulledBeyond += pulled;
        body.A = body.A + aboutAxis(axis, 0.5 * h * h * righting, 0.0);
        body.moment = body.moment + aboutAxis(axis, 0.5 * h * righting, 0.0) * turning;

        body.joint = {};
        body.compliance = {};
        Matrix3 A = body.A, B = body.B, C = body.C;
        Double3 moment = body.moment, force = body.force;
        if (!segment.fixed) {
            const bool atRoot = p == root + 1;
            const Quat parent = atRoot ? substep.rootBefore : motions_[p - 1].rotation;
            const Double3 relative = turning - wide(atRoot ? substep.rootTurning : motions_[p - 1].turning);
            const Quat bent = motions_[p].rotation * conjugate(parent * segment.aim);
            const double k = static_cast<double>(segment.stiffness), c = k * damper;
            const double held = h * h * k + h * c;
            body.joint = wide(rotationVector(bent)) * -k - relative * (h * k + c);
            body.compliance = inverseOf(symmetric(body.A + diagonal(held)));
            // A − A D⁻¹ A with D = A + held, and the like, without differences of what is nearly alike.
            const Matrix3 passed = diagonal(held) * body.compliance;
            const Matrix3 BtD = transposed(body.B) * body.compliance;
            force = force + BtD * (body.joint - moment);
            moment = body.A * (body.compliance * body.joint) + passed * moment;
            A = symmetric(passed * body.A);
            B = passed * body.B;
            C = symmetric(C - BtD * body.B);
        }
        if (p == root + 1) continue;
        Body& holder = bodies[p - 1 - root];
        force = force + C * holder.spin;
        moment = moment + B * holder.spin;
        const Matrix3 r = crossMatrix(holder.lever), Br = B * r;
        holder.A = holder.A + A - Br - transposed(Br) - r * C * r;
        holder.B = holder.B + B + r * C;
        holder.C = holder.C + C;
        holder.moment = holder.moment + moment + crossOf(holder.lever, force);
        holder.force = holder.force + force;
    }
}

/// Root to tip: accelerations, and the speeds that they give.
void RigidChains::accelerate(std::uint32_t strand, const Substep& substep, std::span<const Body> bodies) {
    const std::uint32_t root = offsets_[strand], end = offsets_[strand + 1];
    Double3 turn = wide(substep.turningChange), joint;
    Float3 parent = substep.rootTurning;
    for (std::uint32_t p = root + 1; p < end; ++p) {
        const Body& body = bodies[p - root];
        turn = turn + body.compliance * (body.joint - body.moment - body.A * turn - body.B * joint);
        joint = joint + crossOf(turn, body.lever) + body.spin;
        if (segments_[p].fixed) {
            motions_[p].turning = parent;
        } else {
            const Float3 turning = motions_[p].turning + narrow(turn * static_cast<double>(substep.h));
            motions_[p].turning = substep.rootTurning + (turning - substep.rootTurning) * substep.decay;
        }
        parent = motions_[p].turning;
    }
}

/// Root to tip: where the speeds lead.
void RigidChains::move(std::uint32_t strand, const Substep& substep) {
    const std::uint32_t root = offsets_[strand], end = offsets_[strand + 1];
    Quat parent = substep.root.rotation;
    for (std::uint32_t p = root + 1; p < end; ++p) {
        const Segment& segment = segments_[p];
        Motion& motion = motions_[p];
        motion.axisBefore = rotate(motion.rotation, segment.along);
        if (segment.fixed) {
            motion.rotation = parent;
        } else {
            motion.rotation = turnOf(motion.turning * substep.h) * motion.rotation;
            if (!normalize(motion.rotation)) motion = {parent, {}, motion.axisBefore};
            collide(p, static_cast<float>(p - root) / static_cast<float>(end - root - 1), substep);
        }
        parent = motion.rotation;
        const Float3 lever = rotate(motion.rotation, segment.along) * segment.length;
        positions_[p] = positions_[p - 1] + lever;
        velocities_[p] = velocities_[p - 1] + cross(motion.turning, lever);
    }
}

void RigidChains::collide(std::uint32_t point, float along, const Substep& substep) {
    const Segment& segment = segments_[point];
    Motion& motion = motions_[point];
    const float reach = settings_.collisionRadiusRoot +
                        (settings_.collisionRadiusTip - settings_.collisionRadiusRoot) * along;
    const Float3 joint_ws = substep.root.position + positions_[point - 1];
    for (const MovingSpheres::Moving& sphere : spheres_.all()) {
        const Float3 centre = sphere.from_ws + sphere.motion * substep.share - joint_ws;
        const Float3 axis = rotate(motion.rotation, segment.along);
        const auto out = directionOut(axis, segment.length, centre, sphere.radius + reach);
        if (!out) continue;
        const Float3 turn = cross(axis, *out);
        const float sine = length(turn), angle = std::atan2(sine, dot(axis, *out));
        if (sine > 1e-9f) motion.rotation = turnOf(turn * (angle / sine)) * motion.rotation;
        normalize(motion.rotation);
        motion.axisBefore = *out;
        // The tip no longer approaches the sphere.
        const Float3 apart = *out * segment.length - centre;
        const Float3 normal = apart * (1.0f / std::max(length(apart), 1e-12f));
        const Float3 tip = substep.rootVelocity + velocities_[point - 1] +
                           cross(motion.turning, *out * segment.length) - sphere.motion * substep.perSecond;
        const float approach = dot(tip, normal);
        const Float3 turnsOut = cross(*out, normal);
        const float share = dot(turnsOut, turnsOut);
        if (approach < 0.0f && share > 1e-6f)
            motion.turning = motion.turning - turnsOut * (approach / (share * segment.length));
    }
}

bool RigidChains::readPositions(std::span<Float3> positions_ws) const {
    if (positions_ws.size() != pointCount()) return false;
    for (std::uint32_t s = 0; s < strandCount(); ++s) {
        for (std::uint32_t p = offsets_[s]; p < offsets_[s + 1]; ++p)
            positions_ws[p] = roots_[s].now.position + positions_[p];
    }
    return true;
}

bool RigidChains::readVelocities(std::span<Float3> velocities_ws) const {
    if (velocities_ws.size() != pointCount()) return false;
    for (std::uint32_t s = 0; s < strandCount(); ++s) {
        for (std::uint32_t p = offsets_[s]; p < offsets_[s + 1]; ++p)
            velocities_ws[p] = roots_[s].velocity + velocities_[p];
    }
    return true;
}

}  // namespace hairloom::runtime
