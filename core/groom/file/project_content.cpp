// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/file/project_content.h"

#include <string>
#include <string_view>
#include <type_traits>

#include "core/groom/file/card_edits_json.h"
#include "core/groom/file/character_path.h"
#include "core/groom/file/json_reader.h"
#include "core/groom/file/layers_json.h"
#include "core/groom/file/operators_json.h"
#include "core/groom/file/poses_json.h"
#include "core/groom/file/project_sections.h"
#include "core/groom/file/settings_json.h"
#include "core/groom/file/time_line_json.h"
#include "core/groom/mask_names.h"

namespace hairloom {
namespace {

using Json = nlohmann::ordered_json;

Json scalpToJson(const ScalpMesh& scalp) {
    Json repairs = Json::array();
    for (const MeshRepair& repair : scalp.repairs())
        repairs.push_back({{"what", repair.what}, {"count", repair.count}});
    return {{"groups", scalp.groupNames()},
            {"materials", scalp.materialNames()},
            {"repairs", std::move(repairs)}};
}

/// Views triples or pairs of indices as the flat arrays that files hold.
template <class T>
std::span<const std::uint32_t> flat(std::span<const T> values) {
    static_assert(sizeof(T) % sizeof(std::uint32_t) == 0 && std::is_standard_layout_v<T>);
    return {reinterpret_cast<const std::uint32_t*>(values.data()),
            values.size() * (sizeof(T) / sizeof(std::uint32_t))};
}

void addScalp(ArchiveWriter& writer, const ScalpMesh& scalp) {
    const auto add = [&](std::string_view name, auto values) { writer.add(std::string(name), values); };
    add(section::kScalpPositions, scalp.positions());
    add(section::kScalpNormals, scalp.normals());
    add(section::kScalpTriangles, flat(scalp.triangles()));
    add(section::kScalpCornerUvs, scalp.cornerUvs());
    add(section::kScalpSourceFaces, scalp.sourceFaces());
    add(section::kScalpSourceVertices, scalp.sourceVertices());
    add(section::kScalpGroups, scalp.triangleGroups());
    add(section::kScalpMaterials, scalp.triangleMaterials());
}

}  // namespace

Json projectHead(const Groom& groom, const std::filesystem::path& path) {
    Json head;
    head["strands"] = groom.strandCount();
    head["points"] = groom.pointCount();
    head["layers"] = toJson(groom.layers);
    head["operators"] = toJson(groom.operators);
    head["groups"] = groom.groupNames;
    if (!groom.maskNames.empty()) head["masks"] = maskNamesToJson(groom.maskNames);
    head["spheres"] = toJson(groom.spheres);
    head["material"] = toJson(groom.material);
    head["shadows"] = toJson(groom.shadows);
    head["simulation"] = toJson(groom.simulation);
    head["interpolation"] = toJson(groom.interpolation);
    head["placement"] = toJson(groom.placement);
    head["card_edits"] = toJson(groom.cardEdits);
    head["poses"] = toJson(groom.poses);
    head["time_line"] = toJson(timeLineOf(groom));
    head["character_file"] = characterNameFor(groom.characterFile, path);
    head["character_metres_per_unit"] = readableDecimal(groom.characterMetresPerUnit);
    head["scalp_expression"] = groom.scalpExpression;
    if (groom.scalp) head["scalp"] = scalpToJson(*groom.scalp);
    return head;
}

void addProjectArrays(ArchiveWriter& writer, const Groom& groom, std::span<const std::uint8_t> body) {
    const auto add = [&](std::string_view name, auto values) { writer.add(std::string(name), values); };
    add(section::kOffsets, groom.offsets.view());
    for (const auto& [name, data] : groom.strandAttributes.all()) {
        writer.add(std::string(section::kStrandPrefix) + name, data);
    }
    for (const auto& [name, data] : groom.pointAttributes.all()) {
        writer.add(std::string(section::kPointPrefix) + name, data);
    }
    add(section::kSelection, std::span<const std::uint32_t>(groom.scalpSelection));
    add(section::kRootTriangles, flat(std::span<const Triangle>(groom.triangulation.triangles)));
    add(section::kCoincident,
        flat(std::span<const RootTriangulation::Coincident>(groom.triangulation.coincident)));
    add(section::kAlone, std::span<const std::uint32_t>(groom.triangulation.alone));
    if (groom.scalp) {
        addScalp(writer, *groom.scalp);
        add(section::kScalpDensity, std::span<const float>(groom.scalpDensity));
    }
    if (!body.empty()) add(section::kBody, body);
}

}  // namespace hairloom
