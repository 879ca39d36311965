// SPDX-License-Identifier: MIT
#include "play/gpu_guides.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <numeric>

#include "hairloom/gpu.h"
#include "models/rods/rod_slots.h"

namespace hairloom::runtime {
namespace {

static_assert(HL_GPU_SPHERES >= HAIRLOOM_CONSTANT_SPHERES);
static_assert(sizeof(shaders::SimulationConstants) == 352 && sizeof(shaders::RodConstants) == 160,
              "HL_GPU_BUFFERS");

Map<std::uint32_t, std::size_t> strandsByPointsOf(const RestShape& shape) {
    Map<std::uint32_t, std::size_t> strandsOf;
    for (const Block& block : shape.blocks) strandsOf[block.points] += block.strands;
    return strandsOf;
}

template <class T>
void putGpu(std::span<std::byte> out, std::span<const T> values) {
    const auto bytes = std::as_bytes(values);
    std::memcpy(out.data(), bytes.data(), std::min(bytes.size(), out.size()));
    if (bytes.size() < out.size()) std::memset(out.data() + bytes.size(), 0, out.size() - bytes.size());
}
template <class T>
void putGpu(std::span<std::byte> out, const Vector<T>& values) {
    putGpu(out, std::span<const T>(values));
}

}  // namespace

std::size_t gpuBlocksOf(const Map<std::uint32_t, std::size_t>& strandsOf) {
    std::size_t blocks = 0;
    for (const auto& [points, count] : strandsOf)
        blocks += count / kBlockLanes + std::min<std::size_t>(count, 2);
    return blocks;
}

std::size_t gpuSpheresOf(std::size_t spheresOfAsset, std::size_t capsulesOfAsset) {
    return std::max<std::size_t>(spheresOfAsset + 2 * capsulesOfAsset, HL_GPU_SPHERES);
}

std::string gpuGuidesRefused(const SimulationSettings& settings) {
    if (settings.strandModel != StrandModel::rods)
        return "strandModel is springs, and the kernel of guides is that of rods: step on the CPU";
    if (settings.clampedPoints != 2)
        return "clampedPoints is " + std::to_string(settings.clampedPoints) +
               ", and the kernel of guides clamps 2: step on the CPU";
    if (settings.hairHair)
        return "hairHair is on, and the kernel of guides has no hair-hair collision: step on the CPU";
    if (settings.windShelter > 0.0f)
        return "windShelter is above 0, and the kernel of guides lets wind through spheres: step on the CPU";
    return {};
}

GpuGuides::GpuGuides(std::shared_ptr<const RestShape> shape, const SimulationSettings& settings,
                     std::shared_ptr<const State> state, std::size_t mostSpheres)
    : shape_(std::move(shape)),
      settings_(settings),
      state_(std::move(state)),
      mostSpheres_(mostSpheres),
      blocks_(shape_->blocks.size()),
      slotCount_(static_cast<std::uint32_t>(gpuBlocksOf(strandsByPointsOf(*shape_)) * kBlockLanes)),
      wind_{makeWind(settings), false},
      spheresBefore_(state_->spheres),
      substep_(state_->substep),
      origin_(state_->origin_ws) {
    std::iota(blocks_.begin(), blocks_.end(), 0u);
    roots_.roots.resize(shape_->restRoots.size());
    for (std::size_t b = 0; b < shape_->blocks.size(); ++b) {
        for (std::uint32_t lane = 0; lane < shape_->blocks[b].strands; ++lane) {
            const auto row = [&](std::size_t r) {
                return state_->roots[(b * kRootRows + r) * kBlockLanes + lane];
            };
            roots_.roots[shape_->blocks[b].strandOfLane[lane]] = {{row(0), row(1), row(2)},
                                                                  {row(3), row(4), row(5), row(6)}};
        }
    }
    roots_.min_ws = state_->rootsMin_ws;
    roots_.max_ws = state_->rootsMax_ws;
    reserve();
}

/// Frames have no more, and ask for no memory then.
void GpuGuides::reserve() {
    const std::size_t capsules = std::min(mostSpheres_ / 2, kMaxCapsules);
    roots_.moved.resize(roots_.roots.size());
    // The CPU may have had more.
    reserveSpheres(std::max(mostSpheres_, spheresBefore_.size()), capsules, spheres_);
    spheresBefore_.reserve(mostSpheres_);
    capsulesBefore_.reserve(capsules);
    moving_.reserve(mostSpheres_);
    movingCapsules_.reserve(capsules);
    frame_.roots.resize(std::size_t{slotCount_} * 2);
    frame_.waking.reserve(spheres_.waking.capacity());
    frame_.spheres.reserve(mostSpheres_);
}

Slots GpuGuides::slots() const {
    return {blocks_, shape_->longestPointCount, slotCount_, false};
}

/// Measures what is known of the last frame from the origin of this one; by how much that moves it.
Float3 GpuGuides::moveOrigin(std::array<double, 3> next) {
    if (!isFinite(next)) next = origin_.value_or(std::array<double, 3>{});
    const Float3 shift = shiftOfOrigin(origin_.value_or(next), next);
    origin_ = next;
    if (shift == Float3{}) return shift;
    for (RootFrame& root : roots_.roots) root.position = root.position + shift;
    for (Sphere& sphere : spheresBefore_) sphere.center_ws = sphere.center_ws + shift;
    roots_.min_ws = roots_.min_ws + shift;
    roots_.max_ws = roots_.max_ws + shift;
    return shift;
}

void GpuGuides::take(const FrameInput& input) {
    const Float3 shift = moveOrigin(input.origin_ws);
    const Float3 lowBefore = roots_.min_ws, highBefore = roots_.max_ws;
    takeFrameRoots(input.roots_ws, teleportDistanceOf(settings_, input), true, roots_);
    capsulesBefore_.assign(spheres_.capsules.begin(), spheres_.capsules.end());
    takeSpheres(settings_, shape_->longestStrand, {spheresBefore_, capsulesBefore_, input.cut}, input.spheres,
                input.capsules, spheres_);
    takeWind(settings_, input, wind_);
    FramePlanInput planInput;
    planInput.strandCount = static_cast<std::uint32_t>(shape_->restRoots.size());
    planInput.longestPointCount = shape_->longestPointCount;
    planInput.longestStrand = shape_->longestStrand;
    planInput.straight = shape_->straight;
    planInput.rootsMin_ws = {std::min(roots_.min_ws.x, lowBefore.x), std::min(roots_.min_ws.y, lowBefore.y),
                             std::min(roots_.min_ws.z, lowBefore.z)};
    planInput.rootsMax_ws = {std::max(roots_.max_ws.x, highBefore.x), std::max(roots_.max_ws.y, highBefore.y),
                             std::max(roots_.max_ws.z, highBefore.z)};
    planInput.rootMotion = roots_.motion;
    // How fast hair is, the device alone knows.
    planInput.fastest = std::numeric_limits<float>::infinity();
    const EffectPlan plan =
        planFrame(settings_, planInput, wind_, spheres_.planned, spheres_.plannedMotion, input.dt);
    const std::uint32_t substeps = substepsIn(settings_, input.dt);
    moving_.clear();
    movingCapsules_.clear();
    if (plan.on(Effect::collision)) moveCapsules(spheres_, substeps, moving_, movingCapsules_);
    const SubstepContext context =
        substepContext(settings_, plan, input.dt, substeps, moving_, movingCapsules_);
    // The CPU may have had more spheres before it handed over.
    const std::size_t room = kWakingOfSphere * mostSpheres_, waking = spheres_.waking.size();
    const bool wakes = !(shift == Float3{}) || waking > room;
    frame_.constants = frameConstants(
        {settings_, wind_.wind, moving_, std::min(waking, room), substep_, wakes, *origin_, shift}, context,
        input, slots(), kBlockLanes);
    frame_.rods = rodConstants(context, wind_.wind, substep_, slots(), 0);
    putRootsOfSlots(*shape_, slots(), roots_.roots, roots_.moved, frame_.roots);
    putSphereConstants(moving_, movingCapsules_, frame_.spheres);
    putWaking(spheres_, frame_.waking);
    hasFrame_ = true;
    state_.reset();
    spheresBefore_.assign(spheres_.usable.begin(),
                          spheres_.usable.begin() + static_cast<std::ptrdiff_t>(spheres_.given));
    substep_ = context.h;
}

void GpuGuides::fill(std::uint32_t buffer, std::span<std::byte> out) const {
    const auto rods = [&] { return rodsOfSlots(*shape_, slots(), makeRodRest(*shape_, settings_)); };
    const auto rest = [&] { return restOfSlots(*shape_, slots()); };
    switch (buffer) {
        case HL_GPU_BUFFER_STEP:
            return putGpu(out, std::span(&frame_.constants, 1));
        case HL_GPU_BUFFER_RODS:
            return putGpu(out, std::span(&frame_.rods, 1));
        case HL_GPU_BUFFER_ROOTS_TO:
            return putGpu(out, frame_.roots);
        case HL_GPU_BUFFER_SPHERES:
            return putGpu(out, frame_.spheres);
        case HL_GPU_BUFFER_WAKING:
            return putGpu(out, frame_.waking);
        case HL_GPU_BUFFER_REST:
            return putGpu(out, rest().rest);
        case HL_GPU_BUFFER_SEGMENTS:
            return putGpu(out, rest().segments);
        case HL_GPU_BUFFER_BLOCKS:
            return putGpu(out, rest().blocks);
        case HL_GPU_BUFFER_FIRST_POINTS:
            return putGpu(out, rest().firstPoints);
        case HL_GPU_BUFFER_ROD_REST:
            return putGpu(out, rods().rest);
        case HL_GPU_BUFFER_MASSES:
            return putGpu(out, rods().masses);
        case HL_GPU_BUFFER_CURVED:
            return putGpu(out, rods().curved);
        case HL_GPU_BUFFER_STATE:
            return putGpu(out, planesOfSlots(*shape_, slots(), state_->planes, kStatePlanes));
        case HL_GPU_BUFFER_ROOTS:
            return putGpu(out, rowsOfSlots(slots(), state_->roots.data(), kRootRows));
        case HL_GPU_BUFFER_ROD_STATE:
            return putGpu(out, rodStateOfSlots(*shape_, slots(), *state_));
        case HL_GPU_BUFFER_RESTS:
            return putGpu(out, restsOfSlots(slots(), state_->rests));
        default:
            return putGpu(out, std::span<const std::byte>());  // REPORT
    }
}

}  // namespace hairloom::runtime
