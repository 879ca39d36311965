// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Charts as SVG or as an image: points, lines and bars over linear, logarithmic or named axes, and filled
// maps with a colour bar. The text is laid out here with the widths of a common sans-serif face, so that
// nothing is clipped or printed over something else whichever viewer draws it. Equal plots give equal bytes.
//
//     Plot plot;
//     plot.title = "Error against substeps";
//     plot.x = {.title = "substeps", .scale = Scale::Logarithmic};
//     plot.y = {.title = "error", .unit = "mm", .scale = Scale::Logarithmic};
//     plot.series.push_back({.name = "verlet", .points = {{1, 4.1}, {2, 1.3}, {4, 0.4}}});
//     const std::string text = svg(plot);
//
// Does not do: dates, stacked or filled areas, a second y axis, animation.

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace hairloom {

inline constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

enum class Scale { Linear, Logarithmic };

/// A mark of an axis that the caller chose.
struct AxisTick {
    double value;
    std::string label;
};

struct Axis {
    std::string title = {};
    std::string unit = {};  ///< shown behind the title; "" for a pure number
    Scale scale = Scale::Linear;
    /// Range; what is absent follows from the data, rounded outwards on a linear axis. > 0 on a logarithmic
    /// one.
    std::optional<double> low = {}, high = {};
    /// Replaces the computed ticks: for categories (values 0, 1, …) or for the very settings that were run.
    std::vector<AxisTick> ticks = {};
};

/// Ticks at the values themselves, with short labels.
std::vector<AxisTick> ticksAt(const std::vector<double>& values);

/// What is not finite, or not positive on a logarithmic axis, is not drawn; but y = +infinity is drawn as an
/// open arrow at the upper edge, with Plot::infinityName in the legend.
struct PlotPoint {
    double x;
    double y;
    double yLow = kNoNumber;   ///< lower end of the error bar
    double yHigh = kNoNumber;  ///< upper end
    double xLow = kNoNumber;
    double xHigh = kNoNumber;
    std::string label = {};    ///< printed beside the point; left out where there is no room at all
    std::string tooltip = {};  ///< shown when a viewer hovers over the point
    bool faint = false;        ///< drawn light, under all others
};

enum class Marker { None, Circle, Square, TriangleUp, Diamond, Cross, Plus };
enum class LineStyle { None, Solid, Dashed };

struct Series {
    std::string name = {};                   ///< in the legend; "" keeps it out. May have no points.
    std::vector<PlotPoint> points = {};      ///< lines join them in this order and break at what is not drawn
    std::optional<std::string> colour = {};  ///< "#rrggbb"; absent: next of the palette
    Marker marker = Marker::Circle;
    LineStyle line = LineStyle::None;
};

/// A value that a map's cell may have.
struct MapCategory {
    std::string name;
    std::optional<std::string> colour = {};  ///< absent: next of the palette, skipping neither
};

/// sRGB.
struct CellColour {
    std::uint8_t red = 0, green = 0, blue = 0;
};

/// A grid of cells. Row 0 is the lowest. Series are drawn over it.
struct FilledMap {
    std::vector<double> xEdges;  ///< columns + 1, ascending; see cellEdges
    std::vector<double> yEdges;  ///< rows + 1, ascending
    std::vector<double> values;  ///< rows · columns, row after row; not finite: no data (grey)
    /// Not empty: what cells show in place of `values`, which are empty then. No bar explains them.
    std::vector<CellColour> colours = {};
    std::vector<std::string> cellTexts = {};  ///< the same size, or empty; printed where a cell has room
    /// Not empty: the values are indices into it, and a legend replaces the colour bar.
    std::vector<MapCategory> categories = {};
    Axis colour = {};  ///< of the colour bar: title, unit, scale, range, ticks
};

/// Edges of cells around ascending, distinct centres: half-way between neighbours, in the logarithm on a
/// logarithmic axis. One centre gets a cell of one unit, or from half to double of it.
std::vector<double> cellEdges(const std::vector<double>& centres, Scale scale);

struct Plot {
    std::string title = {};
    std::string note = {};  ///< small print under the chart: what was run, how to read labels
    Axis x, y;
    std::vector<Series> series = {};
    std::optional<FilledMap> map = {};
    std::string infinityName = "off the scale";
    /// Points are bars from the lower edge, those of one x side by side in the order of the series; x counts
    /// 0, 1, … and takes `ticks`. What is below the range has no bar.
    bool bars = false;
    double width = 760;   ///< pixels, 320 … 4000
    double height = 480;  ///< pixels, 240 … 4000
};

/// A complete SVG document, which may also stand within an HTML page as it is (it has no ids).
std::string svg(const Plot& plot);

/// 8 bits a channel, sRGB, opaque; rows from the top, without gaps.
struct ChartImage {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
};
/// The same drawing, `scale` pixels for each of the plot's, 0.5 … 8.
ChartImage image(const Plot& plot, double scale);

/// Okabe and Ito's palette ("Color Universal Design", 2008), which colour-blind readers can tell apart; in an
/// order in which the first few are also of different lightness.
inline constexpr std::array<const char*, 8> kPalette = {"#0072B2", "#D55E00", "#009E73", "#E69F00",
                                                        "#CC79A7", "#000000", "#56B4E9", "#F0E442"};
/// Of the palette, over and over.
const char* paletteColour(std::size_t index);
/// "#rrggbb" of a share 0 … 1 of the colour bar: viridis, dark to light, even in lightness.
std::string mapColour(double share);

}  // namespace hairloom
