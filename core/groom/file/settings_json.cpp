// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/file/settings_json.h"

#include <fmt/format.h>

#include <limits>

#include "hairloom/strands.h"

namespace hairloom {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kAnyFloat = static_cast<double>(std::numeric_limits<float>::max());

template <class S>
void readFields(JsonReader reader, S& settings) {
    reader.fields(settings);
    reader.finish();
}

/// What the curve of stiffness was before it had keys: the value at the tip, that at the root being 1.
constexpr const char* kTipShare = "angularTipShare";

void readTipShare(JsonReader& reader, runtime::SimulationSettings& settings) {
    if (!reader.has(kTipShare)) return;
    const auto tip = static_cast<float>(reader.number(kTipShare, 0, 1));
    if (reader.has("angularCurve"))
        return reader.complain(kTipShare, "cannot be used together with angularCurve",
                               "expected one of the two");
    settings.angularCurve = runtime::Ramp::straight(1, tip);
}

}  // namespace

Json toJson(const HairMaterial& material) {
    return fieldsToJson(material);
}
Json toJson(const ShadowSettings& settings) {
    return fieldsToJson(settings);
}
Json toJson(const InterpolationSettings& settings) {
    return fieldsToJson(settings);
}
Json toJson(const PlacementSettings& settings) {
    return fieldsToJson(settings);
}

Json toJson(const runtime::SimulationSettings& settings) {
    return fieldsToJson(settings);
}

Json toJson(const std::vector<CollisionSphere>& spheres) {
    Json list = Json::array();
    for (const CollisionSphere& sphere : spheres) {
        list.push_back({{"name", sphere.name},
                        {"centre", valueToJson(sphere.centre)},
                        {"radius", readableDecimal(sphere.radius)},
                        {"bone", sphere.bone}});
        if (sphere.joined >= 0) list.back()["joined"] = sphere.joined;
    }
    return list;
}

void readSettings(JsonReader reader, HairMaterial& material) {
    readFields(std::move(reader), material);
}
void readSettings(JsonReader reader, ShadowSettings& settings) {
    readFields(std::move(reader), settings);
}
void readSettings(JsonReader reader, InterpolationSettings& settings) {
    readFields(std::move(reader), settings);
}
void readSettings(JsonReader reader, PlacementSettings& settings) {
    readFields(std::move(reader), settings);
}

void readSettings(JsonReader reader, runtime::SimulationSettings& settings) {
    readTipShare(reader, settings);
    readFields(std::move(reader), settings);
}

namespace {

CollisionSphere readSphere(JsonReader& reader) {
    CollisionSphere sphere;
    sphere.name = reader.string("name");
    sphere.centre = reader.vector("centre", -kAnyFloat, kAnyFloat, "m");
    sphere.radius = static_cast<float>(reader.number("radius", 0, kAnyFloat, "m"));
    sphere.bone = reader.string("bone");
    if (reader.has("joined")) sphere.joined = static_cast<std::int32_t>(reader.count("joined", 0, 1u << 30));
    if (reader.ok() && !(sphere.radius > 0)) reader.complain("radius", "is 0", "expected more than 0 m");
    reader.finish();
    return sphere;
}

}  // namespace

std::vector<CollisionSphere> readSphereList(JsonReader& reader) {
    std::vector<CollisionSphere> spheres;
    std::vector<JsonReader> entries = reader.objects("spheres");
    for (JsonReader& entry : entries) spheres.push_back(readSphere(entry));
    std::size_t capsules = 0;
    for (std::size_t s = 0; s < spheres.size(); ++s) {
        const std::int32_t joined = spheres[s].joined;
        if (joined >= 0 && ++capsules > runtime::kMaxCapsules)
            entries[s].complain("joined", "makes one capsule too many",
                                fmt::format("expected at most {}", runtime::kMaxCapsules));
        if (joined < 0 ||
            (static_cast<std::size_t>(joined) < spheres.size() && static_cast<std::size_t>(joined) != s))
            continue;
        entries[s].complain("joined", fmt::format("is {}", joined),
                            "expected the number of another sphere of the list");
    }
    return spheres;
}

}  // namespace hairloom
