// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "core/base/result.h"
#include "core/render/image.h"

namespace hairloom::render {

/// OpenEXR: the channels R, G, B and A as 32-bit floats, ZIP compressed. Writes the whole file or leaves what
/// was there; the same image gives the same bytes.
Status writeExr(const std::filesystem::path& path, const LinearImage& image);

}  // namespace hairloom::render
