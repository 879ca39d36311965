// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/live/film.h"

#include "core/render/png.h"
#include "core/render/webp.h"

namespace hairloom {

render::Camera turned(render::Camera camera, float degrees) {
    const Eigen::AngleAxisf rotation(radians(degrees), Vec3f::UnitY());
    camera.eye_ws = camera.target_ws + rotation * (camera.eye_ws - camera.target_ws);
    camera.up_ws = rotation * camera.up_ws;
    return camera;
}

Status writeAnimation(const std::filesystem::path& path, std::span<const render::Image> images,
                      std::uint32_t milliseconds) {
    return path.extension() == ".webp" ? render::writeAnimatedWebp(path, images, milliseconds)
                                       : render::writeAnimatedPng(path, images, milliseconds);
}

}  // namespace hairloom
