// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/charts/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/charts/markup.h"
#include "core/charts/plot_labels.h"
#include "core/charts/plot_legend.h"
#include "core/charts/plot_ticks.h"
#include "core/charts/raster_canvas.h"
#include "core/charts/svg_canvas.h"

namespace hairloom {
namespace {

constexpr double kTextSize = 12;
constexpr double kAxisTitleSize = 13;
constexpr double kTitleSize = 15;
constexpr double kTextHeight = 15;  // of a line of kTextSize, with its spacing
constexpr double kEdge = 12;        // between the drawing's border and anything
constexpr double kTickLength = 5;
constexpr double kTurned = -40;  // degrees, of labels that do not fit side by side
constexpr double kFaint = 0.4;
constexpr double kMarkerRoom = 5;       // half the box that labels keep off a marker
constexpr double kNoteShare = 0.93;     // of the width: viewers without the usual face take a wider one
constexpr double kSmallestFrame = 140;  // pixels a side, whatever the text takes

struct MarginText {
    std::vector<std::string> title, xTitle, yTitle, note;
};

std::string axisTitle(const Axis& axis) {
    if (axis.unit.empty()) return axis.title;
    return fmt::format("{} ({})", axis.title, axis.unit);
}

std::vector<std::string> linesOf(const std::string& text, double size, double width) {
    if (text.empty()) return {};
    return wrapText(text, size, width);
}

/// Places of everything, settled before anything is drawn.
struct Layout {
    double width, height;
    PixelBox frame;
    AxisLayout x, y;
    bool turnedTicks = false;
    double xTickHeight = kTextHeight;
    MarginText text;

    double xOf(double value) const { return frame.x + x.share(value) * frame.width; }
    double yOf(double value) const { return frame.y + (1 - y.share(value)) * frame.height; }
};

double widestTick(const AxisLayout& axis) {
    double widest = 0;
    for (const AxisTick& tick : axis.ticks) widest = std::max(widest, textWidth(tick.label, kTextSize));
    return widest;
}

bool ticksCollide(const AxisLayout& axis, double length) {
    double end = -1e30;
    for (const AxisTick& tick : axis.ticks) {
        const double half = textWidth(tick.label, kTextSize) / 2;
        const double at = axis.share(tick.value) * length;
        if (at - half < end + 4) return true;
        end = at + half;
    }
    return false;
}

struct DataValues {
    std::vector<double> x, y;
};

DataValues valuesOf(const Plot& plot) {
    DataValues values;
    for (const Series& series : plot.series) {
        for (const PlotPoint& point : series.points) {
            values.x.insert(values.x.end(), {point.x, point.xLow, point.xHigh});
            values.y.insert(values.y.end(), {point.y, point.yLow, point.yHigh});
        }
    }
    if (plot.map) {
        values.x.insert(values.x.end(), plot.map->xEdges.begin(), plot.map->xEdges.end());
        values.y.insert(values.y.end(), plot.map->yEdges.begin(), plot.map->yEdges.end());
    }
    return values;
}

/// Margins follow from the labels, labels from the ticks, ticks from the size that the margins leave; the
/// second round settles them.
Layout layoutOf(const Plot& plot, const Legend& legend) {
    const DataValues values = valuesOf(plot);
    const bool padded = !plot.map;
    Layout layout;
    layout.width = plot.width;
    layout.height = std::max(plot.height, legend.height() + 2 * kEdge + 40);
    layout.frame = {80, 40, plot.width - 200, layout.height - 120};
    for (int round = 0; round < 3; ++round) {
        PixelBox& frame = layout.frame;
        layout.text.title = linesOf(plot.title, kTitleSize, plot.width - 2 * kEdge);
        layout.text.note = linesOf(plot.note, kTextSize, kNoteShare * (plot.width - 2 * kEdge));
        layout.text.xTitle = linesOf(axisTitle(plot.x), kAxisTitleSize, frame.width);
        layout.text.yTitle = linesOf(axisTitle(plot.y), kAxisTitleSize, frame.height);
        layout.y = layoutAxis(plot.y, values.y, frame.height, 45, padded);
        layout.x = layoutAxis(plot.x, values.x, frame.width, 80, padded);
        layout.turnedTicks = ticksCollide(layout.x, frame.width);
        const double slope = std::sin(-kTurned * 3.14159265358979 / 180);
        layout.xTickHeight = layout.turnedTicks ? widestTick(layout.x) * slope + 14 : kTextHeight;

        const auto lines = [](const std::vector<std::string>& text, double height) {
            return static_cast<double>(text.size()) * height;
        };
        const double left = kEdge + lines(layout.text.yTitle, 17) + widestTick(layout.y) + kTickLength + 10;
        const double turnedOverhang = layout.turnedTicks ? widestTick(layout.x) * 0.77 - 30 : 0;
        const double top = kEdge + lines(layout.text.title, 20) + 6;
        const double bottom = kTickLength + 4 + layout.xTickHeight + lines(layout.text.xTitle, 17) + 4 +
                              lines(layout.text.note, kTextHeight) + kEdge;
        const double lastHalf = layout.x.ticks.empty() || layout.turnedTicks
                                    ? 0
                                    : textWidth(layout.x.ticks.back().label, kTextSize) / 2 -
                                          (1 - layout.x.share(layout.x.ticks.back().value)) * frame.width;
        const double right = std::max(kEdge + legend.width(), kEdge + lastHalf);
        frame.x = std::max(left, turnedOverhang);
        frame.y = top;
        frame.width = std::max(layout.width - frame.x - right, kSmallestFrame);
        frame.height = std::max(layout.height - top - bottom, kSmallestFrame);
        // Text that leaves too little room makes the drawing larger.
        layout.width = std::max(layout.width, frame.x + frame.width + right);
        layout.height = std::max(layout.height, top + frame.height + bottom);
    }
    return layout;
}

void drawGrid(const Layout& layout, Canvas& canvas) {
    const PixelBox& f = layout.frame;
    const Stroke major{"#e2e2e2"}, minor{"#f3f3f3"};
    for (const double value : layout.x.minorTicks) {
        canvas.line({layout.xOf(value), f.y, layout.xOf(value), f.y + f.height}, minor);
    }
    for (const double value : layout.y.minorTicks) {
        canvas.line({f.x, layout.yOf(value), f.x + f.width, layout.yOf(value)}, minor);
    }
    for (const AxisTick& tick : layout.x.ticks) {
        canvas.line({layout.xOf(tick.value), f.y, layout.xOf(tick.value), f.y + f.height}, major);
    }
    for (const AxisTick& tick : layout.y.ticks) {
        canvas.line({f.x, layout.yOf(tick.value), f.x + f.width, layout.yOf(tick.value)}, major);
    }
}

void drawXTicks(const Layout& layout, Canvas& canvas) {
    const double bottom = layout.frame.y + layout.frame.height;
    const Stroke stroke{"#555555"};
    for (const double value : layout.x.minorTicks) {
        canvas.line({layout.xOf(value), bottom, layout.xOf(value), bottom + 3}, stroke);
    }
    for (const AxisTick& tick : layout.x.ticks) {
        const double x = layout.xOf(tick.value);
        canvas.line({x, bottom, x, bottom + kTickLength}, stroke);
        if (layout.turnedTicks) {
            canvas.text(x + 4, bottom + kTickLength + 11, tick.label,
                        {.size = kTextSize, .anchor = Anchor::End, .turned = kTurned});
        } else {
            canvas.text(x, bottom + kTickLength + 14, tick.label,
                        {.size = kTextSize, .anchor = Anchor::Middle});
        }
    }
}

void drawYTicks(const Layout& layout, Canvas& canvas) {
    const double left = layout.frame.x;
    const Stroke stroke{"#555555"};
    for (const double value : layout.y.minorTicks) {
        canvas.line({left - 3, layout.yOf(value), left, layout.yOf(value)}, stroke);
    }
    for (const AxisTick& tick : layout.y.ticks) {
        const double y = layout.yOf(tick.value);
        canvas.line({left - kTickLength, y, left, y}, stroke);
        canvas.text(left - kTickLength - 4, y + 4.3, tick.label, {.size = kTextSize, .anchor = Anchor::End});
    }
}

void drawTitles(const Layout& layout, Canvas& canvas) {
    const PixelBox& f = layout.frame;
    double y = kEdge + 14;
    for (const std::string& line : layout.text.title) {
        canvas.text(kEdge, y, line, {.size = kTitleSize, .bold = true});
        y += 20;
    }
    y = f.y + f.height + kTickLength + 4 + layout.xTickHeight + 14;
    for (const std::string& line : layout.text.xTitle) {
        canvas.text(f.x + f.width / 2, y, line, {.size = kAxisTitleSize, .anchor = Anchor::Middle});
        y += 17;
    }
    y += 6;
    for (const std::string& line : layout.text.note) {
        canvas.text(kEdge, y, line, {.size = kTextSize, .colour = "#555555"});
        y += kTextHeight;
    }
    double x = kEdge + 12;
    for (const std::string& line : layout.text.yTitle) {
        canvas.text(x, f.y + f.height / 2, line,
                    {.size = kAxisTitleSize, .anchor = Anchor::Middle, .turned = -90});
        x += 17;
    }
}

void drawMap(const FilledMap& map, const Legend& legend, const Layout& layout, Canvas& canvas) {
    assert(map.xEdges.size() >= 2 && map.yEdges.size() >= 2);
    const std::size_t columns = map.xEdges.size() - 1;
    const std::size_t cells = columns * (map.yEdges.size() - 1);
    assert((map.colours.empty() ? map.values.size() : map.colours.size()) == cells);
    assert(map.cellTexts.empty() || map.cellTexts.size() == cells);
    for (std::size_t i = 0; i < cells; ++i) {
        const std::size_t column = i % columns, row = i / columns;
        const double x0 = layout.xOf(map.xEdges[column]), x1 = layout.xOf(map.xEdges[column + 1]);
        const double y0 = layout.yOf(map.yEdges[row + 1]), y1 = layout.yOf(map.yEdges[row]);
        // A range that the caller narrowed cuts cells off at the frame.
        const PixelBox& f = layout.frame;
        if (!f.overlaps({x0, y0, x1 - x0, y1 - y0})) continue;
        const double left = std::max(x0, f.x), right = std::min(x1, f.x + f.width);
        const double top = std::max(y0, f.y), bottom = std::min(y1, f.y + f.height);
        const std::string colour = legend.cellColour(i);
        canvas.box({left, top, right - left, bottom - top}, colour, {});
        if (map.cellTexts.empty() || map.cellTexts[i].empty()) continue;
        const double room = right - left - 4;
        if (textWidth(map.cellTexts[i], kTextSize) > room || bottom - top < kTextHeight) continue;
        canvas.text((left + right) / 2, (top + bottom) / 2 + 4.3, map.cellTexts[i],
                    {.size = kTextSize, .anchor = Anchor::Middle, .colour = readableOn(colour)});
    }
}

/// A point that is drawn, in pixels.
struct DrawnPoint {
    const PlotPoint* point;
    double x, y;
    std::string colour;
    Marker marker;
    bool upwards;  ///< off the scale
};

std::vector<DrawnPoint> drawnPoints(const Plot& plot, const Legend& legend, const Layout& layout) {
    std::vector<DrawnPoint> drawn;
    for (std::size_t s = 0; s < plot.series.size(); ++s) {
        for (const PlotPoint& point : plot.series[s].points) {
            if (!layout.x.within(point.x)) continue;
            const bool upwards = std::isinf(point.y) && point.y > 0;
            if (!upwards && !layout.y.within(point.y)) continue;
            drawn.push_back({&point, layout.xOf(point.x), upwards ? layout.frame.y + 7 : layout.yOf(point.y),
                             legend.seriesColour(s), plot.series[s].marker, upwards});
        }
    }
    return drawn;
}

std::vector<PixelSegment> lineOf(const Series& series, const Layout& layout) {
    std::vector<PixelSegment> segments;
    for (std::size_t i = 1; i < series.points.size(); ++i) {
        const PlotPoint &a = series.points[i - 1], &b = series.points[i];
        const bool whole = layout.x.drawable(a.x) && layout.y.drawable(a.y) && layout.x.drawable(b.x) &&
                           layout.y.drawable(b.y);
        if (!whole) continue;
        const auto part =
            clipped({layout.xOf(a.x), layout.yOf(a.y), layout.xOf(b.x), layout.yOf(b.y)}, layout.frame);
        if (part) segments.push_back(*part);
    }
    return segments;
}

void drawErrorBars(const DrawnPoint& drawn, const Layout& layout, Canvas& canvas) {
    const PlotPoint& p = *drawn.point;
    const Stroke stroke{drawn.colour, 1.2, "", p.faint ? kFaint : 0.8};
    const auto bar = [&](double x0, double y0, double x1, double y1) {
        const auto part = clipped({x0, y0, x1, y1}, layout.frame);
        if (!part) return;
        canvas.line(*part, stroke);
        const double capX = x0 == x1 ? 3 : 0, capY = 3 - capX;
        canvas.line({part->x0 - capX, part->y0 - capY, part->x0 + capX, part->y0 + capY}, stroke);
        canvas.line({part->x1 - capX, part->y1 - capY, part->x1 + capX, part->y1 + capY}, stroke);
    };
    if (!drawn.upwards && layout.y.drawable(p.yLow) && layout.y.drawable(p.yHigh)) {
        bar(drawn.x, layout.yOf(p.yLow), drawn.x, layout.yOf(p.yHigh));
    }
    if (layout.x.drawable(p.xLow) && layout.x.drawable(p.xHigh)) {
        bar(layout.xOf(p.xLow), drawn.y, layout.xOf(p.xHigh), drawn.y);
    }
}

void drawPoint(const DrawnPoint& drawn, const Layout& layout, Canvas& canvas) {
    drawErrorBars(drawn, layout, canvas);
    if (drawn.upwards) {
        canvas.arrowUp(drawn.x, drawn.y, drawn.colour, drawn.point->tooltip);
    } else {
        canvas.marker(drawn.marker, drawn.x, drawn.y, drawn.colour, drawn.point->faint ? kFaint : 1,
                      drawn.point->tooltip);
    }
}

void drawLabels(const std::vector<DrawnPoint>& points, const std::vector<PixelSegment>& lines,
                const Layout& layout, Canvas& canvas) {
    std::vector<LabelRequest> requests;
    std::vector<const std::string*> labels;
    std::vector<PixelBox> obstacles;
    for (const DrawnPoint& p : points) {
        // Faint points may show through a label.
        if (!p.point->faint) {
            obstacles.push_back({p.x - kMarkerRoom, p.y - kMarkerRoom, 2 * kMarkerRoom, 2 * kMarkerRoom});
        }
        if (p.point->label.empty()) continue;
        requests.push_back({p.x, p.y, textWidth(p.point->label, kTextSize), kTextHeight});
        labels.push_back(&p.point->label);
    }
    const auto places = placeLabels(requests, layout.frame, obstacles, lines);
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (!places[i]) continue;
        const PixelBox& box = places[i]->box;
        if (!places[i]->far) continue;
        const double x = std::clamp(requests[i].x, box.x, box.x + box.width);
        const double y = std::clamp(requests[i].y, box.y, box.y + box.height);
        canvas.line({requests[i].x, requests[i].y, x, y}, {"#888888", 0.8});
    }
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (!places[i]) continue;
        const PixelBox& box = places[i]->box;
        canvas.text(box.x + box.width / 2, box.y + 11.5, *labels[i],
                    {.size = kTextSize, .anchor = Anchor::Middle, .halo = true});
    }
}

void drawSeries(const Plot& plot, const Legend& legend, const Layout& layout, Canvas& canvas) {
    const std::vector<DrawnPoint> points = drawnPoints(plot, legend, layout);
    for (const DrawnPoint& point : points) {
        if (point.point->faint) drawPoint(point, layout, canvas);
    }
    std::vector<PixelSegment> lines;
    for (std::size_t s = 0; s < plot.series.size(); ++s) {
        if (plot.series[s].line == LineStyle::None) continue;
        const std::vector<PixelSegment> line = lineOf(plot.series[s], layout);
        canvas.polyline(line, seriesStroke(plot.series[s], legend.seriesColour(s)));
        lines.insert(lines.end(), line.begin(), line.end());
    }
    for (const DrawnPoint& point : points) {
        if (!point.point->faint) drawPoint(point, layout, canvas);
    }
    drawLabels(points, lines, layout, canvas);
}

void drawBars(const Plot& plot, const Legend& legend, const Layout& layout, Canvas& canvas) {
    constexpr double kGroup = 0.8;  // of the way to the next x
    const PixelBox& f = layout.frame;
    const double bottom = f.y + f.height;
    const double width = kGroup / static_cast<double>(plot.series.size());
    for (std::size_t s = 0; s < plot.series.size(); ++s) {
        for (const PlotPoint& point : plot.series[s].points) {
            if (!layout.y.drawable(point.y)) continue;
            const double from = point.x - kGroup / 2 + static_cast<double>(s) * width;
            const double left = layout.xOf(from), right = layout.xOf(from + width);
            const double top = std::max(layout.yOf(point.y), f.y);
            if (top < bottom)
                canvas.box({left, top, right - left - 1, bottom - top}, legend.seriesColour(s),
                           point.tooltip);
        }
    }
}

void draw(const Plot& plot, const Legend& legend, const Layout& layout, Canvas& canvas) {
    if (!plot.map) drawGrid(layout, canvas);
    if (plot.map) drawMap(*plot.map, legend, layout, canvas);
    plot.bars ? drawBars(plot, legend, layout, canvas) : drawSeries(plot, legend, layout, canvas);
    canvas.frame(layout.frame, {"#555555"});
    drawXTicks(layout, canvas);
    drawYTicks(layout, canvas);
    drawTitles(layout, canvas);
    legend.draw(layout.frame, canvas);
}

}  // namespace

std::string svg(const Plot& plot) {
    const Legend legend(plot);
    const Layout layout = layoutOf(plot, legend);
    SvgCanvas canvas(layout.width, layout.height, plot.title);
    draw(plot, legend, layout, canvas);
    return std::move(canvas).finish();
}

ChartImage image(const Plot& plot, double scale) {
    const Legend legend(plot);
    const Layout layout = layoutOf(plot, legend);
    RasterCanvas canvas(layout.width, layout.height, scale);
    draw(plot, legend, layout, canvas);
    return std::move(canvas).finish();
}

}  // namespace hairloom
