// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/raw_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hairloom {
namespace {

Status validateNames(const std::vector<std::uint32_t>& perFace, const std::vector<std::string>& names,
                     std::size_t faces, const char* what) {
    if (perFace.empty()) return {};
    if (perFace.size() != faces)
        return fail(fmt::format("{} {} entries for {} faces", perFace.size(), what, faces));
    const auto beyond =
        std::ranges::find_if(perFace, [&](std::uint32_t index) { return index >= names.size(); });
    if (beyond == perFace.end()) return {};
    return fail(fmt::format("face {} is in {} {}", beyond - perFace.begin(), what, *beyond),
                fmt::format("there are {}", names.size()));
}

Status validateFaces(const PolygonSoup& soup) {
    if (soup.offsets.size() < 2) {
        return fail(fmt::format("has no faces ({} points)", soup.positions.size()),
                    "expected a mesh with polygons");
    }
    if (soup.offsets.front() != 0 || soup.offsets.back() != soup.corners.size() ||
        !std::ranges::is_sorted(soup.offsets)) {
        return fail("the faces' corner ranges do not follow one another");
    }
    for (std::size_t corner = 0; corner < soup.corners.size(); ++corner) {
        if (soup.corners[corner] < soup.positions.size()) continue;
        const auto face = std::ranges::upper_bound(soup.offsets, corner) - soup.offsets.begin() - 1;
        return fail(fmt::format("face {} refers to vertex {}", face, soup.corners[corner]),
                    fmt::format("there are {} vertices", soup.positions.size()));
    }
    return {};
}

/// The number of faces that use a position which is not finite.
std::size_t facesWithoutPlace(const PolygonSoup& soup) {
    std::size_t count = 0;
    for (std::size_t face = 0; face + 1 < soup.offsets.size(); ++face) {
        const auto begin = soup.corners.begin() + soup.offsets[face];
        const auto end = soup.corners.begin() + soup.offsets[face + 1];
        count += std::any_of(begin, end,
                             [&](std::uint32_t vertex) { return !soup.positions[vertex].allFinite(); });
    }
    return count;
}

}  // namespace

void scaleLengths(RawScene& scene, float factor) {
    if (factor == 1.0f) return;
    for (Vec3f& position : scene.soup.positions) position *= factor;
    for (MorphTarget& target : scene.morphs) {
        for (Vec3f& offset : target.offsets) offset *= factor;
    }
    for (Bone& bone : scene.bones) {
        bone.rest.translation() *= factor;
        bone.inverseBind.translation() *= factor;
    }
    for (Clip& clip : scene.clips) {
        for (Channel& channel : clip.channels) {
            for (Vec3f& value : channel.translation.values) value *= factor;
        }
    }
}

Status validate(const RawScene& scene) {
    const PolygonSoup& soup = scene.soup;
    if (auto status = validateFaces(soup); !status) return status;
    const std::size_t faces = soup.offsets.size() - 1;
    if (!soup.uvs.empty() && soup.uvs.size() != soup.corners.size()) {
        return fail(
            fmt::format("{} texture coordinates for {} corners", soup.uvs.size(), soup.corners.size()));
    }
    if (!soup.normals.empty() && soup.normals.size() != soup.corners.size()) {
        return fail(fmt::format("{} normals for {} corners", soup.normals.size(), soup.corners.size()));
    }
    if (auto status = validateNames(soup.faceGroups, soup.groupNames, faces, "group"); !status) return status;
    if (auto status = validateNames(soup.faceMaterials, soup.materialNames, faces, "material"); !status) {
        return status;
    }
    if (const std::size_t count = facesWithoutPlace(soup)) {
        return fail(
            fmt::format("{} of {} faces have a coordinate that is not a finite number", count, faces));
    }
    if (scene.skin.vertexCount() != 0 && scene.skin.vertexCount() != soup.positions.size()) {
        return fail(fmt::format("skin weights for {} of {} vertices", scene.skin.vertexCount(),
                                soup.positions.size()));
    }
    if (auto status = validate(scene.skin, scene.bones.size()); !status) return status;
    if (auto status = validate(scene.morphs, soup.positions.size()); !status) return status;
    const auto skeleton = Skeleton::make(scene.bones);
    if (!skeleton) return tl::unexpected(skeleton.error());
    for (const Clip& clip : scene.clips) {
        if (auto status = validate(clip, *skeleton, scene.morphs.size()); !status) return status;
    }
    return {};
}

}  // namespace hairloom
