// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "core/base/math.h"
#include "core/base/result.h"

namespace hairloom::cli {

/// "X,Y,Z". `option` is named in errors.
Result<Vec3f> parseVector(const std::string& text, const std::string& option);

/// "WxH", each 1 … 16384.
Result<std::pair<std::uint32_t, std::uint32_t>> parseSize(const std::string& text);

}  // namespace hairloom::cli
