// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/file/time_line_json.h"

#include <array>

namespace hairloom {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::string_view, 3> kInterpolations{kKeyInterpolations[0], kKeyInterpolations[1],
                                                          kKeyInterpolations[2]};
constexpr double kLatest = static_cast<double>(kLatestKey), kFastest = static_cast<double>(kFastestKeyedWind);
constexpr const char* kInterpolate = "interpolate";

std::string_view nameOf(KeyInterpolation interpolation) {
    return kInterpolations[static_cast<std::size_t>(interpolation)];
}

Json exact(const Vec3d& v) {
    return {v.x(), v.y(), v.z()};
}

Json toJson(const HeadKey& key) {
    return {{"t", readableDecimal(key.time)},
            {"translate", exact(key.translation)},
            {"axis", valueToJson(key.axis)},
            {"degrees", readableDecimal(key.degrees)},
            {kInterpolate, nameOf(key.interpolation)}};
}
Json toJson(const WindKey& key) {
    return {{"t", readableDecimal(key.time)},
            {"velocity", valueToJson(key.velocity)},
            {kInterpolate, nameOf(key.interpolation)}};
}
Json toJson(const SettingTrack& track) {
    Json keys = Json::array();
    const auto* const field = findKeyable(track.name);
    for (const SettingKey& key : track.keys) {
        keys.push_back({{"t", readableDecimal(key.time)},
                        {"value", field ? valueToJson(*field, key.value) : exact(key.value)},
                        {kInterpolate, nameOf(key.interpolation)}});
    }
    return {{"name", track.name}, {"keys", std::move(keys)}};
}
Json toJson(const ClipStrip& strip) {
    Json json{{"name", strip.name}};
    json.update(fieldsToJson(strip));
    return json;
}
template <class T>
Json listOf(const std::vector<T>& values) {
    Json list = Json::array();
    for (const T& value : values) list.push_back(toJson(value));
    return list;
}

KeyInterpolation readInterpolation(JsonReader& reader, KeyInterpolation absent) {
    if (!reader.has(kInterpolate)) return absent;
    return static_cast<KeyInterpolation>(reader.choice(kInterpolate, kInterpolations));
}

float readTime(JsonReader& reader) {
    return static_cast<float>(reader.number("t", 0, kLatest, "s"));
}

HeadKey readHeadKey(JsonReader& reader, KeyInterpolation interpolation) {
    HeadKey key;
    key.time = readTime(reader);
    if (reader.has("translate"))
        key.translation = reader.exactVector("translate", -kFarthestKey, kFarthestKey, "m");
    if (reader.has("degrees"))
        key.degrees = static_cast<float>(reader.number("degrees", -static_cast<double>(kMostKeyedDegrees),
                                                       static_cast<double>(kMostKeyedDegrees), "degrees"));
    if (reader.has("axis")) key.axis = reader.vector("axis", -kFarthestKey, kFarthestKey);
    key.interpolation = readInterpolation(reader, interpolation);
    reader.finish();
    return key;
}

WindKey readWindKey(JsonReader& reader, KeyInterpolation interpolation) {
    WindKey key;
    key.time = readTime(reader);
    key.velocity = reader.vector("velocity", -kFastest, kFastest, "m/s");
    key.interpolation = readInterpolation(reader, interpolation);
    reader.finish();
    return key;
}

/// Of a field whose kind says how its value is written.
Vec3d readValue(JsonReader& reader, const FieldInfo& field) {
    Vec3d value = Vec3d::Zero();
    if (field.components() == 3)
        return reader.vector("value", field.min, field.max, field.unit).cast<double>();
    if (field.kind == FieldKind::Bool) {
        value[0] = reader.boolean("value") ? 1 : 0;
    } else if (field.kind == FieldKind::Choice) {
        const std::vector<std::string_view> choices(field.choices.begin(), field.choices.end());
        value[0] = static_cast<double>(reader.choice("value", choices));
    } else if (field.isWhole()) {
        value[0] = static_cast<double>(reader.count("value", static_cast<std::uint64_t>(field.min),
                                                    static_cast<std::uint64_t>(field.max)));
    } else {
        // As settings have it, so that what is between keys has the same bits before saving and after.
        value[0] =
            static_cast<double>(static_cast<float>(reader.number("value", field.min, field.max, field.unit)));
    }
    return value;
}

SettingTrack readTrack(JsonReader& reader) {
    SettingTrack track;
    track.name = reader.string("name");
    const auto* const field = findKeyable(track.name);
    for (JsonReader& entry : reader.objects("keys")) {
        if (!field) break;  // problemsOf() says so
        SettingKey key;
        key.time = readTime(entry);
        key.value = readValue(entry, *field);
        key.interpolation =
            readInterpolation(entry, field->isWhole() ? KeyInterpolation::step : KeyInterpolation::linear);
        entry.finish();
        track.keys.push_back(key);
    }
    reader.finish();
    return track;
}

ClipStrip readClip(JsonReader& reader) {
    ClipStrip strip;
    strip.name = reader.string("name");
    reader.fields(strip);
    reader.finish();
    return strip;
}

void complainOf(const TimeLine& line, JsonReader& reader) {
    if (!reader.ok()) return;
    const auto problems = problemsOf(line);
    if (!problems.empty()) reader.complainBelow(problems[0].where, problems[0].what, problems[0].expected);
}

template <class T>
Result<T> resultOf(JsonReader& reader, T value) {
    reader.finish();
    if (auto status = reader.status(); !status) return tl::unexpected(status.error());
    return value;
}

}  // namespace

Json toJson(const TimeLine& line) {
    Json json = fieldsToJson(line);
    json["clips"] = listOf(line.clips);
    json["head"] = listOf(line.head);
    json["wind"] = listOf(line.wind);
    json["settings"] = listOf(line.settings);
    return json;
}

TimeLine readTimeLine(JsonReader& parent) {
    JsonReader reader = parent.object("time_line");
    TimeLine line;
    reader.fields(line);
    if (reader.has("clips"))
        for (JsonReader& entry : reader.objects("clips")) line.clips.push_back(readClip(entry));
    if (reader.has("head"))
        for (JsonReader& entry : reader.objects("head"))
            line.head.push_back(readHeadKey(entry, KeyInterpolation::linear));
    if (reader.has("wind"))
        for (JsonReader& entry : reader.objects("wind"))
            line.wind.push_back(readWindKey(entry, KeyInterpolation::linear));
    if (reader.has("settings"))
        for (JsonReader& entry : reader.objects("settings")) line.settings.push_back(readTrack(entry));
    reader.finish();
    complainOf(line, reader);
    return line;
}

std::string timeLineText(const TimeLine& line) {
    return Json{{"time_line", toJson(line)}}.dump(2) + "\n";
}

Result<TimeLine> parseTimeLine(const std::string& file, std::string_view text) {
    const auto json = parseJson(file, text);
    if (!json) return tl::unexpected(json.error());
    JsonReader reader(*json, file);
    TimeLine line = readTimeLine(reader);
    for (const char* const other : {"frames", "clips", "keyable", "kept", "kept_motion", "output"})
        reader.has(other);
    return resultOf(reader, std::move(line));
}

std::string motionText(const TimeLine& line) {
    Json json;
    json["keys"] = listOf(line.head);
    if (line.head.empty()) json["keys"].push_back(toJson(HeadKey()));
    if (!line.wind.empty()) json["wind"] = listOf(line.wind);
    return json.dump(2) + "\n";
}

Result<TimeLine> parseMotion(const std::string& file, std::string_view text) {
    const auto json = parseJson(file, text);
    if (!json) return tl::unexpected(json.error());
    JsonReader reader(*json, file);
    const KeyInterpolation all = readInterpolation(reader, KeyInterpolation::linear);
    TimeLine line;
    for (JsonReader& entry : reader.objects("keys")) line.head.push_back(readHeadKey(entry, all));
    if (line.head.empty() && reader.ok()) reader.complain("keys", "is empty", "at least one key");
    if (reader.has("wind"))
        for (JsonReader& entry : reader.objects("wind")) line.wind.push_back(readWindKey(entry, all));
    if (reader.ok()) {
        for (TimeLineProblem problem : problemsOf(line)) {
            if (problem.where.starts_with("head/")) problem.where = "keys" + problem.where.substr(4);
            reader.complainBelow(problem.where, problem.what, problem.expected);
        }
    }
    return resultOf(reader, std::move(line));
}

}  // namespace hairloom
