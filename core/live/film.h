// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What pictures that follow one another have in common, whoever draws them.

#include <cstdint>
#include <filesystem>
#include <span>

#include "core/base/result.h"
#include "core/render/camera.h"
#include "core/render/image.h"

namespace hairloom {

/// The camera turned about the upright axis through what it looks at, as on a turntable.
render::Camera turned(render::Camera camera, float degrees);

/// An animated WebP where the name ends in .webp, else an animated PNG; `milliseconds` (1…65535) each.
/// Errors: those of render::writeAnimatedWebp() and writeAnimatedPng().
Status writeAnimation(const std::filesystem::path& path, std::span<const render::Image> images,
                      std::uint32_t milliseconds);

}  // namespace hairloom
