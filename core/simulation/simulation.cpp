// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/simulation/simulation.h"

#include <algorithm>
#include <cassert>

#include "core/base/profiler.h"
#include "core/groom/spheres.h"
#include "core/simulation/strand_method.h"

namespace hairloom {
namespace {

Result<std::unique_ptr<StrandMethod>> makeMethod(const SceneInput& scene, const SimulationOptions& options) {
    if (options.backend) {
        if (options.method == SimulationMethod::strands) return options.backend(scene, options.hairVolume);
        return fail("only the strand engine runs on the device", "expected the method 'strands'");
    }
    if (options.method == SimulationMethod::strands) return makeEngineMethod(scene, options.hairVolume);
    if (options.hairVolume) {
        return fail(
            "hair-hair collision needs a method with external velocities and none of its own, which this one "
            "is not",
            "expected the method 'strands'");
    }
    if (options.method == SimulationMethod::particles) return makeParticleMethod(scene);
    if (options.method == SimulationMethod::hybrid) return makeHybridMethod(scene);
    if (options.method == SimulationMethod::projective) return makeProjectiveMethod(scene);
    if (options.method == SimulationMethod::chain) return makeChainMethod(scene);
    return makeLatticeMethod(scene);
}

}  // namespace

struct Simulation::Impl {
    SceneInput scene;
    std::unique_ptr<StrandMethod> method;
    double time = 0;
    std::vector<Vec3f> positions_ws;
    SimulationStats stats;
    Vec3f origin_ws = Vec3f::Zero();  ///< that the method measures from
    double milliseconds = 0;          ///< of all steps
    std::uint64_t substeps = 0;       ///< likewise

    void readPositions();
    void gather();
};

void Simulation::Impl::readPositions() {
    static_assert(sizeof(Vec3f) == sizeof(runtime::Float3));
    method->readPositions({reinterpret_cast<runtime::Float3*>(positions_ws.data()), positions_ws.size()});
    if (origin_ws.isZero()) return;
    for (Vec3f& position : positions_ws) position += origin_ws;
}

void Simulation::Impl::gather() {
    ++stats.frames;
    milliseconds += method->stepMilliseconds();
    const runtime::Measurements measured = method->measure();
    stats.maxStretch = std::max(stats.maxStretch, measured.maxStretch);
    stats.maxPenetrationMm = std::max(stats.maxPenetrationMm, measured.maxPenetration * 1e3);
    stats.energy = measured.kineticEnergy;
    stats.nanCount += measured.nanCount;
    stats.restoredStrands += method->restoredStrands();
    stats.guardedStrands += method->guardedStrands();
    stats.restingStrands = measured.asleep;
    stats.fastestMmPerSecond = measured.fastest * 1e3;
}

Result<Simulation> Simulation::make(const Groom& groom, const HeadPose& start,
                                    const SimulationOptions& options) {
    auto scene = SceneInput::make(groom);
    if (!scene) return tl::unexpected(scene.error());
    auto method = makeMethod(*scene, options);
    if (!method) return tl::unexpected(method.error());
    auto impl = std::unique_ptr<Impl>(new Impl{std::move(*scene), std::move(*method), 0, {}, {}, {}, 0, 0});
    impl->positions_ws.resize(groom.pointCount());
    const HeadPose pose = impl->method->measuresFromOrigin() ? start : inWorld(start);
    impl->origin_ws = pose.origin_ws.cast<float>();
    impl->method->reset(impl->scene, pose);
    impl->readPositions();
    return Simulation(std::move(impl));
}

Simulation::Simulation(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;
Simulation::~Simulation() = default;

Status Simulation::setSettings(const runtime::SimulationSettings& settings) {
    if (auto set = impl_->method->setSettings(settings); !set) return set;
    impl_->scene.setSettings(settings);
    return {};
}

Status Simulation::setPoseAmounts(std::span<const float> amounts) {
    return impl_->method->setPoseAmounts(amounts);
}

Status Simulation::setStyle(std::span<const Vec3f> restPositions) {
    return impl_->method->setStyle(
        {reinterpret_cast<const runtime::Float3*>(restPositions.data()), restPositions.size()});
}

void Simulation::setSpheres(std::vector<CollisionSphere> spheres, bool atRest) {
    impl_->scene.setSpheres(std::move(spheres), atRest);
}

namespace {

/// Of the engine, measured from the origin of the pose that the frame ends on.
struct WithinFrame {
    std::vector<runtime::RootFrame> roots;
    std::vector<runtime::Sphere> spheres;
    std::vector<runtime::BonePose> body;
};

WithinFrame withinFrame(const SceneInput& scene, HeadPose pose, const Vec3d& origin_ws) {
    const Vec3d shift = pose.origin_ws - origin_ws;
    if (!shift.isZero(0)) {
        // moveBy() turns about the pose's own origin, and moves.
        moveBy(Eigen::Isometry3f(Eigen::Translation3f(shift.cast<float>())), pose);
    }
    return {scene.rootsAt(pose), scene.spheresAt(pose), bodyAt(scene.groom(), pose)};
}

}  // namespace

void Simulation::step(float dt, const HeadPose& given, std::span<const HeadPose> within) {
    assert(within.size() <= runtime::kMaxInnerPoses);
    HAIRLOOM_PROFILE("simulation step");
    impl_->time += static_cast<double>(dt);
    const HeadPose pose = impl_->method->measuresFromOrigin() ? given : inWorld(given);
    impl_->origin_ws = pose.origin_ws.cast<float>();
    const auto roots = impl_->scene.rootsAt(pose);
    const auto spheres = impl_->scene.spheresAt(pose);
    runtime::FrameInput input;
    input.dt = dt;
    input.time = impl_->time;
    input.roots_ws = roots;
    input.spheres = spheres;
    const auto capsules = capsulesOf(impl_->scene.groom().spheres);
    input.capsules = capsules;
    input.origin_ws = {pose.origin_ws.x(), pose.origin_ws.y(), pose.origin_ws.z()};
    if (pose.wind_ws)
        input.wind_ws = runtime::Float3{pose.wind_ws->x(), pose.wind_ws->y(), pose.wind_ws->z()};
    input.poseAmounts = pose.poseAmounts;
    const auto body = bodyAt(impl_->scene.groom(), pose);
    input.body_ws = body;
    std::vector<WithinFrame> onTheWay;
    for (const HeadPose& on : within) onTheWay.push_back(withinFrame(impl_->scene, on, pose.origin_ws));
    std::vector<runtime::InnerPose> poses;
    for (const WithinFrame& on : onTheWay) poses.push_back({on.roots, on.spheres, on.body});
    input.inner = poses;
    impl_->method->step(impl_->scene, pose, input);
    impl_->readPositions();
    impl_->substeps += impl_->method->substeps().value_or(substepsIn(impl_->scene.groom().simulation, dt));
    impl_->gather();
}

std::span<const Vec3f> Simulation::positions_ws() const {
    return impl_->positions_ws;
}

std::vector<Vec3f> Simulation::velocities_ws() const {
    std::vector<Vec3f> velocities(impl_->stats.frames > 0 ? impl_->positions_ws.size() : 0);
    const std::span values(reinterpret_cast<runtime::Float3*>(velocities.data()), velocities.size());
    if (velocities.empty() || !impl_->method->readVelocities(values)) return {};
    return velocities;
}

std::shared_ptr<const runtime::State> Simulation::state() const {
    return impl_->method->state();
}

bool Simulation::setState(const runtime::State& state, double time) {
    if (!impl_->method->setState(state)) return false;
    impl_->time = time;
    impl_->readPositions();
    return true;
}

Status Simulation::status() const {
    return impl_->method->status();
}

SimulationStats Simulation::stats() const {
    SimulationStats stats = impl_->stats;
    const double frames = static_cast<double>(std::max<std::uint64_t>(stats.frames, 1));
    const double particleSubsteps =
        static_cast<double>(impl_->positions_ws.size()) * static_cast<double>(impl_->substeps);
    stats.millisecondsPerFrame = impl_->milliseconds / frames;
    stats.nanosecondsPerParticleSubstep = impl_->milliseconds * 1e6 / particleSubsteps;
    stats.stateHash = impl_->method->stateHash();
    stats.effects = impl_->method->effects();
    return stats;
}

Groom posedGroom(const Groom& groom, std::span<const Vec3f> positions_ws, const HeadPose& pose) {
    Groom posed = groom;
    posed.pointAttributes.set(attribute::kPosition,
                              std::vector<Vec3f>(positions_ws.begin(), positions_ws.end()));
    posed.body.reset();  // is baked at rest
    if (groom.scalp) {
        std::vector<Vec3f> vertices = pose.scalpPositions_ws;
        if (vertices.empty()) {
            for (const Vec3f& position : groom.scalp->positions())
                vertices.push_back(pose.head_ws * position);
        }
        // At rest it keeps the normals that it came with; moved() averages those of its faces.
        if (!std::ranges::equal(vertices, groom.scalp->positions()))
            posed.scalp = std::make_shared<const ScalpMesh>(groom.scalp->moved(std::move(vertices)));
    }
    for (std::size_t s = 0; s < posed.spheres.size(); ++s) {
        posed.spheres[s].centre = pose.sphereCentres_ws.empty()
                                      ? Vec3f(pose.head_ws * groom.spheres[s].centre)
                                      : pose.sphereCentres_ws[s];
    }
    return posed;
}

}  // namespace hairloom
