// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/usd_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "importers/file_faces.h"
#include "importers/point_cache.h"
#include "importers/scene_parts.h"
#include "importers/usd_bones.h"
#include "importers/usd_primvar.h"

namespace hairloom {
namespace {

std::string tokenAt(const UsdPrim& prim, std::string_view name, const char* otherwise, double time) {
    const UsdAttribute* const attribute = prim.find(name);
    if (attribute == nullptr) return otherwise;
    const UsdValue value = valueAt(*attribute, time);
    return value.texts.empty() ? otherwise : value.texts.front();
}

/// What people call a prim.
const std::string& calledName(const UsdPrim& prim) {
    return prim.displayName.empty() ? prim.name : prim.displayName;
}

constexpr std::uint32_t kNoSubset = 0xffffffffu;

class Reader {
  public:
    Reader(UsdStage stage, const std::string& file)
        : stage_(std::move(stage)),
          file_(file),
          range_(rangeOf(stage_)),
          turn_(turnOf(stage_.metadata)),
          bones_(stage_, range_, turn_, scene_) {}

    Result<RawScene> run() {
        readStage();
        auto shown = shownPrims(stage_.root, UsdShape::Meshes, range_.start);
        if (!shown) return tl::unexpected(shown.error());
        leftOut_ = std::move(shown->leftOut);
        for (const UsdShownPrim& mesh : shown->prims) {
            if (mesh.isGuide)
                leftOut_.push_back(mesh.path + " is a guide");
            else if (auto status = addMesh(mesh); !status)
                return tl::unexpected(status.error());
        }
        if (scene_.soup.offsets.size() < 2) return noMesh();
        if (!leftOut_.empty()) scene_.warnings.push_back(firstOf(leftOut_) + ": these meshes were left out");
        Clip points;
        if (auto status = cache_.finish(points); !status) return tl::unexpected(status.error());
        if (auto status = bones_.addClips(std::move(points)); !status) return tl::unexpected(status.error());
        finish();
        return std::move(scene_);
    }

  private:
    static Eigen::Affine3d turnOf(const UsdMetadata& metadata) {
        Eigen::Affine3d turn = Eigen::Affine3d::Identity();
        const auto up = metadata.find("upAxis");
        if (up == metadata.end() || up->second.texts.empty() || up->second.texts.front() != "Z") return turn;
        turn.linear() << 1, 0, 0, 0, 0, 1, 0, -1, 0;
        return turn;
    }

    void readStage() {
        const double unit = usdNumber(stage_.metadata, "metersPerUnit", 0);
        constexpr float kFallback = 0.01f;
        if (unit > 0 && std::isfinite(unit))
            scene_.metresPerUnit = static_cast<float>(unit);
        else
            scene_.assumedMetresPerUnit = kFallback;
        const auto up = stage_.metadata.find("upAxis");
        scene_.statesUp = up != stage_.metadata.end() && !up->second.texts.empty();
        const auto tell = [&](const std::vector<std::string>& what, const char* behind) {
            if (!what.empty()) scene_.warnings.push_back(firstOf(what) + behind);
        };
        tell(stage_.repeated, ": appears twice, and USD's own library refuses it");
        tell(stage_.chosen, ": other variants were left out");
        tell(stage_.notFollowed, ": put what is missing beside the file, or flatten the stage");
    }

    Result<RawScene> noMesh() const {
        std::vector<std::string> reasons = stage_.notFollowed;
        reasons.insert(reasons.end(), leftOut_.begin(), leftOut_.end());
        return fail(reasons.empty() ? "has no meshes" : "has no mesh that shows: " + firstOf(reasons),
                    "expected a head as a Mesh with faces");
    }

    std::vector<std::int64_t> wholesOf(const UsdPrim& mesh, std::string_view name) const {
        std::vector<std::int64_t> numbers;
        const UsdAttribute* const attribute = mesh.find(name);
        if (attribute == nullptr) return numbers;
        const UsdValue value = valueAt(*attribute, range_.start);
        numbers.reserve(value.numbers.size());
        for (std::size_t i = 0; i < value.numbers.size(); ++i) numbers.push_back(value.numbers.whole(i));
        return numbers;
    }

    /// What is wrong with a mesh leaves it out, and the others to be had.
    Result<FileFaces> facesOf(const UsdPrim& mesh, std::size_t points) {
        FileFaces faces;
        const std::vector<std::int64_t> counts = wholesOf(mesh, "faceVertexCounts"),
                                        indices = wholesOf(mesh, "faceVertexIndices");
        for (const std::int64_t count : counts) {
            if (count < 0) return fail(fmt::format("has a face of {} corners", count));
            const std::uint64_t end = faces.offsets.back() + static_cast<std::uint64_t>(count);
            if (end > indices.size()) return fail("has faces of more corners than indices");
            faces.offsets.push_back(static_cast<std::uint32_t>(end));
        }
        if (faces.offsets.back() != indices.size())
            return fail(
                fmt::format("has {} indices for faces of {} corners", indices.size(), faces.offsets.back()));
        for (const std::int64_t index : indices) {
            if (index < 0 || static_cast<std::uint64_t>(index) >= points)
                return fail(fmt::format("has a face that refers to point {} of {}", index, points));
            faces.corners.push_back(static_cast<std::uint32_t>(index));
        }
        faces.isHole.assign(faces.count(), 0);
        for (const std::int64_t hole : wholesOf(mesh, "holeIndices")) {
            if (hole >= 0 && static_cast<std::uint64_t>(hole) < faces.count())
                faces.isHole[static_cast<std::size_t>(hole)] = 1;
        }
        return faces;
    }

    Status addMesh(const UsdShownPrim& shown) {
        const UsdPrim& mesh = *shown.prim;
        const auto leave = [&](const std::string& why) -> Status {
            leftOut_.push_back(fmt::format("{} {}", shown.path, why));
            return {};
        };
        const UsdAttribute* const attribute = mesh.find("points");
        if (attribute == nullptr) return leave("has no points");
        UsdValue value = valueAt(*attribute, range_.start);
        if (value.numbers.empty() || value.components != 3) return leave("has no points");
        const std::vector<float> points = std::move(value.numbers).floats();
        const std::size_t count = points.size() / 3;
        const auto faces = facesOf(mesh, count);
        if (!faces) return leave(faces.error().problem);
        if (faces->count() == 0) return leave("has no faces");
        PolygonSoup& soup = scene_.soup;
        if (auto status = FaceCollector::fits(soup, count, faces->corners.size()); !status) return status;
        auto binding = bones_.bind(shown, count);
        if (!binding) return tl::unexpected(binding.error());
        const auto first = static_cast<std::uint32_t>(soup.positions.size());
        std::ranges::copy(pointsIn(points, binding->toWorld), std::back_inserter(soup.positions));
        if (auto status = bones_.addShapes(shown, first, count, binding->toWorld); !status) return status;
        if (attribute->samples.size() > 1) addCache(mesh, *attribute, first, count, *binding);
        SkinWeights& skin = scene_.skin;
        skin.bones.insert(skin.bones.end(), binding->skin.bones.begin(), binding->skin.bones.end());
        skin.weights.insert(skin.weights.end(), binding->skin.weights.begin(), binding->skin.weights.end());
        const std::string scheme = tokenAt(mesh, "subdivisionScheme", "", range_.start);
        collector_.isCage = collector_.isCage || (!scheme.empty() && scheme != "none");
        addFaces(shown, *faces, {count, faces->corners.size(), faces->count()}, first, binding->toWorld);
        return {};
    }

    /// Points in the time of the stage's clip. `attribute` is of the stage.
    void addCache(const UsdPrim& prim, const UsdAttribute& attribute, std::uint32_t first, std::size_t count,
                  const UsdBinding& binding) {
        std::vector<double> codes{range_.start};
        for (const auto& [code, value] : attribute.samples) {
            if (code > range_.start && code < range_.end) codes.push_back(code);
        }
        codes.push_back(range_.end);
        PointCache::Mesh mesh{calledName(prim), first, static_cast<std::uint32_t>(count), {}, {},
                              isMoved(binding)};
        for (const double code : codes) mesh.seconds.push_back(range_.seconds(code));
        mesh.read = [&attribute, codes,
                     toWorld = binding.toWorld](std::size_t sample) -> Result<std::vector<Vec3f>> {
            UsdValue value = valueAt(attribute, codes[sample]);
            return pointsIn(std::move(value.numbers).floats(), toWorld);
        };
        cache_.add(std::move(mesh));
    }
    static bool isMoved(const UsdBinding& binding) {
        return std::ranges::any_of(binding.skin.weights, [](const auto& weights) { return weights[0] > 0; });
    }

    void addFaces(const UsdShownPrim& shown, const FileFaces& faces, const MeshCounts& size,
                  std::uint32_t firstPoint, const Eigen::Affine3d& toWorld) {
        const UsdPrim& mesh = *shown.prim;
        const bool isMirrored = toWorld.linear().determinant() < 0;
        const bool isLeftHanded = tokenAt(mesh, "orientation", "rightHanded", range_.start) == "leftHanded";
        FacesInScene in;
        in.uvs = primvarOf(shown, uvNameOf(mesh), 2, size);
        in.normals = normalsOf(shown, size);
        in.groups = groupsOf(shown, faces.count());
        in.materials = materialsOf(shown, faces.count());
        in.firstPoint = firstPoint;
        in.toWorld = toWorld;
        in.isReversed = isMirrored != isLeftHanded;
        collector_.add(faces, in, scene_.soup);
    }

    std::optional<CornerValues> primvarOf(const UsdShownPrim& shown, std::string_view name,
                                          std::uint32_t components, const MeshCounts& size) {
        std::string problem;
        auto primvar = readPrimvar(*shown.prim, name, components, range_.start, size, problem);
        if (!problem.empty() && scene_.warnings.size() < 64)
            scene_.warnings.push_back(fmt::format("{}: {}; they were left out", shown.path, problem));
        return primvar;
    }

    /// Those of subdivision surfaces, which a mesh is that does not say otherwise, are not of its cage.
    std::optional<CornerValues> normalsOf(const UsdShownPrim& shown, const MeshCounts& size) {
        if (tokenAt(*shown.prim, "subdivisionScheme", "catmullClark", range_.start) != "none")
            return std::nullopt;
        auto normals = primvarOf(shown, "primvars:normals", 3, size);
        return normals ? std::move(normals) : primvarOf(shown, "normals", 3, size);
    }

    /// Subsets of a mesh's faces; those of materials last.
    static std::vector<const UsdPrim*> subsetsOf(const UsdPrim& mesh) {
        std::vector<const UsdPrim*> subsets;
        for (const UsdPrim& child : mesh.children) {
            const bool isShown =
                child.specifier == UsdPrim::Specifier::Def && (!child.active || *child.active);
            const UsdAttribute* const type = child.find("elementType");
            const bool isOfFaces =
                type == nullptr || type->value.texts.empty() || type->value.texts.front() == "face";
            if (child.type == "GeomSubset" && isShown && isOfFaces) subsets.push_back(&child);
        }
        std::ranges::stable_sort(subsets, {}, isOfMaterials);
        return subsets;
    }
    static bool isOfMaterials(const UsdPrim* subset) {
        const UsdAttribute* const family = subset->find("familyName");
        return family != nullptr && !family->value.texts.empty() &&
               family->value.texts.front() == "materialBind";
    }

    /// What `use` gives for the first subset of each face that it gives something for, or for the mesh.
    template <class Use>
    std::vector<std::uint32_t> bySubset(const UsdPrim& mesh, std::size_t faces, const Use& use) {
        std::vector<std::uint32_t> numbers(faces, kNoSubset);
        for (const UsdPrim* const subset : subsetsOf(mesh)) {
            const std::optional<std::uint32_t> number = use(*subset);
            if (!number) continue;
            for (const std::int64_t index : wholesOf(*subset, "indices")) {
                if (index < 0 || static_cast<std::uint64_t>(index) >= faces) {
                    ++collector_.badSetFaces;
                    continue;
                }
                std::uint32_t& own = numbers[static_cast<std::size_t>(index)];
                if (own == kNoSubset) own = *number;
            }
        }
        // A name that no face has is none.
        if (std::ranges::find(numbers, kNoSubset) != numbers.end())
            std::ranges::replace(numbers, kNoSubset, *use(mesh));
        return numbers;
    }

    std::vector<std::uint32_t> groupsOf(const UsdShownPrim& shown, std::size_t faces) {
        const auto numberOf = [&](const UsdPrim& prim) {
            return indexOf(calledName(prim), groups_, scene_.soup.groupNames);
        };
        return bySubset(*shown.prim, faces,
                        [&](const UsdPrim& prim) { return std::optional(numberOf(prim)); });
    }

    std::vector<std::uint32_t> materialsOf(const UsdShownPrim& shown, std::size_t faces) {
        const auto numberOf = [&](const std::string& path) {
            return indexOf(path.substr(path.rfind('/') + 1), materials_, scene_.soup.materialNames);
        };
        return bySubset(*shown.prim, faces, [&](const UsdPrim& prim) -> std::optional<std::uint32_t> {
            if (&prim == shown.prim)
                return numberOf(targetOf(shown.levels, "material:binding").value_or("default"));
            const UsdAttribute* const own = prim.find("material:binding");
            if (own == nullptr || own->value.texts.empty()) return std::nullopt;
            return numberOf(own->value.texts.front());
        });
    }

    void finish() {
        collector_.finish(scene_, "subsets");
        if (scene_.bones.empty()) scene_.skin = {};
    }

    UsdStage stage_;
    const std::string& file_;
    RawScene scene_;
    UsdRange range_;
    Eigen::Affine3d turn_;
    UsdBones bones_;
    std::unordered_map<std::string, std::uint32_t> groups_, materials_;
    std::vector<std::string> leftOut_;
    FaceCollector collector_;
    PointCache cache_{scene_};
};

}  // namespace

Result<RawScene> readUsdMesh(const std::string& file, std::vector<std::byte>&& bytes,
                             const std::filesystem::path& folder) {
    auto stage = openUsdStage(file, std::move(bytes), folder);
    std::vector<std::byte>().swap(bytes);
    if (!stage) return tl::unexpected(stage.error());
    return Reader(std::move(*stage), file).run();
}

}  // namespace hairloom
