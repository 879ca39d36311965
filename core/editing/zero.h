// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Eigen's vectors are not zero by default.

#include <type_traits>

namespace hairloom::editing {

template <class T>
T zero() {
    if constexpr (std::is_arithmetic_v<T>) {
        return T{0};
    } else {
        return T::Zero();
    }
}

}  // namespace hairloom::editing
