// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/time_line_keys.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace hairloom {
namespace {

using Of = KeyTrack::Of;
using runtime::FieldInfo;

float frameOf(const TimeLine& line) {
    return 1 / line.framesPerSecond;
}

float timeOf(const ClipStrip& strip) {
    return strip.start;
}
template <class Key>
float timeOf(const Key& key) {
    return key.time;
}
void setTime(ClipStrip& strip, float time) {
    strip.start = time;
}
template <class Key>
void setTime(Key& key, float time) {
    key.time = time;
}

SettingTrack* settingTrack(TimeLine& line, const std::string& name) {
    const auto found = std::ranges::find(line.settings, name, &SettingTrack::name);
    return found == line.settings.end() ? nullptr : &*found;
}

/// `edit` of the track's keys, where there is such a track.
template <class Line, class Edit>
void withKeys(Line& line, const KeyTrack& track, Edit edit) {
    switch (track.of) {
        case Of::clips:
            return edit(line.clips);
        case Of::head:
            return edit(line.head);
        case Of::wind:
            return edit(line.wind);
        case Of::setting:
            for (auto& setting : line.settings) {
                if (setting.name == track.name) return edit(setting.keys);
            }
    }
}

template <class Key>
std::optional<std::size_t> nearest(const std::vector<Key>& keys, float time, float frame) {
    std::optional<std::size_t> found;
    float least = frame / 2;
    for (std::size_t k = 0; k < keys.size(); ++k) {
        const float distance = std::abs(timeOf(keys[k]) - time);
        if (distance > least) continue;
        least = distance;
        found = k;
    }
    return found;
}

/// What problemsOf() asks of clips that follow each other.
void tidy(std::vector<ClipStrip>& clips, float frame) {
    std::ranges::stable_sort(clips, {}, &ClipStrip::start);
    for (std::size_t i = 1; i < clips.size(); ++i)
        clips[i].start = std::max(clips[i].start, clips[i - 1].start + frame);
    if (!clips.empty()) clips[0].blend = 0;
    for (std::size_t i = 1; i + 1 < clips.size(); ++i)
        clips[i].blend = std::min(clips[i].blend, clips[i + 1].start - clips[i].start);
}
template <class Key>
void tidy(std::vector<Key>& keys, float) {
    std::ranges::stable_sort(keys, {}, &Key::time);
}

template <class Key>
void insert(std::vector<Key>& keys, Key key, float frame) {
    if (const auto there = nearest(keys, key.time, frame)) {
        key.interpolation = keys[*there].interpolation;
        keys[*there] = std::move(key);
        return tidy(keys, frame);
    }
    const auto behind =
        std::ranges::upper_bound(keys, key.time, {}, [](const Key& other) { return other.time; });
    if (behind != keys.begin()) key.interpolation = std::prev(behind)->interpolation;
    keys.insert(behind, std::move(key));
}

std::set<KeyTrack> tracksIn(std::span<const KeyPlace> keys) {
    std::set<KeyTrack> tracks;
    for (const KeyPlace& key : keys) tracks.insert(key.track);
    return tracks;
}

std::set<std::size_t> indicesOf(std::span<const KeyPlace> keys, const KeyTrack& track) {
    std::set<std::size_t> indices;
    for (const KeyPlace& key : keys) {
        if (key.track == track) indices.insert(key.index);
    }
    return indices;
}

template <class Key>
void erase(std::vector<Key>& keys, const std::set<std::size_t>& indices) {
    for (auto index = indices.rbegin(); index != indices.rend(); ++index)
        keys.erase(keys.begin() + static_cast<std::ptrdiff_t>(*index));
}

/// Frames stay whole, whatever repeated moves lose in rounding.
double wholeFrame(double frame) {
    constexpr double kRounding = 1e-3;
    const double whole = std::round(frame);
    return std::abs(frame - whole) < kRounding ? whole : frame;
}

/// Puts `placed` among the others, which make room.
template <class Key>
std::vector<std::size_t> place(std::vector<Key>& keys, std::vector<Key> placed, float frame) {
    constexpr bool isClips = std::is_same_v<Key, ClipStrip>;
    if constexpr (!isClips)
        std::erase_if(keys, [&](const Key& key) { return nearest(placed, key.time, frame).has_value(); });
    // Ahead of those that start at the same time, which are the ones to make room.
    keys.insert(keys.begin(), placed.begin(), placed.end());
    tidy(keys, frame);
    std::vector<std::size_t> at;
    for (std::size_t k = 0; k < keys.size(); ++k) {
        const auto same = std::ranges::find_if(
            placed, [&](const Key& key) { return std::abs(timeOf(key) - timeOf(keys[k])) < frame / 4; });
        if (same != placed.end()) at.push_back(k);
    }
    return at;
}

/// Puts keys at the times that `timeOfCopy` gives for theirs, as copies or in place of themselves. Returns
/// where they are then.
template <class Time>
std::vector<KeyPlace> put(TimeLine& line, std::span<const KeyPlace> keys, bool asCopies,
                          const Time& timeOfCopy) {
    std::vector<KeyPlace> at;
    for (const KeyTrack& track : tracksIn(keys)) {
        const std::set<std::size_t> which = indicesOf(keys, track);
        withKeys(line, track, [&]<class Key>(std::vector<Key>& all) {
            std::vector<Key> taken;
            for (const std::size_t index : which) {
                taken.push_back(all[index]);
                setTime(taken.back(), timeOfCopy(timeOf(all[index])));
            }
            if (!asCopies) erase(all, which);
            for (const std::size_t index : place(all, std::move(taken), frameOf(line)))
                at.push_back({track, index});
        });
    }
    return at;
}

}  // namespace

std::vector<KeyTrack> tracksOf(const TimeLine& line) {
    std::vector<KeyTrack> tracks;
    if (!line.clips.empty()) tracks.push_back({Of::clips, {}});
    if (!line.head.empty()) tracks.push_back({Of::head, {}});
    if (!line.wind.empty()) tracks.push_back({Of::wind, {}});
    for (const SettingTrack& setting : line.settings) tracks.push_back({Of::setting, setting.name});
    return tracks;
}

std::vector<float> keyTimes(const TimeLine& line, const KeyTrack& track) {
    std::vector<float> times;
    withKeys(line, track, [&](const auto& keys) {
        for (const auto& key : keys) times.push_back(timeOf(key));
    });
    return times;
}

bool hasKey(const TimeLine& line, const KeyPlace& key) {
    bool has = false;
    withKeys(line, key.track, [&](const auto& keys) { has = key.index < keys.size(); });
    return has;
}

float keyTime(const TimeLine& line, const KeyPlace& key) {
    float time = 0;
    withKeys(line, key.track, [&](const auto& keys) { time = timeOf(keys[key.index]); });
    return time;
}

std::optional<std::size_t> findKey(const TimeLine& line, const KeyTrack& track, float time) {
    std::optional<std::size_t> found;
    withKeys(line, track, [&](const auto& keys) { found = nearest(keys, time, frameOf(line)); });
    return found;
}

KeyInterpolation interpolationOf(const TimeLine& line, const KeyPlace& key) {
    auto found = KeyInterpolation::linear;
    withKeys(line, key.track, [&]<class Key>(const std::vector<Key>& keys) {
        if constexpr (!std::is_same_v<Key, ClipStrip>) found = keys[key.index].interpolation;
    });
    return found;
}

void keyHead(TimeLine& line, HeadKey key) {
    insert(line.head, std::move(key), frameOf(line));
}

void keyWind(TimeLine& line, float time, const Vec3f& velocity) {
    insert(line.wind, {time, velocity}, frameOf(line));
}

void keySetting(TimeLine& line, const std::string& name, float time, const Vec3d& value) {
    SettingTrack* track = settingTrack(line, name);
    if (track == nullptr) track = &line.settings.emplace_back(SettingTrack{name, {}});
    SettingKey key{time, value};
    const FieldInfo* const field = findKeyable(name);
    if (field != nullptr && field->isWhole()) key.interpolation = KeyInterpolation::step;
    insert(track->keys, key, frameOf(line));
}

void addClip(TimeLine& line, ClipStrip strip) {
    line.clips.insert(line.clips.begin(), std::move(strip));
    tidy(line.clips, frameOf(line));
}

void removeKeys(TimeLine& line, std::span<const KeyPlace> keys) {
    for (const KeyTrack& track : tracksIn(keys)) {
        const std::set<std::size_t> gone = indicesOf(keys, track);
        withKeys(line, track, [&](auto& all) {
            erase(all, gone);
            tidy(all, frameOf(line));
        });
    }
    std::erase_if(line.settings, [](const SettingTrack& track) { return track.keys.empty(); });
}

std::vector<KeyPlace> moveKeys(TimeLine& line, std::span<const KeyPlace> keys, std::int64_t frames) {
    const double rate = static_cast<double>(line.framesPerSecond);
    std::int64_t by = frames;
    for (const KeyPlace& key : keys) {
        const float time = keyTime(line, key);
        by = std::max<std::int64_t>(by, -std::llround(static_cast<double>(time) * rate));
    }
    return put(line, keys, false, [&](float time) {
        const double at = static_cast<double>(time) * rate + static_cast<double>(by);
        return static_cast<float>(std::max(0.0, wholeFrame(at) / rate));
    });
}

std::vector<KeyPlace> copyKeys(TimeLine& line, std::span<const KeyPlace> keys, float time) {
    if (keys.empty()) return {};
    float first = kLatestKey;
    for (const KeyPlace& key : keys) first = std::min(first, keyTime(line, key));
    return put(line, keys, true, [&](float was) { return was - first + time; });
}

void setInterpolation(TimeLine& line, std::span<const KeyPlace> keys, KeyInterpolation interpolation) {
    for (const KeyPlace& key : keys) {
        const FieldInfo* const field = key.track.of == Of::setting ? findKeyable(key.track.name) : nullptr;
        if (field != nullptr && field->isWhole()) continue;
        withKeys(line, key.track, [&]<class Key>(std::vector<Key>& all) {
            if constexpr (!std::is_same_v<Key, ClipStrip>) all[key.index].interpolation = interpolation;
        });
    }
}

std::vector<KeyNumber> numbersOf(const KeyTrack& track) {
    static constexpr const char* kAxes[] = {"X", "Y", "Z"};
    static constexpr const char* kChannels[] = {"Red", "Green", "Blue"};
    std::vector<KeyNumber> numbers;
    if (track.of == Of::head) {
        for (const char* axis : {"Move X", "Move Y", "Move Z"})
            numbers.push_back({axis, "m", -kFarthestKey, kFarthestKey, false, {}, true});
        for (const char* axis : {"Axis X", "Axis Y", "Axis Z"})
            numbers.push_back({axis, "", -1, 1, false, {}, false});
        constexpr auto kMost = static_cast<double>(kMostKeyedDegrees);
        numbers.push_back({"Rotation", "°", -kMost, kMost, false, {}, true});
    }
    if (track.of == Of::wind) {
        constexpr auto kMost = static_cast<double>(kFastestKeyedWind);
        for (const char* axis : kAxes) numbers.push_back({axis, "m/s", -kMost, kMost, false, {}, true});
    }
    const FieldInfo* const field = track.of == Of::setting ? findKeyable(track.name) : nullptr;
    if (field == nullptr) return numbers;
    for (std::uint32_t c = 0; c < field->components(); ++c)
        numbers.push_back({field->kind == runtime::FieldKind::Colour ? kChannels[c]
                           : field->components() > 1                 ? kAxes[c]
                                                                     : "Value",
                           field->unit, field->min, field->max, field->isWhole(), field->choices, true});
    return numbers;
}

double numberOf(const TimeLine& line, const KeyPlace& key, std::size_t number) {
    const auto c = static_cast<Eigen::Index>(number);
    if (key.track.of == Of::head) {
        const HeadKey& head = line.head[key.index];
        if (c < 3) return head.translation[c];
        return c < 6 ? static_cast<double>(head.axis[c - 3]) : static_cast<double>(head.degrees);
    }
    if (key.track.of == Of::wind) return static_cast<double>(line.wind[key.index].velocity[c]);
    double value = 0;
    for (const SettingTrack& track : line.settings) {
        if (key.track.of == Of::setting && track.name == key.track.name)
            value = track.keys[key.index].value[c];
    }
    return value;
}

void setNumber(TimeLine& line, const KeyPlace& key, std::size_t number, double value) {
    const auto c = static_cast<Eigen::Index>(number);
    if (key.track.of == Of::head) {
        HeadKey& head = line.head[key.index];
        if (c < 3)
            head.translation[c] = value;
        else if (c < 6)
            head.axis[c - 3] = static_cast<float>(value);
        else
            head.degrees = static_cast<float>(value);
    }
    if (key.track.of == Of::wind) line.wind[key.index].velocity[c] = static_cast<float>(value);
    if (key.track.of != Of::setting) return;
    if (SettingTrack* const track = settingTrack(line, key.track.name))
        track->keys[key.index].value[c] = value;
}

}  // namespace hairloom
