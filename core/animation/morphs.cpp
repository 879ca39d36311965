// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/animation/morphs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace hairloom {
namespace {

/// Its length is twice the triangle's area.
Vec3f facing(std::span<const Vec3f> positions, const Triangle& corners) {
    const Vec3f& a = positions[corners[0]];
    return (positions[corners[1]] - a).cross(positions[corners[2]] - a);
}

Vec3f unitOr(const Vec3f& v, const Vec3f& otherwise) {
    const float length = v.norm();
    return std::isfinite(length) && length > 0 ? Vec3f(v / length) : otherwise;
}

}  // namespace

Status validate(std::span<const MorphTarget> targets, std::size_t vertexCount) {
    for (const MorphTarget& target : targets) {
        if (target.vertices.size() != target.offsets.size())
            return fail(fmt::format("morph target '{}' has {} offsets for {} vertices", target.name,
                                    target.offsets.size(), target.vertices.size()));
        const auto beyond =
            std::ranges::find_if(target.vertices, [&](std::uint32_t v) { return v >= vertexCount; });
        if (beyond != target.vertices.end())
            return fail(fmt::format("morph target '{}' moves vertex {}", target.name, *beyond),
                        fmt::format("there are {} vertices", vertexCount));
        if (!std::isfinite(target.restWeight) ||
            !std::ranges::all_of(target.offsets, [](const Vec3f& offset) { return offset.allFinite(); }))
            return fail(fmt::format("morph target '{}' has numbers that are not finite", target.name));
    }
    return {};
}

std::vector<MorphTarget> morphsOf(std::span<const MorphTarget> targets,
                                  std::span<const std::uint32_t> vertices, std::size_t most) {
    std::vector<MorphTarget> some;
    if (targets.empty()) return some;
    // Where each vertex has gone, vertex after vertex.
    std::size_t count = 0;
    for (const std::uint32_t from : vertices) count = std::max<std::size_t>(count, std::size_t{from} + 1);
    std::vector<std::size_t> first(count + 1, 0);
    for (const std::uint32_t from : vertices) ++first[std::size_t{from} + 1];
    for (std::size_t v = 0; v < count; ++v) first[v + 1] += first[v];
    std::vector<std::uint32_t> gone(vertices.size());
    std::vector<std::size_t> next(first.begin(), first.end());
    for (std::uint32_t to = 0; to < vertices.size(); ++to) gone[next[vertices[to]]++] = to;

    const auto copiesOf = [&](std::uint32_t from) {
        return std::span(gone).subspan(from < count ? first[from] : 0,
                                       from < count ? first[from + 1] - first[from] : 0);
    };
    std::size_t left = most;
    for (const MorphTarget& target : targets) {
        MorphTarget& moved = some.emplace_back();
        moved.name = target.name;
        moved.restWeight = target.restWeight;
        std::size_t copies = 0;
        for (const std::uint32_t from : target.vertices) copies += copiesOf(from).size();
        if (copies > left) continue;
        left -= copies;
        for (std::size_t i = 0; i < target.vertices.size(); ++i) {
            for (const std::uint32_t to : copiesOf(target.vertices[i])) {
                moved.vertices.push_back(to);
                moved.offsets.push_back(target.offsets[i]);
            }
        }
    }
    return some;
}

std::vector<float> blended(std::span<const MorphTarget> targets, std::span<const float> from,
                           std::span<const float> to, float share) {
    std::vector<float> weights;
    if (from.empty() && to.empty()) return weights;
    for (std::size_t t = 0; t < targets.size(); ++t) {
        const float a = from.empty() ? targets[t].restWeight : from[t];
        const float b = to.empty() ? targets[t].restWeight : to[t];
        weights.push_back(a + share * (b - a));
    }
    return weights;
}

std::vector<Vec3f> morphedPositions(std::span<const Vec3f> rest, std::span<const MorphTarget> targets,
                                    std::span<const float> weights) {
    assert(weights.size() == targets.size());
    std::vector<Vec3f> positions;
    for (std::size_t t = 0; t < targets.size(); ++t) {
        const float weight = weights[t] - targets[t].restWeight;
        if (weight == 0) continue;
        if (positions.empty()) positions.assign(rest.begin(), rest.end());
        for (std::size_t i = 0; i < targets[t].vertices.size(); ++i)
            positions[targets[t].vertices[i]] += weight * targets[t].offsets[i];
    }
    return positions;
}

std::vector<Vec3f> morphedNormals(const ScalpMesh& mesh, std::span<const Vec3f> positions) {
    const auto rest = mesh.positions();
    const auto triangles = mesh.triangles();
    assert(positions.size() == rest.size());
    std::vector<bool> isAtMoved(rest.size(), false);
    for (const Triangle& triangle : triangles) {
        if (std::ranges::none_of(triangle, [&](std::uint32_t v) { return positions[v] != rest[v]; }))
            continue;
        for (const std::uint32_t v : triangle) isAtMoved[v] = true;
    }
    std::vector<Vec3f> before(rest.size(), Vec3f::Zero()), now(rest.size(), Vec3f::Zero());
    for (const Triangle& triangle : triangles) {
        if (std::ranges::none_of(triangle, [&](std::uint32_t v) { return bool(isAtMoved[v]); })) continue;
        const Vec3f facedBefore = facing(rest, triangle), facesNow = facing(positions, triangle);
        for (const std::uint32_t v : triangle) before[v] += facedBefore, now[v] += facesNow;
    }
    std::vector<Vec3f> normals(mesh.normals().begin(), mesh.normals().end());
    for (std::size_t v = 0; v < normals.size(); ++v) {
        if (!isAtMoved[v]) continue;
        const Vec3f turned = unitOr(now[v], Vec3f::Zero()) - unitOr(before[v], Vec3f::Zero());
        normals[v] = unitOr(normals[v] + turned, normals[v]);
    }
    return normals;
}

}  // namespace hairloom
