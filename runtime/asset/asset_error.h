// SPDX-License-Identifier: MIT
#pragma once
// What is said of a damaged asset.

#include <string>
#include <utility>

#include "hairloom/asset.h"

namespace hairloom::runtime {

inline std::string number(std::uint64_t value) {
    return std::to_string(value);
}

inline AssetError damaged(std::uint64_t byte, std::string words) {
    return {AssetError::Kind::damaged, byte, std::move(words)};
}

}  // namespace hairloom::runtime
