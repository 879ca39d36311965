// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "core/base/result.h"
#include "core/render/image.h"

namespace hairloom {

/// A JPEG of grey or colour, as linear light. Errors: damaged, of another colour space, too large.
Result<render::LinearImage> decodeJpeg(const std::string& file, std::span<const std::byte> bytes);

}  // namespace hairloom
