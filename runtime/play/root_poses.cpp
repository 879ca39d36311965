// SPDX-License-Identifier: MIT
#include "play/root_poses.h"

#include <cmath>

namespace hairloom::runtime {
namespace {

/// Columns: along the triangle's first edge, its normal, and across. All zero where it is flat.
struct TriangleFrame {
    Float3 along{}, normal{}, across{};
};

TriangleFrame frameOf(const asset::ScalpTriangle& triangle, std::span<const Float3> vertices) {
    const Float3 a = vertices[triangle.vertices[0]];
    const Float3 along = vertices[triangle.vertices[1]] - a;
    const Float3 normal = cross(along, vertices[triangle.vertices[2]] - a);
    const float edge = length(along), area = length(normal);
    if (!(edge > 0) || !(area > 0)) return {};
    TriangleFrame frame{along * (1 / edge), normal * (1 / area), {}};
    frame.across = cross(frame.along, frame.normal);
    return frame;
}

/// now · restᵀ; the identity where one of them is flat.
Matrix34 turnOf(const TriangleFrame& now, const TriangleFrame& rest) {
    if (now.normal == Float3{} || rest.normal == Float3{}) return kIdentity34;
    const auto row = [&](float along, float normal, float across) {
        return rest.along * along + rest.normal * normal + rest.across * across;
    };
    const Float3 x = row(now.along.x, now.normal.x, now.across.x),
                 y = row(now.along.y, now.normal.y, now.across.y),
                 z = row(now.along.z, now.normal.z, now.across.z);
    return {x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0};
}

constexpr std::size_t kVertexBytes = sizeof(asset::ScalpVertex) + 2 * sizeof(Float3);

Float3 pointOf(const asset::ScalpTriangle& triangle, const asset::Root& root,
               std::span<const Float3> vertices) {
    const float b = static_cast<float>(root.b) / 65535.0f, c = static_cast<float>(root.c) / 65535.0f;
    return vertices[triangle.vertices[0]] * (1 - b - c) + vertices[triangle.vertices[1]] * b +
           vertices[triangle.vertices[2]] * c;
}

/// The mean of its bones' matrices; of the head's where it hangs on none.
Float3 skinned(const asset::ScalpVertex& vertex, Float3 rest, std::span<const float> bones,
               const Matrix34& head) {
    float total = 0;
    for (const std::uint16_t weight : vertex.weights) total += static_cast<float>(weight);
    if (total == 0) return transform(head, rest);
    Matrix34 blend{};
    for (std::size_t i = 0; i < 4; ++i) {
        const float share = static_cast<float>(vertex.weights[i]) / total;
        if (share == 0) continue;
        for (std::size_t k = 0; k < 12; ++k) blend[k] += share * bones[12 * std::size_t{vertex.bones[i]} + k];
    }
    return transform(blend, rest);
}

}  // namespace

Float3 transform(const Matrix34& m, Float3 p) {
    return {m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3], m[4] * p.x + m[5] * p.y + m[6] * p.z + m[7],
            m[8] * p.x + m[9] * p.y + m[10] * p.z + m[11]};
}

Quat rotationOf(const Matrix34& m) {
    const auto at = [&](std::size_t row, std::size_t column) { return m[4 * row + column]; };
    float trace = at(0, 0) + (at(1, 1) + at(2, 2));
    if (trace > 0) {
        trace = std::sqrt(trace + 1);
        const float w = 0.5f * trace;
        trace = 0.5f / trace;
        return {(at(2, 1) - at(1, 2)) * trace, (at(0, 2) - at(2, 0)) * trace, (at(1, 0) - at(0, 1)) * trace,
                w};
    }
    std::size_t i = 0;
    if (at(1, 1) > at(0, 0)) i = 1;
    if (at(2, 2) > at(i, i)) i = 2;
    const std::size_t j = (i + 1) % 3, k = (j + 1) % 3;
    float t = std::sqrt(at(i, i) - at(j, j) - at(k, k) + 1);
    std::array<float, 3> v{};
    v[i] = 0.5f * t;
    t = 0.5f / t;
    v[j] = (at(j, i) + at(i, j)) * t;
    v[k] = (at(k, i) + at(i, k)) * t;
    return {v[0], v[1], v[2], (at(k, j) - at(j, k)) * t};
}

RootPoses::RootPoses(const Asset& asset, const Asset::Strands& strands)
    : roots_(asset.roots.begin(), asset.roots.end()),
      vertices_(asset.scalpVertices.begin(), asset.scalpVertices.end()),
      triangles_(asset.scalpTriangles.begin(), asset.scalpTriangles.end()),
      posed_(vertices_.size()),
      bones_(asset.bones.size()) {
    for (std::size_t s = 0; s < asset.strands.size(); ++s)
        restRoots_.push_back(strands.positions_ss[strands.offsets[s]]);
    for (const asset::ScalpVertex& vertex : vertices_)
        rest_.push_back({vertex.position[0], vertex.position[1], vertex.position[2]});
}

std::size_t RootPoses::bytes() const {
    return restRoots_.size() * sizeof(Float3) + roots_.size() * sizeof(asset::Root) +
           vertices_.size() * kVertexBytes + triangles_.size() * sizeof(asset::ScalpTriangle);
}

std::size_t RootPoses::bytesFor(const Asset& asset) {
    return asset.strands.size() * sizeof(Float3) + asset.roots.size() * sizeof(asset::Root) +
           asset.scalpVertices.size() * kVertexBytes +
           asset.scalpTriangles.size() * sizeof(asset::ScalpTriangle);
}

void RootPoses::followHead(const Matrix34& head, std::span<RootFrame> roots_ws) const {
    const Quat rotation = rotationOf(head);
    for (std::size_t s = 0; s < roots_ws.size(); ++s)
        roots_ws[s] = {transform(head, restRoots_[s]), rotation};
}

void RootPoses::followBones(std::span<const float> bones, const Matrix34& head,
                            std::span<RootFrame> roots_ws) {
    for (std::size_t v = 0; v < posed_.size(); ++v) posed_[v] = skinned(vertices_[v], rest_[v], bones, head);
    followPosed(roots_ws);
}

void RootPoses::followScalp(std::span<const float> vertices_ws, std::span<RootFrame> roots_ws) {
    for (std::size_t v = 0; v < posed_.size(); ++v)
        posed_[v] = {vertices_ws[3 * v], vertices_ws[3 * v + 1], vertices_ws[3 * v + 2]};
    followPosed(roots_ws);
}

void RootPoses::followPosed(std::span<RootFrame> roots_ws) const {
    for (std::size_t s = 0; s < roots_ws.size(); ++s) {
        const asset::ScalpTriangle& triangle = triangles_[roots_[s].triangle];
        Matrix34 turn = turnOf(frameOf(triangle, posed_), frameOf(triangle, rest_));
        const Float3 rest = pointOf(triangle, roots_[s], rest_), now = pointOf(triangle, roots_[s], posed_);
        const Float3 moved = now - transform(turn, rest);
        turn[3] = moved.x;
        turn[7] = moved.y;
        turn[11] = moved.z;
        roots_ws[s] = {transform(turn, restRoots_[s]), rotationOf(turn)};
    }
}

}  // namespace hairloom::runtime
