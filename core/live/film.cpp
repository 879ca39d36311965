// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/live/film.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/render/png.h"
#include "core/render/webp.h"

namespace hairloom {

render::Camera turned(render::Camera camera, float degrees) {
    const Eigen::AngleAxisf rotation(radians(degrees), Vec3f::UnitY());
    camera.eye_ws = camera.target_ws + rotation * (camera.eye_ws - camera.target_ws);
    camera.up_ws = rotation * camera.up_ws;
    return camera;
}

AnimationFile::Kind AnimationFile::kindOf(const std::filesystem::path& path) {
    std::string suffix = path.extension().string();
    std::ranges::transform(suffix, suffix.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    return suffix == ".mp4" ? Kind::Mp4 : suffix == ".webp" ? Kind::Webp : Kind::Png;
}

Result<AnimationFile> AnimationFile::open(const std::filesystem::path& path, std::uint32_t width,
                                          std::uint32_t height, double framesPerSecond) {
    AnimationFile file;
    file.path_ = path;
    file.framesPerSecond_ = framesPerSecond;
    if (!holdsImages(kindOf(path))) {
        auto video = VideoFile::open(path, width, height, framesPerSecond);
        if (!video) return tl::unexpected(video.error());
        file.video_ = std::move(*video);
    }
    return file;
}

Status AnimationFile::add(const render::Image& image) {
    if (video_) return video_->add(image);
    images_.push_back(image);
    return {};
}

Status AnimationFile::finish() {
    if (video_) return video_->finish();
    constexpr double kMost = 65535;
    const auto milliseconds =
        static_cast<std::uint32_t>(std::clamp(std::round(1e3 / framesPerSecond_), 1.0, kMost));
    return kindOf(path_) == Kind::Webp ? render::writeAnimatedWebp(path_, images_, milliseconds)
                                       : render::writeAnimatedPng(path_, images_, milliseconds);
}

}  // namespace hairloom
