// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/attribute_units.h"

#include <algorithm>
#include <array>
#include <string>

namespace hairloom {
namespace {

// Unreal's groom schema, Houdini, Blender, XGen and RenderMan, without underscores.
constexpr std::array<std::string_view, 19> kLengths{
    "width",       "widths",      "groomwidth",  "thickness",     "diameter",   "radius",     "radii",
    "groomradius", "pscale",      "length",      "groomlength",   "hairlength", "restlength", "strandlength",
    "curvelength", "guidelength", "clumpradius", "clumpdistance", "rootwidth"};
constexpr std::array<std::string_view, 9> kPositions{
    "rest",         "pref",         "restposition",    "prest", "restp",
    "rootposition", "surfacepoint", "surfaceposition", "pworld"};
constexpr std::array<std::string_view, 6> kVectors{
    "v", "velocity", "velocities", "acceleration", "accelerations", "displacement"};

}  // namespace

AttributeUnit attributeUnit(std::string_view name, std::uint32_t components) {
    std::string plain;
    for (const char c : name) {
        if (c != '_') plain += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    }
    const auto among = [&](const auto& names) { return std::ranges::find(names, plain) != names.end(); };
    if (components == 1 && among(kLengths)) return AttributeUnit::Length;
    if (components == 3 && among(kPositions)) return AttributeUnit::Position;
    if (components == 3 && among(kVectors)) return AttributeUnit::Vector;
    return AttributeUnit::None;
}

}  // namespace hairloom
