// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gpu_simulation/strand_engine.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>

#include "core/gpu_simulation/strand_engine_impl.h"
#include "runtime/engine/checks.h"

namespace hairloom::gpu_simulation {
namespace {

using gpu::Usage;
using runtime::Effect;
using runtime::Float3;

constexpr std::size_t kMaxSubmissionsInFlight = 2;
constexpr Usage kReadWrite = Usage::ShaderRead | Usage::UnorderedAccess;

}  // namespace

Result<StrandEngine> StrandEngine::make(gpu::Device& device, std::shared_ptr<KernelLibrary> kernels,
                                        const runtime::StrandsView& strands,
                                        const runtime::SimulationSettings& settings,
                                        const EngineOptions& options) {
    if (const std::string why = runtime::validationError(settings); !why.empty()) return fail(why);
    if (const std::string why = runtime::validationError(strands); !why.empty()) return fail(why);
    if (const std::string why = kernelError(settings); !why.empty()) return fail(why);
    if (strands.offsets.size() < 2) return fail("there are no strands", "expected strands to simulate");
    auto impl = std::make_unique<Impl>(device, std::move(kernels), options);
    impl->shape = runtime::makeRestShape(strands);
    impl->wanted = settings;
    impl->run.settings = settings;
    LayoutOptions layout = options.layout;
    const bool direct3d = device.info().backend == gpu::Backend::Direct3D11;
    if (direct3d && layout.storage.value_or(StrandStorage::lanes) == StrandStorage::lanes)
        layout.storage = StrandStorage::threads;
    if (direct3d) layout.members = 1;
    if (!layout.storage) layout.storage = gpuModelOf(settings.strandModel).storage;
    impl->batches = makeBatches(*impl->shape, layout, device.info().waves);
    if (const std::string why = impl->velocityError(); !why.empty()) return fail(why);
    if (const std::string why = bodyError(device.info(), settings, options.body.get()); !why.empty())
        return fail(why);
    impl->placed.roots.resize(impl->shape->restRoots.size());
    if (auto made = impl->makeBuffers(); !made) return tl::unexpected(made.error());
    if (auto taken = impl->takeModel(settings); !taken) return tl::unexpected(taken.error());
    if (options.hairVolume) {
        auto volume = GpuHairVolume::make(device, *options.hairVolume);
        if (!volume) return tl::unexpected(volume.error());
        impl->volume.emplace(std::move(*volume));
    }
    StrandEngine engine(std::move(impl));
    if (auto placed = engine.reset(engine.impl_->shape->restRoots); !placed)
        return tl::unexpected(placed.error());
    return engine;
}

StrandEngine::StrandEngine(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
StrandEngine::StrandEngine(StrandEngine&&) noexcept = default;
StrandEngine& StrandEngine::operator=(StrandEngine&&) noexcept = default;
StrandEngine::~StrandEngine() = default;

/// Why this device cannot write the velocities that were asked for; empty where it can.
std::string StrandEngine::Impl::velocityError() const {
    const bool inBuffers = std::ranges::any_of(
        batches, [](const StrandBatch& batch) { return batch.shape.storage == StrandStorage::buffers; });
    if (!options.velocities || !inBuffers || device.info().backend != gpu::Backend::Direct3D11) return {};
    return "Direct3D 11 lets a kernel write to eight buffers, too few for velocities of strands this long";
}

/// The body, once strands are of a model that meets it.
Status StrandEngine::Impl::makeBody(const runtime::SimulationSettings& settings) {
    if (body || options.body == nullptr || !runtime::modelOf(settings.strandModel).meetsBody) return {};
    auto made = DeviceBody::make(device, options.body, *shape);
    if (!made) return tl::unexpected(made.error());
    const runtime::Floats clearances = runtime::bodyClearances(*shape, *options.body);
    for (StrandBatch& batch : batches) {
        const runtime::Vector<float> own = runtime::planesOfSlots(*shape, batch.inSlots(), clearances, 1);
        auto buffer = makeBuffer<float>(device, "clearances", Usage::ShaderRead, own.size(), own);
        if (!buffer) return tl::unexpected(buffer.error());
        batch.clearances = std::move(*buffer);
    }
    body.emplace(std::move(*made));
    return {};
}

/// Whether the frame needs the body's poses: strands that are wanted meet it, or those of a kernel that still
/// runs.
bool StrandEngine::Impl::followsBody() const {
    if (!body) return false;
    return runtime::modelOf(wanted.strandModel).meetsBody ||
           std::ranges::any_of(batches, [](const StrandBatch& batch) { return batch.key.body; });
}

/// Those that exist whatever the plan.
Status StrandEngine::Impl::makeBuffers() {
    const auto make = [&](gpu::BufferPtr& buffer, const char* name, std::size_t count, std::size_t bytes) {
        gpu::BufferDesc desc;
        desc.name = name;
        desc.size = count * bytes;
        desc.usage = kReadWrite;
        desc.elementBytes = static_cast<std::uint32_t>(bytes);
        auto made = device.createBuffer(desc);
        if (!made) return Status(tl::unexpected(made.error()));
        buffer = std::move(*made);
        return Status();
    };
    const std::size_t points = shape->offsets.back();
    if (auto made = make(reportBuffer, "report", StrandEngine::kReportWords, 4); !made) return made;
    if (auto made = make(positions, "positions", points, sizeof(shaders::float4)); !made) return made;
    if (options.velocities) {
        if (auto made = make(velocities, "velocities", points, sizeof(shaders::float4)); !made) return made;
    }
    for (StrandBatch& batch : batches) {
        if (auto made = makeRestBuffers(device, *shape, batch); !made) return made;
        const std::size_t plane = std::size_t{batch.shape.points} * batch.slots;
        if (auto made = make(batch.state, "state", plane * kDevicePlanes, 4); !made) return made;
        if (auto made = make(batch.roots, "roots", std::size_t{batch.slots} * runtime::kRootRows, 4); !made)
            return made;
        if (auto made = make(batch.rootsTo, "roots of the frame", std::size_t{batch.slots} * 2,
                             sizeof(shaders::float4));
            !made) {
            return made;
        }
    }
    return {};
}

/// Takes what strands are under these settings. Those of another model go on from where they are.
Status StrandEngine::Impl::takeModel(const runtime::SimulationSettings& settings) {
    known.reset();
    if (auto made = makeBody(settings); !made) return made;
    if (model == nullptr || settings.strandModel != run.settings.strandModel) {
        for (StrandBatch& batch : batches) batch.model = {};
        model = gpuModelOf(settings.strandModel).make();
    }
    return model->takeSettings(device, *shape, settings, batches);
}

/// The buffers that the plan needs, and no others.
Status StrandEngine::Impl::allocate() {
    Status status;
    const auto have = [&](gpu::BufferPtr& buffer, const char* name, std::size_t count) {
        if (!status) return;
        if (auto made = haveFloats(device, buffer, name, count, 4); !made)
            status = tl::unexpected(made.error());
    };
    bool sleeps = false;
    for (StrandBatch& batch : batches) {
        const KernelKey& key = batch.key;
        const std::size_t plane = std::size_t{batch.shape.points} * batch.slots;
        if (auto made = model->allocate(device, batch); !made) return made;
        const bool gathers = key.sleep && (sharesBlocks(key.shape.storage) || key.shape.members > 1);
        have(batch.gathered, "gathered", gathers ? batch.blocks.size() : 0);
        have(batch.rests, "rests", key.sleep ? batch.blocks.size() * runtime::kRestFloats : 0);
        const bool scratch = key.shape.storage == StrandStorage::buffers && !key.stages.empty();
        have(batch.scratch, "scratch", scratch ? plane * gpuModelOf(key.model).scratchPlanes(key) : 0);
        sleeps = sleeps || key.sleep;
    }
    if (!sleeps) waking = nullptr;
    const bool many = std::ranges::any_of(
        batches, [](const StrandBatch& batch) { return batch.key.spheres == SphereSource::buffer; });
    if (!many) spheres = nullptr;
    return status;
}

StrandEngine::Impl::Run StrandEngine::Impl::runFor(const runtime::SimulationSettings& settings,
                                                   const runtime::FrameInput& input, Float3 low,
                                                   Float3 high) {
    Run next{settings, {runtime::makeWind(settings), run.wind.given}, {}};
    rejectedWinds = runtime::takeWind(settings, input, next.wind);
    runtime::FramePlanInput planInput;
    planInput.strandCount = static_cast<std::uint32_t>(shape->restRoots.size());
    planInput.longestPointCount = shape->longestPointCount;
    planInput.longestStrand = shape->longestStrand;
    planInput.straight = shape->straight;
    planInput.rootsMin_ws = low;
    planInput.rootsMax_ws = high;
    planInput.rootMotion = placed.motion;
    planInput.fastest = std::numeric_limits<float>::infinity();
    planInput.poseAmounts = poseAmounts;
    next.plan = runtime::planFrame(settings, planInput, next.wind, frameSpheres.planned,
                                   frameSpheres.plannedMotion, input.dt);
    return next;
}

/// Gives each batch the kernel of the run; false, and no change, while one is being made.
Result<bool> StrandEngine::Impl::kernelsFor(const Run& next, bool wait) {
    std::vector<std::pair<KernelKey, gpu::ComputePipelinePtr>> found;
    bool ready = true;
    for (const StrandBatch& batch : batches) {
        KernelKey key = keyFor(next.plan, next.settings, batch.shape,
                               runtime::sphereConstantsOf(frameSpheres, next.settings.strandModel),
                               options.velocities, meetsBody(next.settings));
        if (batch.kernel != nullptr && key == batch.key) {
            found.emplace_back(std::move(key), batch.kernel);
            continue;
        }
        auto kernel = wait ? kernels->get(key) : kernels->poll(key);
        if (!kernel) return tl::unexpected(kernel.error());
        ready = ready && *kernel != nullptr;
        found.emplace_back(std::move(key), std::move(*kernel));
    }
    if (!ready) return false;
    for (std::size_t n = 0; n < batches.size(); ++n)
        std::tie(batches[n].key, batches[n].kernel) = std::move(found[n]);
    return true;
}

Status StrandEngine::Impl::adopt(const Run& next) {
    if (run.settings != next.settings) {
        restsVoid = wakeAll = true;
        if (auto taken = takeModel(next.settings); !taken) return taken;
        if (poses) {
            run.settings = next.settings;
            followPoses(false);
        }
    }
    if (adopted) model->changePlan(run.plan, next.plan);
    run = next;
    adopted = true;
    return allocate();
}

/// Decides by which plan the frame runs.
Status StrandEngine::Impl::choose(const runtime::FrameInput& input, Float3 low, Float3 high) {
    const Run next = runFor(wanted, input, low, high);
    const bool wait = options.waitForKernels || !adopted;
    const auto begin = std::chrono::steady_clock::now();
    auto ready = kernelsFor(next, wait);
    kernelMilliseconds =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    if (!ready) return tl::unexpected(ready.error());
    switching = !*ready;
    if (*ready) return adopt(next);
    // The last plan goes on, in this frame's wind.
    runtime::takeWind(run.settings, input, run.wind);
    return {};
}

Status StrandEngine::setSettings(const runtime::SimulationSettings& settings) {
    if (const std::string why = runtime::validationError(settings); !why.empty()) return fail(why);
    if (const std::string why = kernelError(settings); !why.empty()) return fail(why);
    const runtime::BodyField* const body = impl_->options.body.get();
    if (const std::string why = bodyError(impl_->device.info(), settings, body); !why.empty())
        return fail(why);
    impl_->wanted = settings;
    return {};
}

/// `others`: poses have changed, not settings or amounts alone. Strands that rest may have to move.
void StrandEngine::Impl::followPoses(bool others) {
    static const runtime::PoseSet kNone;
    known.reset();
    model->takePoses(*shape, run.settings, {poses ? *poses : kNone, poseAmounts, others, false});
    restsVoid = wakeAll = true;
}

void StrandEngine::Impl::takePoseAmounts(std::span<const float> amounts) {
    if (amounts.empty() || amounts.size() != poseAmounts.size()) return;
    if (runtime::takePoseAmounts(amounts, poseAmounts)) followPoses(false);
}

Status StrandEngine::setPoses(std::span<const runtime::PoseView> poses) {
    const runtime::RestShape& shape = *impl_->shape;
    if (const std::string why = runtime::validationError(poses, shape); !why.empty()) return fail(why);
    if (poses.empty() && !impl_->poses) return {};
    impl_->poses =
        poses.empty() ? nullptr : std::make_shared<const runtime::PoseSet>(makePoseSet(poses, shape));
    impl_->poseAmounts.assign(poses.size(), 0.0f);
    impl_->followPoses(true);
    return {};
}

Status StrandEngine::setPoseAmounts(std::span<const float> amounts) {
    if (amounts.size() != impl_->poseAmounts.size())
        return fail(fmt::format("there are {} amounts", amounts.size()),
                    fmt::format("expected one for each pose, {}", impl_->poseAmounts.size()));
    impl_->takePoseAmounts(amounts);
    return {};
}

Status StrandEngine::step(const runtime::FrameInput& input) {
    auto list = impl_->device.createCommandList();
    if (!list) return tl::unexpected(list.error());
    if (auto recorded = impl_->record(**list, input, nullptr); !recorded) return recorded;
    auto submission = impl_->device.submit(std::move(*list));
    if (!submission) return tl::unexpected(submission.error());
    impl_->submissionsInFlight.push_back(std::move(*submission));
    if (impl_->submissionsInFlight.size() <= kMaxSubmissionsInFlight) return {};
    const gpu::SubmissionPtr oldest = std::move(impl_->submissionsInFlight.front());
    impl_->submissionsInFlight.pop_front();
    return oldest->wait();
}

Status StrandEngine::record(gpu::CommandList& list, const runtime::FrameInput& input) {
    return impl_->record(list, input, nullptr);
}

Status StrandEngine::record(gpu::CommandList& list, const runtime::FrameInput& input,
                            const DeviceRoots& roots, bool continues) {
    return impl_->record(list, input, &roots, continues);
}

void StrandEngine::setSkinSpheres(std::span<const std::uint8_t> ofSkin) {
    if (std::ranges::equal(ofSkin, impl_->skinSpheres)) return;
    impl_->skinSpheres.assign(ofSkin.begin(), ofSkin.end());
    impl_->wakeAll = true;
}

const runtime::SimulationSettings& StrandEngine::settings() const {
    return impl_->adopted ? impl_->run.settings : impl_->wanted;
}
std::uint32_t StrandEngine::strandCount() const {
    return static_cast<std::uint32_t>(impl_->shape->restRoots.size());
}
std::uint32_t StrandEngine::pointCount() const {
    return impl_->shape->offsets.back();
}
gpu::BufferPtr StrandEngine::positions_ws() const {
    return impl_->positions;
}
gpu::BufferPtr StrandEngine::velocities_ws() const {
    return impl_->velocities;
}
gpu::BufferPtr StrandEngine::reportWords() const {
    return impl_->reportBuffer;
}
float StrandEngine::substep() const {
    return impl_->substep;
}
const runtime::RestShape& StrandEngine::restShape() const {
    return *impl_->shape;
}
const runtime::EffectPlan& StrandEngine::plan() const {
    return impl_->run.plan;
}

std::size_t StrandEngine::effectBytes(Effect effect) const {
    std::size_t bytes = 0;
    const auto add = [&](const gpu::BufferPtr& buffer) {
        if (buffer != nullptr) bytes += static_cast<std::size_t>(buffer->desc().size);
    };
    for (const StrandBatch& batch : impl_->batches) {
        for (const ModelBuffer& own : batch.model.read) {
            if (own.effect == effect) add(own.buffer);
        }
        if (batch.model.state.effect == effect) add(batch.model.state.buffer);
        if (effect == Effect::sleep) {
            add(batch.rests);
            add(batch.gathered);
        }
        if (effect == Effect::collision && batch.key.spheres == SphereSource::constants && bytes == 0)
            bytes = sizeof(shaders::SphereConstants) * HAIRLOOM_CONSTANT_SPHERES;
    }
    if (effect == Effect::sleep) add(impl_->waking);
    if (effect == Effect::collision) add(impl_->spheres);
    if (effect == Effect::wind && impl_->run.plan.on(effect)) bytes = sizeof(runtime::Wind);
    return bytes;
}

std::size_t StrandEngine::volumeBytes() const {
    return impl_->volume ? impl_->volume->bytes() : 0;
}

std::size_t StrandEngine::bodyBytes() const {
    if (!impl_->body || !runtime::modelOf(settings().strandModel).meetsBody) return 0;
    std::size_t bytes = impl_->body->bytes();
    for (const StrandBatch& batch : impl_->batches) {
        bytes += static_cast<std::size_t>(batch.clearances->desc().size);
        bytes += sizeof(float) * runtime::kFoldPlanes * batch.inSlots().planeSize();
    }
    return bytes;
}
const DeviceBody* StrandEngine::body() const {
    return impl_->meetsBody(settings()) ? &*impl_->body : nullptr;
}

std::size_t StrandEngine::frameBytes() const {
    std::size_t bytes = 0;
    for (const StrandBatch& batch : impl_->batches) {
        for (const auto& changing : {batch.state, batch.roots, batch.model.state.buffer}) {
            if (changing != nullptr) bytes += 2 * static_cast<std::size_t>(changing->desc().size);
        }
        bytes += static_cast<std::size_t>(batch.rootsTo->desc().size);
    }
    return bytes + static_cast<std::size_t>(impl_->positions->desc().size);
}

}  // namespace hairloom::gpu_simulation
