// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/file/settings_json.h"

#include <fmt/format.h>

#include <limits>

namespace hairloom {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kAnyFloat = static_cast<double>(std::numeric_limits<float>::max());

template <class S>
void readFields(JsonReader reader, S& settings) {
    reader.fields(settings);
    reader.finish();
}

/// [[place, value], …]
Json rampToJson(const runtime::Ramp& ramp) {
    Json keys = Json::array();
    for (const auto& [at, value] : ramp.inUse())
        keys.push_back({readableDecimal(at), readableDecimal(value)});
    return keys;
}

void readRamp(JsonReader& reader, const runtime::FieldInfo& field, runtime::Ramp& ramp) {
    std::vector<runtime::Ramp::Key> keys;
    for (const auto& [at, value] : reader.pairs(field.name, 0, 1, runtime::Ramp::kMostKeys))
        keys.push_back({static_cast<float>(at), static_cast<float>(value)});
    if (!reader.ok()) return;
    const auto read = runtime::Ramp::of(keys);
    const std::string problem = runtime::problemOf(read);
    if (!problem.empty()) return reader.complain(field.name, problem);
    ramp = read;
}

/// What the curve of stiffness was before it had keys: the value at the tip, that at the root being 1.
constexpr const char* kTipShare = "angularTipShare";

void readTipShare(JsonReader& reader, runtime::SimulationSettings& settings) {
    if (!reader.has(kTipShare)) return;
    const auto tip = static_cast<float>(reader.number(kTipShare, 0, 1));
    if (reader.has("angularCurve"))
        return reader.complain(kTipShare, "stands beside angularCurve", "expected one of the two");
    settings.angularCurve = runtime::Ramp::straight(1, tip);
}

}  // namespace

Json toJson(const HairMaterial& material) {
    return fieldsToJson(material);
}
Json toJson(const InterpolationSettings& settings) {
    return fieldsToJson(settings);
}
Json toJson(const PlacementSettings& settings) {
    return fieldsToJson(settings);
}

Json toJson(const runtime::SimulationSettings& settings) {
    Json json = Json::object();
    for (const runtime::FieldInfo& field : runtime::fields()) {
        const auto value = [&](std::uint32_t component) {
            return readableDecimal(static_cast<float>(runtime::fieldValue(settings, field, component)));
        };
        if (const auto* ramp = std::get_if<runtime::Ramp runtime::SimulationSettings::*>(&field.member)) {
            json[field.name] = rampToJson(settings.**ramp);
        } else if (!field.choices.empty()) {
            json[field.name] = field.choices[static_cast<std::size_t>(runtime::fieldValue(settings, field))];
        } else if (runtime::componentCount(field) == 3) {
            json[field.name] = {value(0), value(1), value(2)};
        } else if (std::holds_alternative<std::uint32_t runtime::SimulationSettings::*>(field.member)) {
            json[field.name] = static_cast<std::uint32_t>(runtime::fieldValue(settings, field));
        } else {
            json[field.name] = value(0);
        }
    }
    return json;
}

Json toJson(const std::vector<CollisionSphere>& spheres) {
    Json list = Json::array();
    for (const CollisionSphere& sphere : spheres) {
        list.push_back({{"name", sphere.name},
                        {"centre", valueToJson(sphere.centre)},
                        {"radius", readableDecimal(sphere.radius)},
                        {"bone", sphere.bone}});
    }
    return list;
}

void readSettings(JsonReader reader, HairMaterial& material) {
    readFields(std::move(reader), material);
}
void readSettings(JsonReader reader, InterpolationSettings& settings) {
    readFields(std::move(reader), settings);
}
void readSettings(JsonReader reader, PlacementSettings& settings) {
    readFields(std::move(reader), settings);
}

void readSettings(JsonReader reader, runtime::SimulationSettings& settings) {
    readTipShare(reader, settings);
    for (const runtime::FieldInfo& field : runtime::fields()) {
        if (!reader.has(field.name)) continue;
        const auto set = [&](double value, std::uint32_t component = 0) {
            if (!reader.ok() || runtime::setFieldValue(settings, field, value, component)) return;
            reader.complain(field.name, fmt::format("is {}", value),
                            "expected " + rangeText(field.min, field.max, field.unit));
        };
        if (const auto* ramp = std::get_if<runtime::Ramp runtime::SimulationSettings::*>(&field.member)) {
            readRamp(reader, field, settings.**ramp);
        } else if (!field.choices.empty()) {
            const std::vector<std::string_view> choices(field.choices.begin(), field.choices.end());
            set(static_cast<double>(reader.choice(field.name, choices)));
        } else if (runtime::componentCount(field) == 3) {
            const Vec3f v = reader.vector(field.name, field.min, field.max, field.unit);
            for (std::uint32_t c = 0; c < 3; ++c) set(static_cast<double>(v[c]), c);
        } else {
            set(reader.number(field.name, field.min, field.max, field.unit));
        }
    }
    reader.finish();
}

CollisionSphere readSphere(JsonReader& reader) {
    CollisionSphere sphere;
    sphere.name = reader.string("name");
    sphere.centre = reader.vector("centre", -kAnyFloat, kAnyFloat, "m");
    sphere.radius = static_cast<float>(reader.number("radius", 0, kAnyFloat, "m"));
    sphere.bone = reader.string("bone");
    if (reader.ok() && !(sphere.radius > 0)) reader.complain("radius", "is 0", "expected more than 0 m");
    reader.finish();
    return sphere;
}

}  // namespace hairloom
