// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/accuracy/gpu_cost.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/accuracy/statistics.h"
#include "core/gpu_simulation/compiled_kernel.h"

namespace hairloom {
namespace {

using Clock = std::chrono::steady_clock;
using gpu_simulation::StrandStorage;

constexpr float kFrame = 1.0f / 60.0f;
constexpr std::uint32_t kTogether = 16;  // frames that are timed as one
constexpr double kWarmUp = 0.1;          // seconds

double millisecondsSince(Clock::time_point begin) {
    return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

runtime::SimulationSettings settingsOf(const GpuStepScene& scene) {
    runtime::SimulationSettings s = scenes::settingsFor(scene.acting);
    s.substeps = scene.substeps;
    switch (scene.leftOut) {
        case LeftOut::nothing:
        case LeftOut::collision:
            break;
        case LeftOut::wind:
            s.airDrag = 0.0f;
            break;
        case LeftOut::angular:
            s.angularStiffness = 0.0f;
            break;
        case LeftOut::length:
            s.lengthIterations = 0;
            break;
        case LeftOut::damping:
            s.dampingTime = 0.0f;
            break;
    }
    return s;
}

}  // namespace

const char* leftOutName(LeftOut effect) {
    constexpr const char* kNames[] = {"nothing", "wind", "collision", "angular", "length", "damping"};
    return kNames[static_cast<std::size_t>(effect)];
}

std::vector<NamedLayout> measuredLayouts(gpu::DeviceType type) {
    std::vector<NamedLayout> layouts{{"chosen", {}},
                                     {"lanes, 1 strand a group", {StrandStorage::lanes, true, 1, 1}},
                                     {"lanes, 2 strands a group", {StrandStorage::lanes, true, 2, 1}},
                                     {"lanes, 4 strands a group", {StrandStorage::lanes, true, 4, 1}},
                                     {"lanes, loops", {StrandStorage::lanes, false, {}, 1}},
                                     {"pairs, 2 strands a group", {StrandStorage::lanes, true, 2, 2}},
                                     {"pairs, 4 strands a group", {StrandStorage::lanes, true, 4, 2}},
                                     {"pairs, 8 strands a group", {StrandStorage::lanes, true, 8, 2}},
                                     {"pairs, loops", {StrandStorage::lanes, false, {}, 2}},
                                     {"threads, unrolled", {StrandStorage::threads, true}},
                                     {"threads, loops", {StrandStorage::threads, false}},
                                     {"groups, unrolled", {StrandStorage::groups, true}},
                                     {"groups, loops", {StrandStorage::groups, false}},
                                     {"wisps, unrolled", {StrandStorage::wisps, true}},
                                     {"wisps, loops", {StrandStorage::wisps, false}},
                                     {"buffers", {StrandStorage::buffers, false}}};
    if (type == gpu::DeviceType::Cpu)
        std::erase_if(layouts, [](const NamedLayout& layout) { return layout.options.unroll; });
    return layouts;
}

GpuStepRun::GpuStepRun(const GpuStepScene& scene, scenes::HeadOfHair head,
                       gpu_simulation::StrandEngine engine)
    : scene_(scene), head_(std::move(head)), engine_(std::move(engine)) {}

Result<GpuStepRun> GpuStepRun::make(gpu::Device& device,
                                    std::shared_ptr<gpu_simulation::KernelLibrary> kernels,
                                    const GpuStepScene& scene) {
    scenes::HeadOfHair head(scene.strands, scene.points);
    gpu_simulation::EngineOptions options;
    options.layout = scene.layout;
    auto engine = gpu_simulation::StrandEngine::make(device, std::move(kernels), head.view(),
                                                     settingsOf(scene), options);
    if (!engine) return tl::unexpected(engine.error());
    std::vector<runtime::RootFrame> roots;
    head.placeRoots(0.0, roots);
    if (auto placed = engine->reset(roots); !placed) return tl::unexpected(placed.error());
    return GpuStepRun(scene, std::move(head), std::move(*engine));
}

void GpuStepRun::nextFrame() {
    time_ += static_cast<double>(kFrame);
    head_.placeRoots(time_, roots_);
    input_.dt = kFrame;
    input_.time = time_;
    input_.roots_ws = roots_;
    const bool spheres =
        scene_.acting == scenes::Acting::windAndSpheres && scene_.leftOut != LeftOut::collision;
    if (spheres) input_.spheres = head_.spheres;
}

Result<GpuFrameCost> GpuStepRun::cost(std::uint32_t frames) {
    std::vector<double> device, wall, together;
    for (std::uint32_t f = 0; f < frames; ++f) {
        nextFrame();
        const auto begin = Clock::now();
        if (auto status = engine_.step(input_); !status) return tl::unexpected(status.error());
        const auto spent = engine_.wait();
        wall.push_back(millisecondsSince(begin));
        if (!spent) return tl::unexpected(spent.error());
        device.push_back(*spent);
    }
    for (std::uint32_t f = 0; f < std::max(frames / kTogether, 1u); ++f) {
        const auto begin = Clock::now();
        double between = 0.0;
        for (std::uint32_t n = 0; n < kTogether; ++n) {
            const auto making = Clock::now();
            nextFrame();
            between += millisecondsSince(making);
            if (auto status = engine_.step(input_); !status) return tl::unexpected(status.error());
        }
        if (const auto done = engine_.wait(); !done) return tl::unexpected(done.error());
        // While roots are made the device may work on: what is left is at least what the frames took of both.
        together.push_back(std::max(millisecondsSince(begin) - between, 0.0) / kTogether);
    }
    return GpuFrameCost{quartiles(device).median, quartiles(wall).median, quartiles(together).median};
}

Result<std::uint32_t> GpuStepRun::framesFor(double seconds) {
    const auto begin = Clock::now();
    double last = 1.0;
    for (std::uint32_t run = 0; run < 20 || (millisecondsSince(begin) < 1e3 * kWarmUp && run < 1000); ++run) {
        const auto cost = this->cost(1);
        if (!cost) return tl::unexpected(cost.error());
        last = cost->wall;
        if (millisecondsSince(begin) > 1e4 * kWarmUp) break;
    }
    return static_cast<std::uint32_t>(std::clamp(std::ceil(seconds * 1e3 / last), 4.0, 240.0));
}

double GpuStepRun::work() const {
    return static_cast<double>(engine_.pointCount()) * scene_.substeps;
}

namespace {

/// Buffers that are copied over and over by a kernel.
class Copies {
  public:
    static Result<Copies> make(gpu::Device& device, std::uint64_t bytes) {
        gpu::BufferDesc desc;
        desc.name = "copied";
        desc.size = std::min(bytes, device.info().maxBufferBytes) / kGroupBytes * kGroupBytes;
        desc.usage = gpu::Usage::ShaderRead | gpu::Usage::UnorderedAccess;
        desc.elementBytes = kElementBytes;
        auto source = device.createBuffer(desc);
        if (!source) return tl::unexpected(source.error());
        auto target = device.createBuffer(desc);
        if (!target) return tl::unexpected(target.error());
        auto kernel = gpu_simulation::compiledKernel(device, "copy_buffer");
        if (!kernel) return tl::unexpected(kernel.error());
        return Copies(device, std::move(*source), std::move(*target), std::move(*kernel));
    }

    /// GB/s read and written by the device's clock, or by this machine's where the device has none.
    Result<double> run() const {
        auto list = device_->createCommandList();
        if (!list) return tl::unexpected(list.error());
        const auto groups = static_cast<std::uint32_t>(source_->desc().size / kGroupBytes);
        gpu::PassDesc pass;
        pass.name = "copies";
        (*list)->beginPass(pass);
        (*list)->setPipeline(kernel_);
        const gpu::Binding bindings[] = {gpu::Binding::read(0, source_), gpu::Binding::write(0, target_)};
        (*list)->bind(bindings);
        for (int n = 0; n < kCopies; ++n)
            (*list)->dispatch(std::min(groups, kRow), (groups + kRow - 1) / kRow);
        (*list)->endPass();
        const auto begin = Clock::now();
        const auto submission = device_->submit(std::move(*list));
        if (!submission) return tl::unexpected(submission.error());
        const auto times = (*submission)->passTimes();
        if (!times) return tl::unexpected(times.error());
        const double wall = millisecondsSince(begin), own = times->front().milliseconds;
        return 2.0 * kCopies * static_cast<double>(source_->desc().size) * 1e-6 / (own > 0.0 ? own : wall);
    }

  private:
    static constexpr std::uint32_t kElementBytes = 16, kGroupBytes = 256 * kElementBytes, kRow = 65535;
    static constexpr int kCopies = 8;

    Copies(gpu::Device& device, gpu::BufferPtr source, gpu::BufferPtr target, gpu::ComputePipelinePtr kernel)
        : device_(&device),
          source_(std::move(source)),
          target_(std::move(target)),
          kernel_(std::move(kernel)) {}

    gpu::Device* device_;
    gpu::BufferPtr source_, target_;
    gpu::ComputePipelinePtr kernel_;
};

}  // namespace

Result<double> copyBandwidth(gpu::Device& device) {
    constexpr int kRuns = 5;
    constexpr std::uint64_t kMost = 256u << 20u;
    const auto copies = Copies::make(device, kMost);
    if (!copies) return tl::unexpected(copies.error());
    double best = 0.0;
    for (int run = 0; run < kRuns; ++run) {
        auto bandwidth = copies->run();
        if (!bandwidth) return bandwidth;
        best = std::max(best, *bandwidth);
    }
    return best;
}

Status bringToSpeed(gpu::Device& device, double seconds) {
    constexpr std::uint64_t kSome = 16u << 20u;
    const auto copies = Copies::make(device, kSome);
    if (!copies) return tl::unexpected(copies.error());
    const auto begin = Clock::now();
    do {
        if (const auto ran = copies->run(); !ran) return tl::unexpected(ran.error());
    } while (millisecondsSince(begin) < 1e3 * seconds);
    return {};
}

std::optional<double> crossing(const std::vector<double>& counts, const std::vector<double>& falling,
                               const std::vector<double>& other) {
    for (std::size_t i = 0; i < counts.size(); ++i) {
        const double now = std::log(falling[i] / other[i]);
        if (!(now < 0.0)) continue;
        if (i == 0) return counts.front();
        const double before = std::log(falling[i - 1] / other[i - 1]);
        const double share = before / (before - now);
        return std::exp(std::log(counts[i - 1]) + share * std::log(counts[i] / counts[i - 1]));
    }
    return {};
}

}  // namespace hairloom
