// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/simulation/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "core/animation/root_motion.h"
#include "core/base/parallel.h"
#include "core/base/profiler.h"
#include "core/groom/validate.h"
#include "runtime/engine.h"

namespace hairloom {
namespace {

using runtime::Effect;
using runtime::StageId;

runtime::Float3 toFloat3(const Vec3f& v) {
    return {v.x(), v.y(), v.z()};
}

runtime::Host applicationHost() {
    runtime::Host host;
    host.parallelFor = parallelFor;
    host.nanoseconds = [] {
        const auto now = std::chrono::steady_clock::now().time_since_epoch();
        return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(now).count());
    };
    return host;
}

/// The effect that a stage is there for; stages that every strand needs have none.
std::optional<Effect> effectOf(StageId stage) {
    switch (stage) {
        case StageId::gravity:
            return Effect::gravity;
        case StageId::drag:
            return Effect::drag;
        case StageId::wind:
            return Effect::wind;
        case StageId::angular:
            return Effect::angular;
        case StageId::length:
        case StageId::extension:
            return Effect::length;
        case StageId::penalty:
        case StageId::sweep:
        case StageId::collision:
        case StageId::backward:
            return Effect::collision;
        case StageId::roots:
        case StageId::integrate:
            return std::nullopt;
    }
    return std::nullopt;
}

/// "off, no sphere within reach of a strand" out of "collision: off, …".
std::string reasonAlone(const std::string& why) {
    const std::size_t colon = why.find(": ");
    return colon == std::string::npos ? why : why.substr(colon + 2);
}

Status refuseWhatValidationRefuses(const Groom& groom) {
    for (const Finding& finding : validate(groom)) {
        if (finding.severity != Severity::Error) continue;
        return fail(fmt::format("{} ({})", finding.what, finding.where),
                    finding.fix.empty() ? "expected a groom that validates" : finding.fix);
    }
    return {};
}

}  // namespace

struct Simulation::Impl {
    Groom groom;
    std::vector<SurfacePoint> bindings;  ///< empty for hair without a scalp
    runtime::Engine engine;
    double time = 0;
    std::vector<Vec3f> positions_ws;
    SimulationStats stats;
    double milliseconds = 0;  ///< of all steps
    std::array<double, runtime::kEffectCount> effectMilliseconds{};

    std::vector<runtime::RootFrame> rootsAt(const HeadPose& pose) const;
    std::vector<runtime::Sphere> spheresAt(const HeadPose& pose) const;
    void readPositions();
    void gather(const runtime::StepReport& report);
};

std::vector<runtime::RootFrame> Simulation::Impl::rootsAt(const HeadPose& pose) const {
    std::vector<Eigen::Isometry3f> transforms(groom.strandCount(), pose.head_ws);
    if (!bindings.empty() && !pose.scalpPositions_ws.empty()) {
        transforms = rootTransforms(*groom.scalp, pose.scalpPositions_ws, bindings);
    }
    std::vector<runtime::RootFrame> roots(transforms.size());
    for (std::size_t s = 0; s < roots.size(); ++s) {
        const Quatf rotation(transforms[s].linear());
        roots[s].position = toFloat3(transforms[s] * groom.strand(s).front());
        roots[s].rotation = {rotation.x(), rotation.y(), rotation.z(), rotation.w()};
    }
    return roots;
}

std::vector<runtime::Sphere> Simulation::Impl::spheresAt(const HeadPose& pose) const {
    std::vector<runtime::Sphere> spheres(groom.spheres.size());
    for (std::size_t s = 0; s < spheres.size(); ++s) {
        const Vec3f centre_ws = pose.sphereCentres_ws.empty() ? Vec3f(pose.head_ws * groom.spheres[s].centre)
                                                              : pose.sphereCentres_ws[s];
        spheres[s] = {toFloat3(centre_ws), groom.spheres[s].radius};
    }
    return spheres;
}

void Simulation::Impl::readPositions() {
    static_assert(sizeof(Vec3f) == sizeof(runtime::Float3));
    engine.readPositions({reinterpret_cast<runtime::Float3*>(positions_ws.data()), positions_ws.size()});
}

void Simulation::Impl::gather(const runtime::StepReport& report) {
    ++stats.frames;
    milliseconds += report.milliseconds;
    for (std::uint32_t stage = 0; stage < runtime::kStageCount; ++stage) {
        if (const auto effect = effectOf(static_cast<StageId>(stage))) {
            effectMilliseconds[static_cast<std::size_t>(*effect)] += report.stageMilliseconds[stage];
        }
    }
    const runtime::Measurements measured = engine.measure();
    stats.maxStretch = std::max(stats.maxStretch, measured.maxStretch);
    stats.maxPenetrationMm = std::max(stats.maxPenetrationMm, measured.maxPenetration * 1e3);
    stats.energy = measured.kineticEnergy;
    stats.nanCount += measured.nanCount;
}

Result<Simulation> Simulation::make(const Groom& groom, const HeadPose& start) {
    if (groom.strandCount() == 0) return fail("the groom has no strands", "expected strands to simulate");
    if (auto status = refuseWhatValidationRefuses(groom); !status) return tl::unexpected(status.error());
    const auto positions = groom.positions();
    runtime::StrandsView strands;
    strands.offsets = groom.offsets.view();
    strands.restPositions_ss = {reinterpret_cast<const runtime::Float3*>(positions.data()), positions.size()};
    auto made = runtime::Engine::make(strands, groom.simulation, applicationHost());
    if (!made.engine) return fail(made.error);

    auto impl = std::unique_ptr<Impl>(
        new Impl{groom, groom.rootBindings(), std::move(*made.engine), 0, {}, {}, 0, {}});
    impl->positions_ws.resize(groom.pointCount());
    impl->engine.reset(impl->rootsAt(start));
    impl->readPositions();
    return Simulation(std::move(impl));
}

Simulation::Simulation(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;
Simulation::~Simulation() = default;

void Simulation::step(float dt, const HeadPose& pose) {
    HAIRLOOM_PROFILE("simulation step");
    impl_->time += static_cast<double>(dt);
    const auto roots = impl_->rootsAt(pose);
    const auto spheres = impl_->spheresAt(pose);
    runtime::FrameInput input;
    input.dt = dt;
    input.time = impl_->time;
    input.roots_ws = roots;
    input.spheres = spheres;
    impl_->engine.step(input);
    impl_->readPositions();
    impl_->gather(impl_->engine.lastStep());
}

std::span<const Vec3f> Simulation::positions_ws() const {
    return impl_->positions_ws;
}

SimulationStats Simulation::stats() const {
    SimulationStats stats = impl_->stats;
    const double frames = static_cast<double>(std::max<std::uint64_t>(stats.frames, 1));
    const double particleSubsteps = static_cast<double>(impl_->positions_ws.size()) *
                                    static_cast<double>(impl_->groom.simulation.substeps) * frames;
    stats.millisecondsPerFrame = impl_->milliseconds / frames;
    stats.nanosecondsPerParticleSubstep = impl_->milliseconds * 1e6 / particleSubsteps;
    stats.stateHash = impl_->engine.stateHash();
    for (std::uint32_t index = 0; index < runtime::kEffectCount; ++index) {
        const auto effect = static_cast<Effect>(index);
        stats.effects.push_back({runtime::effectName(effect), impl_->engine.plan().on(effect),
                                 reasonAlone(impl_->engine.plan().why(effect)),
                                 impl_->effectMilliseconds[index] / frames,
                                 impl_->engine.effectBytes(effect)});
    }
    return stats;
}

Groom posedGroom(const Groom& groom, std::span<const Vec3f> positions_ws, const HeadPose& pose) {
    Groom posed = groom;
    posed.pointAttributes.set(attribute::kPosition,
                              std::vector<Vec3f>(positions_ws.begin(), positions_ws.end()));
    if (groom.scalp) {
        std::vector<Vec3f> vertices = pose.scalpPositions_ws;
        if (vertices.empty()) {
            for (const Vec3f& position : groom.scalp->positions())
                vertices.push_back(pose.head_ws * position);
        }
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
