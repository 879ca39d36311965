// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace hairloom {

/// Built with sanitizers, which slow readers down and make system calls of their own.
#if defined(HAIRLOOM_ADDRESS_SANITIZER) || defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace hairloom
