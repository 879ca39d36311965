// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Text in images, as reviews ask for.

#include <string>
#include <vector>

#include "core/render/image.h"

namespace hairloom::render {

/// Draws the lines, white on a dark ground, into the lower left corner. Their height follows the image's: a
/// fortieth of it, at least 9 pixels. Lines that are too long end with three dots, and lines above the image
/// are left out. Text is UTF-8. Letters of Europe lose their marks, and what is neither such a letter nor
/// ASCII nor "°" becomes "?".
void burnIn(Image& image, const std::vector<std::string>& lines);

}  // namespace hairloom::render
