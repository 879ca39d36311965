// SPDX-License-Identifier: MIT
#pragma once
// std::bit_cast, which the C++ library of Debian 12's Emscripten does not have.

#include <cstring>

namespace hairloom::runtime {

/// The same bits as a number of another type.
template <class To, class From>
inline To fromBitsOf(From from) noexcept {
    static_assert(sizeof(To) == sizeof(From));
    To to;
    std::memcpy(&to, &from, sizeof to);
    return to;
}

}  // namespace hairloom::runtime
