// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry/parameterization.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/geometry/flat_chart.h"
#include "core/geometry/selection.h"

namespace hairloom {
namespace {

constexpr double kMaxStretch = 2;

double flatArea(const std::vector<Vec2d>& uvs) {
    double sum = 0;
    for (std::size_t c = 0; c < uvs.size(); c += 3) {
        const Vec2d a = uvs[c + 1] - uvs[c], b = uvs[c + 2] - uvs[c];
        sum += 0.5 * (a.x() * b.y() - a.y() * b.x());
    }
    return sum;
}

Chart finished(const ScalpMesh& mesh, const FaceSet& faces, std::vector<Vec2d> uvs) {
    Chart chart{faces, std::move(uvs), 1};
    const double scale = std::sqrt(selectionArea(mesh, faces) / flatArea(chart.cornerUvs));
    for (Vec2d& uv : chart.cornerUvs) uv *= scale;
    chart.stretch = meanStretch(mesh, faces, chart.cornerUvs);
    return chart;
}

/// The mesh's own UVs, when the piece is one island of them and they lie well.
std::optional<Chart> chartFromUvs(const ScalpMesh& mesh, const FaceSet& piece) {
    if (mesh.cornerUvs().empty()) return std::nullopt;
    std::vector<Vec2d> uvs;
    uvs.reserve(piece.size() * 3);
    for (const std::uint32_t face : piece)
        for (std::size_t i = 0; i < 3; ++i)
            uvs.push_back(mesh.cornerUvs()[3 * std::size_t{face} + i].cast<double>());
    const double area = flatArea(uvs);
    if (area < 0)
        for (Vec2d& uv : uvs) uv.x() = -uv.x();
    const std::vector<std::uint32_t> opposite = oppositeSides(mesh, piece);
    for (std::uint32_t side = 0; side < opposite.size(); ++side) {
        const std::uint32_t across = opposite[side];
        if (across == kOpenSide) continue;
        const std::uint32_t end = side % 3 == 2 ? side - 2 : side + 1;
        if (uvs[across] != uvs[end]) return std::nullopt;  // a seam
    }
    if (!isInjective(opposite, uvs)) return std::nullopt;
    Chart chart = finished(mesh, piece, std::move(uvs));
    return chart.stretch <= kMaxStretch ? std::optional(std::move(chart)) : std::nullopt;
}

}  // namespace

Result<Parameterization> parameterize(const ScalpMesh& mesh, const FaceSet& faces) {
    if (faces.empty()) return fail("the scalp selection is empty", "at least one face");
    Parameterization result;
    std::vector<FaceSet> work = connectedPieces(mesh, faces);
    std::reverse(work.begin(), work.end());
    while (!work.empty()) {
        const FaceSet piece = std::move(work.back());
        work.pop_back();
        if (std::optional<Chart> chart = chartFromUvs(mesh, piece)) {
            result.charts.push_back(std::move(*chart));
            continue;
        }
        const std::optional<ChartPiece> disc = cutToDisc(mesh, piece);
        std::optional<std::vector<Vec2d>> uvs = disc ? flattenDisc(*disc) : std::nullopt;
        if (uvs) {
            result.charts.push_back(finished(mesh, piece, std::move(*uvs)));
            continue;
        }
        // Ends with single triangles at the latest, which always lie flat.
        auto [first, second] = splitFaces(mesh, piece);
        work.push_back(std::move(second));
        work.push_back(std::move(first));
    }
    return result;
}

}  // namespace hairloom
