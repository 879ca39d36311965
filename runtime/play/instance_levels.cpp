// SPDX-License-Identifier: MIT
// Levels of detail of an instance: going from one to another, and what each is worth.

#include <algorithm>
#include <cmath>
#include <cstring>

#include "engine/checks.h"
#include "play/instance.h"

namespace hairloom::runtime {
namespace {

constexpr float kHeld = 0.5f;       ///< seconds in which what a head did fades out of predictions
constexpr float kFade = 0.1f;       ///< seconds in which a new level's difference falls to 1/e
constexpr float kFadedOut = 1e-5f;  ///< metres
constexpr std::size_t kRootsLookedAt = 64;

// Rates of the machine of docs/integrate.md, in milliseconds.
constexpr float kPointSubstep = 3.0e-5f;
constexpr float kRootPose = 5.0e-6f;
constexpr float kShownPoint = 1.2e-5f;
constexpr float kReadPoint = 2.0e-6f;
constexpr float kHairPoint = 3.2e-6f;

/// Metres, of hair that was not stepped yet: nobody knows how it will move.
constexpr float kUnknown = 1;

}  // namespace

Instance::Levels::Levels() = default;

void Instance::makeLevels(const Asset& asset, const Asset::Strands& strands) {
    auto set = makeShared<LevelSet>(strands);
    levels_.emplace();
    const std::span<const float> stiffness = asset.strandStiffness();
    Vector<float> ofGuides;
    for (const Level& level : set->coarser) {
        ofGuides.clear();
        for (const std::uint32_t guide : level.guides)
            if (!stiffness.empty()) ofGuides.push_back(stiffness[guide]);
        SimulationSettings settings = asset.simulation();
        settings.substeps = level.substepsUnder(settings);
        levels_->engines.push_back(std::move(
            *Engine::make({level.offsets, level.positions_ss, {}, {}, ofGuides}, settings, host_).engine));
        if (body_) levels_->engines.back().setBody(body_);
        levels_->engines.back().setSkinSpheres(skinSpheres_);
    }
    levels_->placed.resize(roots_.size());
    levels_->fade.resize(positions_.size());
    velocities_.resize(positions_.size());
    std::size_t guides = 0, points = 0;
    for (const Level& level : set->coarser) {
        guides = std::max(guides, level.guides.size());
        points = std::max(points, level.positions_ss.size());
    }
    levels_->simulatedRoots.resize(guides);
    levels_->simulated.resize(points);
    levels_->moved.resize(points);
    takeHairs(1);
    levels_->set = set;
    resetLevel();
    const auto known = asset.levelErrors();
    static_assert(asset::kLevels == HL_LEVEL_COUNT);
    for (std::size_t level = 0; level < known.size(); ++level)
        set->errors[level] = {known[level].still, known[level].head, known[level].wind};
    if (known.empty()) measureLevels(*set);
    // Of an asset that nobody looked at from afar: no less than the strict one is safe.
    set->seen = set->errors;
    const auto seen = asset.seenErrors();
    for (std::size_t level = 0; level < seen.size(); ++level)
        set->seen[level] = {seen[level].still, seen[level].head, seen[level].wind};
}

Engine* Instance::engineAt(std::uint32_t number) {
    if (number == HL_LEVEL_FINEST) return &engine_;
    return number == HL_LEVEL_RIGID ? nullptr : &levels_->engines[number - 1];
}

void Instance::placeRootsOfLevels() {
    Levels& levels = *levels_;
    if (levels.level == HL_LEVEL_FINEST || levels.level == HL_LEVEL_RIGID) return;
    const Level& level = levels.set->coarser[levels.level - 1];
    for (std::size_t s = 0; s < level.guides.size(); ++s)
        levels.simulatedRoots[s] = levels.placed[level.guides[s]];
}

void Instance::resetLevel() {
    Levels& levels = *levels_;
    for (std::size_t g = 0; g < roots_.size(); ++g) {
        RootFrame root = roots_[g];
        if (usableWithin(root, kFarthest)) levels.placed[g] = root;
    }
    levels.origin.reset();
    levels.motion = levels.wind = 0;
    levels.velocity = {};
    levels.fading = false;
    placeRootsOfLevels();
    if (Engine* const engine = engineOfLevel(); engine && engine != &engine_)
        engine->reset(std::span(levels.simulatedRoots).first(engine->strandCount()));
}

void Instance::setSettingsOfLevels(const SimulationSettings& settings, std::span<Engine> engines) const {
    for (std::size_t i = 0; i < engines.size(); ++i) {
        SimulationSettings coarser = settings;
        coarser.substeps = levels_->set->coarser[i].substepsUnder(settings);
        engines[i].setSettings(coarser);
    }
}

/// How fast roots and wind are, for predictions, and where roots are.
void Instance::holdMotion(const FrameInput& input) {
    Levels& levels = *levels_;
    Float3 shift{};
    if (levels.origin) {
        shift = {static_cast<float>(input.origin_ws[0] - (*levels.origin)[0]),
                 static_cast<float>(input.origin_ws[1] - (*levels.origin)[1]),
                 static_cast<float>(input.origin_ws[2] - (*levels.origin)[2])};
    }
    const std::size_t step = std::max<std::size_t>(1, roots_.size() / kRootsLookedAt);
    Float3 sum{};
    float squares = 0, looked = 0;
    for (std::size_t g = 0; g < roots_.size(); ++g) {
        RootFrame root = roots_[g];
        if (!usableWithin(root, kFarthest)) continue;
        if (g % step == 0) {
            const Float3 moved = root.position - levels.placed[g].position + shift;
            sum = sum + moved;
            squares += dot(moved, moved);
            ++looked;
        }
        levels.placed[g] = root;
    }
    const bool known = !input.cut && levels.origin.has_value() && looked > 0 && std::isfinite(squares);
    levels.velocity = known ? sum * (1 / (looked * input.dt)) : Float3{};
    const float speed = known ? std::sqrt(squares / looked) / input.dt : 0;
    const float kept = 1 / (1 + input.dt / kHeld);
    levels.motion = std::max(speed, levels.motion * kept);
    const float wind = input.wind_ws ? length(*input.wind_ws) : engine_.settings().windSpeed;
    levels.wind = std::max(std::isfinite(wind) ? wind : 0, levels.wind * kept);
    levels.origin = input.origin_ws;
    for (double& axis : *levels.origin)
        if (!std::isfinite(axis)) axis = 0;
}

/// Those of the guides that the level simulates.
void Instance::takeRootsOfLevel(const Engine& engine, FrameInput& input) {
    const std::size_t count = engine.strandCount();
    input.roots_ws = std::span<const RootFrame>(levels_->simulatedRoots).first(count);
    if (input.inner.empty()) return;
    const Level& level = levels_->set->coarser[levels_->level - 1];
    inner_.simulatedRoots.clear();
    for (const InnerPose& pose : inner_.poses) {
        for (const std::uint32_t guide : level.guides) {
            // To the bit as holdMotion() has those of the frame. The engine leaves out what is no root.
            RootFrame root = pose.roots_ws[guide];
            inner_.simulatedRoots.push_back(usableWithin(root, kFarthest) ? root : pose.roots_ws[guide]);
        }
    }
    for (std::size_t i = 0; i < inner_.poses.size(); ++i)
        inner_.poses[i].roots_ws =
            std::span<const RootFrame>(inner_.simulatedRoots).subspan(i * count, count);
    input.inner = inner_.poses;
}

void Instance::stepLevel(FrameInput& input) {
    Levels& levels = *levels_;
    holdMotion(input);
    placeRootsOfLevels();
    if (Engine* const engine = engineOfLevel()) {
        if (engine != &engine_) takeRootsOfLevel(*engine, input);
        engine->step(input);
        if (engine->asleep() == engine->strandCount()) levels.motion = levels.wind = 0;
    }
    fadeLevel(input.dt);
}

/// What a new level differs by goes away.
void Instance::fadeLevel(float dt) {
    Levels& levels = *levels_;
    if (!levels.fading) return;
    const float kept = 1 / (1 + dt / kFade);
    float greatest = 0;
    for (Float3& away : levels.fade) {
        away = away * kept;
        greatest = std::max(greatest, dot(away, away));
    }
    levels.fading = greatest > kFadedOut * kFadedOut;
}

void Instance::showPositions() {
    if (playedWaits_) return;
    const Engine* const engine = engineOfLevel();
    if (engine == &engine_) {
        engine_.readPositions(positions_);
    } else if (engine) {
        const auto simulated = std::span(levels_->simulated).first(engine->pointCount());
        engine->readPositions(simulated);
        showGuides(*levels_->set, levels_->set->coarser[levels_->level - 1], standing(), levels_->placed,
                   simulated, levels_->moved, positions_);
    } else {
        showRigid(*levels_->set, standing(), levels_->placed, positions_);
    }
    if (!levels_ || !levels_->fading) return;
    for (std::size_t g = 0; g < roots_.size(); ++g) {
        for (std::size_t p = offsets_[g]; p < offsets_[g + 1]; ++p)
            positions_[p] = positions_[p] + rotate(levels_->placed[g].rotation, levels_->fade[p]);
    }
}

void Instance::showVelocities() {
    if (playedWaits_) return;
    const Engine* const engine = engineOfLevel();
    if (engine == &engine_) {
        engine_.readVelocities(velocities_);
        return;
    }
    if (!engine) {
        std::fill(velocities_.begin(), velocities_.end(), levels_->velocity);
        return;
    }
    const auto simulated = std::span(levels_->simulated).first(engine->pointCount());
    engine->readVelocities(simulated);
    const Level& level = levels_->set->coarser[levels_->level - 1];
    for (std::size_t g = 0; g < roots_.size(); ++g) {
        const std::size_t first = offsets_[g], count = offsets_[g + 1] - first;
        const Level::Sources& sources = level.sources[g];
        for (std::size_t p = 0; p < count; ++p) {
            Float3 sum{};
            for (std::size_t i = 0; i < 3; ++i) {
                const std::size_t s = level.offsets[sources.guides[i]];
                const std::size_t points = level.offsets[sources.guides[i] + 1] - s;
                sum = sum + sampleAt(std::span<const Float3>(simulated).subspan(s, points), p, count) *
                                sources.shares[i];
            }
            velocities_[first + p] = sum;
        }
    }
}

Outcome Instance::setLevel(std::uint32_t number, float hairShare) {
    if (!levels_) return Refusal{HL_BAD_VALUE, "the instance was made without HL_LEVELS"};
    if (number >= HL_LEVEL_COUNT)
        return Refusal{HL_BAD_VALUE,
                       "level " + std::to_string(number) + " of " + std::to_string(HL_LEVEL_COUNT)};
    if (!(hairShare > 0) || hairShare > 1)
        return Refusal{HL_BAD_VALUE,
                       "hair_share is " + std::to_string(hairShare) + "; expected above 0 to 1"};
    Levels& levels = *levels_;
    takeHairs(hairShare);
    if (number == levels.level) return std::nullopt;
    settlePlayed();
    leaveGpu();
    ++changes_;
    showPositions();
    showVelocities();
    levels.level = number;
    levels.fading = hairPoses_.isStanding = false;
    asleep_ = last_.known = false;
    levels.fade.swap(positions_);  // where they are seen now
    placeRootsOfLevels();
    if (Engine* const engine = engineOfLevel(); engine == &engine_) {
        engine_.place(levels.placed, levels.fade, velocities_);
    } else if (engine) {
        placeCoarser(*engine, levels.fade, std::nullopt);
    }
    showPositions();
    for (std::size_t g = 0; g < roots_.size(); ++g) {
        const Quat back = conjugate(levels.placed[g].rotation);
        for (std::size_t p = offsets_[g]; p < offsets_[g + 1]; ++p) {
            const Float3 away = rotate(back, levels.fade[p] - positions_[p]);
            levels.fade[p] = isFinite(away) ? away : Float3{};
        }
    }
    levels.fading = true;
    return std::nullopt;
}

/// Of the level's engine: the points that it has of its guides, of the given positions and of velocities_.
void Instance::placeCoarser(Engine& engine, std::span<const Float3> positions_ws,
                            const std::optional<std::array<double, 3>>& origin_ws) {
    Levels& levels = *levels_;
    const Level& level = levels.set->coarser[levels.level - 1];
    for (std::size_t s = 0; s < level.guides.size(); ++s) {
        const std::size_t first = offsets_[level.guides[s]], count = offsets_[level.guides[s] + 1] - first;
        const std::size_t points = level.offsets[s + 1] - level.offsets[s];
        for (std::size_t p = 0; p < points; ++p) {
            levels.simulated[level.offsets[s] + p] = sampleAt(positions_ws.subspan(first, count), p, points);
            levels.moved[level.offsets[s] + p] =
                sampleAt(std::span<const Float3>(velocities_).subspan(first, count), p, points);
        }
    }
    engine.place(std::span(levels.simulatedRoots).first(engine.strandCount()),
                 std::span(levels.simulated).first(engine.pointCount()),
                 std::span(levels.moved).first(engine.pointCount()), origin_ws);
}

hl_level Instance::describeLevel(std::uint32_t number) const {
    hl_level level{};
    if (number == HL_LEVEL_FINEST) {
        level.guides = static_cast<std::uint32_t>(roots_.size());
        level.points = static_cast<std::uint32_t>(positions_.size());
        level.substeps = engine_.settings().substeps;
    } else if (number < HL_LEVEL_RIGID) {
        const Engine& engine = levels_->engines[number - 1];
        level.guides = engine.strandCount();
        level.points = engine.pointCount();
        level.substeps = engine.settings().substeps;
    }
    const LevelError error = levels_ ? levels_->set->errors[number] : LevelError{};
    level.error_still = error.still;
    level.error_head = error.head;
    level.error_wind = error.wind;
    const LevelError seen = levels_ ? levels_->set->seen[number] : LevelError{};
    level.seen_still = seen.still;
    level.seen_head = seen.head;
    level.seen_wind = seen.wind;
    const auto points = static_cast<float>(positions_.size());
    level.milliseconds =
        kPointSubstep * static_cast<float>(level.points) * static_cast<float>(level.substeps) +
        kRootPose * static_cast<float>(roots_.size()) +
        (level.points == 0 || number == HL_LEVEL_FINEST ? kReadPoint : kShownPoint) * points;
    if (hairs_) level.milliseconds += kHairPoint * static_cast<float>(hairPoints());
    return level;
}

float Instance::predictedError(std::uint32_t number, bool ofPaths) const {
    if (number == HL_LEVEL_FINEST) return 0;
    if (!levels_->origin) return kUnknown;
    const LevelError& error = (ofPaths ? levels_->set->errors : levels_->set->seen)[number];
    return error.still + error.head * levels_->motion + error.wind * levels_->wind;
}

float Instance::predictedMilliseconds(std::uint32_t number, float hairShare) const {
    if (asleep_ && number == levels_->level) return 0;
    const float hairs = hairs_ ? kHairPoint * static_cast<float>(hairPoints()) : 0;
    return describeLevel(number).milliseconds - hairs * (1 - hairShare);
}

std::uint32_t Instance::hairsRead() const {
    if (!hairs_) return 0;
    return levels_ ? levels_->taken.back() : hairs_->hairCount();
}

/// Of each guide at least one, where it has any.
void Instance::takeHairs(float share) {
    if (share != levels_->share) {
        ++changes_;
        shown_[1].state = 0;
    }
    levels_->share = share;
    levels_->taken.assign(hairGroups_.size(), 0);
    for (std::size_t g = 0; g + 1 < hairGroups_.size(); ++g) {
        levels_->taken[g + 1] = levels_->taken[g] + takenOf(hairGroups_[g + 1] - hairGroups_[g], share);
    }
}

std::uint64_t Instance::hash() const {
    settlePlayed();
    if (level() == HL_LEVEL_FINEST) return engine_.stateHash();
    const Engine* const engine = engineOfLevel();
    std::uint64_t hash = engine ? engine->stateHash() : 0;
    for (const RootFrame& root : levels_->placed) {
        std::uint32_t bits[3];
        std::memcpy(bits, &root.position, sizeof bits);
        for (const std::uint32_t word : bits) hash = (hash ^ word) * 0x9e3779b97f4a7c15ull;
    }
    // Hair that is not simulated stands in its poses.
    for (const float amount : hairPoses_.amounts) {
        std::uint32_t bits = 0;
        std::memcpy(&bits, &amount, sizeof bits);
        if (bits != 0) hash = (hash ^ bits) * 0x9e3779b97f4a7c15ull;
    }
    return hash ^ levels_->level;
}

std::size_t Instance::bytesOfLevels() const {
    if (!levels_) return 0;
    const Levels& levels = *levels_;
    std::size_t bytes = levels.set->bytes() + sizeof(LevelSet) + levels.taken.size() * sizeof(std::uint32_t) +
                        (levels.placed.size() + levels.simulatedRoots.size()) * sizeof(RootFrame) +
                        (levels.fade.size() + levels.simulated.size() + levels.moved.size()) * sizeof(Float3);
    for (const Engine& engine : levels.engines) {
        bytes += sizeof(Engine) + engine.baseBytes() + bytesOfPoses(engine);
        for (std::uint32_t effect = 0; effect < kEffectCount; ++effect)
            bytes += engine.effectBytes(static_cast<Effect>(effect));
    }
    if (!hairs_) bytes += velocities_.size() * sizeof(Float3);
    return bytes;
}

}  // namespace hairloom::runtime
