// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace hairloom {

/// The text with every byte that is not part of well-formed UTF-8 (Unicode 15, table 3-7) and every control
/// character replaced by '?', so that names from files can go into messages, JSON and project files, and to
/// a terminal.
std::string cleanUtf8(std::string_view text);

}  // namespace hairloom
