// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cost/gpu_cost.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/cost/statistics.h"
#include "core/gpu_simulation/compiled_kernel.h"
#include "shaders/shared/group_sizes.h"

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

    /// Starts so many copies, and waits for none.
    Result<gpu::SubmissionPtr> start(std::uint32_t copies) const {
        auto list = device_->createCommandList();
        if (!list) return tl::unexpected(list.error());
        const auto groups = static_cast<std::uint32_t>(source_->desc().size / kGroupBytes);
        gpu::PassDesc pass;
        pass.name = "copies";
        (*list)->beginPass(pass);
        (*list)->setPipeline(kernel_);
        const gpu::Binding bindings[] = {gpu::Binding::read(0, source_), gpu::Binding::write(0, target_)};
        (*list)->bind(bindings);
        for (std::uint32_t n = 0; n < copies; ++n)
            (*list)->dispatch(std::min<std::uint32_t>(groups, HAIRLOOM_COPY_ROW),
                              (groups + HAIRLOOM_COPY_ROW - 1) / HAIRLOOM_COPY_ROW);
        (*list)->endPass();
        return device_->submit(std::move(*list));
    }

    /// GB/s read and written by the device's clock, or by this machine's where the device has none.
    Result<double> run() const {
        const auto begin = Clock::now();
        const auto submission = start(kCopies);
        if (!submission) return tl::unexpected(submission.error());
        const auto times = (*submission)->passTimes();
        if (!times) return tl::unexpected(times.error());
        const double wall = millisecondsSince(begin), own = times->front().milliseconds;
        return 2.0 * kCopies * static_cast<double>(source_->desc().size) * 1e-6 / (own > 0.0 ? own : wall);
    }

  private:
    static constexpr std::uint32_t kElementBytes = 16, kGroupBytes = HAIRLOOM_COPY_GROUP * kElementBytes;
    static constexpr std::uint32_t kCopies = 8;

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

/// Gives a GPU work for a while. What is copied stays in its caches beside the hair.
class KeptBusy {
  public:
    static Result<std::shared_ptr<const KeptBusy>> make(gpu::Device& device) {
        constexpr std::uint64_t kLittle = 2u << 20u;
        auto copies = Copies::make(device, kLittle);
        if (!copies) return tl::unexpected(copies.error());
        std::vector<double> each;
        for (int run = 0; run < 5; ++run) {
            const auto begin = Clock::now();
            const auto submission = copies->start(kSome);
            if (!submission) return tl::unexpected(submission.error());
            if (auto done = (*submission)->wait(); !done) return tl::unexpected(done.error());
            each.push_back(millisecondsSince(begin) / kSome);
        }
        return std::shared_ptr<const KeptBusy>(new KeptBusy(std::move(*copies), quartiles(each).median));
    }
    /// For about so many milliseconds from now on.
    Status stay(double milliseconds) const {
        const double copies = std::clamp(std::ceil(milliseconds / each_), 1.0, kMax);
        const auto submission = copies_.start(static_cast<std::uint32_t>(copies));
        return submission ? Status() : Status(tl::unexpected(submission.error()));
    }

  private:
    static constexpr std::uint32_t kSome = 200;
    static constexpr double kMax = 4000.0;
    KeptBusy(Copies copies, double each) : copies_(std::move(copies)), each_(each) {}

    Copies copies_;
    double each_;  // milliseconds of one
};

const char* leftOutName(LeftOut effect) {
    constexpr const char* kNames[] = {"nothing", "wind", "collision", "angular", "length", "damping"};
    return kNames[static_cast<std::size_t>(effect)];
}

runtime::SimulationSettings settingsWithout(LeftOut effect, runtime::StrandModel model) {
    runtime::SimulationSettings s = scenes::settingsFor(scenes::ActiveForces::windAndSpheres, model);
    switch (effect) {
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

std::vector<NamedLayout> measuredLayouts(gpu::DeviceType type) {
    std::vector<NamedLayout> layouts{{"chosen", {}},
                                     {"lanes, 1 strand a group", {StrandStorage::lanes, true, 1, 1}},
                                     {"lanes, 2 strands a group", {StrandStorage::lanes, true, 2, 1}},
                                     {"lanes, 4 strands a group", {StrandStorage::lanes, true, 4, 1}},
                                     {"lanes, loops", {StrandStorage::lanes, false, {}, 1}},
                                     {"pairs, 2 strands a group", {StrandStorage::lanes, true, 2, 2}},
                                     {"pairs, 4 strands a group", {StrandStorage::lanes, true, 4, 2}},
                                     {"pairs, 8 strands a group", {StrandStorage::lanes, true, 8, 2}},
                                     {"pairs, 16 strands a group", {StrandStorage::lanes, true, 16, 2}},
                                     {"pairs, 32 strands a group", {StrandStorage::lanes, true, 32, 2}},
                                     {"pairs, loops", {StrandStorage::lanes, false, {}, 2}},
                                     {"lanes, no waves", {StrandStorage::lanes, true, 2, 1, false}},
                                     {"pairs, no waves", {StrandStorage::lanes, true, 4, 2, false}},
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

std::vector<NamedLayout> measuredRodLayouts(gpu::DeviceType type) {
    if (type == gpu::DeviceType::Cpu) return {};
    return {{"1 thread a strand", {.members = 1}},
            {"4 threads a strand", {.members = 4}},
            {"8 threads a strand", {.members = 8}},
            {"16 threads a strand", {.members = 16}}};
}

GpuStepRun::GpuStepRun(std::unique_ptr<MovingStrands> strands, gpu_simulation::StrandEngine engine,
                       std::shared_ptr<const KeptBusy> busy)
    : strands_(std::move(strands)), engine_(std::move(engine)), busy_(std::move(busy)) {}

Result<GpuStepRun> GpuStepRun::make(gpu::Device& device,
                                    std::shared_ptr<gpu_simulation::KernelLibrary> kernels,
                                    std::unique_ptr<MovingStrands> strands,
                                    const runtime::SimulationSettings& settings,
                                    const gpu_simulation::LayoutOptions& layout) {
    gpu_simulation::EngineOptions options;
    options.layout = layout;
    auto engine =
        gpu_simulation::StrandEngine::make(device, std::move(kernels), strands->view(), settings, options);
    if (!engine) return tl::unexpected(engine.error());
    std::vector<runtime::RootFrame> roots;
    std::vector<runtime::Sphere> spheres;
    strands->move(0.0, roots, spheres);
    if (auto placed = engine->reset(roots); !placed) return tl::unexpected(placed.error());
    std::shared_ptr<const KeptBusy> busy;
    if (device.info().type != gpu::DeviceType::Cpu) {
        auto made = KeptBusy::make(device);
        if (!made) return tl::unexpected(made.error());
        busy = std::move(*made);
    }
    return GpuStepRun(std::move(strands), std::move(*engine), std::move(busy));
}

void GpuStepRun::nextFrame() {
    time_ += static_cast<double>(kFrame);
    strands_->move(time_, roots_, spheres_);
    input_.dt = kFrame;
    input_.time = time_;
    input_.roots_ws = roots_;
    input_.spheres = spheres_;
}

/// One frame at a time. `device` takes what the device's clock says, where it is asked for.
Result<std::vector<double>> GpuStepRun::wallOf(std::uint32_t frames, std::vector<double>* device) {
    std::vector<double> wall;
    for (std::uint32_t f = 0; f < frames; ++f) {
        nextFrame();
        const auto begin = Clock::now();
        if (auto status = engine_.step(input_); !status) return tl::unexpected(status.error());
        const auto spent = engine_.wait();
        wall.push_back(millisecondsSince(begin));
        if (!spent) return tl::unexpected(spent.error());
        if (device != nullptr) device->push_back(*spent);
    }
    return wall;
}

/// By the device's clock, of frames that find it at work on copies. `wall`: of a frame that does not,
/// milliseconds.
Result<std::vector<double>> GpuStepRun::deviceOf(std::uint32_t frames, double wall) {
    // Until the device is at speed: an H200 that has rested takes more than a tenth of that for its clock to
    // rise.
    constexpr double kToSpeed = 1.0;
    const auto begin = Clock::now();
    std::vector<double> device;
    while (device.size() < frames) {
        nextFrame();
        if (auto kept = busy_->stay(wall); !kept) return tl::unexpected(kept.error());
        if (auto status = engine_.step(input_); !status) return tl::unexpected(status.error());
        const auto spent = engine_.wait();
        if (!spent) return tl::unexpected(spent.error());
        if (millisecondsSince(begin) > 1e3 * kToSpeed) device.push_back(*spent);
    }
    return device;
}

Result<std::vector<double>> GpuStepRun::togetherOf(std::uint32_t frames) {
    std::vector<double> together;
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
    return together;
}

Result<GpuFrameCost> GpuStepRun::cost(std::uint32_t frames) {
    std::vector<double> device;
    const auto wall = wallOf(frames, busy_ == nullptr ? &device : nullptr);
    if (!wall) return tl::unexpected(wall.error());
    const double wallMedian = quartiles(*wall).median;
    const auto together = togetherOf(frames);
    if (!together) return tl::unexpected(together.error());
    if (busy_ != nullptr) {
        auto measured = deviceOf(frames, wallMedian);
        if (!measured) return tl::unexpected(measured.error());
        device = std::move(*measured);
    }
    return GpuFrameCost{quartiles(device).median, wallMedian, quartiles(*together).median};
}

Result<std::uint32_t> GpuStepRun::framesFor(double seconds) {
    const auto begin = Clock::now();
    double last = 1.0;
    for (std::uint32_t run = 0; run < 20 || (millisecondsSince(begin) < 1e3 * kWarmUp && run < 1000); ++run) {
        const auto wall = wallOf(1, nullptr);
        if (!wall) return tl::unexpected(wall.error());
        last = wall->front();
        if (millisecondsSince(begin) > 1e4 * kWarmUp) break;
    }
    return static_cast<std::uint32_t>(std::clamp(std::ceil(seconds * 1e3 / last), 4.0, 240.0));
}

double GpuStepRun::work() const {
    return static_cast<double>(engine_.pointCount()) * substepsIn(engine_.settings(), kFrame);
}

Result<double> copyBandwidth(gpu::Device& device) {
    constexpr int kRuns = 5;
    constexpr std::uint64_t kMax = 256u << 20u;
    const auto copies = Copies::make(device, kMax);
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
