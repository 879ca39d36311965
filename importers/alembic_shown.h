// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The curves or meshes of an Alembic file, each in every place that it is seen at.

#include <array>
#include <map>
#include <span>
#include <string>
#include <string_view>
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
    OgawaNode node;
    std::string schema;                       ///< "AbcGeom_Curve_v2"
    std::vector<AlembicProperty> properties;  ///< of its geometry
    AlembicInherited inherited;
};

struct AlembicShown {
    std::vector<AlembicShownObject> objects;
    std::vector<std::string> hidden;  ///< paths of those that are not visible
    std::vector<Finding> warnings;
};

inline constexpr std::array<std::string_view, 1> kAlembicCurves{"AbcGeom_Curve_v"};
inline constexpr std::array<std::string_view, 2> kAlembicMeshes{"AbcGeom_PolyMesh_v", "AbcGeom_SubD_v"};

/// Those of schemas that begin so, instances in their own places. Errors: objects that lie too deep or are
/// too many, as instances of what they lie in are.
Result<AlembicShown> shownObjects(const AlembicArchive& archive, std::span<const std::string_view> schemas);

/// The value of a key, or nothing.
std::string valueOf(const AlembicMetadata& metadata, std::string_view key);

/// Whether a property of an object is about its hair ("groom_…").
bool isOfHair(const AlembicProperty& property);

}  // namespace hairloom
