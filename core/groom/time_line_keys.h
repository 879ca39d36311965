// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Editing the keys of a time line, whatever they are of. Two keys of a track within half a frame are one.

#include <compare>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/groom/time_line.h"

namespace hairloom {

/// A row of the time line.
struct KeyTrack {
    enum class Of : std::uint8_t { clips, head, wind, setting };
    Of of = Of::clips;
    std::string name;  ///< of a setting, "simulation.gravity"; else empty

    friend auto operator<=>(const KeyTrack&, const KeyTrack&) = default;
};
/// A key, or a clip, by its place in its track.
struct KeyPlace {
    KeyTrack track;
    std::size_t index = 0;

    friend auto operator<=>(const KeyPlace&, const KeyPlace&) = default;
};

/// Those that have keys: clips, head, wind, then settings in their order.
std::vector<KeyTrack> tracksOf(const TimeLine& line);
/// Seconds: times of the keys, or starts of the clips. Empty where there is no such track.
std::vector<float> keyTimes(const TimeLine& line, const KeyTrack& track);
bool hasKey(const TimeLine& line, const KeyPlace& key);
/// Of a key that is there.
float keyTime(const TimeLine& line, const KeyPlace& key);
/// The key within half a frame of `time`.
std::optional<std::size_t> findKey(const TimeLine& line, const KeyTrack& track, float time);
/// Of a key that is there; linear for clips.
KeyInterpolation interpolationOf(const TimeLine& line, const KeyPlace& key);

// One more key, or another value of the one that is there. It leaves as the key before it does, the first one
// linear; a setting that has nothing between its values leaves by steps.

void keyHead(TimeLine& line, HeadKey key);
void keyWind(TimeLine& line, float time, const Vec3f& velocity);
/// `name` is one that findKeyable() finds.
void keySetting(TimeLine& line, const std::string& name, float time, const Vec3d& value);
/// A clip from `start` on, before that of the next one. `frame` seconds apart from one that starts there.
void addClip(TimeLine& line, ClipStrip strip);

// Of keys that are there. Those that come to lie on others take their place, and clips stay apart by a frame.

void removeKeys(TimeLine& line, std::span<const KeyPlace> keys);
/// By a whole number of frames; none goes before time 0. Returns where they are now.
std::vector<KeyPlace> moveKeys(TimeLine& line, std::span<const KeyPlace> keys, std::int64_t frames);
/// The first of them to `time`, others as far behind it as they are. Returns the copies.
std::vector<KeyPlace> copyKeys(TimeLine& line, std::span<const KeyPlace> keys, float time);
/// Settings that have nothing between their values, and clips, stay as they are.
void setInterpolation(TimeLine& line, std::span<const KeyPlace> keys, KeyInterpolation interpolation);

/// A number of a key, as a person edits it.
struct KeyNumber {
    const char* label;
    const char* unit;
    double min, max;
    bool isWhole;
    std::span<const char* const> choices;  ///< names of its values 0, 1, …; empty: a number
    bool isDrawn;                          ///< has a curve
};
/// Of each key of a track; none for clips.
std::vector<KeyNumber> numbersOf(const KeyTrack& track);
double numberOf(const TimeLine& line, const KeyPlace& key, std::size_t number);
void setNumber(TimeLine& line, const KeyPlace& key, std::size_t number, double value);

}  // namespace hairloom
