// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Hair that was written as polygons: flat ribbons and tubes, a connected piece for each strand, and how the
// vertices of a piece follow each other.

#include <cstdint>
#include <span>
#include <vector>

#include "importers/raw_strands.h"

namespace hairloom {

/// A piece is a grid of rows, the cross-sections from end to end, and of as many columns as a row has
/// vertices. Tubes may end in a vertex that stands alone: a tip, or the middle of a lid.
struct StrandGrid {
    enum class Alone : std::uint8_t { None, LastAtTip, FirstAtRoot, FirstAndLast, LastTwo, LastAtRoot };
    std::uint32_t sides = 2;  ///< vertices of a row, ≥ 2
    RibbonOrder order =
        RibbonOrder::Interleaved;  ///< row after row, column after column, or around (two sides)
    Alone alone = Alone::None;
    bool operator==(const StrandGrid&) const = default;

    std::uint32_t aloneBefore() const;  ///< vertices before the grid
    std::uint32_t aloneAfter() const;   ///< vertices behind it
    /// Rows of a piece of so many vertices; 0 where they make no grid of two rows or more.
    std::uint32_t rows(std::uint32_t vertices) const;
    /// Of a vertex, counted from the piece's first.
    std::uint32_t rowOf(std::uint32_t vertex, std::uint32_t vertices) const;
    /// The vertex in a row and a column.
    std::uint32_t vertexAt(std::uint32_t row, std::uint32_t column, std::uint32_t rows) const;
};

/// The pieces of a mesh. Errors: a vertex of no face.
struct StrandPieces {
    std::vector<std::uint32_t> vertexOffsets{0}, vertices;  ///< of each piece, ascending
    std::vector<std::uint32_t> faceOffsets{0}, faces;       ///< likewise
    std::vector<std::uint32_t> placeOf;                     ///< of each vertex within its piece

    std::size_t count() const { return vertexOffsets.size() - 1; }
    std::span<const std::uint32_t> verticesOf(std::size_t piece) const {
        return std::span(vertices).subspan(vertexOffsets[piece],
                                           vertexOffsets[piece + 1] - vertexOffsets[piece]);
    }
};
Result<StrandPieces> findPieces(const std::string& file, const ObjStrandText& obj);

/// The grid of every piece: one for all where one fits them all, of the fewest sides and then the narrowest.
/// `asked` limits the order of ribbons. Errors: a piece that is none, with the line of a face.
Result<std::vector<StrandGrid>> findGrids(const std::string& file, const ObjStrandText& obj,
                                          const StrandPieces& pieces, RibbonOrder asked);

/// As findGrids(), of flat ribbons alone; pieces may be without faces.
Result<std::vector<StrandGrid>> findRibbons(const std::string& file, const ObjStrandText& obj,
                                            const StrandPieces& pieces, RibbonOrder asked);

/// How ribbons without faces follow each other in a run of vertices, where distances tell: the segments of
/// each, 0 where they do not.
struct RibbonRun {
    std::uint32_t segments = 0;
    RibbonOrder order = RibbonOrder::Detect;
};
RibbonRun guessRibbons(std::span<const Vec3f> vertices, RibbonOrder asked);

}  // namespace hairloom
