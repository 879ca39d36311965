// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Marks over a finished picture: what shaders/render/overlay.vert.hlsl and overlay.frag.hlsl do on a GPU.

#include <span>

#include "core/software/memory.h"
#include "shaders/shared/render_types.h"

namespace hairloom::software {

/// Blends the marks of so many corners (six a point or line, three a triangle), the first at
/// `constants.firstVertex`, over `target`, in their order. `hides`: a depth a pixel that marks lie behind;
/// empty: none.
void drawMarks(HostTexture& target, std::span<const float> hides, const shaders::OverlayConstants& constants,
               std::span<const shaders::OverlayVertex> vertices, std::uint32_t corners);

}  // namespace hairloom::software
