// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What happens when, as an artist authors it: clips of the character, keys of the head, of the wind and of
// settings, and the range that plays. Times are seconds on the time line.

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/math.h"
#include "core/base/smooth_step.h"
#include "core/groom/groom_pose.h"
#include "core/groom/material.h"
#include "hairloom/field.h"
#include "hairloom/settings.h"

namespace hairloom {

struct Groom;

/// How a value goes from a key to the next one.
enum class KeyInterpolation : std::uint8_t {
    linear,
    step,    ///< stays until the next key
    smooth,  ///< leaves and arrives at rest: 3t² − 2t³ of the way
};
inline constexpr const char* kKeyInterpolations[] = {"linear", "step", "smooth"};

inline constexpr float kShortestAxis = 1e-6f;

/// Rigid, about the origin of the head's own space: turned first, then moved.
struct HeadKey {
    float time = 0;
    Vec3d translation = Vec3d::Zero();  ///< metres
    Vec3f axis = Vec3f::UnitY();        ///< of any length of at least kShortestAxis
    float degrees = 0;
    KeyInterpolation interpolation = KeyInterpolation::linear;

    friend bool operator==(const HeadKey&, const HeadKey&) = default;
};
struct WindKey {
    float time = 0;
    Vec3f velocity = Vec3f::Zero();  ///< m/s, at most kFastestKeyedWind, in place of the settings' mean wind
    KeyInterpolation interpolation = KeyInterpolation::linear;

    friend bool operator==(const WindKey&, const WindKey&) = default;
};
struct SettingKey {
    float time = 0;
    Vec3d value = Vec3d::Zero();  ///< as many components as the field has
    KeyInterpolation interpolation = KeyInterpolation::linear;

    friend bool operator==(const SettingKey&, const SettingKey&) = default;
};
/// Keys of one described setting.
struct SettingTrack {
    std::string name;  ///< "simulation.windSpeed", "pose.NAME" or "material.rootColour", see findKeyable()
    std::vector<SettingKey> keys;  ///< at least one

    friend bool operator==(const SettingTrack&, const SettingTrack&) = default;
};
/// A clip of the character from `start` on, until the next one starts. fieldsOf() describes the numbers.
struct ClipStrip {
    std::string name;
    float start = 0;  ///< before that of the first, its first frame holds
    float first = 0;  ///< seconds of the clip that play, from here …
    float last = 0;   ///< … to here; 0: to the clip's end
    float speed = 1;
    bool loop = true;  ///< else its last frame holds
    float blend = 0;   ///< seconds from `start` over which it takes over from the clip before

    friend bool operator==(const ClipStrip&, const ClipStrip&) = default;
};

/// Keys ascend in time, strips in their starts. fieldsOf() describes the numbers.
struct TimeLine {
    float framesPerSecond = 60;
    float start = 0, end = 4;
    std::uint32_t preRoll = 0;
    bool loop = true;
    std::vector<ClipStrip> clips;
    std::vector<HeadKey> head;  ///< on top of the clips
    std::vector<WindKey> wind;
    std::vector<SettingTrack> settings;

    /// Nothing would move or change.
    bool isEmpty() const { return clips.empty() && head.empty() && wind.empty() && settings.empty(); }
    /// Frames from start to end, at least one.
    std::uint64_t frameCount() const;
    /// Where on the line `seconds` behind its start are: a loop begins anew at its end, and without one it
    /// goes on.
    float timeAt(float seconds) const;

    friend bool operator==(const TimeLine&, const TimeLine&) = default;
};
std::span<const runtime::Field<ClipStrip>> fieldsOf(const ClipStrip&);
std::span<const runtime::Field<TimeLine>> fieldsOf(const TimeLine&);

inline constexpr float kLatestKey = 1e6f;    ///< seconds
inline constexpr double kFarthestKey = 1e6;  ///< metres
inline constexpr float kMostKeyedDegrees = 1e6f;
inline constexpr float kFastestKeyedWind = 1000;  ///< m/s
inline constexpr std::size_t kMaxKeys = 200'000;  ///< of a time line, clips among them

/// The groom's, or one with nothing on it.
const TimeLine& timeLineOf(const Groom& groom);

/// The field of a name such as "simulation.gravity" or "material.rootColour", and of a pose, "pose.NAME",
/// that of its amount, whether a groom has it or not; null where there is none that can be keyed: curves and
/// seeds cannot, a strand model cannot change while hair moves, and a material neither its shading model nor
/// which strands are in streaks, white and dyed.
const runtime::FieldInfo* findKeyable(std::string_view name);
/// The names of all that can be keyed, in order of their description, those of the material last.
std::vector<std::string> keyableNames();
/// Likewise, and of the groom's poses behind those of the simulation.
std::vector<std::string> keyableNames(const Groom& groom);
/// What the groom has of a field that findKeyable() finds; components that the field lacks are 0.
Vec3d authoredValue(const Groom& groom, std::string_view name);

/// `authored` with what is keyed at that time. Before the first key and behind the last one their values
/// hold.
runtime::SimulationSettings settingsAt(const TimeLine& line, float time,
                                       const runtime::SimulationSettings& authored);
/// The hairstyle's material, likewise. Those of layers have no keys.
HairMaterial materialAt(const TimeLine& line, float time, const HairMaterial& authored);
/// The amounts of poses, likewise.
std::vector<float> poseAmountsAt(const TimeLine& line, float time, std::span<const GroomPose> authored);
/// Whether settingsAt() and materialAt() may give something else than what is authored.
bool keysSimulation(const TimeLine& line);
bool keysMaterial(const TimeLine& line);
/// Whether they lead to the same motion: all is alike but keys of the material.
bool movesAlike(const TimeLine& one, const TimeLine& other);
/// Of a track at that time; it has keys.
Vec3d valueAt(const SettingTrack& track, float time);

/// The key that holds at `time`, and how far it is to the next one, with its interpolation applied: 0 … 1,
/// below 1. `keys` has at least one.
struct BetweenKeys {
    std::size_t from;
    float share;
};
template <class Key>
BetweenKeys betweenKeys(const std::vector<Key>& keys, float time) {
    const auto next = std::upper_bound(keys.begin(), keys.end(), time,
                                       [](float t, const Key& key) { return t < key.time; });
    if (next == keys.begin()) return {0, 0.0f};
    const auto from = static_cast<std::size_t>(next - keys.begin()) - 1;
    if (next == keys.end() || keys[from].interpolation == KeyInterpolation::step) return {from, 0.0f};
    const float share = (time - keys[from].time) / (next->time - keys[from].time);
    if (keys[from].interpolation == KeyInterpolation::linear) return {from, share};
    return {from, smoothStep(share)};
}

/// What does not hold.
struct TimeLineProblem {
    std::string where;  ///< "settings/0/keys/3/t", as in its JSON
    std::string what;   ///< "is 2 s, not later than the key before it"
    std::string expected;
};
/// Numbers out of range or not finite, an end before the start, times that do not ascend, strips that blend
/// longer than they play, names of no setting, values that their field does not hold. Empty: all is well.
std::vector<TimeLineProblem> problemsOf(const TimeLine& line);

}  // namespace hairloom
