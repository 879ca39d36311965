// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Settings and spheres as JSON: one form for project files, scripts and the command line.

#include "core/groom/file/json_reader.h"
#include "core/groom/groom.h"

namespace hairloom {

nlohmann::ordered_json toJson(const HairMaterial& material);
nlohmann::ordered_json toJson(const ShadowSettings& settings);
nlohmann::ordered_json toJson(const InterpolationSettings& settings);
nlohmann::ordered_json toJson(const PlacementSettings& settings);
nlohmann::ordered_json toJson(const runtime::SimulationSettings& settings);
nlohmann::ordered_json toJson(const std::vector<CollisionSphere>& spheres);

/// Members that are absent keep their value; unknown names and values out of range are complaints of the
/// reader. Of the simulation angularTipShare, which was there before angularCurve, is read as a straight
/// curve.
void readSettings(JsonReader reader, HairMaterial& material);
void readSettings(JsonReader reader, ShadowSettings& settings);
void readSettings(JsonReader reader, InterpolationSettings& settings);
void readSettings(JsonReader reader, PlacementSettings& settings);
void readSettings(JsonReader reader, runtime::SimulationSettings& settings);

/// The member "spheres": objects of "name", "centre", "radius" (> 0), "bone" and, where it makes a capsule,
/// "joined", the number of another one of the list.
std::vector<CollisionSphere> readSphereList(JsonReader& reader);

}  // namespace hairloom
