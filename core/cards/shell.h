// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The far end: one closed surface around the hair, with its mean colours.

#include "core/cards/hair_light.h"

namespace hairloom::cards {

struct ShellVertex {
    Vec3f position_ws;
    Vec3f normal_ws;
    Vec3f along_ws;  ///< unit, mean direction of strands, root to tip
    Vec3f albedo;    ///< linear RGB
    float open = 1;
};
struct Shell {
    std::vector<ShellVertex> vertices;
    std::vector<std::uint32_t> indices;
};

/// Means of the hair over a grid, smoothed: what shells are cut from.
class ShellField {
  public:
    static ShellField make(const Hair& hair, const HairLight& light);
    /// The surface where the share of hair is `level` (0 … 1), of at most about `triangles` ≥ 64 triangles.
    Shell cut(float level, std::uint32_t triangles) const;

  private:
    struct Cell {
        float density = 0;
        float weight = 0;
        Vec3f along = Vec3f::Zero(), albedo = Vec3f::Zero();
        float open = 0;
    };
    std::size_t index(int x, int y, int z) const {
        return (static_cast<std::size_t>(z) * static_cast<std::size_t>(size_[1]) +
                static_cast<std::size_t>(y)) *
                   static_cast<std::size_t>(size_[0]) +
               static_cast<std::size_t>(x);
    }
    void smooth();
    ShellVertex vertexAt(const Vec3f& cellPlace) const;

    Vec3f low_ = Vec3f::Zero();
    float cell_ = 1;
    std::array<int, 3> size_{1, 1, 1};
    std::vector<Cell> cells_;
};

}  // namespace hairloom::cards
