// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

namespace hairloom::runtime {

/// How often this program has asked for memory so far, on any thread.
std::size_t allocationCount();

}  // namespace hairloom::runtime
