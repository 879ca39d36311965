// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/text.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/render/font.h"

namespace hairloom::render {
namespace {

constexpr std::size_t kAdvance = kGlyphWidth + 1, kLine = kGlyphHeight + 2;  // pixels of the font
constexpr std::size_t kMargin = 2;

using Glyphs = std::vector<std::size_t>;

/// The letters from U+00C0 to U+017F without their marks.
constexpr std::string_view kBare =
    "AAAAAAACEEEEIIIIDNOOOOOxOUUUUYTsaaaaaaaceeeeiiiidnooooo/ouuuuyty"
    "AaAaAaCcCcCcCcDdDdEeEeEeEeEeGgGgGgGgHhHhIiIiIiIiIiIiJjKkkLlLlLlL"
    "lLlNnNnNnnNnOoOoOoOoRrRrRrSsSsSsSsTtTtTtUuUuUuUuUuUuWwYyYZzZzZzs";

/// What the font shows in place of the character of two bytes; none: it has nothing.
char bareLetter(unsigned char first, unsigned char second) {
    const std::size_t code = (first & 0x1fu) << 6u | (second & 0x3fu);
    constexpr std::size_t kFirst = 0xc0;
    if ((first & 0xe0u) != 0xc0u || (second & 0xc0u) != 0x80u || code < kFirst ||
        code - kFirst >= kBare.size())
        return '?';
    return kBare[code - kFirst];
}

/// Indices into the font.
Glyphs glyphsOf(const std::string& text) {
    constexpr std::size_t kDegrees = 95;
    Glyphs glyphs;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto byte = static_cast<unsigned char>(text[i]);
        if ((byte & 0xc0u) == 0x80u) continue;  // a later byte of a character
        const unsigned char next = i + 1 < text.size() ? static_cast<unsigned char>(text[i + 1]) : 0;
        // U+0300 to U+036F, marks that join the letter before them, as names from macOS have them.
        if (byte == 0xcc || (byte == 0xcd && next < 0xb0)) continue;
        const bool isDegrees = text.compare(i, 2, "\xc2\xb0") == 0;
        const char shown = byte >= ' ' && byte <= '~' ? text[i] : bareLetter(byte, next);
        glyphs.push_back(isDegrees ? kDegrees : static_cast<std::size_t>(shown - ' '));
    }
    return glyphs;
}

/// With three dots in place of what is behind.
void shorten(Glyphs& glyphs, std::size_t most) {
    if (glyphs.size() <= most) return;
    glyphs.resize(most);
    for (std::size_t i = most - std::min<std::size_t>(most, 3); i < most; ++i) glyphs[i] = '.' - ' ';
}

/// Three fifths of black over the pixel, whose alpha is not premultiplied.
void darken(std::uint8_t* pixel) {
    const unsigned alpha = (3 * 255u + 2u * pixel[3]) / 5;
    for (int c = 0; c < 3; ++c) pixel[c] = static_cast<std::uint8_t>(pixel[c] * 2u * pixel[3] / (5 * alpha));
    pixel[3] = static_cast<std::uint8_t>(alpha);
}

}  // namespace

void burnIn(Image& image, const std::vector<std::string>& lines) {
    const std::size_t scale = std::max<std::size_t>(1, image.height / (40 * kGlyphHeight));
    const std::size_t width = image.width / scale, height = image.height / scale;  // pixels of the font
    if (width < 2 * kMargin + kAdvance || height < 2 * kMargin + kLine) return;
    std::vector<Glyphs> shown;
    for (const std::string& line : lines) {
        shown.push_back(glyphsOf(line));
        shorten(shown.back(), (width - 2 * kMargin) / kAdvance);
    }
    const std::size_t most = (height - 2 * kMargin) / kLine;
    if (shown.size() > most) shown.erase(shown.begin(), shown.end() - static_cast<std::ptrdiff_t>(most));
    std::size_t longest = 0;
    for (const Glyphs& line : shown) longest = std::max(longest, line.size());
    if (longest == 0) return;
    const std::size_t boxWidth = 2 * kMargin + longest * kAdvance,
                      boxHeight = 2 * kMargin + shown.size() * kLine;
    const std::size_t top = image.height - boxHeight * scale;
    const auto pixelAt = [&](std::size_t x, std::size_t y) {
        return image.rgba.data() + 4 * ((top + y) * image.width + x);
    };
    for (std::size_t y = 0; y < boxHeight * scale; ++y)
        for (std::size_t x = 0; x < boxWidth * scale; ++x) darken(pixelAt(x, y));
    for (std::size_t l = 0; l < shown.size(); ++l) {
        for (std::size_t i = 0; i < shown[l].size(); ++i) {
            const std::size_t left = (kMargin + i * kAdvance) * scale,
                              above = (kMargin + l * kLine + 1) * scale;
            for (std::size_t y = 0; y < kGlyphHeight * scale; ++y)
                for (std::size_t x = 0; x < kGlyphWidth * scale; ++x)
                    if (isInk(shown[l][i], x / scale, y / scale))
                        std::fill_n(pixelAt(left + x, above + y), 4, std::uint8_t{255});
        }
    }
}

}  // namespace hairloom::render
