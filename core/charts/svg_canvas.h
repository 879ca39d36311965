// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Writes the elements of an SVG drawing. Coordinates are rounded to hundredths of a pixel.

#include <string>
#include <string_view>
#include <vector>

#include "core/charts/plot.h"
#include "core/charts/plot_labels.h"

namespace hairloom {

enum class Anchor { Start, Middle, End };

struct TextStyle {
    double size = 12;  ///< pixels
    Anchor anchor = Anchor::Start;
    const char* colour = "#222222";
    bool bold = false;
    bool halo = false;  ///< a white border, to be read over lines
    double turned = 0;  ///< degrees clockwise about the anchor
};

struct Stroke {
    std::string colour;
    double width = 1;
    const char* dashes = "";  ///< as stroke-dasharray
    double opacity = 1;
};

class SvgCanvas {
  public:
    SvgCanvas(double width, double height, std::string_view label);

    void line(const PixelSegment& segment, const Stroke& stroke);
    void polyline(const std::vector<PixelSegment>& connected, const Stroke& stroke);
    /// Sharp edges, so that neighbouring boxes show no seam.
    void box(const PixelBox& box, const std::string& fill, std::string_view tooltip = {});
    void frame(const PixelBox& box, const Stroke& stroke);
    /// `y` is the line of writing. "10^-3" is set with a raised exponent.
    void text(double x, double y, std::string_view text, const TextStyle& style);
    void marker(Marker marker, double x, double y, const std::string& colour, double opacity,
                std::string_view tooltip);
    /// An open triangle pointing up.
    void arrowUp(double x, double y, const std::string& colour, std::string_view tooltip);

    std::string finish() &&;

  private:
    std::string out_;
};

}  // namespace hairloom
