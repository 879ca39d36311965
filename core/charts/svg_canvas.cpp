// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/charts/svg_canvas.h"

#include <fmt/format.h>

#include "core/charts/markup.h"

namespace hairloom {
namespace {

/// "12.5", "3", "0": hundredths without trailing zeros.
std::string px(double value) {
    std::string text = fmt::format("{:.2f}", value);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text == "-0" ? "0" : text;
}

std::string strokeAttributes(const Stroke& stroke) {
    std::string text = fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"",
                                   escapeMarkup(stroke.colour), px(stroke.width));
    if (*stroke.dashes) text += fmt::format(" stroke-dasharray=\"{}\"", stroke.dashes);
    if (stroke.opacity < 1) text += fmt::format(" stroke-opacity=\"{}\"", px(stroke.opacity));
    return text;
}

const char* anchorName(Anchor anchor) {
    return anchor == Anchor::Start ? "start" : anchor == Anchor::Middle ? "middle" : "end";
}

/// "M x y L x y …" through the corners; those of open markers in pairs.
std::string markerPath(Marker marker, double x, double y) {
    const bool open = marker == Marker::Cross || marker == Marker::Plus;
    const std::vector<MarkerCorner>& corners = markerCorners(marker);
    const std::size_t stroke = open ? 2 : corners.size();
    std::string path;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        path += fmt::format("{}{} {}", i % stroke == 0 ? 'M' : 'L', px(x + corners[i].x * kMarkerRadius),
                            px(y + corners[i].y * kMarkerRadius));
    }
    return open ? path : path + 'Z';
}

/// An element that shows a text when a viewer hovers over it.
std::string withTooltip(const std::string& element, const std::string& attributes, std::string_view tooltip) {
    if (tooltip.empty()) return fmt::format("<{} {}/>\n", element, attributes);
    return fmt::format("<{} {}><title>{}</title></{}>\n", element, attributes, escapeMarkup(tooltip),
                       element);
}

}  // namespace

SvgCanvas::SvgCanvas(double width, double height, std::string_view label) {
    out_ = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
        "role=\"img\" aria-label=\"{2}\" font-family=\"Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', "
        "sans-serif\">\n<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n",
        px(width), px(height), escapeMarkup(label));
}

void SvgCanvas::line(const PixelSegment& s, const Stroke& stroke) {
    out_ += fmt::format("<path d=\"M{} {}L{} {}\" {}/>\n", px(s.x0), px(s.y0), px(s.x1), px(s.y1),
                        strokeAttributes(stroke));
}

void SvgCanvas::polyline(const std::vector<PixelSegment>& connected, const Stroke& stroke) {
    if (connected.empty()) return;
    std::string path;
    const PixelSegment* before = nullptr;
    for (const PixelSegment& s : connected) {
        const bool follows = before && before->x1 == s.x0 && before->y1 == s.y0;
        if (!follows) path += fmt::format("M{} {}", px(s.x0), px(s.y0));
        path += fmt::format("L{} {}", px(s.x1), px(s.y1));
        before = &s;
    }
    out_ += fmt::format("<path d=\"{}\" stroke-linejoin=\"round\" {}/>\n", path, strokeAttributes(stroke));
}

void SvgCanvas::box(const PixelBox& box, const std::string& fill, std::string_view tooltip) {
    out_ += withTooltip("rect",
                        fmt::format("x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\" "
                                    "shape-rendering=\"crispEdges\"",
                                    px(box.x), px(box.y), px(box.width), px(box.height), escapeMarkup(fill)),
                        tooltip);
}

void SvgCanvas::frame(const PixelBox& box, const Stroke& stroke) {
    out_ += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" {}/>\n", px(box.x), px(box.y),
                        px(box.width), px(box.height), strokeAttributes(stroke));
}

void SvgCanvas::text(double x, double y, std::string_view text, const TextStyle& style) {
    std::string attributes =
        fmt::format("x=\"{}\" y=\"{}\" font-size=\"{}\" text-anchor=\"{}\" fill=\"{}\"", px(x), px(y),
                    px(style.size), anchorName(style.anchor), style.colour);
    if (style.bold) attributes += " font-weight=\"bold\"";
    if (style.halo) {
        attributes +=
            " stroke=\"#ffffff\" stroke-width=\"3\" stroke-linejoin=\"round\" paint-order=\"stroke\"";
    }
    if (style.turned != 0) {
        attributes += fmt::format(" transform=\"rotate({} {} {})\"", px(style.turned), px(x), px(y));
    }
    const std::string_view exponent = exponentOf(text);
    const std::string content = exponent.empty()
                                    ? escapeMarkup(text)
                                    : fmt::format("10<tspan dy=\"{}\" font-size=\"{}\">{}</tspan>",
                                                  px(-0.4 * style.size), px(0.8 * style.size), exponent);
    out_ += fmt::format("<text {}>{}</text>\n", attributes, content);
}

void SvgCanvas::marker(Marker marker, double x, double y, const std::string& colour, double opacity,
                       std::string_view tooltip) {
    if (marker == Marker::None) return;
    const std::string safe = escapeMarkup(colour);
    const std::string faded = opacity < 1 ? fmt::format(" opacity=\"{}\"", px(opacity)) : std::string();
    if (marker == Marker::Circle) {
        out_ += withTooltip("circle",
                            fmt::format("cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"{}\" stroke=\"#ffffff\" "
                                        "stroke-width=\"0.8\"{}",
                                        px(x), px(y), px(kMarkerRadius), safe, faded),
                            tooltip);
        return;
    }
    const bool open = marker == Marker::Cross || marker == Marker::Plus;
    const std::string paint = open ? fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"2\"", safe)
                                   : fmt::format("fill=\"{}\" stroke=\"#ffffff\" stroke-width=\"0.8\"", safe);
    out_ +=
        withTooltip("path", fmt::format("d=\"{}\" {}{}", markerPath(marker, x, y), paint, faded), tooltip);
}

void SvgCanvas::arrowUp(double x, double y, const std::string& colour, std::string_view tooltip) {
    out_ += withTooltip("path",
                        fmt::format("d=\"{}\" fill=\"#ffffff\" stroke=\"{}\" stroke-width=\"1.6\"",
                                    markerPath(Marker::TriangleUp, x, y), escapeMarkup(colour)),
                        tooltip);
}

std::string SvgCanvas::finish() && {
    out_ += "</svg>\n";
    return std::move(out_);
}

}  // namespace hairloom
