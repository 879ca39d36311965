// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a person drew: a tool with its settings and where it was put down, in the scalp's rest space, so that
// it does the same again on any machine that has the groom.

#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "core/editing/brush_curve.h"
#include "core/groom/file/json_reader.h"

namespace hairloom::editing {

/// One place of a stroke.
struct Dab {
    Vec3f position_ss = Vec3f::Zero();   ///< metres; on the skin, on the hair or in the view's plane
    Vec3f direction_ss = Vec3f::Zero();  ///< unit length, into the view; zero: no view, the dab is a sphere
    float radius = 0.02f;                ///< metres, 0.0001 … 1
    float strength = 0.5f;               ///< 0 … 1
    float pressure = 1.0f;               ///< 0 … 1; multiplies the strength
};

/// fieldsOf() (core/editing/brush_list.h) describes the members but for the curves and the parameters.
struct BrushSettings {
    float radius = 0.02f;
    float strength = 0.5f;
    float depth = 0.02f;
    float clearance = 0.001f;
    bool collide = true;
    bool invert = false;  ///< lower, spread, shorten, thaw …
    bool symmetric = false;
    Vec3f mirrorPoint = Vec3f::Zero();
    Vec3f mirrorNormal = Vec3f::UnitX();                 ///< any length but 0
    BrushCurve falloff = BrushCurve::falloff("smooth");  ///< middle to rim
    BrushCurve profile;                                  ///< root to tip
    std::uint64_t seed = 1;
    /// The tool's own numbers by name; those that are missing have their defaults.
    std::map<std::string, float, std::less<>> parameters;
};

struct Stroke {
    std::string tool;  ///< a name of brushNames()
    BrushSettings settings;
    std::vector<Dab> dabs;
};

/// A dab with the settings' radius and strength.
inline Dab dabAt(const BrushSettings& settings, const Vec3f& position_ss,
                 const Vec3f& direction_ss = Vec3f::Zero(), float pressure = 1) {
    return {position_ss, direction_ss, settings.radius, settings.strength, pressure};
}
Dab mirrored(const Dab& dab, const BrushSettings& settings);

/// An operation of a script, "op": "stroke" (docs/formats/script.md). Floats come back with the same bits.
nlohmann::ordered_json toJson(const Stroke& stroke);
/// All members but "op". Complaints are the reader's: unknown tools and names, values out of range.
Stroke readStroke(JsonReader& reader);

}  // namespace hairloom::editing
