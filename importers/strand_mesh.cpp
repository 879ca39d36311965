// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/strand_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "importers/points_per_strand.h"

namespace hairloom {
namespace {

using Alone = StrandGrid::Alone;

constexpr std::uint32_t kMostSides = 64;

class DisjointSets {
  public:
    explicit DisjointSets(std::size_t count) : parents_(count) {
        std::iota(parents_.begin(), parents_.end(), 0u);
    }
    std::uint32_t find(std::uint32_t element) {
        while (parents_[element] != element) {
            parents_[element] = parents_[parents_[element]];
            element = parents_[element];
        }
        return element;
    }
    /// The lowest element represents its set.
    void join(std::uint32_t a, std::uint32_t b) {
        a = find(a);
        b = find(b);
        parents_[std::max(a, b)] = std::min(a, b);
    }

  private:
    std::vector<std::uint32_t> parents_;
};

std::span<const std::uint32_t> cornersOf(const ObjStrandText& obj, std::size_t face) {
    return std::span(obj.faceIndices)
        .subspan(obj.faceOffsets[face], obj.faceOffsets[face + 1] - obj.faceOffsets[face]);
}

std::uint32_t sizeOf(const StrandPieces& pieces, std::size_t piece) {
    return pieces.vertexOffsets[piece + 1] - pieces.vertexOffsets[piece];
}

/// The first face of a piece, by its place among the piece's, that lies across more than two neighbouring
/// rows; the number of faces where there is none.
std::uint32_t firstMisfit(const ObjStrandText& obj, const StrandPieces& pieces, std::size_t piece,
                          const StrandGrid& grid) {
    const std::uint32_t vertices = sizeOf(pieces, piece), begin = pieces.faceOffsets[piece];
    const std::uint32_t count = pieces.faceOffsets[piece + 1] - begin;
    if (grid.rows(vertices) == 0) return 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        std::uint32_t low = vertices, high = 0;
        for (const std::uint32_t corner : cornersOf(obj, pieces.faces[begin + i])) {
            const std::uint32_t row = grid.rowOf(pieces.placeOf[corner], vertices);
            low = std::min(low, row);
            high = std::max(high, row);
        }
        if (high > low + 1) return i;
    }
    return count;
}

bool fits(const ObjStrandText& obj, const StrandPieces& pieces, std::size_t piece, const StrandGrid& grid) {
    return firstMisfit(obj, pieces, piece, grid) == pieces.faceOffsets[piece + 1] - pieces.faceOffsets[piece];
}

std::vector<StrandGrid> fittingGrids(const ObjStrandText& obj, const StrandPieces& pieces, std::size_t piece,
                                     RibbonOrder asked) {
    std::vector<StrandGrid> found;
    const auto tryOne = [&](const StrandGrid& grid) {
        if (asked != RibbonOrder::Detect && grid.order != asked) return;
        if (fits(obj, pieces, piece, grid)) found.push_back(grid);
    };
    for (const RibbonOrder order :
         {RibbonOrder::Interleaved, RibbonOrder::EdgeAfterEdge, RibbonOrder::Around})
        tryOne({2, order, Alone::None});
    // An order that somebody names is that of a ribbon's two edges.
    if (asked != RibbonOrder::Detect) return found;
    for (std::uint32_t sides = 3; sides <= std::min(kMostSides, sizeOf(pieces, piece) / 2); ++sides) {
        for (const Alone alone : {Alone::None, Alone::LastAtTip, Alone::FirstAtRoot, Alone::FirstAndLast,
                                  Alone::LastTwo, Alone::LastAtRoot}) {
            for (const RibbonOrder order : {RibbonOrder::Interleaved, RibbonOrder::EdgeAfterEdge})
                tryOne({sides, order, alone});
        }
    }
    return found;
}

struct Shape {
    double length = 0;  ///< of the line through the rows' middles
    double width = 0;   ///< sum of the rows' largest distances from their first vertex
    double widest = 0;  ///< of these
};

Shape shapeOf(const ObjStrandText& obj, const StrandPieces& pieces, std::size_t piece,
              const StrandGrid& grid) {
    const auto vertices = pieces.verticesOf(piece);
    const std::uint32_t rows = grid.rows(static_cast<std::uint32_t>(vertices.size()));
    Shape shape;
    Vec3f before = Vec3f::Zero();
    for (std::uint32_t row = 0; row < rows; ++row) {
        const Vec3f& first = obj.vertices[vertices[grid.vertexAt(row, 0, rows)]];
        Vec3f middle = Vec3f::Zero();
        double width = 0;
        for (std::uint32_t column = 0; column < grid.sides; ++column) {
            const Vec3f& at = obj.vertices[vertices[grid.vertexAt(row, column, rows)]];
            middle += at / static_cast<float>(grid.sides);
            width = std::max(width, static_cast<double>((at - first).norm()));
        }
        if (row > 0) shape.length += static_cast<double>((middle - before).norm());
        before = middle;
        if (!std::isfinite(width)) continue;
        shape.width += width;
        shape.widest = std::max(shape.widest, width);
    }
    return shape;
}

double widthOf(const ObjStrandText& obj, const StrandPieces& pieces, const StrandGrid& grid) {
    double width = 0;
    for (std::size_t piece = 0; piece < pieces.count(); ++piece)
        width += shapeOf(obj, pieces, piece, grid).width;
    return width;
}

/// Those of the fewest sides come first, which of the same are the narrowest.
template <class Width>
StrandGrid best(std::span<const StrandGrid> grids, Width width) {
    const auto lonely = [](const StrandGrid& grid) { return grid.aloneBefore() + grid.aloneAfter(); };
    return *std::ranges::min_element(grids, [&](const StrandGrid& a, const StrandGrid& b) {
        if (a.sides != b.sides) return a.sides < b.sides;
        if (lonely(a) != lonely(b)) return lonely(a) < lonely(b);
        return width(a) < width(b);
    });
}

/// A flat ribbon has a border; a closed surface has none.
bool hasBorder(const ObjStrandText& obj, const StrandPieces& pieces, std::size_t piece) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (std::uint32_t i = pieces.faceOffsets[piece]; i < pieces.faceOffsets[piece + 1]; ++i) {
        const auto corners = cornersOf(obj, pieces.faces[i]);
        for (std::size_t c = 0; c < corners.size(); ++c)
            edges.push_back(std::minmax({corners[c], corners[(c + 1) % corners.size()]}));
    }
    std::ranges::sort(edges);
    for (auto edge = edges.begin(); edge != edges.end();) {
        const auto next = std::upper_bound(edge, edges.end(), *edge);
        if (next - edge == 1) return true;
        edge = next;
    }
    return edges.empty();
}

/// Strands are longer than wide; what is not is some other mesh. Flat ribbons may be as wide as cards are.
Status checkSlender(const std::string& file, const ObjStrandText& obj, const StrandPieces& pieces,
                    std::span<const StrandGrid> grids) {
    constexpr double kSlender = 2;
    double length = 0, width = 0;
    for (std::size_t piece = 0; piece < pieces.count(); ++piece) {
        if (grids[piece].sides == 2 && hasBorder(obj, pieces, piece)) return {};
        const Shape shape = shapeOf(obj, pieces, piece, grids[piece]);
        if (!std::isfinite(shape.length)) continue;
        length += shape.length;
        width += shape.widest;
    }
    if (length >= kSlender * width) return {};
    return failIn(
        file, {},
        fmt::format("its {} connected pieces are {:.3g} units long and {:.3g} wide (mean)", pieces.count(),
                    length / static_cast<double>(pieces.count()),
                    width / static_cast<double>(pieces.count())),
        "expected slender tubes or a hair ribbon for each strand, or OBJ lines; open a head as a head");
}

tl::unexpected<Error> noGrid(const std::string& file, const ObjStrandText& obj, const StrandPieces& pieces,
                             std::size_t piece, RibbonOrder asked) {
    const auto vertices = pieces.verticesOf(piece);
    std::uint32_t farthest = 0;
    for (const RibbonOrder order :
         {RibbonOrder::Interleaved, RibbonOrder::EdgeAfterEdge, RibbonOrder::Around}) {
        if (asked == RibbonOrder::Detect || asked == order)
            farthest = std::max(farthest, firstMisfit(obj, pieces, piece, {2, order, Alone::None}));
    }
    const std::uint32_t begin = pieces.faceOffsets[piece];
    const std::uint32_t face = pieces.faces[std::min(begin + farthest, pieces.faceOffsets[piece + 1] - 1)];
    return failIn(
        file, Line{obj.faceLines[face]},
        "this face is not between neighbouring cross-sections of one hair ribbon or tube",
        fmt::format("expected the {} vertices that faces join with vertex {} to be a strand, or OBJ "
                    "lines",
                    vertices.size(), vertices.front() + 1));
}

}  // namespace

std::uint32_t StrandGrid::aloneBefore() const {
    return alone == Alone::FirstAtRoot || alone == Alone::FirstAndLast ? 1 : 0;
}

std::uint32_t StrandGrid::aloneAfter() const {
    if (alone == Alone::LastTwo) return 2;
    return alone == Alone::None || alone == Alone::FirstAtRoot ? 0 : 1;
}

std::uint32_t StrandGrid::rows(std::uint32_t vertices) const {
    const std::uint32_t lonely = aloneBefore() + aloneAfter();
    if (vertices < lonely + 2 * sides || (vertices - lonely) % sides != 0) return 0;
    return (vertices - lonely) / sides;
}

std::uint32_t StrandGrid::rowOf(std::uint32_t vertex, std::uint32_t vertices) const {
    const std::uint32_t count = rows(vertices), end = vertices - aloneAfter();
    if (vertex < aloneBefore()) return 0;
    if (vertex >= end) {
        const bool isRoot = alone == Alone::LastAtRoot || (alone == Alone::LastTwo && vertex == end);
        return isRoot ? 0 : count - 1;
    }
    const std::uint32_t place = vertex - aloneBefore();
    if (order == RibbonOrder::EdgeAfterEdge) return place % count;
    if (order == RibbonOrder::Around) return std::min(place, 2 * count - 1 - place);
    return place / sides;
}

std::uint32_t StrandGrid::vertexAt(std::uint32_t row, std::uint32_t column, std::uint32_t rows) const {
    if (order == RibbonOrder::EdgeAfterEdge) return aloneBefore() + column * rows + row;
    if (order == RibbonOrder::Around) return column == 0 ? row : 2 * rows - 1 - row;
    return aloneBefore() + row * sides + column;
}

Result<StrandPieces> findPieces(const std::string& file, const ObjStrandText& obj) {
    const auto count = static_cast<std::uint32_t>(obj.vertices.size());
    const std::size_t faces = obj.faceLines.size();
    DisjointSets sets(count);
    std::vector<std::uint8_t> isUsed(count, 0);
    for (std::size_t face = 0; face < faces; ++face) {
        const auto corners = cornersOf(obj, face);
        for (const std::uint32_t corner : corners) {
            sets.join(corners.front(), corner);
            isUsed[corner] = 1;
        }
    }
    StrandPieces pieces;
    std::vector<std::uint32_t> pieceOf(count);
    pieces.placeOf.resize(count);
    std::vector<std::uint32_t> sizes, faceCounts;
    for (std::uint32_t vertex = 0; vertex < count; ++vertex) {
        if (isUsed[vertex] == 0)
            return failIn(file, {}, fmt::format("vertex {} belongs to no face", vertex + 1),
                          "expected the vertices of hair ribbons or tubes alone");
        const std::uint32_t first = sets.find(vertex);
        if (first == vertex) {
            pieceOf[vertex] = static_cast<std::uint32_t>(sizes.size());
            sizes.push_back(0);
        }
        pieceOf[vertex] = pieceOf[first];
        pieces.placeOf[vertex] = sizes[pieceOf[vertex]]++;
    }
    faceCounts.resize(sizes.size(), 0);
    for (std::size_t face = 0; face < faces; ++face) {
        if (!cornersOf(obj, face).empty()) ++faceCounts[pieceOf[cornersOf(obj, face).front()]];
    }
    for (std::size_t piece = 0; piece < sizes.size(); ++piece) {
        pieces.vertexOffsets.push_back(pieces.vertexOffsets.back() + sizes[piece]);
        pieces.faceOffsets.push_back(pieces.faceOffsets.back() + faceCounts[piece]);
    }
    pieces.vertices.resize(count);
    for (std::uint32_t vertex = 0; vertex < count; ++vertex)
        pieces.vertices[pieces.vertexOffsets[pieceOf[vertex]] + pieces.placeOf[vertex]] = vertex;
    pieces.faces.resize(pieces.faceOffsets.back());
    std::vector<std::uint32_t> next(pieces.faceOffsets.begin(), pieces.faceOffsets.end() - 1);
    for (std::size_t face = 0; face < faces; ++face) {
        const auto corners = cornersOf(obj, face);
        if (!corners.empty())
            pieces.faces[next[pieceOf[corners.front()]]++] = static_cast<std::uint32_t>(face);
    }
    return pieces;
}

Result<std::vector<StrandGrid>> findGrids(const std::string& file, const ObjStrandText& obj,
                                          const StrandPieces& pieces, RibbonOrder asked) {
    std::vector<StrandGrid> common = fittingGrids(obj, pieces, 0, asked);
    if (common.empty()) return noGrid(file, obj, pieces, 0, asked);
    for (std::size_t piece = 1; piece < pieces.count() && !common.empty(); ++piece)
        std::erase_if(common, [&](const StrandGrid& grid) { return !fits(obj, pieces, piece, grid); });
    std::vector<StrandGrid> grids;
    if (!common.empty()) {
        grids.assign(pieces.count(),
                     best(common, [&](const StrandGrid& grid) { return widthOf(obj, pieces, grid); }));
    } else {
        for (std::size_t piece = 0; piece < pieces.count(); ++piece) {
            const std::vector<StrandGrid> own = fittingGrids(obj, pieces, piece, asked);
            if (own.empty()) return noGrid(file, obj, pieces, piece, asked);
            grids.push_back(
                best(own, [&](const StrandGrid& grid) { return shapeOf(obj, pieces, piece, grid).width; }));
        }
    }
    if (auto status = checkSlender(file, obj, pieces, grids); !status) return tl::unexpected(status.error());
    return grids;
}

Result<std::vector<StrandGrid>> findRibbons(const std::string& file, const ObjStrandText& obj,
                                            const StrandPieces& pieces, RibbonOrder asked) {
    std::vector<StrandGrid> fitting;
    for (const RibbonOrder order :
         {RibbonOrder::Interleaved, RibbonOrder::EdgeAfterEdge, RibbonOrder::Around}) {
        if (asked == RibbonOrder::Detect || asked == order) fitting.push_back({2, order, Alone::None});
    }
    for (std::size_t piece = 0; piece < pieces.count(); ++piece) {
        std::erase_if(fitting, [&](const StrandGrid& grid) { return !fits(obj, pieces, piece, grid); });
        if (fitting.empty()) return noGrid(file, obj, pieces, piece, asked);
    }
    return std::vector<StrandGrid>(
        pieces.count(), best(fitting, [&](const StrandGrid& grid) { return widthOf(obj, pieces, grid); }));
}

RibbonRun guessRibbons(std::span<const Vec3f> vertices, RibbonOrder asked) {
    const std::uint32_t run = guessPointsPerStrand(vertices);
    if (run == 0) return {};
    RibbonRun found;
    double least = 0;
    const auto consider = [&](RibbonOrder order, std::uint32_t size) {
        if ((asked != RibbonOrder::Detect && asked != order) || size % 2 != 0 || size < 4 ||
            vertices.size() % size != 0)
            return;
        const StrandGrid grid{2, order, Alone::None};
        const std::uint32_t rows = size / 2;
        // Across a strand its two edges are as far apart as it is wide, along it not at all.
        double along = 0;
        for (std::size_t begin = 0; begin < vertices.size(); begin += size) {
            const auto at = [&](std::uint32_t row, std::uint32_t column) {
                return vertices[begin + grid.vertexAt(row, column, rows)];
            };
            for (std::uint32_t row = 0; row + 1 < rows; ++row) {
                const Vec3f across = at(row, 1) - at(row, 0), next = at(row + 1, 0) - at(row, 0);
                const double cosine = static_cast<double>(std::abs(across.dot(next))) /
                                      std::max(1e-30, static_cast<double>(next.norm()));
                if (std::isfinite(cosine)) along += cosine + 0.01 * static_cast<double>(across.norm());
            }
        }
        if (found.segments != 0 && along >= least) return;
        found = {rows - 1, order};
        least = along;
    };
    consider(RibbonOrder::Interleaved, run);
    consider(RibbonOrder::Around, run);
    consider(RibbonOrder::EdgeAfterEdge, 2 * run);
    return found;
}

}  // namespace hairloom
