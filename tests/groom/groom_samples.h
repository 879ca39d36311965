// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Grooms and scalps that the tests of this room share.

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <numeric>
#include <span>

#include "core/base/random.h"
#include "core/geometry/closest_point.h"
#include "core/groom/groom.h"
#include "core/groom/time_line.h"

namespace hairloom {

/// Degrees between neighbouring segments.
inline float largestTurn(std::span<const Vec3f> points) {
    float largest = 0;
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
        const Vec3f a = points[i] - points[i - 1], b = points[i + 1] - points[i];
        largest = std::max(largest, std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / kPi);
    }
    return largest;
}

/// A subdivided octahedron on a sphere, with two groups and every array filled.
inline std::shared_ptr<const ScalpMesh> sphereScalp(float radius = 0.09f, int levels = 4,
                                                    const Vec3f& centre = Vec3f(0, 1.6f, 0)) {
    std::vector<Vec3f> points{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    std::vector<Triangle> triangles{{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                    {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (int level = 0; level < levels; ++level) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [found, isNew] =
                middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(points.size()));
            if (isNew) points.push_back((points[a] + points[b]).normalized());
            return found->second;
        };
        std::vector<Triangle> finer;
        for (const auto& [a, b, c] : triangles) {
            const std::uint32_t ab = middle(a, b);
            const std::uint32_t bc = middle(b, c);
            const std::uint32_t ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        triangles = std::move(finer);
    }
    ScalpMeshParts parts;
    for (const Vec3f& p : points) {
        parts.normals.push_back(p);
        parts.positions.push_back(centre + p * radius);
    }
    parts.sourceVertices.resize(points.size());
    std::iota(parts.sourceVertices.begin(), parts.sourceVertices.end(), 0u);
    parts.sourceFaces.resize(triangles.size());
    std::iota(parts.sourceFaces.begin(), parts.sourceFaces.end(), 0u);
    for (const Triangle& triangle : triangles) {
        for (const std::uint32_t v : triangle) parts.cornerUvs.push_back(points[v].head<2>());
        parts.triangleGroups.push_back(points[triangle[0]].y() > 0 ? 0 : 1);
        parts.triangleMaterials.push_back(0);
    }
    parts.triangles = std::move(triangles);
    parts.groupNames = {"scalp", "face"};
    parts.materialNames = {"skin"};
    parts.repairs = {{"duplicate vertices welded", 3}};
    auto mesh = ScalpMesh::fromParts(std::move(parts));
    EXPECT_TRUE(mesh) << mesh.error().message();
    return std::make_shared<const ScalpMesh>(std::move(*mesh));
}

/// Roots at random over the upper half of the sphere, straight strands along its normals.
inline Groom straightHair(const std::shared_ptr<const ScalpMesh>& scalp, std::size_t strands,
                          std::uint32_t points, float length, std::uint64_t seed = 5) {
    FaceSet selection;
    for (std::uint32_t t = 0; t < scalp->triangleCount(); ++t) {
        if (scalp->triangleNormal(t).y() > 0) selection.push_back(t);
    }
    Random random(seed);
    std::vector<std::uint32_t> offsets{0};
    std::vector<Vec3f> positions;
    std::vector<SurfacePoint> roots;
    for (std::size_t s = 0; s < strands; ++s) {
        const std::uint32_t triangle = selection[random.below(static_cast<std::uint32_t>(selection.size()))];
        const float u = std::sqrt(random.uniform());
        const float v = random.uniform();
        roots.push_back({triangle, Vec3f(1 - u, u * (1 - v), u * v)});
        const Vec3f root = scalp->pointAt(triangle, roots.back().barycentric);
        const Vec3f along = scalp->normalAt(triangle, roots.back().barycentric) * length;
        for (std::uint32_t p = 0; p < points; ++p) {
            positions.push_back(root + along * (static_cast<float>(p) / static_cast<float>(points - 1)));
        }
        offsets.push_back(static_cast<std::uint32_t>(positions.size()));
    }
    Groom groom = makeGroom(std::move(offsets), std::move(positions));
    groom.setRootBindings(roots);
    std::vector<std::uint32_t> ids(strands);
    std::iota(ids.begin(), ids.end(), 100u);
    groom.strandAttributes.set(attribute::kStrandId, std::move(ids));
    groom.scalp = scalp;
    groom.scalpSelection = std::move(selection);
    return groom;
}

/// A card shaped by hand at random; pinned in one of two cases.
inline CardEdit anyCardEdit(Random& random) {
    const auto anywhere = [&] { return Vec3f(random.uniform(), random.uniform(), random.uniform()); };
    CardEdit edit;
    edit.level = 1 + random.below(300);
    edit.roots.resize(1 + random.below(5));
    for (Vec3f& root : edit.roots) root = anywhere();
    edit.width = random.uniform(0.5f, 2), edit.bend = random.uniform(-1, 1);
    edit.deleted = random.below(4) == 0;
    if (random.below(2) == 0) edit.strip.resize(kCardStations);
    for (CardStation& station : edit.strip)
        station = {anywhere(), (anywhere() + Vec3f::Constant(0.1f)).normalized(),
                   random.uniform(0.001f, 0.02f), random.uniform(-10, 10), random.uniform(0, 1e-4f)};
    return edit;
}

/// A small groom in which nothing is at its default.
inline Groom fullGroom() {
    Groom groom = straightHair(sphereScalp(0.09f, 1), 5, 4, 0.1f);
    groom.pointAttributes.set(attribute::kRadius, std::vector<float>(20, 4e-5f));
    groom.pointAttributes.set("mine/weights", std::vector<Vec4f>(20, Vec4f(1, 2, 3, 4)));
    groom.strandAttributes.set(attribute::kGroup, std::vector<std::uint32_t>{0, 1, 1, 0, 1});
    groom.strandAttributes.set(attribute::kLayer, std::vector<std::uint32_t>{0, 1, 0, 1, 0});
    groom.strandAttributes.set(attribute::kGuide, std::vector<std::uint8_t>{1, 0, 0, 0, 1});
    groom.strandAttributes.set(attribute::kFrozen, std::vector<std::uint8_t>{0, 1, 0, 0, 0});
    groom.strandAttributes.set(attribute::kRootUv, std::vector<Vec2f>(5, Vec2f(0.25f, 0.5f)));
    groom.strandAttributes.set("signed", std::vector<std::int32_t>{-1, 2, -3, 4, -5});
    HairMaterial ofFringe;
    ofFringe.shadingModel = ShadingModel::sadeghi;
    ofFringe.rootColour = Vec3f(0.6f, 0.4f, 0.125f);
    groom.layers = {{"Top", true, false, 1, {}}, {"Fringe \"β\"", false, true, 0.3f, ofFringe}};
    groom.groupNames = {"front", "back"};
    groom.spheres = {{"head", Vec3f(0, 1.6f, 0), 0.095f, "Head"},
                     {"neck", Vec3f(0.01f, 1.45f, 0), 0.06f, "", 0}};
    groom.material.shadingModel = ShadingModel::marschner;
    groom.material.rootRadius = 0.00003f;
    groom.material.tipColour = Vec3f(0.1f, 0.7f, 0.3f);
    groom.simulation.substeps = 11;
    const runtime::Ramp::Key keys[] = {{0, 0.7f}, {0.123f, 1}, {0.6f, 0.05f}, {1, 0.3f}};
    groom.simulation.angularCurve = runtime::Ramp::of(keys);
    groom.simulation.gravity = {0.1f, -9.7f, 0.3f};
    groom.interpolation.followPerGuide = 12;
    groom.interpolation.seed = 0xfedcba9876543210ull;
    groom.placement = {PlacementMethod::random, 1234, 7.5f, 0.2f, 9, 77};
    Random random(9);
    groom.cardEdits = {anyCardEdit(random), anyCardEdit(random)};
    groom.cardEdits[0].strip.clear();
    groom.cardEdits[1].strip.assign(kCardStations, {Vec3f(0, 1.7f, 0.1f), Vec3f::UnitX(), 0.01f, -3, 2e-5f});
    TimeLine line;
    line.framesPerSecond = 23.976f;
    line.start = 0.25f, line.end = 7, line.preRoll = 12, line.loop = false;
    line.clips = {{"Walk \"β\"", 0, 0.5f, 2, 1.25f, true, 0}, {"Run", 2.5f, 0, 0, 1, false, 0.75f}};
    line.head = {{0, Vec3d::Zero(), Vec3f(0, 2, 0), 30, KeyInterpolation::step},
                 {1.5f, Vec3d(0.1, 1e5, -2), Vec3f::UnitX(), -400, KeyInterpolation::smooth}};
    line.wind = {{0.1f, Vec3f(3, 0, 0.7f), KeyInterpolation::linear}};
    line.settings = {{"simulation.gravity", {{0, Vec3d(0, -9.5, 1), KeyInterpolation::smooth}}},
                     {"simulation.windKind", {{2, Vec3d(1, 0, 0), KeyInterpolation::step}}}};
    groom.timeLine = std::make_shared<const TimeLine>(std::move(line));
    groom.scalpDensity.assign(groom.scalp->vertexCount(), 0.25f);
    groom.triangulation.triangles = {{0, 1, 2}, {2, 1, 3}};
    groom.triangulation.coincident = {{4, 0}};
    groom.triangulation.alone = {3};
    groom.scalpExpression = "group:scalp,cap:90";
    groom.characterFile = "heads/bust.glb";
    return groom;
}

}  // namespace hairloom
