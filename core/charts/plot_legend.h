// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What stands to the right of a chart: the colour bar of a map and the names of series and categories; and
// the colours that they explain.

#include <vector>

#include "core/charts/canvas.h"
#include "core/charts/plot_ticks.h"

namespace hairloom {

class Legend {
  public:
    /// `plot` outlives the legend.
    explicit Legend(const Plot& plot);

    double width() const;   ///< pixels, with the gap to the chart; 0 where there is nothing to explain
    double height() const;  ///< of the names
    void draw(const PixelBox& frame, Canvas& canvas) const;

    std::string seriesColour(std::size_t series) const;
    std::string cellColour(std::size_t cell) const;

  private:
    struct Entry {
        enum class Kind { Series, Swatch, Arrow } kind;
        std::vector<std::string> lines;  ///< the name, wrapped
        std::string colour;
        const Series* series;
    };
    void addEntry(Entry::Kind kind, const std::string& name, std::string colour,
                  const Series* series = nullptr);
    std::string colourOf(double value) const;  ///< of a map's cells
    bool hasBar() const;
    AxisLayout barAxis(double length) const;
    double barWidth() const;
    double namesWidth() const;
    void drawBar(const PixelBox& frame, Canvas& canvas) const;
    void drawEntry(const Entry& entry, double x, double y, Canvas& canvas) const;

    const Plot& plot_;
    std::vector<Entry> entries_;
    AxisLayout scale_;  ///< of the map's colours
};

Stroke seriesStroke(const Series& series, const std::string& colour);
/// Black or white, whichever reads better on "#rrggbb".
const char* readableOn(const std::string& colour);

}  // namespace hairloom
