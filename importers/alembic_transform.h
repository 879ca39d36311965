// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What leads from an object of an Alembic file to the file: a transform of each level above it.

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "importers/alembic_archive.h"

namespace hairloom {

/// A transform of the schema AbcGeom_Xform.
struct AlembicLevel {
    std::string path;
    std::vector<AlembicProperty> xform;
};

/// Appends the object's own transform to those above it, which go where it does not inherit them.
Status addLevel(const AlembicArchive& archive, const AlembicObject& object, const AlembicProperty& xform,
                std::vector<AlembicLevel>& levels);

/// The property of its numbers; null where it has none.
const AlembicProperty* valuesOf(const AlembicLevel& level);

/// Of all levels at a time, in seconds, each in its own sampling: between two samples scales, moves and
/// angles go straight, matrices by their rotation, scale and place. Errors: operations that there are not,
/// numbers that are none.
Result<Eigen::Affine3d> toFileAt(const AlembicArchive& archive, const std::vector<AlembicLevel>& levels,
                                 double seconds);

}  // namespace hairloom
