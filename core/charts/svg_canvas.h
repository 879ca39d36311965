// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Writes the elements of an SVG drawing. Coordinates are rounded to hundredths of a pixel.

#include "core/charts/canvas.h"

namespace hairloom {

class SvgCanvas final : public Canvas {
  public:
    SvgCanvas(double width, double height, std::string_view label);

    void line(const PixelSegment& segment, const Stroke& stroke) override;
    void polyline(const std::vector<PixelSegment>& connected, const Stroke& stroke) override;
    void box(const PixelBox& box, const std::string& fill, std::string_view tooltip) override;
    void frame(const PixelBox& box, const Stroke& stroke) override;
    void text(double x, double y, std::string_view text, const TextStyle& style) override;
    void marker(Marker marker, double x, double y, const std::string& colour, double opacity,
                std::string_view tooltip) override;
    void arrowUp(double x, double y, const std::string& colour, std::string_view tooltip) override;

    std::string finish() &&;

  private:
    std::string out_;
};

}  // namespace hairloom
