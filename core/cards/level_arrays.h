// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A level of cards or a shell as arrays, as files of meshes hold it.

#include <array>
#include <vector>

#include "core/cards/levels.h"

namespace hairloom::cards {

/// One entry a vertex; no uvs and tangents in a shell, which has no texture.
struct LevelArrays {
    std::vector<Vec3f> positions_ws, normals_ws;  ///< metres; unit
    std::vector<Vec3f> colours;                   ///< linear, 0 … 1
    std::vector<Vec2f> uvs;                       ///< v from the upper edge of the texture down
    std::vector<Vec4f> tangents_ws;               ///< direction of u, and 1 or -1 as glTF has it
    std::vector<std::array<std::uint16_t, 4>> joints;
    std::vector<Vec4f> weights;          ///< ≥ 0, sum 1
    std::vector<std::uint32_t> indices;  ///< three a triangle, counterclockwise from outside
    /// Colours end at 1: what they would be more by is to be in the texture's albedo.
    float albedoScale = 1;
};
/// Of a level that is no strands.
LevelArrays arraysOf(const Level& level, const Rig& rig);

/// The finest level of an atlas with albedo so many times as bright.
Picture brightened(const Atlas& atlas, float scale);

}  // namespace hairloom::cards
