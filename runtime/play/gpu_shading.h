// SPDX-License-Identifier: MIT
#pragma once
// What the passes that light and shade hairs are given: materials, tables, streaks.

#include "hairloom/asset.h"

namespace hairloom::runtime {

/// At least one.
std::size_t gpuMaterialsOf(const Asset& asset);
/// Whether fillShading() fills the buffer.
bool fillsShading(std::uint32_t buffer);
/// The whole buffer, of hairs in `order`.
void fillShading(const Asset& asset, std::uint32_t buffer, std::span<const std::uint32_t> order, void* out);

}  // namespace hairloom::runtime
