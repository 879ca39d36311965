// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How triangles of roots lie to the border of the chart they are on. Private to core/geometry.

#include <array>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "core/geometry/flat_chart.h"

namespace hairloom {

/// One at a time: it keeps the memory of its searches.
class ChartBorder {
  public:
    using Corners = std::array<Vec2d, 3>;
    static constexpr double kBridges = std::numeric_limits<double>::infinity();

    ChartBorder(const ScalpMesh& mesh, const Chart& chart);

    /// 0 for a counter-clockwise triangle inside the chart. For one whose sides only cut off bends of the
    /// border, the depth of the deepest over the length of the side that cuts it. kBridges where a part of
    /// the border lies within or passes from side to side, and for a triangle without area. Triangles are
    /// drawn in by a millionth, so that roots on the border count as inside.
    double overhang(const Corners& corners);

    /// Whether the line between two points stays inside the chart, drawn in likewise.
    bool sees(const Vec2d& a, const Vec2d& b);

  private:
    std::vector<std::uint32_t> takeChain(std::size_t first, const Corners& corners);
    double overhangOf(const std::vector<std::uint32_t>& chain, const Corners& corners) const;
    double depth(const std::vector<std::uint32_t>& chain, const Vec2d& a, const Vec2d& b) const;

    SegmentGrid grid_;
    std::map<std::pair<double, double>, std::vector<std::uint32_t>> around_;  ///< segments that end there
    std::vector<std::uint32_t> found_;                                        ///< segments at hand, ascending
    std::vector<bool> taken_;                                                 ///< per one of found_
};

}  // namespace hairloom
