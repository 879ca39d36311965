// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "core/base/result.h"
#include "core/render/image.h"

namespace hairloom::render {

/// Writes the whole file or leaves what was there. The same image gives the same bytes.
Status writePng(const std::filesystem::path& path, const Image& image);

}  // namespace hairloom::render
