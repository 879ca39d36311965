// SPDX-License-Identifier: GPL-3.0-or-later
// Charts: well-formed, with sensible ticks, nothing clipped, nothing printed over something else.

#include "core/charts/plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/charts/markup.h"
#include "core/charts/plot_labels.h"
#include "core/charts/plot_ticks.h"
#include "tests/accuracy/xml_check.h"

namespace hairloom::test {
namespace {

using testing::Contains;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::Pointwise;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<std::string> labelsOf(const AxisLayout& axis) {
    std::vector<std::string> labels;
    for (const AxisTick& tick : axis.ticks) labels.push_back(tick.label);
    return labels;
}

std::vector<XmlElement> parsed(const Plot& plot) {
    const auto elements = parseXml(svg(plot));
    EXPECT_TRUE(elements.has_value());
    return elements.value_or(std::vector<XmlElement>());
}

std::vector<std::string> texts(const Plot& plot) {
    std::vector<std::string> found;
    for (const XmlElement& element : named(parsed(plot), "text")) found.push_back(element.text);
    return found;
}

Plot logarithmicPlot() {
    Plot plot;
    plot.title = "Error against time";
    plot.x = {.title = "time per frame", .unit = "ms", .scale = Scale::Logarithmic};
    plot.y = {.title = "error", .unit = "mm", .scale = Scale::Logarithmic};
    plot.series.push_back(
        {.name = "verlet", .points = {{0.1, 20}, {1, 0.5}, {30, 0.0002}}, .line = LineStyle::Solid});
    return plot;
}

TEST(Ticks, LinearStepsAreOneTwoOrFive) {
    EXPECT_DOUBLE_EQ(niceStep(0.7), 1);
    EXPECT_DOUBLE_EQ(niceStep(1.0), 1);
    EXPECT_DOUBLE_EQ(niceStep(1.2), 2);
    EXPECT_DOUBLE_EQ(niceStep(0.03), 0.05);
    EXPECT_DOUBLE_EQ(niceStep(6e6), 1e7);
    Axis axis;
    axis.low = 0;
    axis.high = 2;
    EXPECT_THAT(labelsOf(layoutAxis(axis, {}, 450, 100, true)),
                ElementsAre("0.0", "0.5", "1.0", "1.5", "2.0"));
    axis.low = -40;
    axis.high = 40;
    EXPECT_THAT(labelsOf(layoutAxis(axis, {}, 450, 100, true)), ElementsAre("−40", "−20", "0", "20", "40"));
}

TEST(Ticks, LogarithmicAxesShowDecades) {
    Axis axis;
    axis.scale = Scale::Logarithmic;
    axis.low = 1e-5;
    axis.high = 1;
    const AxisLayout decades = layoutAxis(axis, {}, 600, 60, true);
    EXPECT_THAT(labelsOf(decades), ElementsAre("10^−5", "10^−4", "10^−3", "10^−2", "10^−1", "10^0"));
    EXPECT_EQ(decades.minorTicks.size(), 5u * 8u);
    axis.low = 0.01;
    EXPECT_THAT(labelsOf(layoutAxis(axis, {}, 600, 60, true)), ElementsAre("0.01", "0.1", "1"));
    axis.low = 0.3;
    axis.high = 6;
    EXPECT_THAT(labelsOf(layoutAxis(axis, {}, 600, 60, true)), ElementsAre("0.5", "1", "2", "5"));
    axis.low = 1e-30;
    axis.high = 1e30;
    const AxisLayout wide = layoutAxis(axis, {}, 300, 60, true);
    EXPECT_LE(wide.ticks.size(), 6u);
    EXPECT_GE(wide.ticks.size(), 3u);
}

TEST(Ticks, ANarrowLogarithmicRangeStillHasTwo) {
    Axis axis;
    axis.scale = Scale::Logarithmic;
    axis.low = 3.1;
    axis.high = 3.4;
    EXPECT_GE(layoutAxis(axis, {}, 600, 60, true).ticks.size(), 2u);
}

TEST(Ticks, RangesHoldAllDataEvenOneValueOrNone) {
    Axis linear, logarithmic;
    logarithmic.scale = Scale::Logarithmic;
    for (const std::vector<double>& values :
         {std::vector<double>{}, {5.0}, {0.0}, {-3.0, 8.0}, {kInfinity, kNoNumber, 2.0}, {1e-300, 1e300}}) {
        for (const Axis& axis : {linear, logarithmic}) {
            const AxisLayout layout = layoutAxis(axis, values, 500, 60, true);
            ASSERT_LT(layout.low, layout.high);
            for (const double value : values)
                EXPECT_EQ(layout.within(value), layout.drawable(value)) << value;
            for (const AxisTick& tick : layout.ticks) EXPECT_TRUE(layout.within(tick.value));
        }
    }
}

TEST(Ticks, CellEdgesLieHalfWay) {
    EXPECT_THAT(cellEdges({1, 2, 4}, Scale::Linear), ElementsAre(0.5, 1.5, 3, 5));
    const std::vector<double> expected{1 / std::sqrt(2), std::sqrt(2), 2 * std::sqrt(2), 4 * std::sqrt(2)};
    EXPECT_THAT(cellEdges({1, 2, 4}, Scale::Logarithmic), Pointwise(DoubleNear(1e-12), expected));
    EXPECT_THAT(cellEdges({3}, Scale::Linear), ElementsAre(2.5, 3.5));
}

TEST(Markup, EscapesWhatWouldBreakADocument) {
    EXPECT_EQ(escapeMarkup("a<b & \"c\" > 'd'"), "a&lt;b &amp; &quot;c&quot; &gt; &#39;d&#39;");
    EXPECT_EQ(escapeMarkup("m/s² ×"), "m/s² ×");
    EXPECT_EQ(escapeMarkup(std::string("a\0\x1b", 3)), "a  ");
    EXPECT_EQ(escapeMarkup("\xff\xc3("), "\uFFFD\uFFFD(");
    EXPECT_EQ(escapeMarkup("\xed\xa0\x80"), "\uFFFD\uFFFD\uFFFD") << "a surrogate";
}

TEST(Markup, WrapsAtSpacesAndLosesNothing) {
    const std::string text = "a rather long title that has to be broken into several lines somewhere";
    const auto lines = wrapText(text, 12, 140);
    ASSERT_GT(lines.size(), 2u);
    std::string joined;
    for (const std::string& line : lines) {
        EXPECT_LE(textWidth(line, 12), 140);
        joined += (joined.empty() ? "" : " ") + line;
    }
    EXPECT_EQ(joined, text);
    EXPECT_EQ(wrapText("", 12, 100).size(), 1u);
}

TEST(Labels, CoverNeitherOneAnotherNorPointsNorTheFrame) {
    const PixelBox frame{0, 0, 300, 200};
    std::vector<LabelRequest> requests;
    std::vector<PixelBox> obstacles;
    for (int i = 0; i < 10; ++i) {  // close together, and two in corners
        const double x = i == 0 ? 2 : i == 1 ? 298 : 100 + 9 * i;
        const double y = i == 0 ? 2 : i == 1 ? 198 : 100 - 4 * i;
        requests.push_back({x, y, 60, 15});
        obstacles.push_back({x - 5, y - 5, 10, 10});
    }
    const auto places = placeLabels(requests, frame, obstacles, {});
    std::vector<PixelBox> placed;
    for (const auto& place : places) {
        if (!place) continue;
        EXPECT_TRUE(frame.contains(place->box));
        for (const PixelBox& other : obstacles) EXPECT_FALSE(place->box.overlaps(other));
        for (const PixelBox& other : placed) EXPECT_FALSE(place->box.overlaps(other));
        placed.push_back(place->box);
    }
    EXPECT_GE(placed.size(), 6u);
}

TEST(Labels, WithoutASpaceLeftThereIsNoLabel) {
    const auto places = placeLabels({{10, 10, 60, 15}}, {0, 0, 50, 50}, {}, {});
    EXPECT_FALSE(places[0].has_value());
}

TEST(Labels, PreferSidesWithoutLines) {
    const PixelSegment line{100, 100, 200, 40};  // goes up to the right, where a label would stand first
    const auto places = placeLabels({{100, 100, 40, 15}}, {0, 0, 300, 200}, {}, {line});
    ASSERT_TRUE(places[0].has_value());
    EXPECT_FALSE(clipped(line, places[0]->box).has_value());
}

TEST(Plots, AreWellFormedWithTitlesUnitsAndLegend) {
    const auto found = texts(logarithmicPlot());
    EXPECT_THAT(found, Contains("Error against time"));
    EXPECT_THAT(found, Contains("time per frame (ms)"));
    EXPECT_THAT(found, Contains("error (mm)"));
    EXPECT_THAT(found, Contains("verlet"));
    EXPECT_EQ(named(parsed(logarithmicPlot()), "circle").size(), 3u + 1u) << "points and the legend's";
}

TEST(Plots, EqualPlotsGiveEqualBytes) {
    EXPECT_EQ(svg(logarithmicPlot()), svg(logarithmicPlot()));
}

TEST(Plots, PointsStandWhereTheAxesSay) {
    Plot plot;
    plot.x = {.title = "x", .low = 0, .high = 10};
    plot.y = {.title = "y", .low = 0, .high = 10};
    plot.series.push_back({.points = {{0, 0}, {10, 10}, {5, 2.5}}});
    const auto circles = named(parsed(plot), "circle");
    ASSERT_EQ(circles.size(), 3u);
    const auto at = [&](std::size_t i, const char* key) { return std::stod(circles[i].attributes.at(key)); };
    EXPECT_NEAR(at(2, "cx"), (at(0, "cx") + at(1, "cx")) / 2, 0.02);
    EXPECT_NEAR(at(2, "cy"), at(0, "cy") + 0.25 * (at(1, "cy") - at(0, "cy")), 0.02);
    EXPECT_LT(at(1, "cy"), at(0, "cy")) << "up is up";
}

TEST(Plots, HostileTextStaysText) {
    Plot plot = logarithmicPlot();
    plot.title = "<script>alert(\"&\")</script>";
    plot.series[0].name = "a & b < c";
    plot.series[0].points[0].label = "</text>";
    plot.series[0].points[0].tooltip = "\x01 \xff";
    plot.series[0].colour = "\" onload=\"x";
    EXPECT_THAT(texts(plot), Contains("<script>alert(\"&\")</script>"));
    EXPECT_THAT(svg(plot), Not(HasSubstr("<script")));
}

TEST(Plots, NothingIsPrintedOutsideTheDrawing) {
    Plot plot = logarithmicPlot();
    plot.title = std::string(150, 'W').append(" and more of it ").append(60, 'w');
    plot.note =
        "A note that goes on for a while, so that it has to be broken into lines, one under the other, "
        "until all of it has been said, which may take more than two of them at this width.";
    plot.title =
        "A title that goes on for a while, so that it has to be broken into lines, one under the other";
    plot.width = 420;
    plot.series[0].name = "a name of a series that is far too long for the margin of so small a chart";
    plot.x.ticks = {{0.1, "the first category"}, {1, "the second category"}, {30, "the third category"}};
    const auto elements = parsed(plot);
    const double width = std::stod(elements[0].attributes.at("width"));
    const double height = std::stod(elements[0].attributes.at("height"));
    const auto texts = named(elements, "text");
    EXPECT_GE(texts.size(), 8u) << "title, note, ticks and a series";
    for (const XmlElement& text : texts) {
        if (text.attributes.contains("transform")) continue;
        const double x = std::stod(text.attributes.at("x")), y = std::stod(text.attributes.at("y"));
        const double wide = textWidth(text.text, std::stod(text.attributes.at("font-size")));
        const std::string anchor = text.attributes.at("text-anchor");
        const double left = anchor == "start" ? x : anchor == "end" ? x - wide : x - wide / 2;
        EXPECT_GE(left, 0) << text.text;
        EXPECT_LE(left + wide, width) << text.text;
        EXPECT_GE(y, 8) << text.text;
        EXPECT_LE(y, height) << text.text;
    }
}

TEST(Plots, WhatCannotBeDrawnIsLeftOutAndInfinityPointsUp) {
    Plot plot = logarithmicPlot();
    plot.infinityName = "diverged";
    plot.series[0].points = {{1, 1}, {2, kNoNumber}, {3, -1}, {kNoNumber, 2}, {4, kInfinity}, {5, 2}};
    EXPECT_EQ(named(parsed(plot), "circle").size(), 2u + 1u);
    EXPECT_THAT(texts(plot), Contains("diverged"));
    EXPECT_THAT(svg(plot), Not(HasSubstr("nan")));
    EXPECT_THAT(svg(plot), Not(HasSubstr("inf")));
}

TEST(Plots, AnEmptyPlotIsStillADrawing) {
    EXPECT_FALSE(parsed(Plot()).empty());
}

Plot mapPlot() {
    Plot plot;
    plot.x = {.title = "step", .unit = "ms", .scale = Scale::Logarithmic};
    plot.y = {.title = "stiffness"};
    FilledMap map;
    map.xEdges = cellEdges({1, 2, 4}, Scale::Logarithmic);
    map.yEdges = cellEdges({0, 1}, Scale::Linear);
    map.values = {0, 1, 2, 3, kNoNumber, 5};
    map.colour = {.title = "growth", .unit = "1/s"};
    plot.map = map;
    return plot;
}

TEST(Maps, ContinuousOnesHaveAColourBar) {
    const auto found = texts(mapPlot());
    EXPECT_THAT(found, Contains("growth (1/s)"));
    EXPECT_THAT(found, Contains("no data"));
    const std::string text = svg(mapPlot());
    EXPECT_THAT(text, HasSubstr(mapColour(0)));
    EXPECT_THAT(text, HasSubstr(mapColour(1)));
    EXPECT_THAT(text, HasSubstr(mapColour(0.4)));
}

TEST(Maps, CellsFillTheFrameWithoutGaps) {
    Plot plot = mapPlot();
    plot.map->categories = {{"calm"}, {"rings"}, {"grows", "#123456"}, {"x"}, {"y"}, {"z"}};
    const auto elements = parsed(plot);
    double area = 0, frame = 0;
    for (const XmlElement& box : named(elements, "rect")) {
        if (!box.attributes.contains("x")) continue;
        const double size = std::stod(box.attributes.at("width")) * std::stod(box.attributes.at("height"));
        const bool swatch = size < 300;
        if (swatch) continue;
        if (box.attributes.contains("shape-rendering"))
            area += size;
        else
            frame = std::max(frame, size);
    }
    EXPECT_NEAR(area, frame, 0.001 * frame);
    EXPECT_THAT(texts(plot), Contains("rings"));
    EXPECT_THAT(svg(plot), HasSubstr("#123456"));
}

TEST(Maps, LightnessOfTheColourBarOnlyRises) {
    double before = -1;
    for (int i = 0; i <= 32; ++i) {
        const std::string c = mapColour(i / 32.0);
        const auto channel = [&](std::size_t at) { return std::stoi(c.substr(at, 2), nullptr, 16); };
        const double lightness = 0.2126 * channel(1) + 0.7152 * channel(3) + 0.0722 * channel(5);
        EXPECT_GT(lightness, before);
        before = lightness;
    }
}

}  // namespace
}  // namespace hairloom::test
