// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A video in an MP4 file: H.264, by hairloom-video-writer, a program of its own that alone is linked with
// libavcodec and the hundred libraries behind it.

#include <cstdint>
#include <filesystem>
#include <memory>

#include "core/base/result.h"
#include "core/render/image.h"

namespace hairloom {

/// Whether this program has that other one beside it.
bool canWriteVideo();

/// Frames are encoded as they come, so that a long video takes no more memory than its file.
///
/// Colours are converted to BT.709, limited range, 4:2:0, and labelled so: primaries 1, transfer 13 (sRGB,
/// which is what the images hold), matrix 1 (ITU-T H.273). The same frames give the same bytes on any number
/// of threads.
class VideoFile {
  public:
    /// `framesPerSecond` 1/66 … 1000. A width or height that is odd gains a column or row, a copy of the
    /// last. Errors: a size of none or above kMostVideoSide, no program that writes videos, what OutputFile
    /// refuses.
    static Result<VideoFile> open(const std::filesystem::path& path, std::uint32_t width,
                                  std::uint32_t height, double framesPerSecond);
    VideoFile(VideoFile&&) noexcept;
    VideoFile& operator=(VideoFile&&) noexcept;
    ~VideoFile();  ///< unfinished, it leaves what was there

    /// Errors: another size, a pixel that lets the background through, an encoder that has ended.
    Status add(const render::Image& frame);
    /// Errors: no frames, what the encoder says, a disk that is full.
    Status finish();

  private:
    struct Impl;
    explicit VideoFile(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace hairloom
