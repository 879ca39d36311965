// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Files that several jobs open, and values that several reports hold.

#include <CLI/App.hpp>
#include <string>
#include <vector>

#include "cli/job.h"
#include "core/groom/groom.h"
#include "core/groom/validate.h"
#include "importers/scene.h"

namespace hairloom::cli {

/// --unit m/dm/cm/mm/inch, or another name, for files that state none.
void addUnitOption(CLI::App& job, std::string& unit, const std::string& name = "--unit",
                   const std::string& of = "the file");
/// Metres of one such unit, 1 for an empty name. The name is one that addUnitOption lets through.
float metresPerUnit(const std::string& unit);

/// The mesh, skeleton and clips of a file; its warnings go to the log.
Result<ImportedScene> importSceneLoud(const std::string& path, const MeshImportOptions& options);
/// The same with the unit of --unit, which may be empty.
Result<ImportedScene> importSceneWithUnit(const std::string& path, const std::string& unit);

/// A groom from a project, or from a hair file of any supported format.
Result<Groom> loadDocument(const std::string& path);

/// What is in a file of any supported kind.
struct Opened {
    std::string format;
    Groom groom;  ///< for meshes: the scalp and no strands
    std::vector<Finding> findings;
};
Result<Opened> openAny(const std::string& path, const std::string& unit);

/// The list of {"name", "centre": [x, y, z], "radius", "bone"} that `spheres` takes; metres, radius > 0.
Result<std::vector<CollisionSphere>> readSpheres(const std::string& path);

/// One number in [0, 1] per vertex of the mesh file, separated by white space; given back per vertex of the
/// mesh.
Result<std::vector<float>> readVertexMask(const std::string& path, const ScalpMesh& mesh);

/// Says findings on standard error, as warnings about `path`.
void logFindings(const std::string& path, const std::vector<Finding>& findings);

Report toReport(const Finding& finding);
Report toReport(const std::vector<Finding>& findings);
Report toReport(const Vec3f& vector);
/// JSON has no infinities.
Report finiteOrNull(double value);

}  // namespace hairloom::cli
