// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/live/moving_hair.h"

#include <algorithm>

#include "core/base/stopwatch.h"
#include "core/gpu_simulation/gpu_engine_method.h"

namespace hairloom {

Status showMaterials(render::Renderer& renderer, const GroomScene& scene, bool hair, bool head) {
    const render::RenderScene shown = scene.scene();
    for (std::size_t i = 0; head && i < shown.meshes.size(); ++i) {
        const auto& albedo = shown.meshes[i].vertexAlbedo;
        if (albedo.empty()) continue;
        if (auto set = renderer.setMeshAlbedo(i, albedo); !set) return set;
    }
    if (!hair || shown.strands.empty()) return {};
    const render::RenderStrands& strands = shown.strands.front();
    return renderer.setMaterial(0, strands.material, strands.others);
}

Status showPosed(render::Renderer& renderer, const GroomScene& scene, bool hair, bool head) {
    const render::RenderScene moved = scene.scene();
    for (std::size_t i = 0; head && i < moved.meshes.size(); ++i) {
        const render::RenderMesh& mesh = moved.meshes[i];
        if (auto set = renderer.setMeshPositions(i, mesh.positions_ws, mesh.normals_ws); !set) return set;
    }
    if (!hair || moved.strands.empty()) return {};
    return renderer.setStrandPositions(0, moved.strands.front().positions_ws);
}

Result<MovingHair> MovingHair::onCpu(const Groom& groom, const MovingStart& start,
                                     const SimulationOptions& options) {
    auto made = Simulation::make(groom, start.pose, options);
    if (!made) return tl::unexpected(made.error());
    if (start.state && !made->setState(*start.state, start.time))
        return fail("the state does not belong to these strands");
    return MovingHair(std::move(*made), start);
}

Result<MovingHair> MovingHair::onGpu(gpu::Device& device,
                                     std::shared_ptr<gpu_simulation::KernelLibrary> kernels,
                                     const GroomScene& scene, const SkinWeights* skin,
                                     const MovingStart& start) {
    auto made = DeviceHair::make(device, std::move(kernels), scene, skin, start.pose);
    if (!made) return tl::unexpected(made.error());
    if (start.state) {
        if (auto written = made->writeState(*start.state); !written) return tl::unexpected(written.error());
    }
    return MovingHair(device, std::move(*made), start);
}

Result<MovingHair> MovingHair::make(EngineKind engine, gpu::Device& device,
                                    std::shared_ptr<gpu_simulation::KernelLibrary> kernels,
                                    const GroomScene& scene, const SkinWeights* skin,
                                    const MovingStart& start) {
    return engine == EngineKind::gpu ? onGpu(device, std::move(kernels), scene, skin, start)
                                     : onCpu(scene.rest(), start);
}

Status MovingHair::setSettings(const runtime::SimulationSettings& settings) {
    return std::visit([&](auto& hair) { return hair.setSettings(settings); }, hair_);
}

Status MovingHair::setStyle(std::span<const Vec3f> restPositions) {
    if (auto* const cpu = std::get_if<Simulation>(&hair_)) return cpu->setStyle(restPositions);
    return fail("strands on a GPU take no style while they run", "expected the method 'projective'");
}

Status MovingHair::setPoseAmounts(std::span<const float> amounts) {
    return std::visit([&](auto& hair) { return hair.setPoseAmounts(amounts); }, hair_);
}

void MovingHair::setColliders(std::vector<CollisionSphere> spheres) {
    std::visit([&](auto& hair) { hair.setSpheres(std::move(spheres)); }, hair_);
}

void MovingHair::setReadsPositions(bool on) {
    if (auto* const gpu = std::get_if<DeviceHair>(&hair_)) gpu->setReadsPositions(on);
}

Status MovingHair::step(gpu::CommandList& list, float dt, const HeadStep& head) {
    auto* const gpu = std::get_if<DeviceHair>(&hair_);
    if (!gpu) return step(dt, head);
    time_ += static_cast<double>(dt);
    pose_ = head.end;
    ++frames_;
    return gpu->record(list, dt, time_, head.end, head.within);
}

Status MovingHair::step(float dt, const HeadStep& head) {
    if (auto* const cpu = std::get_if<Simulation>(&hair_)) {
        time_ += static_cast<double>(dt);
        pose_ = head.end;
        const Stopwatch watch;
        cpu->step(dt, head);
        simulateMs_ = 1e3 * watch.seconds();
        return cpu->status();
    }
    auto list = device_->createCommandList();
    if (!list) return tl::unexpected(list.error());
    if (auto recorded = step(**list, dt, head); !recorded) return recorded;
    auto submission = device_->submit(std::move(*list));
    if (!submission) return tl::unexpected(submission.error());
    submitted(*submission);
    return {};
}

void MovingHair::submitted(const gpu::SubmissionPtr& submission) {
    auto* const gpu = std::get_if<DeviceHair>(&hair_);
    if (!gpu) return;
    gpu->submitted(submission);
    timed_.push_back(submission);
    readTimes();
}

/// Of what the device has done; never waits.
void MovingHair::readTimes() {
    const auto smooth = [](double& mean, double now) {
        constexpr double kShare = 0.1;
        mean = mean > 0 ? mean + kShare * (now - mean) : now;
    };
    while (!timed_.empty() && timed_.front()->isDone()) {
        const auto times = timed_.front()->passTimes();
        timed_.pop_front();
        if (!times) continue;
        double sum = 0;
        std::map<FrameCost, double> costs;
        for (const gpu::PassTime& pass : *times) {
            const FrameCost cost = frameCostOf(pass.name);
            if (!isSimulationCost(cost)) continue;  // drawn in the same list
            sum += pass.milliseconds;
            costs[cost] += pass.milliseconds;
        }
        smooth(frameMs_, sum);
        for (const auto& [cost, milliseconds] : costs) smooth(costs_[cost], milliseconds);
    }
}

Status MovingHair::show(render::Renderer& renderer, GroomScene& scene, bool hair, bool head) {
    if (const auto* const gpu = std::get_if<DeviceHair>(&hair_)) return gpu->show(renderer, hair, head);
    const auto& cpu = std::get<Simulation>(hair_);
    const Stopwatch watch;
    scene.pose(cpu.positions_ws(), cpu.velocities_ws(), pose_);
    followMs_ = 1e3 * watch.seconds();
    return showPosed(renderer, scene, hair, head);
}

std::span<const Vec3f> MovingHair::positions_ws() const {
    if (const auto* const gpu = std::get_if<DeviceHair>(&hair_)) return gpu->latestFrame().positions_ws;
    return std::get<Simulation>(hair_).positions_ws();
}

std::vector<Vec3f> MovingHair::velocities_ws() const {
    const auto* const cpu = std::get_if<Simulation>(&hair_);
    return cpu ? cpu->velocities_ws() : std::vector<Vec3f>();
}

Status MovingHair::readPositions(std::span<Vec3f> positions_ws) {
    if (auto* const gpu = std::get_if<DeviceHair>(&hair_)) return gpu->readPositions(positions_ws);
    std::ranges::copy(std::get<Simulation>(hair_).positions_ws(), positions_ws.begin());
    return {};
}

Result<std::shared_ptr<const runtime::State>> MovingHair::state() {
    if (auto* const gpu = std::get_if<DeviceHair>(&hair_)) return gpu->readState();
    return std::get<Simulation>(hair_).state();
}

SimulationStats MovingHair::stats() const {
    if (const auto* const cpu = std::get_if<Simulation>(&hair_)) return cpu->stats();
    const auto& gpu = std::get<DeviceHair>(hair_);
    const DeviceFrame& frame = gpu.latestFrame();
    SimulationStats stats;
    stats.frames = frames_;
    stats.millisecondsPerFrame = frameMs_;
    stats.maxStretch = frame.maxStretch;
    stats.maxPenetrationMm = 1e3 * frame.maxPenetration;
    stats.energy = frame.kineticEnergy;
    stats.nanCount = frame.nanCount;
    stats.restoredStrands = frame.restoredStrands;
    stats.guardedStrands = frame.guardedStrands;
    stats.restingStrands = frame.report.asleep;
    stats.fastestMmPerSecond = 1e3 * static_cast<double>(frame.report.fastest);
    stats.effects = gpu_simulation::effectReports(gpu.engine());
    for (const auto& [cost, milliseconds] : costs_)
        stats.effects.push_back({std::string(frameCostName(cost)), true, "on, on the GPU", milliseconds, 0});
    return stats;
}

}  // namespace hairloom
