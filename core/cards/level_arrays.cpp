// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cards/level_arrays.h"

#include <algorithm>

namespace hairloom::cards {
namespace {

/// The most that the tint of nearly all vertices is: it goes into the texture, for colours of vertices end
/// at 1.
float tintScale(const Cards& cards) {
    std::vector<float> most;
    for (const CardVertex& v : cards.mesh.vertices) most.push_back(v.tint.maxCoeff());
    const auto at = most.begin() + static_cast<std::ptrdiff_t>(most.size() * 98 / 100);
    std::nth_element(most.begin(), at, most.end());
    return std::max(1.0f, *at);
}

LevelArrays arraysOf(const Cards& cards, const Rig& rig) {
    LevelArrays a;
    a.albedoScale = tintScale(cards);
    for (const CardVertex& v : cards.mesh.vertices) {
        a.positions_ws.push_back(v.position_ws), a.normals_ws.push_back(v.normal_ws), a.uvs.push_back(v.uv);
        a.colours.push_back((v.tint / a.albedoScale).cwiseMin(1.0f));
        // glTF's tangent is the direction of u, and its bitangent that of -v in images whose rows go down.
        Vec3f across = v.normal_ws.cross(v.along_ws);
        across = (across - across.dot(v.normal_ws) * v.normal_ws).normalized();
        const float hand = v.normal_ws.cross(across).dot(-v.along_ws) < 0 ? -1.0f : 1.0f;
        a.tangents_ws.emplace_back(across.x(), across.y(), across.z(), hand);
    }
    const Binding binding = bind(rig, cards);
    a.joints = binding.joints, a.weights = binding.weights;
    a.indices = cards.mesh.indices;
    return a;
}

LevelArrays arraysOf(const Shell& shell) {
    LevelArrays a;
    for (const ShellVertex& v : shell.vertices) {
        a.positions_ws.push_back(v.position_ws), a.normals_ws.push_back(v.normal_ws);
        a.colours.push_back((v.open * v.albedo).cwiseMin(1.0f));
        a.joints.push_back({}), a.weights.emplace_back(1, 0, 0, 0);
    }
    a.indices = shell.indices;
    return a;
}

}  // namespace

LevelArrays arraysOf(const Level& level, const Rig& rig) {
    if (const auto* cards = std::get_if<Cards>(&level.content)) return arraysOf(*cards, rig);
    return arraysOf(std::get<Shell>(level.content));
}

Picture brightened(const Atlas& atlas, float scale) {
    Picture picture = atlas.levels[0];
    for (Texel& t : picture.texels) t.albedo = (scale * t.albedo).cwiseMin(1.0f);
    return picture;
}

}  // namespace hairloom::cards
