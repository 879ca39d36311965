// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Text as SVG and HTML take it, and how wide it becomes.

#include <string>
#include <string_view>
#include <vector>

namespace hairloom {

/// Safe as content and as an attribute's value in XML and HTML: markup is escaped, control characters become
/// spaces, bytes that are no UTF-8 become U+FFFD.
std::string escapeMarkup(std::string_view text);

/// Bytes of the UTF-8 sequence at the start of `text`, which is not empty; 0 where there is none.
std::size_t sequenceLength(std::string_view text);

/// Pixels that a line takes at `size` pixels in Helvetica, Arial or what a viewer has instead, with some
/// room for wider faces.
double textWidth(std::string_view text, double size);

/// Cuts at spaces into lines of at most `width` pixels where that is possible; at least one line.
std::vector<std::string> wrapText(std::string_view text, double size, double width);

}  // namespace hairloom
