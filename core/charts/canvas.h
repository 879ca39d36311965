// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What charts are drawn on. Coordinates are pixels of the layout, y downwards.

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
    std::string colour;  ///< "#rrggbb"
    double width = 1;
    const char* dashes = "";  ///< lengths of dash and gap: "6 4"; "" for a whole line
    double opacity = 1;
};

class Canvas {
  public:
    virtual ~Canvas() = default;

    virtual void line(const PixelSegment& segment, const Stroke& stroke) = 0;
    virtual void polyline(const std::vector<PixelSegment>& connected, const Stroke& stroke) = 0;
    /// Sharp edges, so that neighbouring boxes show no seam.
    virtual void box(const PixelBox& box, const std::string& fill, std::string_view tooltip) = 0;
    virtual void frame(const PixelBox& box, const Stroke& stroke) = 0;
    /// `y` is the line of writing. "10^-3" is set with a raised exponent.
    virtual void text(double x, double y, std::string_view text, const TextStyle& style) = 0;
    virtual void marker(Marker marker, double x, double y, const std::string& colour, double opacity,
                        std::string_view tooltip) = 0;
    /// An open triangle pointing up.
    virtual void arrowUp(double x, double y, const std::string& colour, std::string_view tooltip) = 0;
};

inline constexpr double kMarkerRadius = 4;
struct MarkerCorner {
    double x, y;
};
/// Corners in marker radii about the middle. Cross and plus are pairs of ends, all others closed; a circle
/// and no marker have none.
const std::vector<MarkerCorner>& markerCorners(Marker marker);

/// The exponent of "10^-3", or nothing. Only what layoutAxis writes counts: titles may hold any other '^'.
std::string_view exponentOf(std::string_view text);

}  // namespace hairloom
