// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Draws charts into an image, with smooth edges and text of single strokes. The same drawing gives the same
// bytes.

#include "core/charts/canvas.h"

namespace hairloom {

class RasterCanvas final : public Canvas {
  public:
    /// White; `scale` pixels of the image for one of the layout.
    RasterCanvas(double width, double height, double scale);

    void line(const PixelSegment& segment, const Stroke& stroke) override;
    void polyline(const std::vector<PixelSegment>& connected, const Stroke& stroke) override;
    void box(const PixelBox& box, const std::string& fill, std::string_view tooltip) override;
    void frame(const PixelBox& box, const Stroke& stroke) override;
    /// Each line takes the width that textWidth() says.
    void text(double x, double y, std::string_view text, const TextStyle& style) override;
    void marker(Marker marker, double x, double y, const std::string& colour, double opacity,
                std::string_view tooltip) override;
    void arrowUp(double x, double y, const std::string& colour, std::string_view tooltip) override;

    ChartImage finish() &&;

  private:
    struct Paint {
        double red, green, blue, opacity;
    };
    static Paint paintOf(std::string_view colour, double opacity);
    /// Round ends and joints; what strokes share is painted once. Places in pixels of the image.
    void strokes(const std::vector<PixelSegment>& segments, double width, const Paint& paint);
    /// A convex polygon, corners in pixels of the image.
    void fill(const std::vector<MarkerCorner>& corners, const Paint& paint);
    void blend(std::size_t x, std::size_t y, double cover, const Paint& paint);
    std::vector<PixelSegment> scaled(const std::vector<PixelSegment>& segments) const;

    double scale_;
    std::size_t width_, height_;
    std::vector<float> rgb_;
};

}  // namespace hairloom
