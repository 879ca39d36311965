// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/stroke.h"

#include <algorithm>

#include "core/editing/brush_list.h"
#include "core/editing/stroke_session.h"

namespace hairloom::editing {
namespace {

using Json = nlohmann::ordered_json;

Json curveToJson(const BrushCurve& curve) {
    Json values = Json::array();
    for (const float value : curve.values()) values.push_back(readableDecimal(value));
    return values;
}

BrushCurve readCurve(JsonReader& reader, std::string_view name) {
    std::vector<float> values;
    for (const double value : reader.numbers(name, 0, 1, BrushCurve::kMaxValues))
        values.push_back(static_cast<float>(value));
    return BrushCurve(std::move(values));
}

Json dabToJson(const Dab& dab, const BrushSettings& settings) {
    Json json{{"at", valueToJson(dab.position_ss)}};
    if (!dab.direction_ss.isZero(0)) json["view"] = valueToJson(dab.direction_ss);
    if (dab.radius != settings.radius) json["radius"] = valueToJson(dab.radius);
    if (dab.strength != settings.strength) json["strength"] = valueToJson(dab.strength);
    if (dab.pressure != 1) json["pressure"] = valueToJson(dab.pressure);
    return json;
}

Dab readDab(JsonReader& reader, const BrushSettings& settings) {
    Dab dab = dabAt(settings, reader.vector("at", -kAnywhere, kAnywhere, "m"));
    if (reader.has("view")) dab.direction_ss = reader.vector("view", -1, 1);
    const auto number = [&](std::string_view name, double min, double max, float& value) {
        if (reader.has(name)) value = static_cast<float>(reader.number(name, min, max));
    };
    number("radius", 0.0001, 1, dab.radius);
    number("strength", 0, 1, dab.strength);
    number("pressure", 0, 1, dab.pressure);
    reader.finish();
    if (const auto status = checkDab(dab); !status && reader.ok())
        reader.complain({}, status.error().problem, status.error().expected);
    return dab;
}

void readParameters(JsonReader reader, BrushSettings& settings) {
    constexpr double kAnyNumber = 1e9;  // checkStroke() knows the brush's own ranges
    for (const std::string& name : reader.keys())
        settings.parameters[name] = static_cast<float>(reader.number(name, -kAnyNumber, kAnyNumber));
}

}  // namespace

Dab mirrored(const Dab& dab, const BrushSettings& settings) {
    const Vec3f normal = settings.mirrorNormal.normalized();
    Dab other = dab;
    other.position_ss -= 2 * (dab.position_ss - settings.mirrorPoint).dot(normal) * normal;
    other.direction_ss -= 2 * dab.direction_ss.dot(normal) * normal;
    return other;
}

Json toJson(const Stroke& stroke) {
    Json json{{"op", "stroke"}, {"tool", stroke.tool}};
    json.update(fieldsToJson(stroke.settings));
    json["falloff"] = curveToJson(stroke.settings.falloff);
    json["profile"] = curveToJson(stroke.settings.profile);
    json["parameters"] = Json::object();
    for (const auto& [name, value] : stroke.settings.parameters)
        json["parameters"][name] = readableDecimal(value);
    json["dabs"] = Json::array();
    for (const Dab& dab : stroke.dabs) json["dabs"].push_back(dabToJson(dab, stroke.settings));
    return json;
}

Stroke readStroke(JsonReader& reader) {
    Stroke stroke;
    stroke.tool = reader.string("tool");
    reader.fields(stroke.settings);
    if (reader.has("falloff")) stroke.settings.falloff = readCurve(reader, "falloff");
    if (reader.has("profile")) stroke.settings.profile = readCurve(reader, "profile");
    if (reader.has("parameters")) readParameters(reader.object("parameters"), stroke.settings);
    for (JsonReader& dab : reader.objects("dabs")) stroke.dabs.push_back(readDab(dab, stroke.settings));
    if (const auto status = checkStroke(stroke); !status && reader.ok())
        reader.complain({}, status.error().problem, status.error().expected);
    return stroke;
}

}  // namespace hairloom::editing
