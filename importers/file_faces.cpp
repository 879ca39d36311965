// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/file_faces.h"

#include <fmt/format.h>

#include <cmath>

namespace hairloom {
namespace {

constexpr std::uint64_t kMaxPoints = std::uint64_t{1} << 25u;   ///< of all meshes and their instances
constexpr std::uint64_t kMaxCorners = std::uint64_t{1} << 26u;  ///< likewise

/// What turns normals where `linear` moves points.
Mat3f turnOfNormals(const Mat3f& linear, bool isMirrored) {
    Mat3f turned;
    turned << linear.col(1).cross(linear.col(2)), linear.col(2).cross(linear.col(0)),
        linear.col(0).cross(linear.col(1));
    return isMirrored ? Mat3f(-turned) : turned;
}

}  // namespace

std::vector<Vec3f> pointsIn(std::span<const float> numbers, const Eigen::Affine3d& toWorld) {
    std::vector<Vec3f> points;
    points.reserve(numbers.size() / 3);
    for (std::size_t n = 0; n + 2 < numbers.size(); n += 3) {
        const Vec3d point(double{numbers[n]}, double{numbers[n + 1]}, double{numbers[n + 2]});
        points.push_back((toWorld * point).cast<float>());
    }
    return points;
}

Status FaceCollector::fits(const PolygonSoup& soup, std::size_t points, std::size_t corners) {
    if (soup.positions.size() + points <= kMaxPoints && soup.corners.size() + corners <= kMaxCorners)
        return {};
    return fail("its meshes and their instances have more points or corners than are read",
                fmt::format("expected at most {} points and {} corners", kMaxPoints, kMaxCorners));
}

void FaceCollector::add(const FileFaces& faces, const FacesInScene& in, PolygonSoup& soup) {
    const Mat3f turned =
        turnOfNormals(in.toWorld.linear().cast<float>(), in.toWorld.linear().determinant() < 0);
    // Corners of meshes without texture coordinates have them at 0 once another mesh has some.
    if (in.uvs) soup.uvs.resize(soup.corners.size(), Vec2f::Zero());
    const bool hasUvs = !soup.uvs.empty() || in.uvs;
    meshesWithoutUvs_ += !in.uvs;
    hasNormals_ = hasNormals_ && in.normals;
    for (std::size_t face = 0; face < faces.count(); ++face) {
        const std::uint32_t begin = faces.offsets[face], end = faces.offsets[face + 1];
        if (faces.isHole[face] != 0 || end - begin < 3) {
            (faces.isHole[face] != 0 ? holes_ : tooFewCorners_) += 1;
            continue;
        }
        for (std::uint32_t i = begin; i < end; ++i) {
            const std::uint32_t corner = in.isReversed ? end - 1 - (i - begin) : i;
            const std::uint32_t point = faces.corners[corner];
            soup.corners.push_back(in.firstPoint + point);
            if (hasUvs) {
                const float* const uv = in.uvs ? in.uvs->at(corner, point, face) : nullptr;
                const Vec2f found = uv == nullptr ? Vec2f::Zero() : Vec2f(uv[0], uv[1]);
                soup.uvs.push_back(found.allFinite() ? found : Vec2f::Zero());
            }
            if (hasNormals_) addNormal(in.normals->at(corner, point, face), turned, soup);
        }
        soup.offsets.push_back(static_cast<std::uint32_t>(soup.corners.size()));
        soup.faceGroups.push_back(in.groups[face]);
        soup.faceMaterials.push_back(in.materials[face]);
    }
}

void FaceCollector::addNormal(const float* numbers, const Mat3f& turned, PolygonSoup& soup) {
    Vec3f normal = Vec3f::Zero();
    if (numbers != nullptr) normal = turned * Vec3f(numbers[0], numbers[1], numbers[2]);
    const float length = normal.norm();
    badNormals_ += !(std::isfinite(length) && length > 0);
    soup.normals.push_back(normal / length);
}

void FaceCollector::finish(RawScene& scene, const char* sets) const {
    const auto tell = [&](std::size_t count, const std::string& what) {
        if (count > 0) scene.warnings.push_back(fmt::format("{} {}", count, what));
    };
    tell(tooFewCorners_, "faces with fewer than three corners were left out");
    tell(holes_, "faces that are holes were left out");
    tell(badSetFaces, fmt::format("faces of {} are not there", sets));
    if (!scene.soup.uvs.empty())
        tell(meshesWithoutUvs_, "meshes have no texture coordinates; those of their corners are (0, 0)");
    if (isCage) scene.warnings.emplace_back("subdivision surfaces are taken as the polygons of their cages");
    if (isSheared) scene.warnings.emplace_back("transforms that shear in time were taken without shear");
    if (hasNormals_) tell(badNormals_, "normals are unusable, so all are computed from the faces");
    if (!hasNormals_ || badNormals_ > 0) scene.soup.normals.clear();
}

}  // namespace hairloom
