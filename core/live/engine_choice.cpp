// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/live/engine_choice.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/base/file.h"
#include "core/base/stopwatch.h"
#include "core/gpu_simulation/kernel_key.h"
#include "core/groom/poses.h"
#include "core/live/device_hair.h"
#include "core/live/groom_scene.h"
#include "core/simulation/simulation.h"
#include "core/software/device.h"

namespace hairloom {
namespace {

constexpr float kFrame = 1.0f / 60;  // seconds
constexpr int kWarmUp = 2, kMeasured = 6;
constexpr std::uint64_t kMaxMemoryBytes = 1u << 20u;

/// Of hairstyles that cost alike on one device.
std::string keyOf(const gpu::DeviceInfo& device, const Groom& groom) {
    const std::uint64_t hairs =
        groom.interpolation.followPerGuide > 0 ? std::uint64_t{groom.interpolation.followPerGuide} : 1;
    const auto size = [](std::uint64_t count) { return std::bit_width(count); };
    const char* const model = groom.simulation.strandModel == runtime::StrandModel::rods ? "rods" : "springs";
    const char* const skin = groom.body ? ", skin" : "";
    const char* const poses = followsPoses(groom) ? ", poses" : "";
    return fmt::format("{} | {} | {}{}{} | points 2^{}, hairs of each 2^{}, substeps {}", device.name,
                       device.driver, model, skin, poses, size(groom.pointCount()), size(hairs),
                       groom.simulation.substeps);
}

Result<double> cpuMilliseconds(const Groom& groom, const HeadMotion& motion) {
    auto simulation = Simulation::make(groom, motion.poseAt(0));
    if (!simulation) return tl::unexpected(simulation.error());
    auto scene = GroomScene::make(groom, {}, {});
    if (!scene) return tl::unexpected(scene.error());
    HeadPose before = motion.poseAt(0);
    Stopwatch watch;
    for (int frame = 1; frame <= kWarmUp + kMeasured; ++frame) {
        if (frame == kWarmUp + 1) watch = {};
        const float time = kFrame * static_cast<float>(frame);
        HeadStep head = stepOf(motion, before, time - kFrame, time);
        simulation->step(kFrame, head);
        scene->pose(simulation->positions_ws(), simulation->velocities_ws(), head.end);
        before = std::move(head.end);
    }
    return 1e3 * watch.seconds() / kMeasured;
}

Result<double> gpuMilliseconds(gpu::Device& device,
                               const std::shared_ptr<gpu_simulation::KernelLibrary>& kernels,
                               const Groom& groom, const HeadMotion& motion) {
    const auto scene = GroomScene::make(groom, {}, {});
    if (!scene) return tl::unexpected(scene.error());
    HeadPose before = motion.poseAt(0);
    auto hair = DeviceHair::make(device, kernels, *scene, nullptr, before);
    if (!hair) return tl::unexpected(hair.error());
    Stopwatch watch;
    for (int frame = 1; frame <= kWarmUp + kMeasured; ++frame) {
        if (frame == kWarmUp + 1) watch = {};
        auto list = device.createCommandList();
        if (!list) return tl::unexpected(list.error());
        const float time = kFrame * static_cast<float>(frame);
        HeadStep head = stepOf(motion, before, time - kFrame, time);
        auto recorded = hair->record(**list, kFrame, static_cast<double>(time), head.end, head.within);
        before = std::move(head.end);
        if (!recorded) return tl::unexpected(recorded.error());
        auto submission = device.submit(std::move(*list));
        if (!submission) return tl::unexpected(submission.error());
        hair->submitted(*submission);
        if (frame != kWarmUp && frame != kWarmUp + kMeasured) continue;
        if (auto done = (*submission)->wait(); !done) return tl::unexpected(done.error());
    }
    return 1e3 * watch.seconds() / kMeasured;
}

Result<EngineTimes> measure(gpu::Device& device,
                            const std::shared_ptr<gpu_simulation::KernelLibrary>& kernels,
                            const Groom& groom) {
    const auto motion = makeRigidMotion("nod", groom);
    if (!motion) return tl::unexpected(motion.error());
    const auto gpu = gpuMilliseconds(device, kernels, groom, **motion);
    if (!gpu) return tl::unexpected(gpu.error());
    const auto cpu = cpuMilliseconds(groom, **motion);
    if (!cpu) return tl::unexpected(cpu.error());
    return EngineTimes{*cpu, *gpu};
}

/// Why the device cannot run these settings; empty where it can.
std::string obstacle(gpu::Device* device, const Groom& groom) {
    if (device == nullptr || software::isSoftware(*device)) return "there is no GPU";
    std::string why = gpu_simulation::bodyError(device->info(), groom.simulation, groom.body.get());
    if (!why.empty()) return why;
    return gpu_simulation::kernelError(groom.simulation);
}

}  // namespace

std::span<const std::string_view> engineWishNames() {
    static constexpr std::array<std::string_view, 3> kNames{"auto", "gpu", "cpu"};
    return kNames;
}

std::string_view engineName(EngineKind kind) {
    return kind == EngineKind::gpu ? "gpu" : "cpu";
}

EngineMemory EngineMemory::ofUser() {
    const std::filesystem::path kernels = gpu_simulation::userKernelFolder();
    return EngineMemory(kernels.empty() ? kernels : kernels.parent_path() / "engines.json");
}

std::optional<EngineTimes> EngineMemory::find(const std::string& key) const {
    if (file_.empty()) return {};
    const auto text = readTextFile(file_, kMaxMemoryBytes);
    if (!text) return {};
    const auto all = nlohmann::json::parse(*text, nullptr, false);
    if (!all.is_object() || !all.contains(key)) return {};
    const auto& found = all[key];
    if (!found.is_array() || found.size() != 2 || !found[0].is_number() || !found[1].is_number()) return {};
    return EngineTimes{found[0].get<double>(), found[1].get<double>()};
}

void EngineMemory::keep(const std::string& key, const EngineTimes& times) const {
    if (file_.empty()) return;
    nlohmann::json all = nlohmann::json::object();
    if (const auto text = readTextFile(file_, kMaxMemoryBytes)) {
        auto known = nlohmann::json::parse(*text, nullptr, false);
        if (known.is_object()) all = std::move(known);
    }
    all[key] = {times.cpu, times.gpu};
    std::error_code failure;
    std::filesystem::create_directories(file_.parent_path(), failure);
    const std::string text = all.dump(1);
    static_cast<void>(writeFileAtomically(file_, std::as_bytes(std::span(text)), Replacing::Anything));
}

EngineChoice chooseEngine(EngineWish wish, gpu::Device* device, const Groom& groom,
                          const EngineMemory& memory, const std::function<Result<EngineTimes>()>& measure) {
    if (wish == EngineWish::cpu) return {EngineKind::cpu, "you asked for it"};
    if (const std::string why = obstacle(device, groom); !why.empty()) return {EngineKind::cpu, why};
    if (wish == EngineWish::gpu) return {EngineKind::gpu, "you asked for it"};
    const gpu::DeviceInfo& info = device->info();
    if (info.type == gpu::DeviceType::Cpu)
        return {EngineKind::cpu, fmt::format("{} is a software device", info.name)};
    const std::string key = keyOf(info, groom);
    auto times = memory.find(key);
    if (!times) {
        const auto measured = measure();
        if (!measured) return {EngineKind::cpu, "the GPU cannot: " + measured.error().message()};
        memory.keep(key, *measured);
        times = *measured;
    }
    const bool gains = times->gpu < times->cpu;
    return {gains ? EngineKind::gpu : EngineKind::cpu,
            fmt::format("{:.2f} ms per frame on {}, {:.2f} on the CPU", times->gpu, info.name, times->cpu)};
}

EngineChoice chooseEngine(EngineWish wish, gpu::Device* device,
                          const std::shared_ptr<gpu_simulation::KernelLibrary>& kernels, const Groom& groom,
                          const EngineMemory& memory) {
    return chooseEngine(wish, device, groom, memory, [&] { return measure(*device, kernels, groom); });
}

}  // namespace hairloom
