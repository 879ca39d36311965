// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/charts/raster_canvas.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "core/charts/markup.h"
#include "core/charts/stroke_font.h"

namespace hairloom {
namespace {

constexpr double kDegree = 0.017453292519943295;
constexpr double kThin = 0.105, kBold = 0.165;  // strokes of text, of its size
constexpr double kHalo = 3;                     // pixels of the layout
constexpr double kExponentSize = 0.8, kExponentRise = 0.4;

double distance(double x, double y, const PixelSegment& s) {
    const double dx = s.x1 - s.x0, dy = s.y1 - s.y0;
    const double squared = dx * dx + dy * dy;
    const double t = squared > 0 ? std::clamp(((x - s.x0) * dx + (y - s.y0) * dy) / squared, 0.0, 1.0) : 0.0;
    return std::hypot(x - s.x0 - t * dx, y - s.y0 - t * dy);
}

/// Pixels of a side of `count` that what lies between `low` and `high` may touch.
struct Range {
    std::size_t begin, end;
    Range(double low, double high, std::size_t count) {
        const auto most = static_cast<double>(count);
        begin = static_cast<std::size_t>(std::clamp(std::floor(low), 0.0, most));
        end = static_cast<std::size_t>(std::clamp(std::ceil(high), 0.0, most));
        end = std::max(begin, end);
    }
};

double lengthOf(const PixelSegment& s) {
    return std::hypot(s.x1 - s.x0, s.y1 - s.y0);
}

/// The parts of a line that its dashes leave, "dash gap" in pixels of the layout.
std::vector<PixelSegment> dashed(const std::vector<PixelSegment>& line, const char* dashes) {
    std::istringstream in(dashes);
    double dash = 0, gap = 0;
    if (!(in >> dash >> gap) || dash <= 0 || gap <= 0) return line;
    std::vector<PixelSegment> parts;
    double at = 0;
    for (const PixelSegment& s : line) {
        const double length = lengthOf(s);
        for (double from = 0; from < length;) {
            const double place = std::fmod(at + from, dash + gap);
            const bool on = place < dash;
            const double to = std::min(length, from + std::max((on ? dash : dash + gap) - place, 1e-6));
            const auto point = [&](double t) {
                return std::array{s.x0 + t / length * (s.x1 - s.x0), s.y0 + t / length * (s.y1 - s.y0)};
            };
            if (on) parts.push_back({point(from)[0], point(from)[1], point(to)[0], point(to)[1]});
            from = to;
        }
        at += length;
    }
    return parts;
}

double unitsOf(std::u32string_view text) {
    double units = 0;
    for (const char32_t code : text) units += glyphOf(code).advance;
    return units;
}

/// A line of text that begins at 0 and stands on it, y downwards; `squeeze` is of its width.
void appendText(std::u32string_view text, double x, double rise, double unit, double squeeze,
                std::vector<PixelSegment>& out) {
    for (const char32_t code : text) {
        const Glyph& glyph = glyphOf(code);
        for (const GlyphStroke& stroke : glyph.strokes) {
            const auto place = [&](std::size_t i) {
                return std::array{x + squeeze * unit * stroke.points[i][0],
                                  -rise - unit * stroke.points[i][1]};
            };
            for (std::size_t i = 0; i < std::max<std::size_t>(stroke.points.size() - 1, 1); ++i) {
                const auto a = place(i), b = place(std::min(i + 1, stroke.points.size() - 1));
                out.push_back({a[0], a[1], b[0], b[1]});
            }
        }
        x += squeeze * unit * glyph.advance;
    }
}

}  // namespace

RasterCanvas::RasterCanvas(double width, double height, double scale)
    : scale_(scale),
      width_(static_cast<std::size_t>(std::lround(width * scale))),
      height_(static_cast<std::size_t>(std::lround(height * scale))),
      rgb_(3 * width_ * height_, 1.0f) {}

RasterCanvas::Paint RasterCanvas::paintOf(std::string_view colour, double opacity) {
    const auto channel = [&](std::size_t at) {
        int value = 0;
        if (colour.size() == 7) std::from_chars(colour.data() + at, colour.data() + at + 2, value, 16);
        return value / 255.0;
    };
    return {channel(1), channel(3), channel(5), opacity};
}

void RasterCanvas::blend(std::size_t x, std::size_t y, double cover, const Paint& paint) {
    float* pixel = &rgb_[3 * (y * width_ + x)];
    const double share = std::clamp(cover, 0.0, 1.0) * paint.opacity;
    const double colour[3] = {paint.red, paint.green, paint.blue};
    for (int c = 0; c < 3; ++c)
        pixel[c] = static_cast<float>(static_cast<double>(pixel[c]) * (1 - share) + colour[c] * share);
}

std::vector<PixelSegment> RasterCanvas::scaled(const std::vector<PixelSegment>& segments) const {
    std::vector<PixelSegment> result;
    for (const PixelSegment& s : segments)
        result.push_back({s.x0 * scale_, s.y0 * scale_, s.x1 * scale_, s.y1 * scale_});
    return result;
}

void RasterCanvas::strokes(const std::vector<PixelSegment>& segments, double width, const Paint& paint) {
    if (segments.empty()) return;
    // A line thinner than a pixel is a pixel wide and lighter.
    const double half = 0.5 * std::max(width, 1.0), light = std::min(width, 1.0), reach = half + 1;
    double left = 1e30, right = -1e30, top = 1e30, bottom = -1e30;
    for (const PixelSegment& s : segments) {
        left = std::min({left, s.x0, s.x1});
        right = std::max({right, s.x0, s.x1});
        top = std::min({top, s.y0, s.y1});
        bottom = std::max({bottom, s.y0, s.y1});
    }
    const Range columns(left - reach, right + reach, width_), rows(top - reach, bottom + reach, height_);
    const std::size_t wide = columns.end - columns.begin;
    std::vector<float> cover(wide * (rows.end - rows.begin));
    for (const PixelSegment& s : segments) {
        const Range xs(std::min(s.x0, s.x1) - reach, std::max(s.x0, s.x1) + reach, width_);
        const Range ys(std::min(s.y0, s.y1) - reach, std::max(s.y0, s.y1) + reach, height_);
        for (std::size_t y = ys.begin; y < ys.end; ++y) {
            for (std::size_t x = xs.begin; x < xs.end; ++x) {
                const double away = distance(static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5, s);
                float& most = cover[(y - rows.begin) * wide + x - columns.begin];
                most = std::max(most, static_cast<float>(light * std::clamp(half + 0.5 - away, 0.0, 1.0)));
            }
        }
    }
    for (std::size_t y = rows.begin; y < rows.end; ++y) {
        for (std::size_t x = columns.begin; x < columns.end; ++x) {
            const float share = cover[(y - rows.begin) * wide + x - columns.begin];
            if (share > 0) blend(x, y, static_cast<double>(share), paint);
        }
    }
}

void RasterCanvas::fill(const std::vector<MarkerCorner>& corners, const Paint& paint) {
    constexpr int kSamples = 4;  // a side of a pixel
    double left = 1e30, right = -1e30, top = 1e30, bottom = -1e30, area = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const MarkerCorner &a = corners[i], &b = corners[(i + 1) % corners.size()];
        left = std::min(left, a.x);
        right = std::max(right, a.x);
        top = std::min(top, a.y);
        bottom = std::max(bottom, a.y);
        area += a.x * b.y - b.x * a.y;
    }
    const auto inside = [&](double x, double y) {
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const MarkerCorner &a = corners[i], &b = corners[(i + 1) % corners.size()];
            if (((b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x)) * area < 0) return false;
        }
        return true;
    };
    const Range xs(left, right, width_), ys(top, bottom, height_);
    for (std::size_t y = ys.begin; y < ys.end; ++y) {
        for (std::size_t x = xs.begin; x < xs.end; ++x) {
            int covered = 0;
            for (int s = 0; s < kSamples * kSamples; ++s) {
                covered += inside(static_cast<double>(x) + (s % kSamples + 0.5) / kSamples,
                                  static_cast<double>(y) + (s / kSamples + 0.5) / kSamples)
                               ? 1
                               : 0;
            }
            if (covered > 0) blend(x, y, covered / double{kSamples * kSamples}, paint);
        }
    }
}

void RasterCanvas::line(const PixelSegment& segment, const Stroke& stroke) {
    polyline({segment}, stroke);
}

void RasterCanvas::polyline(const std::vector<PixelSegment>& connected, const Stroke& stroke) {
    strokes(scaled(dashed(connected, stroke.dashes)), stroke.width * scale_,
            paintOf(stroke.colour, stroke.opacity));
}

void RasterCanvas::box(const PixelBox& box, const std::string& colour, std::string_view) {
    const auto edge = [&](double at) { return std::round(at * scale_); };
    const Range xs(edge(box.x), edge(box.x + box.width), width_);
    const Range ys(edge(box.y), edge(box.y + box.height), height_);
    const Paint paint = paintOf(colour, 1);
    for (std::size_t y = ys.begin; y < ys.end; ++y) {
        for (std::size_t x = xs.begin; x < xs.end; ++x) blend(x, y, 1, paint);
    }
}

void RasterCanvas::frame(const PixelBox& box, const Stroke& stroke) {
    const double right = box.x + box.width, bottom = box.y + box.height;
    polyline({{box.x, box.y, right, box.y},
              {right, box.y, right, bottom},
              {right, bottom, box.x, bottom},
              {box.x, bottom, box.x, box.y}},
             stroke);
}

void RasterCanvas::text(double x, double y, std::string_view text, const TextStyle& style) {
    const std::string_view exponent = exponentOf(text);
    const std::u32string base = codePoints(exponent.empty() ? text : text.substr(0, 2));
    const std::u32string raised = codePoints(exponent);
    const double unit = style.size / kGlyphUnitsPerSize;
    const double natural = unit * (unitsOf(base) + kExponentSize * unitsOf(raised));
    const double room = exponent.empty() ? textWidth(text, style.size) : natural;
    if (natural <= 0) return;
    const double squeeze = std::min(room / natural, 1.1), width = natural * squeeze;
    const double begin = style.anchor == Anchor::Start ? 0
                         : style.anchor == Anchor::End ? -width
                                                       : -width / 2;
    std::vector<PixelSegment> line;
    appendText(base, begin, 0, unit, squeeze, line);
    appendText(raised, begin + squeeze * unit * unitsOf(base), kExponentRise * style.size,
               kExponentSize * unit, squeeze, line);
    const double cosine = std::cos(style.turned * kDegree), sine = std::sin(style.turned * kDegree);
    for (PixelSegment& s : line) {
        s = {x + cosine * s.x0 - sine * s.y0, y + sine * s.x0 + cosine * s.y0,
             x + cosine * s.x1 - sine * s.y1, y + sine * s.x1 + cosine * s.y1};
    }
    const std::vector<PixelSegment> segments = scaled(line);
    const double thick = scale_ * style.size * (style.bold ? kBold : kThin);
    if (style.halo) strokes(segments, thick + kHalo * scale_, paintOf("#ffffff", 1));
    strokes(segments, thick, paintOf(style.colour, 1));
}

void RasterCanvas::marker(Marker marker, double x, double y, const std::string& colour, double opacity,
                          std::string_view) {
    if (marker == Marker::None) return;
    const Paint paint = paintOf(colour, opacity), white = paintOf("#ffffff", opacity);
    const double radius = kMarkerRadius * scale_, border = 0.4;
    if (marker == Marker::Circle) {
        const std::vector<PixelSegment> middle{{x * scale_, y * scale_, x * scale_, y * scale_}};
        strokes(middle, 2 * (radius + border * scale_), white);
        return strokes(middle, 2 * (radius - border * scale_), paint);
    }
    const std::vector<MarkerCorner>& corners = markerCorners(marker);
    if (marker == Marker::Cross || marker == Marker::Plus) {
        std::vector<PixelSegment> lines;
        for (std::size_t i = 0; i + 1 < corners.size(); i += 2) {
            lines.push_back({x * scale_ + corners[i].x * radius, y * scale_ + corners[i].y * radius,
                             x * scale_ + corners[i + 1].x * radius, y * scale_ + corners[i + 1].y * radius});
        }
        return strokes(lines, 2 * scale_, paint);
    }
    for (const double size : {1 + border / kMarkerRadius, 1 - border / kMarkerRadius}) {
        std::vector<MarkerCorner> placed;
        for (const MarkerCorner& corner : corners)
            placed.push_back({x * scale_ + size * radius * corner.x, y * scale_ + size * radius * corner.y});
        fill(placed, size > 1 ? white : paint);
    }
}

void RasterCanvas::arrowUp(double x, double y, const std::string& colour, std::string_view) {
    const std::vector<MarkerCorner>& corners = markerCorners(Marker::TriangleUp);
    std::vector<MarkerCorner> placed;
    for (const MarkerCorner& corner : corners)
        placed.push_back({scale_ * (x + kMarkerRadius * corner.x), scale_ * (y + kMarkerRadius * corner.y)});
    fill(placed, paintOf("#ffffff", 1));
    std::vector<PixelSegment> edges;
    for (std::size_t i = 0; i < placed.size(); ++i) {
        const MarkerCorner &a = placed[i], &b = placed[(i + 1) % placed.size()];
        edges.push_back({a.x, a.y, b.x, b.y});
    }
    strokes(edges, 1.6 * scale_, paintOf(colour, 1));
}

ChartImage RasterCanvas::finish() && {
    ChartImage image{static_cast<std::uint32_t>(width_), static_cast<std::uint32_t>(height_), {}};
    image.rgba.reserve(4 * width_ * height_);
    for (std::size_t i = 0; i < width_ * height_; ++i) {
        for (std::size_t c = 0; c < 3; ++c)
            image.rgba.push_back(static_cast<std::uint8_t>(std::lround(255 * rgb_[3 * i + c])));
        image.rgba.push_back(255);
    }
    return image;
}

}  // namespace hairloom
