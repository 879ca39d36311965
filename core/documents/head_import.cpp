// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/documents/head_import.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "core/animation/bone_near.h"
#include "core/documents/open.h"
#include "core/editing/sphere_parts.h"
#include "core/geometry/selection.h"
#include "importers/length_unit.h"

namespace hairloom {
namespace {

/// A human, bust or head is higher than deep; one that is deeper by this lies.
constexpr float kLies = 1.15f;

bool isHelper(std::string name) {
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
    return name.find("helper") != std::string::npos || name.find("joint") != std::string::npos;
}

/// The triangles with what their corners and faces have; normals are computed anew.
PolygonSoup soupOf(const ScalpMesh& mesh, const FaceSet& faces, bool zUp) {
    PolygonSoup soup;
    for (const Vec3f& p : mesh.positions()) soup.positions.push_back(zUp ? Vec3f(p.x(), p.z(), -p.y()) : p);
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
    const double largest = static_cast<double>(size.maxCoeff());
    if (const LengthUnit* fits = fittingUnit(largest); implausibleSize(largest, 1) && fits)
        guess.unit = fits->name;
    guess.zUp = size.z() > kLies * size.y();
    return guess;
}

Result<ScalpMesh> partOfHead(const ScalpMesh& mesh, const HeadImportOptions& options) {
    std::vector<std::string> names = options.leaveOut;
    names.insert(names.end(), options.collideWith.begin(), options.collideWith.end());
    auto out = facesOfGroups(mesh, names);
    if (!out) return tl::unexpected(out.error());
    const FaceSet faces = invertSelection(mesh, *out);
    if (faces.empty() && options.collideWith.empty())
        return fail("all groups are left out", "keep at least one");
    if (faces.empty())
        return fail("no head is left: all groups are left out or set to collide",
                    "keep at least one as the head");
    return ScalpMesh::make(soupOf(mesh, faces, options.zUp));
}

Result<editing::SphereFit> fitColliders(const ScalpMesh& mesh, const Skeleton& skeleton,
                                        const HeadImportOptions& options,
                                        const std::atomic<bool>* cancelled) {
    if (options.collideWith.empty()) return editing::SphereFit{};
    for (const std::string& name : options.collideWith) {
        const auto faces = facesOfGroups(mesh, {&name, 1});
        if (!faces) return tl::unexpected(faces.error());
        if (faces->empty()) return fail(fmt::format("the group '{}' has no faces to collide with", name));
    }
    const auto faces = facesOfGroups(mesh, options.collideWith);
    if (!faces) return tl::unexpected(faces.error());
    const auto clothes = ScalpMesh::make(soupOf(mesh, *faces, options.zUp));
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

Result<ImportedHead> importHead(const std::string& path, const HeadImportOptions& options) {
    MeshImportOptions asRead;
    if (options.metresPerUnit > 0) asRead.metresPerUnit = options.metresPerUnit;
    auto scene = importSceneLoud(path, asRead);
    if (!scene) return tl::unexpected(scene.error());
    ImportedHead head{std::move(*scene), {}};
    if (options.keepsMesh()) return head;
    if (options.zUp) {
        head.scene.skeleton = {};
        head.scene.clips.clear();
        head.scene.skin = {};
    }
    auto part = partOfHead(head.scene.mesh, options);
    if (!part) return tl::unexpected(inFile(part.error(), path));
    auto colliders = fitColliders(head.scene.mesh, head.scene.skeleton, options);
    if (!colliders) return tl::unexpected(inFile(colliders.error(), path));
    head.colliders = std::move(*colliders);
    head.scene.skin = weightsOf(head.scene.skin, part->sourceVertices());
    head.scene.mesh = std::move(*part);
    return head;
}

}  // namespace hairloom
