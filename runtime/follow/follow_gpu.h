// SPDX-License-Identifier: MIT
#pragma once
// Follow hairs as the kernels follow_wisps and follow_hairs of runtime/shaders take them.

#include <array>

#include "hairloom/follow.h"
#include "hairloom/memory.h"
#include "shaders/follow_types.h"

namespace hairloom::runtime {

/// Of hair `hair` of a view that FollowHairs::make takes.
shaders::FollowBinding followBinding(const FollowView& view, std::size_t hair);
/// Of each guide.
shaders::FollowPlane followPlane(const RootPlane& plane);
/// Of each guide and point of a hair: the guides' point, its bits as a float, and the share of the next.
Vector<std::array<float, 2>> followSamples(const FollowView& view);

}  // namespace hairloom::runtime
