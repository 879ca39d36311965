// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Files of any supported kind, as the command line and the editor open them.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "core/groom/groom.h"
#include "core/groom/validate.h"
#include "importers/scene.h"

namespace hairloom {

/// Whether the file's content is of a format that heads come in; USD and Alembic may be hair as well.
bool mayBeHead(const std::string& path);
/// Metres of one unit of that name (m, dm, cm, mm, inch); 1 for an empty or unknown name.
float metresPerUnit(const std::string& unit);

/// The mesh, skeleton and clips of a file; its warnings go to the log.
Result<ImportedScene> importSceneLoud(const std::string& path, const MeshImportOptions& options);
/// The same with the name of a unit, which may be empty.
Result<ImportedScene> importSceneWithUnit(const std::string& path, const std::string& unit);

/// Hair files that state no unit are in the unit of this name from here on, for openGroom(). Empty, as at
/// first: as their format says, or metres. For programs that do one job. Set before anything is read.
void setUnitOfHairFiles(const std::string& unit);

/// A groom from a project, or from a hair file of any supported format.
Result<Groom> openGroom(const std::string& path);

/// What is in a file of any supported kind.
struct Opened {
    std::string format;
    Groom groom;  ///< for meshes: the scalp and no strands
    std::vector<Finding> findings;
};
/// Errors: no such file, an empty one, one that neither reader knows; those of the reader that knows it.
Result<Opened> openAny(const std::string& path, const std::string& unit);

/// From a JSON list of {"name", "centre": [x, y, z], "radius", "bone"}; metres, radius > 0.
Result<std::vector<CollisionSphere>> readSpheres(const std::string& path);

/// What a JSON object says of "simulation", "material", "shadows", "interpolation", "layers" and "masks";
/// what it leaves out keeps its value. Layers stand by their names and have "density" and "material", which
/// begins as the hairstyle's and is none as null. Masks stand by their numbers and have names. Errors:
/// unknown names and values out of range. `source` is named in errors.
Status applySettings(const nlohmann::json& document, const std::string& source, Groom& groom);

/// Says findings on standard error, as warnings about `path`.
void logFindings(const std::string& path, const std::vector<Finding>& findings);

}  // namespace hairloom
