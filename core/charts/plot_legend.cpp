// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/charts/plot_legend.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/charts/markup.h"

namespace hairloom {
namespace {

constexpr double kTextSize = 12;
constexpr double kLineHeight = 15;
constexpr double kEntryGap = 5;
constexpr double kGap = 16;  // between chart and legend
constexpr double kSymbolWidth = 26;
constexpr double kWidestName = 230;
constexpr double kBarWidth = 16;
constexpr int kBarSteps = 64;
constexpr const char* kNoData = "#d9d9d9";

struct Rgb {
    double r, g, b;
};

/// Viridis at ninths of its length (S. van der Walt and N. Smith, matplotlib, CC0).
constexpr std::array<Rgb, 9> kViridis = {{{68, 1, 84},
                                          {71, 44, 122},
                                          {59, 81, 139},
                                          {44, 113, 142},
                                          {33, 144, 141},
                                          {39, 173, 129},
                                          {92, 200, 99},
                                          {170, 220, 50},
                                          {253, 231, 37}}};

}  // namespace

const char* paletteColour(std::size_t index) {
    return kPalette[index % kPalette.size()];
}

std::string mapColour(double share) {
    const double at = std::clamp(share, 0.0, 1.0) * static_cast<double>(kViridis.size() - 1);
    const std::size_t stop = std::min(static_cast<std::size_t>(at), kViridis.size() - 2);
    const double t = at - static_cast<double>(stop);
    const Rgb &a = kViridis[stop], &b = kViridis[stop + 1];
    const auto mix = [t](double from, double to) {
        return static_cast<int>(std::lround(from + t * (to - from)));
    };
    return fmt::format("#{:02x}{:02x}{:02x}", mix(a.r, b.r), mix(a.g, b.g), mix(a.b, b.b));
}

const char* readableOn(const std::string& colour) {
    const auto channel = [&](std::size_t at) {
        int value = 255;
        if (colour.size() == 7) std::from_chars(colour.data() + at, colour.data() + at + 2, value, 16);
        return static_cast<double>(value);
    };
    const double lightness = 0.299 * channel(1) + 0.587 * channel(3) + 0.114 * channel(5);
    return lightness > 140 ? "#111111" : "#ffffff";
}

Stroke seriesStroke(const Series& series, const std::string& colour) {
    return {colour, 1.8, series.line == LineStyle::Dashed ? "6 4" : ""};
}

Legend::Legend(const Plot& plot) : plot_(plot) {
    const FilledMap* map = plot.map ? &*plot.map : nullptr;
    if (map) {
        scale_ = layoutAxis(map->colour, map->values, 200, 45, false);
        for (std::size_t c = 0; c < map->categories.size(); ++c) {
            addEntry(Entry::Kind::Swatch, map->categories[c].name, colourOf(static_cast<double>(c)));
        }
        const bool gaps =
            std::ranges::any_of(map->values, [](double value) { return !std::isfinite(value); });
        if (gaps) addEntry(Entry::Kind::Swatch, "no data", kNoData);
    }
    bool upwards = false;
    for (std::size_t s = 0; s < plot.series.size(); ++s) {
        const Series& series = plot.series[s];
        const auto kind = plot.bars ? Entry::Kind::Swatch : Entry::Kind::Series;
        if (!series.name.empty()) addEntry(kind, series.name, seriesColour(s), &series);
        upwards = upwards || std::ranges::any_of(series.points, [](const PlotPoint& point) {
                      return std::isinf(point.y) && point.y > 0;
                  });
    }
    if (upwards) addEntry(Entry::Kind::Arrow, plot.infinityName, "#555555");
}

void Legend::addEntry(Entry::Kind kind, const std::string& name, std::string colour, const Series* series) {
    entries_.push_back({kind, wrapText(name, kTextSize, kWidestName), std::move(colour), series});
}

std::string Legend::seriesColour(std::size_t series) const {
    return plot_.series[series].colour.value_or(paletteColour(series));
}

std::string Legend::cellColour(std::size_t cell) const {
    const FilledMap& map = *plot_.map;
    if (map.colours.empty()) return colourOf(map.values[cell]);
    const CellColour& colour = map.colours[cell];
    return fmt::format("#{:02x}{:02x}{:02x}", colour.red, colour.green, colour.blue);
}

std::string Legend::colourOf(double value) const {
    if (!std::isfinite(value)) return kNoData;
    const auto& categories = plot_.map->categories;
    if (categories.empty()) return scale_.drawable(value) ? mapColour(scale_.share(value)) : kNoData;
    const auto index = static_cast<std::size_t>(std::max(value, 0.0));
    if (index >= categories.size()) return kNoData;
    return categories[index].colour.value_or(paletteColour(index));
}

bool Legend::hasBar() const {
    return plot_.map && plot_.map->categories.empty() && plot_.map->colours.empty();
}

AxisLayout Legend::barAxis(double length) const {
    return layoutAxis(plot_.map->colour, plot_.map->values, length, 45, false);
}

double Legend::barWidth() const {
    if (!hasBar()) return 0;
    double labels = 0;
    for (const AxisTick& tick : barAxis(plot_.height).ticks) {
        labels = std::max(labels, textWidth(tick.label, kTextSize));
    }
    const double title = plot_.map->colour.title.empty() ? 0 : 20;
    return kGap + kBarWidth + 8 + labels + title;
}

double Legend::namesWidth() const {
    double widest = 0;
    for (const Entry& entry : entries_) {
        for (const std::string& line : entry.lines) widest = std::max(widest, textWidth(line, kTextSize));
    }
    return entries_.empty() ? 0 : kGap + kSymbolWidth + 6 + widest;
}

double Legend::width() const {
    return barWidth() + namesWidth();
}

double Legend::height() const {
    double height = 0;
    for (const Entry& entry : entries_) {
        height += static_cast<double>(entry.lines.size()) * kLineHeight + kEntryGap;
    }
    return height;
}

void Legend::drawBar(const PixelBox& frame, Canvas& canvas) const {
    const AxisLayout axis = barAxis(frame.height);
    const double x = frame.x + frame.width + kGap;
    for (int step = 0; step < kBarSteps; ++step) {
        const double top = frame.y + frame.height * (1 - (step + 1.0) / kBarSteps);
        // Each lies half a pixel over the one above, so that no seam shows.
        canvas.box({x, top, kBarWidth, frame.height / kBarSteps + 0.5}, mapColour((step + 0.5) / kBarSteps),
                   {});
    }
    canvas.frame({x, frame.y, kBarWidth, frame.height}, {"#555555"});
    for (const AxisTick& tick : axis.ticks) {
        const double y = frame.y + frame.height * (1 - axis.share(tick.value));
        canvas.line({x + kBarWidth, y, x + kBarWidth + 4, y}, {"#555555"});
        canvas.text(x + kBarWidth + 8, y + 4.3, tick.label, {.size = kTextSize});
    }
    const Axis& colour = plot_.map->colour;
    if (colour.title.empty()) return;
    const std::string title =
        colour.unit.empty() ? colour.title : fmt::format("{} ({})", colour.title, colour.unit);
    canvas.text(frame.x + frame.width + barWidth() - 4, frame.y + frame.height / 2, title,
                {.size = kTextSize, .anchor = Anchor::Middle, .turned = -90});
}

void Legend::drawEntry(const Entry& entry, double x, double y, Canvas& canvas) const {
    const double middle = x + kSymbolWidth / 2;
    const double axis = y + 6.5;
    switch (entry.kind) {
        case Entry::Kind::Swatch:
            canvas.box({x + 4, y, 18, 13}, entry.colour, {});
            canvas.frame({x + 4, y, 18, 13}, {"#999999", 0.8});
            break;
        case Entry::Kind::Arrow:
            canvas.arrowUp(middle, axis, entry.colour, {});
            break;
        case Entry::Kind::Series:
            if (entry.series->line != LineStyle::None) {
                canvas.line({x, axis, x + kSymbolWidth, axis}, seriesStroke(*entry.series, entry.colour));
            }
            canvas.marker(entry.series->marker, middle, axis, entry.colour, 1, {});
            break;
    }
    double textY = y + 11;
    for (const std::string& line : entry.lines) {
        canvas.text(x + kSymbolWidth + 6, textY, line, {.size = kTextSize});
        textY += kLineHeight;
    }
}

void Legend::draw(const PixelBox& frame, Canvas& canvas) const {
    if (hasBar()) drawBar(frame, canvas);
    const double x = frame.x + frame.width + barWidth() + kGap;
    double y = frame.y + 2;
    for (const Entry& entry : entries_) {
        drawEntry(entry, x, y, canvas);
        y += static_cast<double>(entry.lines.size()) * kLineHeight + kEntryGap;
    }
}

}  // namespace hairloom
