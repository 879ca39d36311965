// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/alembic_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <unordered_map>

#include "importers/alembic_shown.h"
#include "importers/file_faces.h"
#include "importers/point_cache.h"
#include "importers/scene_parts.h"
#include "importers/transform_keys.h"

namespace hairloom {
namespace {

constexpr std::uint32_t kNoSet = 0xffffffffu;

std::string leafOf(const std::string& path) {
    return path.substr(path.rfind('/') + 1);
}

class Reader {
  public:
    Reader(const AlembicArchive& archive, const std::string& file) : archive_(archive), file_(file) {}

    Result<RawScene> run() {
        auto shown = shownObjects(archive_, kAlembicMeshes);
        if (!shown) return tl::unexpected(inFile(shown.error(), file_));
        for (const Finding& finding : shown->warnings) scene_.warnings.push_back(finding.what);
        for (const std::string& hidden : shown->hidden) leftOut_.push_back(hidden + " is hidden");
        findStart(shown->objects);
        for (const AlembicShownObject& object : shown->objects) {
            if (auto status = addMesh(object); !status) return tl::unexpected(inFile(status.error(), file_));
        }
        if (scene_.soup.offsets.size() < 2)
            return failIn(
                file_, {},
                leftOut_.empty() ? "has no meshes" : "has no mesh that can be read: " + firstOf(leftOut_),
                "expected a visible head as polygons");
        if (!leftOut_.empty()) scene_.warnings.push_back(firstOf(leftOut_) + ": these meshes were left out");
        if (auto status = cache_.finish(clip_); !status) return tl::unexpected(inFile(status.error(), file_));
        finish();
        return std::move(scene_);
    }

  private:
    static const AlembicProperty* movingOf(const AlembicLevel& level) {
        const AlembicProperty* const values = hairloom::valuesOf(level);
        return values != nullptr && values->moves() ? values : nullptr;
    }

    /// The first time of what moves.
    void findStart(const std::vector<AlembicShownObject>& objects) {
        std::set<double> starts;
        const auto take = [&](const AlembicProperty* property) {
            if (property == nullptr || !property->moves()) return;
            const SampleTimes& times = archive_.times(property->timeSampling);
            if (times.ascend(property->samples)) starts.insert(times.at(0));
        };
        for (const AlembicShownObject& object : objects) {
            take(findProperty(object.properties, "P"));
            for (const AlembicLevel& level : object.inherited.levels) take(movingOf(level));
        }
        if (!starts.empty()) start_ = *starts.begin();
    }

    std::uint32_t first(const AlembicProperty& property) const {
        return archive_.momentOf(property, start_).nearest();
    }

    Result<std::vector<std::int64_t>> wholesOf(const AlembicShownObject& object,
                                               std::string_view name) const {
        const AlembicProperty* const property = findProperty(object.properties, name);
        if (property == nullptr) return std::vector<std::int64_t>();
        return archive_.integers(*property, first(*property));
    }

    /// Damage of the file is an error; a mesh that contradicts itself is left out.
    Status addMesh(const AlembicShownObject& object) {
        const auto leave = [&](const std::string& why) -> Status {
            leftOut_.push_back(fmt::format("{} {}", object.path, why));
            return {};
        };
        const AlembicProperty* const positions = findProperty(object.properties, "P");
        if (positions == nullptr || positions->samples == 0 || positions->extent != 3)
            return leave("has no points");
        const auto points = archive_.floats(*positions, first(*positions));
        if (!points) return tl::unexpected(points.error());
        const auto counts = wholesOf(object, ".faceCounts"), indices = wholesOf(object, ".faceIndices"),
                   holes = wholesOf(object, ".holes");
        for (const auto* const numbers : {&counts, &indices, &holes}) {
            if (!*numbers) return tl::unexpected(numbers->error());
        }
        const std::size_t pointCount = points->size() / 3;
        FileFaces faces;
        auto& [offsets, corners, isHole] = faces;
        for (const std::int64_t count : *counts) {
            if (count < 0) return leave(fmt::format("has a face of {} corners", count));
            const std::uint64_t end = offsets.back() + static_cast<std::uint64_t>(count);
            if (end > indices->size()) return leave("has faces of more corners than indices");
            offsets.push_back(static_cast<std::uint32_t>(end));
        }
        if (offsets.back() != indices->size())
            return leave(
                fmt::format("has {} indices for faces of {} corners", indices->size(), offsets.back()));
        if (offsets.size() < 2) return leave("has no faces");
        for (const std::int64_t index : *indices) {
            if (index < 0 || static_cast<std::uint64_t>(index) >= pointCount)
                return leave(fmt::format("has a face that refers to point {} of {}", index, pointCount));
            corners.push_back(static_cast<std::uint32_t>(index));
        }
        if (auto status = FaceCollector::fits(scene_.soup, pointCount, faces.corners.size()); !status)
            return status;
        collector_.isCage = collector_.isCage || object.schema.starts_with("AbcGeom_SubD");
        const auto where = toFileAt(archive_, object.inherited.levels, start_);
        if (!where) return tl::unexpected(where.error());
        const auto carrier = carrierOf(object.inherited.levels);
        if (!carrier) return tl::unexpected(carrier.error());
        firstPoint_ = static_cast<std::uint32_t>(scene_.soup.positions.size());
        std::ranges::copy(pointsIn(*points, *where), std::back_inserter(scene_.soup.positions));
        const bool isCarried = *carrier != kNoBone;
        if (positions->moves()) addCache(object, *positions, *where, pointCount, isCarried);
        scene_.skin.bones.resize(scene_.soup.positions.size(), {isCarried ? *carrier : 0});
        scene_.skin.weights.resize(scene_.soup.positions.size(), {isCarried ? 1.0f : 0.0f});
        isHole.assign(faces.count(), 0);
        for (const std::int64_t hole : *holes) {
            if (hole >= 0 && static_cast<std::size_t>(hole) < isHole.size())
                isHole[static_cast<std::size_t>(hole)] = 1;
        }
        return addFaces(object, faces, {pointCount, corners.size(), faces.count()}, *where);
    }

    /// `positions` are those of the object.
    void addCache(const AlembicShownObject& object, const AlembicProperty& positions,
                  const Eigen::Affine3d& toFile, std::size_t pointCount, bool isCarried) {
        const SampleTimes& times = archive_.times(positions.timeSampling);
        // Later ones are the last that changed.
        const std::uint32_t samples = std::min(positions.lastChanged, positions.samples - 1) + 1;
        const auto stay = [&](const std::string& why) {
            scene_.warnings.push_back(
                fmt::format("{}: {}; its points stay as they are at first", object.path, why));
        };
        if (samples > kMaxRecordFrames)
            return stay(
                fmt::format("has points at {} times, of which {} are read", samples, kMaxRecordFrames));
        if (!times.ascend(samples)) return stay("times of its points do not ascend");
        PointCache::Mesh mesh{
            leafOf(object.path), firstPoint_, static_cast<std::uint32_t>(pointCount), {}, {}, isCarried};
        for (std::uint32_t s = 0; s < samples; ++s)
            mesh.seconds.push_back(static_cast<float>(times.at(s) - start_));
        mesh.read = [this, &positions, toFile](std::size_t sample) -> Result<std::vector<Vec3f>> {
            const auto numbers = archive_.floats(positions, static_cast<std::uint32_t>(sample));
            if (!numbers) return tl::unexpected(numbers.error());
            return pointsIn(*numbers, toFile);
        };
        cache_.add(std::move(mesh));
    }

    /// Faces go clockwise in Alembic, seen from outside.
    Status addFaces(const AlembicShownObject& object, const FileFaces& faces, const MeshCounts& size,
                    const Eigen::Affine3d& toFile) {
        auto uvs = valuesAt(object, "uv", 2, size), normals = valuesAt(object, "N", 3, size);
        for (const auto* const values : {&uvs, &normals}) {
            if (!*values) return tl::unexpected(values->error());
        }
        auto groups = groupsOf(object, size.faces);
        if (!groups) return tl::unexpected(groups.error());
        FacesInScene in;
        in.uvs = std::move(*uvs);
        in.normals = std::move(*normals);
        in.groups = std::move(*groups);
        in.materials.assign(faces.count(), 0);
        in.firstPoint = firstPoint_;
        in.toWorld = toFile;
        in.isReversed = !(toFile.linear().determinant() < 0);
        collector_.add(faces, in, scene_.soup);
        return {};
    }

    /// A plain property, or the pair of values and indices into them.
    Result<std::optional<CornerValues>> valuesAt(const AlembicShownObject& object, std::string_view name,
                                                 std::uint32_t components, const MeshCounts& size) {
        const AlembicProperty* const named = findProperty(object.properties, name);
        if (named == nullptr) return std::nullopt;
        std::vector<AlembicProperty> inside;
        if (named->kind == AlembicProperty::Kind::Compound) {
            auto read = archive_.properties(*named);
            if (!read) return tl::unexpected(read.error());
            inside = std::move(*read);
        }
        const bool isPair = named->kind == AlembicProperty::Kind::Compound;
        const AlembicProperty* const values = isPair ? findProperty(inside, ".vals") : named;
        if (values == nullptr || values->samples == 0 || values->extent != components) return std::nullopt;
        auto numbers = archive_.floats(*values, first(*values));
        if (!numbers) return tl::unexpected(numbers.error());
        std::vector<std::int64_t> places;
        if (const AlembicProperty* const indices = findProperty(inside, ".indices")) {
            auto read = archive_.integers(*indices, first(*indices));
            if (!read) return tl::unexpected(read.error());
            places = std::move(*read);
        }
        if (numbers->empty()) return std::nullopt;
        using Scope = CornerValues::Scope;
        const std::string said = valueOf(named->metadata, "geoScope");
        std::optional<Scope> scope;
        if (said == "fvr") scope = Scope::Corner;
        if (said == "vtx" || said == "var") scope = Scope::Point;
        if (said == "uni") scope = Scope::Face;
        if (said == "con") scope = Scope::Constant;
        std::string problem;
        auto made =
            CornerValues::make(std::move(*numbers), components, std::move(places), scope, size, problem);
        if (!problem.empty() && scene_.warnings.size() < 64)
            scene_.warnings.push_back(
                fmt::format("{}: {}: {}; they were left out", object.path, name, problem));
        return made;
    }

    /// Sets of faces, which are children of their mesh; the first one of each face.
    Result<std::vector<std::uint32_t>> groupsOf(const AlembicShownObject& object, std::size_t faces) {
        std::vector<std::uint32_t> groups(faces, kNoSet);
        const auto children = archive_.children({object.path, {}, object.node});
        if (!children) return tl::unexpected(children.error());
        for (const AlembicObject& child : *children) {
            if (!valueOf(child.metadata, "schema").starts_with("AbcGeom_FaceSet_v")) continue;
            const auto properties = archive_.properties(child);
            if (!properties) return tl::unexpected(properties.error());
            const AlembicProperty* const set = findProperty(*properties, ".faceset");
            if (set == nullptr || set->kind != AlembicProperty::Kind::Compound) continue;
            const auto inside = archive_.properties(*set);
            if (!inside) return tl::unexpected(inside.error());
            const AlembicProperty* const numbers = findProperty(*inside, ".faces");
            if (numbers == nullptr) continue;
            const auto members = archive_.integers(*numbers, first(*numbers));
            if (!members) return tl::unexpected(members.error());
            for (const std::int64_t face : *members) {
                if (face < 0 || static_cast<std::size_t>(face) >= faces) {
                    ++collector_.badSetFaces;
                    continue;
                }
                std::uint32_t& group = groups[static_cast<std::size_t>(face)];
                if (group == kNoSet) group = indexOf(leafOf(child.path), groups_, scene_.soup.groupNames);
            }
        }
        if (std::ranges::find(groups, kNoSet) != groups.end())
            std::ranges::replace(groups, kNoSet,
                                 indexOf(leafOf(object.path), groups_, scene_.soup.groupNames));
        return groups;
    }

    /// A bone for the levels above a mesh, where these move.
    Result<std::uint32_t> carrierOf(const std::vector<AlembicLevel>& levels) {
        const AlembicLevel* deepest = nullptr;
        std::set<double> times;
        for (const AlembicLevel& level : levels) {
            const AlembicProperty* const values = movingOf(level);
            if (values == nullptr) continue;
            const SampleTimes& sampling = archive_.times(values->timeSampling);
            if (!sampling.ascend(values->samples)) continue;
            deepest = &level;
            for (std::uint32_t s = 0; s < values->samples; ++s) times.insert(sampling.at(s));
        }
        if (deepest == nullptr) return kNoBone;
        // Objects below the same level that stand still in it share its bone.
        std::vector<AlembicLevel> moving(levels.begin(), levels.begin() + (deepest - levels.data()) + 1);
        const auto [known, isNew] =
            carriers_.try_emplace(deepest->path, static_cast<std::uint32_t>(scene_.bones.size()));
        if (!isNew) return known->second;
        const auto at = [&](double seconds) { return toFileAt(archive_, moving, seconds); };
        const auto restOfBone = at(start_);
        if (!restOfBone) return tl::unexpected(restOfBone.error());
        Bone bone;
        bone.name = leafOf(deepest->path);
        bone.rest = restOfBone->cast<float>();
        const Eigen::Affine3d inverse = restOfBone->inverse();
        if (inverse.matrix().cast<float>().allFinite()) bone.inverseBind = inverse.cast<float>();
        Channel channel;
        channel.bone = known->second;
        const auto isSheared = addTransformKeys(
            times, at, [&](double seconds) { return static_cast<float>(seconds - start_); }, channel);
        if (!isSheared) return tl::unexpected(isSheared.error());
        collector_.isSheared = collector_.isSheared || *isSheared;
        scene_.bones.push_back(std::move(bone));
        clip_.duration = std::max(clip_.duration, lastTime(channel));
        clip_.channels.push_back(std::move(channel));
        return known->second;
    }

    void finish() {
        scene_.soup.materialNames = {"default"};
        collector_.finish(scene_, "sets");
        clip_.name = "animation";
        if (!clip_.channels.empty() || !clip_.morphs.empty()) scene_.clips.push_back(std::move(clip_));
        if (scene_.bones.empty()) scene_.skin = {};
    }

    const AlembicArchive& archive_;
    const std::string& file_;
    RawScene scene_;
    Clip clip_;
    double start_ = 0;  ///< seconds
    std::uint32_t firstPoint_ = 0;
    std::map<std::string, std::uint32_t> carriers_;
    std::unordered_map<std::string, std::uint32_t> groups_;
    std::vector<std::string> leftOut_;
    FaceCollector collector_;
    PointCache cache_{scene_};
};

}  // namespace

Result<RawScene> readAlembicMesh(const std::string& file, std::span<const std::byte> bytes) {
    if (!bytes.empty() && std::to_integer<int>(bytes[0]) == 0x89)
        return failIn(file, Byte{0}, "is an Alembic file in HDF5, from before version 1.5",
                      "expected Ogawa: export it again, or run abcconvert -toOgawa");
    const auto archive = AlembicArchive::open(file, bytes);
    if (!archive) return tl::unexpected(archive.error());
    return Reader(*archive, file).run();
}

}  // namespace hairloom
