// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/alembic_unreal.h"

namespace hairloom {
namespace {

constexpr std::size_t kMaxObjects = 10'000;  ///< the schema stands at one of the first
constexpr const char* kVersion = "groom_version_major";

bool statesVersion(const AlembicArchive& archive, const std::vector<AlembicProperty>& properties) {
    for (const char* schema : {".xform", ".geom"}) {
        const AlembicProperty* const inside = findProperty(properties, schema);
        if (inside == nullptr || inside->kind != AlembicProperty::Kind::Compound) continue;
        const auto own = archive.properties(*inside);
        if (!own) continue;
        for (const char* list : {".arbGeomParams", ".userProperties"}) {
            const AlembicProperty* const compound = findProperty(*own, list);
            if (compound == nullptr || compound->kind != AlembicProperty::Kind::Compound) continue;
            const auto named = archive.properties(*compound);
            if (named && findProperty(*named, kVersion) != nullptr) return true;
        }
    }
    return false;
}

}  // namespace

bool hasUnrealSchema(const AlembicArchive& archive) {
    std::vector<AlembicObject> waiting{archive.top()};
    for (std::size_t seen = 0; seen < waiting.size() && seen < kMaxObjects; ++seen) {
        const auto properties = archive.properties(waiting[seen]);
        if (properties && statesVersion(archive, *properties)) return true;
        const auto children = archive.children(waiting[seen]);
        if (children && waiting.size() < kMaxObjects)
            waiting.insert(waiting.end(), children->begin(), children->end());
    }
    return false;
}

bool isOfUnrealFile(std::string_view name) {
    return name == kVersion || name == "groom_version_minor" || name == "groom_tool" ||
           name == "groom_properties";
}

void assumeUnrealUnit(const StrandImportOptions& options, RawStrands& strands) {
    constexpr float kCentimetre = 0.01f;
    strands.assumedMetresPerUnit = kCentimetre;
    if (!options.isUnitAsked && options.metresPerUnit == 1.0f)
        strands.warnings.push_back(fileNote("a groom for Unreal states no unit; Unreal takes centimetres",
                                            "unit", "import with --unit where it is another"));
}

}  // namespace hairloom
