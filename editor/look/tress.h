// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A lock of hair that shows what a material looks like, and the view that thumbnails have of it.

#include "core/groom/groom.h"
#include "editor/viewport/picture_request.h"

namespace hairloom::editor {

/// Goes up with each change of the picture, so that none is shown that was kept of an older one.
inline constexpr int kTressVersion = 4;

/// A wavy lock with that material, `side_px` pixels square, transparent around it. Dark looks get more light
/// than bright ones, so that each shows its colour.
PictureRequest tressPicture(const HairMaterial& material, std::uint32_t side_px);

}  // namespace hairloom::editor
