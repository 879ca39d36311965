// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A lock of hair that shows what a material looks like, and the view that thumbnails have of it.

#include "core/groom/groom.h"
#include "editor/viewport/picture_request.h"

namespace hairloom::editor {

/// A wavy lock with that material, `side_px` pixels square.
PictureRequest tressPicture(const HairMaterial& material, std::uint32_t side_px, const Vec3f& background);

}  // namespace hairloom::editor
