// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The cards of a level, drawn over the strands: each a tinted strip with its outline.

#include <array>
#include <optional>
#include <vector>

#include "core/cards/cards.h"
#include "editor/viewport/marks.h"

namespace hairloom::editor {

class CardMarks {
  public:
    CardMarks() = default;
    explicit CardMarks(const cards::Cards& cards);
    /// `picked` stands out.
    void draw(Marks& marks, std::optional<std::uint32_t> picked) const;

  private:
    struct Triangle {
        std::array<Vec3f, 3> corners_ws;
        std::uint32_t card;
    };
    struct Line {
        Vec3f a_ws, b_ws;
        std::uint32_t card;
    };
    std::vector<Triangle> triangles_;
    std::vector<Line> outlines_;
};

}  // namespace hairloom::editor
