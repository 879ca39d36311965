// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/live/video_stream.h"

namespace hairloom {

/// H.264 in MP4, in memory. What fails throws std::runtime_error.
class H264Encoder {
  public:
    /// Throws also where this libavcodec has no encoder of H.264 that this program knows.
    explicit H264Encoder(const VideoHead& head);
    ~H264Encoder();
    H264Encoder(const H264Encoder&) = delete;
    H264Encoder& operator=(const H264Encoder&) = delete;

    /// Rows of RGBA from the top.
    void add(std::span<const std::uint8_t> rgba);
    /// The whole file.
    std::vector<std::uint8_t> finish();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace hairloom
