// SPDX-License-Identifier: GPL-3.0-or-later
// Hair that was written as polygons. Cinema 4D has flat ribbons (thesis §4.1, Figure 7): 2n vertices for a
// strand of n particles, root to tip. There are n_v/(2n) strands; the thesis prints the inverse. Tubes of any
// number of sides, and strands of unlike length, are other programs'.

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "importers/raw_strands.h"
#include "importers/strand_mesh.h"

namespace hairloom {
namespace {

/// Pieces of equal size, run after run of the vertices; faces belong to the run of their first corner.
Result<StrandPieces> equalPieces(const std::string& file, const ObjStrandText& obj, std::uint32_t segments) {
    const std::size_t count = obj.vertices.size();
    const std::uint64_t size = 2 * (std::uint64_t{segments} + 1);
    if (count % size != 0) {
        return failIn(
            file, {},
            fmt::format("{} vertices are not a multiple of {}, the vertices of a strand of {} segments",
                        count, size, segments),
            fmt::format("{} are left over", count % size));
    }
    StrandPieces pieces;
    for (std::uint32_t vertex = 0; vertex < count; ++vertex) {
        pieces.vertices.push_back(vertex);
        pieces.placeOf.push_back(static_cast<std::uint32_t>(vertex % size));
        if ((vertex + 1) % size == 0) pieces.vertexOffsets.push_back(vertex + 1);
    }
    std::vector<std::uint32_t> counts(pieces.count(), 0);
    const auto pieceOf = [&](std::size_t face) {
        const std::uint32_t begin = obj.faceOffsets[face];
        return static_cast<std::size_t>(obj.faceIndices[begin] / size);
    };
    for (std::size_t face = 0; face < obj.faceLines.size(); ++face) {
        const auto begin = obj.faceIndices.begin() + obj.faceOffsets[face];
        const auto end = obj.faceIndices.begin() + obj.faceOffsets[face + 1];
        if (begin == end ||
            std::any_of(begin, end, [&](std::uint32_t v) { return v / size != pieceOf(face); }))
            return failIn(file, Line{obj.faceLines[face]},
                          "this face is not between neighbouring cross-sections of one hair ribbon",
                          fmt::format("expected ribbons of {} segments, or OBJ lines", segments));
        ++counts[pieceOf(face)];
    }
    for (const std::uint32_t faces : counts) pieces.faceOffsets.push_back(pieces.faceOffsets.back() + faces);
    pieces.faces.resize(pieces.faceOffsets.back());
    std::vector<std::uint32_t> next(pieces.faceOffsets.begin(), pieces.faceOffsets.end() - 1);
    for (std::size_t face = 0; face < obj.faceLines.size(); ++face)
        pieces.faces[next[pieceOf(face)]++] = static_cast<std::uint32_t>(face);
    return pieces;
}

class Maker {
  public:
    Maker(const ObjStrandText& obj, RibbonParticle particle) : obj_(obj), particle_(particle) {
        raw_.rootFirst = false;
    }

    void add(std::span<const std::uint32_t> vertices, const StrandGrid& grid) {
        const auto count = static_cast<std::uint32_t>(vertices.size());
        const std::uint32_t rows = grid.rows(count);
        std::vector<Vec3f> row(grid.sides);
        for (std::uint32_t r = 0; r < rows; ++r) {
            for (std::uint32_t column = 0; column < grid.sides; ++column)
                row[column] = obj_.vertices[vertices[grid.vertexAt(r, column, rows)]];
            addRow(row);
        }
        if (grid.aloneBefore() + grid.aloneAfter() > 0) addTips(vertices, grid);
        raw_.offsets.push_back(static_cast<std::uint32_t>(raw_.positions.size()));
        hasTubes_ = hasTubes_ || grid.sides > 2;
    }

    RawStrands finish() {
        raw_.format = hasTubes_ ? "OBJ ribbons and tubes" : "Cinema 4D hair OBJ";
        if (!hasTubes_) raw_.thickness.clear();
        return std::move(raw_);
    }

  private:
    /// A ribbon's particles are vertices of the file or midway; a tube's lie in its middle.
    void addRow(std::span<const Vec3f> row) {
        const bool isEdge = row.size() == 2 && particle_ == RibbonParticle::FirstEdge;
        Vec3f middle = Vec3f::Zero();
        for (const Vec3f& vertex : row) middle += vertex / static_cast<float>(row.size());
        float radius = 0;
        for (const Vec3f& vertex : row) radius += (vertex - middle).norm() / static_cast<float>(row.size());
        raw_.positions.push_back(isEdge ? row[0] : middle);
        raw_.thickness.push_back(2 * radius);
    }

    /// A vertex alone at an end is a particle where it lies beyond the last row, not in it as a lid's middle.
    void addTips(std::span<const std::uint32_t> vertices, const StrandGrid& grid) {
        const auto count = static_cast<std::uint32_t>(vertices.size());
        const std::size_t begin = raw_.offsets.back();
        for (std::uint32_t i = 0; i < grid.aloneBefore() + grid.aloneAfter(); ++i) {
            const std::uint32_t place =
                i < grid.aloneBefore() ? i : count - grid.aloneAfter() + i - grid.aloneBefore();
            const Vec3f& vertex = obj_.vertices[vertices[place]];
            const bool isRoot = grid.rowOf(place, count) == 0;
            const std::size_t end = isRoot ? begin : raw_.positions.size() - 1;
            if ((vertex - raw_.positions[end]).norm() <= 0.5f * raw_.thickness[end]) continue;
            const auto at = static_cast<std::ptrdiff_t>(isRoot ? begin : raw_.positions.size());
            raw_.positions.insert(raw_.positions.begin() + at, vertex);
            raw_.thickness.insert(raw_.thickness.begin() + at, isRoot ? raw_.thickness[begin] : 0.0f);
        }
    }

    const ObjStrandText& obj_;
    RibbonParticle particle_;
    RawStrands raw_;
    bool hasTubes_ = false;
};

}  // namespace

Result<RawStrands> strandsFromRibbons(const std::string& file, const ObjStrandText& obj,
                                      const StrandImportOptions& options) {
    RibbonOrder order = options.ribbonOrder;
    std::uint32_t segments = options.ribbonSegments;
    if (segments == 0 && obj.faceLines.empty()) {
        const RibbonRun run = guessRibbons(obj.vertices, order);
        if (run.segments == 0)
            return failIn(file, {},
                          fmt::format("has {} vertices, but neither lines nor faces", obj.vertices.size()),
                          "expected the number of segments of a strand to be given");
        segments = run.segments;
        order = run.order;
    }
    const auto pieces = segments > 0 ? equalPieces(file, obj, segments) : findPieces(file, obj);
    if (!pieces) return tl::unexpected(pieces.error());
    const auto grids =
        segments > 0 ? findRibbons(file, obj, *pieces, order) : findGrids(file, obj, *pieces, order);
    if (!grids) return tl::unexpected(grids.error());
    Maker maker(obj, options.ribbonParticle);
    for (std::size_t piece = 0; piece < pieces->count(); ++piece)
        maker.add(pieces->verticesOf(piece), (*grids)[piece]);
    RawStrands raw = maker.finish();
    if (!obj.faceLines.empty()) {
        raw.parts = obj.parts;
        for (std::size_t piece = 0; piece < pieces->count(); ++piece) {
            const std::uint32_t first = pieces->faceOffsets[piece];
            const bool hasFace = pieces->faceOffsets[piece + 1] > first;
            raw.partOfStrand.push_back(hasFace ? obj.faceParts[pieces->faces[first]] : 0);
        }
    }
    RibbonsFound found;
    found.order = grids->front().order;
    const bool isOneOrder = std::ranges::all_of(
        *grids, [&](const StrandGrid& grid) { return grid.order == grids->front().order; });
    if (!isOneOrder) found.order = RibbonOrder::Detect;
    const auto [fewestSides, mostSides] = std::ranges::minmax(*grids, {}, &StrandGrid::sides);
    found.sides = mostSides.sides;
    found.fewestSides = fewestSides.sides;
    found.fewestSegments = std::numeric_limits<std::uint32_t>::max();
    for (std::size_t s = 0; s + 1 < raw.offsets.size(); ++s) {
        const std::uint32_t n = raw.offsets[s + 1] - raw.offsets[s] - 1;
        found.fewestSegments = std::min(found.fewestSegments, n);
        found.mostSegments = std::max(found.mostSegments, n);
    }
    raw.ribbons = found;
    return raw;
}

}  // namespace hairloom
