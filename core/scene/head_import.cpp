// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/head_import.h"

#include <algorithm>
#include <cctype>

#include "core/geometry/selection.h"
#include "core/scene/open.h"
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
    const auto skin = partOfHead(scene.mesh, {0, false, guess.helpers});
    const Vec3f size = (skin ? *skin : scene.mesh).bounds().sizes();
    const double largest = static_cast<double>(size.maxCoeff());
    if (const LengthUnit* fits = fittingUnit(largest); implausibleSize(largest, 1) && fits)
        guess.unit = fits->name;
    guess.zUp = size.z() > kLies * size.y();
    return guess;
}

Result<ScalpMesh> partOfHead(const ScalpMesh& mesh, const HeadImportOptions& options) {
    auto out = facesOfGroups(mesh, options.leaveOut);
    if (!out) return tl::unexpected(out.error());
    const FaceSet faces = invertSelection(mesh, *out);
    if (faces.empty()) return fail("all groups are left out", "keep at least one");
    return ScalpMesh::make(soupOf(mesh, faces, options.zUp));
}

Result<ImportedScene> importHead(const std::string& path, const HeadImportOptions& options) {
    MeshImportOptions asRead;
    if (options.metresPerUnit > 0) asRead.metresPerUnit = options.metresPerUnit;
    auto scene = importSceneLoud(path, asRead);
    if (!scene || options.keepsMesh()) return scene;
    auto part = partOfHead(scene->mesh, options);
    if (!part) return tl::unexpected(inFile(part.error(), path));
    ImportedScene taken;
    taken.mesh = std::move(*part);
    taken.warnings = std::move(scene->warnings);
    taken.format = std::move(scene->format);
    taken.metresPerUnit = scene->metresPerUnit;
    return taken;
}

}  // namespace hairloom
