// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <limits>

#include "core/base/file.h"
#include "core/base/profiler.h"
#include "core/groom/file/archive.h"
#include "core/groom/file/card_edits_json.h"
#include "core/groom/file/character_path.h"
#include "core/groom/file/json_reader.h"
#include "core/groom/file/layers_json.h"
#include "core/groom/file/operators_json.h"
#include "core/groom/file/poses_json.h"
#include "core/groom/file/project_file.h"
#include "core/groom/file/project_sections.h"
#include "core/groom/file/settings_json.h"
#include "core/groom/file/time_line_json.h"
#include "core/groom/mask_names.h"
#include "core/groom/validate.h"
#include "hairloom/body_field.h"

namespace hairloom {
namespace {

constexpr std::uint64_t kFirstWithPlacement = 2;  ///< version that has density and placement
constexpr std::uint64_t kFirstWithOperators = 6;
constexpr std::uint64_t kFirstWithCardEdits = 9;
constexpr std::uint64_t kFirstWithBody = 10;
constexpr std::uint64_t kFirstWithTimeLine = 11;
constexpr std::uint64_t kFirstWithPoses = 12;

struct Counts {
    std::uint64_t version;
    std::uint64_t strands;
    std::uint64_t points;
};

Counts readHead(JsonReader& head, Groom& groom, ScalpMeshParts& scalp) {
    head.string("kind");
    const std::uint64_t version = head.count("version", 1, kProjectVersion);
    head.object("arrays");
    constexpr std::uint64_t kMax = std::numeric_limits<std::uint32_t>::max();
    const Counts counts{version, head.count("strands", 0, kMax), head.count("points", 0, kMax)};
    groom.layers = readLayers(head);
    if (groom.layers.empty()) head.complain("layers", "is empty", "expected at least one layer");
    if (version >= kFirstWithOperators) groom.operators = readOperatorList(head, readOperatorShape);
    groom.groupNames = head.strings("groups");
    if (head.has("masks")) readMaskNames(head.object("masks"), groom.maskNames);
    groom.spheres = readSphereList(head);
    readSettings(head.object("material"), groom.material);
    if (head.has("shadows")) readSettings(head.object("shadows"), groom.shadows);
    readSettings(head.object("simulation"), groom.simulation);
    readSettings(head.object("interpolation"), groom.interpolation);
    if (version >= kFirstWithPlacement) readSettings(head.object("placement"), groom.placement);
    if (version >= kFirstWithCardEdits) groom.cardEdits = readCardEdits(head);
    if (version >= kFirstWithPoses) groom.poses = readPoses(head);
    if (version >= kFirstWithTimeLine) {
        if (TimeLine line = readTimeLine(head); line != TimeLine())
            groom.timeLine = std::make_shared<const TimeLine>(std::move(line));
    }
    groom.characterFile = head.string("character_file");
    groom.characterMetresPerUnit = static_cast<float>(head.number("character_metres_per_unit", 0, 1e6));
    groom.scalpExpression = head.string("scalp_expression");
    if (head.has("scalp")) {
        JsonReader reader = head.object("scalp");
        scalp.groupNames = reader.strings("groups");
        scalp.materialNames = reader.strings("materials");
        for (JsonReader& entry : reader.objects("repairs")) {
            scalp.repairs.push_back(
                {entry.string("what"), static_cast<std::size_t>(entry.count("count", 0, kMax))});
            entry.finish();
        }
        reader.finish();
    }
    head.finish();
    return counts;
}

/// Takes arrays out of the archive and remembers the first error and what has been asked for.
class ArrayTaker {
  public:
    explicit ArrayTaker(const ArchiveReader& archive) : archive_(archive) {}

    template <class T>
    std::vector<T> take(std::string_view name) {
        taken_.emplace(name);
        if (!status_) return {};
        auto values = archive_.read<T>(name);
        if (values) return std::move(*values);
        status_ = tl::unexpected(values.error());
        return {};
    }

    /// Groups of N indices that the file holds as a flat array.
    template <class T>
    std::vector<T> takeGroups(std::string_view name) {
        constexpr std::size_t kSize = sizeof(T) / sizeof(std::uint32_t);
        const auto values = take<std::uint32_t>(name);
        if (values.size() % kSize != 0) {
            status_ = tl::unexpected(archive_.errorAt(name, fmt::format("has {} values", values.size()),
                                                      fmt::format("expected a multiple of {}", kSize)));
            return {};
        }
        std::vector<T> groups(values.size() / kSize);
        if (!values.empty()) std::memcpy(groups.data(), values.data(), values.size() * sizeof(std::uint32_t));
        return groups;
    }

    void takeAttributes(std::string_view prefix, std::uint64_t count, AttributeSet& attributes) {
        for (const std::string& name : archive_.names()) {
            if (!status_ || name.rfind(prefix, 0) != 0) continue;
            taken_.insert(name);
            auto data = archive_.readAny(name);
            if (data && sizeOf(*data) == count) {
                attributes.set(name.substr(prefix.size()), std::move(*data));
            } else {
                status_ =
                    tl::unexpected(data ? archive_.errorAt(name, fmt::format("has {} values", sizeOf(*data)),
                                                           fmt::format("expected {}", count))
                                        : data.error());
            }
        }
    }

    Status finish() const {
        if (!status_) return status_;
        for (const std::string& name : archive_.names()) {
            if (!taken_.contains(name)) {
                return tl::unexpected(
                    archive_.errorAt(name, "is not known to this program",
                                     "expected strand/…, point/… or a name of this version"));
            }
        }
        return {};
    }

  private:
    const ArchiveReader& archive_;
    Status status_;
    std::set<std::string, std::less<>> taken_;
};

void takeScalp(ArrayTaker& taker, ScalpMeshParts& parts) {
    parts.positions = taker.take<Vec3f>(section::kScalpPositions);
    parts.normals = taker.take<Vec3f>(section::kScalpNormals);
    parts.triangles = taker.takeGroups<Triangle>(section::kScalpTriangles);
    parts.cornerUvs = taker.take<Vec2f>(section::kScalpCornerUvs);
    parts.sourceFaces = taker.take<std::uint32_t>(section::kScalpSourceFaces);
    parts.sourceVertices = taker.take<std::uint32_t>(section::kScalpSourceVertices);
    parts.triangleGroups = taker.take<std::uint32_t>(section::kScalpGroups);
    parts.triangleMaterials = taker.take<std::uint32_t>(section::kScalpMaterials);
}

Status takeArrays(const ArchiveReader& archive, const Counts& counts, Groom& groom, ScalpMeshParts* scalp) {
    ArrayTaker taker(archive);
    groom.offsets = CowArray<std::uint32_t>(taker.take<std::uint32_t>(section::kOffsets));
    taker.takeAttributes(section::kStrandPrefix, counts.strands, groom.strandAttributes);
    taker.takeAttributes(section::kPointPrefix, counts.points, groom.pointAttributes);
    groom.scalpSelection = taker.take<std::uint32_t>(section::kSelection);
    groom.triangulation.triangles = taker.takeGroups<Triangle>(section::kRootTriangles);
    groom.triangulation.alone = taker.take<std::uint32_t>(section::kAlone);
    groom.triangulation.coincident = taker.takeGroups<RootTriangulation::Coincident>(section::kCoincident);
    if (scalp) takeScalp(taker, *scalp);
    if (scalp && counts.version >= kFirstWithPlacement)
        groom.scalpDensity = taker.take<float>(section::kScalpDensity);
    if (counts.version >= kFirstWithBody && archive.has(section::kBody)) {
        const auto bytes = taker.take<std::uint8_t>(section::kBody);
        runtime::BodyFieldRead read = runtime::bodyFieldFromBytes(bytes);
        if (!read.field)
            return tl::unexpected(archive.errorAt(section::kBody, "cannot be used: " + read.error,
                                                  "expected what colliders --fit field bakes"));
        groom.body = std::make_shared<const runtime::BodyField>(std::move(*read.field));
    }
    if (auto status = taker.finish(); !status) return status;
    if (groom.strandCount() == counts.strands && groom.pointCount() == counts.points &&
        !groom.offsets.empty())
        return {};
    return tl::unexpected(archive.errorAt(
        section::kOffsets,
        fmt::format("describes {} strands of {} points", groom.strandCount(), groom.pointCount()),
        fmt::format("the header has {} strands of {} points", counts.strands, counts.points)));
}

}  // namespace

bool looksLikeProject(const std::filesystem::path& path) {
    return startsAsArchive(readBeginning(path, 8));
}

Result<Groom> readProjectFile(const std::filesystem::path& path) {
    HAIRLOOM_PROFILE("groom: load project");
    const std::string name = path.string();
    auto bytes = readFile(path);
    if (!bytes) return tl::unexpected(bytes.error());
    const auto archive = ArchiveReader::open(name, std::move(*bytes), section::kKind, kProjectVersion);
    if (!archive) return tl::unexpected(archive.error());

    Groom groom;
    ScalpMeshParts scalp;
    JsonReader head(archive->head(), name);
    const Counts counts = readHead(head, groom, scalp);
    if (auto status = head.status(); !status) return tl::unexpected(status.error());
    groom.characterFile = findCharacter(groom.characterFile, path);
    const bool hasScalp = head.has("scalp");
    if (auto status = takeArrays(*archive, counts, groom, hasScalp ? &scalp : nullptr); !status) {
        return tl::unexpected(status.error());
    }
    if (hasScalp) {
        auto mesh = ScalpMesh::fromParts(std::move(scalp));
        if (!mesh) return tl::unexpected(inFile(mesh.error(), name));
        groom.scalp = std::make_shared<const ScalpMesh>(std::move(*mesh));
    }
    if (auto status = checkStructure(groom); !status) return tl::unexpected(inFile(status.error(), name));
    return groom;
}

}  // namespace hairloom
