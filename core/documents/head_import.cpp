// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/documents/head_import.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "core/animation/bone_near.h"
#include "core/base/log.h"
#include "core/documents/open.h"
#include "core/editing/sphere_parts.h"
#include "core/geometry/selection.h"
#include "importers/length_unit.h"

namespace hairloom {
namespace {

/// A human, bust or head is higher than deep; one that is deeper by this lies.
constexpr float kLies = 1.15f;
/// A surface, and no head that lies.
constexpr float kFlat = 0.1f;

bool isHelper(std::string name) {
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
    return name.find("helper") != std::string::npos || name.find("joint") != std::string::npos;
}

/// As the options turn a head; quarters are exact.
Mat3f turnOf(const HeadImportOptions& options) {
    Mat3f up = Mat3f::Identity();
    if (options.zUp) up << 1, 0, 0, 0, 0, 1, 0, -1, 0;
    if (options.turnDegrees == 0) return up;
    constexpr float kQuarter = 90;
    float sine = std::sin(radians(options.turnDegrees)), cosine = std::cos(radians(options.turnDegrees));
    if (std::fmod(options.turnDegrees, kQuarter) == 0) {
        sine = std::round(sine);
        cosine = std::round(cosine);
    }
    Mat3f turn;
    turn << cosine, 0, sine, 0, 1, 0, -sine, 0, cosine;
    return turn * up;
}

/// The triangles with what their corners and faces have; normals are computed anew.
PolygonSoup soupOf(const ScalpMesh& mesh, const FaceSet& faces, const Mat3f& turn) {
    PolygonSoup soup;
    for (const Vec3f& p : mesh.positions()) soup.positions.emplace_back(turn * p);
    std::vector<std::uint32_t> newGroups(mesh.groupNames().size(), 0);
    std::vector<std::uint8_t> used(mesh.groupNames().size(), 0);
    for (const std::uint32_t face : faces) {
        if (!mesh.triangleGroups().empty()) used[mesh.triangleGroups()[face]] = 1;
    }
    for (std::size_t g = 0; g < used.size(); ++g) {
        newGroups[g] = static_cast<std::uint32_t>(soup.groupNames.size());
        if (used[g]) soup.groupNames.push_back(mesh.groupNames()[g]);
    }
    soup.materialNames = mesh.materialNames();
    for (const std::uint32_t face : faces) {
        for (std::size_t c = 0; c < 3; ++c) {
            soup.corners.push_back(mesh.triangles()[face][c]);
            if (!mesh.cornerUvs().empty()) soup.uvs.push_back(mesh.cornerUvs()[3 * std::size_t{face} + c]);
        }
        soup.offsets.push_back(static_cast<std::uint32_t>(soup.corners.size()));
        if (!mesh.triangleGroups().empty()) soup.faceGroups.push_back(newGroups[mesh.triangleGroups()[face]]);
        if (!mesh.triangleMaterials().empty()) soup.faceMaterials.push_back(mesh.triangleMaterials()[face]);
    }
    return soup;
}

/// Whether a head is where that of a standing character is, if Z is up: far along it, and at the height of
/// the ground.
bool isHighAlongZ(const ScalpMesh& mesh) {
    constexpr float kHigh = 2, kGround = 0.5f;
    const Vec3f size = mesh.bounds().sizes(), middle = mesh.bounds().center();
    return middle.z() > kHigh * size.z() && std::abs(middle.y()) < kGround * size.y() &&
           std::abs(middle.x()) < kGround * size.x() + 0.1f * size.z();
}

}  // namespace

HeadGuess guessHead(const ImportedScene& scene) {
    HeadGuess guess;
    for (const std::string& name : scene.mesh.groupNames()) {
        if (isHelper(name)) guess.helpers.push_back(name);
    }
    // What is no skin says nothing about the size.
    HeadImportOptions withoutHelpers;
    withoutHelpers.leaveOut = guess.helpers;
    const auto skin = partOfHead(scene.mesh, withoutHelpers);
    const Vec3f size = (skin ? *skin : scene.mesh).bounds().sizes();
    const auto unit = static_cast<double>(scene.metresPerUnit);
    const double largest = static_cast<double>(size.maxCoeff()) / unit;
    if (const LengthUnit* fits = fittingUnit(largest); implausibleSize(largest, unit) && fits)
        guess.unit = fits->name;
    const bool isDeep = size.z() > kLies * size.y() && size.y() > kFlat * size.z();
    guess.zUp = isDeep || isHighAlongZ(skin ? *skin : scene.mesh);
    return guess;
}

Result<ScalpMesh> partOfHead(const ScalpMesh& mesh, const HeadImportOptions& options) {
    std::vector<std::string> names = options.leaveOut;
    names.insert(names.end(), options.collideWith.begin(), options.collideWith.end());
    auto out = facesOfGroups(mesh, names);
    if (!out) return tl::unexpected(out.error());
    const FaceSet faces = invertSelection(mesh, *out);
    if (faces.empty() && options.collideWith.empty())
        return fail("all groups are left out", "keep at least one as the head");
    if (faces.empty())
        return fail("no head is left: all groups are left out or set to collide",
                    "keep at least one as the head");
    return ScalpMesh::make(soupOf(mesh, faces, turnOf(options)));
}

Result<editing::SphereFit> fitColliders(const ScalpMesh& mesh, const Skeleton& skeleton,
                                        const HeadImportOptions& options,
                                        const std::atomic<bool>* cancelled) {
    if (options.collideWith.empty()) return editing::SphereFit{};
    for (const std::string& name : options.collideWith) {
        const auto faces = facesOfGroups(mesh, {&name, 1});
        if (!faces) return tl::unexpected(faces.error());
        if (faces->empty())
            return fail(fmt::format("the group '{}' has no faces to collide with", name),
                        "expected a group with faces");
    }
    const auto faces = facesOfGroups(mesh, options.collideWith);
    if (!faces) return tl::unexpected(faces.error());
    const auto clothes = ScalpMesh::make(soupOf(mesh, *faces, turnOf(options)));
    if (!clothes) return tl::unexpected(clothes.error());
    std::vector<editing::SpherePart> parts;
    for (std::uint32_t face = 0; face < clothes->triangleCount(); ++face) {
        const std::string& name = clothes->groupNames()[clothes->triangleGroups()[face]];
        auto part = std::ranges::find(parts, name, &editing::SpherePart::name);
        if (part == parts.end()) part = parts.insert(part, {name, {}});
        part->faces.push_back(face);
    }
    auto fit = editing::fitSpheresToParts(*clothes, parts, options.colliderSpheres, cancelled);
    if (!fit) return fit;
    for (CollisionSphere& sphere : fit->spheres) sphere.bone = boneNear(skeleton, sphere.centre);
    return fit;
}

SkinWeights weightsOf(const SkinWeights& all, std::span<const std::uint32_t> vertices) {
    SkinWeights some;
    if (all.vertexCount() == 0) return some;
    for (const std::uint32_t v : vertices) {
        some.bones.push_back(all.bones[v]);
        some.weights.push_back(all.weights[v]);
    }
    return some;
}

namespace {

/// Unit and axis that neither the file nor the options say, with a word for each.
Status guessInto(const std::string& path, ImportedHead& head) {
    const HeadGuess guess = guessHead(head.scene);
    HeadImportOptions& options = head.taken;
    if (guess.zUp && options.guessUp && head.scene.statesUp)
        head.words.emplace_back("looks as if its Z axis were up, though it has another one. --up z turns it");
    const bool mayGuess = options.guessUnit && options.metresPerUnit == 0 && !head.scene.statesUnit;
    if (mayGuess && !guess.unit.empty()) {
        options.metresPerUnit = metresPerUnit(guess.unit);
        const Vec3f size = head.scene.mesh.bounds().sizes();
        const auto units = lengthUnits();
        const auto read = std::ranges::find_if(units, [&](const LengthUnit& known) {
            return static_cast<float>(known.metres) == head.scene.metresPerUnit;
        });
        const char* const usual = read == units.end() ? "m" : read->name;
        head.words.push_back(fmt::format(
            "states no unit; {0} were taken, since {1} would make it {2:.3g} m large; --unit {1} takes {1}",
            guess.unit, usual, size.maxCoeff()));
        auto scene = importScene(path, {options.metresPerUnit});
        if (!scene) return tl::unexpected(scene.error());
        head.scene = std::move(*scene);
    }
    if (options.guessUp && guess.zUp && !head.scene.statesUp) {
        options.zUp = true;
        head.words.emplace_back(
            "has its Z axis taken as up, along which it is high; --up y leaves it as it is");
    }
    return {};
}

}  // namespace

Result<ImportedHead> importHead(const std::string& path, const HeadImportOptions& options) {
    MeshImportOptions asRead;
    if (options.metresPerUnit > 0) asRead.metresPerUnit = options.metresPerUnit;
    auto scene = importScene(path, asRead);
    if (!scene) return tl::unexpected(scene.error());
    ImportedHead head{std::move(*scene), {}, options, {}};
    if (options.guessUnit || options.guessUp) {
        if (auto status = guessInto(path, head); !status) return tl::unexpected(status.error());
    }
    for (const std::vector<std::string>* words : {&head.scene.warnings, &head.words}) {
        for (const std::string& word : *words) log::warning("{}: {}", path, word);
    }
    const HeadImportOptions& taken = head.taken;
    if (taken.keepsMesh()) return head;
    if (taken.isTurned()) {
        if (!head.scene.clips.empty()) {
            head.words.push_back(
                fmt::format("is turned, so that its {} clips are left out", head.scene.clips.size()));
            log::warning("{}: {}", path, head.words.back());
        }
        head.scene.skeleton = {};
        head.scene.clips.clear();
        head.scene.skin = {};
        head.scene.morphs.clear();
    }
    auto part = partOfHead(head.scene.mesh, taken);
    if (!part) return tl::unexpected(inFile(part.error(), path));
    auto colliders = fitColliders(head.scene.mesh, head.scene.skeleton, taken);
    if (!colliders) return tl::unexpected(inFile(colliders.error(), path));
    head.colliders = std::move(*colliders);
    head.scene.skin = weightsOf(head.scene.skin, part->sourceVertices());
    head.scene.morphs = morphsOf(head.scene.morphs, part->sourceVertices());
    head.scene.mesh = std::move(*part);
    return head;
}

}  // namespace hairloom
