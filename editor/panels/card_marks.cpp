// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/panels/card_marks.h"

#include <cmath>
#include <map>
#include <utility>

namespace hairloom::editor {
namespace {

/// Neighbours in a list get hues that lie apart.
QColor colourOf(std::uint32_t card, int alpha) {
    constexpr double kGolden = 0.618033988749895;
    return QColor::fromHsvF(static_cast<float>(std::fmod(kGolden * card, 1.0)), 0.6f, 1.0f,
                            static_cast<float>(alpha) / 255);
}

}  // namespace

CardMarks::CardMarks(const cards::Cards& cards) {
    const auto& vertices = cards.mesh.vertices;
    const auto& indices = cards.mesh.indices;
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;  // an outline's belong to one triangle
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        const std::array<std::uint32_t, 3> t{indices[i], indices[i + 1], indices[i + 2]};
        if (vertices[t[0]].card == cards::kOfCap) continue;
        triangles_.push_back(
            {{vertices[t[0]].position_ws, vertices[t[1]].position_ws, vertices[t[2]].position_ws},
             vertices[t[0]].card});
        for (std::size_t e = 0; e < 3; ++e) ++edges[std::minmax(t[e], t[(e + 1) % 3])];
    }
    for (const auto& [edge, count] : edges) {
        if (count == 1)
            outlines_.push_back({vertices[edge.first].position_ws, vertices[edge.second].position_ws,
                                 vertices[edge.first].card});
    }
}

void CardMarks::draw(Marks& marks, std::optional<std::uint32_t> picked) const {
    constexpr int kFill = 60, kOutline = 200;
    for (const Triangle& triangle : triangles_)
        marks.triangle(triangle.corners_ws, colourOf(triangle.card, kFill));
    for (const Line& line : outlines_) {
        if (line.card == picked)
            marks.line(line.a_ws, line.b_ws, Qt::white, 2.5f, Marks::Depth::OnTop);
        else
            marks.line(line.a_ws, line.b_ws, colourOf(line.card, kOutline), 1);
    }
}

}  // namespace hairloom::editor
