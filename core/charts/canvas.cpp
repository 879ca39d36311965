// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/charts/canvas.h"

#include <algorithm>

namespace hairloom {

std::string_view exponentOf(std::string_view text) {
    constexpr std::string_view kTen = "10^", kMinus = "\u2212";
    if (!text.starts_with(kTen) || text.size() == kTen.size()) return {};
    const std::string_view exponent = text.substr(kTen.size());
    std::string_view digits = exponent;
    if (digits.starts_with(kMinus)) digits.remove_prefix(kMinus.size());
    const bool whole =
        !digits.empty() && std::ranges::all_of(digits, [](char c) { return c >= '0' && c <= '9'; });
    return whole ? exponent : std::string_view();
}

const std::vector<MarkerCorner>& markerCorners(Marker marker) {
    static const std::vector<MarkerCorner> kNone, kSquare{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}},
        kTriangle{{0, -1.2}, {1.15, 0.9}, {-1.15, 0.9}}, kDiamond{{0, -1.3}, {1.3, 0}, {0, 1.3}, {-1.3, 0}},
        kCross{{-1, -1}, {1, 1}, {-1, 1}, {1, -1}}, kPlus{{-1.1, 0}, {1.1, 0}, {0, -1.1}, {0, 1.1}};
    switch (marker) {
        case Marker::Square:
            return kSquare;
        case Marker::TriangleUp:
            return kTriangle;
        case Marker::Diamond:
            return kDiamond;
        case Marker::Cross:
            return kCross;
        case Marker::Plus:
            return kPlus;
        case Marker::None:
        case Marker::Circle:
            break;
    }
    return kNone;
}

}  // namespace hairloom
