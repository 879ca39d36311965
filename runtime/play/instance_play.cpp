// SPDX-License-Identifier: MIT
// Plays the clip of an asset: an instance's points are where the clip has them on the head of the frame, with
// the speeds that they then have, so that a step may follow.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "engine/checks.h"
#include "engine/in_parallel.h"
#include "play/head_turn.h"
#include "play/instance.h"

namespace hairloom::runtime {
namespace {

constexpr std::size_t kPlacedStrandsPerJob = 128;

Refusal refusalOf(AssetError problem) {
    return {problem.kind == AssetError::Kind::newer ? HL_NEWER : HL_DAMAGED, std::move(problem.words),
            problem.byte};
}

Outcome checkPlay(const hl_play& how) {
    if (!std::isfinite(how.time)) return Refusal{HL_BAD_VALUE, "play.time is not finite"};
    if (!std::isfinite(how.speed) || std::abs(how.speed) > 1000)
        return Refusal{HL_BAD_VALUE,
                       "play.speed is " + std::to_string(how.speed) + "; expected -1000 to 1000"};
    if (how.loop > HL_LOOP_ALWAYS)
        return Refusal{HL_BAD_VALUE, "play.loop is " + std::to_string(how.loop) + "; expected 0 to 2"};
    return std::nullopt;
}

}  // namespace

Outcome Instance::play(const Asset& asset, const hl_frame& frame, const hl_play& how) {
    if (frame.dt == 0) return std::nullopt;
    if (Outcome refused = checkStep(frame)) return refused;
    if (Outcome refused = checkPlay(how)) return refused;
    const asset::Clip* const clip = asset.clip();
    if (!clip) return Refusal{HL_BAD_VALUE, "the asset has no clip"};
    if (!clip_ || !clip_->isSame(asset)) {
        if (asset_ != numberOf(asset)) return Refusal{HL_BAD_VALUE, "the clip is of another hairstyle"};
        if (const auto problem = asset.checkContent()) return refusalOf(*problem);
        if (!clip_) clip_.emplace();
        allStrands_.resize(roots_.size());
        std::iota(allStrands_.begin(), allStrands_.end(), 0u);
        rootsBefore_.resize(roots_.size());
        velocities_.resize(positions_.size());
    }
    const bool loops = how.loop == HL_LOOP_AS_AUTHORED ? clip->loops != 0 : how.loop == HL_LOOP_ALWAYS;
    const ClipMoment moment = clipMoment(*clip, how.time, loops);
    const std::uint32_t number = level();
    std::span<const std::uint32_t> strands = allStrands_;
    if (number == HL_LEVEL_RIGID)
        strands = {};
    else if (number != HL_LEVEL_FINEST)
        strands = levels_->set->coarser[number - 1].guides;
    if (auto problem = clip_->decode(asset, moment, strands, number, host_))
        return refusalOf(std::move(*problem));

    const HeadBefore before = headBefore(frame);
    FrameInput input;
    if (Outcome refused = place(frame, input)) return refused;
    leaveGpu();
    takeTurns();
    takeOrigin(frame);
    if (levels_) {
        holdMotion(input);
        placeRootsOfLevels();
    }
    playOnto(before, frame, moment.moves ? clip->framesPerSecond * how.speed : 0, moment.share, strands);
    placePlayed();
    if (levels_) fadeLevel(frame.dt);
    asleep_ = last_.known = false;
    played_ = true;
    ++changes_;
    return std::nullopt;
}

std::size_t Instance::clipMemory(const Asset& asset) {
    const std::size_t strands = asset.strandCount(), points = asset.pointCount();
    return ClipPlayer::bytesFor(strands, points) + strands * (sizeof(std::uint32_t) + sizeof(Float3)) +
           points * sizeof(Float3);
}

/// The roots of the last frame, measured from the origin of this one.
Instance::HeadBefore Instance::headBefore(const hl_frame& frame) {
    HeadBefore before;
    if (!rootsKnown_) return before;
    const auto shift = [&](std::size_t axis) {
        const double moved = origin_[axis] - frame.origin[axis];
        return std::isfinite(moved) ? static_cast<float>(moved) : 0.0f;
    };
    const Float3 moved{shift(0), shift(1), shift(2)};
    before.turn = headTurn(poses_.restRoots(), roots_);
    before.known = true;
    for (std::size_t s = 0; s < roots_.size(); ++s) rootsBefore_[s] = roots_[s].position + moved;
    return before;
}

/// `rate`: frames of the clip a second.
void Instance::playOnto(const HeadBefore& before, const hl_frame& frame, float rate, float share,
                        std::span<const std::uint32_t> strands) {
    const Quat turn = headTurn(poses_.restRoots(), roots_);
    const float cut = engine_.settings().teleportDistance, perSecond = 1 / frame.dt;
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    inParallel(host_, strands.size(), kPlacedStrandsPerJob, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t s = strands[i];
            RootFrame root = roots_[s];
            // The engine puts a strand that is nowhere to rest.
            if (!usableWithin(root, kFarthest)) root.position = {kNone, kNone, kNone};
            Float3 carried{};
            bool turns = before.known;
            if (before.known) {
                const Float3 moved = root.position - rootsBefore_[s];
                turns = frame.cut == 0 && dot(moved, moved) <= cut * cut;
                if (turns) carried = moved * perSecond;
            }
            positions_[offsets_[s]] = root.position;
            velocities_[offsets_[s]] = carried;
            for (std::uint32_t p = 1; p < offsets_[s + 1] - offsets_[s]; ++p) {
                const ClipPlayer::Place at = clip_->place(s, p, share);
                const Float3 away = rotate(turn, at.offset);
                Float3 velocity = carried + rotate(turn, at.moved) * rate;
                if (turns) velocity = velocity + (away - rotate(before.turn, at.offset)) * perSecond;
                positions_[offsets_[s] + p] = root.position + away;
                velocities_[offsets_[s] + p] = velocity;
            }
        }
    });
}

/// positions_ and velocities_ become those of the level's engine, at the finest level once it is needed. Only
/// the engine knows where a strand without a place lies, and reading adds what fades to what it has.
void Instance::placePlayed() {
    Engine* const engine = engineOfLevel();
    playedWaits_ = engine == &engine_;
    if (!playedWaits_) {
        if (engine) placeCoarser(*engine, positions_, origin_);
        return;
    }
    const bool hasPlaces = std::none_of(allStrands_.begin(), allStrands_.end(), [&](std::uint32_t strand) {
        return std::isnan(positions_[offsets_[strand]].x);
    });
    if (!hasPlaces || (levels_ && levels_->fading)) settlePlayed();
}

void Instance::settlePlayed() {
    if (!playedWaits_) return;
    engine_.place(roots_, positions_, velocities_, origin_);
    playedWaits_ = false;
}

}  // namespace hairloom::runtime
