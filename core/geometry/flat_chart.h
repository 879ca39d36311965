// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A chart in work: a piece of the selection with vertices of its own, and what tells a good flat image from a
// folded one. Private to core/geometry.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/geometry/parameterization.h"

namespace hairloom {

/// Faces with vertices numbered for this piece alone; a mesh vertex on a cut, or where the piece only touches
/// itself, appears several times.
struct ChartPiece {
    FaceSet faces;
    std::vector<Triangle> triangles;  ///< per face, vertices of the piece
    std::vector<Vec3d> positions;     ///< per vertex of the piece, metres
};

/// Side i of face f of the piece runs from its corner i to the next and has the number 3f + i.
/// Returns per side the side across it, or kOpenSide.
inline constexpr std::uint32_t kOpenSide = ~0u;
std::vector<std::uint32_t> oppositeSides(const ScalpMesh& mesh, const FaceSet& faces);

/// Cuts an edge-connected set of faces open along a tree of edges until it is a disc. Nothing for a closed
/// surface of genus 0, which no tree of edges between borders and handles opens.
std::optional<ChartPiece> cutToDisc(const ScalpMesh& mesh, const FaceSet& faces);

/// A closed or badly laid set of at least two faces in two connected parts of about equal size.
std::pair<FaceSet, FaceSet> splitFaces(const ScalpMesh& mesh, const FaceSet& faces);

/// Corner UVs of a disc without folds: least squares conformal maps, else mean value coordinates on a circle,
/// else Tutte's on a circle. Nothing if rounding folds even these.
std::optional<std::vector<Vec2d>> flattenDisc(const ChartPiece& piece);

/// Segments in the plane by position.
class SegmentGrid {
  public:
    using Segment = std::array<Vec2d, 2>;
    explicit SegmentGrid(std::vector<Segment> segments);
    /// Numbers of the segments whose bounding boxes may meet the box, each once.
    void near(const Vec2d& low, const Vec2d& high, std::vector<std::uint32_t>& found) const;
    const std::vector<Segment>& segments() const { return segments_; }

  private:
    std::array<std::size_t, 2> cellOf(const Vec2d& p) const;
    std::vector<Segment> segments_;
    Vec2d low_ = Vec2d::Zero();
    double perCell_ = 1;
    std::size_t columns_ = 1, rows_ = 1;
    std::vector<std::vector<std::uint32_t>> cells_;
};

/// The sides of a chart that have no face of the chart across them, in its flat image.
std::vector<SegmentGrid::Segment> flatBorder(std::span<const std::uint32_t> opposite,
                                             std::span<const Vec2d> cornerUvs);

/// True when the flat image has positive area in every face, meets itself nowhere and winds once round each
/// inner vertex.
bool isInjective(std::span<const std::uint32_t> opposite, std::span<const Vec2d> cornerUvs);

/// Area-weighted mean of the ratio of singular values; infinite where a face is flat.
double meanStretch(const ScalpMesh& mesh, const FaceSet& faces, std::span<const Vec2d> cornerUvs);

}  // namespace hairloom
