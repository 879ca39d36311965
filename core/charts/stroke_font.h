// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A face of single strokes, for text in images: letters, digits, signs of charts and the Greek that formulas
// of hair have. No font file is needed, and every machine draws the same.

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace hairloom {

/// Places in units of the face: x from the glyph's left edge, y up from the line of writing.
struct GlyphStroke {
    std::vector<std::array<double, 2>> points;  ///< at least one; one alone is a dot
};
struct Glyph {
    double advance = 0;  ///< to where the next one begins
    std::vector<GlyphStroke> strokes;
};

inline constexpr double kGlyphUnitsPerSize = 9.6;  ///< units in the size of a text; capitals have 7

/// Of a code point; an empty box where the face has none.
const Glyph& glyphOf(char32_t code);
/// Code points of UTF-8; bytes that are none become U+FFFD.
std::u32string codePoints(std::string_view text);

}  // namespace hairloom
