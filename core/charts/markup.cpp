// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/charts/markup.h"

#include <array>
#include <cstdint>

namespace hairloom {
namespace {

/// Advance widths of Helvetica (Adobe's font metrics) for the characters from space to tilde, in thousandths
/// of the size.
constexpr std::array<std::uint16_t, 95> kHelvetica = {
    278,  278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278, 278,  // space … /
    556,  556, 556, 556, 556, 556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556,  // 0 … ?
    1015, 667, 667, 722, 722, 667, 611, 778, 722, 278, 500, 667, 556, 833, 722, 778,  // @ … O
    667,  778, 722, 667, 611, 722, 667, 944, 667, 667, 611, 278, 278, 278, 469, 556,  // P … _
    333,  556, 556, 500, 556, 556, 278, 556, 556, 222, 222, 500, 222, 833, 556, 556,  // ` … o
    556,  556, 333, 500, 278, 556, 500, 722, 500, 500, 500, 334, 260, 334, 584};      // p … ~
constexpr double kOtherCharacter = 600;
/// DejaVu Sans, what many Linux systems take for Helvetica, is about so much wider.
constexpr double kWiderFaces = 1.12;

void appendEscaped(char c, std::string& out) {
    switch (c) {
        case '&':
            out += "&amp;";
            break;
        case '<':
            out += "&lt;";
            break;
        case '>':
            out += "&gt;";
            break;
        case '"':
            out += "&quot;";
            break;
        case '\'':
            out += "&#39;";
            break;
        default:
            out += static_cast<unsigned char>(c) < 0x20u || c == 0x7F ? ' ' : c;
    }
}

}  // namespace

std::size_t sequenceLength(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char first = byte(0);
    const std::size_t length = first < 0x80u                     ? 1u
                               : first >= 0xC2u && first < 0xE0u ? 2u
                               : first >= 0xE0u && first < 0xF0u ? 3u
                               : first >= 0xF0u && first < 0xF5u ? 4u
                                                                 : 0u;
    if (length == 0 || length > text.size()) return 0;
    for (std::size_t i = 1; i < length; ++i) {
        if ((byte(i) & 0xC0u) != 0x80u) return 0;
    }
    // Overlong forms, surrogates, what lies beyond U+10FFFF, and U+FFFE and U+FFFF, which XML does not allow.
    if (first == 0xE0u && byte(1) < 0xA0u) return 0;
    if (first == 0xEDu && byte(1) >= 0xA0u) return 0;
    if (first == 0xF0u && byte(1) < 0x90u) return 0;
    if (first == 0xF4u && byte(1) >= 0x90u) return 0;
    if (first == 0xEFu && byte(1) == 0xBFu && byte(2) >= 0xBEu) return 0;
    return length;
}

std::string escapeMarkup(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    while (!text.empty()) {
        const std::size_t length = sequenceLength(text);
        if (length == 0) {
            out += "\uFFFD";
        } else if (length == 1) {
            appendEscaped(text[0], out);
        } else {
            out += text.substr(0, length);
        }
        text.remove_prefix(length == 0 ? 1 : length);
    }
    return out;
}

double textWidth(std::string_view text, double size) {
    double thousandths = 0;
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte >= 0x20u && byte < 0x7Fu)
            thousandths += kHelvetica[byte - 0x20u];
        else if ((byte & 0xC0u) != 0x80u)
            thousandths += kOtherCharacter;  // first byte of a character
    }
    return thousandths * 1e-3 * size * kWiderFaces;
}

std::vector<std::string> wrapText(std::string_view text, double size, double width) {
    std::vector<std::string> lines;
    std::string line;
    while (!text.empty()) {
        const std::size_t space = text.find(' ');
        const std::string_view word = text.substr(0, space);
        const std::string longer = line.empty() ? std::string(word) : line + ' ' + std::string(word);
        if (line.empty() || textWidth(longer, size) <= width) {
            line = longer;
        } else {
            lines.push_back(line);
            line = word;
        }
        text.remove_prefix(space == std::string_view::npos ? text.size() : space + 1);
    }
    if (!line.empty() || lines.empty()) lines.push_back(line);
    return lines;
}

}  // namespace hairloom
