// SPDX-License-Identifier: GPL-3.0-or-later
// The editor's loop without its window: hair on a nodding head in wind, moved and drawn as the viewport does
// while something moves, by the engine on the GPU and by the one on the CPU.

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <map>

#include "benchmarks/benchmark.h"
#include "benchmarks/sample_hair.h"
#include "core/accuracy/benchmark_scenes.h"
#include "core/base/stopwatch.h"
#include "core/render/renderer.h"
#include "core/scene/live_hair.h"
#include "core/scene/open.h"

namespace hairloom::benchmarks {
namespace {

constexpr float kFrame = 1.0f / 60;  // seconds
constexpr float kWind = 4;           // m/s
constexpr std::uint32_t kWarmUp = 8;
constexpr std::size_t kUnderWay = 2;  // frames
constexpr std::string_view kMany = "100000x16";

/// Means of a frame, milliseconds and bytes.
struct Row {
    std::string groom;
    EngineKind engine = EngineKind::cpu;
    std::uint64_t hairs = 0;
    double simulate = 0, follow = 0, shadow = 0, shade = 0, draw = 0, wall = 0;
    double toDevice = 0, fromDevice = 0;
    double pointBytes = 0;                 ///< of all points that are drawn, once
    std::map<std::string, double> passes;  ///< on the device, ms

    double frame() const { return simulate + follow + shadow + shade + draw; }
};

/// 10,000 guides of 16 points on a ball, and ten hairs around each.
Groom manyHairs() {
    const scenes::HeadOfHair head(10'000, 16);
    std::vector<Vec3f> positions;
    for (const runtime::Float3& p : head.positions) positions.emplace_back(p.x, p.y, p.z);
    Groom groom = makeGroom(head.offsets, std::move(positions));
    for (const runtime::Sphere& sphere : head.spheres) {
        CollisionSphere placed;
        placed.centre = {sphere.center_ws.x, sphere.center_ws.y, sphere.center_ws.z};
        placed.radius = sphere.radius;
        groom.spheres.push_back(placed);
    }
    groom.interpolation.followPerGuide = 10;
    return groom;
}

Result<Sample> groomOf(const std::string& name) {
    if (name == kMany) return Sample{name, manyHairs()};
    if (std::filesystem::exists(name)) {
        auto opened = loadDocument(name);
        if (!opened) return tl::unexpected(opened.error());
        return Sample{name, std::move(*opened)};
    }
    const auto& known = samples();
    if (!known) return tl::unexpected(known.error());
    const auto sample = std::ranges::find(*known, name + " sample", &Sample::name);
    if (sample == known->end())
        return fail(fmt::format("there is no hairstyle '{}'", name),
                    "expected a sample, a file, or 100000x16");
    return *sample;
}

Result<std::vector<Sample>> groomsOf(const Options& options) {
    if (options.grooms.empty()) return samples();
    std::vector<Sample> grooms;
    for (const std::string& name : options.grooms) {
        auto groom = groomOf(name);
        if (!groom) return tl::unexpected(groom.error());
        grooms.push_back(std::move(*groom));
    }
    return grooms;
}

/// As the viewport draws while something moves.
render::RenderOptions viewportOptions(std::pair<std::uint32_t, std::uint32_t> size) {
    render::RenderOptions options;
    std::tie(options.width, options.height) = size;
    options.frames = 1;
    options.samples = 1;
    options.subdivisions = 1;
    options.shadowResolution = 512;
    options.skyStrands = 1024;
    options.detail = 0.5f;
    options.bakeBehind = true;
    return options;
}

class Loop {
  public:
    Loop(gpu::Device& device, std::shared_ptr<gpu_simulation::KernelLibrary> kernels,
         const render::RenderOptions& options)
        : device_(device), kernels_(std::move(kernels)), options_(options), renderer_(device) {}

    Result<Row> run(const Sample& sample, EngineKind engine, std::uint32_t frames) {
        Groom groom = sample.groom;
        groom.simulation.windSpeed = kWind;
        const auto motion = makeRigidMotion("nod", groom);
        if (!motion) return tl::unexpected(motion.error());
        auto scene = GroomScene::make(groom, {}, {});
        if (!scene) return tl::unexpected(scene.error());
        auto live = LiveHair::make(device_, kernels_, std::move(*scene), **motion, engine);
        if (!live) return tl::unexpected(live.error());
        if (auto status = setUp(live->scene()); !status) return tl::unexpected(status.error());
        row_ = {};
        row_.groom = sample.name;
        row_.engine = engine;
        if (auto status = play(*live, kWarmUp); !status) return tl::unexpected(status.error());
        row_ = {};
        row_.groom = sample.name;
        row_.engine = engine;
        const gpu::Traffic before = device_.traffic();
        const Stopwatch watch;
        if (auto status = play(*live, frames); !status) return tl::unexpected(status.error());
        row_.wall = 1e3 * watch.seconds();
        const gpu::Traffic after = device_.traffic();
        row_.toDevice = static_cast<double>(after.toDevice - before.toDevice);
        row_.fromDevice = static_cast<double>(after.fromDevice - before.fromDevice);
        for (double* sum : {&row_.simulate, &row_.follow, &row_.shadow, &row_.shade, &row_.draw, &row_.wall,
                            &row_.toDevice, &row_.fromDevice})
            *sum /= frames;
        for (auto& [name, milliseconds] : row_.passes) milliseconds /= frames;
        const render::RenderScene drawn = live->scene().scene();
        row_.hairs = drawn.strands.front().offsets.size() - 1;
        row_.pointBytes = static_cast<double>(drawn.strands.front().positions_ws.size_bytes());
        return row_;
    }

  private:
    Status setUp(const GroomScene& groom) {
        render::RenderScene scene = groom.scene();
        const float aspect = static_cast<float>(options_.width) / static_cast<float>(options_.height);
        scene.camera = render::frame(render::View::ThreeQuarter, groom.subject(), aspect);
        scene.lights = render::studioLights(scene.camera);
        gpu::TextureDesc desc;
        desc.name = "bench";
        desc.width = options_.width;
        desc.height = options_.height;
        desc.usage = gpu::Usage::RenderTarget;
        auto target = device_.createTexture(desc);
        if (!target) return tl::unexpected(target.error());
        target_ = std::move(*target);
        return renderer_.setScene(scene);
    }

    Status play(LiveHair& live, std::uint32_t count) {
        std::deque<gpu::SubmissionPtr> underWay;
        for (std::uint32_t frame = 0; frame < count; ++frame) {
            auto list = device_.createCommandList();
            if (!list) return tl::unexpected(list.error());
            if (auto status = live.record(**list, renderer_, kFrame); !status) return status;
            if (auto status = renderer_.record(**list, options_, target_); !status) return status;
            auto submission = device_.submit(std::move(*list));
            if (!submission) return tl::unexpected(submission.error());
            live.submitted(*submission);
            row_.simulate += live.simulateMilliseconds();
            row_.follow += live.followMilliseconds();
            underWay.push_back(std::move(*submission));
            while (underWay.size() > (frame + 1 == count ? 0 : kUnderWay)) {
                if (auto status = add(*underWay.front()); !status) return status;
                underWay.pop_front();
            }
        }
        return {};
    }

    Status add(gpu::Submission& submission) {
        const auto times = submission.passTimes();
        if (!times) return tl::unexpected(times.error());
        for (const gpu::PassTime& time : *times) {
            sumOf(time.name) += time.milliseconds;
            row_.passes[time.name] += time.milliseconds;
        }
        return {};
    }

    double& sumOf(std::string_view pass) {
        using render::Pass;
        const auto isOne = [&](std::initializer_list<std::string_view> names) {
            return std::ranges::find(names, pass) != names.end();
        };
        if (isOne({"head", "roots", "roots of slots", "strands", "measures", "extent"})) return row_.simulate;
        if (isOne({"wisps", "follow hairs"})) return row_.follow;
        if (isOne({passName(Pass::headDepth), passName(Pass::firstHair), passName(Pass::opacity),
                   passName(Pass::skyHead), passName(Pass::skyFirst), passName(Pass::skyLayers),
                   passName(Pass::skySeen)}))
            return row_.shadow;
        if (isOne({passName(Pass::shade), passName(Pass::curves)})) return row_.shade;
        return row_.draw;
    }

    gpu::Device& device_;
    std::shared_ptr<gpu_simulation::KernelLibrary> kernels_;
    render::RenderOptions options_;
    render::Renderer renderer_;
    gpu::TexturePtr target_;
    Row row_;
};

Report reportOf(const Row& row) {
    return Report{{"groom", row.groom},
                  {"engine", engineName(row.engine)},
                  {"hairs", row.hairs},
                  {"simulate_ms", row.simulate},
                  {"follow_ms", row.follow},
                  {"shadow_ms", row.shadow},
                  {"shade_ms", row.shade},
                  {"draw_ms", row.draw},
                  {"frame_ms", row.frame()},
                  {"wall_ms", row.wall},
                  {"bytes_to_device", row.toDevice},
                  {"bytes_from_device", row.fromDevice},
                  {"point_bytes", row.pointBytes},
                  {"passes", row.passes}};
}

std::string markdownOf(const std::vector<Row>& rows, const Options& options, const gpu::DeviceInfo& device) {
    std::string text = fmt::format("`{}`\n\n{}, {}\n\n", options.commandLine, device.name, device.driver);
    text +=
        "| hairstyle | engine | hairs | simulate | follow | shadow | shade | draw | frame ms | wall ms | to "
        "device "
        "KB | from device KB |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n";
    for (const Row& row : rows) {
        text += fmt::format(
            "| {} | {} | {} | {:.3f} | {:.3f} | {:.3f} | {:.3f} | {:.3f} | {:.2f} | {:.2f} | {:.1f} | {:.1f} "
            "|\n",
            row.groom, engineName(row.engine), row.hairs, row.simulate, row.follow, row.shadow, row.shade,
            row.draw, row.frame(), row.wall, row.toDevice / 1000, row.fromDevice / 1000);
    }
    return text;
}

Result<Outcome> run(const Options& options) {
    auto grooms = groomsOf(options);
    if (!grooms) return tl::unexpected(grooms.error());
    gpu::DeviceOptions wanted;
    wanted.index = options.device;
    const auto device = gpu::createDevice(wanted);
    if (!device) return tl::unexpected(device.error());
    const gpu::DeviceInfo& info = (*device)->info();
    const bool software = info.type == gpu::DeviceType::Cpu;
    if (options.grooms.empty() && !options.quick && !software)
        grooms->push_back({std::string(kMany), manyHairs()});
    const auto kernels =
        std::make_shared<gpu_simulation::KernelLibrary>(**device, gpu_simulation::userKernelFolder());
    const auto size = options.size.value_or(software ? std::pair(320u, 180u) : std::pair(1920u, 1080u));
    const std::uint32_t frames = options.frames.value_or(options.quick ? 8 : software ? 20 : 240);
    Loop loop(**device, kernels, viewportOptions(size));
    std::vector<Row> rows;
    Outcome outcome;
    outcome.report = Report{{"name", "live"},      {"device", info.name},   {"driver", info.driver},
                            {"width", size.first}, {"height", size.second}, {"frames", frames}};
    Report all = Report::array();
    for (const Sample& groom : *grooms) {
        for (const EngineKind engine : {EngineKind::gpu, EngineKind::cpu}) {
            auto row = loop.run(groom, engine, frames);
            if (!row) return tl::unexpected(row.error());
            all.push_back(reportOf(*row));
            rows.push_back(std::move(*row));
            if (options.progress) options.progress("playing", rows.size(), 2 * grooms->size());
        }
    }
    outcome.report["rows"] = std::move(all);
    outcome.markdown = markdownOf(rows, options, info);
    return outcome;
}

}  // namespace

Benchmark liveBenchmark() {
    return {
        "live",
        "the editor's loop without a window: hair moved and drawn by the engine on the GPU and on the CPU",
        {"--quick", "--device", "--size", "--grooms", "--frames", "--markdown"},
        run};
}

}  // namespace hairloom::benchmarks
