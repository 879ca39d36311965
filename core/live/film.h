// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What pictures that follow one another have in common, whoever draws them.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "core/base/result.h"
#include "core/live/video_file.h"
#include "core/render/camera.h"
#include "core/render/image.h"

namespace hairloom {

/// The camera turned about the upright axis through what it looks at, as on a turntable.
render::Camera turned(render::Camera camera, float degrees);

/// Images that follow one another in one file: an MP4 or an animated WebP where the name ends so, else an
/// animated PNG.
class AnimationFile {
  public:
    /// Which of the three a name asks for, in capitals or not.
    enum class Kind { Png, Webp, Mp4 };
    static Kind kindOf(const std::filesystem::path& path);
    /// Whether images are held until finish(), 4 bytes a pixel. An MP4 is encoded as they come.
    static bool holdsImages(Kind kind) { return kind != Kind::Mp4; }

    /// `framesPerSecond` 1/65 … 1000, of WebP and PNG rounded to milliseconds of an image. Errors: those of
    /// VideoFile::open().
    static Result<AnimationFile> open(const std::filesystem::path& path, std::uint32_t width,
                                      std::uint32_t height, double framesPerSecond);
    /// Errors: those of VideoFile::add().
    Status add(const render::Image& image);
    /// Errors: those of render::writeAnimatedWebp(), writeAnimatedPng() and VideoFile::finish().
    Status finish();

  private:
    std::filesystem::path path_;
    double framesPerSecond_ = 0;
    std::vector<render::Image> images_;
    std::optional<VideoFile> video_;
};

}  // namespace hairloom
