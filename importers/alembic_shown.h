// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The objects of curves of an Alembic file, each in every place that it is seen at.

#include <map>
#include <string>
#include <vector>

#include "importers/alembic_archive.h"
#include "importers/alembic_transform.h"
#include "importers/raw_strands.h"

namespace hairloom {

/// What an object has from those above it.
struct AlembicInherited {
    std::vector<AlembicLevel> levels;
    /// Properties of the objects themselves that are about hair, the nearest of each name.
    std::map<std::string, AlembicProperty> ofObjects;
    bool isHidden = false;
};

struct AlembicShownObject {
    std::string path;
    std::vector<AlembicProperty> properties;
    AlembicInherited inherited;
};

struct AlembicShown {
    std::vector<AlembicShownObject> curves;
    std::vector<std::string> hidden;  ///< paths of those that are not visible
    std::vector<Finding> warnings;
};

/// Those of the schemas AbcGeom_Curve_v1 and _v2, instances in their own places. Errors: objects that lie too
/// deep or are too many, as instances of what they lie in are.
Result<AlembicShown> findCurves(const AlembicArchive& archive);

/// The value of a key, or nothing.
std::string valueOf(const AlembicMetadata& metadata, std::string_view key);

/// Whether a property of an object is about its hair ("groom_…").
bool isOfHair(const AlembicProperty& property);

}  // namespace hairloom
