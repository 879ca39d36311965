// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/live/device_hair.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "core/gpu_simulation/compiled_kernel.h"
#include "core/groom/poses.h"
#include "core/groom/spheres.h"
#include "hairloom/capsules.h"
#include "runtime/shaders/live_types.h"

namespace hairloom {
namespace {

using gpu::Binding;
using gpu::Usage;
using gpu_simulation::makeBuffer;

constexpr std::size_t kReadbacks = 4;       // frames under way, and one to record into
constexpr std::uint32_t kMaxSample = 1024;  // points
constexpr std::uint32_t kExtentThreads = 64 * 256;
constexpr std::uint32_t kMaxGroups = 65535;  // of one dimension, on every device
constexpr float kSlack = 0.01f;              // metres around where hair was seen
constexpr Usage kReadWrite = Usage::ShaderRead | Usage::UnorderedAccess;

Eigen::Affine3f toAffine(const runtime::BonePose& bone) {
    const auto column = [](runtime::Float3 v) { return Vec3f(v.x, v.y, v.z); };
    Eigen::Affine3f m = Eigen::Affine3f::Identity();
    m.linear() << column(bone.x), column(bone.y), column(bone.z);
    m.translation() = column(bone.origin);
    return m;
}

constexpr std::size_t kReportBytes = gpu_simulation::StrandEngine::kReportWords * 4;
constexpr std::size_t kMeasureBytes = HAIRLOOM_MEASURE_WORDS * 4;
constexpr std::size_t kExtentBytes = HAIRLOOM_EXTENT_WORDS * 4;

float fromOrdered(std::uint32_t word) {
    return std::bit_cast<float>((word & 0x80000000u) != 0 ? word & 0x7fffffffu : ~word);
}

std::vector<shaders::MeasuredPoint> measuredPoints(const runtime::RestShape& shape, std::uint32_t clamped) {
    std::vector<shaders::MeasuredPoint> points(shape.offsets.back());
    for (const runtime::Block& block : shape.blocks) {
        const std::size_t plane = planeSize(block);
        const float* const planes = shape.planes.data() + block.firstPlane * runtime::kRestPlanes;
        for (std::uint32_t lane = 0; lane < block.strands; ++lane) {
            const std::uint32_t first = shape.offsets[block.strandOfLane[lane]];
            for (std::uint32_t p = 0; p < block.points; ++p) {
                const std::size_t at = std::size_t{p} * runtime::kBlockLanes + lane;
                shaders::MeasuredPoint& point = points[first + p];
                // Planes 3 and 5: the length of the segment that begins here, and the inverse mass.
                if (p > 0) point.segment = planes[3 * plane + at - runtime::kBlockLanes];
                const float inverse = planes[5 * plane + at];
                point.mass = p >= clamped && inverse > 0 ? 1 / inverse : 0;
                point.along = static_cast<float>(p) / static_cast<float>(block.points - 1);
            }
        }
    }
    return points;
}

void dispatch(gpu::CommandList& list, const char* name, const gpu::ComputePipelinePtr& pipeline,
              std::span<const Binding> bound, std::span<const std::byte> constants, std::uint32_t groups) {
    gpu::PassDesc pass;
    pass.name = name;
    list.beginPass(pass);
    list.setPipeline(pipeline);
    list.bind(bound);
    list.setConstants(0, constants);
    list.dispatch(std::min(groups, kMaxGroups), (groups + kMaxGroups - 1) / kMaxGroups);
    list.endPass();
}

}  // namespace

Result<DeviceHair> DeviceHair::make(gpu::Device& device,
                                    std::shared_ptr<gpu_simulation::KernelLibrary> kernels,
                                    const GroomScene& scene, const SkinWeights* skin, const HeadPose& start) {
    const Groom& groom = scene.rest();
    auto input = SceneInput::make(groom);
    if (!input) return tl::unexpected(input.error());
    gpu_simulation::EngineOptions options;
    options.layout = gpu_simulation::layoutFor(device.info().type);
    options.velocities = true;
    options.waitForKernels = false;
    options.body = groom.body;
    auto engine = gpu_simulation::StrandEngine::make(device, std::move(kernels), input->strands(),
                                                     groom.simulation, options);
    if (!engine) return tl::unexpected(engine.error());
    if (auto given = engine->setPoses(poseViews(groom).views); !given) return tl::unexpected(given.error());
    if (auto set = engine->setPoseAmounts(poseAmounts(groom)); !set) return tl::unexpected(set.error());
    if (auto placed = engine->reset(input->rootsAt(start)); !placed) return tl::unexpected(placed.error());
    std::vector<Vec3f> roots;
    for (std::size_t s = 0; s < groom.strandCount(); ++s) roots.push_back(groom.strand(s).front());
    const std::vector<SurfacePoint> bindings = groom.rootBindings();
    auto head = gpu_simulation::GpuHead::make(device, {groom.scalp, skin, roots, bindings});
    if (!head) return tl::unexpected(head.error());
    DeviceHair hair(device, std::move(*input), std::move(*engine), std::move(*head));
    hair.skinned_ = skin != nullptr && groom.scalp != nullptr;
    hair.reach_ = hair.engine_.restShape().longestStrand;
    if (const StrandFollow* follow = scene.follow()) {
        const runtime::FollowView view = follow->view();
        auto made = gpu_simulation::GpuFollowHairs::make(device, view);
        if (!made) return tl::unexpected(made.error());
        hair.follow_.emplace(std::move(*made));
        // A wisp is as wide as twice its radius at rest at most, or at 7 m/s.
        hair.reach_ += 2 * *std::ranges::max_element(view.radii);
    }
    if (scene.bodyPush() != nullptr && gpu_simulation::hasBodyKernels(device.info())) {
        auto made = gpu_simulation::GpuBodyPush::make(device, *scene.bodyPush());
        if (!made) return tl::unexpected(made.error());
        hair.push_.emplace(std::move(*made));
    }
    const auto drawn = scene.scene().strands.front().positions_ws;
    hair.drawnPointCount_ = static_cast<std::uint32_t>(drawn.size());
    hair.sampleStep_ = std::max(1u, hair.drawnPointCount_ / kMaxSample) | 1u;  // odd: no stride of strands
    for (std::size_t i = 0; i < drawn.size() && hair.restSample_.size() < kMaxSample; i += hair.sampleStep_)
        hair.restSample_.push_back(drawn[i]);
    hair.sampleCount_ = static_cast<std::uint32_t>(hair.restSample_.size());
    if (auto made = hair.makeBuffers(); !made) return tl::unexpected(made.error());
    hair.placedSpheres_ = spheresAt(groom.spheres, start);
    hair.bones_ = hair.bonesOf(start);
    hair.morphed_ss_ = start.morphed_ss;
    hair.forgetSeen(start);
    return hair;
}

Status DeviceHair::makeBuffers() {
    Status status;
    const auto keep = [&](gpu::BufferPtr& buffer, Result<gpu::BufferPtr> made) {
        if (status && made) buffer = std::move(*made);
        if (status && !made) status = tl::unexpected(made.error());
    };
    const auto points = measuredPoints(engine_.restShape(), engine_.settings().clampedPoints);
    keep(measuredRest_, makeBuffer<shaders::MeasuredPoint>(*device_, "points measured", Usage::ShaderRead,
                                                           points.size(), points));
    keep(measures_, makeBuffer<std::uint32_t>(*device_, "measures", kReadWrite, HAIRLOOM_MEASURE_WORDS, {}));
    keep(extent_,
         makeBuffer<std::uint32_t>(*device_, "extent of hair", kReadWrite, HAIRLOOM_EXTENT_WORDS, {}));
    keep(samples_, makeBuffer<shaders::float4>(*device_, "sample of hair", kReadWrite, sampleCount_, {}));
    readbacks_.resize(kReadbacks);
    for (Readback& readback : readbacks_) {
        gpu::BufferDesc desc;
        desc.name = "told of a frame";
        desc.size = kReportBytes + kMeasureBytes + kExtentBytes + sampleCount_ * sizeof(shaders::float4);
        desc.usage = Usage::None;
        desc.memory = gpu::MemoryKind::ReadBack;
        keep(readback.buffer, device_->createBuffer(desc));
    }
    recording_ = readbacks_.size();
    for (auto& [kernel, name] :
         {std::pair{&measureKernel_, "strands_measure"}, {&extentKernel_, "hair_extent"}}) {
        auto compiled = gpu_simulation::compiledKernel(*device_, name);
        if (!compiled) return tl::unexpected(compiled.error());
        *kernel = std::move(*compiled);
    }
    return status;
}

Status DeviceHair::setSettings(const runtime::SimulationSettings& settings) {
    if (auto taken = engine_.setSettings(settings); !taken) return taken;
    if (settings.clampedPoints == engine_.settings().clampedPoints) return {};
    const auto points = measuredPoints(engine_.restShape(), settings.clampedPoints);
    auto made = makeBuffer<shaders::MeasuredPoint>(*device_, "points measured", Usage::ShaderRead,
                                                   points.size(), points);
    if (!made) return tl::unexpected(made.error());
    measuredRest_ = std::move(*made);
    return {};
}

Status DeviceHair::setPoseAmounts(std::span<const float> amounts) {
    return engine_.setPoseAmounts(amounts);
}

/// From the head at rest to the world.
std::vector<runtime::BonePose> DeviceHair::headBones(const HeadPose& pose) const {
    std::vector<runtime::BonePose> bones;
    const auto add = [&](const Eigen::Affine3f& bone) { bones.push_back(toBonePose(bone)); };
    if (skinned_ && !pose.bones_ws.empty())
        std::ranges::for_each(pose.bones_ws, add);
    else
        add(Eigen::Affine3f(pose.head_ws));
    return bones;
}

/// Those of the head, and behind them those of its body, so that both go through a frame alike.
std::vector<runtime::BonePose> DeviceHair::bonesOf(const HeadPose& pose) const {
    std::vector<runtime::BonePose> bones = headBones(pose);
    const auto body = bodyAt(input_.groom(), pose);
    bones.insert(bones.end(), body.begin(), body.end());
    return bones;
}

/// Where vertices are before bones move them at the end of a piece; they go straight as bones do.
std::vector<Vec3f> DeviceHair::morphedAt(std::size_t piece, const HeadPose& end,
                                         std::span<const HeadPose> within) const {
    const auto aim = pieces_.aimOf(piece);
    const auto posed = [&](std::size_t pose) -> const std::vector<Vec3f>& {
        return pose <= within.size() ? within[pose - 1].morphed_ss : end.morphed_ss;
    };
    const std::vector<Vec3f>& to = posed(aim.to);
    const std::vector<Vec3f>& from = aim.from > 0 ? posed(aim.from) : morphed_ss_;
    if (aim.share >= 1.0f || (from.empty() && to.empty())) return to;
    const auto rest = input_.groom().scalp->positions();
    const auto a = from.empty() ? rest : std::span<const Vec3f>(from);
    const auto b = to.empty() ? rest : std::span<const Vec3f>(to);
    std::vector<Vec3f> mixed(rest.size());
    for (std::size_t v = 0; v < mixed.size(); ++v) mixed[v] = a[v] + aim.share * (b[v] - a[v]);
    return mixed;
}

gpu::BufferPtr DeviceHair::drawnPoints() const {
    if (follow_) return follow_->positions_ws();
    return pushed_ != nullptr ? pushed_ : engine_.positions_ws();
}

Status DeviceHair::recordStraight(gpu::CommandList& list, const runtime::FrameInput& input, bool continues,
                                  std::vector<Vec3f> morphed_ss) {
    bones_.assign(input.body_ws.begin(), input.body_ws.end());
    placedSpheres_.assign(input.spheres.begin(), input.spheres.end());
    const auto ofHead = std::span(bones_).first(headBones_);
    std::vector<Eigen::Affine3f> bones(ofHead.size());
    std::ranges::transform(ofHead, bones.begin(), toAffine);
    morphed_ss_ = std::move(morphed_ss);
    if (auto recorded = head_.record(list, bones, morphed_ss_); !recorded) return recorded;
    runtime::FrameInput ofBody = input;
    ofBody.body_ws = std::span(bones_).subspan(headBones_);
    return engine_.record(list, ofBody, head_.roots(), continues);
}

/// What is drawn, from strands that the frame has moved.
Status DeviceHair::recordDrawn(gpu::CommandList& list) {
    if (follow_) {
        gpu_simulation::FollowInput guides{engine_.positions_ws(), engine_.velocities_ws(), {}};
        guides.roots_ws = head_.roots().frames_ws;
        follow_->record(list, guides);
    }
    const gpu_simulation::DeviceBody* const body = engine_.body();
    if (!push_ || body == nullptr) {
        pushed_ = nullptr;
        return {};
    }
    if (!follow_ && pushed_ == nullptr) {
        auto made = makeBuffer<shaders::float4>(*device_, "strands out of the body", kReadWrite,
                                                engine_.pointCount(), {});
        if (!made) return tl::unexpected(made.error());
        pushed_ = std::move(*made);
    }
    if (!follow_) list.copyBuffer(engine_.positions_ws(), 0, pushed_, 0, pushed_->desc().size);
    push_->record(list, *body, drawnPoints());
    return {};
}

Status DeviceHair::record(gpu::CommandList& list, float dt, double time, const HeadPose& pose,
                          std::span<const HeadPose> within) {
    listen();
    ++frame_;
    const std::span<const CollisionSphere> atRest = input_.groom().spheres;
    const auto spheres = spheresAt(atRest, pose);
    runtime::FrameInput input;
    input.dt = dt;
    input.time = time;
    const auto capsules = capsulesOf(atRest);
    input.spheres = spheres;
    input.capsules = capsules;
    if (pose.wind_ws)
        input.wind_ws = runtime::Float3{pose.wind_ws->x(), pose.wind_ws->y(), pose.wind_ws->z()};
    const auto bones = bonesOf(pose);
    input.body_ws = bones;
    headBones_ = headBones(pose).size();
    engine_.setSkinSpheres(input_.skinSpheres());
    input.poseAmounts = pose.poseAmounts;
    // Bones make the roots on the device, part after part of the frame.
    std::vector<std::vector<runtime::Sphere>> spheresWithin;
    std::vector<std::vector<runtime::BonePose>> bonesWithin;
    for (const HeadPose& on : within) {
        spheresWithin.push_back(spheresAt(atRest, on));
        bonesWithin.push_back(bonesOf(on));
    }
    std::vector<runtime::InnerPose> poses;
    for (std::size_t i = 0; i < within.size(); ++i) poses.push_back({{}, spheresWithin[i], bonesWithin[i]});
    input.inner = poses;
    pieces_.take(input, runtime::substepsIn(engine_.settings(), dt));
    for (std::size_t i = 0; i < pieces_.count(); ++i) {
        const runtime::FrameInput part = pieces_.at(i, {{}, placedSpheres_, bones_});
        auto morphed = morphedAt(i, pose, within);
        if (auto recorded = recordStraight(list, part, i > 0, std::move(morphed)); !recorded) return recorded;
    }
    if (auto recorded = recordDrawn(list); !recorded) return recorded;
    recordMeasures(list, pressing(spheres, capsules));
    recordExtent(list);
    recordReadback(list);
    return {};
}

/// Those that hair is measured against, capsules as spheres along them: what stands for the skin of the body
/// is not met.
std::vector<runtime::Sphere> DeviceHair::pressing(std::span<const runtime::Sphere> spheres,
                                                  std::span<const runtime::Capsule> capsules) const {
    const std::span<const std::uint8_t> ofSkin =
        engine_.body() != nullptr ? input_.skinSpheres() : std::span<const std::uint8_t>();
    const auto isSkin = [&](std::uint32_t sphere) { return sphere < ofSkin.size() && ofSkin[sphere] != 0; };
    std::vector<runtime::Capsule> between;
    for (const runtime::Capsule& capsule : capsules) {
        if (!isSkin(capsule.first) || !isSkin(capsule.second)) between.push_back(capsule);
    }
    std::vector<runtime::Sphere> all(spheres.begin(), spheres.end());
    runtime::appendCapsules(between, all);
    std::vector<runtime::Sphere> left;
    for (std::size_t s = 0; s < all.size(); ++s) {
        if (!isSkin(static_cast<std::uint32_t>(s))) left.push_back(all[s]);
    }
    return left;
}

void DeviceHair::recordMeasures(gpu::CommandList& list, std::span<const runtime::Sphere> spheres) {
    static_assert(sizeof(runtime::Sphere) == sizeof(shaders::float4));
    const std::uint64_t bytes = std::max<std::size_t>(spheres.size(), 1) * sizeof(shaders::float4);
    if (sphereBuffer_ == nullptr || sphereBuffer_->desc().size < bytes) {
        auto made = makeBuffer<shaders::float4>(*device_, "spheres measured", Usage::ShaderRead,
                                                std::max<std::size_t>(2 * spheres.size(), 8), {});
        if (!made) return;  // nothing is measured
        sphereBuffer_ = std::move(*made);
    }
    constexpr std::array<shaders::float4, 1> kNone{};
    list.updateBuffer(sphereBuffer_, 0,
                      spheres.empty() ? std::as_bytes(std::span(kNone)) : std::as_bytes(spheres));
    constexpr std::array<std::uint32_t, HAIRLOOM_MEASURE_WORDS> kNothing{};
    list.updateBuffer(measures_, 0, std::as_bytes(std::span(kNothing)));
    const runtime::SimulationSettings& settings = engine_.settings();
    const shaders::MeasureConstants constants{engine_.pointCount(),
                                              static_cast<std::uint32_t>(spheres.size()),
                                              settings.collisionRadiusRoot, settings.collisionRadiusTip};
    const std::array<Binding, 5> bound{
        Binding::read(0, engine_.positions_ws()), Binding::read(1, engine_.velocities_ws()),
        Binding::read(2, measuredRest_), Binding::read(3, sphereBuffer_), Binding::write(0, measures_)};
    const std::uint32_t groups = (constants.points + HAIRLOOM_LIVE_GROUP - 1) / HAIRLOOM_LIVE_GROUP;
    dispatch(list, "measures", measureKernel_, bound, gpu::bytesOf(constants), groups);
}

void DeviceHair::recordExtent(gpu::CommandList& list) {
    constexpr std::array<std::uint32_t, HAIRLOOM_EXTENT_WORDS> kEmpty{~0u, ~0u, ~0u, 0, 0, 0};
    list.updateBuffer(extent_, 0, std::as_bytes(std::span(kEmpty)));
    const shaders::ExtentConstants constants{drawnPointCount_, std::min(kExtentThreads, drawnPointCount_),
                                             sampleCount_, sampleStep_};
    const std::array<Binding, 3> bound{Binding::read(0, drawnPoints()), Binding::write(0, extent_),
                                       Binding::write(1, samples_)};
    const std::uint32_t groups = (constants.threads + HAIRLOOM_LIVE_GROUP - 1) / HAIRLOOM_LIVE_GROUP;
    shaders::ExtentConstants whole = constants;
    whole.threads = groups * HAIRLOOM_LIVE_GROUP;
    dispatch(list, "extent", extentKernel_, bound, gpu::bytesOf(whole), groups);
}

void DeviceHair::recordReadback(gpu::CommandList& list) {
    const auto free = std::ranges::find_if(readbacks_, [](const Readback& t) { return t.frame == 0; });
    recording_ = static_cast<std::size_t>(free - readbacks_.begin());
    if (free == readbacks_.end()) return;  // the device is far behind: this frame is not told of
    free->frame = frame_;
    free->substep = engine_.substep();
    std::uint64_t at = 0;
    for (const auto& [buffer, bytes] :
         {std::pair<gpu::BufferPtr, std::size_t>{engine_.reportWords(), kReportBytes},
          {measures_, kMeasureBytes},
          {extent_, kExtentBytes},
          {samples_, sampleCount_ * sizeof(shaders::float4)}}) {
        list.copyBuffer(buffer, 0, free->buffer, at, bytes);
        at += bytes;
    }
    free->hasPositions = readsPositions_;
    if (!readsPositions_) return;
    if (free->positions == nullptr) {
        gpu::BufferDesc desc;
        desc.name = "told positions";
        desc.size = engine_.positions_ws()->desc().size;
        desc.usage = Usage::None;
        desc.memory = gpu::MemoryKind::ReadBack;
        auto made = device_->createBuffer(desc);
        free->hasPositions = made.has_value();
        if (!made) return;
        free->positions = std::move(*made);
    }
    list.copyBuffer(engine_.positions_ws(), 0, free->positions, 0, free->positions->desc().size);
}

void DeviceHair::submitted(gpu::SubmissionPtr submission) {
    if (recording_ < readbacks_.size()) readbacks_[recording_].submission = std::move(submission);
    recording_ = readbacks_.size();
}

/// Takes what has come back, in the order of frames.
void DeviceHair::listen() {
    // A list that was never submitted tells nothing.
    if (recording_ < readbacks_.size()) readbacks_[recording_].frame = 0;
    recording_ = readbacks_.size();
    std::vector<Readback*> done;
    for (Readback& readback : readbacks_) {
        if (readback.submission != nullptr && readback.submission->isDone()) done.push_back(&readback);
    }
    std::ranges::sort(done, {}, &Readback::frame);
    for (Readback* readback : done) {
        std::vector<std::byte> bytes(static_cast<std::size_t>(readback->buffer->desc().size));
        if (device_->readMapped(readback->buffer, 0, bytes)) take(*readback, bytes);
        latest_.positions_ws.clear();
        if (readback->hasPositions) {
            std::vector<shaders::float4> points(engine_.pointCount());
            if (device_->readMapped(readback->positions, 0, std::as_writable_bytes(std::span(points)))) {
                for (const shaders::float4& p : points) latest_.positions_ws.emplace_back(p.x, p.y, p.z);
            }
        }
        readback->submission = nullptr;
        readback->frame = 0;
    }
}

void DeviceHair::take(const Readback& readback, std::span<const std::byte> bytes) {
    std::array<std::uint32_t, gpu_simulation::StrandEngine::kReportWords> report{};
    std::array<std::uint32_t, HAIRLOOM_MEASURE_WORDS> measures{};
    std::array<std::uint32_t, HAIRLOOM_EXTENT_WORDS> extent{};
    std::vector<shaders::float4> sample(sampleCount_);
    const auto copy = [&](void* to, std::size_t size) {
        std::memcpy(to, bytes.data(), size);
        bytes = bytes.subspan(size);
    };
    copy(report.data(), sizeof(report));
    copy(measures.data(), sizeof(measures));
    copy(extent.data(), sizeof(extent));
    copy(sample.data(), sample.size() * sizeof(shaders::float4));

    const std::uint64_t restored = latest_.restoredStrands, guarded = latest_.guardedStrands;
    latest_.frame = readback.frame;
    latest_.report = gpu_simulation::StrandEngine::reportFrom(report, readback.substep);
    latest_.restoredStrands = restored + latest_.report.restoredStrands;
    latest_.guardedStrands = guarded + latest_.report.guardedStrands;
    latest_.maxStretch = std::max(latest_.maxStretch, static_cast<double>(std::bit_cast<float>(measures[0])));
    latest_.maxPenetration =
        std::max(latest_.maxPenetration, static_cast<double>(std::bit_cast<float>(measures[1])));
    latest_.report.fastest = std::bit_cast<float>(measures[2]);
    latest_.nanCount += measures[3];
    latest_.kineticEnergy = 1e-6 * (4294967296.0 * measures[5] + measures[4]);
    if (readback.frame < seenSince_) return;
    SeenHair seen;
    seen.frame = readback.frame;
    for (int axis = 0; axis < 3; ++axis) {
        seen.box.min()[axis] = fromOrdered(extent[static_cast<std::size_t>(axis)]);
        seen.box.max()[axis] = fromOrdered(extent[static_cast<std::size_t>(axis) + 3]);
    }
    if (seen.box.isEmpty() || !seen.box.min().allFinite() || !seen.box.max().allFinite()) return;
    for (const shaders::float4& p : sample) {
        const Vec3f point(p.x, p.y, p.z);
        seen.sample.push_back(seen.box.contains(point) ? point : seen.box.center());
    }
    seenBefore_ = std::move(seen_);
    seen_ = std::move(seen);
}

/// Hair stands at rest on `pose`: what earlier frames tell is of elsewhere.
void DeviceHair::forgetSeen(const HeadPose& pose) {
    seenSince_ = frame_ + 1;
    seenBefore_ = {};
    seen_ = {};
    seen_.frame = frame_;
    if (skinned_ && !pose.bones_ws.empty()) return;  // where it may be at all is known
    for (const Vec3f& p : restSample_) {
        seen_.sample.push_back(pose.head_ws * p);
        seen_.box.extend(seen_.sample.back());
    }
}

Box3f DeviceHair::hairBounds() const {
    const auto& roots = head_.roots();
    const Vec3f reach = Vec3f::Constant(reach_);
    const Box3f possible(Vec3f(roots.min_ws.x, roots.min_ws.y, roots.min_ws.z) - reach,
                         Vec3f(roots.max_ws.x, roots.max_ws.y, roots.max_ws.z) + reach);
    if (seen_.box.isEmpty()) return possible;
    // Since it was seen hair has gone on about as far as in the frames before.
    Box3f box = seen_.box;
    float step = 0;
    if (seenBefore_.sample.size() == seen_.sample.size()) {
        for (std::size_t i = 0; i < seen_.sample.size(); ++i)
            step = std::max(step, (seen_.sample[i] - seenBefore_.sample[i]).norm());
        step /= static_cast<float>(std::max<std::uint64_t>(seen_.frame - seenBefore_.frame, 1));
    }
    const float late = static_cast<float>(frame_ - seen_.frame);
    const Vec3f around = Vec3f::Constant(kSlack + 1.5f * step * late);
    box = Box3f(box.min() - around, box.max() + around).intersection(possible);
    return box.isEmpty() ? possible : box;
}

std::vector<Vec3f> DeviceHair::hairSample() const {
    std::vector<Vec3f> sample = seen_.sample;
    if (seenBefore_.sample.size() != sample.size() || seen_.frame <= seenBefore_.frame) return sample;
    const float ahead =
        static_cast<float>(frame_ - seen_.frame) / static_cast<float>(seen_.frame - seenBefore_.frame);
    for (std::size_t i = 0; i < sample.size(); ++i) sample[i] += ahead * (sample[i] - seenBefore_.sample[i]);
    return sample;
}

Status DeviceHair::show(render::Renderer& renderer, bool hair, bool head) const {
    if (head && head_.positions_ws() != nullptr && !head_.bounds_ws().isEmpty()) {
        auto set = renderer.setMeshPositions(0, head_.positions_ws(), head_.normals_ws(), head_.bounds_ws());
        if (!set) return set;
    }
    if (!hair) return {};
    return renderer.setStrandPositions(0, drawnPoints(), 4, hairBounds(), hairSample());
}

Result<std::shared_ptr<const runtime::State>> DeviceHair::readState() {
    auto state = engine_.readState();
    if (!state) return tl::unexpected(state.error());
    return std::make_shared<const runtime::State>(std::move(*state));
}

Status DeviceHair::writeState(const runtime::State& state) {
    seenSince_ = frame_ + 1;
    seenBefore_ = {};
    seen_ = {};
    return engine_.writeState(state);
}

Status DeviceHair::readPositions(std::span<Vec3f> positions_ws) {
    return engine_.readPositions(
        {reinterpret_cast<runtime::Float3*>(positions_ws.data()), positions_ws.size()});
}

}  // namespace hairloom
