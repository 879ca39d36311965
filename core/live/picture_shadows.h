// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How the shadows that a project saves are drawn.

#include "core/groom/shadow_settings.h"
#include "core/live/view_file.h"
#include "core/render/options.h"

namespace hairloom {

/// The project's, but for what the view says.
void takeShadows(const ShadowSettings& project, const ViewFile& view, render::RenderOptions& options);
/// The project's alone.
void takeShadows(const ShadowSettings& project, render::RenderOptions& options);

}  // namespace hairloom
