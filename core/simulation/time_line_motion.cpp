// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/simulation/time_line_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/smooth_step.h"
#include "core/simulation/clip_motion.h"

namespace hairloom {
namespace {

/// Metres between origins of poses: near the world's there is no other.
constexpr double kOriginGrid = 64;
/// Of a clip's duration, by which what plays of it may be longer: both are rounded.
constexpr float kRounding = 1e-4f;

Vec3f directionOf(const HeadKey& key) {
    return key.axis.normalized();
}

Quatf rotationOf(const HeadKey& key) {
    return Quatf(Eigen::AngleAxisf(radians(key.degrees), directionOf(key)));
}

/// The rigid pose of the head, nothing else.
HeadPose keyedPose(const std::vector<HeadKey>& keys, float time) {
    const auto [k, share] = betweenKeys(keys, time);
    const HeadKey& from = keys[k];
    Vec3d translation = from.translation;
    Quatf rotation = rotationOf(from);
    if (share > 0) {
        const HeadKey& to = keys[k + 1];
        translation += (to.translation - from.translation) * static_cast<double>(share);
        const Vec3f axis = directionOf(from);
        const float angle = radians(from.degrees);
        // About one axis a turn keeps all its degrees, above 180 too; else the shorter way.
        rotation = axis == directionOf(to)
                       ? Quatf(Eigen::AngleAxisf(angle + (radians(to.degrees) - angle) * share, axis))
                       : rotation.slerp(share, rotationOf(to));
    }
    HeadPose pose;
    pose.origin_ws = (translation / kOriginGrid).array().round() * kOriginGrid;
    pose.head_ws = Eigen::Translation3f((translation - pose.origin_ws).cast<float>()) * rotation;
    return pose;
}

/// A strip with what its clip is.
struct PlayedClip {
    ClipStrip strip;
    std::uint32_t clip = 0;
    float last = 0;  ///< seconds of the clip
    bool isWhole = false;

    Actor::At at(float time) const {
        const float played = std::max(time - strip.start, 0.0f) * strip.speed;
        if (isWhole) return {clip, played, strip.loop ? Wrap::Loop : Wrap::Clamp};
        const float length = last - strip.first;
        const float within = strip.loop && length > 0 ? std::fmod(played, length) : std::min(played, length);
        return {clip, strip.first + within, Wrap::Clamp};
    }
};

class TimeLineMotion : public HeadMotion {
  public:
    TimeLineMotion(TimeLine line, std::vector<PlayedClip> clips, std::optional<CharacterPoser> character,
                   std::vector<GroomPose> poses)
        : line_(std::move(line)),
          clips_(std::move(clips)),
          character_(std::move(character)),
          poses_(std::move(poses)) {}

    HeadPose poseAt(float seconds) const override {
        const float time = line_.timeAt(seconds);
        HeadPose pose;
        if (!line_.head.empty()) pose = keyedPose(line_.head, time);
        if (!clips_.empty()) {
            HeadPose posed = clipPose(time);
            if (!line_.head.empty()) moveBy(pose.head_ws, posed);
            posed.origin_ws = pose.origin_ws;
            pose = std::move(posed);
        }
        if (!line_.wind.empty()) {
            const auto [w, share] = betweenKeys(line_.wind, time);
            pose.wind_ws = line_.wind[w].velocity;
            if (share > 0) *pose.wind_ws += (line_.wind[w + 1].velocity - line_.wind[w].velocity) * share;
        }
        if (!poses_.empty()) pose.poseAmounts = poseAmountsAt(line_, time, poses_);
        return pose;
    }
    std::optional<runtime::SimulationSettings> settingsAt(
        float seconds, const runtime::SimulationSettings& authored) const override {
        if (!keysSimulation(line_)) return std::nullopt;
        return hairloom::settingsAt(line_, line_.timeAt(seconds), authored);
    }
    const SkinWeights* skin() const override { return character_ ? &character_->actor().skin() : nullptr; }

  private:
    HeadPose clipPose(float time) const {
        const auto next =
            std::ranges::find_if(clips_, [time](const PlayedClip& clip) { return clip.strip.start > time; });
        const std::size_t now =
            next == clips_.begin() ? 0 : static_cast<std::size_t>(next - clips_.begin()) - 1;
        const PlayedClip& played = clips_[now];
        const float since = time - played.strip.start;
        const Actor::At at = played.at(time);
        if (now == 0 || since >= played.strip.blend)
            return character_->pose(character_->actor().poseAt(at.clip, at.time, at.wrap));
        // As keys that are smooth: it leaves and arrives without a jolt.
        const float share = since / played.strip.blend;
        return character_->pose(
            character_->actor().poseBetween(clips_[now - 1].at(time), at, smoothStep(share)));
    }

    TimeLine line_;
    std::vector<PlayedClip> clips_;
    std::optional<CharacterPoser> character_;
    std::vector<GroomPose> poses_;  ///< of the groom, whose amounts hold where none is keyed
};

Result<PlayedClip> playedClip(const ClipStrip& strip, const Actor& actor, const std::string& place) {
    const auto index = actor.findClip(strip.name);
    if (!index) return fail(place + "/name: " + index.error().problem, index.error().expected);
    const float duration = actor.clips()[*index].duration;
    const float longest = duration * (1 + kRounding);
    const auto outside = [&](const char* member, float value) {
        return fail(fmt::format("{}/{} is {} s", place, member, value),
                    fmt::format("the clip '{}' lasts {} s", strip.name, duration));
    };
    if (strip.first > 0 && !(strip.first < duration)) return outside("first", strip.first);
    if (strip.last > longest) return outside("last", strip.last);
    const bool toEnd = strip.last == 0 || strip.last >= duration;
    return PlayedClip{strip, *index, toEnd ? duration : strip.last, strip.first == 0 && toEnd};
}

}  // namespace

std::uint32_t FramePace::steps() const {
    constexpr float kSlowest = 10;  // steps a second
    return static_cast<std::uint32_t>(std::max(1.0f, std::ceil(kSlowest / framesPerSecond)));
}

float FramePace::timeOf(float frame, std::uint32_t step) const {
    const auto perFrame = static_cast<float>(steps());
    return ((frame - 1) * perFrame + static_cast<float>(step)) / (framesPerSecond * perFrame);
}

FramePace paceOf(const TimeLine& line) {
    return {line.framesPerSecond, line.preRoll};
}

Result<std::unique_ptr<HeadMotion>> makeTimeLineMotion(TimeLine line, std::shared_ptr<const Actor> actor,
                                                       const Groom& groom) {
    if (const auto problems = problemsOf(line); !problems.empty())
        return fail(fmt::format("time_line/{} {}", problems[0].where, problems[0].what),
                    problems[0].expected);
    std::vector<PlayedClip> clips;
    std::optional<CharacterPoser> character;
    if (!line.clips.empty()) {
        if (!actor) return fail("the time line plays clips, and this head has none", "remove its clips");
        auto made = CharacterPoser::make(actor, groom);
        if (!made) return tl::unexpected(made.error());
        character.emplace(std::move(*made));
        for (std::size_t i = 0; i < line.clips.size(); ++i) {
            auto played = playedClip(line.clips[i], *actor, fmt::format("time_line/clips/{}", i));
            if (!played) return tl::unexpected(played.error());
            clips.push_back(std::move(*played));
        }
    }
    return std::make_unique<TimeLineMotion>(std::move(line), std::move(clips), std::move(character),
                                            groom.poses);
}

}  // namespace hairloom
