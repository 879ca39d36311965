// SPDX-License-Identifier: GPL-3.0-or-later
// Charts as images: their size, their colours, their text, and that equal plots give equal bytes.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/charts/markup.h"
#include "core/charts/plot.h"
#include "core/charts/stroke_font.h"

namespace hairloom::test {
namespace {

using Rgb = std::array<int, 3>;

Rgb pixel(const ChartImage& image, std::size_t x, std::size_t y) {
    const std::uint8_t* p = &image.rgba[4 * (y * image.width + x)];
    return {p[0], p[1], p[2]};
}

std::size_t count(const ChartImage& image, const Rgb& colour) {
    std::size_t found = 0;
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
        if (image.rgba[i] == colour[0] && image.rgba[i + 1] == colour[1] && image.rgba[i + 2] == colour[2])
            ++found;
    }
    return found;
}

Plot curvePlot() {
    Plot plot;
    plot.title = "N around the fibre";
    plot.x = {.title = "azimuth φ", .unit = "°", .low = -180.0, .high = 180.0};
    plot.y = {.title = "N", .low = 0.0, .high = 1.0};
    Series series{.name = "R", .colour = "#ff0000", .marker = Marker::None, .line = LineStyle::Solid};
    for (int x = -180; x <= 180; ++x) series.points.push_back({double(x), std::cos(x * 0.0087266)});
    plot.series.push_back(series);
    return plot;
}

TEST(PlotImage, HasTheSizeAskedForAndTheSameBytesAgain) {
    const ChartImage one = image(curvePlot(), 1.5);
    EXPECT_EQ(one.width, 1140u);
    EXPECT_EQ(one.height, 720u);
    ASSERT_EQ(one.rgba.size(), std::size_t{4} * 1140 * 720);
    EXPECT_EQ(one.rgba, image(curvePlot(), 1.5).rgba);
    for (std::size_t i = 3; i < one.rgba.size(); i += 4) ASSERT_EQ(one.rgba[i], 255);
    EXPECT_EQ(pixel(one, 0, 0), (Rgb{255, 255, 255}));
}

/// A wide frame is all there is to measure by: the curve's highest pixels lie in the middle, where cos is 1.
TEST(PlotImage, DrawsACurveWhereItsValuesAre) {
    const ChartImage drawn = image(curvePlot(), 1);
    EXPECT_GT(count(drawn, {255, 0, 0}), 500u);
    std::size_t top = drawn.height, at = 0, left = drawn.width, right = 0;
    for (std::size_t y = 0; y < drawn.height; ++y) {
        for (std::size_t x = 0; x < drawn.width * 4 / 5; ++x) {
            if (pixel(drawn, x, y) != (Rgb{255, 0, 0})) continue;
            if (y < top) {
                top = y;
                at = x;
            }
            left = std::min(left, x);
            right = std::max(right, x);
        }
    }
    EXPECT_NEAR(static_cast<double>(at), 0.5 * static_cast<double>(left + right),
                0.1 * static_cast<double>(right - left));
}

TEST(PlotImage, DashesLeaveGaps) {
    Plot plot = curvePlot();
    const std::size_t whole = count(image(plot, 1), {255, 0, 0});
    plot.series[0].line = LineStyle::Dashed;
    const std::size_t dashed = count(image(plot, 1), {255, 0, 0});
    EXPECT_GT(dashed, whole / 3);
    EXPECT_LT(dashed, 4 * whole / 5);
}

TEST(PlotImage, MapsShowTheirColoursWithoutABar) {
    Plot plot;
    FilledMap map{{0, 1, 2}, {0, 1, 2}, {}};
    map.colours = {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {255, 255, 0}};
    plot.map = map;
    const ChartImage drawn = image(plot, 1);
    std::set<std::size_t> areas;
    for (const Rgb& colour : {Rgb{255, 0, 0}, Rgb{0, 255, 0}, Rgb{0, 0, 255}, Rgb{255, 255, 0}}) {
        EXPECT_GT(count(drawn, colour), 50'000u);
        areas.insert(count(drawn, colour) / 4000);
    }
    EXPECT_LE(areas.size(), 2u) << "cells of one size";
    // Row 0 is the lowest.
    const std::size_t low = 3 * drawn.height / 4, high = drawn.height / 4;
    EXPECT_EQ(pixel(drawn, drawn.width / 4, low), (Rgb{255, 0, 0}));
    EXPECT_EQ(pixel(drawn, 3 * drawn.width / 4, high), (Rgb{255, 255, 0}));
    EXPECT_NE(svg(plot).find("#00ff00"), std::string::npos);
}

TEST(PlotImage, EveryMarkerIsDrawn) {
    std::set<std::size_t> inks;
    for (const Marker marker : {Marker::None, Marker::Circle, Marker::Square, Marker::TriangleUp,
                                Marker::Diamond, Marker::Cross, Marker::Plus}) {
        Plot plot;
        plot.series.push_back({.points = {{0, 0}, {1, 1}}, .colour = "#ff00ff", .marker = marker});
        inks.insert(count(image(plot, 4), {255, 0, 255}));
    }
    EXPECT_EQ(inks.size(), 7u);
    EXPECT_TRUE(inks.contains(0));
}

TEST(StrokeFont, HasWhatChartsWriteWithinTheWidthTheyReckonWith) {
    const Glyph& none = glyphOf(U'\uFFFD');
    std::string all;
    for (char c = '!'; c <= '~'; ++c) all += c;
    all += "°±²³µ·×−–—…½αβγημθπσφΔΣ";
    for (const char32_t code : codePoints(all)) {
        const Glyph& glyph = glyphOf(code);
        EXPECT_NE(&glyph, &none) << static_cast<std::uint32_t>(code);
        EXPECT_FALSE(glyph.strokes.empty());
        for (const GlyphStroke& stroke : glyph.strokes) {
            for (const auto& [x, y] : stroke.points) {
                EXPECT_GE(x, 0);
                EXPECT_LE(x, glyph.advance);
                EXPECT_GE(y, -2);
                EXPECT_LE(y, 8);
            }
        }
    }
    EXPECT_EQ(&glyphOf(U'漢'), &none);
    EXPECT_EQ(codePoints("a\xff"
                         "φ"),
              U"a\uFFFDφ");
    EXPECT_EQ(codePoints("θ_o = 3°"), U"θ_o = 3°");
}

TEST(StrokeFont, TextIsDrawnWhereItsPlaceSays) {
    Plot plot = curvePlot();
    plot.title = "";
    plot.x.title = plot.y.title = "";
    const auto ink = [](const ChartImage& drawn) {
        std::size_t dark = 0;
        for (std::size_t i = 0; i < drawn.rgba.size(); i += 4) dark += drawn.rgba[i] < 120 ? 1 : 0;
        return dark;
    };
    const std::size_t without = ink(image(plot, 1));
    plot.note = "A note that is read under the chart";
    const std::size_t with = ink(image(plot, 1));
    EXPECT_GT(with, without + 200);
    plot.note += ", and more of it that takes the next line or makes this one longer";
    EXPECT_GT(ink(image(plot, 1)), with + 200);
}

}  // namespace
}  // namespace hairloom::test
