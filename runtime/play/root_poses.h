// SPDX-License-Identifier: MIT
#pragma once
// Where a head's motion puts the roots of an asset, as the editor has it: the frame of a root's triangle now
// against that at rest.

#include <array>
#include <span>

#include "hairloom/asset.h"
#include "hairloom/memory.h"

namespace hairloom::runtime {

/// Three rows of four, row by row.
using Matrix34 = std::array<float, 12>;
inline constexpr Matrix34 kIdentity34{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

Float3 transform(const Matrix34& matrix, Float3 point);
/// Of a rotation matrix (Shoemake 1987).
Quat rotationOf(const Matrix34& matrix);

class RootPoses {
  public:
    /// Of an asset whose content is sound; keeps nothing of it.
    RootPoses(const Asset& asset, const Asset::Strands& strands);

    std::size_t scalpVertexCount() const { return vertices_.size(); }
    std::size_t boneCount() const { return bones_; }
    std::size_t bytes() const;
    static std::size_t bytesFor(const Asset& asset);
    std::span<const Float3> restRoots() const { return restRoots_; }
    /// Asset of a head that bones or vertices can move.
    bool hasScalp() const { return !roots_.empty(); }

    void followHead(const Matrix34& head, std::span<RootFrame> roots_ws) const;
    /// `bones`: 12 of each; vertices that hang on none follow the head. Fills the place of posed vertices.
    void followBones(std::span<const float> bones, const Matrix34& head, std::span<RootFrame> roots_ws);
    /// `vertices_ws`: 3 of each vertex of the scalp.
    void followScalp(std::span<const float> vertices_ws, std::span<RootFrame> roots_ws);

  private:
    void followPosed(std::span<RootFrame> roots_ws) const;

    Vector<Float3> restRoots_;
    Vector<asset::Root> roots_;  // empty without a scalp
    Vector<asset::ScalpVertex> vertices_;
    Vector<asset::ScalpTriangle> triangles_;
    Vector<Float3> rest_, posed_;  // of the vertices
    std::size_t bones_;
};

}  // namespace hairloom::runtime
