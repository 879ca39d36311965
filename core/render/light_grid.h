// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Light between hairs, followed through cells of hair and skin (Scattering::volume).

#include "core/render/passes.h"

namespace hairloom::render {

/// Hair that takes part: fibres that send light on to others.
bool standsInLightGrid(const StrandShading& shading);
/// Cells for the hair of now, and photons for the lights of now; nothing where no light comes in. Before
/// setUpLights().
void placeLightGrid(RendererState& state);
/// Fills the cells and follows the photons; nothing where placeLightGrid() found nothing.
void recordLightGrid(gpu::CommandList& list, RendererState& state);

}  // namespace hairloom::render
