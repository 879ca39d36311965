// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/charts/stroke_font.h"

#include <algorithm>
#include <unordered_map>

#include "core/charts/markup.h"

namespace hairloom {
namespace {

/// Strokes between spaces, a place two characters: x from 0 on, y from 'a', 2 units below the line of
/// writing, over 'c', the line itself, 'h', the height of small letters, to 'j', that of capitals. '~' begins
/// a round stroke, whose corners are cut.
struct Drawing {
    char32_t code;
    const char* strokes;
};

// clang-format off
constexpr Drawing kDrawings[] = {
    {U' ', ""}, {U'!', "0j0e 0c0c"}, {U'"', "0j0h 2j2h"}, {U'#', "1c2j 3c4j 0e5e 0h5h"},
    {U'$', "~4i3j1j0i0h1g3f4e4d3c1c0d 2k2b"}, {U'%', "~1j0j0h2h2j1j ~4e3e3c5c5e4e 5j0c"},
    {U'&', "~5c1g1j3j3h0f0c3c5f"}, {U'\'', "0j0h"}, {U'(', "~2k0i0d2b"}, {U')', "~0k2i2d0b"},
    {U'*', "2j2f 0i4g 4i0g"}, {U'+', "0f4f 2h2d"}, {U',', "1d1c0b"}, {U'-', "0f2f"}, {U'.', "0c0c"}, {U'/', "0b3j"},
    {U'0', "~2j0j0c4c4j2j"}, {U'1', "0i2j2c"}, {U'2', "~0h0j4j4g0c 0c4c"}, {U'3', "~0i0j4j4g2g ~2g4g4c0c0d"},
    {U'4', "3c3j0e4e"}, {U'5', "4j0j0g ~0g4h4c0c0d"}, {U'6', "~4i4j0j0c4c4g0g0e"}, {U'7', "0j4j1c"},
    {U'8', "~2g4g4j0j0g2g ~2g4g4c0c0g2g"}, {U'9', "~0d0c4c4j0j0f4f4h"},
    {U':', "0g0g 0c0c"}, {U';', "1g1g 1d1c0b"}, {U'<', "4h0f4d"}, {U'=', "0g4g 0e4e"}, {U'>', "0h4f0d"},
    {U'?', "~0i0j4j4g2g2e 2c2c"}, {U'@', "~5e4e4h2h2e4e6e6j0j0c5c"},
    {U'A', "0c3j6c 1e5e"}, {U'B', "0c0j ~0j4j5j5g3g0g ~0g4g5g5c3c0c"}, {U'C', "~5h5j0j0c5c5e"}, {U'D', "0c0j ~0j3j5j5c3c0c"},
    {U'E', "4j0j0c4c 0g4g"}, {U'F', "4j0j0c 0g4g"}, {U'G', "~5h5j0j0c5c5f 5f3f"}, {U'H', "0c0j 5c5j 0g5g"}, {U'I', "0c0j"},
    {U'J', "~3j3c0c0e"}, {U'K', "0c0j 5j0f 2g5c"}, {U'L', "0j0c4c"}, {U'M', "0c0j3e6j6c"}, {U'N', "0c0j5c5j"},
    {U'O', "~3j0j0c6c6j3j"}, {U'P', "0c0j ~0j4j5j5f3f0f"}, {U'Q', "~3j0j0c6c6j3j 4e6b"}, {U'R', "0c0j ~0j4j5j5f3f0f 3f5c"},
    {U'S', "~5i5j0j0g5g5c0c0d"}, {U'T', "0j6j 3j3c"}, {U'U', "~0j0c5c5j"}, {U'V', "0j3c6j"}, {U'W', "0j2c4j6c8j"},
    {U'X', "0j5c 5j0c"}, {U'Y', "0j3g6j 3g3c"}, {U'Z', "0j5j0c5c"},
    {U'[', "2k0k0b2b"}, {U'\\', "0j3b"}, {U']', "0k2k2b0b"}, {U'^', "0g2j4g"}, {U'_', "0b5b"}, {U'`', "0k1i"},
    {U'a', "~0g0h4h4c ~4f0f0c4c4e"}, {U'b', "0j0c ~0f0h4h4c0c0e"}, {U'c', "~4g4h0h0c4c4d"}, {U'd', "4j4c ~4f4h0h0c4c4e"},
    {U'e', "0f4f ~4f4h0h0c4c4d"}, {U'f', "~3j1j1g 1h1c 0h3h"}, {U'g', "~4h4a0a0b ~4f4h0h0c4c4e"}, {U'h', "0j0c ~0f0h4h4e 4e4c"},
    {U'i', "0h0c 0j0j"}, {U'j', "1j1j ~1h1a0a"}, {U'k', "0j0c 4h0e 1f4c"}, {U'l', "0j0c"}, {U'm', "0h0c ~0f0h3h3e 3f3c ~3f3h6h6e 6f6c"},
    {U'n', "0h0c ~0f0h4h4e 4f4c"}, {U'o', "~2h0h0c4c4h2h"}, {U'p', "0h0a ~0f0h4h4c0c0e"}, {U'q', "4h4a ~4f4h0h0c4c4e"},
    {U'r', "0h0c ~0f0h2h"}, {U's', "~4g4h0h0f4f4c0c0d"}, {U't', "~1j1c3c 0h3h"}, {U'u', "4h4c ~0h0c4c4f"},
    {U'v', "0h2c4h"}, {U'w', "0h2c3g4c6h"}, {U'x', "0h4c 4h0c"}, {U'y', "0h2c 4h1a0a"}, {U'z', "0h4h0c4c"},
    {U'{', "~3k2k2f0f ~0f2f2b3b"}, {U'|', "0k0b"}, {U'}', "~0k1k1f3f ~3f1f1b0b"}, {U'~', "~0f1h3d4f"},
    {U'°', "~1j0j0h2h2j1j"}, {U'±', "0g4g 2i2e 0c4c"}, {U'²', "~0j0k2k2i0h 0h2h"}, {U'³', "~0k2k2i1i ~1i2i2g0g"}, {U'µ', "0h0a ~0f0c4c4f 4h4c"},
    {U'·', "0f0f"}, {U'×', "0h4d 0d4h"}, {U'−', "0f4f"}, {U'–', "0f4f"}, {U'—', "0f7f"}, {U'…', "0c0c 2c2c 4c4c"}, {U'½', "0i1j1g 4j1c ~3e3f5f5e3c 3c5c"},
    {U'α', "~5h4c0c0h4h5c"}, {U'β', "0a0g ~0g0j4j4g1g ~1g4g4c0c0d"}, {U'γ', "0h2c4h 2c2a"}, {U'η', "0h0c ~0f0h4h4e 4f4a"},
    {U'θ', "~2j0j0c4c4j2j 0g4g"}, {U'μ', "0h0a ~0f0c4c4f 4h4c"}, {U'π', "0h5h 1h1c 4h4c"}, {U'σ', "5h2h ~2h0h0c4c4h2h"},
    {U'φ', "~2h0h0c5c5h3h2h 2j2a"}, {U'Δ', "0c3j6c0c"}, {U'Σ', "5j0j3g0c5c"},
    {U'\uFFFD', "0c0j4j4c0c"},
};
// clang-format on

using Points = std::vector<std::array<double, 2>>;

/// Cuts every corner, as Chaikin (1974) has it; ends stay.
Points rounded(const Points& points) {
    if (points.size() < 3) return points;
    Points cut{points.front()};
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const auto &a = points[i], &b = points[i + 1];
        const auto between = [&](double t) {
            return std::array{a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])};
        };
        if (i > 0) cut.push_back(between(0.25));
        if (i + 2 < points.size()) cut.push_back(between(0.75));
    }
    cut.push_back(points.back());
    return cut;
}

Glyph glyphFrom(std::string_view drawing) {
    constexpr double kBearing = 0.75, kBaseline = 'c', kSpace = 2.7;
    constexpr int kCuts = 3;
    Glyph glyph;
    double right = 0;
    while (!drawing.empty()) {
        const std::string_view stroke = drawing.substr(0, drawing.find(' '));
        drawing.remove_prefix(std::min(drawing.size(), stroke.size() + 1));
        const bool round = stroke.front() == '~';
        Points points;
        for (std::size_t i = round ? 1 : 0; i + 1 < stroke.size(); i += 2) {
            points.push_back({kBearing + (stroke[i] - '0'), stroke[i + 1] - kBaseline});
            right = std::max(right, points.back()[0]);
        }
        for (int cut = 0; round && cut < kCuts; ++cut) points = rounded(points);
        glyph.strokes.push_back({std::move(points)});
    }
    glyph.advance = glyph.strokes.empty() ? kSpace : right + kBearing;
    return glyph;
}

}  // namespace

const Glyph& glyphOf(char32_t code) {
    static const std::unordered_map<char32_t, Glyph> kGlyphs = [] {
        std::unordered_map<char32_t, Glyph> glyphs;
        for (const Drawing& drawing : kDrawings) glyphs.emplace(drawing.code, glyphFrom(drawing.strokes));
        return glyphs;
    }();
    const auto found = kGlyphs.find(code);
    return found != kGlyphs.end() ? found->second : kGlyphs.at(U'\uFFFD');
}

std::u32string codePoints(std::string_view text) {
    std::u32string codes;
    while (!text.empty()) {
        const std::size_t length = sequenceLength(text);
        const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
        char32_t code = U'\uFFFD';
        if (length == 1) code = byte(0);
        if (length > 1) {
            code = byte(0) & (0xFFu >> (length + 1));
            for (std::size_t i = 1; i < length; ++i) code = code << 6u | (byte(i) & 0x3Fu);
        }
        codes.push_back(code);
        text.remove_prefix(std::max<std::size_t>(length, 1));
    }
    return codes;
}

}  // namespace hairloom
