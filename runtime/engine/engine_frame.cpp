// SPDX-License-Identifier: MIT
// A frame of an engine: what comes in, the plan that follows, and the run of its blocks.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "engine/checks.h"
#include "engine/engine_impl.h"
#include "engine/in_parallel.h"

namespace hairloom::runtime {
namespace {

constexpr std::size_t kBlocksPerJob = 4;
/// Metres that a point may go before the body has to be looked at again.
constexpr float kNeverSeen = -1e30f;

RootBounds noRoots() {
    RootBounds bounds;
    std::fill_n(bounds.low[0], 3 * kBlockLanes, 1e30f);
    std::fill_n(bounds.high[0], 3 * kBlockLanes, -1e30f);
    std::fill_n(bounds.longest, kBlockLanes, 0.0f);
    return bounds;
}
float minimum(const float* row) {
    return *std::min_element(row, row + kBlockLanes);
}
bool asksForOtherHairGrid(const SimulationSettings& before, const SimulationSettings& now) {
    return before.hairHair != now.hairHair || before.hairHairCell != now.hairHairCell ||
           before.strandModel != now.strandModel;
}
float maximum(const float* row) {
    return *std::max_element(row, row + kBlockLanes);
}

}  // namespace

Engine::Impl::Impl(const StrandsView& strands, const SimulationSettings& settings, Host host)
    : settings_(settings), host_(std::move(host)), shape_(makeRestShape(strands, host_)) {
    state_.planes = zeroFloats(shape_->planeFloats * kStatePlanes, host_);
    state_.roots.assign(shape_->blocks.size() * kRootRows * kBlockLanes, 0.0f);
    blockReports_.resize(shape_->blocks.size());
    nextRoots_.assign(state_.roots.size(), 0.0f);
    state_.model = settings.strandModel;
    strands_ = OwnedStrands(model().make());
    strands_->takeSettings(*shape_, settings_, nullptr, state_, host_);
    strands_->takeNewState(*shape_, settings_, state_, host_);
    wind_.wind = makeWind(settings);
    hairGrid_.take(*shape_, settings_, host_);
    reset(shape_->restRoots);
    allocateForPlan();
}

void Engine::Impl::reset(std::span<const RootFrame> roots_ws) {
    report_ = {};
    state_.rests.assign(shape_->blocks.size(), {});
    forBlocks([&](std::size_t b) {
        float* rows = state_.roots.data() + b * kRootRows * kBlockLanes;
        for (std::uint32_t lane = 0; lane < kBlockLanes; ++lane) {
            const std::uint32_t strand = shape_->blocks[b].strandOfLane[lane];
            RootFrame root = roots_ws[strand];
            if (!usableWithin(root, kFarthest)) root = shape_->restRoots[strand];
            const float values[kRootRows] = {root.position.x, root.position.y, root.position.z,
                                             root.rotation.x, root.rotation.y, root.rotation.z,
                                             root.rotation.w};
            for (std::size_t r = 0; r < kRootRows; ++r) rows[r * kBlockLanes + lane] = values[r];
        }
        placeAtRest(b, kAllLanes);
    });
    state_.spheres.clear();
    state_.capsules.clear();
    state_.body.clear();
    hairGrid_.forget();
    bodyLost_ = true;
    state_.substep = 0.0f;
    state_.fastest = 0.0f;
    state_.origin_ws.reset();
    FrameInput here;
    here.roots_ws = roots_ws;
    teleportDistance_ = settings_.teleportDistance;
    takeRoots(here);
    // What effects have stays for the next frame, which knows its spheres: it takes no memory where they are
    // on.
    plan({}, {}, state_.rootsMin_ws, state_.rootsMax_ws, 0.0f);
}

void Engine::Impl::placeAtRest(std::size_t block, LaneRange lanes) {
    runtime::placeAtRest(*shape_, state_, block, lanes);
    strands_->placeAtRest(*shape_, state_, block, lanes);
}

/// In any order, on the host's threads.
void Engine::Impl::forBlocks(const std::function<void(std::size_t)>& each) {
    const auto run = [&](std::size_t begin, std::size_t end) {
        for (std::size_t b = begin; b < end; ++b) each(b);
    };
    inParallel(host_, shape_->blocks.size(), kBlocksPerJob, run);
}

void Engine::Impl::place(std::span<const RootFrame> roots_ws, std::span<const Float3> positions_ws,
                         std::span<const Float3> velocities_ws,
                         const std::optional<std::array<double, 3>>& origin_ws) {
    reset(roots_ws);
    state_.origin_ws = origin_ws;
    state_.substep = kUsualFrame / static_cast<float>(substepsIn(settings_, kUsualFrame));
    for (std::size_t b = 0; b < shape_->blocks.size(); ++b) {
        const Block& block = shape_->blocks[b];
        for (std::uint32_t lane = 0; lane < kBlockLanes; ++lane) {
            const std::size_t first = shape_->offsets[block.strandOfLane[lane]];
            const auto finite = [&](std::span<const Float3> values) {
                const auto strand = values.subspan(first, block.points);
                return std::all_of(strand.begin(), strand.end(),
                                   [](Float3 value) { return isFinite(value); });
            };
            if (finite(positions_ws) && finite(velocities_ws))
                placeLane(b, lane, &positions_ws[first], &velocities_ws[first]);
        }
    }
}

void Engine::Impl::placeLane(std::size_t index, std::uint32_t lane, const Float3* positions_ws,
                             const Float3* velocities_ws) {
    const Block& block = shape_->blocks[index];
    const std::size_t size = planeSize(block);
    const float* const root = state_.roots.data() + index * kRootRows * kBlockLanes + lane;
    const Float3 root_ws{root[0], root[kBlockLanes], root[2 * kBlockLanes]};
    float* const moving = state_.planes.data() + block.firstPlane * kStatePlanes;
    for (std::uint32_t p = 0; p < block.points; ++p) {
        const std::size_t i = std::size_t{p} * kBlockLanes + lane;
        const Float3 at = positions_ws[p] - root_ws, before = at - velocities_ws[p] * state_.substep;
        const float values[] = {at.x, at.y, at.z, before.x, before.y, before.z};
        for (std::size_t plane = 0; plane < kStatePlanes; ++plane) moving[plane * size + i] = values[plane];
    }
    strands_->placeOnPoints(*shape_, state_, index, lane);
}

std::string Engine::Impl::setSettings(const SimulationSettings& settings) {
    if (std::string error = validationError(settings); !error.empty()) return error;
    const SimulationSettings before = std::exchange(settings_, settings);
    const bool other = before.strandModel != settings.strandModel;
    if (other) strands_ = OwnedStrands(model().make());
    if (other || before.substeps != settings.substeps) allocateForBody();
    strands_->takeSettings(*shape_, settings_, other ? nullptr : &before, state_, host_);
    strands_->takeState(*shape_, settings_, state_);
    if (poses_) followPoses(false);
    if (asksForOtherHairGrid(before, settings_)) hairGrid_.take(*shape_, settings_, host_);
    scratch_ = {};
    wind_ = {makeWind(settings), false};
    state_.rests.assign(shape_->blocks.size(), {});
    replan({}, {}, state_.rootsMin_ws, state_.rootsMax_ws, 0.0f);
    return {};
}

bool Engine::Impl::setState(const State& state) {
    if (state.planes.size() != state_.planes.size() || state.roots.size() != state_.roots.size() ||
        state.rests.size() != state_.rests.size())
        return false;
    state_ = state;
    hairGrid_.forget();
    bodyLost_ = true;
    strands_->takeState(*shape_, settings_, state_);
    wind_.given = false;
    // The state keeps what its last frame had: all of it is what runs on.
    plan({}, {}, state_.rootsMin_ws, state_.rootsMax_ws, 0.0f);
    return true;
}

void Engine::Impl::replan(std::span<const Sphere> spheres, std::span<const Float3> sphereMotion,
                          Float3 rootsMin_ws, Float3 rootsMax_ws, float frameTime) {
    plan(spheres, sphereMotion, rootsMin_ws, rootsMax_ws, frameTime);
    allocateForPlan();
}

void Engine::Impl::plan(std::span<const Sphere> spheres, std::span<const Float3> sphereMotion,
                        Float3 rootsMin_ws, Float3 rootsMax_ws, float frameTime) {
    FramePlanInput planInput{strandCount(),         shape_->longestPointCount,
                             shape_->longestStrand, shape_->straight,
                             rootsMin_ws,           rootsMax_ws,
                             rootMotion_,           state_.fastest};
    planInput.hairCell = hairGrid_.cell();
    planInput.poseAmounts = poseAmounts_;
    planInput.restTime = 1e30f;
    for (std::size_t b = 0; b < state_.rests.size(); ++b) {
        if (state_.rests[b].asleep) planInput.asleep += shape_->blocks[b].strands;
        planInput.restTime = std::min(planInput.restTime, state_.rests[b].time);
    }
    plan_ = planFrame(settings_, planInput, wind_, spheres, sphereMotion, frameTime);
}

void Engine::Impl::allocateForPlan() {
    strands_->allocate(*shape_, settings_, plan_, meetsBody(), state_);
    for (Floats& own : state_.own) {
        if (own.empty() && !keepsMemory_) own = Floats();
    }
    // Sleeping strands keep theirs, so that they wake up without asking for memory.
    const std::size_t jobs = (shape_->blocks.size() + kBlocksPerJob - 1) / kBlocksPerJob;
    const std::size_t perPoint = model().solverFloats(plan_.stages());
    scratch_.grow(host_.parallelFor ? scratchPieces(jobs) : 1, model().laneFloats,
                  perPoint > 0 ? perPoint * shape_->longestPointCount + kSolverPadding : 0);
}

/// Measures what is known of the last frame from the origin of this one.
void Engine::Impl::moveOrigin(std::array<double, 3> origin_ws) {
    if (!isFinite(origin_ws)) origin_ws = state_.origin_ws.value_or(std::array<double, 3>{});
    const Float3 shift = shiftOfOrigin(state_.origin_ws.value_or(origin_ws), origin_ws);
    state_.origin_ws = origin_ws;
    if (shift == Float3{}) return;
    for (std::size_t b = 0; b < shape_->blocks.size(); ++b) {
        float* const rows = state_.roots.data() + b * kRootRows * kBlockLanes;
        const float parts[] = {shift.x, shift.y, shift.z};
        for (std::size_t i = 0; i < 3 * kBlockLanes; ++i) rows[i] += parts[i / kBlockLanes];
    }
    for (Sphere& sphere : state_.spheres) sphere.center_ws = sphere.center_ws + shift;
    for (BonePose& bone : state_.body) bone.origin = bone.origin + shift;
    bodyLost_ = true;
    state_.rootsMin_ws = state_.rootsMin_ws + shift;
    state_.rootsMax_ws = state_.rootsMax_ws + shift;
}

/// Keeps the roots that the frame ends on, their box and how far they go. What is no root stays where it was.
void Engine::Impl::takeRoots(const FrameInput& input) {
    RootBounds bounds = noRoots();
    const float cut = teleportDistance_ * std::abs(teleportDistance_);
    const Kernels& table = kernels();
    for (std::size_t b = 0; b < shape_->blocks.size(); ++b) {
        const Block& block = shape_->blocks[b];
        const float* rows = state_.roots.data() + b * kRootRows * kBlockLanes;
        float* const next = nextRoots_.data() + b * kRootRows * kBlockLanes;
        for (std::uint32_t lane = 0; lane < kBlockLanes; ++lane) {
            const RootFrame& root = input.roots_ws[block.strandOfLane[lane]];
            const float values[kRootRows] = {root.position.x, root.position.y, root.position.z,
                                             root.rotation.x, root.rotation.y, root.rotation.z,
                                             root.rotation.w};
            for (std::size_t r = 0; r < kRootRows; ++r) next[r * kBlockLanes + lane] = values[r];
        }
        bounds.anyTeleported = false;
        if (!table.takeRoots(rows, next, false, cut, bounds)) {
            repairRoots(b);
            table.takeRoots(rows, next, true, cut, bounds);
        }
        blockReports_[b].rootsTeleported = bounds.anyTeleported;
        blockReports_[b].rootsMoved = std::memcmp(rows, next, kRootRows * kBlockLanes * sizeof(float)) != 0;
    }
    rootMotion_ = std::sqrt(maximum(bounds.longest));
    state_.rootsMin_ws = {minimum(bounds.low[0]), minimum(bounds.low[1]), minimum(bounds.low[2])};
    state_.rootsMax_ws = {maximum(bounds.high[0]), maximum(bounds.high[1]), maximum(bounds.high[2])};
}

/// Puts the block's roots that are no positions back to those of the last frame.
void Engine::Impl::repairRoots(std::size_t block) {
    const float* const rows = state_.roots.data() + block * kRootRows * kBlockLanes;
    float* const next = nextRoots_.data() + block * kRootRows * kBlockLanes;
    for (std::uint32_t lane = 0; lane < kBlockLanes; ++lane) {
        const auto given = [&](std::size_t r) -> float& { return next[r * kBlockLanes + lane]; };
        RootFrame root{{given(0), given(1), given(2)}, {given(3), given(4), given(5), given(6)}};
        if (usableWithin(root, kFarthest)) {
            given(3) = root.rotation.x;
            given(4) = root.rotation.y;
            given(5) = root.rotation.z;
            given(6) = root.rotation.w;
            continue;
        }
        for (std::size_t r = 0; r < kRootRows; ++r) given(r) = rows[r * kBlockLanes + lane];
        if (lane < shape_->blocks[block].strands) ++report_.rejectedRoots;
    }
}

void Engine::Impl::setBody(std::shared_ptr<const BodyField> body) {
    if (!body && !body_) return;
    body_ = std::move(body);
    state_.body.clear();
    strands_->forgetBody(state_);
    state_.rests.assign(shape_->blocks.size(), {});
    allocateForBody();
    allocateForPlan();
}

void Engine::Impl::allocateForBody() {
    clearances_ = meetsBody() ? bodyClearances(*shape_, *body_) : Floats();
    bodyTable_ = meetsBody() ? BodyTable(*body_) : BodyTable();
    bodyCarriers_ = meetsBody() ? carriersOf(*shape_, *body_) : Vector<std::uint32_t>();
    bodySeen_ = Floats(meetsBody() ? kBodyPlanes * shape_->planeFloats : 0, kNeverSeen);
    bodyLost_ = true;
    movingBody_ = {};
    if (!meetsBody()) return;
    const std::uint32_t most = kMostMoreSubsteps * substepsIn(settings_, kUsualFrame);
    movingBody_.reserve(*body_, bodyTable_, bodyCarriers_, std::min(most, kMaxSubsteps));
}

std::uint32_t Engine::Impl::substepsOf(const FrameInput& input, std::uint32_t usual) const {
    if (!meetsBody()) return usual;
    return substepsBesideBody(std::max(rootMotion_, state_.fastest * input.dt), usual);
}

/// Poses the body for the substeps of the frame.
void Engine::Impl::takeBody(const FrameInput& input) {
    movingBody_.clear();
    bodyMoves_ = false;
    if (!meetsBody()) return;
    const BodyWay way = bodyWay(*body_, input.body_ws, state_.body, teleportDistance_);
    if (way.to.empty()) return;
    bodyLost_ = bodyLost_ || way.isCut;
    bodyMoves_ = way.moves;
    movingBody_.take(*body_, bodyTable_, way.from, way.to, bodyCarriers_, substeps_);
    if (bodyLost_ || movingBody_.lostTrack()) std::fill(bodySeen_.begin(), bodySeen_.end(), kNeverSeen);
    bodyLost_ = false;
    if (way.to.data() != state_.body.data()) state_.body.assign(way.to.begin(), way.to.end());
}

/// Whether a sphere that has changed since the last frame comes within reach of the block's strands.
bool Engine::Impl::sphereNear(std::size_t block) const {
    const float* rows = state_.roots.data() + block * kRootRows * kBlockLanes;
    for (const Sphere& waking : spheres_.waking) {
        for (std::uint32_t lane = 0; lane < shape_->blocks[block].strands; ++lane) {
            const Float3 root{rows[lane], rows[kBlockLanes + lane], rows[2 * kBlockLanes + lane]};
            if (length(root - waking.center_ws) < waking.radius) return true;
        }
    }
    return false;
}

bool Engine::Impl::isWindy() const {
    return length(wind_.wind.mean) > 0.0f && settings_.airDrag > 0.0f;
}

void Engine::Impl::wakeBlocks() {
    const bool windy = isWindy();
    for (std::size_t b = 0; b < state_.rests.size(); ++b) {
        Rest& rest = state_.rests[b];
        if (rest.asleep &&
            (windy || bodyMoves_ || skinSpheresChanged_ || blockReports_[b].rootsMoved || sphereNear(b)))
            rest = {};
    }
    skinSpheresChanged_ = false;
}

Engine::Impl::Frame Engine::Impl::makeFrame(const FrameInput& input) {
    Frame frame{};
    frame.input = &input;
    const std::span<const MovingSphere> spheres(movingSpheres_);
    frame.context =
        substepContext(settings_, plan_, input.dt, substeps_,
                       model().listsSpheres ? spheres.first(pressing_) : spheres, movingCapsules_);
    if (model().listsSpheres) {
        frame.context.shelters = spheres;
    } else {
        // Those along capsules come last.
        const auto given = std::count_if(
            spheres_.usable.begin(), spheres_.usable.begin() + static_cast<std::ptrdiff_t>(spheres_.given),
            [](const Sphere& sphere) { return sphere.radius > 0.0f; });
        frame.context.shelters = frame.context.spheres.first(
            std::min(frame.context.spheres.size(), static_cast<std::size_t>(given)));
    }
    if (!movingBody_.empty()) {
        frame.context.body = &movingBody_;
        frame.context.spheresRest = frame.context.spheresRest && !bodyMoves_;
        frame.context.collisionRadiusAtRoot = settings_.collisionRadiusRoot;
        frame.context.collisionRadiusAtTip = settings_.collisionRadiusTip;
    }
    const float h = frame.context.h;
    frame.windy = plan_.on(Effect::wind);
    if (frame.windy) {
        const double time = std::isfinite(input.time) ? input.time : 0.0;
        frame.windFrom = windPhases(wind_.wind, time - static_cast<double>(input.dt), *state_.origin_ws);
        frame.windTo = windPhases(wind_.wind, time, *state_.origin_ws);
    }
    frame.context.stepRatio = state_.substep > 0.0f ? h / state_.substep : kFirstStepRatio;
    frame.context.conservative = !frame.windy;
    if (frame.windy) {
        frame.context.wind = &wind_.wind;
        const double time = std::isfinite(input.time) ? input.time : 0.0;
        for (std::uint32_t i = 0; i < frame.context.count; ++i) {
            const double left = static_cast<double>(frame.context.count - 1 - i) * static_cast<double>(h);
            frame.windPhases[i] = windPhases(wind_.wind, time - left, *state_.origin_ws);
        }
    }
    frame.rescale = state_.substep > 0.0f ? h / state_.substep : 1.0f;
    frame.starts = !(state_.substep > 0.0f);
    frame.kernels = &kernels();
    frame.passes = model().passes(plan_.stages(), static_cast<bool>(host_.nanoseconds));
    return frame;
}

void Engine::Impl::stepStraight(const FrameInput& input, std::uint32_t substeps) {
    const std::uint64_t begin = host_.nanoseconds ? host_.nanoseconds() : 0;
    report_ = {};

    moveOrigin(input.origin_ws);
    const Float3 lowBefore = state_.rootsMin_ws, highBefore = state_.rootsMax_ws;
    teleportDistance_ = teleportDistanceOf(settings_, input);
    takeRoots(input);
    const Float3 low = state_.rootsMin_ws, high = state_.rootsMax_ws;
    takeSpheres(settings_, shape_->longestStrand, {state_.spheres, state_.capsules, input.cut}, input.spheres,
                input.capsules, spheres_);
    report_.rejectedSpheres = spheres_.rejected;
    report_.rejectedWinds = takeWind(settings_, input, wind_);
    report_.substeps = substeps_ = substepsOf(input, substeps);
    takeBody(input);
    setPoseAmounts(input.poseAmounts);
    if (!movingBody_.empty() && skinSpheres_.size() == spheres_.given)
        spheres_.ofSkin.assign(skinSpheres_.begin(), skinSpheres_.end());
    wakeBlocks();
    replan(spheres_.planned, spheres_.plannedMotion,
           {std::min(low.x, lowBefore.x), std::min(low.y, lowBefore.y), std::min(low.z, lowBefore.z)},
           {std::max(high.x, highBefore.x), std::max(high.y, highBefore.y), std::max(high.z, highBefore.z)},
           input.dt);
    if (!plan_.on(Effect::collision)) {
        movingSpheres_ = {};
        movingCapsules_ = {};
        pressing_ = 0;
    } else if (model().listsSpheres) {
        pressing_ = moveCapsules(spheres_, substeps_, movingSpheres_, movingCapsules_);
        scratch_.reserveSpheres(spheres_.given, movingCapsules_.size());
    } else {
        moveSpheres(spheres_, substeps_, movingSpheres_);
    }

    // Where there is no memory for them nothing has moved yet.
    state_.spheres.reserve(spheres_.given);
    state_.capsules.reserve(spheres_.capsules.size());
    const Frame frame = makeFrame(input);
    if (hairGrid_.isOn() && !plan_.stages().empty())
        hairGrid_.update(*shape_, state_, nextRoots_, settings_, {frame.context.h, substeps_, input.cut},
                         host_);
    runBlocks(frame);
    const std::span<const Sphere> given = std::span(spheres_.usable).first(spheres_.given);
    state_.spheres.assign(given.begin(), given.end());
    state_.capsules.assign(spheres_.capsules.begin(), spheres_.capsules.end());
    state_.substep = frame.context.h;
    strands_->closeFrame(frame);
    sumReports();
    if (host_.nanoseconds) report_.milliseconds = static_cast<double>(host_.nanoseconds() - begin) * 1e-6;
}

void Engine::Impl::runBlocks(const Frame& frame) {
    const auto run = [&](std::size_t first, std::size_t end) {
        Scratch::Piece& piece = scratch_.take();
        for (std::size_t b = first; b < end; ++b) runBlock(b, piece.lanes, frame);
        piece.taken.store(false, std::memory_order_release);
    };
    inParallel(host_, shape_->blocks.size(), kBlocksPerJob, run);
}

void Engine::Impl::sumReports() {
    float fastest = 0.0f;
    for (const BlockReport& block : blockReports_) {
        for (std::size_t i = 0; host_.nanoseconds && i < kStageCount; ++i)
            report_.stageMilliseconds[i] += static_cast<double>(block.nanoseconds[i]) * 1e-6;
        report_.restoredStrands += block.restored;
        report_.guardedStrands += block.guarded;
        fastest = std::max(fastest, block.fastest);
    }
    state_.fastest = std::sqrt(fastest) / state_.substep;
    if (report_.restoredStrands > 0 && host_.log) {
        host_.log(std::to_string(report_.restoredStrands) +
                  " strands had left the range of sound places and were put back to rest");
    }
}

BlockView& Engine::Impl::view(std::size_t block, BlockRoom& room) {
    BlockView& view = strands_->view(*shape_, state_, block, settings_.clampedPoints, room);
    if (meetsBody()) {
        view.clearance = clearances_.data() + shape_->blocks[block].firstPlane;
        view.bodySeen = bodySeen_.data() + kBodyPlanes * shape_->blocks[block].firstPlane;
    }
    if (hairGrid_.isOn()) hairGrid_.show(shape_->blocks[block], view);
    return view;
}

void Engine::Impl::addVelocities(std::span<const Float3> changes_ws) {
    const float h = state_.substep;
    for (std::size_t b = 0; b < shape_->blocks.size(); ++b) {
        const Block& block = shape_->blocks[b];
        BlockRoom room;
        const BlockView& blockView = view(b, room);
        const Planes previous = blockView.previous;
        bool changed = false;
        for (std::uint32_t lane = 0; lane < kBlockLanes; ++lane) {
            // Lanes past the last strand repeat it.
            const std::uint32_t first = shape_->offsets[block.strandOfLane[lane]];
            for (std::uint32_t p = settings_.clampedPoints; p < block.points; ++p) {
                const Float3 change = changes_ws[first + p];
                if (!isFinite(change) || change == Float3{}) continue;
                const std::size_t i = std::size_t{p} * kBlockLanes + lane;
                previous.x[i] -= change.x * h;
                previous.y()[i] -= change.y * h;
                previous.z()[i] -= change.z * h;
                strands_->addVelocity(blockView, i, lane, change);
                changed = true;
            }
        }
        if (changed) state_.rests[b] = {};
    }
}

}  // namespace hairloom::runtime
